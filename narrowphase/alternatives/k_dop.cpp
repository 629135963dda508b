#include "narrowphase/alternatives/k_dop.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Of the size, m: a dozen roundings of what is added up for a slab.
constexpr double kWidened = 64 * std::numeric_limits<double>::epsilon();

const std::array<Vec3, kMaxSlabs>& directions()
{
    static const std::array<Vec3, kMaxSlabs> all = {
        Vec3(1, 1, 1),  Vec3(1, 1, -1), Vec3(1, -1, 1), Vec3(1, -1, -1), Vec3(1, 0, 0),
        Vec3(0, 1, 0),  Vec3(0, 0, 1),  Vec3(1, 1, 0),  Vec3(1, -1, 0),  Vec3(1, 0, 1),
        Vec3(1, 0, -1), Vec3(0, 1, 1),  Vec3(0, 1, -1)};
    return all;
}

// Lengths of the directions of corners, axes and edges.
double length_of(std::size_t slab)
{
    constexpr double kRoot2 = 1.41421356237309504880, kRoot3 = 1.73205080756887729353;
    return slab < 4 ? kRoot3 : slab < 7 ? 1 : kRoot2;
}

struct Range {
    double lower, upper;
};

// Of a shape in its own frame, along a direction of any length.
Range range_along(const ConvexCore<double>& core, const Vec3& direction)
{
    if (core.kind != ShapeKind::hull) {
        // All others are the same seen from both sides.
        const double extent = direction.dot(support(core, direction).position)
            + core.convex_radius * std::sqrt(direction.squaredNorm());
        return {-extent, extent};
    }
    Range range = {std::numeric_limits<double>::infinity(),
                   -std::numeric_limits<double>::infinity()};
    for (const Vec3& vertex : core.hull->vertices) {
        const double along = direction.dot(vertex);
        range.lower = along < range.lower ? along : range.lower;
        range.upper = along > range.upper ? along : range.upper;
    }
    return range;
}

Range range_along(const ConvexCore<double>& core,
                  const Mat3& turn,
                  const Vec3& position,
                  const Vec3& direction)
{
    const Range own = range_along(core, turn.transpose() * direction);
    const double shift = direction.dot(position);
    return {own.lower + shift, own.upper + shift};
}

// m, below which rounding decides.
double slack_of(const ConvexCorePair& cores)
{
    return kWidened * (cores.size + std::sqrt(cores.b_position.squaredNorm()));
}

// From a to b.
Vec3 outward(std::size_t slab, bool b_is_above)
{
    return directions()[slab] / (b_is_above ? length_of(slab) : -length_of(slab));
}

bool parts(const ConvexCorePair& cores, std::size_t slab, MethodAnswer& answer)
{
    ++answer.rounds;
    const Vec3& direction = slab_direction(slab);
    const Range a = range_along(cores.a, direction);
    const Range b = range_along(cores.b, cores.b_turn, cores.b_position, direction);
    const double separation = std::max(b.lower - a.upper, a.lower - b.upper);
    if (!(separation > slack_of(cores) * length_of(slab))) return false;
    answer.overlap = OverlapState::apart;
    answer.normal = outward(slab, b.lower > a.upper);
    return true;
}

std::size_t likely_slab(const ConvexCorePair& cores, Slabs slabs)
{
    const Vec3 offset = cores.b_turn * cores.b.middle + cores.b_position - cores.a.middle;
    std::size_t best = slabs.begin;
    double most = -1;
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        const double along = std::abs(slab_direction(slab).dot(offset)) / length_of(slab);
        if (!(along > most)) continue;
        most = along;
        best = slab;
    }
    return best;
}

}  // namespace

Slabs slabs_of(int k)
{
    THRONG_CHECK(k == 6 || k == 14 || k == 18 || k == 26, "a k-DOP has 6, 14, 18 or 26 sides");
    return {k == 6 || k == 18 ? 4U : 0U, k == 6 || k == 14 ? 7U : kMaxSlabs};
}

