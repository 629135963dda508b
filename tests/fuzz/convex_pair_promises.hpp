// Convex pair promises: what holds of every answer about two convex shapes.
#pragma once

#include "kernels/geometry/separating_axes.hpp"
#include "tests/fuzz/convex_pair_input.hpp"
#include "tests/fuzz/convex_pair_told.hpp"
#include "tests/support/polytope_pairs.hpp"

namespace throng {

// Of the size, like all below: nearer than this to touching either answer is right, and lengths are
// known as well.
constexpr double kHair = 1e-9;
// Corners that stray from their faces by no more are rounding.
constexpr double kFlat = 1e-13;
// What goes by faces is as good as this where corners stray from them: ten times what build_hull()
// allows, for that counts more where faces meet at a sharp angle.
constexpr double kOfStraying = 1e-4;
constexpr double kOfCylinders = 1e-6;
constexpr double kParts = 1e-12;
constexpr double kAnyReach = 1e30;

inline int most_rounds(const ConvexMethod& method, const ConvexPair& pair)
{
    if (method.name == "sphere") return 1;
    if (method.name == "sat") return 8;
    if (method.name == "chung_wang") return 96;
    // Of GJK and EPA as query_gjk.hpp says, and a few supports that prove.
    if (method.name == "gjk") return 129 + 512 + 8;
    if (method.name.starts_with("k_dop")) return 32;
    const PolytopeView &a = pair.polytopes()->a, &b = pair.polytopes()->b;
    const auto looks = [](const PolytopeView& planes, const PolytopeView& other) {
        return planes.normals.size() * (other.vertices.size() + other.edges.size() + 64);
    };
    if (method.name == "clip_volume")
        return static_cast<int>(2 * (a.vertices.size() + b.vertices.size()));
    return static_cast<int>(4 * (looks(a, b) + looks(b, a)));
}

// So many vertices that a step asks GJK which corners meet, and other methods take too long.
inline bool is_large()
{
    return std::any_of(std::begin(now.shapes), std::end(now.shapes), [](const auto* shape) {
        const auto* const hull = std::get_if<HullShape>(&shape->shape);
        return hull && hull->points.size() >= 192;
    });
}

/// All that is asked of two shapes at one pose.
class Placing {
public:
    Placing(const ConvexPair& pair, const Pose& pose) : pair_(pair), pose_(pose)
    {
        size_ = pair.size() + pose.position.norm();
        const ConvexCorePair& cores = pair.cores();
        cylinders_ = cores.a.kind == ShapeKind::cylinder || cores.b.kind == ShapeKind::cylinder;
        MethodMemory memory;
        now.method = "gjk";
        now.start = 2;
        now.speculative_margin = kAnyReach;
        now.memory = memory;
        best_ = find_convex_method("gjk")->ask(pair, kAnyReach, MethodStart::plain, memory);
        by_points_ = best_.separation;
        by_faces_ = by_points_;
        const PolytopePair* const both = pair.polytopes();
        if (both && !is_large()) {
            by_faces_ = polytope_separation(both->a, both->b, pose, nullptr);
            const double stray = std::max(stray_of(both->a), stray_of(both->b));
            strays_ = stray > kFlat * pair.size();
        }
    }

    double size() const { return size_; }
    double by_points() const { return by_points_; }
    /// As near as any axis leaves them, which is nearer than their points where corners face
    /// corners.
    double by_axes() const { return std::min(by_points_, by_faces_); }

    /// What holds of any answer, whatever the pair remembered.
    void
    check(const ConvexMethod& method, double speculative_margin, const MethodAnswer& told) const
    {
        check_numbers(method, told);
        check_touch(method, told);
        if (told.overlap == OverlapState::apart) check_apart(method, speculative_margin, told);
        if (told.overlap == OverlapState::touching && (method.tells & tells_depth))
            check_depth(told);
    }

