// Convex pair input: bytes made into two convex shapes, a way of placing them, and moves.
//
// Any bytes are an input, and bytes that are missing are 0. Numbers come from short tables and
// grids, so that ties, repeats and exact alignments are as common as they are hard.
#pragma once

#include "cooking/hulls/hull.hpp"
#include "kernels/math/turn_between.hpp"
#include "narrowphase/alternatives/convex_methods.hpp"
#include "throng/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>

namespace throng {

class FuzzBytes {
public:
    explicit FuzzBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) { }

    bool empty() const { return at_ >= bytes_.size(); }
    std::uint32_t byte() { return empty() ? 0 : bytes_[at_++]; }
    std::uint32_t below(std::uint32_t count) { return byte() % count; }
    std::uint32_t word()
    {
        std::uint32_t word = 0;
        for (int i = 0; i < 4; ++i) word = word << 8 | byte();
        return word;
    }
    /// -1 to 1, on a grid of 1/128 or, finely, of 1/32768.
    double coarse() { return (static_cast<double>(byte()) - 128) / 128; }
    double fine() { return coarse() + static_cast<double>(byte()) / 32768; }
    /// 10 to the power of 0 to -most.
    double small(std::uint32_t most) { return std::pow(10, -static_cast<double>(below(most + 1))); }
    Vec3 vector()
    {
        const double x = coarse(), y = coarse();
        return {x, y, coarse()};
    }
    Vec3 direction()
    {
        if (below(2) == 0) return Vec3::Unit(static_cast<int>(below(3)));
        return unit_or<double>(vector(), Vec3::UnitZ());
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

/// Some 200 points on an ellipsoid, from few bytes: so many that corners are sought by GJK.
inline HullShape large_hull_of(FuzzBytes& bytes, double scale)
{
    const std::uint32_t count = 192 + bytes.below(64);
    const Vec3 axes(1, bytes.small(2), bytes.small(2));
    std::minstd_rand random(1 + bytes.byte());
    HullShape hull;
    while (hull.points.size() < count) {
        Vec3 point;
        for (double& number : point) number = static_cast<double>(random()) / (1U << 30) - 1;
        const double square = point.squaredNorm();
        if (square > 0.01 && square < 1)
            hull.points.push_back(scale * axes.cwiseProduct(point.normalized()));
    }
    return hull;
}

/// 4 to 40 points: on a coarse grid, beside one by a hair, slender, or anywhere; now and then far
/// from their origin. One hull in fifty is large.
inline HullShape hull_of(FuzzBytes& bytes, double scale)
{
    const std::uint32_t first = bytes.byte();
    if (first > 250) return large_hull_of(bytes, scale);
    const std::uint32_t count = 4 + first % 37, form = bytes.below(5);
    const double hair = bytes.small(15), thin = bytes.small(6);
    const double away = std::array{0.0, 0.0, 1.0, 10.0}[bytes.below(4)];
    const Vec3 offset = away == 0 ? Vec3(Vec3::Zero()) : Vec3(bytes.vector() * away);
    HullShape hull;
    for (std::uint32_t i = 0; i < count && !bytes.empty(); ++i) {
        Vec3 point;
        for (double& number : point) {
            if (form == 0 || form == 1) number = (static_cast<double>(bytes.below(5)) - 2) / 2;
            if (form == 1) number += bytes.coarse() * hair;
            if (form == 2 || form == 3) number = bytes.coarse();
            if (form == 4) number = bytes.fine();
        }
        if (form == 2) point = point.cwiseProduct(Vec3(1, thin, hair < thin ? 1 : thin));
        hull.points.push_back((point + offset) * scale);
    }
    return hull;
}

/// Any convex shape of about the scale.
inline ShapeDescription shape_of(FuzzBytes& bytes, double scale)
{
    // None shorter than a scene may state.
    const auto length = [&] {
        return std::max(1e-11, scale * (1 + bytes.below(64)) / 64 * bytes.small(3));
    };
    switch (bytes.below(12)) {
    case 0:
        return {"", SphereShape{length()}};
    case 1: {
        const double radius = length();
        return {"", CapsuleShape{radius, length()}};
    }
    case 2: {
        const double radius = length();
        return {"", CylinderShape{radius, length()}};
    }
    case 3:
    case 4:
    case 5: {
        const double x = length(), y = length();
        return {"", BoxShape{{x, y, length()}}};
    }
    default:
        return {"", hull_of(bytes, scale)};
    }
}

/// Meters, of both shapes, and how much smaller or greater the second is.
inline std::array<double, 2> scales_of(FuzzBytes& bytes)
{
    constexpr std::array kScale{1.0, 1.0, 1.0, 1e-3, 1e3, 1e-6, 1e6, 0.1};
    constexpr std::array kOther{1.0, 1.0, 1.0, 1.0, 0.1, 10.0, 1e-3, 1e3};
    const double scale = kScale[bytes.below(8)];
    return {scale, scale * kOther[bytes.below(8)]};
}

inline Quat turn_by(double angle, const Vec3& axis) { return Quat(Eigen::AngleAxisd(angle, axis)); }

/// Aligned, turned by round angles, tilted from that by a hair, or anyhow; or, of hulls, a face on
/// a face.
inline Quat turn_of(FuzzBytes& bytes, const ConvexPair& pair)
{
    constexpr double kStep = 0.26179938779914944;  // 15 degrees
    const auto step = [&] { return kStep * bytes.below(24); };
    const auto quarter = [&] { return 6 * kStep * bytes.below(4); };
    Quat turn = Quat::Identity();
    switch (bytes.below(6)) {
    case 0:
        break;
    case 1:
        turn = turn_by(quarter(), Vec3::UnitX()) * turn_by(quarter(), Vec3::UnitZ());
        break;
    case 2:
        turn = turn_by(step(), bytes.direction());
        break;
    case 3:
        if (const PolytopePair* both = pair.polytopes()) {
            const Vec3& of_a = both->a.normals[bytes.byte() % both->a.normals.size()];
            const Vec3& of_b = both->b.normals[bytes.byte() % both->b.normals.size()];
            turn = turn_between(of_b, -of_a);
        }
        break;
    default:
        turn = turn_by(3 * bytes.fine(), bytes.direction());
        break;
    }
    if (bytes.below(3) == 0) turn = turn_by(bytes.small(15), bytes.direction()) * turn;
    return turn.normalized();
}

/// Apart, below 0 deep, as far as their furthest points along a direction say.
inline double separation_beyond(const ConvexCorePair& cores, const Vec3& direction)
{
    return separation_along(cores, direction) - cores.a.convex_radius - cores.b.convex_radius;
}

/// Concentric, on a grid, far, or so that along some direction they are a known hair apart or deep.
inline Pose pose_of(FuzzBytes& bytes, ConvexPair& pair)
{
    Pose pose{Vec3::Zero(), turn_of(bytes, pair)};
    pair.place(pose);
    const ConvexCorePair& cores = pair.cores();
    const Vec3 onto = cores.a.middle - cores.b_turn * cores.b.middle;
    const std::uint32_t way = bytes.below(8);
    if (way == 0) return pose;
    pose.position = onto;
    if (way == 1) return pose;
    pose.position += bytes.vector() * pair.size() * (way == 2 ? 1.0 : bytes.small(4));
    if (way == 2 || way == 3) return pose;
    Vec3 along = bytes.direction();
    if (const PolytopePair* both = pair.polytopes(); both && way > 5)
        along = both->a.normals[bytes.byte() % both->a.normals.size()];
    const double hair = bytes.small(15), wanted = pair.size() * hair * (1.0 - bytes.below(3));
    pair.place(pose);
    pose.position += along * (wanted - separation_beyond(pair.cores(), along));
    return pose;
}

/// A small move or turn, or a leap.
inline Pose moved(FuzzBytes& bytes, const Pose& pose, ConvexPair& pair)
{
    if (bytes.below(8) == 0) return pose_of(bytes, pair);
    Pose next = pose;
    next.position += bytes.direction() * bytes.coarse() * pair.size() * bytes.small(15);
    if (bytes.below(2) == 0) {
        next.orientation =
            turn_by(bytes.coarse() * bytes.small(15), bytes.direction()) * pose.orientation;
        next.orientation.normalize();
    }
    return next;
}

/// What no question leaves behind: any features, and an axis that may be no direction at all.
inline MethodMemory garbage_of(FuzzBytes& bytes)
{
    MethodMemory memory;
    memory.kind = bytes.below(16);
    memory.count = bytes.below(8);
    const bool huge = bytes.below(4) == 0;
    for (int i = 0; i < 4; ++i) {
        memory.a[i] = huge ? bytes.word() : bytes.below(48);
        memory.b[i] = huge ? bytes.word() : bytes.below(48);
    }
    constexpr std::array kLength{1.0,  1.0, 1.0,   0.0,
                                 1e-3, 1e9, 1e300, std::numeric_limits<double>::quiet_NaN()};
    memory.axis = bytes.direction() * kLength[bytes.below(8)];
    return memory;
}

}  // namespace throng