const Vec3& slab_direction(std::size_t slab) { return directions()[slab]; }

KDop empty_k_dop(Slabs slabs)
{
    KDop nothing;
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        nothing.lower[slab] = std::numeric_limits<double>::infinity();
        nothing.upper[slab] = -std::numeric_limits<double>::infinity();
    }
    return nothing;
}

void add(const Vec3& point, Slabs slabs, KDop& to)
{
    const double x = point.x(), y = point.y(), z = point.z();
    const double sum = x + y, difference = x - y;
    const std::array<double, kMaxSlabs> along = {
        sum + z, sum - z,    difference + z, difference - z, x,     y,    z,
        sum,     difference, x + z,          x - z,          y + z, y - z};
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        to.lower[slab] = along[slab] < to.lower[slab] ? along[slab] : to.lower[slab];
        to.upper[slab] = along[slab] > to.upper[slab] ? along[slab] : to.upper[slab];
    }
}

void add(const KDop& other, Slabs slabs, KDop& to)
{
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        to.lower[slab] = std::min(to.lower[slab], other.lower[slab]);
        to.upper[slab] = std::max(to.upper[slab], other.upper[slab]);
    }
}

KDop k_dop_of(const ConvexCore<double>& core, const Mat3& turn, const Vec3& position, int k)
{
    const Slabs slabs = slabs_of(k);
    KDop dop = empty_k_dop(slabs);
    if (core.kind == ShapeKind::hull) {
        for (const Vec3& vertex : core.hull->vertices) add(turn * vertex + position, slabs, dop);
        return dop;
    }
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        const Range range = range_along(core, turn, position, slab_direction(slab));
        dop.lower[slab] = range.lower;
        dop.upper[slab] = range.upper;
    }
    return dop;
}

std::size_t parting_slab(const KDop& a, const KDop& b, Slabs slabs, double slack)
{
    for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
        const double separation =
            std::max(b.lower[slab] - a.upper[slab], a.lower[slab] - b.upper[slab]);
        if (separation > slack * length_of(slab)) return slab;
    }
    return slabs.end;
}

template <int k>
MethodAnswer query_k_dop(const ConvexPair& pair, double, MethodStart start, MethodMemory& memory)
{
    const ConvexCorePair& cores = pair.cores();
    const Slabs slabs = slabs_of(k);
    MethodAnswer answer;
    if (start != MethodStart::plain) {
        // What is remembered counts from one; nothing is 0.
        const std::size_t known = memory.kind - 1U;
        const bool knows =
            start == MethodStart::cached && known >= slabs.begin && known < slabs.end;
        if (knows && parts(cores, known, answer)) return answer;
        const std::size_t likely = likely_slab(cores, slabs);
        memory.kind = static_cast<std::uint32_t>(likely + 1);
        if ((!knows || likely != known) && parts(cores, likely, answer)) return answer;
    }
    const KDop a = k_dop_of(cores.a, Mat3::Identity(), Vec3::Zero(), k);
    const KDop b = k_dop_of(cores.b, cores.b_turn, cores.b_position, k);
    const std::size_t slab = parting_slab(a, b, slabs, slack_of(cores));
    answer.rounds += static_cast<int>(slabs.end - slabs.begin);
    if (slab == slabs.end) return answer;
    memory.kind = static_cast<std::uint32_t>(slab + 1);
    answer.overlap = OverlapState::apart;
    answer.normal = outward(slab, b.lower[slab] > a.upper[slab]);
    return answer;
}

template MethodAnswer query_k_dop<6>(const ConvexPair&, double, MethodStart, MethodMemory&);
template MethodAnswer query_k_dop<14>(const ConvexPair&, double, MethodStart, MethodMemory&);
template MethodAnswer query_k_dop<18>(const ConvexPair&, double, MethodStart, MethodMemory&);
template MethodAnswer query_k_dop<26>(const ConvexPair&, double, MethodStart, MethodMemory&);

}  // namespace throng
