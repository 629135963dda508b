// Boxes of active bodies, written once over the width of the machine's registers.
#include "broadphase/active_bounds.hpp"
#include "kernels/simd/lane_rows.hpp"

namespace throng::THRONG_LANES {

namespace {

using L = Lanes<double>;
constexpr int kWidth = L::kWidth;

L absolute(L x) { return max(x, -x); }

template <class Lane = L>  // a template, so that each width sees its own branch alone
Lane load_floats(const float* from, const RowIds& ids)
{
    if constexpr (Lane::kWidth > 1) {
        if (ids.run) {
            using F __attribute__((vector_size(Lane::kWidth * sizeof(float)))) = float;
            F numbers;
            __builtin_memcpy(&numbers, from + ids.at[0], sizeof(F));
            return Lane(__builtin_convertvector(numbers, typename Lane::V));
        }
    }
    double numbers[kWidth];
    for (int i = 0; i < kWidth; ++i) numbers[i] = double{from[ids.at[i]]};
    return Lane::load(numbers);
}

L load_one(const double* from, const RowIds& ids)
{
    if (ids.run) return L::load(from + ids.at[0]);
    L out[1];
    load_rows(from, 1, ids, out);
    return out[0];
}

L length(const L (&v)[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

struct ActiveBody {
    RowIds collider, body;
    std::size_t valid = 0;  // lanes; idle ones repeat the last
    L position[3], orientation[4], linear[3];
    L lower[3], upper[3];  // tight, then grown by the speculative margin
    L speculative_margin;
};

// How far the shape reaches along the world's axes.
void extend(const ActiveBoundsArrays& arrays, const ActiveBody& active, L (&out)[3])
{
    const L x = active.orientation[0], y = active.orientation[1], z = active.orientation[2],
            w = active.orientation[3];
    const L one = 1.0, x2 = x + x, y2 = y + y, z2 = z + z;
    const L xx = x2 * x, yy = y2 * y, zz = z2 * z, xy = x2 * y, xz = x2 * z, yz = y2 * z;
    const L wx = x2 * w, wy = y2 * w, wz = z2 * w;
    const L turn[3][3] = {{one - (yy + zz), xy - wz, xz + wy},
                          {xy + wz, one - (xx + zz), yz - wx},
                          {xz - wy, yz + wx, one - (xx + yy)}};
    L half[3];
    for (int k = 0; k < 3; ++k) half[k] = load_floats(arrays.half[k], active.collider);
    const L round = load_floats(arrays.round, active.collider);
    for (int k = 0; k < 3; ++k)
        out[k] = absolute(turn[k][0]) * half[0] + absolute(turn[k][1]) * half[1]
            + absolute(turn[k][2]) * half[2];
    double cylinders[kWidth];
    bool any = false;
    for (int i = 0; i < kWidth; ++i) {
        const bool is =
            arrays.form[active.collider.at[i]] == std::uint8_t(ActiveBoundsForm::cylinder);
        cylinders[i] = is ? 1 : 0;
        any |= is;
    }
    if (!any) {
        for (L& part : out) part += round;
        return;
    }
    // A disk across the axis; the two other components say it without cancellation.
    const L is = L::load(cylinders);
    for (int k = 0; k < 3; ++k) {
        const L a = turn[(k + 1) % 3][2], b = turn[(k + 2) % 3][2];
        out[k] += round * select(is > L(0.0), sqrt(a * a + b * b), L(1.0));
    }
}

L speculative_margin_of(const ActiveBoundsRule& rule,
                        const ActiveBoundsArrays& arrays,
                        const ActiveBody& active)
{
    L spin[3];
    load_3(arrays.angular, active.body, spin);
    const L outer = load_one(arrays.outer, active.collider);
    const L rest = max(L(rule.resting) * load_one(arrays.inner, active.collider), L(rule.falls));
    const L swept = min(length(spin) * outer * L(rule.dt), L(2.0) * outer);
    return rest + length(active.linear) * L(rule.dt) + swept;
}

// A number rounded outward, see near_box() of update_bounds.cpp.
template <class F>
F outward(F x, float way)
{
    const F size = x < F{} ? -x : x;
    return x + (size * (3 * 0x1p-24f) + 0x1p-126f) * way;
}

template <class Wanted = ActiveBody>  // a template, so that each width sees its own branch alone
void store_near(const Wanted& active, float* near)
{
    if constexpr (decltype(active.speculative_margin)::kWidth == 8) {
        using F __attribute__((vector_size(8 * sizeof(float)))) = float;
        F rows[8] = {};
        for (int k = 0; k < 3; ++k) {
            rows[k] = outward(__builtin_convertvector(active.lower[k].v, F), -1.0f);
            rows[4 + k] = outward(__builtin_convertvector(active.upper[k].v, F), 1.0f);
        }
        detail::turn_8x8(rows);
        for (std::size_t i = 0; i < active.valid; ++i)
            __builtin_memcpy(near + std::size_t{active.collider.at[i]} * 8, &rows[i], sizeof(F));
    } else {
        for (std::size_t i = 0; i < active.valid; ++i) {
            float* to = near + std::size_t{active.collider.at[i]} * 8;
            const int lane = static_cast<int>(i);
            for (int k = 0; k < 3; ++k) {
                to[k] = outward(static_cast<float>(active.lower[k].get(lane)), -1.0f);
                to[4 + k] = outward(static_cast<float>(active.upper[k].get(lane)), 1.0f);
            }
            to[3] = to[7] = 0;
        }
    }
}

void store_placed(const ActiveBody& active, const ActiveBoundsArrays& arrays)
{
    for (std::size_t i = 0; i < active.valid; ++i) {
        double* to = arrays.placed + std::size_t{active.collider.at[i]} * 7;
        const std::size_t body = active.body.at[i];
        __builtin_memcpy(to, arrays.position + body * 3, 3 * sizeof(double));
        __builtin_memcpy(to + 3, arrays.orientation + body * 4, 4 * sizeof(double));
    }
}

// How far a box reaches ahead along an axis, of some speed.
L ahead_of(const ActiveBoundsRule& rule, L way, L size)
{
    return max(way, min(L(rule.steps) * way, L(rule.longest) * size));
}

// Bit a lane: those that are no longer within their box, or whose box has become loose.
unsigned
misfits(const ActiveBoundsRule& rule, const ActiveBoundsArrays& arrays, const ActiveBody& active)
{
    L box[6];
    load_6(arrays.boxes, active.collider, box);
    const L size = load_one(arrays.inner, active.collider);
    L out = 0.0;
    for (int k = 0; k < 3; ++k) {
        const L below = active.lower[k] - box[k], above = box[3 + k] - active.upper[k];
        out = select(below < L(0.0), L(1.0), out);
        out = select(above < L(0.0), L(1.0), out);
        const L ahead = ahead_of(rule, absolute(active.linear[k] * L(rule.dt)), size);
        const L most = ahead + L(rule.base + rule.loose) * size;
        out = select(max(below, above) > most, L(1.0), out);
    }
    double numbers[kWidth];
    out.store(numbers);
    unsigned bits = 0;
    for (std::size_t i = 0; i < active.valid; ++i) bits |= (numbers[i] != 0 ? 1u : 0u) << i;
    return bits;
}

// The same sums as fattened() of margins.cpp, which says why.
void store_fattened(const ActiveBoundsRule& rule,
                    const ActiveBoundsArrays& arrays,
                    const ActiveBody& active,
                    unsigned of)
{
    constexpr double kSlack = 4 * 0x1p-52;
    const L size = load_one(arrays.inner, active.collider);
    const L base = L(rule.base) * size, zero = 0.0;
    L box[6];
    for (int k = 0; k < 3; ++k) {
        const L step = active.linear[k] * L(rule.dt), way = absolute(step);
        const L ahead = ahead_of(rule, way, size);
        const L rounding =
            L(kSlack) * (max(absolute(active.lower[k]), absolute(active.upper[k])) + ahead);
        const L padding = base + rounding;
        box[k] = active.lower[k] - (padding + select(step < zero, ahead, zero));
        box[3 + k] = active.upper[k] + (padding + select(step > zero, ahead, zero));
    }
    store_rows(box, arrays.boxes, 6, active.collider, of);
}

unsigned update(const ActiveBoundsRule& rule, const ActiveBoundsArrays& arrays, ActiveBody& active)
{
    load_3(arrays.position, active.body, active.position);
    load_3(arrays.linear, active.body, active.linear);
    load_4(arrays.orientation, active.body, active.orientation);
    L extent[3];
    extend(arrays, active, extent);
    active.speculative_margin = speculative_margin_of(rule, arrays, active);
    for (int k = 0; k < 3; ++k) {
        active.lower[k] = active.position[k] - extent[k] - active.speculative_margin;
        active.upper[k] = active.position[k] + extent[k] + active.speculative_margin;
    }
    const L speculative_margin[1] = {active.speculative_margin};
    if (active.collider.run)
        active.speculative_margin.store(arrays.speculative_margin + active.collider.at[0]);
    else
        store_rows(speculative_margin, arrays.speculative_margin, 1, active.collider,
                   (1u << active.valid) - 1);
    store_near(active, arrays.near);
    store_placed(active, arrays);
    const unsigned left = misfits(rule, arrays, active);
    if (left != 0) store_fattened(rule, arrays, active, left);
    return left;
}

bool follow_on(const RowIds& ids)
{
    bool all = true;
    for (std::uint32_t i = 1; i < kWidth; ++i) all &= ids.at[i] == ids.at[0] + i;
    return all;
}

std::size_t update_active_bounds(const ActiveBoundsRule& rule,
                                 const ActiveBoundsArrays& arrays,
                                 const std::uint32_t* colliders,
                                 const std::uint32_t* bodies,
                                 std::size_t count,
                                 std::uint32_t* asked)
{
    std::size_t found = 0;
    for (std::size_t at = 0; at < count; at += kWidth) {
        ActiveBody active;
        active.valid = count - at < kWidth ? count - at : kWidth;
        for (std::size_t i = 0; i < kWidth; ++i) {
            const std::size_t from = at + (i < active.valid ? i : active.valid - 1);
            active.collider.at[i] = colliders[from];
            active.body.at[i] = bodies[from];
        }
        active.collider.run = follow_on(active.collider);
        active.body.run = follow_on(active.body);
        const unsigned left = update(rule, arrays, active);
        for (std::size_t i = 0; i < active.valid; ++i)
            if ((left >> i & 1u) != 0) asked[found++] = colliders[at + i];
    }
    return found;
}

}  // namespace

extern const ActiveBoundsKernel kUpdateActiveBounds;
const ActiveBoundsKernel kUpdateActiveBounds = update_active_bounds;

}  // namespace throng::THRONG_LANES
