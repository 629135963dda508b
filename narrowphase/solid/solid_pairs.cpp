#include "narrowphase/solid/solid_pairs.hpp"

#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/solid/image_candidates.hpp"
#include "narrowphase/solid/sphere_candidates.hpp"
#include "narrowphase/solid/voxel_pairs.hpp"

#include <algorithm>
#include <limits>

namespace throng {
namespace {

// Part of its size from which on all that is deep of a body is alike, in what is mostly a floor:
// who is pressed in, and leans by as much as he turns in a step, is to be pushed out all over, or
// his ends come out and go in by turns.
constexpr double kDeep = 0.08;

// Half the diagonal of its box; a plane has no end.
double size_of(const Shapes& shapes, ShapeRef shape)
{
    if (shape.kind == ShapeKind::hull) return shapes.hulls[shape.index].outer_radius;
    const Box3 box = shape_bounds(shapes, shape, Pose{});
    return 0.5 * (box.upper - box.lower).norm();
}

// How far two boxes are apart along the axis of the first that parts them most; below 0 where none
// does.
double separation_between(const Box3& a, const Box3& b)
{
    return std::max((a.lower - b.upper).maxCoeff(), (b.lower - a.upper).maxCoeff());
}

// How far the two are apart at least: their boxes as each sees the other's.
double
least_separation(const Shapes& shapes, ShapeRef solid, ShapeRef other, const Pose& other_in_solid)
{
    const double separation = separation_between(shape_bounds(shapes, solid, Pose{}),
                                                 shape_bounds(shapes, other, other_in_solid));
    if (other.kind != ShapeKind::solid && other.kind != ShapeKind::box) return separation;
    return std::max(separation,
                    separation_between(shape_bounds(shapes, other, Pose{}),
                                       shape_bounds(shapes, solid, other_in_solid.inverse())));
}

// The other's spheres against this one, told from this one.
void find_candidates_from_other(const PairInput<double>& in,
                                std::vector<ContactCandidate>& candidates)
{
    const auto& [shapes, solid, other, other_in_solid, speculative_margin] = in;
    find_sphere_candidates({shapes, other, solid, other_in_solid.inverse(), speculative_margin}, {},
                           candidates);
    for (ContactCandidate& candidate : candidates) {
        candidate.position = other_in_solid * candidate.position;
        candidate.normal = other_in_solid.orientation * -candidate.normal;
    }
}

}  // namespace

double shape_error(const Shapes& shapes, ShapeRef shape)
{
    return shape.kind == ShapeKind::solid ? shapes.solids[shape.index].error : 0;
}

SolidAnswer
collide_solid(const PairInput<double>& in, std::vector<PartManifold>& out, double pressed_in)
{
    const auto& [shapes, solid, other, other_in_solid, speculative_margin] = in;
    SolidAnswer answer;
    // Spheres may reach out of it by so much.
    answer.apart = least_separation(shapes, solid, other, other_in_solid)
        - shape_error(shapes, solid) - shape_error(shapes, other);
    if (answer.apart > speculative_margin) return answer;
    thread_local std::vector<ContactCandidate> candidates;
    candidates.clear();
    const SolidRepresentation representation = shapes.solids[solid.index].representation;
    const SolidRepresentation other_representation = other.kind == ShapeKind::solid
        ? shapes.solids[other.index].representation
        : SolidRepresentation::voxels;
    if (representation == SolidRepresentation::depth_image
        || other_representation == SolidRepresentation::depth_image)
        find_image_candidates({shapes, solid, other, other_in_solid, speculative_margin},
                              candidates);
    else if (representation == SolidRepresentation::spheres)
        find_sphere_candidates({shapes, solid, other, other_in_solid, speculative_margin}, {},
                               candidates);
    else if (other_representation == SolidRepresentation::spheres)
        find_candidates_from_other({shapes, solid, other, other_in_solid, speculative_margin},
                                   candidates);
    else
        answer.apart = std::max(answer.apart,
                                find_voxel_candidates(shapes, shapes.solids[solid.index], other,
                                                      other_in_solid, speculative_margin,
                                                      pressed_in, candidates));
    const double size = std::min(size_of(shapes, solid), size_of(shapes, other));
    const double deep =
        other.kind == ShapeKind::solid ? std::numeric_limits<double>::infinity() : kDeep * size;
    answer.left_out = make_patches(candidates, speculative_margin, size, deep, out);
    return answer;
}

}  // namespace throng
