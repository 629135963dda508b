// Dials: every choice that trades accuracy for time, by name.
#include "throng/dials.hpp"

#include "scene/names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// The values of each dial, default first, in the order of the enumerators of settings.hpp. To offer
// one: write it, and take its `false` away.
constexpr bool kNotYet = false;
constexpr Choice kFrictionAt[] = {{"manifold"}, {"points"}};
constexpr Choice kPrecision[] = {{"float"}, {"double"}};
constexpr Choice kIntegrator[] = {{"auto"},     {"semi_implicit"}, {"euler"},
                                  {"midpoint"}, {"splitting"},     {"rk4"}};
constexpr Choice kRotation[] = {{"quaternion"},   {"rotation_vector"},
                                {"matrix"},       {"quaternion_euler"},
                                {"matrix_euler"}, {"matrix_euler_repaired"}};
constexpr Choice kGyroscopic[] = {{"implicit"}, {"explicit"}, {"off"}};
constexpr Choice kBroadPhase[] = {{"auto"}, {"embree"}, {"grid"}, {"sweep"}, {"all_pairs"}};
constexpr Choice kNarrowPhase[] = {{"auto"},       {"gjk"},         {"sat"},
                                   {"chung_wang"}, {"clip_volume"}, {"containment"}};
constexpr Choice kMethodStart[] = {{"cached"}, {"cold"}, {"plain"}};
constexpr Choice kBoundsFilter[] = {{"none"},    {"sphere"},   {"k_dop:14"},
                                    {"k_dop:6"}, {"k_dop:18"}, {"k_dop:26"}};
constexpr Choice kMeshTree[] = {{"boxes"}, {"k_dop:14"}, {"k_dop:18"}, {"k_dop:26"}};
constexpr Choice kNonconvex[] = {{"voxels"}, {"parts"}, {"spheres"}, {"depth_image"}, {"hull"}};
constexpr Choice kResponse[] = {{"impulse"}, {"penalty"}, {"kinematic"}};
constexpr Choice kSolver[] = {{"soft_step"}, {"pgs"}, {"direct"}};
constexpr Choice kEscalation[] = {{"auto"}, {"off"}};
constexpr Choice kFrictionCone[] = {{"cone"}, {"pyramid"}};
constexpr Choice kImpactLaw[] = {{"sequential"}, {"simultaneous"}};
constexpr Choice kOverlap[] = {{"allow"}, {"back_up"}, {"subdivide"}};
constexpr Choice kToiMethod[] = {{"newton"}, {"bisection"}, {"conservative"}};
constexpr Choice kSleep[] = {{"on"}, {"off"}};
constexpr Choice kPartialRest[] = {{"off"}, {"on"}};
constexpr Choice kEffects[] = {{"called"}, {"auto"}};

constexpr double kLeastStiffness = 1e-30, kLeastDamping = 0;

// Finer steps than this are lost in the time they add up to; greater ones in no scene's scale.
constexpr double kShortestStep = 1e-9, kLongestStep = 1e4;

std::string wanted(std::string_view what, std::string_view text)
{
    return "wanted " + std::string(what) + ", not " + in_quotes(text);
}

/// The place of a value among the choices, or what was wanted.
std::string choose(std::span<const Choice> choices, std::string_view text, std::size_t& place)
{
    std::vector<std::string_view> offered;
    for (const Choice& choice : choices)
        if (choice.available) offered.push_back(choice.text);
    for (std::size_t i = 0; i < choices.size(); ++i) {
        if (choices[i].text != text) continue;
        place = i;
        if (choices[i].available) return {};
        return "wanted " + either_of(offered) + "; " + in_quotes(text)
            + " is not available in this build";
    }
    return wanted(either_of(offered), text);
}

template <auto Member, const auto& choices>
std::string set_choice(Settings& settings, std::string_view text)
{
    std::size_t place = 0;
    const std::string trouble = choose(choices, text, place);
    if (!trouble.empty()) return trouble;
    using Value = std::remove_reference_t<decltype(settings.*Member)>;
    settings.*Member = static_cast<Value>(place);
    return {};
}

