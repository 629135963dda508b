// Surface walk: the points of one solid that are near another shape, found down the tree of balls.
//
// Which way a touch pushes: out of the other shape, along the gradient of its distance at the
// point. That is what parts the two fastest, and of a point at rest on a face it is that face's
// normal however sharp the corner that the point stands for. It is wrong where a corner of the
// other pokes into a face: the points of that face find themselves beside the corner and would be
// pushed sideways. Their own normals tell: what touches a point looks against one of the normals
// round it, give or take what curvature and the grid make of that, so what comes from further off
// is left to the corner's own point, which sees the face. (See `cones` of SurfacePoints.) Deep
// inside, where the gradients of two sides meet and cancel, the point's own normal says the way.
#pragma once

#include "kernels/geometry/voxel_bricks.hpp"
#include "narrowphase/manifold/contact_patches.hpp"
#include "narrowphase/solid/shape_distance.hpp"

namespace throng {

/// Places in the frame of the other shape, and what it says of them. Empty places hold whatever
/// they hold: `count` come first.
template <class Number>
struct LeafSample {
    static constexpr std::size_t kPoints = 16;
    std::size_t count = 0;
    Number x[kPoints], y[kPoints], z[kPoints];
    Number within[kPoints];  // m, asked of bound(): whether a surface point is this near
    Number distance[kPoints], gx[kPoints], gy[kPoints], gz[kPoints];  // gradient 0: not told
};

/// Features of candidates: which side's points they are, and which of them.
enum class CandidateSide : std::uint32_t { a = 0, b = 1U << 30, probe = 2U << 30, edge = 3U << 30 };
inline std::uint32_t candidate_feature(CandidateSide side, std::size_t index)
{
    return static_cast<std::uint32_t>(side) | (static_cast<std::uint32_t>(index) & 0x3fffffffU);
}

/// Gradients shorter than this are of no use: somewhere inside, where two ways out are as near.
inline constexpr double kNoGradient = 0.25;

/// A solid by its field. To be walked against: `bound` fills in distances that no surface point is
/// nearer than to the places (below 0 inside; no more than `within` need be told), and `sample`
/// distances and gradients, out to `furthest()`. Told in float: to a ten-millionth of the solid.
class FieldSide {
public:
    using Real = float;

    explicit FieldSide(const Solid& solid);

    float furthest() const { return furthest_; }
    void bound(LeafSample<float>& places) const;
    void sample(LeafSample<float>& leaf) const;
    /// Where all of its surface is.
    const Box3& box() const { return box_; }

private:
    const VoxelBricks& bricks_;
    float furthest_;  // the band
    Box3 box_;
};

/// A convex shape or a plane, by its exact distance.
class ConvexSide {
public:
    using Real = double;

    ConvexSide(const Shapes& shapes, ShapeRef shape) : shapes_(shapes), shape_(shape) { }

    double furthest() const { return std::numeric_limits<double>::infinity(); }
    void bound(LeafSample<double>& places) const;
    void sample(LeafSample<double>& leaf) const;

private:
    const Shapes& shapes_;
    ShapeRef shape_;
};

/// How deep behind a static mesh what touches it may lie.
///
///   middle          m, of the body, in the mesh's frame
///   deepest         m, where the middle is behind as well
///   deepest_before  m, where the middle is before the mesh; no less
///   past_rim        m, of what is nearest to the rim: what is deeper went round it
struct MeshLimits {
    Vec3 middle = Vec3::Zero();
    double speculative_margin = 0, deepest = 0, deepest_before = 0, past_rim = 0;
};

/// The front of a static mesh.
class MeshSide {
public:
    using Real = double;

    MeshSide(const Mesh& mesh, const MeshLimits& limits) : mesh_(mesh), limits_(limits) { }
    /// Whether something that is mostly before the mesh lies behind it by half of `deepest` or
    /// more.
    bool pressed_in() const { return pressed_in_; }
    double furthest() const { return std::numeric_limits<double>::infinity(); }
    void bound(LeafSample<double>& places) const;
    void sample(LeafSample<double>& leaf) const;

private:
    bool touches(double distance, const struct MeshPoint& nearest) const;

    const Mesh& mesh_;
    MeshLimits limits_;
    mutable bool pressed_in_ = false;  // by what was sampled
};

/// A walked point that the other shape touches, in the walked solid's frame.
///
///   outward  unit, out of the other shape
struct PointCandidate {
    std::uint32_t point = 0;
    Vec3 position, outward;
    double distance = 0;
};

/// Appends the points that `other` touches, out to `speculative_margin`, in order of point. For the
/// sides above. Answers a distance that no point is nearer than to the other shape, which may be
/// less than it is by much: where nothing comes within the margin it is no less than the
/// speculative margin.
///
///   pose  of the other shape in the frame of the points
template <class Other>
double walk_surface(const SurfacePoints& points,
                    const Other& other,
                    const Pose& pose,
                    double speculative_margin,
                    std::vector<PointCandidate>& out);

}  // namespace throng
