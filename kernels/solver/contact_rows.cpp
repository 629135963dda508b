#include "kernels/solver/contact_rows.hpp"

#include <cstddef>

namespace throng {

namespace {

template <class Real>
Vec3T<Real> get3(const Lane16<Real> (&from)[3], std::size_t lane)
{
    return {from[0].at[lane], from[1].at[lane], from[2].at[lane]};
}

}  // namespace

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
void loosen(const Contact<Real>& contact,
            const ContactTerms<Real>& terms,
            int lane_at,
            LooseBlock<Real>& loose)
{
    using Of = Contact<Real>;
    using Point = typename Of::Point;
    constexpr std::size_t kNumber = sizeof(Real);
    static_assert(offsetof(Of, normal) == contact_numbers::kNormal * kNumber
                  && offsetof(Of, between) == contact_numbers::kBetween * kNumber
                  && offsetof(Of, friction) == contact_numbers::kFriction * kNumber
                  && offsetof(Of, rolling) == contact_numbers::kRolling * kNumber
                  && offsetof(Of, round_a) == contact_numbers::kRoundA * kNumber
                  && offsetof(Of, round_b) == contact_numbers::kRoundB * kNumber
                  && offsetof(Of, twist) == contact_numbers::kTwist * kNumber
                  && offsetof(Of, points) == contact_numbers::kPoints * kNumber
                  && sizeof(Point) == contact_numbers::kPoint * kNumber
                  && offsetof(Point, from_a) == contact_numbers::kFromA * kNumber
                  && offsetof(Point, separation) == contact_numbers::kSeparation * kNumber
                  && offsetof(Point, impulse) == contact_numbers::kImpulse * kNumber
                  && sizeof(Of) == contact_numbers::kAll * kNumber);
    const auto lane = static_cast<std::size_t>(lane_at);
    loose.contact[lane] = contact.normal.data();
    loose.count.at[lane] = static_cast<Real>(contact.count);
    loose.friction.at[lane] = terms.friction;
    loose.restitution.at[lane] = terms.restitution;
    loose.rolling_friction.at[lane] = terms.rolling_friction;
    loose.bias_rate.at[lane] = terms.softness.bias_rate;
    loose.impulse_scale.at[lane] = terms.softness.impulse_scale;
    loose.deep.at[lane] = terms.deep;
}

template <class Real>
void loosen_nothing(int lane, LooseBlock<Real>& loose)
{
    static const Contact<Real> kNothing = [] {
        Contact<Real> nothing;
        nothing.count = 1;
        return nothing;
    }();
    loosen(kNothing, {}, lane, loose);
}

template <class Real>
void hold_uncut(const Contact<Real>& contact, int lane_at, ContactBlock<Real>& block)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    const Vec3T<Real> tangent = get3(block.tangent, lane);
    const Vec3T<Real> other = contact.normal.cross(tangent);
    block.friction_impulse[0].at[lane] = tangent.dot(contact.friction);
    block.friction_impulse[1].at[lane] = other.dot(contact.friction);
}

template <class Real>
void store_impulses(const RowsView<Real>& rows,
                    std::size_t place,
                    int lane_at,
                    Contact<Real>& contact)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    const ContactBlock<Real>& block = rows.blocks[place];
    for (int k = 0; k < contact.count; ++k)
        contact.points[static_cast<std::size_t>(k)].impulse =
            rows.points[block.first_point + static_cast<std::uint32_t>(k)].impulse.at[lane];
    const Vec3T<Real> tangent = get3(block.tangent, lane);
    const Vec3T<Real> other = contact.normal.cross(tangent);
    contact.friction =
        tangent * block.friction_impulse[0].at[lane] + other * block.friction_impulse[1].at[lane];
    contact.twist = block.twist_impulse.at[lane];
    if (rows.rollings == nullptr) return;
    const Vec3T<Real> rolling = get3(rows.rollings[place].impulse, lane);
    contact.rolling = tangent * rolling.x() + other * rolling.y() + contact.normal * rolling.z();
}

template <class Real>
Vec3T<Real> impact_impulse(const Rows<Real>& rows, std::size_t place, int lane_at)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    const ContactBlock<Real>& block = rows.blocks[place];
    const Vec3T<Real> normal = get3(block.normal, lane), tangent = get3(block.tangent, lane);
    const Vec3T<Real> given = get3(rows.bounces[place].impulse, lane);
    return normal * given.x() + tangent * given.y() + normal.cross(tangent) * given.z();
}

template <class Real>
void scale_impulses(Real scale, Contact<Real>& contact)
{
    for (auto& point : contact.points) point.impulse *= scale;
    contact.friction *= scale;
    contact.twist *= scale;
    contact.rolling *= scale;
}

template <class Real>
void carry_impulses(const Contact<Real>& before, Real scale, Contact<Real>& contact)
{
    bool any = false;
    bool taken[4] = {};
    for (int k = 0; k < contact.count; ++k) {
        auto& point = contact.points[static_cast<std::size_t>(k)];
        for (int old = 0; old < before.count; ++old) {
            const auto& from = before.points[static_cast<std::size_t>(old)];
            if (taken[old] || from.feature != point.feature) continue;
            taken[old] = true;
            point.impulse = from.impulse * scale;
            any = any || point.impulse > 0;
            break;
        }
    }
    if (!any) return;
    contact.friction =
        scale * (before.friction - contact.normal * contact.normal.dot(before.friction));
    // A single point holds no twist, and would never let go of one.
    if (contact.count > 1) contact.twist = before.twist * scale;
    contact.rolling = before.rolling * scale;
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template Softness<Real> softness<Real>(double, double, double);                                \
    template void loosen<Real>(const Contact<Real>&, const ContactTerms<Real>&, int,               \
                               LooseBlock<Real>&);                                                 \
    template void loosen_nothing<Real>(int, LooseBlock<Real>&);                                    \
    template void hold_uncut<Real>(const Contact<Real>&, int, ContactBlock<Real>&);                \
    template void store_impulses<Real>(const RowsView<Real>&, std::size_t, int, Contact<Real>&);   \
    template Vec3T<Real> impact_impulse<Real>(const Rows<Real>&, std::size_t, int);                \
    template void scale_impulses<Real>(Real, Contact<Real>&);                                      \
    template void carry_impulses<Real>(const Contact<Real>&, Real, Contact<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