template <auto Member, const auto& choices>
std::string get_choice(const Settings& settings)
{
    // A program may have put there what names nothing; whoever reads the text refuses it.
    const auto place = static_cast<std::size_t>(settings.*Member);
    return place < std::size(choices) ? std::string(choices[place].text) : std::to_string(place);
}

/// A whole number in a range, or 0 where it is none.
int parse_whole(std::string_view text, int greatest)
{
    const double number = parse_number(text);
    const bool good = number >= 1 && number <= greatest && number == std::floor(number);
    return good ? static_cast<int>(number) : 0;
}

std::string set_dt(Settings& settings, std::string_view text)
{
    const double time = parse_time(text);
    if (!(time >= kShortestStep && time <= kLongestStep))
        return wanted("a time from 1e-9 to 1e4 s, such as 0.01 or 1/60", text);
    settings.dt = time;
    return {};
}

std::string get_dt(const Settings& settings)
{
    // As a fraction where that is shorter: 1/60 and not 0.016666666666666666.
    const std::string decimal = number_text(settings.dt);
    const double steps = std::round(1 / settings.dt);
    const std::string fraction = "1/" + number_text(steps);
    const bool same = steps >= 1 && parse_time(fraction) == settings.dt;
    return same && fraction.size() < decimal.size() ? fraction : decimal;
}

std::string set_substeps(Settings& settings, std::string_view text)
{
    const int count = parse_whole(text, 1000);
    if (count == 0) return wanted("a whole number from 1 to 1000", text);
    settings.substeps = count;
    return {};
}

std::string get_substeps(const Settings& settings) { return std::to_string(settings.substeps); }

std::string set_direct_limit(Settings& settings, std::string_view text)
{
    const int count = parse_whole(text, 100000);
    if (count == 0) return wanted("a whole number from 1 to 100000", text);
    settings.direct_limit = count;
    return {};
}

std::string get_direct_limit(const Settings& settings)
{
    return std::to_string(settings.direct_limit);
}

std::string set_contact_rate(Settings& settings, std::string_view text)
{
    constexpr std::string_view kFixed = "fixed:";
    const bool is_fixed = text.starts_with(kFixed);
    const double number = parse_number(is_fixed ? text.substr(kFixed.size()) : text);
    // A rate above 1 a substep overshoots; 1e9 Hz is above that at the shortest step.
    const bool good = number > 0 && number <= (is_fixed ? 1e9 : 1.0);
    if (!good && text != "auto")
        return wanted("auto, a number above 0 and up to 1, or fixed:HERTZ such as fixed:30", text);
    settings.contact_rate = good && !is_fixed ? number : 0;
    settings.contact_hertz = good && is_fixed ? number : 0;
    return {};
}

std::string get_contact_rate(const Settings& settings)
{
    if (settings.contact_hertz > 0) return "fixed:" + number_text(settings.contact_hertz);
    return settings.contact_rate > 0 ? number_text(settings.contact_rate) : "auto";
}

template <auto Member>
std::string get_number(const Settings& settings)
{
    return number_text(settings.*Member);
}

std::string set_push_limit(Settings& settings, std::string_view text)
{
    const double speed = parse_number(text);
    if (!(speed >= 0 && speed <= 1e6)) return wanted("a speed from 0 to 1e6 m/s", text);
    settings.push_limit = speed;
    return {};
}

// Below this the rounding of places a few meters away hides it, in double too; above that a contact
// is not looked for as far out as a body was held.
constexpr double kLeastToiTolerance = 1e-12, kMostToiTolerance = 0.02;

std::string set_toi_tolerance(Settings& settings, std::string_view text)
{
    const double share = parse_number(text);
    if (!(share >= kLeastToiTolerance && share <= kMostToiTolerance))
        return wanted("a share of the shape's size from 1e-12 (by precision=float 1.2e-7) to "
                          + number_text(kMostToiTolerance),
                      text);
    settings.toi_tolerance = share;
    return {};
}

std::string set_effects_error(Settings& settings, std::string_view text)
{
    const double error = parse_number(text);
    if (!(error >= 0 && error <= 1)) return wanted("a share of the radius from 0 to 1", text);
    settings.effects_error = error;
    return {};
}

