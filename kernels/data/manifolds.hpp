// Manifolds: where two shapes touch, or soon may.
//
// Up to four points that share a normal, each with a feature id that stays the same while the same
// features touch, so that impulses carry over from step to step.
#pragma once

#include "throng/math.hpp"

#include <array>

namespace throng {

/// What the geometry of one pair says, in the frame of shape a (its center and axes).
///
///   normal      unit, from a to b
///   position    midway between the two surfaces
///   separation  m along the normal; below 0 when overlapping
template <class Real>
struct LocalManifold {
    struct Point {
        Vec3T<Real> position;
        Real separation;
        std::uint32_t feature;
    };
    Vec3T<Real> normal = Vec3T<Real>::UnitZ();
    std::array<Point, 4> points;
    int count = 0;

    void add(const Vec3T<Real>& position, Real separation, std::uint32_t feature)
    {
        points[static_cast<std::size_t>(count++)] = {position, separation, feature};
    }

    /// The same in another kind of number.
    template <class To>
    LocalManifold<To> cast() const
    {
        LocalManifold<To> to;
        to.normal = normal.template cast<To>();
        for (int i = 0; i < count; ++i) {
            const Point& point = points[static_cast<std::size_t>(i)];
            to.add(point.position.template cast<To>(), static_cast<To>(point.separation),
                   point.feature);
        }
        return to;
    }
};

/// One of the manifolds of a pair that may have many.
///
///   part  the same from step to step while the same part of the surfaces touches. Of a mesh: its
///         triangle. Of solids: where the normal looks in a's frame, so other patches that come and
///         go leave it as it is, and which end of the patch it is where the normal is that end's
///         alone
struct PartManifold {
    std::uint32_t part = 0;
    LocalManifold<double> manifold;
};

/// A manifold as it was found, and what for: while the two have hardly moved against one another
/// since, where its points are now says as much as a new one (see recycle()).
///
///   b_in_a              the pose that it was found at
///   speculative_margin  m, points further apart were left out
template <class Real>
struct CachedManifold {
    LocalManifold<Real> manifold;
    PoseT<Real> b_in_a;
    Real speculative_margin = 0;
};

/// What a pair remembers from step to step so that the next answer comes sooner. It never changes
/// the answer. The meaning is the pair function's own; all zero is a cold start.
struct PairCache {
    std::uint32_t feature_a = 0, feature_b = 0;
    std::uint32_t kind = 0;
    float apart = 0;  // m, of this call alone: beyond the margin, some axis parts them by so much
    bool operator==(const PairCache&) const = default;
};

}  // namespace throng
