#include "scene/shapes/stated_hull.hpp"

#include "kernels/math/hash.hpp"
#include "scene/shapes/answer_cache.hpp"

namespace throng {
namespace {

// Points, kept together: about 1 kB each.
constexpr std::size_t kMostPoints = 100000;
// Hulls of fewer are built within a millisecond, and there may be many of them.
constexpr std::size_t kWorthKeeping = 256;

AnswerCache<HullResult>& kept_hulls()
{
    static AnswerCache<HullResult> kept(kMostPoints);
    return kept;
}

std::uint64_t key_of(const HullShape& stated)
{
    Hash hash;
    for (const Vec3& point : stated.points)
        for (const double x : point) hash.add(x);
    return hash.value();
}

}  // namespace

std::shared_ptr<const HullResult> stated_hull(const HullShape& stated)
{
    const auto make = [&] { return std::make_shared<const HullResult>(build_hull(stated.points)); };
    if (stated.points.size() < kWorthKeeping) return make();
    return kept_hulls().get(key_of(stated), stated.points.size(), make);
}

void forget_stated_hull(const HullShape& stated)
{
    if (stated.points.size() >= kWorthKeeping) kept_hulls().forget(key_of(stated));
}

}  // namespace throng
