// Solids: closed shapes that need not be convex, and what each way of taking them in contact needs.
//
// A solid keeps its triangles whatever its way, so that what it weighs and how far it reaches do
// not hang on the way. All of it is in the shape's own axes and shared by the bodies that use it.
#pragma once

#include "kernels/data/mesh.hpp"
#include "kernels/data/ray_layers.hpp"

#include <cstdint>
#include <vector>

namespace throng {

/// How a solid is taken in contact. `parts` and `hull` of the dial are no ways of a solid: they
/// make convex hulls of it.
enum class SolidRepresentation : std::uint8_t { voxels, spheres, depth_image };

/// A signed distance on a grid of values, in bricks of 9^3 values: 8^3 cells and the layer shared
/// with the next brick, so that a sample reads one brick alone. Trilinear between values.
///
///   origin    m, place of the first value
///   voxel     m, from one value to the next
///   bricks    number of them along each axis
///   brick_of  [bricks.x * y * z], x fastest: which brick of `values`, or -1 where all of it is
///             outside and further than `band` from the surface
///   values    [stored bricks][9][9][9] m, x fastest; below 0 inside, to any depth; no more than
///             `band` outside
struct VoxelBricks {
    static constexpr int kCells = 8, kSide = 9, kValues = kSide * kSide * kSide;

    Vec3 origin = Vec3::Zero();
    double voxel = 0;
    double band = 0;
    std::array<std::int32_t, 3> bricks{};
    std::vector<std::int32_t> brick_of;
    std::vector<float> values;

    bool empty() const { return values.empty(); }
};

/// Points of a surface, close enough together that nothing of it is further than `spacing` from
/// one, in a tree of balls. Points of a leaf lie side by side.
///
///   x, y, z     [points] m
///   normals     [points] unit, outward; of an edge or a corner the mean over its faces, weighed by
///               their angles
///   cones       [points] cosine of the angle to -normal within which another surface may push the
///               point: how far the surface that it stands for leans from its normal, and 20
///               degrees
///   nodes       [0] is the root
struct SurfacePoints {
    struct Node {
        Vec3T<float> center = Vec3T<float>::Zero();
        float radius = 0;         // of a ball about center with all points of the node in it
        std::uint32_t first = 0;  // leaf: first point; inner: left child, right is left + 1
        std::uint32_t count = 0;  // leaf: points; inner: 0
    };
    double spacing = 0;
    std::vector<float> x, y, z;
    std::vector<Vec3T<float>> normals;
    std::vector<float> cones;
    std::vector<Node> nodes;

    std::size_t size() const { return x.size(); }
};

/// Spheres that stand for a solid, coarse to fine: each level stands for the whole of it.
///
///   levels  [0] is one sphere. Spheres of a level lie side by side; `first` and `count` name the
///           children in the next level (count 0 at the last)
///   error   m, of each level: no point of the solid's surface is further than this from the
///           surface of the level's spheres taken together, nor the other way round
struct SphereTree {
    struct Node {
        Vec3T<float> center = Vec3T<float>::Zero();
        float radius = 0;         // of the sphere that stands for its part
        float bound = 0;          // about center: all spheres below it are inside, at every level
        std::uint32_t first = 0;  // children, among the nodes of the next level
        std::uint32_t count = 0;
    };
    struct Level {
        std::vector<Node> nodes;
        double error = 0;
    };
    std::vector<Level> levels;
};

/// A ball within a solid.
struct SolidCore {
    Vec3 center = Vec3::Zero();
    double radius = 0;
};

/// A closed shape that may move.
///
///   field, points  way voxels; for others empty
///   spheres        way spheres
///   rays           way depth_image: along the longest side of the smaller shape of a pair
///   layers         way depth_image: along each axis, what the rays of pairs meet in which this is
///                  the smaller one; empty where that would take much room
///   cores          balls all over it, which may not pass through anything whatever contact does;
///                  none where it is too thin for them
///   error          m, how far a depth may be from that of the triangles: half a voxel, a pixel
///                  of this shape, or the spheres' own; smaller features may be missed
struct Solid {
    SolidRepresentation representation = SolidRepresentation::voxels;
    Mesh mesh;
    VoxelBricks field;
    SurfacePoints points;
    SphereTree spheres;
    int rays = 0;
    std::array<RayLayers, 3> layers;
    std::vector<SolidCore> cores;
    double error = 0;
};

}  // namespace throng
