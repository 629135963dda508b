// Convex pair: two convex shapes as every method looks at them, and what a method answers.
#pragma once

#include "kernels/data/shapes.hpp"
#include "kernels/geometry/gjk.hpp"
#include "kernels/geometry/polytope_contacts.hpp"
#include "throng/settings.hpp"

#include <cmath>
#include <cstdint>
#include <optional>

namespace throng {

/// Two convex shapes, b placed in a's frame, as all methods look at them. Keep the shapes while it
/// lives.
class ConvexPair {
public:
    /// Needs: a sphere, capsule, cylinder, box or hull each.
    ConvexPair(const Shapes& shapes, ShapeRef a, ShapeRef b, const Pose& b_in_a);
    ConvexPair(const ConvexPair&) = delete;
    ConvexPair& operator=(const ConvexPair&) = delete;

    void place(const Pose& b_in_a);

    const ConvexCorePair& cores() const { return cores_; }
    /// Null where one of the two is round.
    const PolytopePair* polytopes() const { return polytopes_ ? &*polytopes_ : nullptr; }
    /// m, greatest distance of a point of either from its own origin, within a factor of two: what
    /// tolerances are relative to.
    double size() const { return cores_.size; }

private:
    const Shapes& shapes_;
    ShapeRef a_, b_;
    std::optional<PolytopeShape> shape_a_, shape_b_;
    ConvexCorePair cores_;
    std::optional<PolytopePair> polytopes_;
};

enum class OverlapState : std::uint8_t {
    apart,
    touching,   // they share a point
    undecided,  // the method has come to the end of what it can tell
};

/// What a method tells of a pair, in a's frame; of that only what its `tells` names.
///
///   separation  m: apart, their distance; touching, minus the least distance by which one must be
///               moved for them to part
///   normal      unit, from a to b: apart, of a plane that parts them; touching, the direction of
///               that least move
///   on_a, on_b  apart, the points of the two that are nearest; touching, points of the two
///               surfaces `separation` apart along the normal
///   volume, surface, center   m3, m2, m, of what the two share
///   rounds      of its loop: support points asked for, planes cut by, axes looked at
///   cut_short   the loop came to its bound; the answer is the best so far
struct MethodAnswer {
    OverlapState overlap = OverlapState::undecided;
    double separation = 0;
    Vec3 normal = Vec3::UnitZ();
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
    double volume = 0, surface = 0;
    Vec3 center = Vec3::Zero();
    int rounds = 0;
    bool cut_short = false;
};

/// What a pair remembers from one question to the next. It changes the time and never the answer
/// beyond rounding; the meaning is the method's own, and a fresh one is a cold start.
struct MethodMemory {
    Vec3 axis = Vec3::Zero();
    std::uint32_t a[4] = {}, b[4] = {};
    std::uint32_t count = 0, kind = 0;

    /// Whether the axis is of unit length: one that is not was left by somebody else.
    bool has_direction() const { return std::abs(axis.squaredNorm() - 1) <= 1e-12; }
};

}  // namespace throng
