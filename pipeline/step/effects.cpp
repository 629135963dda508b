#include "pipeline/step/effects.hpp"

#include "broadphase/pair_filter.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "pipeline/step/fast_bodies.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <vector>

namespace throng {

namespace {

// In the order of the enumeration.
constexpr std::string_view kNames[] = {
    "motion",
    "gravity",
    "forces",
    "drive",
    "rotation",
    "gyroscopic",
    "contact",
    "no overlap",
    "little overlap",
    "friction",
    "rolling friction",
    "restitution",
    "fast motion",
    "mesh contact",
    "voxel contact",
    "sphere contact",
    "image contact",
    "seams",
    "springs",
    "attractors",
    "wind",
    "drag",
    "pivot",
    "sleeping",
    "escalation",
};
static_assert(std::size(kNames) == kEffects);

class Search {
public:
    explicit Search(const EffectFacts& facts) : facts_(facts) { }

    Effects run()
    {
        for (int i = 0; i < kEffects; ++i)
            if (const std::string& who = facts_.requests.first[static_cast<std::size_t>(i)];
                !who.empty())
                call(static_cast<Effect>(i), who);
        find_motion();
        if (found_.on.has(Effect::motion)) find_forces();
        find_contact();
        if (meets()) find_materials();
        find_rotation();
        if (found_.on.has(Effect::contact) && facts_.settings.sleep)
            if (const auto body =
                    first_body([&](std::size_t b) { return facts_.states.dynamic(b); });
                body != kNoBody)
                call(Effect::sleeping, name(body));
        return std::move(found_);
    }

private:
    void call(Effect effect, std::string who)
    {
        if (found_.on.has(effect)) return;
        found_.on.add(effect);
        found_.cause[static_cast<std::size_t>(effect)] = std::move(who);
    }
    std::string name(std::size_t body) const
    {
        const bool named = body < facts_.body_names.size() && !facts_.body_names[body].empty();
        return "body " + std::to_string(body) + (named ? " " + facts_.body_names[body] : "");
    }
    template <class Predicate>
    std::uint32_t first_body(Predicate wanted) const
    {
        for (std::uint32_t body = 0; body < facts_.states.kind.size(); ++body)
            if (wanted(body)) return body;
        return kNoBody;
    }
    bool movable(std::size_t body) const
    {
        return facts_.states.kind[body] == BodyKind::dynamic
            || facts_.states.kind[body] == BodyKind::kinematic;
    }
    bool meets() const { return found_.on.has(Effect::contact) || found_.on.meets(kEventDriven); }
    bool has_contact(std::size_t body) const { return meets() && facts_.colliders.count[body] > 0; }
    // How bodies meet: overlapping, or carried from touch to touch (see step_event_driven.cpp).
    Effect contact_effect() const
    {
        const Settings& settings = facts_.settings;
        if (settings.overlap == Overlap::allow || !carries()) return Effect::contact;
        return settings.overlap == Overlap::back_up ? Effect::no_overlap : Effect::little_overlap;
    }
    bool carries() const { return facts_.settings.response == Response::impulse; }

    // Who hangs on a pivot falls about it, unless it is held by its center.
    bool can_fall(std::size_t body) const
    {
        if (!movable(body)) return false;
        if (facts_.masses.inverse_mass[body] > 0) return true;
        const Forces& forces = facts_.forces;
        return forces.on_pivot(body) && !forces.pivot_to_center[body].isZero(0)
            && facts_.masses.inverse_inertia[body] != Sym3{};
    }

    void find_motion()
    {
        const auto moving = first_body([&](std::size_t body) { return movable(body); });
        if (moving == kNoBody) return;
        call(Effect::motion, name(moving));
        const auto falls = first_body([&](std::size_t body) { return can_fall(body); });
        if (!facts_.gravity.isZero(0) && falls != kNoBody)
            call(Effect::gravity, "gravity of the scene");
        if (!facts_.prescribed.body.empty())
            call(Effect::drive, name(facts_.prescribed.body.front()));
        const double dt = facts_.settings.dt;
        const auto fast = first_body([&](std::size_t body) {
            if (!movable(body) || facts_.colliders.count[body] == 0) return false;
            const Vec3& gravity = facts_.gravity;
            const double fall = facts_.states.dynamic(body) ? gravity.norm() * dt * dt : 0;
            return is_fast_candidate(facts_.colliders, facts_.velocities, body, dt, fall);
        });
        if (fast != kNoBody) call(Effect::fast_motion, name(fast));
    }

