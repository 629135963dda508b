#include "pipeline/step/effects.hpp"

#include "pipeline/step/parameters.hpp"

#include <algorithm>
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
    "events",
    "sensors",
};
static_assert(std::size(kNames) == kEffects);

// Decides, effect by effect, and names who calls where that is asked.
class Search {
public:
    Search(const EffectFacts& facts, const EffectCensus& census, bool names)
        : facts_(facts), census_(census), names_(names)
    { }

    Effects run()
    {
        for (int i = 0; i < kEffects; ++i)
            if (const std::string& who = facts_.requests.first[static_cast<std::size_t>(i)];
                !who.empty())
                call(static_cast<Effect>(i), [&] { return who; });
        find_motion();
        if (found_.on.has(Effect::motion)) find_forces();
        find_contact();
        // Nobody is held at what he may not touch, nor who is carried from touch to touch.
        if (!found_.on.has(Effect::contact)) found_.on.remove(Effect::fast_motion);
        if (meets()) find_materials();
        find_rotation();
        const Settings& settings = facts_.bodies.settings;
        if (found_.on.has(Effect::contact) && (settings.sleep || rests_by_force(settings)))
            call_if(Effect::sleeping, Call::dynamic);
        return std::move(found_);
    }

private:
    template <class Who>
    void call(Effect effect, const Who& who)
    {
        if (found_.on.has(effect) || facts_.left_out.has(effect)) return;
        found_.on.add(effect);
        if (names_) found_.cause[static_cast<std::size_t>(effect)] = who();
    }
    void call_if(Effect effect, Call by)
    {
        if (census_.any(by)) call(effect, [&] { return name(census_.first(by)); });
    }
    std::string name(std::size_t body) const
    {
        const bool named = body < facts_.body_names.size() && !facts_.body_names[body].empty();
        return "body " + std::to_string(body) + (named ? " " + facts_.body_names[body] : "");
    }
    bool meets() const { return found_.on.has(Effect::contact) || found_.on.meets(kEventDriven); }
    // How bodies meet: overlapping, or carried from touch to touch (see step_event_driven.cpp).
    Effect contact_effect() const
    {
        const Settings& settings = facts_.bodies.settings;
        const bool carries = settings.response == Response::impulse;
        if (settings.overlap == Overlap::allow || !carries) return Effect::contact;
        return settings.overlap == Overlap::back_up ? Effect::no_overlap : Effect::little_overlap;
    }

    void find_motion()
    {
        if (!census_.any(Call::motion)) return;
        call_if(Effect::motion, Call::motion);
        if (!facts_.bodies.gravity.isZero(0) && census_.any(Call::falls))
            call(Effect::gravity, [] { return "gravity of the scene"; });
        if (!facts_.prescribed.body.empty())
            call(Effect::drive, [&] { return name(facts_.prescribed.body.front()); });
        call_if(Effect::fast_motion, Call::fast);
    }

    void find_forces()
    {
        const Forces& forces = facts_.bodies.forces;
        if (forces.field) call(Effect::forces, [] { return "force field of the program"; });
        call_if(Effect::forces, Call::forces);
        call_if(Effect::drag, Call::drag);
        call_if(Effect::pivot, Call::pivot);
        if (!forces.springs.empty()) call(Effect::springs, [] { return "spring 0"; });
        if (!forces.attractors.empty()) call(Effect::attractors, [] { return "attractor 0"; });
        if (!forces.wind.isZero(0)) call(Effect::wind, [] { return "wind of the scene"; });
    }

