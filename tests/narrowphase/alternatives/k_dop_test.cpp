#include "narrowphase/alternatives/k_dop.hpp"

#include "kernels/geometry/separating_axes.hpp"
#include "narrowphase/alternatives/bounding_sphere.hpp"
#include "narrowphase/alternatives/k_dop_tree.hpp"
#include "tests/support/polytope_pairs.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

constexpr MethodStart kStarts[] = {MethodStart::cached, MethodStart::cold, MethodStart::plain};
constexpr int kSides[] = {6, 14, 18, 26};
const char* const kFilters[] = {"sphere", "k_dop:6", "k_dop:14", "k_dop:18", "k_dop:26"};

MethodAnswer ask(const char* filter, const ConvexPair& pair, MethodStart start)
{
    MethodMemory memory;
    return find_convex_method(filter)->ask(pair, 0, start, memory);
}

// Boxes 0 to 9 and hulls 0 to 9, of 8 to 60 vertices.
Shapes some_shapes(RandomShapes& random, double scale)
{
    Shapes shapes;
    for (int i = 0; i < 10; ++i) {
        shapes.boxes.push_back({random.vector(0.1, 0.6) * scale});
        shapes.hulls.push_back(
            random.hull(i == 9 ? 60 : 8 + 2 * i, random.number(0.2, 0.6) * scale));
    }
    return shapes;
}

ShapeRef any(RandomShapes& random)
{
    const ShapeKind kind = random.number(0, 1) < 0.5 ? ShapeKind::box : ShapeKind::hull;
    return {kind, static_cast<std::uint32_t>(random.number(0, 10))};
}

// Deep, near, apart, and of those some parallel and some concentric.
Pose any_pose(RandomShapes& random, double scale, int i)
{
    Pose pose = random.pose((0.4 + 0.2 * (i % 4)) * scale);
    if (i % 7 == 1) pose.orientation = Quat::Identity();
    if (i % 11 == 2) pose.position.setZero();
    return pose;
}

// The pair moved along a parting direction until the gap is as wanted.
Pose brought_near(const PolytopeView& a, const PolytopeView& b, Pose pose, double clearance)
{
    Vec3 normal;
    const double separation = polytope_separation(a, b, pose, &normal);
    pose.position += normal * (clearance - separation);
    return pose;
}

}  // namespace

TEST(KDop, NeverPartsWhatTouches)
{
    RandomShapes random(81);
    constexpr int kPairs = 20000;
    int apart = 0, filtered[5] = {};
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Shapes shapes = some_shapes(random, scale);
        for (int i = 0; i < kPairs / 3; ++i) {
            SCOPED_TRACE("seed 81, scale " + std::to_string(scale) + ", pair " + std::to_string(i));
            const ConvexPair pair(shapes, any(random), any(random), any_pose(random, scale, i));
            const double separation = separation_of(pair);
            apart += separation > 0;
            for (int k = 0; k < 5; ++k) {
                const MethodAnswer answer = ask(kFilters[k], pair, MethodStart::cold);
                if (answer.overlap == OverlapState::undecided) continue;
                ASSERT_EQ(answer.overlap, OverlapState::apart);
                ASSERT_GT(separation, 0) << kFilters[k];
                // Its normal does part them.
                ASSERT_NEAR(answer.normal.norm(), 1, 1e-14);
                ASSERT_GT(separation_along(pair.cores(), answer.normal), 0) << kFilters[k];
                ++filtered[k];
            }
        }
    }
    EXPECT_GT(apart, kPairs / 4);
    EXPECT_LT(apart, 3 * kPairs / 4);
    // More sides, fewer pairs left over.
    EXPECT_GT(filtered[0], apart / 4);
    EXPECT_GT(filtered[2], filtered[1]);
    EXPECT_GT(filtered[3], filtered[1]);
    EXPECT_GT(filtered[4], filtered[2]);
    EXPECT_GT(filtered[4], filtered[3]);
    EXPECT_GT(filtered[4], 3 * apart / 4);
}

TEST(KDop, NeverPartsWhatTouchesByAHair)
{
    // Boxes side by side, moved out along a slab by what rounding hides, and far from the origin.
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Shapes shapes = two_boxes(Vec3(0.3, 0.4, 0.5) * scale, Vec3(0.7, 0.1, 0.9) * scale);
        for (int axis = 0; axis < 3; ++axis) {
            const double sum =
                shapes.boxes[0].half_extents[axis] + shapes.boxes[1].half_extents[axis];
            for (const double clearance : {-1e-15, 0.0, 1e-15, 1e-12}) {
                const Pose pose{Vec3::Unit(axis) * (sum + clearance * scale), Quat::Identity()};
                for (const int side : {0, 1}) {
                    const ConvexPair pair(shapes, side == 0 ? kBoxA : kBoxB,
                                          side == 0 ? kBoxB : kBoxA,
                                          side == 0 ? pose : inverse(pose));
                    for (int k = 1; k < 5; ++k)
                        for (const MethodStart start : kStarts)
                            EXPECT_EQ(ask(kFilters[k], pair, start).overlap,
                                      clearance > 1e-14 ? OverlapState::apart
                                                        : OverlapState::undecided);
                }
            }
        }
    }
}