    void find_forces()
    {
        const Forces& forces = facts_.forces;
        if (forces.field) call(Effect::forces, "force field of the program");
        const auto call_for = [&](Effect effect, std::size_t size, auto acts) {
            if (size == 0) return;
            const auto body = first_body(
                [&](std::size_t b) { return b < size && facts_.states.dynamic(b) && acts(b); });
            if (body != kNoBody) call(effect, name(body));
        };
        call_for(Effect::forces, forces.force.size(), [&](std::size_t b) {
            return !forces.force[b].isZero(0) || !forces.torque[b].isZero(0);
        });
        call_for(Effect::drag, forces.linear_drag.size(), [&](std::size_t b) {
            return forces.linear_drag[b] > 0 || forces.angular_drag[b] > 0;
        });
        call_for(Effect::pivot, forces.has_pivot.size(),
                 [&](std::size_t b) { return forces.on_pivot(b); });
        if (!forces.springs.empty()) call(Effect::springs, "spring 0");
        if (!forces.attractors.empty()) call(Effect::attractors, "attractor 0");
        if (!forces.wind.isZero(0)) call(Effect::wind, "wind of the scene");
    }

    // Filters know groups and masks: bodies of one group and mask are alike.
    struct Kind {
        std::uint32_t first = kNoBody, second = kNoBody;  // bodies
        std::uint32_t dynamic = kNoBody;                  // first dynamic one
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Kind> find_kinds() const
    {
        std::map<std::pair<std::uint32_t, std::uint32_t>, Kind> kinds;
        for (std::uint32_t i = 0; i < facts_.colliders.size(); ++i) {
            const std::uint32_t body = facts_.colliders.body[i];
            if (body == kNoBody) continue;
            Kind& kind = kinds[{facts_.filter.group[i], facts_.filter.mask[i]}];
            if (kind.first == kNoBody)
                kind.first = body;
            else if (kind.second == kNoBody && kind.first != body)
                kind.second = body;
            if (kind.dynamic == kNoBody && facts_.states.dynamic(body)) kind.dynamic = body;
        }
        return kinds;
    }

    void find_contact()
    {
        const auto kinds = find_kinds();
        for (const auto& [x, a] : kinds)
            for (const auto& [y, b] : kinds) {
                if ((x.first & y.second) == 0 || (y.first & x.second) == 0) continue;
                if (a.dynamic == kNoBody) continue;
                const std::uint32_t other = b.first != a.dynamic ? b.first : b.second;
                if (other == kNoBody) continue;
                const Effect how = contact_effect();
                call(how, name(a.dynamic) + " may touch " + name(other));
                // Nobody is swept who is carried from touch to touch.
                if (how != Effect::contact)
                    found_.on.remove(Effect::fast_motion);
                else {
                    find_surfaces();
                    find_seams();
                }
                return;
            }
    }

    void find_surfaces()
    {
        for (std::uint32_t i = 0; i < facts_.colliders.size(); ++i) {
            if (facts_.colliders.body[i] == kNoBody) continue;
            const ShapeRef shape = facts_.colliders.shape[i];
            if (shape.kind == ShapeKind::mesh)
                call(Effect::mesh_contact, name(facts_.colliders.body[i]));
            if (shape.kind == ShapeKind::solid)
                call(effect_of(facts_.shapes.solids[shape.index].representation),
                     name(facts_.colliders.body[i]));
        }
    }
    // Two colliders of what is not pushed, which may lie flush, or two of one body; planes alone
    // have no rims.
    void find_seams()
    {
        std::uint32_t unpushed = 0, rimmed = kNoBody;
        for (std::uint32_t i = 0; i < facts_.colliders.size(); ++i) {
            const std::uint32_t body = facts_.colliders.body[i];
            if (body == kNoBody) continue;
            const bool dynamic = facts_.states.dynamic(body);
            if (dynamic && facts_.colliders.count[body] < 2) continue;
            unpushed += dynamic ? 2 : 1;
            if (rimmed == kNoBody && facts_.colliders.shape[i].kind != ShapeKind::plane)
                rimmed = body;
            if (unpushed > 1 && rimmed != kNoBody) return call(Effect::seams, name(rimmed));
        }
    }
    static Effect effect_of(SolidRepresentation way)
    {
        return way == SolidRepresentation::spheres    ? Effect::sphere_contact
            : way == SolidRepresentation::depth_image ? Effect::image_contact
                                                      : Effect::voxel_contact;
    }