    /// What a start from memory and a cold one have in common.
    void compare(const ConvexMethod& method,
                 double speculative_margin,
                 const MethodAnswer& told,
                 const MethodAnswer& cold) const
    {
        if (std::abs(by_points_) > slack_of(method) && told.overlap != OverlapState::undecided
            && cold.overlap != OverlapState::undecided)
            expect(told.overlap == cold.overlap, "memory does not change who touches");
        if (told.overlap != cold.overlap || told.cut_short || cold.cut_short) return;
        const bool apart = told.overlap == OverlapState::apart;
        const bool measured = (method.tells & (apart ? tells_distance : tells_depth)) != 0;
        if (measured && cold.separation <= speculative_margin) {
            const double error = std::abs(told.separation - cold.separation);
            expect(error <= std::max(slack_of(method), length_slack()),
                   "memory does not change lengths", told.separation, cold.separation);
        }
        if (!apart && (method.tells & tells_volume)) {
            expect(std::abs(told.volume - cold.volume) <= kHair * size_ * size_ * size_,
                   "memory does not change volumes", told.volume, cold.volume);
        }
    }

private:
    // Of what goes by faces and of what goes by points.
    double face_slack() const { return (strays_ ? kOfStraying : kHair) * size_; }
    double length_slack() const { return (cylinders_ ? kOfCylinders : kHair) * size_; }
    bool goes_by_faces(const ConvexMethod& method) const
    {
        return method.name == "sat" || method.name == "containment";
    }
    double slack_of(const ConvexMethod& method) const
    {
        return goes_by_faces(method) ? face_slack() : length_slack();
    }

    void check_numbers(const ConvexMethod& method, const MethodAnswer& told) const
    {
        expect(std::isfinite(told.separation) && std::isfinite(told.volume)
                   && std::isfinite(told.surface),
               "lengths and volumes are finite");
        expect(told.normal.allFinite() && told.on_a.allFinite() && told.on_b.allFinite()
                   && told.center.allFinite(),
               "directions and places are finite");
        expect(std::abs(told.normal.norm() - 1) < kParts, "normals are of unit length",
               told.normal.norm());
        const int most = most_rounds(method, pair_);
        expect(told.rounds >= 0 && told.rounds <= most, "rounds have a bound", told.rounds, most);
        expect(told.volume >= 0 && told.surface >= 0, "volumes are not below 0", told.volume);
    }

    void check_touch(const ConvexMethod& method, const MethodAnswer& told) const
    {
        const OverlapState overlap = told.overlap;
        // What they all have in common is seen by faces and by points.
        const double slack = slack_of(method);
        if (by_faces_ > face_slack() && by_points_ > slack)
            expect(overlap != OverlapState::touching, "what is apart does not touch", by_faces_,
                   by_points_);
        if (by_faces_ < -face_slack() && by_points_ < -slack)
            expect(overlap != OverlapState::apart, "what touches is not apart", by_faces_,
                   by_points_);
        if (pair_.polytopes() && (by_faces_ > face_slack() || by_faces_ < -face_slack()))
            expect((by_faces_ > 0) == (by_points_ > 0), "gjk agrees with the axes", by_points_,
                   by_faces_);
        if (goes_by_faces(method)) return;
        if (by_points_ > slack)
            expect(overlap != OverlapState::touching, "what gjk parts does not touch", by_points_);
        if (by_points_ < -slack)
            expect(overlap != OverlapState::apart, "what gjk sees touch is not apart", by_points_);
    }

    void check_apart(const ConvexMethod& method,
                     double speculative_margin,
                     const MethodAnswer& told) const
    {
        // Those have a normal of faces alone, or none.
        if (method.name == "clip_volume" || method.name == "containment") return;
        const double clearance = separation_beyond(pair_.cores(), told.normal);
        expect(clearance > -kParts * size_, "the normal of what is apart parts it", clearance,
               size_);
        if ((method.tells & tells_distance) == 0) return;
        expect(clearance >= told.separation - length_slack(), "the normal shows the distance",
               clearance, told.separation);
        if (told.separation > speculative_margin) return;
        const double between = (told.on_b - told.on_a).norm();
        expect(std::abs(between - told.separation) <= kHair * size_,
               "the nearest points are that far apart", between, told.separation);
    }

    void check_depth(const MethodAnswer& told) const
    {
        const double clearance = separation_beyond(pair_.cores(), told.normal);
        expect(clearance >= told.separation - kHair * size_, "the depth is enough to part them",
               clearance, told.separation);
        if (told.cut_short || best_.cut_short || by_points_ > 0) return;
        const double wrong = std::abs(told.separation - by_points_);
        expect(wrong <= std::max(face_slack(), length_slack()), "depths agree", told.separation,
               by_points_);
    }

    const ConvexPair& pair_;
    const Pose pose_;
    MethodAnswer best_;
    double size_ = 0, by_points_ = 0, by_faces_ = 0;
    bool strays_ = false, cylinders_ = false;
};

}  // namespace throng
