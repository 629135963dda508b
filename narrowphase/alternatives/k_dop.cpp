#include "narrowphase/alternatives/k_dop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Of the size, m: a dozen roundings of what is added up for a slab.
constexpr double kWidened = 64 * std::numeric_limits<double>::epsilon();

// m, below which rounding decides.
double slack_of(const ConvexCorePair& cores)
{
    return kWidened * (cores.size + std::sqrt(cores.b_position.squaredNorm()));
}

// From a to b.
Vec3 outward(std::size_t slab, bool b_is_above)
{
    return slab_direction(slab) / (b_is_above ? slab_length(slab) : -slab_length(slab));
}

bool parts(const ConvexCorePair& cores, std::size_t slab, MethodAnswer& answer)
{
    ++answer.rounds;
    const Vec3& direction = slab_direction(slab);
    const SlabRange a = range_along(cores.a, direction);
    const SlabRange b = range_along(cores.b, cores.b_turn, cores.b_position, direction);
    const double separation = std::max(b.lower - a.upper, a.lower - b.upper);
    if (!(separation > slack_of(cores) * slab_length(slab))) return false;
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
        const double along = std::abs(slab_direction(slab).dot(offset)) / slab_length(slab);
        if (!(along > most)) continue;
        most = along;
        best = slab;
    }
    return best;
}

}  // namespace

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
