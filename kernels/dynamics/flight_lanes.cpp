// Free flight, written once over the width of the machine's registers.
#include "kernels/dynamics/flight.hpp"
#include "kernels/math/gyroscopic_theta.hpp"
#include "kernels/simd/lane_rows.hpp"
#include "kernels/simd/lane_vectors.hpp"

namespace throng::THRONG_LANES {

namespace {

using L = Lanes<double>;
constexpr int kWidth = L::kWidth;

// Twice this much of a nutation in a substep wants more parts; its square. See free_rotation.cpp.
constexpr double kNodSquared = 0.01;
// Turns of a quarter radian and more in a substep want more terms than the series below have.
constexpr double kFastest = 0.0625;
// Less than the squares of any speed that can be told from nothing.
constexpr double kLeast = 1e-300;
// As much of anything as a step can hold, see holdable().
constexpr double kMost = 1e16;

// v turned by q, or back by it where `back` is -1.
void turn(const L (&q)[4], double back, const L (&v)[3], L (&out)[3])
{
    const V3<L> w = turned(V3<L>{q[0], q[1], q[2]} * L(back), q[3], V3<L>{v[0], v[1], v[2]});
    out[0] = w.x, out[1] = w.y, out[2] = w.z;
}

// Sine and cosine of an angle as series of its square that are exact to double up to half a turn of
// kFastest; the sine is over the angle.
void series(L squared, L& sine, L& cosine)
{
    const L one = 1.0;
    sine = one
        + squared
            * (L(-1.0 / 6)
               + squared * (L(1.0 / 120) + squared * (L(-1.0 / 5040) + squared * L(1.0 / 362880))));
    cosine = one
        + squared
            * (L(-1.0 / 2)
               + squared
                   * (L(1.0 / 24)
                      + squared
                          * (L(-1.0 / 720)
                             + squared * (L(1.0 / 40320) - squared * L(1.0 / 3628800)))));
}

// Angular velocity of W bodies in their own axes, which are principal ones.
struct Spin {
    L w[3], squares[3];
    L moment[3];
    L ratio[3];  // h (I3 - I2) / I1 and so on: how strongly the other two axes act on each
    L pair[3];   // products of two ratios, and twice that of all three
    L triple;
    L uneven;    // not 0 for those that precess
    L energy;    // twice
    L momentum;  // its square
    L time;      // s, of a substep
    L fastest;   // greatest square of a turn of one substep

    void square()
    {
        for (int k = 0; k < 3; ++k) squares[k] = w[k] * w[k];
    }
    // And what follows from the squares.
    void weigh()
    {
        L m[3];
        for (int k = 0; k < 3; ++k) m[k] = moment[k] * squares[k];
        energy = m[0] + m[1] + m[2] + L(kLeast);
        momentum = moment[0] * m[0] + moment[1] * m[1] + moment[2] * m[2] + L(kLeast);
    }
    void start(L unevenly, double h, bool precesses)
    {
        square();
        fastest = 0.0;
        uneven = unevenly;
        time = h;
        if (!precesses) return;
        for (int k = 0; k < 3; ++k) {
            const L difference = moment[(k + 2) % 3] - moment[(k + 1) % 3];
            ratio[k] = select(uneven > L(0.0), L(h) * difference / moment[k], L(0.0));
        }
        for (int k = 0; k < 3; ++k) pair[k] = ratio[(k + 1) % 3] * ratio[(k + 2) % 3];
        triple = L(2.0) * ratio[0] * pair[0];
        weigh();
    }

