#include "narrowphase/solid/voxel_pairs.hpp"

#include "narrowphase/solid/surface_walk.hpp"
#include "narrowphase/solid/voxel_probes.hpp"

#include <algorithm>

namespace throng {
namespace {

std::vector<PointCandidate>& scratch()
{
    thread_local std::vector<PointCandidate> found;
    found.clear();
    return found;
}

// Points of a: out of the other shape is from b to a.
template <class Other>
double find_points_of_a(const Solid& a,
                        const Other& other,
                        const Pose& other_in_a,
                        double speculative_margin,
                        std::vector<ContactCandidate>& out)
{
    std::vector<PointCandidate>& found = scratch();
    const double apart = walk_surface(a.points, other, other_in_a, speculative_margin, found);
    for (const PointCandidate& candidate : found)
        out.push_back({candidate.position - candidate.outward * (candidate.distance / 2),
                       -candidate.outward, candidate.distance,
                       candidate_feature(CandidateSide::a, candidate.point)});
    return apart;
}

double find_points_of_b(const Solid& a,
                        const Solid& b,
                        const Pose& b_in_a,
                        double speculative_margin,
                        std::vector<ContactCandidate>& out)
{
    std::vector<PointCandidate>& found = scratch();
    const double apart =
        walk_surface(b.points, FieldSide(a), b_in_a.inverse(), speculative_margin, found);
    const Mat3 turn = b_in_a.orientation.toRotationMatrix();
    for (const PointCandidate& candidate : found) {
        const Vec3 between = candidate.position - candidate.outward * (candidate.distance / 2);
        out.push_back({turn * between + b_in_a.position, turn * candidate.outward,
                       candidate.distance, candidate_feature(CandidateSide::b, candidate.point)});
    }
    return apart;
}

// Behind a static mesh nothing says how thick it is: no deeper than half of the solid, and than
// four of the distances between its points, beyond where it was pressed to before. But who has his
// middle before it is before it, and as deep in it as he lies: small bodies turn by radians as they
// land, and what is thin goes in by all of its thickness.
double find_points_on_mesh(const Solid& a,
                           const Mesh& mesh,
                           const Pose& mesh_in_a,
                           double speculative_margin,
                           double pressed_in,
                           std::vector<ContactCandidate>& out)
{
    const Box3 box = FieldSide(a).box();
    const Vec3 size = box.upper - box.lower;
    const double unknown = std::min(0.25 * size.minCoeff(), 4 * a.points.spacing);
    MeshLimits limits;
    limits.middle = mesh_in_a.to_local(0.5 * (box.lower + box.upper));
    limits.speculative_margin = speculative_margin;
    limits.deepest = limits.deepest_before = std::min(unknown + pressed_in, size.norm());
    limits.past_rim = unknown;
    const MeshSide near(mesh, limits);
    const std::size_t before = out.size();
    const double apart = find_points_of_a(a, near, mesh_in_a, speculative_margin, out);
    if (!near.pressed_in()) return apart;
    // Few are, and to look so far takes longer.
    limits.deepest_before = size.norm();
    out.resize(before);
    return find_points_of_a(a, MeshSide(mesh, limits), mesh_in_a, speculative_margin, out);
}

}  // namespace

double find_voxel_candidates(const Shapes& shapes,
                             const Solid& a,
                             ShapeRef other,
                             const Pose& other_in_a,
                             double speculative_margin,
                             double pressed_in,
                             std::vector<ContactCandidate>& out)
{
    const bool has_field = !a.field.empty();
    double apart = std::numeric_limits<double>::infinity();
    switch (other.kind) {
    case ShapeKind::solid: {
        const Solid& b = shapes.solids[other.index];
        if (!b.field.empty())
            apart = find_points_of_a(a, FieldSide(b), other_in_a, speculative_margin, out);
        if (has_field)
            apart = std::min(apart, find_points_of_b(a, b, other_in_a, speculative_margin, out));
        return apart;
    }
    case ShapeKind::mesh: {
        const Mesh& mesh = shapes.meshes[other.index];
        apart = find_points_on_mesh(a, mesh, other_in_a, speculative_margin, pressed_in, out);
        if (has_field) probe_mesh(a, mesh, other_in_a, speculative_margin, out);
        break;
    }
    default:
        apart = find_points_of_a(a, ConvexSide(shapes, other), other_in_a, speculative_margin, out);
        // A plane has nothing of its own.
        if (!has_field || other.kind == ShapeKind::plane) return apart;
        probe_convex(shapes, a, other, other_in_a, speculative_margin, out);
    }
    // What sticks out of the other may be between the points, and is told by the field.
    return apart - a.points.spacing - a.field.voxel;
}

}  // namespace throng
