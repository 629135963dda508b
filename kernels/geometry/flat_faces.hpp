// Flat faces: a polytope whose faces lie in planes, to rounding.
//
// A hull's faces are put together of triangles that lie in one plane to a hundred-thousandth of its
// size. Where a volume or a touch is wanted closer than that, they are taken apart again.
#pragma once

#include "kernels/geometry/polytope.hpp"

#include <vector>

namespace throng {

/// The points with normal . x <= offset are kept. The normal is of unit length.
struct CutPlane {
    Vec3 normal = Vec3::Zero();
    double offset = 0;
};

/// A triangle of a face, as places of its corners round the face: first < middle < last.
struct FaceTriangle {
    std::size_t first, middle, last;
};

/// Whether no corner of the face lies below its plane by more than the slack, m.
bool is_flat(const PolytopeView& shape, std::size_t face, double slack);

/// The triangles of the hull of a face's corners that look outward, each after the one beyond its
/// long side, which runs from first to last.
void collect_triangles(const PolytopeView& shape,
                       std::size_t face,
                       std::vector<FaceTriangle>& triangles);

/// The planes of the faces, in the shape's frame; of a face that is not flat, those of its
/// triangles. None cuts anything off the shape.
void collect_planes(const PolytopeView& shape, double slack, std::vector<CutPlane>& planes);

}  // namespace throng
