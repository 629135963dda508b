#include "pipeline/contacts/chosen_method.hpp"

#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/follow.hpp"
#include "narrowphase/dispatch.hpp"

namespace throng {

namespace {

constexpr std::size_t kColliders = 256;  // a block

const ConvexMethod* method_of(NarrowPhase dial)
{
    switch (dial) {
    case NarrowPhase::gjk:
        return find_convex_method("gjk");
    case NarrowPhase::sat:
        return find_convex_method("sat");
    case NarrowPhase::chung_wang:
        return find_convex_method("chung_wang");
    case NarrowPhase::clip_volume:
        return find_convex_method("clip_volume");
    case NarrowPhase::containment:
        return find_convex_method("containment");
    default:
        return nullptr;
    }
}

int slabs_of(BoundsFilter dial)
{
    switch (dial) {
    case BoundsFilter::k_dop_6:
        return 6;
    case BoundsFilter::k_dop_14:
        return 14;
    case BoundsFilter::k_dop_18:
        return 18;
    case BoundsFilter::k_dop_26:
        return 26;
    default:
        return 0;
    }
}

}  // namespace

ChosenMethod::ChosenMethod(const NarrowPhaseParameters& parameters,
                           const Pairs& pairs,
                           const Shapes& shapes,
                           const Colliders& colliders,
                           const Bounds& bounds,
                           std::size_t blocks,
                           MethodPairs& memories)
    : shapes_(shapes), colliders_(colliders), bounds_(bounds), memories_(memories),
      method_(method_of(parameters.method)), start_(parameters.start), filter_(parameters.filter),
      slabs_(slabs_of(filter_))
{
    memories_.fell_back = 0;
    memories_.scratch.fallbacks.assign(blocks, 0);
    if (method_) {
        const auto fresh = [](std::size_t) { return MethodMemory{}; };
        if (pairs.changed && !memories_.of_pair.empty())
            follow(pairs.from, memories_.of_pair, fresh, [](const MethodMemory&) {});
        memories_.of_pair.resize(pairs.keys.size());
    } else {
        memories_.of_pair.clear();
    }
    memories_.bounds.resize(slabs_ > 0 ? bounds.placed.size() : 0);
    for_each_block(memories_.bounds.size(), kColliders,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                       for (std::size_t i = begin; i < end; ++i) {
                           const ShapeRef shape = colliders.shape[i];
                           if (!ends(shape.kind)) continue;
                           const Pose& placed = bounds.placed[i];
                           memories_.bounds[i] = k_dop_of(convex_core_of<double>(shapes, shape),
                                                          placed.orientation.toRotationMatrix(),
                                                          placed.position, slabs_);
                       }
                   });
}

bool ChosenMethod::parts(const PairPlace& pair) const
{
    // In float the two may seem nearer by so much than they are.
    constexpr double kRounding = 1e-6;
    const double outer = colliders_.outer_radius[pair.a] + colliders_.outer_radius[pair.b];
    const double apart = pair.speculative_margin + kRounding * outer;
    if (filter_ == BoundsFilter::sphere) {
        const Vec3 between = bounds_.placed[pair.b].position - bounds_.placed[pair.a].position;
        return between.squaredNorm() > (outer + apart) * (outer + apart);
    }
    if (slabs_ == 0) return false;
    const Slabs slabs = throng::slabs_of(slabs_);
    return parting_slab(memories_.bounds[pair.a], memories_.bounds[pair.b], slabs, apart)
        != slabs.end;
}

bool ChosenMethod::collide(std::size_t i,
                           const PairPlace& pair,
                           LocalManifold<double>& out,
                           std::size_t block)
{
    const ShapeRef a = colliders_.shape[pair.a], b = colliders_.shape[pair.b];
    const Pose seen = seen_from_first(pair.a, pair.b, shapes_, colliders_, bounds_);
    MethodMemory fresh;
    MethodMemory& memory = start_ == MethodStart::cached ? memories_.of_pair[i] : fresh;
    if (collide_by(*method_, start_, {shapes_, a, b, seen, pair.speculative_margin}, memory, out))
        return true;
    ++memories_.scratch.fallbacks[block];
    return false;
}

void ChosenMethod::count_fallbacks()
{
    for (const std::uint32_t of_block : memories_.scratch.fallbacks)
        memories_.fell_back += of_block;
}

}  // namespace throng
