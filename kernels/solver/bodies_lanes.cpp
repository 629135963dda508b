// Solver bodies through a substep, written once over the width of the machine's registers.
#include "kernels/math/gyroscopic_theta.hpp"
#include "kernels/solver/solve_lanes.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

namespace throng::THRONG_LANES {

namespace {

constexpr std::int32_t kInOrder[kBlock] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// The symmetric inertia of W bodies, as a share of its trace.
template <class L>
struct Inertia {
    L xx, yy, zz, xy, xz, yz;
    V3<L> operator*(const V3<L>& w) const
    {
        return {xx * w.x + xy * w.y + xz * w.z, xy * w.x + yy * w.y + yz * w.z,
                xz * w.x + yz * w.y + zz * w.z};
    }
};

// before / after, where before = after + lost. The loss is told apart, and no more of it made up
// for than is left: of the least moments of a needle rounding may leave nothing but the loss.
template <class L>
L gained_back(L before, L after, L lost)
{
    using Real = typename L::Number;
    // Squares of a spin that is none.
    const L least = std::numeric_limits<Real>::min() * Real(1e6);
    const auto falls = lost > L(Real(0));
    return (select(falls, after + min(lost, after), before) + least)
        / (select(falls, after, before - lost) + least);
}

// One Newton step of the Euler equation of a free top, which then has its momentum back
// or, where that is less, its energy; see after_gyroscopic_torque().
template <class L>
V3<L> after_implicit(const Inertia<L>& inertia, const V3<L>& w, L time)
{
    using Real = typename L::Number;
    const V3<L> m = inertia * w;
    const V3<L> residual = cross(w, m) * time;
    const L ahead = time * gyroscopic_theta(L(time * time * dot(w, w)));
    // Columns of inertia + ahead (w x inertia - m x).
    const V3<L> column_x{inertia.xx, inertia.xy, inertia.xz};
    const V3<L> column_y{inertia.xy, inertia.yy, inertia.yz};
    const V3<L> column_z{inertia.xz, inertia.yz, inertia.zz};
    const L zero = Real(0);
    const V3<L> x = column_x + (cross(w, column_x) - V3<L>{zero, m.z, -m.y}) * ahead;
    const V3<L> y = column_y + (cross(w, column_y) - V3<L>{-m.z, zero, m.x}) * ahead;
    const V3<L> z = column_z + (cross(w, column_z) - V3<L>{m.y, -m.x, zero}) * ahead;
    const V3<L> yz = cross(y, z);
    const L determinant = dot(x, yz);
    const L sound = abs(determinant);
    const L inverse = L(Real(1)) / select(sound > zero, determinant, L(Real(1)));
    const V3<L> change =
        V3<L>{dot(residual, yz), dot(residual, cross(z, x)), dot(residual, cross(x, y))} * inverse;
    const V3<L> m_change = inertia * change;
    const V3<L> m_after = m - m_change, both = m + m_after;
    V3<L> after = w - change;
    const L energy = dot(w, m), energy_after = dot(after, m_after);
    const L kept = gained_back(dot(m, m), dot(m_after, m_after), dot(m_change, both));
    const L allowed = gained_back(energy, energy_after, dot(change, both));
    after = after * sqrt(min(kept, allowed));
    // Rounding may leave nothing of the least moment of a needle, or squares of a spin may be past
    // all numbers: then it turns on as it did.
    const L there = select(energy > zero, sound, zero);
    const auto fine = select(energy_after < L(Real(1e38)), there, zero) > zero;
    return {select(fine, after.x, w.x), select(fine, after.y, w.y), select(fine, after.z, w.z)};
}

// Euler's equation, one explicit step.
template <class L>
V3<L> after_explicit(const Inertia<L>& inertia, const V3<L>& w, L time)
{
    using Real = typename L::Number;
    const V3<L> torque = cross(w, inertia * w);
    const V3<L> x{inertia.xx, inertia.xy, inertia.xz}, y{inertia.xy, inertia.yy, inertia.yz},
        z{inertia.xz, inertia.yz, inertia.zz};
    const V3<L> yz = cross(y, z);
    const L determinant = dot(x, yz), zero = Real(0);
    const L inverse = select(abs(determinant) > zero, time / determinant, zero);
    return w - V3<L>{dot(torque, yz), dot(torque, cross(z, x)), dot(torque, cross(x, y))} * inverse;
}

// What a body that is symmetric about an axis does in axes that follow it (see spin_frame): its
// spin across goes round the axis at the rate of its spin about it, times the moment about it over
// that across. Exact but for the sine, which comes of a quotient: it gains nothing however fast.
template <class L>
V3<L> after_precession(const V3<L>& axis, L share, const V3<L>& w, L time)
{
    using Real = typename L::Number;
    const L about = dot(axis, w), most = Real(2);
    const V3<L> along = axis * about, across = w - along;
    // tan(x) of half the angle as p / q, good to a thousandth up to a right angle.
    const L x = max(min(share * about * time * L(Real(0.5)), most), -most);
    const L p = x * (L(Real(15)) - x * x), q = L(Real(15)) - x * x * L(Real(6));
    const L inverse = L(Real(1)) / (q * q + p * p);
    const L cosine = (q * q - p * p) * inverse, sine = p * q * L(Real(2)) * inverse;
    return along + across * cosine + cross(axis, across) * sine;
}

template <class Mask, class L>
V3<L> chosen(Mask first, const V3<L>& a, const V3<L>& b)
{
    return {select(first, a.x, b.x), select(first, a.y, b.y), select(first, a.z, b.z)};
}

// The GyroscopicInertia of W bodies.
template <class L>
struct Spinning {
    L share[8], axis[8];

