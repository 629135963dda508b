// Capsule on hull: in closed form where an end looks straight down on a face, which is how capsules
// rest; whatever else touches is searched for. In double: hulls are stored so.
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/convex/rod_contacts.hpp"

namespace throng {

namespace {

struct Seen {
    const Hull& hull;
    Rod<double> rod;
    double noise;  // rounding errors of coordinates stay below this
};

template <class Real>
Seen seen_from_hull(const Capsule& capsule, const Hull& hull, const PoseT<Real>& b_in_a)
{
    Seen seen = {hull, {}, 0};
    const Mat3 turn = b_in_a.orientation.template cast<double>().normalized().toRotationMatrix();
    seen.rod.center = -(turn.transpose() * b_in_a.position.template cast<double>());
    seen.rod.along = turn.row(2).transpose();
    seen.rod.half = capsule.half_length;
    seen.rod.radius = capsule.radius;
    seen.rod.rounding = capsule.radius;
    const double greatest = seen.rod.center.cwiseAbs().maxCoeff() + seen.rod.half;
    seen.noise = 4 * std::numeric_limits<double>::epsilon() * greatest;
    return seen;
}

double above_face(const Seen& seen, std::size_t face)
{
    const Vec3& normal = seen.hull.normals[face];
    return normal.dot(seen.rod.center) - seen.hull.offsets[face]
        - seen.rod.half * std::abs(normal.dot(seen.rod.along));
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
    const Vec3 end = seen.rod.at(at);
    bool inside = true;
    for_each_side(seen.hull, face, [&](const Vec3& out, const Vec3& corner) {
        inside = inside && out.dot(end - corner) <= 0;
    });
    return inside;
}

// The way out over a face, if the lowest end looks straight down on it: no other is nearer then.
bool stands_clear(const Seen& seen, std::size_t face, double above, RodAxis<double>& axis)
{
    if (!(above > 0)) return false;
    axis.outward = seen.hull.normals[face];
    axis.at = axis.outward.dot(seen.rod.along) > 0 ? -seen.rod.half : seen.rod.half;
    axis.separation = above;
    return stands_on(seen, face, axis.at);
}

RodStretch<double> over_face(const Seen& seen, std::size_t face)
{
    const Rod<double>& rod = seen.rod;
    const Vec3& normal = seen.hull.normals[face];
    RodStretch<double> stretch = {-rod.half, rod.half,
                                  normal.dot(rod.center) - seen.hull.offsets[face],
                                  normal.dot(rod.along)};
    for_each_side(seen.hull, face, [&](const Vec3& out, const Vec3& corner) {
        const double length = length_of(out);
        if (!(length > 0)) return;
        const double slope = out.dot(rod.along) / length;
        stretch.cut(out.dot(rod.center - corner) / length, slope,
                    seen.noise + beside_edge(rod, slope));
    });
    return stretch;
}

}  // namespace

template <class Real>
void capsule_hull(const Shapes& shapes,
                  ShapeRef a,
                  ShapeRef b,
                  const PoseT<Real>& b_in_a,
                  Real reach,
                  PairCache& cache,
                  LocalManifold<Real>& out)
{
    out.count = 0;
    const Hull& hull = shapes.hulls[b.index];
    const Seen seen = seen_from_hull(shapes.capsules[a.index], hull, b_in_a);
    const double limit = static_cast<double>(reach) + seen.rod.radius;
    RodAxis<double> axis;
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
            convex_convex(shapes, a, b, b_in_a, reach, cache, out);
            return;
        }
    }

    LocalManifold<double> found;
    found.normal = b_in_a.orientation.template cast<double>().normalized() * -axis.outward;
    if (!lies_across(seen.rod, axis)
        || !touch_along(seen.rod, axis, over_face(seen, face), seen.noise,
                        static_cast<double>(reach), found)) {
        touch_at(seen.rod, axis, found);
    }
    out = found.cast<Real>();
}

THRONG_PAIR_INSTANCES(capsule_hull)

}  // namespace throng