    void find_contact()
    {
        for (const auto& [x, a] : census_.kinds())
            for (const auto& [y, b] : census_.kinds()) {
                if ((x.first & y.second) == 0 || (y.first & x.second) == 0) continue;
                if (a.dynamic == 0 || b.bodies < (x == y ? 2u : 1u)) continue;
                const Effect how = contact_effect();
                call(how, [&, &one = x, &other = y] { return names_of(one, other); });
                if (how == Effect::contact) find_surfaces();
                return;
            }
    }
    // The first that can be pushed of one kind, and the first other one of another.
    std::string names_of(const EffectCensus::KindKey& x, const EffectCensus::KindKey& y) const
    {
        const auto first = [&](const EffectCensus::KindKey& key, const auto& wanted) {
            std::uint32_t body = 0;
            while (!EffectCensus::is_of(key, body, facts_.bodies) || !wanted(body)) ++body;
            return body;
        };
        const std::uint32_t a =
            first(x, [&](std::uint32_t body) { return facts_.bodies.states.dynamic(body); });
        const std::uint32_t b = first(y, [&](std::uint32_t body) { return body != a; });
        return name(a) + " may touch " + name(b);
    }

    void find_surfaces()
    {
        call_if(Effect::mesh_contact, Call::mesh_contact);
        call_if(Effect::voxel_contact, Call::voxel_contact);
        call_if(Effect::sphere_contact, Call::sphere_contact);
        call_if(Effect::image_contact, Call::image_contact);
        if (census_.has_seams()) call_if(Effect::seams, Call::rimmed_seam);
    }

    // Of materials that nothing tells apart, the first.
    template <class Wanted>
    std::vector<std::uint32_t> distinct(const Wanted& wanted) const
    {
        const Surfaces& surfaces = facts_.surfaces;
        std::set<std::uint32_t> overridden;
        for (const auto& entry : surfaces.overrides) overridden.insert({entry.a, entry.b});
        std::set<std::tuple<double, double, double>> seen;
        std::vector<std::uint32_t> first;
        for (const auto& [i, use] : census_.materials())
            if (wanted(use)
                && (overridden.count(i) != 0
                    || seen.insert({surfaces.friction[i], surfaces.restitution[i],
                                    surfaces.rolling_friction[i]})
                           .second))
                first.push_back(i);
        return first;
    }

    void find_materials()
    {
        using Material = EffectCensus::Material;
        const std::vector<std::uint32_t> others = distinct([](const Material&) { return true; });
        for (const std::uint32_t a :
             distinct([](const Material& use) { return use.on_dynamic > 0; }))
            for (const std::uint32_t b : others) {
                const auto combined = facts_.surfaces.between(a, b);
                const auto call_for = [&](bool called, Effect effect) {
                    if (called)
                        call(effect, [&] {
                            return "materials " + facts_.material_names[a] + " and "
                                + facts_.material_names[b];
                        });
                };
                call_for(combined.friction > 0, Effect::friction);
                call_for(combined.rolling_friction > 0, Effect::rolling_friction);
                call_for(combined.restitution > 0, Effect::restitution);
            }
    }

    // The first of those that turn by themselves, as they are touched, and by friction.
    void call_turning(Effect effect, Call by_itself, Call touched, Call rubbed)
    {
        std::uint32_t first = kNoBody;
        const auto look = [&](bool acts, Call by) {
            if (!acts || !census_.any(by)) return;
            // Without names anybody will do.
            first = std::min(first, names_ ? census_.first(by) : 0);
        };
        look(true, by_itself);
        look(meets(), touched);
        look(meets() && found_.on.has(Effect::friction), rubbed);
        if (first != kNoBody) call(effect, [&] { return name(first); });
    }
    void find_rotation()
    {
        call_turning(Effect::rotation, Call::turns, Call::turns_touched, Call::turns_rubbed);
        if (!found_.on.has(Effect::rotation)
            || facts_.bodies.settings.gyroscopic == Gyroscopic::off)
            return;
        call_turning(Effect::gyroscopic, Call::uneven_turns, Call::uneven_turns_touched,
                     Call::uneven_turns_rubbed);
    }

    const EffectFacts& facts_;
    const EffectCensus& census_;
    bool names_;
    Effects found_;
};

}  // namespace

std::string_view name_of(Effect effect) { return kNames[static_cast<std::size_t>(effect)]; }

Set<Effect> effects_called_for(const EffectFacts& facts, const EffectCensus& census)
{
    return Search(facts, census, false).run().on;
}

Effects find_effects(const EffectFacts& facts, const EffectCensus& census)
{
    return Search(facts, census, true).run();
}

}  // namespace throng