    explicit Spinning(const GyroscopicInertia<typename L::Number>* inertias)
    {
        gather_8(inertias->share, 16, kInOrder, share);
        gather_8(inertias->axis, 16, kInOrder, axis);
    }
    auto acts() const { return share[6] > L(typename L::Number(0)); }
    auto symmetric() const { return axis[3] > L(typename L::Number(0)); }
    V3<L> own_axis() const { return {axis[0], axis[1], axis[2]}; }
};

// In axes that go with the body, in which the inertia stays what it was.
template <class L>
V3<L> gyroscopic(const Spinning<L>& of, const V3<L>& w, const Substep<typename L::Number>& substep)
{
    using Real = typename L::Number;
    const Inertia<L> inertia{of.share[0], of.share[1], of.share[2],
                             of.share[3], of.share[4], of.share[5]};
    const L time = substep.time;
    if (substep.gyroscopic != Substep<Real>::Gyroscopic::implicit)
        return chosen(of.acts(), after_explicit(inertia, w, time), w);
    const V3<L> after = chosen(of.symmetric(), after_precession(of.own_axis(), of.axis[3], w, time),
                               after_implicit(inertia, w, time));
    return chosen(of.acts(), after, w);
}

template <class Real>
constexpr int kStride = int(sizeof(SolverBody<Real>) / sizeof(Real));

// Stops every body whose velocity is no longer a number, or beyond what products of it can hold,
// and marks it: it stands still for the rest of the step, so that what touches it stays sound.
template <class Real>
void stop_runaways(SolverBody<Real>* bodies, int count)
{
    constexpr Real kGreatest = Real(1e16);
    // Hardly ever is there one: eight numbers at a time tell of all bodies that none is.
    Real lost[8] = {};
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < 8; ++k)
            lost[k] += std::abs(bodies[i].motion[k]) < kGreatest ? Real(0) : Real(1);
    Real any = 0;
    for (const Real each : lost) any += each;
    if (!(any > 0)) return;
    for (int i = 0; i < count; ++i) {
        SolverBody<Real>& body = bodies[i];
        bool sound = true;
        for (const Real number : body.motion)
            sound = sound && number < kGreatest && number > -kGreatest;
        if (sound) continue;
        for (int k = 0; k < 8; ++k) body.motion[k] = body.inertia[k] = body.free[k] = 0;
        body.delta_pose[3] = 1;
    }
}

template <class L>
[[gnu::flatten]] void begin_lanes(SolverBody<typename L::Number>* bodies,
                                  const GyroscopicInertia<typename L::Number>* inertias,
                                  unsigned writes,
                                  const Substep<typename L::Number>& substep)
{
    using Real = typename L::Number;
    L motion[8], free[8], inertia[8];
    gather_bodies(bodies->motion, kInOrder, motion);
    gather_bodies(bodies->free, kInOrder, free);
    gather_bodies(bodies->inertia, kInOrder, inertia);
    const L zero = Real(0);
    L given[8];
    for (int k = 0; k < 8; ++k) given[k] = substep.first ? zero : motion[k] - free[k];
    const L falls = select(inertia[0] > zero, L(Real(1)), zero);
    for (int k = 0; k < 3; ++k) motion[k] += falls * L(substep.gravity[k]);
    if (inertias != nullptr) {
        const V3<L> spin =
            gyroscopic(Spinning<L>(inertias), {motion[4], motion[5], motion[6]}, substep);
        motion[4] = spin.x;
        motion[5] = spin.y;
        motion[6] = spin.z;
    }
    scatter_8(motion, bodies->free, kStride<Real>, kInOrder, writes);
    for (int k = 0; k < 8; ++k) motion[k] += given[k];
    scatter_8(motion, bodies->motion, kStride<Real>, kInOrder, writes);
}

// The quaternion of a turn by a rotation vector, as a series that is exact to double below a
// quarter radian.
template <class L>
void small_turn(const V3<L>& turn, L squared, V3<L>& axis, L& w)
{
    using Real = typename L::Number;
    const L z = squared * L(Real(0.25)), one = Real(1);  // of the half angle
    const auto share = [](int k) { return L(Real(1) / Real(k)); };
    const L scale =
        (one - z * share(6) * (one - z * share(20) * (one - z * share(42) * (one - z * share(72)))))
        * L(Real(0.5));
    w = one
        - z * share(2)
            * (one
               - z * share(12)
                   * (one - z * share(30) * (one - z * share(56) * (one - z * share(90)))));
    axis = turn * scale;
}

// A rotation of W bodies as a quaternion.
template <class L>
struct Turn {
    V3<L> axis;
    L w;

