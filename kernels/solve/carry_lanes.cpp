// Carried contacts: how those that a turning surface carries along slide by where they are now.
// Written once over the width of the machine's registers.
#include "kernels/solve/solve_lanes.hpp"

namespace throng::THRONG_LANES {

namespace {

// Turned for a time, by a rotation that is exact to the third order and one for any spin.
template <class L>
V3<L> turned_on(const V3<L>& arm, const V3<L>& spin, L time)
{
    using Real = typename L::Number;
    const V3<L> u = spin * (time * L(Real(0.5))), across = cross(u, arm);
    return arm + (across + cross(u, across)) * (L(Real(2)) / (L(Real(1)) + dot(u, u)));
}

// One side of W contacts: how it spins, and how far the middle of the substep finds its center, and
// what was at the contact as the step began.
template <class L>
struct Side {
    using Real = typename L::Number;
    V3<L> spin, center, material;

    Side(const SolverBody<Real>* bodies, const std::int32_t* index, const V3<L>& arm, L half)
    {
        const Motion<L, true> motion(bodies, index);
        const Drift<L, true> drift(bodies, index);
        const V3<L> now = arm + drift.change_of(arm);
        spin = motion.spin;
        center = drift.moved + motion.velocity * half;
        material = center + turned_on(now, spin, half) - arm;
    }
};

template <class L>
[[gnu::flatten]] void carry_lanes(const RowsView<typename L::Number>& rows,
                                  std::size_t place,
                                  int at,
                                  typename L::Number half)
{
    const auto& block = rows.blocks[place];
    auto& carried = rows.carries[place];
    const Frame<L, true> frame(block, at);
    // A round side is the same however it turns.
    const V3<L> core_a = frame.center_a - frame.normal * lane<L>(block.round_a, at);
    const V3<L> core_b = frame.center_b + frame.normal * lane<L>(block.round_b, at);
    const Side<L> a(rows.bodies, block.a + at, core_a, half);
    const Side<L> b(rows.bodies, block.b + at, core_b, half);
    const L by_a = lane<L>(carried.by_a, at), by_b = lane<L>(carried.by_b, at);
    const V3<L> contact = a.material * by_a + b.material * by_b;
    const V3<L> slip = cross(b.spin, contact - b.center) - cross(a.spin, contact - a.center);
    // Where nothing is carried the speed is what it was: of who walks, or none.
    const L acts = by_a + by_b;
    const auto carries = acts > L(typename L::Number(0));
    const auto tell = [&](const V3<L>& along, Lane16<typename L::Number>& speed) {
        select(carries, dot(along, slip) * acts, lane<L>(speed, at)).store(speed.at + at);
    };
    tell(frame.tangent, carried.speed[0]);
    tell(frame.other, carried.speed[1]);
}

}  // namespace

template <class Real>
void carry(const RowsView<Real>& rows, std::size_t begin, std::size_t end, Real half)
{
    for (std::size_t place = begin; place < end; ++place)
        for (int at = 0; at < kBlock; at += Lanes<Real>::kWidth)
            carry_lanes<Lanes<Real>>(rows, place, at, half);
}

template void carry<float>(const RowsView<float>&, std::size_t, std::size_t, float);
template void carry<double>(const RowsView<double>&, std::size_t, std::size_t, double);

}  // namespace throng::THRONG_LANES
