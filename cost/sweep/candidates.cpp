#include "cost/sweep/candidates.hpp"

#include "scene/names.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Of the scene's own dt.
constexpr double kSteps[] = {2, 1, 0.5, 0.25, 0.125, 0.0625};
constexpr std::string_view kSubsteps[] = {"1", "2", "4", "8", "16", "32"};

// A value worth a try by itself, and what calls for it: none for what any scene may have.
struct Try {
    Changes changes;
    Set<Effect> called_for_by;
};

const std::vector<Try>& tries()
{
    using enum Effect;
    static constexpr Set<Effect> kTouch = {contact};
    static constexpr Set<Effect> kTurns = {gyroscopic, forces, springs, attractors, pivot};
    static const std::vector<Try> all = {
        {{{"precision", "double"}}, {}},
        {{{"integrator", "semi_implicit"}}, kTurns},
        {{{"integrator", "midpoint"}}, kTurns},
        {{{"integrator", "splitting"}}, kTurns},
        {{{"integrator", "rk4"}}, kTurns},
        {{{"gyroscopic", "off"}}, {gyroscopic}},
        {{{"gyroscopic", "explicit"}}, {gyroscopic}},
        {{{"iterations", "2"}}, kTouch},
        {{{"iterations", "4"}}, kTouch},
        {{{"relax_iterations", "1"}}, kTouch},
        {{{"relax_iterations", "2"}}, kTouch},
        {{{"relax_iterations", "4"}}, kTouch},
        {{{"contact_rate", "0.1"}}, kTouch},
        {{{"contact_rate", "0.4"}}, kTouch},
        {{{"friction_at", "points"}}, {friction}},
        {{{"friction_cone", "pyramid"}}, {friction}},
        {{{"solver", "pgs"}}, kTouch},
        {{{"solver", "pgs"}, {"iterations", "60"}}, kTouch},
        {{{"solver", "direct"}}, kTouch},
        {{{"response", "penalty"}}, kTouch},
        {{{"response", "kinematic"}}, kTouch},
        {{{"overlap", "back_up"}}, kTouch},
        {{{"overlap", "subdivide"}}, kTouch},
        {{{"escalation", "off"}}, kTouch},
        {{{"narrowphase", "gjk"}}, kTouch},
        {{{"narrowphase", "sat"}}, kTouch},
        {{{"broadphase", "embree"}}, kTouch},
        {{{"broadphase", "grid"}}, kTouch},
        {{{"broadphase", "sweep"}}, kTouch},
        {{{"mesh_tree", "k_dop:14"}}, {mesh_contact}},
        {{{"nonconvex", "parts"}}, kSolidContact},
        {{{"nonconvex", "spheres"}}, kSolidContact},
        {{{"nonconvex", "depth_image"}}, kSolidContact},
        {{{"nonconvex", "hull"}}, kSolidContact},
    };
    return all;
}

// A fraction where the scene's own is one, so that it can be read.
std::string time_text(double seconds)
{
    Settings settings;
    settings.dt = seconds;
    return dial_value(settings, "dt");
}

bool does_something(const Scene& scene, const Changes& changes)
{
    Scene by;
    try {
        by = changed(scene, changes);
    } catch (const std::invalid_argument&) {
        return false;
    }
    by.dials_set.clear();
    for (const Change& each : changes) by.dials_set.push_back(each.dial);
    const auto is_the_same = [&](const Change& each) {
        return dial_value(scene.settings, each.dial) == dial_value(by.settings, each.dial);
    };
    return unused_dials(by).empty() && !std::all_of(changes.begin(), changes.end(), is_the_same);
}

// All of them are when none is named.
bool asked_for(std::string_view dial, std::span<const std::string> dials)
{
    return dials.empty() || std::find(dials.begin(), dials.end(), dial) != dials.end();
}

// Other steps, other numbers of substeps, and both at once.
std::vector<Changes> steps_for(const Scene& scene, std::span<const std::string> dials)
{
    std::vector<Changes> steps;
    const auto add = [&](const Changes& changes) {
        if (does_something(scene, changes)) steps.push_back(changes);
    };
    for (const double share : kSteps) {
        if (share != 1 && !asked_for("dt", dials)) continue;
        const Change dt{"dt", time_text(share * scene.settings.dt)};
        bool own = false;
        for (const std::string_view substeps : kSubsteps) {
            if (!asked_for("substeps", dials)) continue;
            const Change cut{"substeps", std::string(substeps)};
            add(share == 1 ? Changes{cut} : Changes{dt, cut});
            own = own || dial_value(scene.settings, "substeps") == substeps;
        }
        if (share != 1 && !own) add({dt});
    }
    return steps;
}

}  // namespace

std::vector<std::string_view> swept_dials()
{
    std::vector<std::string_view> names = {"dt", "substeps"};
    for (const Try& each : tries())
        if (std::find(names.begin(), names.end(), each.changes.front().dial) == names.end())
            names.push_back(each.changes.front().dial);
    return names;
}

Candidates
candidates_for(const Scene& scene, const Effects& effects, std::span<const std::string> dials)
{
    Candidates candidates;
    candidates.steps = steps_for(scene, dials);
    for (const Try& each : tries()) {
        if (!asked_for(each.changes.front().dial, dials)) continue;
        if (!each.called_for_by.empty() && !each.called_for_by.meets(effects.on)) continue;
        if (does_something(scene, each.changes)) candidates.others.push_back(each.changes);
    }
    return candidates;
}

}  // namespace throng