TEST(KDop, StartAndOrderOfTheTwoChangeNothing)
{
    RandomShapes random(82);
    const Shapes shapes = some_shapes(random, 1);
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seed 82, pair " + std::to_string(i));
        const ShapeRef a = any(random), b = any(random);
        Pose pose = any_pose(random, 1, i);
        // The frame is a's, so that swapping keeps the slabs where the two are parallel alone.
        pose.orientation = Quat::Identity();
        const ConvexPair ab(shapes, a, b, pose), ba(shapes, b, a, inverse(pose));
        for (const char* filter : kFilters) {
            const OverlapState plain = ask(filter, ab, MethodStart::plain).overlap;
            ASSERT_EQ(ask(filter, ab, MethodStart::cold).overlap, plain) << filter;
            ASSERT_EQ(ask(filter, ab, MethodStart::cached).overlap, plain) << filter;
            ASSERT_EQ(ask(filter, ba, MethodStart::cold).overlap, plain) << filter;
        }
    }
}

TEST(KDop, RemembersTheSlab)
{
    RandomShapes random(83);
    const Shapes shapes = some_shapes(random, 1);
    int quick = 0;
    for (int i = 0; i < 300; ++i) {
        MethodMemory memory;
        const ConvexPair pair(shapes, any(random), any(random), any_pose(random, 1, 3));
        if (query_k_dop<26>(pair, 0, MethodStart::cached, memory).overlap != OverlapState::apart)
            continue;
        const MethodAnswer again = query_k_dop<26>(pair, 0, MethodStart::cached, memory);
        EXPECT_EQ(again.overlap, OverlapState::apart);
        EXPECT_EQ(again.rounds, 1);
        ++quick;
    }
    EXPECT_GT(quick, 100);
}

TEST(KDop, HoldsItsShapeAndTouchesItOnEachSide)
{
    RandomShapes random(84);
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE("seed 84, shape " + std::to_string(i));
        Shapes shapes;
        shapes.spheres = {{random.number(0.1, 1)}};
        shapes.capsules = {{random.number(0.1, 1), random.number(0, 1)}};
        shapes.cylinders = {{random.number(0.1, 1), random.number(0, 1)}};
        shapes.boxes = {{random.vector(0, 1)}};
        shapes.hulls = {random.hull(12, 0.7)};
        const Pose pose = random.pose(2);
        const Mat3 turn = pose.orientation.toRotationMatrix();
        for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder,
                                     ShapeKind::box, ShapeKind::hull}) {
            const ConvexCore<double> core = convex_core_of<double>(shapes, {kind, 0});
            const Ball ball = ball_round(core);
            double furthest = 0;
            for (const int k : kSides) {
                const KDop dop = k_dop_of(core, turn, pose.position, k);
                const Slabs slabs = slabs_of(k);
                ASSERT_EQ(2 * (slabs.end - slabs.begin), static_cast<std::size_t>(k));
                for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
                    for (const double sign : {-1.0, 1.0}) {
                        const Vec3 out = sign * slab_direction(slab);
                        const Vec3 point = support(core, Vec3(turn.transpose() * out)).position;
                        const double extent =
                            out.dot(pose * point) + core.convex_radius * out.norm();
                        ASSERT_NEAR(sign < 0 ? -dop.lower[slab] : dop.upper[slab], extent, 1e-14);
                        furthest =
                            std::max(furthest, (point - ball.center).norm() + core.convex_radius);
                    }
                }
            }
            ASSERT_LE(furthest, ball.radius * (1 + 1e-14));
        }
    }
}

TEST(KDop, RoundShapesArePartedByTheirDistance)
{
    RandomShapes random(85);
    int filtered = 0, apart = 0;
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE("seed 85, pair " + std::to_string(i));
        Shapes shapes;
        shapes.spheres = {{random.number(0.1, 0.6)}};
        shapes.capsules = {{random.number(0.1, 0.3), random.number(0, 0.5)}};
        shapes.cylinders = {{random.number(0.1, 0.6), random.number(0, 0.5)}};
        const ShapeKind kinds[] = {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder};
        const ConvexPair pair(shapes, {kinds[i % 3], 0}, {kinds[i / 3 % 3], 0}, random.pose(0.8));
        const Distance distance = gjk(pair.cores(), 1e30);
        const double radii = pair.cores().a.convex_radius + pair.cores().b.convex_radius;
        const bool is_apart = distance.apart && distance.distance > radii;
        apart += is_apart;
        for (const char* filter : kFilters) {
            if (ask(filter, pair, MethodStart::cold).overlap == OverlapState::undecided) continue;
            ASSERT_TRUE(is_apart) << filter;
            ++filtered;
        }
    }
    EXPECT_GT(filtered, 3 * apart);
}

