#include "pipeline/step/effect_census.hpp"

#include "pipeline/step/fast_bodies.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::uint32_t kCounted = 1u << kCalls;

constexpr auto bit = EffectCensus::bit;

Call contact_of(SolidRepresentation way)
{
    return way == SolidRepresentation::spheres    ? Call::sphere_contact
        : way == SolidRepresentation::depth_image ? Call::image_contact
                                                  : Call::voxel_contact;
}

// What a body calls for, as bits.
class BodyCalls {
public:
    BodyCalls(std::uint32_t body, const BodyFacts& facts)
        : body_(body), facts_(facts), dynamic_(facts.states.dynamic(body))
    { }

    std::uint32_t find()
    {
        if (facts_.states.kind[body_] == BodyKind::removed) return 0;
        calls_ = kCounted;
        call_if(dynamic_, Call::dynamic);
        find_colliders();
        if (!dynamic_ && facts_.states.kind[body_] != BodyKind::kinematic) return calls_;
        call_if(true, Call::motion);
        call_if(can_fall(), Call::falls);
        call_if(is_fast(), Call::fast);
        if (dynamic_) find_forces();
        find_turning();
        return calls_;
    }

private:
    void call_if(bool calls, Call call)
    {
        if (calls) calls_ |= bit(call);
    }

    void find_colliders()
    {
        const Colliders& colliders = facts_.colliders;
        for (std::uint32_t k = 0; k < colliders.count[body_]; ++k) {
            const ShapeRef shape = colliders.shape[colliders.begin[body_] + k];
            call_if(shape.kind == ShapeKind::mesh, Call::mesh_contact);
            if (shape.kind == ShapeKind::solid)
                call_if(true, contact_of(facts_.shapes.solids[shape.index].representation));
            // Planes alone have no rims.
            call_if((!dynamic_ || colliders.count[body_] > 1) && shape.kind != ShapeKind::plane,
                    Call::rimmed_seam);
        }
    }

    // Who hangs on a pivot falls about it, unless it is held by its center.
    bool can_fall() const
    {
        if (facts_.masses.inverse_mass[body_] > 0) return true;
        const Forces& forces = facts_.forces;
        return forces.on_pivot(body_) && !forces.pivot_to_center[body_].isZero(0)
            && facts_.masses.inverse_inertia[body_] != Sym3{};
    }

    bool is_fast() const
    {
        const double dt = facts_.settings.dt;
        const double falls = dynamic_ ? facts_.gravity.norm() * dt * dt : 0;
        return facts_.colliders.count[body_] > 0
            && is_fast_candidate(facts_.colliders, facts_.velocities, body_, dt, falls);
    }

    void find_forces()
    {
        const Forces& forces = facts_.forces;
        const auto acts = [&](const auto& list, const auto& is_none) {
            return body_ < list.size() && !is_none(list[body_]);
        };
        const auto zero = [](const Vec3& v) { return v.isZero(0); };
        const auto none = [](double x) { return !(x > 0); };
        call_if(acts(forces.force, zero) || acts(forces.torque, zero), Call::forces);
        call_if(acts(forces.linear_drag, none) || acts(forces.angular_drag, none), Call::drag);
        call_if(forces.on_pivot(body_), Call::pivot);
    }

    void find_turning()
    {
        const bool free = facts_.masses.inverse_inertia[body_] != Sym3{};
        const bool touches = free && facts_.colliders.count[body_] > 0;
        const bool by_itself =
            !facts_.velocities.angular[body_].isZero(0) || (free && facts_.forces.turn(body_));
        // A ball about its own center is turned by friction alone; anything else by any touch.
        const bool touched =
            touches && (facts_.colliders.shape_bits[body_] & Colliders::kOffCenter) != 0;
        call_if(by_itself, Call::turns);
        call_if(touched, Call::turns_touched);
        call_if(touches, Call::turns_rubbed);
        if (facts_.masses.inertia_kind[body_] == 0) return;
        call_if(by_itself, Call::uneven_turns);
        call_if(touched, Call::uneven_turns_touched);
        call_if(touches, Call::uneven_turns_rubbed);
    }

