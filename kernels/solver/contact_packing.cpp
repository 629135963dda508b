#include "kernels/solver/contact_packing.hpp"

#include <cstddef>
#include <limits>

namespace throng {

template <class Real>
Softness<Real> softness(double rate, double damping_ratio, double substep)
{
    const double omega = 2 * 3.14159265358979323846 * rate;
    const double a1 = 2 * damping_ratio + substep * omega;
    const double a2 = substep * omega * a1;
    const double a3 = 1 / (1 + a2);
    return {static_cast<Real>(omega / a1), static_cast<Real>(a3)};
}

template <class Real>
void pack_contact(const Contact<Real>& contact,
                  const ContactParameters<Real>& terms,
                  int lane_at,
                  PackedContacts<Real>& packed)
{
    using Of = Contact<Real>;
    using Point = typename Of::Point;
    constexpr std::size_t kNumber = sizeof(Real);
    static_assert(offsetof(Of, normal) == contact_numbers::kNormal * kNumber
                  && offsetof(Of, center_offset) == contact_numbers::kCenterOffset * kNumber
                  && offsetof(Of, friction) == contact_numbers::kFriction * kNumber
                  && offsetof(Of, rolling) == contact_numbers::kRolling * kNumber
                  && offsetof(Of, round_a) == contact_numbers::kRoundA * kNumber
                  && offsetof(Of, round_b) == contact_numbers::kRoundB * kNumber
                  && offsetof(Of, torsional_impulse) == contact_numbers::kTorsionalImpulse * kNumber
                  && offsetof(Of, points) == contact_numbers::kPoints * kNumber
                  && sizeof(Point) == contact_numbers::kPoint * kNumber
                  && offsetof(Point, anchor_a) == contact_numbers::kAnchorA * kNumber
                  && offsetof(Point, separation) == contact_numbers::kSeparation * kNumber
                  && offsetof(Point, impulse) == contact_numbers::kImpulse * kNumber
                  && sizeof(Of) == contact_numbers::kAll * kNumber);
    const auto lane = static_cast<std::size_t>(lane_at);
    packed.contact[lane] = contact.normal.data();
    packed.count.at[lane] = static_cast<Real>(contact.count);
    packed.friction.at[lane] = terms.friction;
    packed.restitution.at[lane] = terms.restitution;
    packed.rolling_friction.at[lane] = terms.rolling_friction;
    packed.bias_rate.at[lane] = terms.softness.bias_rate;
    packed.impulse_scale.at[lane] = terms.softness.impulse_scale;
    packed.deep.at[lane] = terms.deep;
    packed.on_rim.at[lane] = terms.on_rim ? Real(1) : Real(0);
}

template <class Real>
void pack_empty_lane(int lane, PackedContacts<Real>& packed)
{
    static const Contact<Real> kNothing = [] {
        Contact<Real> nothing;
        nothing.count = 1;
        return nothing;
    }();
    pack_contact(kNothing, {}, lane, packed);
}

template <class Real>
void pack_unclamped_friction(const Contact<Real>& contact,
                             int lane_at,
                             ContactConstraintWide<Real>& block)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    const Vec3T<Real> tangent = vector_at(block.tangent, lane);
    const Vec3T<Real> other = contact.normal.cross(tangent);
    block.friction_impulse[0].at[lane] = tangent.dot(contact.friction);
    block.friction_impulse[1].at[lane] = other.dot(contact.friction);
}

template <class Real>
void store_impulses(const ContactConstraintsView<Real>& constraints,
                    std::size_t place,
                    int lane_at,
                    Contact<Real>& contact)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    const ContactConstraintWide<Real>& block = constraints.blocks[place];
    for (int k = 0; k < contact.count; ++k)
        contact.points[static_cast<std::size_t>(k)].impulse =
            constraints.points[block.first_point + static_cast<std::uint32_t>(k)].impulse.at[lane];
    const Vec3T<Real> tangent = vector_at(block.tangent, lane);
    const Vec3T<Real> other = contact.normal.cross(tangent);
    contact.friction =
        tangent * block.friction_impulse[0].at[lane] + other * block.friction_impulse[1].at[lane];
    contact.torsional_impulse = block.torsional_impulse.at[lane];
    if (constraints.rolling_frictions == nullptr) return;
    const Vec3T<Real> rolling = vector_at(constraints.rolling_frictions[place].impulse, lane);
    contact.rolling = tangent * rolling.x() + other * rolling.y() + contact.normal * rolling.z();
}