TEST(KDopTree, NeverPartsWhatTouches)
{
    RandomShapes random(86);
    Shapes shapes = some_shapes(random, 1);
    shapes.hulls.push_back(random.hull(200, 0.5));
    std::vector<PolytopeShape> views;
    for (std::uint32_t i = 0; i < shapes.boxes.size(); ++i)
        views.emplace_back(shapes, ShapeRef{ShapeKind::box, i});
    for (std::uint32_t i = 0; i < shapes.hulls.size(); ++i)
        views.emplace_back(shapes, ShapeRef{ShapeKind::hull, i});
    int apart[4] = {}, all = 0;
    for (int side = 0; side < 4; ++side) {
        std::vector<KDopTree> trees;
        for (const PolytopeShape& shape : views) {
            trees.emplace_back(shape.view(), kSides[side]);
            ASSERT_EQ(trees.back().count(), 2 * shape.view().normals.size() - 1);
        }
        RandomShapes poses(87);
        all = 0;
        for (int i = 0; i < 2000; ++i) {
            SCOPED_TRACE("seed 87, pair " + std::to_string(i));
            const auto count = static_cast<double>(views.size());
            const auto a = static_cast<std::size_t>(poses.number(0, count));
            const auto b = static_cast<std::size_t>(poses.number(0, count));
            const PolytopeView view_a = views[a].view(), view_b = views[b].view();
            Pose pose = any_pose(poses, 1, i);
            // A third of them a little apart, a third a hair deep.
            if (i % 3 == 1) pose = brought_near(view_a, view_b, pose, 0.1);
            if (i % 3 == 2) pose = brought_near(view_a, view_b, pose, -1e-12);
            const bool is_apart = polytope_separation(view_a, view_b, pose, nullptr) > 0;
            const PolytopePair pair(view_a, view_b, pose);
            const MethodAnswer answer = query_k_dop_trees(pair, trees[a], trees[b]);
            const MethodAnswer swapped = query_k_dop_trees(pair.mirrored(), trees[b], trees[a]);
            ASSERT_EQ(swapped.overlap, answer.overlap);
            all += is_apart;
            if (answer.overlap == OverlapState::undecided) continue;
            ASSERT_TRUE(is_apart);
            ++apart[side];
        }
    }
    // More sides, fewer pairs left over.
    EXPECT_GT(all, 700);
    EXPECT_GT(apart[1], apart[0]);
    EXPECT_GT(apart[2], apart[0]);
    EXPECT_GT(apart[3], apart[1]);
    EXPECT_GT(apart[3], apart[2]);
    EXPECT_GT(apart[3], 9 * all / 10);
}

TEST(KDopTree, OneInsideTheOtherIsNotApart)
{
    RandomShapes random(88);
    const BoxPolytope large({3, 3, 3});
    const Hull small = random.hull(20, 0.5);
    const KDopTree tree_a(large.view(), 14), tree_b(view_of(small), 14);
    for (int i = 0; i < 50; ++i) {
        const PolytopePair pair(large.view(), view_of(small), random.pose(1));
        EXPECT_EQ(query_k_dop_trees(pair, tree_a, tree_b).overlap, OverlapState::undecided);
        EXPECT_EQ(query_k_dop_trees(pair.mirrored(), tree_b, tree_a).overlap,
                  OverlapState::undecided);
    }
}

TEST(KDopTree, SlabsSeenFromAnotherFrameStillHoldTheShape)
{
    // Turned by halves and quarters of turns, directions fall between the slabs' in every way.
    RandomShapes random(89);
    const Hull hull = random.hull(30, 0.5);
    const BoxPolytope wall({0.1, 5, 5});
    for (const int k : kSides) {
        const KDopTree tree(view_of(hull), k), flat(wall.view(), k);
        for (int i = 0; i < 500; ++i) {
            SCOPED_TRACE("seed 89, k " + std::to_string(k) + ", turn " + std::to_string(i));
            Pose pose{Vec3::Zero(), random.turn()};
            if (i < 100) {
                const auto step = [&] { return std::floor(random.number(-2, 3)) / 2; };
                const Quat coarse(step(), step(), step(), step());
                if (coarse.norm() > 0) pose.orientation = coarse.normalized();
            }
            pose = brought_near(wall.view(), view_of(hull), pose, -1e-9);
            const PolytopePair pair(wall.view(), view_of(hull), pose);
            ASSERT_EQ(query_k_dop_trees(pair, flat, tree).overlap, OverlapState::undecided);
            ASSERT_EQ(query_k_dop_trees(pair.mirrored(), tree, flat).overlap,
                      OverlapState::undecided);
            // A k-DOP is at most a cube's diagonal larger than what it holds.
            pose = brought_near(wall.view(), view_of(hull), pose, 0.5);
            const PolytopePair far(wall.view(), view_of(hull), pose);
            ASSERT_EQ(query_k_dop_trees(far, flat, tree).overlap, OverlapState::apart);
        }
    }
}

}  // namespace throng