    std::uint32_t body_;
    const BodyFacts& facts_;
    bool dynamic_;
    std::uint32_t calls_ = 0;
};

EffectCensus::KindKey kind_of(std::uint32_t body, const BodyFacts& facts)
{
    const std::uint32_t first = facts.colliders.begin[body];
    return {facts.filter.group[first], facts.filter.mask[first]};
}

}  // namespace

std::uint32_t EffectCensus::first(Call call) const
{
    const auto calls = [&](std::uint32_t bits) { return (bits & bit(call)) != 0; };
    const auto found = std::find_if(calls_.begin(), calls_.end(), calls);
    return found == calls_.end() ? kNoBody : static_cast<std::uint32_t>(found - calls_.begin());
}

std::size_t EffectCensus::count_any(std::initializer_list<Call> calls) const
{
    std::uint32_t wanted = 0;
    for (const Call call : calls) wanted |= bit(call);
    return static_cast<std::size_t>(std::count_if(
        calls_.begin(), calls_.end(), [&](std::uint32_t bits) { return (bits & wanted) != 0; }));
}

bool EffectCensus::is_of(const KindKey& key, std::uint32_t body, const BodyFacts& facts)
{
    return facts.states.kind[body] != BodyKind::removed && facts.colliders.count[body] > 0
        && kind_of(body, facts) == key;
}

// As it was counted in, so that what is counted out is the same.
void EffectCensus::count(std::uint32_t body, bool in, const BodyFacts& facts)
{
    const std::uint32_t calls = calls_[body];
    if ((calls & kCounted) == 0) return;
    const auto change = [&](std::size_t& number, std::size_t by = 1) {
        // Nobody, one and several are told apart.
        const std::size_t before = std::min<std::size_t>(number, 2);
        number = in ? number + by : number - by;
        if (before != std::min<std::size_t>(number, 2)) ++changes_;
    };
    for (std::size_t i = 0; i < kCalls; ++i)
        if ((calls >> i & 1) != 0) change(counts_[i]);
    const std::uint32_t colliders = facts.colliders.count[body];
    if (colliders == 0) return;
    const bool dynamic = (calls & bit(Call::dynamic)) != 0;
    Kind& kind = kinds_[kind_of(body, facts)];
    change(kind.bodies);
    if (dynamic) change(kind.dynamic);
    if (kind.bodies == 0) kinds_.erase(kind_of(body, facts));
    if (!dynamic || colliders > 1) change(unpushed_, colliders * (dynamic ? 2u : 1u));
    for (std::uint32_t k = 0; k < colliders; ++k) {
        const std::uint32_t name = facts.colliders.material[facts.colliders.begin[body] + k];
        Material& material = materials_[name];
        change(material.colliders);
        if (dynamic) change(material.on_dynamic);
        if (material.colliders == 0) materials_.erase(name);
    }
}

void EffectCensus::recount(std::uint32_t body, const BodyFacts& facts)
{
    if (calls_.size() <= body) calls_.resize(body + std::size_t{1}, 0);
    const std::uint32_t calls = BodyCalls(body, facts).find();
    if (calls == calls_[body]) return;
    count(body, false, facts);
    calls_[body] = calls;
    count(body, true, facts);
}

void EffectCensus::forget(std::uint32_t body, const BodyFacts& facts)
{
    if (calls_.size() <= body) return;
    count(body, false, facts);
    calls_[body] = 0;
}

void EffectCensus::count_all(const BodyFacts& facts)
{
    const std::size_t changes = changes_ + 1;
    *this = {};
    changes_ = changes;
    for (std::uint32_t body = 0; body < facts.states.kind.size(); ++body) recount(body, facts);
}

}  // namespace throng