    Turn operator*(const Turn& q) const
    {
        return {q.axis * w + axis * q.w + cross(axis, q.axis), w * q.w - dot(axis, q.axis)};
    }
};

template <class L>
Turn<L> small_turn(const V3<L>& turn)
{
    Turn<L> by;
    small_turn(turn, dot(turn, turn), by.axis, by.w);
    return by;
}

// Turned on by a vector in the axes of spin_frame().
template <class L>
Turn<L> turned_along(const Spinning<L>& of, const Turn<L>& before, const V3<L>& turn)
{
    using Real = typename L::Number;
    const Turn<L> taken{{of.axis[4], of.axis[5], of.axis[6]}, of.axis[7]};
    const Turn<L> since = before * Turn<L>{{-taken.axis.x, -taken.axis.y, -taken.axis.z}, taken.w};
    const V3<L> own = of.own_axis(), now = turned(since.axis, since.w, own);
    const V3<L> about = own * dot(own, turn), none{L(Real(0)), L(Real(0)), L(Real(0))};
    const V3<L> across = ShortestTurn<L>(own, now) * (turn - about);
    const V3<L> first = chosen(of.acts(), chosen(of.symmetric(), across, none), turn);
    const V3<L> last = chosen(of.acts(), chosen(of.symmetric(), about, turn), none);
    return small_turn(first) * since * small_turn(last) * taken;
}

template <class L>
[[gnu::flatten]] L advance_lanes(SolverBody<typename L::Number>* bodies,
                                 const GyroscopicInertia<typename L::Number>* inertias,
                                 unsigned writes,
                                 typename L::Number time,
                                 bool turns)
{
    using Real = typename L::Number;
    const L zero = Real(0), one = Real(1);
    L motion[8], delta_pose[8];
    gather_bodies(bodies->motion, kInOrder, motion);
    gather_bodies(bodies->delta_pose, kInOrder, delta_pose);
    for (int k = 0; k < 3; ++k) delta_pose[k] += motion[k] * L(time);
    L fast = zero;
    if (turns) {
        const V3<L> turn{motion[4] * L(time), motion[5] * L(time), motion[6] * L(time)};
        const L squared = dot(turn, turn);
        const auto slow = squared < L(Real(kFastTurn * kFastTurn));
        fast = select(slow, zero, one);
        const Turn<L> before{{delta_pose[4], delta_pose[5], delta_pose[6]}, delta_pose[7]};
        const auto [axis, w] = inertias == nullptr
            ? small_turn(turn) * before
            : turned_along(Spinning<L>(inertias), before, turn);
        const L length = sqrt(dot(axis, axis) + w * w);
        const L shrink = one / length;
        // Who does not turn keeps its very bits.
        const auto turned = select(squared > zero, one - fast, zero) > zero;
        delta_pose[4] = select(turned, axis.x * shrink, delta_pose[4]);
        delta_pose[5] = select(turned, axis.y * shrink, delta_pose[5]);
        delta_pose[6] = select(turned, axis.z * shrink, delta_pose[6]);
        delta_pose[7] = select(turned, w * shrink, delta_pose[7]);
    }
    scatter_8(delta_pose, bodies->delta_pose, kStride<Real>, kInOrder, writes);
    return fast;
}

// Calls wide(first) for each group of as many bodies as a register holds, and one(first) for each
// that is over: the narrow formula has the same bits.
template <class Real, class Wide, class One>
void for_bodies(std::size_t count, Wide wide, One one)
{
    constexpr std::size_t kWidth = Lanes<Real>::kWidth;
    std::size_t i = 0;
    for (; i + kWidth <= count; i += kWidth) wide(i);
    for (; i < count; ++i) one(i);
}

constexpr std::size_t kTogether = 128;  // bodies that are looked through for few

// Room for some of a kind, which costs nothing until they are there.
template <class T, std::size_t most>
class Room {
public:
    T* data() { return std::launder(reinterpret_cast<T*>(bytes_)); }
    const T& operator[](std::size_t i) { return data()[i]; }
    void put(std::size_t i, const T& one)
    {
        std::construct_at(reinterpret_cast<T*>(bytes_ + i * sizeof(T)), one);
    }

private:
    alignas(T) std::byte bytes_[most * sizeof(T)];
};

// Copies of few bodies among others, side by side.
template <class Real>
class Few {
public:
    // Of those on whom a gyroscopic torque acts. False where they are not few.
    bool take(const SolverBody<Real>* bodies,
              const GyroscopicInertia<Real>* inertias,
              const std::uint8_t* precesses,
              std::size_t count)
    {
        for (std::size_t first = 0; first < count; first += 8) {
            std::uint64_t eight = 0;  // of these bytes, each 0 or 1
            std::memcpy(&eight, precesses + first, std::min<std::size_t>(8, count - first));
            for (; eight != 0; eight &= eight - 1) {
                if (2 * (count_ + 1) > count) return false;
                from_[count_++] = first + static_cast<std::size_t>(std::countr_zero(eight)) / 8;
            }
        }
        for (std::size_t k = 0; k < count_; ++k) put(k, bodies[from_[k]], inertias[from_[k]]);
        return true;
    }
    // Calls run(bodies, inertias, how many) with them, and one of them again to fill the lanes.
    template <class Run>
    void run(Run run)
    {
        if (count_ == 0) return;
        std::size_t filled = count_;
        for (; filled % std::size_t{Lanes<Real>::kWidth} != 0; ++filled)
            put(filled, bodies_[0], inertias_[0]);
        run(bodies_.data(), inertias_.data(), filled);
    }
    void put_back(SolverBody<Real>* bodies)
    {
        for (std::size_t k = 0; k < count_; ++k) bodies[from_[k]] = bodies_[k];
    }

private:
    void put(std::size_t at, const SolverBody<Real>& body, const GyroscopicInertia<Real>& inertia)
    {
        bodies_.put(at, body);
        inertias_.put(at, inertia);
    }

