// Chosen method: the narrow phase and the filter that the user asked for, in place of `auto`.
#pragma once

#include "narrowphase/alternatives/method_contacts.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "pipeline/contacts/collide.hpp"

namespace throng {

/// The choice of the dials `narrowphase`, `method_start` and `bounds_filter` for one step.
class ChosenMethod {
public:
    /// After the list of pairs has changed `memories` follows it; filters get the bounds of now.
    ///
    ///   blocks  of pairs, that collide() is told apart by
    ChosenMethod(const NarrowPhaseParameters& parameters,
                 const Pairs& pairs,
                 const Shapes& shapes,
                 const Colliders& colliders,
                 const Bounds& bounds,
                 std::size_t blocks,
                 MethodPairs& memories);

    /// Whether it is up to the filter or the method, and not to `auto` alone: two convex shapes
    /// that end somewhere.
    bool asks(ShapeKind a, ShapeKind b) const
    {
        return (method_ || filters()) && ends(a) && ends(b);
    }

    /// Whether the filter shows them to be beyond the margin.
    bool parts(const PairPlace& pair) const;

    /// Where the two touch, in a's frame. False where `auto` has to answer.
    bool
    collide(std::size_t i, const PairPlace& pair, LocalManifold<double>& out, std::size_t block);

    /// Counts a pair whose method within `auto` came to its bound, as its cache tells.
    void note_fallback(const PairCache& cache, std::size_t block)
    {
        if ((cache.kind & kFellBack) != 0) ++memories_.scratch.fallbacks[block];
    }

    /// How many pairs took their answer from another method, once all blocks are through.
    void count_fallbacks();

    bool has_method() const { return method_ != nullptr; }

private:
    // Solids and meshes collide in stages of their own, and have no core.
    static bool ends(ShapeKind kind)
    {
        return kind != ShapeKind::plane && kind != ShapeKind::mesh && kind != ShapeKind::solid;
    }
    bool filters() const { return filter_ != BoundsFilter::none; }

    const Shapes& shapes_;
    const Colliders& colliders_;
    const Bounds& bounds_;
    MethodPairs& memories_;
    const ConvexMethod* method_;
    MethodStart start_;
    BoundsFilter filter_;
    int slabs_ = 0;  // of a k-DOP, counted both ways
};

}  // namespace throng
