#include "kernels/geometry/gjk.hpp"

#include "kernels/geometry/hill_climbing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

constexpr double kTolerance = 1e-14;  // of the size; some fifty times double's spacing

// A candidate for the point of a simplex nearest to 0, as weights of the corners it uses.
struct Nearest {
    Vec3 point = Vec3::Zero();
    double square = std::numeric_limits<double>::infinity();
    std::array<int, 3> corners = {};
    std::array<double, 3> weights = {};
    int count = 0;
};

void keep_nearer(Nearest& best, const Nearest& other)
{
    if (other.square < best.square) best = other;
}

Nearest nearest_of_point(const Simplex& simplex, int a)
{
    const Vec3& point = simplex.corners[static_cast<std::size_t>(a)].point;
    return {point, point.squaredNorm(), {a}, {1}, 1};
}

Nearest nearest_of_edge(const Simplex& simplex, int a, int b)
{
    const Vec3& from = simplex.corners[static_cast<std::size_t>(a)].point;
    const Vec3& to = simplex.corners[static_cast<std::size_t>(b)].point;
    const Vec3 along = to - from;
    const double square = along.squaredNorm();
    const double part = -from.dot(along);
    if (!(part > 0)) return nearest_of_point(simplex, a);
    if (!(part < square)) return nearest_of_point(simplex, b);
    const double t = part / square;
    // Measured from the nearer end, which is where the sum loses least.
    const Vec3 point = t < 0.5 ? Vec3(from + along * t) : Vec3(to - along * (1 - t));
    return {point, point.squaredNorm(), {a, b}, {1 - t, t}, 2};
}

Nearest nearest_of_triangle(const Simplex& simplex, int a, int b, int c)
{
    const Vec3& pa = simplex.corners[static_cast<std::size_t>(a)].point;
    const Vec3& pb = simplex.corners[static_cast<std::size_t>(b)].point;
    const Vec3& pc = simplex.corners[static_cast<std::size_t>(c)].point;
    const Vec3 ab = pb - pa;
    const Vec3 ac = pc - pa;
    const Vec3 bc = pc - pb;
    const Vec3 normal = ab.cross(ac);
    const double square = normal.squaredNorm();
    // Twice the signed areas of 0's shadow against each side, times the normal's length.
    const double against_ab = normal.dot(pa.cross(ab));
    const double against_bc = normal.dot(pb.cross(bc));
    const double against_ca = -normal.dot(pa.cross(ac));
    if (square > 0 && against_ab > 0 && against_bc > 0 && against_ca > 0) {
        const double sum = against_ab + against_bc + against_ca;
        const Vec3 point = normal * (normal.dot(pa) / square);
        return {point,
                point.squaredNorm(),
                {a, b, c},
                {against_bc / sum, against_ca / sum, against_ab / sum},
                3};
    }
    Nearest best = nearest_of_edge(simplex, a, b);
    keep_nearer(best, nearest_of_edge(simplex, a, c));
    keep_nearer(best, nearest_of_edge(simplex, b, c));
    return best;
}

// Whether 0 lies within the tetrahedron; a flat one contains nothing.
bool tetrahedron_has_zero(const Simplex& simplex)
{
    const Vec3& a = simplex.corners[0].point;
    const Vec3& b = simplex.corners[1].point;
    const Vec3& c = simplex.corners[2].point;
    const Vec3& d = simplex.corners[3].point;
    const double volume = (b - a).cross(c - a).dot(d - a);
    const double scale = (b - a).norm() * (c - a).norm() * (d - a).norm();
    if (!(std::abs(volume) > 1e-14 * scale)) return false;
    const double sign = volume > 0 ? 1 : -1;
    const double of_d = -sign * a.dot(b.cross(c));
    const double of_c = sign * a.dot(b.cross(d));
    const double of_b = -sign * a.dot(c.cross(d));
    const double of_a = sign * b.dot(c.cross(d));
    return of_a >= 0 && of_b >= 0 && of_c >= 0 && of_d >= 0;
}

Nearest nearest_of(const Simplex& simplex)
{
    switch (simplex.count) {
    case 1:
        return nearest_of_point(simplex, 0);
    case 2:
        return nearest_of_edge(simplex, 0, 1);
    case 3:
        return nearest_of_triangle(simplex, 0, 1, 2);
    default:
        break;
    }
    // The newest corner was found beyond the face of the others, so that face is never nearest.
    Nearest best = nearest_of_triangle(simplex, 0, 1, 3);
    keep_nearer(best, nearest_of_triangle(simplex, 0, 2, 3));
    keep_nearer(best, nearest_of_triangle(simplex, 1, 2, 3));
    return best;
}

// Corners are named in order, so that none is overwritten before it is moved.
void reduce(Simplex& simplex, const Nearest& nearest)
{
    simplex.count = nearest.count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(nearest.count); ++i) {
        const auto from = static_cast<std::size_t>(nearest.corners[i]);
        if (from != i) simplex.corners[i] = simplex.corners[from];
        simplex.weights[i] = nearest.weights[i];
    }
}

bool has(const Simplex& simplex, const Vec3& point)
{
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
        if (simplex.corners[i].point == point) return true;
    }
    return false;
}

void finish(Distance& result, const Vec3& nearest)
{
    result.apart = true;
    result.distance = nearest.norm();
    result.normal = -nearest / result.distance;
    result.on_a.setZero();
    result.on_b.setZero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(result.simplex.count); ++i) {
        result.on_a += result.simplex.corners[i].on_a * result.simplex.weights[i];
        result.on_b += result.simplex.corners[i].on_b * result.simplex.weights[i];
    }
}