    static constexpr std::size_t kMost = kTogether / 2 + kBlock;
    std::size_t count_ = 0;
    std::size_t from_[kMost];
    Room<SolverBody<Real>, kMost> bodies_;
    Room<GyroscopicInertia<Real>, kMost> inertias_;
};

// Calls run(bodies, inertias or null, how many) for all, and sums what it returns; before that for
// those on whom a gyroscopic torque acts by themselves, where they are few.
template <class Real, class Run>
std::size_t for_inertias(SolverBody<Real>* bodies,
                         const GyroscopicInertia<Real>* inertias,
                         const std::uint8_t* precesses,
                         std::size_t count,
                         Run run)
{
    constexpr const GyroscopicInertia<Real>* kNone = nullptr;
    if (inertias == nullptr || precesses == nullptr) return run(bodies, inertias, count);
    std::size_t sum = 0;
    for (std::size_t at = 0; at < count; at += kTogether) {
        const std::size_t some = std::min(kTogether, count - at);
        Few<Real> few;
        if (few.take(bodies + at, inertias + at, precesses + at, some)) {
            few.run(run);
            sum += run(bodies + at, kNone, some);
            few.put_back(bodies + at);
        } else {
            sum += run(bodies + at, inertias + at, some);
        }
    }
    return sum;
}

}  // namespace