std::string set_rest_force(Settings& settings, std::string_view text)
{
    const double share = parse_number(text);
    if (!(share >= 1e-6 && share <= 1)) return wanted("a share of the load from 1e-6 to 1", text);
    settings.rest_force = share;
    return {};
}

std::string set_voxel_size(Settings& settings, std::string_view text)
{
    const double length = parse_number(text);
    if (!(length >= 1e-9 && length <= 1e9) && text != "auto")
        return wanted("auto or a length from 1e-9 to 1e9 m", text);
    settings.voxel_size = text == "auto" ? 0 : length;
    return {};
}

std::string get_voxel_size(const Settings& settings)
{
    return settings.voxel_size > 0 ? number_text(settings.voxel_size) : "auto";
}

/// A number of at least `least`, or auto, which is below 0.
template <auto Member, const auto& least>
std::string set_amount(Settings& settings, std::string_view text)
{
    const double amount = parse_number(text);
    if (!(amount >= least && amount <= 1e30) && text != "auto")
        return wanted("auto or a number from " + number_text(least) + " to 1e30", text);
    settings.*Member = text == "auto" ? -1 : amount;
    return {};
}

template <auto Member>
std::string get_amount(const Settings& settings)
{
    return settings.*Member >= 0 ? number_text(settings.*Member) : "auto";
}

/// A whole number, or auto, which is 0.
template <auto Member, int least, int greatest>
std::string set_whole(Settings& settings, std::string_view text)
{
    const int count = parse_whole(text, greatest);
    if (count < least && text != "auto")
        return wanted("auto or a whole number from " + std::to_string(least) + " to "
                          + std::to_string(greatest),
                      text);
    settings.*Member = text == "auto" ? 0 : count;
    return {};
}

template <auto Member>
std::string get_whole(const Settings& settings)
{
    return settings.*Member > 0 ? std::to_string(settings.*Member) : "auto";
}

std::string set_sleep(Settings& settings, std::string_view text)
{
    std::size_t place = 0;
    std::string trouble = choose(kSleep, text, place);
    if (trouble.empty()) settings.sleep = place == 0;
    return trouble;
}

std::string get_sleep(const Settings& settings) { return settings.sleep ? "on" : "off"; }

/// A dial with a number for a value.
Dial number_dial(std::string_view name,
                 std::string_view values,
                 std::string_view unit,
                 std::string (*set)(Settings&, std::string_view),
                 std::string (*get)(const Settings&),
                 std::string_view trades)
{
    return {name, std::string(values), get(Settings{}), unit, trades, {}, true, set, get};
}

Dial named_dial(std::string_view name,
                std::span<const Choice> choices,
                std::string (*set)(Settings&, std::string_view),
                std::string (*get)(const Settings&),
                std::string_view trades)
{
    std::string values;
    for (const Choice& choice : choices)
        values += (values.empty() ? "" : ", ") + std::string(choice.text);
    const auto offered = std::count_if(choices.begin(), choices.end(),
                                       [](const Choice& choice) { return choice.available; });
    return {name, values, get(Settings{}), "", trades, choices, offered > 1, set, get};
}

template <auto Member, const auto& choices>
Dial choice_dial(std::string_view name, std::string_view trades)
{
    const auto set = set_choice<Member, choices>;
    return named_dial(name, choices, set, get_choice<Member, choices>, trades);
}

template <auto Member, int least, int greatest>
Dial whole_dial(std::string_view name,
                std::string_view values,
                std::string_view unit,
                std::string_view trades)
{
    return number_dial(name, values, unit, set_whole<Member, least, greatest>, get_whole<Member>,
                       trades);
}