// The first simplex, the furthest difference from center to center. The direction is told too, for
// what it shows already.
template <class Furthest>
Vec3 begin_between_centers(const ConvexCorePair& pair, Furthest& furthest, Simplex& simplex)
{
    Vec3 start = pair.a.middle - (pair.b_turn * pair.b.middle + pair.b_position);
    if (!(start.squaredNorm() > 0)) start = Vec3::UnitX();
    simplex.corners[0] = furthest(-start);
    simplex.weights[0] = 1;
    simplex.count = 1;
    return start;
}

// From a simplex and its point nearest to 0.
template <class Furthest>
void walk(
    const ConvexCorePair& pair, double limit, Furthest& furthest, Vec3 nearest, Distance& result)
{
    Simplex& simplex = result.simplex;
    const double slack = kTolerance * (pair.size + pair.b_position.norm());
    while (result.iterations++ < kMostRounds) {
        const double length = nearest.norm();
        if (!(length > slack)) return;
        const MinkowskiVertex further = furthest(-nearest);
        const double bound = nearest.dot(further.point) / length;
        if (bound > limit) {
            finish(result, nearest);
            result.beyond = true;
            result.distance = bound;
            return;
        }
        if (length - bound <= slack || has(simplex, further.point)) break;

        simplex.corners[static_cast<std::size_t>(simplex.count++)] = further;
        if (simplex.count == 4 && tetrahedron_has_zero(simplex)) return;
        const Nearest next = nearest_of(simplex);
        if (!(next.square < length * length)) {
            --simplex.count;
            result.stalled = true;
            break;
        }
        reduce(simplex, next);
        nearest = next.point;
    }
    if (nearest.norm() > slack) finish(result, nearest);
}

}  // namespace

ConvexCorePair::ConvexCorePair(const Shapes& shapes,
                               ShapeRef shape_a,
                               ShapeRef shape_b,
                               const Pose& b_in_a)
    : ConvexCorePair(
        convex_core_of<double>(shapes, shape_a), convex_core_of<double>(shapes, shape_b), b_in_a)
{ }

ConvexCorePair::ConvexCorePair(const ConvexCore<double>& core_a,
                               const ConvexCore<double>& core_b,
                               const Pose& b_in_a)
    : a(core_a), b(core_b), b_position(b_in_a.position),
      b_turn(b_in_a.orientation.toRotationMatrix()), size(a.size + b.size)
{ }

MinkowskiVertex minkowski_support(const ConvexCorePair& pair, const Vec3& direction)
{
    MinkowskiVertex difference;
    const Vec3 against = pair.b_turn.transpose() * -direction;
    const SupportPoint<double> of_a = support(pair.a, direction);
    const SupportPoint<double> of_b = support(pair.b, against);
    difference.on_a = of_a.position;
    difference.on_b = pair.b_turn * of_b.position + pair.b_position;
    difference.point = difference.on_a - difference.on_b;
    difference.feature_a = of_a.feature;
    difference.feature_b = of_b.feature;
    return difference;
}

double separation_along(const ConvexCorePair& pair, const Vec3& direction)
{
    return -direction.dot(minkowski_support(pair, direction).point);
}

SweptDistance swept_gjk(const ConvexCorePair& pair, const Vec3& motion, double limit)
{
    constexpr std::uint32_t kMoved = 1u << 31;  // of a difference: b was at the end of its way
    const auto furthest = [&](const Vec3& direction) {
        MinkowskiVertex difference = minkowski_support(pair, direction);
        if (direction.dot(motion) < 0) {
            difference.on_b += motion;
            difference.point -= motion;
            difference.feature_b |= kMoved;
        }
        return difference;
    };
    ConvexCorePair path = pair;
    path.size += motion.norm();
    SweptDistance swept;
    Distance& nearest = swept.nearest;
    begin_between_centers(path, furthest, nearest.simplex);
    walk(path, limit, furthest, nearest.simplex.corners[0].point, nearest);
    if (!nearest.apart) return swept;
    for (std::size_t i = 0; i < static_cast<std::size_t>(nearest.simplex.count); ++i)
        if ((nearest.simplex.corners[i].feature_b & kMoved) != 0)
            swept.at += nearest.simplex.weights[i];
    swept.at = std::clamp(swept.at, 0.0, 1.0);
    return swept;
}

Distance gjk(const ConvexCorePair& pair, double limit)
{
    const auto furthest = [&](const Vec3& direction) { return minkowski_support(pair, direction); };
    Distance result;
    begin_between_centers(pair, furthest, result.simplex);
    walk(pair, limit, furthest, result.simplex.corners[0].point, result);
    return result;
}

Distance gjk(const ConvexCorePair& pair,
             double limit,
             HillClimbingSupports& supports,
             const Simplex& beginning)
{
    Distance result;
    Simplex& simplex = result.simplex;
    if (beginning.count == 0) {
        const Vec3 start = begin_between_centers(pair, supports, simplex);
        const Vec3& corner = simplex.corners[0].point;
        result.iterations = 1;
        const double length = start.norm();
        if (start.dot(corner) > limit * length) {
            finish(result, corner);
            result.beyond = true;
            result.distance = start.dot(corner) / length;
            result.normal = -start / length;
            return result;
        }
        walk(pair, limit, supports, corner, result);
        return result;
    }
    simplex = beginning;
    if (simplex.count == 4 && tetrahedron_has_zero(simplex)) return result;
    Nearest next = nearest_of(simplex);
    // Nothing is known of which corner came last.
    if (simplex.count == 4) keep_nearer(next, nearest_of_triangle(simplex, 0, 1, 2));
    reduce(simplex, next);
    walk(pair, limit, supports, next.point, result);
    return result;
}

}  // namespace throng