template <class Real>
Vec3T<Real>
impact_impulse(const ContactConstraints<Real>& constraints, std::size_t place, int lane_at)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    const ContactConstraintWide<Real>& block = constraints.blocks[place];
    const Vec3T<Real> normal = vector_at(block.normal, lane),
                      tangent = vector_at(block.tangent, lane);
    const Vec3T<Real> given = vector_at(constraints.restitutions[place].impulse, lane);
    return normal * given.x() + tangent * given.y() + normal.cross(tangent) * given.z();
}

template <class Real>
void scale_impulses(Real scale, Contact<Real>& contact)
{
    for (auto& point : contact.points) point.impulse *= scale;
    contact.friction *= scale;
    contact.torsional_impulse *= scale;
    contact.rolling *= scale;
}

// Cosine of the angle up to which a contact is with the same face as before.
template <class Real>
constexpr Real kSameFace = Real(0.97);

// What a point bore that is there no more goes to the nearest of those that are new: else the body
// would sink there, be thrown back, and sink where it lies on the other one.
template <class Real>
void pass_on(const typename Contact<Real>::Point& from,
             Real scale,
             unsigned& is_new,
             Contact<Real>& contact)
{
    std::size_t nearest = 0;
    Real least = std::numeric_limits<Real>::max();
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
        if ((is_new >> k & 1u) == 0) continue;
        const Real distance2 = (contact.points[k].anchor_a - from.anchor_a).squaredNorm();
        if (distance2 >= least) continue;
        least = distance2;
        nearest = k;
    }
    is_new &= ~(1u << nearest);
    contact.points[nearest].impulse = from.impulse * scale;
}

template <class Real>
void carry_impulses(const Contact<Real>& before, Real scale, Contact<Real>& contact)
{
    bool any = false;
    bool taken[4] = {};
    unsigned is_new = (1u << contact.count) - 1u;
    for (int k = 0; k < contact.count; ++k) {
        auto& point = contact.points[static_cast<std::size_t>(k)];
        for (int old = 0; old < before.count; ++old) {
            const auto& from = before.points[static_cast<std::size_t>(old)];
            if (taken[old] || from.feature != point.feature) continue;
            taken[old] = true;
            is_new &= ~(1u << k);
            point.impulse = from.impulse * scale;
            any = any || point.impulse > 0;
            break;
        }
    }
    // Of another face whatever was borne is over.
    if (is_new != 0 && before.normal.dot(contact.normal) > kSameFace<Real>)
        for (int old = 0; old < before.count && is_new != 0; ++old) {
            const auto& from = before.points[static_cast<std::size_t>(old)];
            if (taken[old] || !(from.impulse > 0)) continue;
            pass_on(from, scale, is_new, contact);
            any = true;
        }
    if (!any) return;
    contact.friction =
        scale * (before.friction - contact.normal * contact.normal.dot(before.friction));
    // A single point holds no twist, and would never let go of one.
    if (contact.count > 1) contact.torsional_impulse = before.torsional_impulse * scale;
    contact.rolling = before.rolling * scale;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template Softness<Real> softness<Real>(double, double, double);                                \
    template void pack_contact<Real>(const Contact<Real>&, const ContactParameters<Real>&, int,    \
                                     PackedContacts<Real>&);                                       \
    template void pack_empty_lane<Real>(int, PackedContacts<Real>&);                               \
    template void pack_unclamped_friction<Real>(const Contact<Real>&, int,                         \
                                                ContactConstraintWide<Real>&);                     \
    template void store_impulses<Real>(const ContactConstraintsView<Real>&, std::size_t, int,      \
                                       Contact<Real>&);                                            \
    template Vec3T<Real> impact_impulse<Real>(const ContactConstraints<Real>&, std::size_t, int);  \
    template void scale_impulses<Real>(Real, Contact<Real>&);                                      \
    template void carry_impulses<Real>(const Contact<Real>&, Real, Contact<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