    // Of materials that nothing tells apart, the first.
    std::vector<std::uint32_t> distinct(const std::set<std::uint32_t>& materials) const
    {
        const Surfaces& surfaces = facts_.surfaces;
        std::set<std::uint32_t> overridden;
        for (const auto& entry : surfaces.overrides) overridden.insert({entry.a, entry.b});
        std::set<std::tuple<double, double, double>> seen;
        std::vector<std::uint32_t> first;
        for (const std::uint32_t i : materials)
            if (overridden.count(i) != 0
                || seen.insert({surfaces.friction[i], surfaces.restitution[i],
                                surfaces.rolling_friction[i]})
                       .second)
                first.push_back(i);
        return first;
    }

    void find_materials()
    {
        std::set<std::uint32_t> on_dynamic, on_any;
        for (std::uint32_t i = 0; i < facts_.colliders.size(); ++i) {
            const std::uint32_t body = facts_.colliders.body[i];
            if (body == kNoBody) continue;
            on_any.insert(facts_.colliders.material[i]);
            if (facts_.states.dynamic(body)) on_dynamic.insert(facts_.colliders.material[i]);
        }
        const std::vector<std::uint32_t> others = distinct(on_any);
        for (const std::uint32_t a : distinct(on_dynamic))
            for (const std::uint32_t b : others) {
                const auto combined = facts_.surfaces.between(a, b);
                const auto call_if = [&](bool called, Effect effect) {
                    if (!called || found_.on.has(effect)) return;
                    call(effect,
                         "materials " + facts_.material_names[a] + " and "
                             + facts_.material_names[b]);
                };
                call_if(combined.friction > 0, Effect::friction);
                call_if(combined.rolling_friction > 0, Effect::rolling_friction);
                call_if(combined.restitution > 0, Effect::restitution);
            }
    }

    bool turned_by_forces(std::uint32_t body) const
    {
        const Forces& forces = facts_.forces;
        if (forces.field || forces.on_pivot(body)) return true;
        if (body < forces.torque.size() && !forces.torque[body].isZero(0)) return true;
        if (body + std::size_t{1} >= forces.first_spring.size()) return false;
        for (std::uint32_t k = forces.first_spring[body]; k < forces.first_spring[body + 1]; ++k) {
            const SpringForce& spring = forces.springs[forces.spring_of[k]];
            if (!(spring.a == body ? spring.at_a : spring.at_b).isZero(0)) return true;
        }
        return false;
    }

    // A ball about its own center is turned by friction alone; anything else by any touch.
    bool can_be_turned(std::size_t body) const
    {
        if (!movable(body)) return false;
        if (!facts_.velocities.angular[body].isZero(0)) return true;
        const Sym3& inverse = facts_.masses.inverse_inertia[body];
        if (inverse == Sym3{}) return false;
        if (turned_by_forces(static_cast<std::uint32_t>(body))) return true;
        if (!has_contact(body)) return false;
        if (found_.on.has(Effect::friction)) return true;
        for (std::uint32_t k = 0; k < facts_.colliders.count[body]; ++k) {
            const std::uint32_t collider = facts_.colliders.begin[body] + k;
            if (facts_.colliders.shape[collider].kind != ShapeKind::sphere
                || !facts_.colliders.local[collider].position.isZero(0))
                return true;
        }
        return false;
    }

    void find_rotation()
    {
        const auto turns = first_body([&](std::size_t body) { return can_be_turned(body); });
        if (turns == kNoBody) return;
        call(Effect::rotation, name(turns));
        if (facts_.settings.gyroscopic == Gyroscopic::off) return;
        const auto uneven = first_body([&](std::size_t body) {
            return facts_.masses.gyroscopic_kind[body] != 0 && can_be_turned(body);
        });
        if (uneven != kNoBody) call(Effect::gyroscopic, name(uneven));
    }

    const EffectFacts& facts_;
    Effects found_;
};

}  // namespace

std::string_view name_of(Effect effect) { return kNames[static_cast<std::size_t>(effect)]; }

Effects find_effects(const EffectFacts& facts) { return Search(facts).run(); }

}  // namespace throng
