// Placed boxes: random pairs of boxes of every kind that boxes meet in.
#pragma once

#include "kernels/geometry/separating_axes.hpp"
#include "narrowphase/convex/wide/box_pairs.hpp"
#include "tests/support/polyhedra.hpp"

namespace throng {

struct PlacedPair {
    Vec3 half_a, half_b;
    Pose pose;  // of b in a's frame
    double speculative_margin;

    double size() const { return std::max(half_a.maxCoeff(), half_b.maxCoeff()); }
    // By how much a face may be worse than the best axis and still lead.
    double bias() const { return 1e-3 * (half_a.minCoeff() + half_b.minCoeff()); }
    BoxPair rounded() const
    {
        return box_pair(cast<float>(pose), half_a.cast<float>(), half_b.cast<float>(),
                        static_cast<float>(speculative_margin));
    }
    LocalManifold<double> twin() const
    {
        return run<double>(box_box<double>, two_boxes(half_a, half_b), kBoxA, kBoxB, pose,
                           speculative_margin);
    }
};

// clang-format off
enum class Kind { anywhere, near, deep, upright, stacked, turned_about_z, askew, edges };
inline constexpr Kind kKinds[] = {Kind::anywhere, Kind::near,    Kind::deep,           Kind::upright,
                                  Kind::askew,    Kind::stacked, Kind::turned_about_z, Kind::edges};
inline constexpr const char* kNames[] = {"anywhere", "near", "deep", "upright",
                                         "stacked", "turned about z", "askew", "edges"};
// clang-format on

inline Quat about(const Vec3& axis, double angle)
{
    return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

// b moved along `from` until it comes to `clearance` of touching.
inline void bring_near(PlacedPair& pair, const Vec3& from, double clearance)
{
    double touching = 0, apart = 4 * (pair.half_a.norm() + pair.half_b.norm());
    for (int i = 0; i < 40; ++i) {
        const double middle = (touching + apart) / 2;
        pair.pose.position = middle * from;
        const BoxPolytope a(pair.half_a), b(pair.half_b);
        const bool touch = polytope_separation(a.view(), b.view(), pair.pose, nullptr) <= 0;
        (touch ? touching : apart) = middle;
    }
    pair.pose.position = (apart + clearance) * from;
}

// An edge of b along its y lies across a's upper edge along x.
inline void place_edge_on_edge(RandomShapes& random, PlacedPair& pair)
{
    const Vec3 out = Vec3(0, 1, 1).normalized(), across(0, out.y(), -out.z());
    Mat3 axes;
    axes << (Vec3::UnitX() + out).normalized(), across, (out - Vec3::UnitX()).normalized();
    if (axes.determinant() < 0) axes.col(1) *= -1;
    const Quat turn = about(random.vector(-1, 1), random.number(-0.3, 0.3)) * Quat(axes);
    const Vec3 on_a(random.number(-0.1, 0.1), pair.half_a.y(), pair.half_a.z());
    const Vec3 on_b(-pair.half_b.x(), random.number(-0.1, 0.1), -pair.half_b.z());
    pair.pose = {on_a - turn * on_b + out * random.number(-0.02, 0.015), turn};
}

inline PlacedPair random_pair(RandomShapes& random, Kind kind)
{
    PlacedPair pair{random.vector(0.2, 1), random.vector(0.2, 1), random.pose(1.5), 0.02};
    const double lies = pair.half_a.z() + pair.half_b.z() + random.number(-0.01, 0.015);
    switch (kind) {
    case Kind::anywhere:
        break;
    case Kind::near:
        bring_near(pair, random.vector(-1, 1).normalized(), random.number(-0.02, 0.03));
        break;
    case Kind::deep:
        pair.pose.position *= 0.2;
        break;
    case Kind::upright:
        pair.pose.orientation.setIdentity();
        break;
    case Kind::stacked:
        pair.pose = at(random.number(-0.5, 0.5), random.number(-0.5, 0.5), lies);
        break;
    case Kind::turned_about_z:
        pair.pose = {{random.number(-0.5, 0.5), random.number(-0.5, 0.5), lies},
                     about(Vec3::UnitZ(), random.number(-3, 3))};
        break;
    case Kind::askew:
        pair.pose = {{random.number(-0.5, 0.5), random.number(-0.5, 0.5), lies},
                     about(random.vector(-1, 1), random.number(-0.05, 0.05))};
        break;
    case Kind::edges:
        place_edge_on_edge(random, pair);
        break;
    }
    return pair;
}

inline std::vector<PlacedPair> random_pairs(std::uint64_t seed, Kind kind, int count)
{
    RandomShapes random(seed);
    std::vector<PlacedPair> pairs;
    for (int i = 0; i < count; ++i) pairs.push_back(random_pair(random, kind));
    return pairs;
}

}  // namespace throng
