#include "cost/hard_cases/certified_pairs.hpp"

#include "scene/catalog/parts.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr double kLeastSeparation = 1e-9, kGreatestSeparation = 0.3;

const Vec3& furthest(const Hull& hull, const Vec3& direction)
{
    return *std::max_element(hull.vertices.begin(), hull.vertices.end(),
                             [&](const Vec3& one, const Vec3& other) {
                                 return direction.dot(one) < direction.dot(other);
                             });
}

double log_uniform(Random& random, double low, double high)
{
    return low * std::pow(high / low, random.unit());
}

// Any, none, a quarter, or one of those and a hair.
Quat awkward_turn(Random& random)
{
    Quat turn = random_turn(random);
    const std::uint32_t kind = random.below(4);
    if (kind == 0) return turn;
    turn = Quat::Identity();
    if (kind == 2) turn = Quat(1, 1, 0, 0).normalized();
    if (kind == 3)
        turn =
            exponential(log_uniform(random, 1e-12, 1e-2) * (random_turn(random) * Vec3::UnitX()));
    return turn;
}

Vec3 edge_of(const Hull& hull, Random& random)
{
    const Hull::Edge& edge =
        hull.edges[random.below(static_cast<std::uint32_t>(hull.edges.size()))];
    return hull.vertices[edge.to] - hull.vertices[edge.from];
}
const Vec3& normal_of(const Hull& hull, Random& random)
{
    return hull.normals[random.below(static_cast<std::uint32_t>(hull.normals.size()))];
}

// From a to b: at random, square to a face, or square to two edges.
Vec3 direction_between(const Hull& a, const Hull& b, const Quat& turn, Random& random)
{
    switch (random.below(4)) {
    case 0:
        return normal_of(a, random);
    case 1:
        return -(turn * normal_of(b, random));
    case 2: {
        const Vec3 across = edge_of(a, random).cross(turn * edge_of(b, random));
        if (across.norm() > 1e-3) return across.normalized();
        break;
    }
    default:
        break;
    }
    return random_turn(random) * Vec3::UnitX();
}

// A point of the surface: a vertex, or somewhere on an edge or a face beside it.
Vec3 surface_point(const Hull& hull, Random& random)
{
    const std::size_t face = random.below(static_cast<std::uint32_t>(hull.normals.size()));
    const std::uint32_t begin = hull.face_begin[face], count = hull.face_begin[face + 1] - begin;
    const std::uint32_t corners = 1 + random.below(3), first = random.below(count);
    Vec3 point = Vec3::Zero();
    double sum = 0;
    for (std::uint32_t i = 0; i < std::min(corners, count); ++i) {
        const double weight = random.uniform(0.1, 1);
        point += weight * hull.vertices[hull.face_vertices[begin + (first + i) % count]];
        sum += weight;
    }
    return point / sum;
}

}  // namespace

double certified_size(const Hull& a, const Hull& b)
{
    return std::max(a.outer_radius, b.outer_radius);
}

Quat random_turn(Random& random)
{
    while (true) {
        const double w = random.uniform(-1, 1), x = random.uniform(-1, 1);
        const double y = random.uniform(-1, 1), z = random.uniform(-1, 1);
        const Quat turn(w, x, y, z);
        const double square = turn.squaredNorm();
        if (square > 0.01 && square < 1) return turn.normalized();
    }
}

Hull random_hull(Random& random, int points)
{
    Vec3 axes = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) axes[axis] = random.uniform(0.3, 1);
    std::vector<Vec3> cloud;
    while (static_cast<int>(cloud.size()) < points) {
        const Vec3 point = random_vector(random, -1, 1);
        const double square = point.squaredNorm();
        if (square > 0.01 && square < 1) cloud.emplace_back(axes.cwiseProduct(point.normalized()));
    }
    return build_hull(cloud).hull;
}

CertifiedPair certified_pair(const Hull& a, const Hull& b, Random& random)
{
    CertifiedPair pair;
    const Quat turn = random.below(2) == 0 ? random_turn(random) : awkward_turn(random);
    pair.b_in_a.orientation = turn;
    pair.separation =
        log_uniform(random, kLeastSeparation, kGreatestSeparation) * certified_size(a, b);
    pair.touching = random.below(2) == 0;

    if (!pair.touching) {
        if (random.below(8) == 0)
            pair.separation =
                log_uniform(random, kFarSeparation, 10 * kFarSeparation) * certified_size(a, b);
        // A vertex of b above a point of a's furthest face, edge or vertex; then aside, along the
        // plane between them, so that faces lie over one another in all ways.
        const Vec3 along = direction_between(a, b, turn, random);
        const Vec3 lowest = turn * furthest(b, turn.conjugate() * -along);
        const Vec3 aside = random_vector(random, -1, 1) * random.uniform(0, 1) * a.outer_radius;
        pair.b_in_a.position = furthest(a, along) - lowest + pair.separation * along
            + (random.below(2) == 0 ? aside - along * along.dot(aside) : Vec3(Vec3::Zero()));
        return pair;
    }
    // Some point of b, its center at times, comes to a point as deep in a as the gap says.
    const bool centers = random.below(8) == 0;
    const double share = std::min(1.0, pair.separation / a.inner_radius);
    const Vec3 skin = surface_point(a, random);
    const Vec3 in_a = centers ? a.center : Vec3(skin + share * (a.center - skin));
    const Vec3 in_b = centers ? b.center : surface_point(b, random);
    pair.separation = centers ? a.inner_radius : share * a.inner_radius;
    pair.b_in_a.position = in_a - turn * in_b;
    return pair;
}

}  // namespace throng
