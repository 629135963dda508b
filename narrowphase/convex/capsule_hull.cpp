// Capsule on hull: in closed form where an end looks straight down on a face, which is how capsules
// rest; whatever else touches is searched for. In double: hulls are stored so.
#include "narrowphase/convex/capsule_contacts.hpp"
#include "narrowphase/convex/pair_functions.hpp"

namespace throng {

namespace {

struct Seen {
    const Hull& hull;
    CapsuleSegment<double> segment;
    double noise;  // rounding errors of coordinates stay below this
};

template <class Real>
Seen seen_from_hull(const Capsule& capsule, const Hull& hull, const PoseT<Real>& b_in_a)
{
    Seen seen = {hull, {}, 0};
    const Mat3 turn = b_in_a.orientation.template cast<double>().normalized().toRotationMatrix();
    seen.segment.center = -(turn.transpose() * b_in_a.position.template cast<double>());
    seen.segment.along = turn.row(2).transpose();
    seen.segment.half = capsule.half_length;
    seen.segment.radius = capsule.radius;
    seen.segment.convex_radius = capsule.radius;
    const double greatest = seen.segment.center.cwiseAbs().maxCoeff() + seen.segment.half;
    seen.noise = 4 * std::numeric_limits<double>::epsilon() * greatest;
    return seen;
}

double above_face(const Seen& seen, std::size_t face)
{
    const Vec3& normal = seen.hull.normals[face];
    return normal.dot(seen.segment.center) - seen.hull.offsets[face]
        - seen.segment.half * std::abs(normal.dot(seen.segment.along));
}

std::size_t face_furthest_below(const Seen& seen)
{
    std::size_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < seen.hull.normals.size(); ++i) {
        const double above = above_face(seen, i);
        if (!(above > most)) continue;
        most = above;
        best = i;
    }
    return best;
}

// Calls with each side plane of a face: outward, and a corner that it goes through.
template <class Call>
void for_each_side(const Hull& hull, std::size_t face, const Call& call)
{
    const std::size_t begin = hull.face_begin[face], end = hull.face_begin[face + 1];
    Vec3 from = hull.vertices[hull.face_vertices[end - 1]];
    for (std::size_t i = begin; i < end; ++i) {
        const Vec3& to = hull.vertices[hull.face_vertices[i]];
        call(Vec3((to - from).cross(hull.normals[face])), from);
        from = to;
    }
}

bool stands_on(const Seen& seen, std::size_t face, double at)
{
    const Vec3 end = seen.segment.at(at);
    bool inside = true;
    for_each_side(seen.hull, face, [&](const Vec3& out, const Vec3& corner) {
        inside = inside && out.dot(end - corner) <= 0;
    });
    return inside;
}

// The way out over a face, if the lowest end looks straight down on it: no other is nearer then.
bool stands_clear(const Seen& seen, std::size_t face, double above, CapsuleAxis<double>& axis)
{
    if (!(above > 0)) return false;
    axis.outward = seen.hull.normals[face];
    axis.at = axis.outward.dot(seen.segment.along) > 0 ? -seen.segment.half : seen.segment.half;
    axis.separation = above;
    return stands_on(seen, face, axis.at);
}

SegmentRange<double> over_face(const Seen& seen, std::size_t face)
{
    const CapsuleSegment<double>& segment = seen.segment;
    const Vec3& normal = seen.hull.normals[face];
    SegmentRange<double> range = {-segment.half, segment.half,
                                  normal.dot(segment.center) - seen.hull.offsets[face],
                                  normal.dot(segment.along)};
    for_each_side(seen.hull, face, [&](const Vec3& out, const Vec3& corner) {
        const double length = length_of(out);
        if (!(length > 0)) return;
        const double slope = out.dot(segment.along) / length;
        range.cut(out.dot(segment.center - corner) / length, slope,
                  seen.noise + beside_edge(segment, slope));
    });
    return range;
}

}  // namespace

template <class Real>
void capsule_hull(const PairInput<Real>& in, PairCache& cache, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    out.count = 0;
    const Hull& hull = shapes.hulls[b.index];
    const Seen seen = seen_from_hull(shapes.capsules[a.index], hull, b_in_a);
    const double limit = static_cast<double>(speculative_margin) + seen.segment.radius;
    CapsuleAxis<double> axis;
    // The face known from last time, while it proves to be the one; else the best of all.
    std::size_t face = cache.feature_b;
    double above = 0;
    if (cache.kind != 0 && face < hull.normals.size()) {
        above = above_face(seen, face);
        if (above > limit) return;
    }
    if (!(above > 0) || !stands_clear(seen, face, above, axis)) {
        face = face_furthest_below(seen);
        above = above_face(seen, face);
        cache.kind = 1;
        cache.feature_b = static_cast<std::uint32_t>(face);
        if (above > limit) return;
        if (!stands_clear(seen, face, above, axis)) {
            convex_convex({shapes, a, b, b_in_a, speculative_margin}, cache, out);
            return;
        }
    }

    LocalManifold<double> found;
    found.normal = b_in_a.orientation.template cast<double>().normalized() * -axis.outward;
    if (!lies_across(seen.segment, axis)
        || !add_capsule_ends(seen.segment, axis, over_face(seen, face), seen.noise,
                             static_cast<double>(speculative_margin), found)) {
        add_capsule_point(seen.segment, axis, found);
    }
    out = found.cast<Real>();
}

THRONG_PAIR_INSTANCES(capsule_hull)

}  // namespace throng
