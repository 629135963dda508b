// Free flight, written once over the width of the machine's registers.
#include "kernels/math/lane_rows.hpp"
#include "kernels/motion/flight.hpp"

namespace throng::THRONG_LANES {

namespace {

using L = Lanes<double>;
constexpr int kWidth = L::kWidth;

// Turns of a quarter radian and more in a substep want more terms than the series below have.
constexpr double kFastest = 0.0625;
// Less than the squares of any speed that can be told from nothing.
constexpr double kLeast = 1e-300;
// As much of anything as a step can hold, see holdable().
constexpr double kMost = 1e16;

L absolute(L x) { return max(x, -x); }

// v turned by q, or back by it where `back` is -1.
void turn(const L (&q)[4], double back, const L (&v)[3], L (&out)[3])
{
    const L two = 2.0, x = q[0] * L(back), y = q[1] * L(back), z = q[2] * L(back);
    const L tx = two * (y * v[2] - z * v[1]);
    const L ty = two * (z * v[0] - x * v[2]);
    const L tz = two * (x * v[1] - y * v[0]);
    out[0] = v[0] + q[3] * tx + (y * tz - z * ty);
    out[1] = v[1] + q[3] * ty + (z * tx - x * tz);
    out[2] = v[2] + q[3] * tz + (x * ty - y * tx);
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
        if (!precesses) return;
        for (int k = 0; k < 3; ++k) {
            const L difference = moment[(k + 2) % 3] - moment[(k + 1) % 3];
            ratio[k] = select(uneven > L(0.0), L(h) * difference / moment[k], L(0.0));
        }
        for (int k = 0; k < 3; ++k) pair[k] = ratio[(k + 1) % 3] * ratio[(k + 2) % 3];
        triple = L(2.0) * ratio[0] * pair[0];
        weigh();
    }

    // One Newton step of w' = w - h w' x I w' / I, its 3x3 system solved by hand: with r the ratios
    // the matrix is 1 on the diagonal and r1 w3, r1 w2 and so on beside it. Then its momentum back
    // or, where that is less, its energy; see after_gyroscopic_torque().
    void precess()
    {
        const L product = w[0] * w[1] * w[2];
        const L determinant = L(1.0) + triple * product
            - (pair[0] * squares[0] + pair[1] * squares[1] + pair[2] * squares[2]);
        const L inverse = L(1.0) / determinant;
        L change[3];
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            const L across = w[i] * w[j] * (L(1.0) + pair[k] * squares[k]);
            const L along = w[k] * (ratio[i] * squares[j] + ratio[j] * squares[i]);
            // Nothing at all for those that spin evenly, not even a zero of another sign.
            change[k] = select(uneven > L(0.0), ratio[k] * inverse * (across - along), L(0.0));
        }
        for (int k = 0; k < 3; ++k) w[k] -= change[k];
        square();
        const L had = energy, went = momentum;
        weigh();
        const L squared = min(went / momentum, had / energy);
        const L scale = select(uneven > L(0.0), sqrt(squared), L(1.0));
        for (int k = 0; k < 3; ++k) w[k] = w[k] * scale;
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
        const L z = squared * L(0.25), one = 1.0;
        const L sine = one
            + z * (L(-1.0 / 6) + z * (L(1.0 / 120) + z * (L(-1.0 / 5040) + z * L(1.0 / 362880))));
        const L cosine = one
            + z
                * (L(-1.0 / 2)
                   + z
                       * (L(1.0 / 24)
                          + z * (L(-1.0 / 720) + z * (L(1.0 / 40320) - z * L(1.0 / 3628800)))));
        const L scale = sine * L(0.5 * h);
        const L x = w[0] * scale, y = w[1] * scale, s = w[2] * scale;
        const L before[4] = {q[0], q[1], q[2], q[3]};
        q[0] = before[3] * x + before[0] * cosine + (before[1] * s - before[2] * y);
        q[1] = before[3] * y + before[1] * cosine + (before[2] * x - before[0] * s);
        q[2] = before[3] * s + before[2] * cosine + (before[0] * y - before[1] * x);
        q[3] = before[3] * cosine - (before[0] * x + before[1] * y + before[2] * s);
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

void spin(const FlightRule& rule, const FlightArrays& arrays, const RowIds& ids, Bodies& body)
{
    Spin spin;
    double uneven[kWidth] = {};
    for (int i = 0; rule.gyroscopic && i < kWidth; ++i) {
        uneven[i] = arrays.spins[ids.at[i]];
        body.precesses |= uneven[i] != 0;
    }
    turn(body.orientation, -1, body.angular, spin.w);
    if (body.precesses) load_3_of_6(arrays.inertia, ids, spin.moment);
    spin.start(L::load(uneven), rule.substep, body.precesses);
    for (int step = 0; step < rule.substeps; ++step) {
        if (body.precesses) spin.precess();
        spin.turn_on(rule.substep, body.orientation);
    }
    // Rounding alone has made its length stray: one term of the series for its inverse will do.
    L length = 0.0;
    for (const L part : body.orientation) length += part * part;
    const L shrink = L(1.5) - L(0.5) * length;
    for (L& part : body.orientation) part = part * shrink;
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
        sum += absolute(body.position[k]) + absolute(body.linear[k]) + absolute(body.angular[k]);
    for (const L part : body.orientation) sum += absolute(part);
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
