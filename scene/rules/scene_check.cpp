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

void check_material(const Material& material, const SceneChecker& checker)
{
    checker.at("density").need_range(material.density, kLeastMass, kGreatestMass,
                                     "a density above 0 kg/m3");
    checker.at("friction")
        .need_range(material.friction, 0, kGreatestNumber, "a friction of at least 0");
    checker.at("restitution").need_range(material.restitution, 0, 1, "a restitution from 0 to 1");
    checker.at("rolling_friction")
        .need_range(material.rolling_friction, 0, kGreatestLength,
                    "a rolling friction of at least 0 m");
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
        check_material(material, checker);
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
        checker.at("friction")
            .need_range(pair.friction.value_or(0), 0, kGreatestNumber, "a friction of at least 0");
        checker.at("restitution")
            .need_range(pair.restitution.value_or(0), 0, 1, "a restitution from 0 to 1");
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
        checker.at("at_a").need_place(spring.at_a);
        checker.at("at_b").need_place(spring.at_b);
        checker.at("stiffness")
            .need_range(spring.stiffness, 0, kGreatestNumber, "a stiffness of at least 0 N/m");
        checker.at("damping").need_range(spring.damping, 0, kGreatestNumber,
                                         "a damping of at least 0 N s/m");
        checker.at("length").need_range(spring.length, 0, kGreatestLength,
                                        "a length of at least 0 m");
    }
}

void check_fields(const Scene& scene)
{
    const SceneChecker whole, attractors = whole.at("attractors");
    whole.at("gravity").need_range(scene.gravity, -kGreatestLength, kGreatestLength,
                                   "an acceleration in m/s2");
    whole.at("wind").need_range(scene.wind, -kGreatestLength, kGreatestLength, "a velocity in m/s");
    for (std::size_t i = 0; i < scene.attractors.size(); ++i) {
        const SceneChecker checker = attractors.at(i);
        checker.at("position").need_place(scene.attractors[i].position);
        checker.at("strength")
            .need_range(scene.attractors[i].strength, -kGreatestNumber, kGreatestNumber,
                        "a strength");
    }
}

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

void SceneChecker::need_range(double number,
                              double least,
                              double greatest,
                              std::string_view what) const
{
    if (number >= least && number <= greatest) return;
    // A limit of the step, not of nature, is said to be one.
    const bool beyond = (std::abs(number) > greatest && greatest >= kGreatestLength)
        || (number > 0 && number < least);
    refuse("wanted " + std::string(what) + (beyond ? ", of a size that a step can hold" : "")
           + ", not " + number_text(number));
}

void SceneChecker::need_range(const Vec3& numbers,
                              double least,
                              double greatest,
                              std::string_view what) const
{
    for (std::size_t i = 0; i < 3; ++i) {
        const double number = numbers[static_cast<Eigen::Index>(i)];
        if (!(number >= least && number <= greatest))
            at(i).need_range(number, least, greatest, what);
    }
}

void SceneChecker::need_place(const Vec3& place) const
{
    need_range(place, -kGreatestLength, kGreatestLength, "a place in m");
}

bool is_unit(const Quat& orientation) { return std::abs(orientation.norm() - 1) <= kUnitTolerance; }

void SceneChecker::need_unit(const Quat& orientation) const
{
    if (is_unit(orientation)) return;
    refuse(std::string(kWantedUnitQuaternion) + ", not of length "
           + number_text(orientation.norm()));
}

std::optional<SceneTrouble> find_trouble(const Scene& scene)
{
    try {
        check_settings(scene.settings);
        check_fields(scene);
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