template <class Real>
void begin_substep(SolverBody<Real>* bodies,
                   const GyroscopicInertia<Real>* inertias,
                   const std::uint8_t* precesses,
                   std::size_t count,
                   const Substep<Real>& substep)
{
    using L = Lanes<Real>;
    using One = Wide<Real, 1>;
    for_inertias(
        bodies, inertias, precesses, count, [&](auto* some, auto* of, std::size_t how_many) {
            const auto at = [&](std::size_t i) { return of == nullptr ? nullptr : of + i; };
            for_bodies<Real>(
                how_many,
                [&](std::size_t i) {
                    stop_runaways(some + i, L::kWidth);
                    begin_lanes<L>(some + i, at(i), ~0u, substep);
                },
                [&](std::size_t i) {
                    stop_runaways(some + i, 1);
                    begin_lanes<One>(some + i, at(i), 1u, substep);
                });
            return std::size_t{0};
        });
}

template <class Real>
std::size_t advance(SolverBody<Real>* bodies,
                    const GyroscopicInertia<Real>* inertias,
                    const std::uint8_t* precesses,
                    std::size_t count,
                    Real time,
                    bool turns)
{
    using L = Lanes<Real>;
    using One = Wide<Real, 1>;
    return for_inertias(
        bodies, inertias, precesses, count, [&](auto* some, auto* of, std::size_t how_many) {
            std::size_t fast = 0;
            const auto tally = [&](auto lanes) {
                for (int k = 0; k < decltype(lanes)::kWidth; ++k) fast += lanes.get(k) > 0 ? 1 : 0;
            };
            const auto at = [&](std::size_t i) { return of == nullptr ? nullptr : of + i; };
            for_bodies<Real>(
                how_many,
                [&](std::size_t i) { tally(advance_lanes<L>(some + i, at(i), ~0u, time, turns)); },
                [&](std::size_t i) {
                    tally(advance_lanes<One>(some + i, at(i), 1u, time, turns));
                });
            return fast;
        });
}

template void begin_substep<float>(SolverBody<float>*,
                                   const GyroscopicInertia<float>*,
                                   const std::uint8_t*,
                                   std::size_t,
                                   const Substep<float>&);
template void begin_substep<double>(SolverBody<double>*,
                                    const GyroscopicInertia<double>*,
                                    const std::uint8_t*,
                                    std::size_t,
                                    const Substep<double>&);
template std::size_t advance<float>(SolverBody<float>*,
                                    const GyroscopicInertia<float>*,
                                    const std::uint8_t*,
                                    std::size_t,
                                    float,
                                    bool);
template std::size_t advance<double>(SolverBody<double>*,
                                     const GyroscopicInertia<double>*,
                                     const std::uint8_t*,
                                     std::size_t,
                                     double,
                                     bool);

}  // namespace throng::THRONG_LANES
