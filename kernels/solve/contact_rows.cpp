#include "kernels/solve/contact_rows.hpp"

namespace throng {

namespace {

template <class Real>
void put3(const Vec3T<Real>& v, std::size_t lane, Lane16<Real> (&to)[3])
{
    for (int k = 0; k < 3; ++k) to[k].at[lane] = v[k];
}

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
            int points,
            int lane_at,
            LooseBlock<Real>& loose)
{
    const auto lane = static_cast<std::size_t>(lane_at);
    put3(contact.normal, lane, loose.normal);
    put3(contact.between, lane, loose.between);
    put3(contact.friction, lane, loose.held);
    put3(contact.rolling, lane, loose.rolling);
    loose.twist.at[lane] = contact.twist;
    loose.round_a.at[lane] = contact.round_a;
    loose.round_b.at[lane] = contact.round_b;
    loose.friction.at[lane] = terms.friction;
    loose.restitution.at[lane] = terms.restitution;
    loose.rolling_friction.at[lane] = terms.rolling_friction;
    loose.bias_rate.at[lane] = terms.softness.bias_rate;
    loose.impulse_scale.at[lane] = terms.softness.impulse_scale;
    loose.deep.at[lane] = terms.deep;
    static const typename Contact<Real>::Point kNone;
    for (int k = 0; k < points; ++k) {
        const bool there = k < contact.count;
        const auto& from = there ? contact.points[static_cast<std::size_t>(k)] : kNone;
        auto& to = loose.point[k];
        to.there.at[lane] = there ? 1 : 0;
        put3(from.from_a, lane, to.from_a);
        to.separation.at[lane] = from.separation;
        to.impulse.at[lane] = from.impulse;
    }
}

template <class Real>
void loosen_nothing(int points, int lane, LooseBlock<Real>& loose)
{
    Contact<Real> nothing;
    nothing.count = 1;
    loosen(nothing, {}, points, lane, loose);
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
    template void loosen<Real>(const Contact<Real>&, const ContactTerms<Real>&, int, int,          \
                               LooseBlock<Real>&);                                                 \
    template void loosen_nothing<Real>(int, int, LooseBlock<Real>&);                               \
    template void store_impulses<Real>(const RowsView<Real>&, std::size_t, int, Contact<Real>&);   \
    template void carry_impulses<Real>(const Contact<Real>&, Real, Contact<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