    // One Newton step of w' = w - h w" x I w" / I, w" at theta of the time, its 3x3 system solved
    // by hand: with r the ratios the matrix is 1 on the diagonal and r1 w3, r1 w2 and so on, times
    // theta, beside it. Then its momentum back or, where that is less, its energy; see
    // after_gyroscopic_torque().
    void precess()
    {
        const L theta = gyroscopic_theta(L((squares[0] + squares[1] + squares[2]) * (time * time)));
        const L theta2 = theta * theta, product = w[0] * w[1] * w[2];
        const L determinant = L(1.0) + triple * product * (theta2 * theta)
            - (pair[0] * squares[0] + pair[1] * squares[1] + pair[2] * squares[2]) * theta2;
        const L inverse = L(1.0) / determinant;
        L change[3];
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            const L across = w[i] * w[j] * (L(1.0) + pair[k] * squares[k] * theta2);
            const L along = w[k] * (ratio[i] * squares[j] + ratio[j] * squares[i]) * theta;
            // Nothing at all for those that spin evenly, not even a zero of another sign.
            change[k] = select(uneven > L(0.0), ratio[k] * inverse * (across - along), L(0.0));
        }
        for (int k = 0; k < 3; ++k) w[k] -= change[k];
        square();
        const L had = energy, went = momentum;
        weigh();
        const L squared = min(went / momentum, had / energy);
        const L scale = select(uneven > L(0.0), sqrt(squared), L(1.0));
        for (L& speed : w) speed = speed * scale;
        square();
        energy = energy * squared;
        momentum = momentum * squared;
    }

    // q turned by w for a substep: half the angle's sine over itself, and cosine, as series that
    // are exact to double up to kFastest.
    void turn_on(double h, L (&q)[4])
    {
        const L squared = (squares[0] + squares[1] + squares[2]) * L(h * h);
        fastest = max(squared, fastest);
        L sine, cosine;
        series(squared * L(0.25), sine, cosine);
        const L scale = sine * L(0.5 * h);
        const L x = w[0] * scale, y = w[1] * scale, s = w[2] * scale;
        const L before[4] = {q[0], q[1], q[2], q[3]};
        q[0] = before[3] * x + before[0] * cosine + (before[1] * s - before[2] * y);
        q[1] = before[3] * y + before[1] * cosine + (before[2] * x - before[0] * s);
        q[2] = before[3] * s + before[2] * cosine + (before[0] * y - before[1] * x);
        q[3] = before[3] * cosine - (before[0] * x + before[1] * y + before[2] * s);
    }
};

// The axes of W bodies told anew, so that the one of the middle moment comes last.
struct AxisOrder {
    L first, second;  // above 0: its moment is not the middle one

    explicit AxisOrder(const L (&moment)[3])
        : first((moment[0] - moment[1]) * (moment[0] - moment[2])),
          second((moment[1] - moment[2]) * (moment[1] - moment[0]))
    { }
    L pick(L a, L b, L c) const { return select(first > L(0.0), select(second > L(0.0), c, b), a); }
    void tell(const L* from, L* to) const
    {
        to[0] = pick(from[1], from[2], from[0]);
        to[1] = pick(from[2], from[0], from[1]);
        to[2] = pick(from[0], from[1], from[2]);
    }
    void tell_back(const L* from, L* to) const
    {
        to[0] = pick(from[2], from[1], from[0]);
        to[1] = pick(from[0], from[2], from[1]);
        to[2] = pick(from[1], from[0], from[2]);
    }
};

// Angular momentum of W bodies that turn freely, about their principal axes as AxisOrder tells
// them, and how they stand.
struct FreeTurns {
    L momentum[3], q[4];
    L inverse_mass[2];  // half a substep times what 1 / moment is greater by about the first two
                        // axes
    L fastest{0.0};     // greatest square of a turn of a part

    // share: of a whole part, or of half
    void turn_about(int axis, double share)
    {
        const int next = (axis + 1) % 3, last = (axis + 2) % 3;
        const L half = inverse_mass[axis] * L(share) * momentum[axis], squared = half * half;
        fastest = max(L(4.0) * squared, fastest);
        L sine, cosine;
        series(squared, sine, cosine);
        sine = sine * half;
        const L sine_2 = L(2.0) * sine * cosine, cosine_2 = L(1.0) - L(2.0) * sine * sine;
        const L x = momentum[next], y = momentum[last];
        momentum[next] = cosine_2 * x + sine_2 * y;
        momentum[last] = cosine_2 * y - sine_2 * x;
        const L before[4] = {q[axis], q[next], q[last], q[3]};
        q[axis] = before[0] * cosine + before[3] * sine;
        q[next] = before[1] * cosine + before[2] * sine;
        q[last] = before[2] * cosine - before[1] * sine;
        q[3] = before[3] * cosine - before[0] * sine;
    }

