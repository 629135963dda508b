#include "cost/sweep/candidates.hpp"

#include "scene/names.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace throng {

namespace {

// Of the scene's own dt.
constexpr double kSteps[] = {2, 1, 0.5, 0.25, 0.125, 0.0625};
constexpr std::string_view kSubsteps[] = {"1", "2", "4", "8", "16", "32"};

constexpr int kMostIterations = 64;

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
        // An exact solve is no more exact than its numbers: either alone shows nothing.
        {{{"solver", "direct"}, {"precision", "double"}}, kTouch},
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

bool is_step(const Change& change) { return change.dial == "dt" || change.dial == "substeps"; }

// Of a dial turned to what the scene has anyway, nothing.
void put(const Scene& scene, const Change& change, Changes& to)
{
    if (dial_value(scene.settings, change.dial) != change.value) to.push_back(change);
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

std::vector<Changes>
neighbors_of(const Scene& scene, const Changes& changes, std::span<const std::string> dials)
{
    constexpr double kFactors[] = {2, 1, 0.5};
    const Settings own = changed(scene, changes).settings;
    Changes others;
    std::remove_copy_if(changes.begin(), changes.end(), std::back_inserter(others), is_step);
    std::vector<Changes> all;
    const auto add = [&](const Changes& neighbor) {
        if (does_something(scene, neighbor)) all.push_back(neighbor);
    };
    for (const double longer : kFactors) {
        const double dt = own.dt * longer, share = dt / scene.settings.dt;
        const bool is_tried = share < 1.01 * kSteps[0] && share > 0.99 * *std::rbegin(kSteps);
        if (longer != 1 && (!is_tried || !asked_for("dt", dials))) continue;
        for (const double more : kFactors) {
            const std::string substeps = number_text(own.substeps * more);
            const bool is_known = std::find(std::begin(kSubsteps), std::end(kSubsteps), substeps)
                != std::end(kSubsteps);
            if (more != 1 && (!is_known || !asked_for("substeps", dials))) continue;
            if (longer == 1 && more == 1) continue;
            Changes steps;
            put(scene, {"dt", time_text(dt)}, steps);
            put(scene, {"substeps", substeps}, steps);
            add(joined(steps, others));
        }
    }
    for (const Change& other : others) {
        Changes fewer = changes;
        std::erase(fewer, other);
        add(fewer);
    }
    // Those that pgs has by itself are half as many at first.
    if (own.solver == Solver::pgs && own.iterations == 0 && asked_for("iterations", dials))
        add(joined(changes, {{"iterations", "10"}}));
    const auto turn = [&](std::string_view dial, int count) {
        const bool is_turned = std::any_of(others.begin(), others.end(),
                                           [&](const Change& each) { return each.dial == dial; });
        if (!is_turned) return;
        for (const int more : {2 * count, count / 2})
            if (more >= 1 && more <= kMostIterations)
                add(joined(changes, {{std::string(dial), std::to_string(more)}}));
    };
    turn("iterations", own.iterations);
    turn("relax_iterations", own.relax_iterations);
    return all;
}

}  // namespace throng
