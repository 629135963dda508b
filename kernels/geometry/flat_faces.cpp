#include "kernels/geometry/flat_faces.hpp"

#include <algorithm>

namespace throng {

bool is_flat(const PolytopeView& shape, std::size_t face, double slack)
{
    const auto corners = shape.face(face);
    return corners.size() <= 3
        || std::all_of(corners.begin(), corners.end(), [&](std::uint16_t corner) {
               const double height = shape.normals[face].dot(shape.vertices[corner]);
               return shape.offsets[face] - height <= slack;
           });
}

void collect_triangles(const PolytopeView& shape,
                       std::size_t face,
                       std::vector<FaceTriangle>& triangles)
{
    const auto corners = shape.face(face);
    const auto vertex = [&](std::size_t i) -> const Vec3& { return shape.vertices[corners[i]]; };
    triangles.clear();
    const auto add = [&](std::size_t first, std::size_t last) {
        if (last - first < 2) return;
        // Wrapped about the side whose other triangle is known: the others stay below.
        const Vec3 base = vertex(last) - vertex(first);
        std::size_t middle = first + 1;
        for (std::size_t i = middle + 1; i < last; ++i) {
            const Vec3 normal = (vertex(middle) - vertex(first)).cross(base);
            if (normal.dot(vertex(i) - vertex(first)) > 0) middle = i;
        }
        triangles.push_back({first, middle, last});
    };
    add(0, corners.size() - 1);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const FaceTriangle triangle = triangles[i];
        add(triangle.first, triangle.middle);
        add(triangle.middle, triangle.last);
    }
}

void collect_planes(const PolytopeView& shape, double slack, std::vector<CutPlane>& planes)
{
    thread_local std::vector<FaceTriangle> triangles;
    planes.clear();
    for (std::size_t face = 0; face < shape.normals.size(); ++face) {
        if (is_flat(shape, face, slack)) {
            planes.push_back({shape.normals[face], shape.offsets[face]});
            continue;
        }
        const auto corners = shape.face(face);
        collect_triangles(shape, face, triangles);
        for (const FaceTriangle& triangle : triangles) {
            const Vec3& first = shape.vertices[corners[triangle.first]];
            const Vec3 across = (shape.vertices[corners[triangle.middle]] - first)
                                    .cross(shape.vertices[corners[triangle.last]] - first);
            const double length = across.norm();
            if (!(length > 0)) continue;
            // Of a sliver the normal may be wide of the mark; its plane is still outside the shape.
            const Vec3 normal = across / length;
            const std::uint16_t highest = support_vertex(shape, normal, corners[triangle.first]);
            planes.push_back({normal, normal.dot(shape.vertices[highest])});
        }
    }
}

}  // namespace throng