    void go(int parts)
    {
        turn_about(0, 0.5);
        for (int i = 0; i < parts; ++i) {
            turn_about(1, 1);
            turn_about(0, i + 1 < parts ? 1 : 0.5);
        }
    }
};

struct Bodies {
    L position[3], orientation[4], linear[3], angular[3];
    L trouble = 0.0;         // beyond the kernel where it is not 0
    bool precesses = false;  // some of them do
};

// Falls as the substeps would have it: so many times speed, then place.
void fall(const FlightRule& rule, L falls, Bodies& body)
{
    const double h = rule.substep, n = rule.substeps;
    for (int k = 0; k < 3; ++k) {
        const L pull = select(falls > L(0.0), L(rule.gravity[k]), L(0.0));
        body.position[k] += body.linear[k] * L(n * h) + pull * L(h * h * (n * (n + 1) / 2));
        body.linear[k] += pull * L(n * h);
    }
}

L trouble_where(auto fine) { return select(fine, L(0.0), L(1.0)); }

// Rounding alone has made its length stray: one term of the series for its inverse will do.
void keep_unit(L (&q)[4])
{
    L length = 0.0;
    for (const L part : q) length += part * part;
    const L shrink = L(1.5) - L(0.5) * length;
    for (L& part : q) part = part * shrink;
}

// What is left of free rotation when bodies have turned about their momentum as it stands in space;
// see free_rotation.hpp. Of those that spin evenly nothing is.
//
//   told      their moments in that order
//   momentum  about their axes, as the step began
void nod(const FlightRule& rule,
         const AxisOrder& order,
         const L (&told)[3],
         const L (&momentum)[3],
         Spin& spin,
         Bodies& body)
{
    const L uneven = spin.uneven;
    FreeTurns turns;
    for (int k = 0; k < 2; ++k)
        turns.inverse_mass[k] = L(0.5 * rule.substep) * (L(1.0) / told[k] - L(1.0) / told[2]);
    order.tell(momentum, turns.momentum);
    order.tell(body.orientation, turns.q);
    turns.q[3] = body.orientation[3];
    turns.go(rule.substeps);
    L length = 0.0;
    for (const L part : momentum) length += part * part;
    const L nodding = L(4.0) * length * abs(turns.inverse_mass[0] * turns.inverse_mass[1]);
    body.trouble += select(uneven > L(0.0), trouble_where(nodding < L(kNodSquared)), L(0.0));
    spin.fastest = max(select(uneven > L(0.0), turns.fastest, L(0.0)), spin.fastest);

    L q[3], w[3];
    order.tell_back(turns.q, q);
    for (int k = 0; k < 3; ++k) turns.momentum[k] = turns.momentum[k] / told[k];
    order.tell_back(turns.momentum, w);
    // Nothing at all for those that spin evenly, not even a zero of another sign.
    for (int k = 0; k < 3; ++k) {
        body.orientation[k] = select(uneven > L(0.0), q[k], body.orientation[k]);
        spin.w[k] = w[k];
    }
    body.orientation[3] = select(uneven > L(0.0), turns.q[3], body.orientation[3]);
}

// Those that spin unevenly, in exact parts. Those that spin evenly keep their velocity, and turn as
// they do among their like.
void turn_freely(const FlightRule& rule, Spin& spin, Bodies& body)
{
    const AxisOrder order(spin.moment);
    L momentum[3], told[3];
    order.tell(spin.moment, told);
    const L share = L(1.0) / told[2];
    for (int k = 0; k < 3; ++k) {
        momentum[k] = spin.moment[k] * spin.w[k];
        spin.w[k] = select(spin.uneven > L(0.0), share * momentum[k], spin.w[k]);
    }
    spin.square();
    for (int step = 0; step < rule.substeps; ++step) spin.turn_on(rule.substep, body.orientation);
    nod(rule, order, told, momentum, spin, body);
}

// By implicit Euler, substep by substep.
void turn_by_steps(const FlightRule& rule, Spin& spin, Bodies& body)
{
    for (int step = 0; step < rule.substeps; ++step) {
        if (body.precesses) spin.precess();
        spin.turn_on(rule.substep, body.orientation);
    }
}

void spin(const FlightRule& rule, const FlightArrays& arrays, const RowIds& ids, Bodies& body)
{
    using Precession = FlightRule::Precession;
    Spin spin;
    double uneven[kWidth] = {};
    for (int i = 0; rule.precession != Precession::none && i < kWidth; ++i) {
        uneven[i] = arrays.spins[ids.at[i]];
        body.precesses |= uneven[i] != 0;
    }
    turn(body.orientation, -1, body.angular, spin.w);
    if (body.precesses) load_3_of_6(arrays.inertia, ids, spin.moment);
    const bool split = body.precesses && rule.precession == Precession::split;
    spin.start(L::load(uneven), rule.substep, body.precesses && !split);
    if (split)
        turn_freely(rule, spin, body);
    else
        turn_by_steps(rule, spin, body);
    keep_unit(body.orientation);
    body.trouble += trouble_where(spin.fastest < L(kFastest));
    if (!body.precesses) return;
    body.trouble += trouble_where(L::load(uneven) < L(1.5));  // its axes are principal ones
    // What spins evenly keeps its velocity to the last bit.
    L world[3];
    turn(body.orientation, 1, spin.w, world);
    for (int k = 0; k < 3; ++k)
        body.angular[k] = select(spin.uneven > L(0.0), world[k], body.angular[k]);
}

// Bit a lane: those that went well.
unsigned sound_ones(Bodies& body, std::size_t valid)
{
    L sum = 0.0;
    for (int k = 0; k < 3; ++k)
        sum += abs(body.position[k]) + abs(body.linear[k]) + abs(body.angular[k]);
    for (const L part : body.orientation) sum += abs(part);
    body.trouble += trouble_where(sum < L(kMost));
    double trouble[kWidth];
    body.trouble.store(trouble);
    unsigned sound = 0;
    for (std::size_t i = 0; i < valid; ++i) sound |= (trouble[i] == 0 ? 1u : 0u) << i;
    return sound;
}

unsigned
fly_some(const FlightRule& rule, const FlightArrays& arrays, const RowIds& ids, std::size_t valid)
{
    Bodies body;
    load_3(arrays.position, ids, body.position);
    load_3(arrays.linear, ids, body.linear);
    load_3(arrays.angular, ids, body.angular);
    load_4(arrays.orientation, ids, body.orientation);
    L inverse_mass[1];
    load_rows(arrays.inverse_mass, 1, ids, inverse_mass);
    fall(rule, inverse_mass[0], body);
    if (rule.turns) spin(rule, arrays, ids, body);

    const unsigned sound = sound_ones(body, valid);
    const bool pulled = rule.gravity[0] != 0 || rule.gravity[1] != 0 || rule.gravity[2] != 0;
    store_3(body.position, arrays.position, ids, sound);
    if (pulled) store_3(body.linear, arrays.linear, ids, sound);
    if (rule.turns) store_4(body.orientation, arrays.orientation, ids, sound);
    if (body.precesses) store_3(body.angular, arrays.angular, ids, sound);
    return sound;
}

std::size_t fly(const FlightRule& rule,
                const FlightArrays& arrays,
                const std::uint32_t* bodies,
                std::size_t count,
                std::uint32_t* left)
{
    std::size_t left_over = 0;
    for (std::size_t at = 0; at < count; at += kWidth) {
        const std::size_t valid = count - at < kWidth ? count - at : kWidth;
        RowIds ids;
        // Idle lanes repeat the last body, and are not written.
        for (std::size_t i = 0; i < kWidth; ++i)
            ids.at[i] = bodies[at + (i < valid ? i : valid - 1)];
        ids.run = valid == kWidth && ids.at[kWidth - 1] - ids.at[0] == kWidth - 1;
        const unsigned sound = fly_some(rule, arrays, ids, valid);
        for (std::size_t i = 0; i < valid; ++i)
            if ((sound >> i & 1u) == 0) left[left_over++] = bodies[at + i];
    }
    return left_over;
}

}  // namespace

extern const FlyKernel kFly;
const FlyKernel kFly = fly;

}  // namespace throng::THRONG_LANES