std::vector<Dial> make_dials()
{
    using S = Settings;
    // clang-format off
    return {
        number_dial("dt", "a number or a fraction, 1/60", "s", set_dt, get_dt,
            "a shorter step is more exact in everything and costs a whole step each; in float down to substeps of 1e-5 s"),
        number_dial("substeps", "a whole number from 1 to 1000", "", set_substeps, get_substeps,
            "more substeps make contacts stiffer and motion finer, and cost a solve each"),
        whole_dial<&S::iterations, 1, 100000>("iterations", "auto, or a whole number: solver iterations a substep (soft_step 1, and 16 in a world's first step; pgs 20, factorisations of direct at most 400)",
            "", "more iterations leave less error in the velocities, and cost a sweep of all constraints each"),
        whole_dial<&S::relax_iterations, 1, 100>("relax_iterations", "auto (2 where most contacts have three points or four, as in towers and walls, and from 17 substeps on, else 1; up to 8 in escalated islands, one for twelve contacts), or a whole number: iterations a substep after bodies have moved",
            "", "a second iteration leaves towers a hundredth of their energy, and heaps no less; each is a sweep of all constraints"),
        number_dial("contact_rate", "auto (0.25 a substep for manifolds, 0.5 for one point), a number, fixed:HERTZ",
            "a substep", set_contact_rate, get_contact_rate,
            "a higher rate leaves less overlap and rests less quietly"),
        number_dial("push_limit", "a number", "m/s", set_push_limit, get_number<&S::push_limit>,
            "a higher limit clears deep overlap sooner and throws bodies about more"),
        choice_dial<&S::friction_at, kFrictionAt>("friction_at",
            "points hold each by its own load, as they lie, where the center has one pull and a twist; they cost a fifth more"),
        choice_dial<&S::precision, kPrecision>("precision",
            "double resolves far finer motion and overlap, and takes about twice the memory and time"),
        choice_dial<&S::integrator, kIntegrator>("integrator",
            "higher orders follow smooth forces more closely, and evaluate them more often; auto takes splitting for what forces and pivots act on, and falls by semi_implicit with free turning by splitting; what touches something goes by semi_implicit"),
        choice_dial<&S::rotation, kRotation>("rotation",
            "the exponential map keeps turns exact; the textbook updates drift and save a root"),
        choice_dial<&S::gyroscopic, kGyroscopic>("gyroscopic",
            "implicit is stable at any spin and loses a little energy; explicit gains; off is wrong for long bodies"),
        choice_dial<&S::broadphase, kBroadPhase>("broadphase",
            "time alone: all find the same pairs"),
        choice_dial<&S::narrowphase, kNarrowPhase>("narrowphase",
            "how contacts are found: methods differ in time, depth and the points they give"),
        choice_dial<&S::method_start, kMethodStart>("method_start",
            "time alone: what a pair remembers from the step before saves work"),
        choice_dial<&S::bounds_filter, kBoundsFilter>("bounds_filter",
            "time alone: tighter bounds leave fewer pairs to look at, and cost a test each"),
        choice_dial<&S::mesh_tree, kMeshTree>("mesh_tree",
            "tighter bounds leave fewer triangles of a static mesh to look at, and cost memory and a test each"),
        choice_dial<&S::nonconvex, kNonconvex>("nonconvex",
            "finer stand-ins for a moving non-convex shape fit better, and cost more points"),
        number_dial("voxel_size", "auto (a 48th of the shape's longest side), or a length", "m", set_voxel_size, get_voxel_size,
            "smaller voxels fit the shape better, and cost memory with the cube"),
        whole_dial<&S::image_resolution, 4, 512>("image_resolution", "auto (32), or a whole number from 4 to 512", "rays along the smaller shape's longest side",
            "finer depth images fit the shape better, and cost time with the square"),
        whole_dial<&S::sphere_levels, 1, 6>("sphere_levels", "auto (5), or a whole number from 1 to 6; no level has more than 2000 spheres", "",
            "deeper sphere trees fit the shape better, and cost more tests"),
        whole_dial<&S::max_parts, 1, 256>("max_parts", "auto (16; up to 64 where the shape is so many convex ones), or a whole number from 1 to 256", "",
            "more convex parts fit the shape better, and cost a pair each"),
        choice_dial<&S::response, kResponse>("response",
            "impulses hold overlap small; penalty forces are smooth and soft; kinematic is cheap and loses momentum"),
        choice_dial<&S::solver, kSolver>("solver",
            "soft_step converges best for its time; pgs is the classic; direct is exact and slow"),
        number_dial("direct_limit", "a whole number: greatest island that solver direct takes", "bodies, or contacts", set_direct_limit, get_direct_limit,
            "greater islands solved exactly, for time that grows with the cube"),
        choice_dial<&S::escalation, kEscalation>("escalation",
            "auto gives more substeps, or the direct solver, to islands whose load is too much for their contacts; off leaves them to fall"),
        number_dial("penalty_stiffness", "auto (from mass and dt, within the stability limit), or a number", "N/m",
            set_amount<&S::penalty_stiffness, kLeastStiffness>, get_amount<&S::penalty_stiffness>,
            "stiffer leaves less overlap and needs a shorter step"),
        number_dial("penalty_damping", "auto (from mass, dt and restitution, within the stability limit), or a number", "N s/m",
            set_amount<&S::penalty_damping, kLeastDamping>, get_amount<&S::penalty_damping>,
            "more damping bounces less and needs a shorter step"),
        choice_dial<&S::friction_cone, kFrictionCone>("friction_cone",
            "the cone is the same in every direction; the pyramid is the classic of other engines, holds up to 1.41 too much and bends paths"),
        choice_dial<&S::impact_law, kImpactLaw>("impact_law",
            "sequential passes an impact along one pair at a time; simultaneous shares it, for a joint solve"),
        choice_dial<&S::overlap, kOverlap>("overlap",
            "backing up or subdividing the step avoids overlap, and repeats work at every impact"),
        whole_dial<&S::halvings, 1, 20>("halvings", "auto (12), or a whole number from 1 to 20", "of a substep at most",
            "overlap subdivide: each halves the overlap that is left where bodies meet fast, for two more tries a meeting"),
        choice_dial<&S::toi_method, kToiMethod>("toi_method",
            "time alone: none is ever late; newton asks least, bisection a bit at a time, conservative often where two graze"),
        number_dial("toi_tolerance", "a number from 1e-12 (float: 1.2e-7) to 0.02", "of the smallest half extent", set_toi_tolerance, get_number<&S::toi_tolerance>,
            "a smaller tolerance finds the moment of touch more exactly, for more evaluations"),
        named_dial("sleep", kSleep, set_sleep, get_sleep,
            "bodies at rest cost nothing while asleep; off follows the slowest creep"),
        choice_dial<&S::partial_rest, kPartialRest>("partial_rest",
            "on lets each body that is quiet rest while others of its heap go on, at no cost, until what it bears changes by rest_force"),
        number_dial("rest_force", "a number from 1e-6 to 1", "of what a body bears", set_rest_force, get_number<&S::rest_force>,
            "partial_rest on: a greater change is not felt by who rests, and fewer wake"),
        choice_dial<&S::effects, kEffects>("effects",
            "auto leaves the gyroscopic torque out of bodies, and rolling friction out of islands that sleep soon, as long as bodies are off by less than effects_error for it"),
        number_dial("effects_error", "a number from 0 to 1", "of the radius in 0.1 s, and rad", set_effects_error, get_number<&S::effects_error>,
            "effects auto: a greater error leaves out more"),
    };
    // clang-format on
}

}  // namespace

