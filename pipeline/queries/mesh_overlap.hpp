// Mesh overlap: how deep two closed meshes are in one another, by their triangles alone.
//
// What a case judges a step by must not be what the step itself went by: no voxels, spheres, parts
// or images come in here.
#pragma once

#include "kernels/data/mesh.hpp"
#include "throng/scene.hpp"

namespace throng {

/// Two closed meshes, turned outward, to be asked about as often as one likes.
class MeshOverlap {
public:
    MeshOverlap(const MeshShape& a, const MeshShape& b);

    /// m: how deep any corner, or any of three points along an edge, of either lies in the other;
    /// 0 where none does.
    double greatest(const Pose& b_in_a) const;

private:
    struct Side {
        Mesh mesh;
        std::vector<Vec3> points;
    };
    static Side side_of(const MeshShape& shape);
    static double depth_in(const Side& side, const Side& other, const Pose& other_in_side);

    Side a_, b_;
};

}  // namespace throng
