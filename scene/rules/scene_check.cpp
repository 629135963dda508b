// Scene check: what a scene must be before it can become a world.
#include "scene/rules/scene_check.hpp"

#include "scene/names.hpp"
#include "scene/rules/scene_rules.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace throng {
namespace {

void check_settings(const Settings& settings)
{
    // A dial's present value is good when the dial would take it.
    const SceneChecker whole, part = whole.at("settings");
    for (const Dial& dial : dials()) {
        Settings scratch;
        const SceneChecker checker = part.at(dial.name);
        const std::string trouble = dial.set(scratch, dial.get(settings));
        checker.need(trouble.empty(), trouble);
    }
    const std::string clash = clashing_dials(settings);
    part.need(clash.empty(), clash);
}

void check_materials(const Scene& scene)
{
    const SceneChecker whole, materials = whole.at("materials"), pairs = whole.at("pairs");
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        const SceneChecker checker = materials.at(material.name, i);
        checker.need(material.name.empty() || names.insert(material.name).second,
                     "wanted a name of its own for each material");
        checker.need_fields(material, kMaterialFields);
    }

    std::set<std::pair<std::uint32_t, std::uint32_t>> met;
    for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
        const MaterialPairDescription& pair = scene.pairs[i];
        const SceneChecker checker = pairs.at(i);
        checker.at("materials")
            .need(std::max(pair.a, pair.b) < scene.materials.size(),
                  "wanted two materials of the scene");
        checker.at("materials")
            .need(met.insert(std::minmax(pair.a, pair.b)).second,
                  "wanted each pair of materials once");
        checker.need_fields(pair, kPairFields);
    }
}

void check_springs(const Scene& scene)
{
    const SceneChecker whole, springs = whole.at("springs");
    const std::size_t bodies = scene.body_count();
    for (std::size_t i = 0; i < scene.springs.size(); ++i) {
        const Spring& spring = scene.springs[i];
        const SceneChecker checker = springs.at(i);
        checker.at("a").need(spring.a == kNone || spring.a < bodies, "wanted a body of the scene");
        checker.at("b").need(spring.b == kNone || spring.b < bodies, "wanted a body of the scene");
        checker.at("b").need(spring.a != spring.b, "wanted another end than a");
        checker.need_fields(spring, kSpringFields);
    }
}

void check_attractors(const Scene& scene)
{
    const SceneChecker whole, attractors = whole.at("attractors");
    for (std::size_t i = 0; i < scene.attractors.size(); ++i) {
        const SceneChecker checker = attractors.at(i);
        checker.need_fields(scene.attractors[i], kAttractorFields);
    }
}

/// What a field says of its member, whatever that is kept as.
struct MemberRule {
    const SceneChecker& here;
    const FieldWords& words;

    template <class Value>
    void operator()(const Value* kept) const
    {
        if (!words.range.wanted.empty()) need(here, *kept);
    }
    void operator()(const Quat* kept) const { here.need_unit(*kept); }
    void operator()(const BoundFields& group) const { here.need_fields(group); }
    void operator()(const BoundDial& dial) const
    {
        std::visit([&](const auto* kept) { need_dial(*kept); }, dial);
    }
    // Whoever refers to a name says whether it is there.
    template <class Other>
    void operator()(const Other&) const
    { }

private:
    void need(const SceneChecker& at, double number) const { at.need_range(number, words.range); }
    void need(const SceneChecker& at, const Vec3& vector) const
    {
        at.need_range(vector, words.range);
    }
    template <class Value>
    void need(const SceneChecker& at, const std::optional<Value>& value) const
    {
        if (value) need(at, *value);
    }
    void need(const SceneChecker& at, const std::vector<Vec3>& list) const { need_each(at, list); }
    void need(const SceneChecker& at, const std::array<std::optional<double>, 3>& list) const
    {
        need_each(at, list);
    }
    template <class List>
    void need_each(const SceneChecker& at, const List& list) const
    {
        for (std::size_t i = 0; i < list.size(); ++i) need(at.at(i), list[i]);
    }
    template <class Unranged>
    void need(const SceneChecker&, const Unranged&) const
    { }

    // 0 or empty: not stated.
    void need_dial(const std::string& value) const
    {
        Settings unread;
        if (value.empty()) return;
        const std::string trouble = find_dial(words.key)->set(unread, value);
        here.need(trouble.empty(), trouble);
    }
    void need_dial(double value) const
    {
        if (value != 0) need_dial(number_text(value));
    }
    void need_dial(int value) const
    {
        if (value != 0) need_dial(std::to_string(value));
    }
};

}  // namespace

ScenePath SceneChecker::path() const
{
    if (!whole_) return {};
    ScenePath path = whole_->path();
    if (key_.empty())
        path.emplace_back(index_);
    else
        path.emplace_back(std::string(key_));
    return path;
}

void SceneChecker::refuse(std::string_view wanted) const
{
    throw SceneTrouble{path(), std::string(wanted)};
}

void SceneChecker::need_range(double number, const Range& range) const
{
    if (number >= range.least && number <= range.greatest) return;
    // A limit of the step, not of nature, is said to be one.
    const bool beyond = (std::abs(number) > range.greatest && range.greatest >= kGreatestLength)
        || (number > 0 && number < range.least);
    refuse("wanted " + std::string(range.wanted)
           + (beyond ? ", of a size that a step can hold" : "") + ", not " + number_text(number));
}

void SceneChecker::need_range(const Vec3& numbers, const Range& range) const
{
    for (std::size_t i = 0; i < 3; ++i) {
        const double number = numbers[static_cast<Eigen::Index>(i)];
        if (!(number >= range.least && number <= range.greatest)) at(i).need_range(number, range);
    }
}

bool is_unit(const Quat& orientation) { return std::abs(orientation.norm() - 1) <= kUnitTolerance; }

void SceneChecker::need_unit(const Quat& orientation) const
{
    if (is_unit(orientation)) return;
    refuse(std::string(kWantedUnitQuaternion) + ", not of length "
           + number_text(orientation.norm()));
}

void SceneChecker::need_fields(const BoundFields& fields) const
{
    for (const auto& [words, place] : fields) {
        const SceneChecker here = at(words->key);
        std::visit(MemberRule{here, *words}, place);
    }
}

std::optional<SceneTrouble> find_trouble(const Scene& scene)
{
    try {
        check_settings(scene.settings);
        SceneChecker().need_fields(scene, kSceneFields);
        check_attractors(scene);
        const std::vector<MassProperties> masses = check_shapes(scene);
        check_materials(scene);
        check_bodies(scene, masses);
        check_springs(scene);
    } catch (SceneTrouble& trouble) {
        return std::move(trouble);
    }
    return std::nullopt;
}

std::string check_scene(const Scene& scene)
{
    const std::optional<SceneTrouble> trouble = find_trouble(scene);
    return trouble ? path_text(trouble->path) + ": " + trouble->wanted : std::string();
}

}  // namespace throng