std::span<const Dial> dials()
{
    static const std::vector<Dial> table = make_dials();
    return table;
}

const Dial* find_dial(std::string_view name)
{
    for (const Dial& dial : dials())
        if (dial.name == name) return &dial;
    return nullptr;
}

std::string set_dial(Settings& settings, std::string_view name, std::string_view value)
{
    if (const Dial* dial = find_dial(name)) {
        const std::string trouble = dial->set(settings, value);
        return trouble.empty() ? trouble : std::string(name) + ": " + trouble;
    }
    std::vector<std::string_view> names;
    for (const Dial& dial : dials()) names.push_back(dial.name);
    const std::string near = nearest_names(name, names);
    const std::string plain = in_quotes(name);
    return plain.substr(1, plain.size() - 2) + ": wanted the name of a dial"
        + (near.empty() ? ", one of: " + either_of(names) : ", perhaps " + near);
}

std::string dial_value(const Settings& settings, std::string_view name)
{
    const Dial* dial = find_dial(name);
    return dial ? dial->get(settings) : std::string();
}

double parse_time(std::string_view text)
{
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) return parse_number(text);
    const double above = parse_number(text.substr(0, slash));
    const double below = parse_number(text.substr(slash + 1));
    const double time = above / below;
    return std::isfinite(time) ? time : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace throng
