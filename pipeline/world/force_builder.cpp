#include "pipeline/world/force_builder.hpp"

#include "kernels/dynamics/integrators.hpp"
#include "kernels/dynamics/spring_limit.hpp"
#include "kernels/parallel/disjoint_sets.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace throng {

namespace {

// At a place of lists that all have it or none.
template <class... Lists>
void grow_lists(std::uint32_t body, Lists&... lists)
{
    const auto one = [&](auto& list, auto none) {
        if (list.size() <= body) list.resize(body + std::size_t{1}, none);
    };
    (one(lists, typename Lists::value_type(Lists::value_type::Zero())), ...);
}

void grow_lists(std::uint32_t body, std::vector<double>& a, std::vector<double>& b)
{
    for (auto* const list : {&a, &b})
        if (list->size() <= body) list->resize(body + std::size_t{1}, 0.0);
}

std::string spring_warning(std::size_t i, double limit, const Settings& settings)
{
    const std::string_view integrator = chosen(settings.integrator, true).name;
    const std::string who = "spring " + std::to_string(i) + ": ";
    if (limit <= 0)
        return who + std::string(integrator)
            + " makes it swing wider at any dt; take integrator=auto";
    const double span = settings.dt / settings.substeps;
    return who + "a substep of " + number_text(span) + " s is beyond " + number_text(limit)
        + " s, the longest at which " + std::string(integrator)
        + " keeps it from swinging wider; take substeps="
        + std::to_string(static_cast<int>(std::ceil(settings.dt / limit))) + " or more";
}

}  // namespace

void sort_springs(const BodyStates& states, Forces& forces)
{
    const std::size_t bodies = states.kind.size();
    forces.first_spring.assign(bodies + 1, 0);
    const auto count = [&](std::uint32_t body) {
        if (body != kNoBody) ++forces.first_spring[body + 1];
    };
    for (const SpringForce& spring : forces.springs) {
        count(spring.a);
        count(spring.b);
    }
    for (std::size_t i = 0; i < bodies; ++i) forces.first_spring[i + 1] += forces.first_spring[i];
    forces.spring_of.resize(forces.first_spring.back());
    std::vector<std::uint32_t> next(forces.first_spring.begin(), forces.first_spring.end() - 1);
    DisjointSets sets;
    sets.reset(bodies);
    for (std::uint32_t i = 0; i < forces.springs.size(); ++i) {
        const SpringForce& spring = forces.springs[i];
        for (const std::uint32_t body : {spring.a, spring.b}) {
            if (body == kNoBody) continue;
            forces.spring_of[next[body]++] = i;
            if (states.dynamic(body)) sets.add(body);
        }
        if (spring.a != kNoBody && spring.b != kNoBody && states.dynamic(spring.a)
            && states.dynamic(spring.b))
            sets.join(spring.a, spring.b);
    }
    forces.groups.clear();
    forces.group_of.assign(bodies, kNoBody);
    for (std::uint32_t body = 0; body < bodies; ++body) {
        if (!sets.holds(body)) continue;
        const std::uint32_t first = sets.find(body);
        if (first == body) {
            forces.group_of[body] = static_cast<std::uint32_t>(forces.groups.size());
            forces.groups.emplace_back();
        } else {
            forces.group_of[body] = forces.group_of[first];
        }
        forces.groups[forces.group_of[body]].push_back(body);
    }
}

void state_forces(std::uint32_t body,
                  const BodyDescription& stated,
                  const Vec3& center,
                  Forces& forces)
{
    if (!stated.force.isZero(0) || !stated.torque.isZero(0)) {
        grow_lists(body, forces.force, forces.torque);
        forces.force[body] = stated.force;
        forces.torque[body] = stated.torque;
    }
    if (stated.linear_drag != 0 || stated.angular_drag != 0) {
        grow_lists(body, forces.linear_drag, forces.angular_drag);
        forces.linear_drag[body] = stated.linear_drag;
        forces.angular_drag[body] = stated.angular_drag;
    }
    if (stated.pivot) {
        grow_lists(body, forces.pivot_to_center);
        forces.has_pivot.resize(forces.pivot_to_center.size(), 0);
        forces.pivot_to_center[body] = center - *stated.pivot;
        forces.has_pivot[body] = 1;
    }
}

void join_springs(std::span<const Spring> springs,
                  std::span<const std::uint32_t> ids,
                  std::span<const Vec3> center,
                  const BodyStates& states,
                  Forces& forces)
{
    const auto id = [&](std::uint32_t end) { return end == kNone ? kNoBody : ids[end]; };
    const auto lever_arm = [&](std::uint32_t body, const Vec3& at) {
        return body == kNoBody ? at : Vec3(at - center[body] - forces.pivot_to_center_of(body));
    };
    for (const Spring& stated : springs) {
        SpringForce spring{id(stated.a),     id(stated.b),   {},           {},
                           stated.stiffness, stated.damping, stated.length};
        spring.at_a = lever_arm(spring.a, stated.at_a);
        spring.at_b = lever_arm(spring.b, stated.at_b);
        forces.springs.push_back(spring);
    }
    if (!forces.springs.empty()) sort_springs(states, forces);
}

void drop_forces(std::span<const std::uint32_t> going, const BodyStates& states, Forces& forces)
{
    for (const std::uint32_t body : going) {
        for (auto* const list : {&forces.force, &forces.torque, &forces.pivot_to_center})
            if (body < list->size()) (*list)[body].setZero();
        if (body < forces.has_pivot.size()) forces.has_pivot[body] = 0;
        for (auto* const list : {&forces.linear_drag, &forces.angular_drag})
            if (body < list->size()) (*list)[body] = 0;
    }
    if (forces.springs.empty()) return;
    const auto goes = [&](std::uint32_t body) {
        return body != kNoBody && states.kind[body] == BodyKind::removed;
    };
    std::erase_if(forces.springs,
                  [&](const SpringForce& spring) { return goes(spring.a) || goes(spring.b); });
    sort_springs(states, forces);
}

std::vector<std::string>
unstable_springs(const Forces& forces, const Masses& masses, const Settings& settings)
{
    // Then they go by a rule that bears any step: see pipeline/forces/state_dependent_forces.hpp.
    // Among penalty forces the step is cut for them.
    if (bears_stiff_springs(settings.integrator)) return {};
    const IntegratorRow& integrator = chosen(settings.integrator, true);
    const double span = settings.dt / settings.substeps;
    std::map<double, double> limits;  // by damping ratio: springs are mostly alike
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < forces.springs.size(); ++i) {
        const SpringForce& spring = forces.springs[i];
        const SpringLoad load =
            spring_load(forces, masses, spring.a) + spring_load(forces, masses, spring.b);
        if (!(load.square > 0)) continue;
        const double frequency = std::sqrt(load.square), ratio = damping_ratio(load);
        const auto [known, fresh] = limits.try_emplace(ratio, 0.0);
        if (fresh) known->second = stable_span(integrator, ratio);
        const double limit = known->second / frequency;
        if (span > limit) warnings.push_back(spring_warning(i, limit, settings));
    }
    return warnings;
}

}  // namespace throng
