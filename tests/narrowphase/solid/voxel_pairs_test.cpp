// Voxel pairs: depths within a stated part of a voxel, nothing missed, nothing pushed sideways.
#include "narrowphase/solid/voxel_pairs.hpp"

#include "cooking/hulls/hull.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "narrowphase/solid/solid_pairs.hpp"
#include "narrowphase/solid/surface_walk.hpp"
#include "tests/narrowphase/small_solids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

namespace throng::test {
namespace {

constexpr ShapeRef kFirst{ShapeKind::solid, 0}, kSecond{ShapeKind::solid, 1};

std::vector<ContactCandidate> touches_of(
    const Shapes& shapes, ShapeRef a, ShapeRef b, const Pose& b_in_a, double speculative_margin)
{
    std::vector<ContactCandidate> candidates;
    find_voxel_candidates(shapes, shapes.solids[a.index], b, b_in_a, speculative_margin, 0,
                          candidates);
    return candidates;
}

ContactCandidate
deepest(const Shapes& shapes, ShapeRef other, const Pose& pose, double speculative_margin)
{
    ContactCandidate most;
    most.separation = 1e300;
    for (const ContactCandidate& candidate :
         touches_of(shapes, kFirst, other, pose, speculative_margin))
        if (candidate.separation < most.separation) most = candidate;
    return most;
}

std::vector<PartManifold>
patches(const Shapes& shapes, ShapeRef other, const Pose& pose, double speculative_margin)
{
    std::vector<PartManifold> out;
    EXPECT_EQ(collide_solid({shapes, kFirst, other, pose, speculative_margin}, out).left_out, 0U);
    return out;
}

const PartManifold& deepest(const std::vector<PartManifold>& all, double& separation)
{
    separation = 1e300;
    const PartManifold* most = nullptr;
    for (const PartManifold& patch : all)
        for (int k = 0; k < patch.manifold.count; ++k) {
            const double now = patch.manifold.points[static_cast<std::size_t>(k)].separation;
            if (now < separation) most = &patch;
            separation = std::min(separation, now);
        }
    return *most;
}

struct Errors {
    double depth = 0, sine = 0;
};

// The greatest over many ways that a ball of radius 1 touches another shape that is round too.
Errors ball_errors(int voxels_in_radius, bool solid)
{
    const double voxel = 1.0 / voxels_in_radius;
    Shapes shapes;
    shapes.solids = {small_ball(1, voxel), small_ball(0.75, voxel)};
    shapes.spheres = {{0.75}};
    Dice dice(91);
    Errors worst;
    for (int i = 0; i < 60; ++i) {
        const Vec3 way = dice.point(1).normalized();
        const double separation = dice.between(-0.1, 0.02);
        const Pose pose{way * (1.75 + separation), dice.turn()};
        const ShapeRef other = solid ? kSecond : ShapeRef{ShapeKind::sphere, 0};
        const ContactCandidate candidate = deepest(shapes, other, pose, 0.1);
        worst.depth = std::max(worst.depth, std::abs(candidate.separation - separation));
        const auto found = patches(shapes, other, pose, 0.1);
        double least = 0;
        const Vec3 normal = deepest(found, least).manifold.normal;
        EXPECT_GT(normal.dot(way), 0);
        worst.sine = std::max(worst.sine, normal.cross(way).norm());
    }
    return worst;
}

TEST(VoxelPairs, BallsAreOfSecondOrder)
{
    for (const bool solid : {true, false}) {
        const Errors coarse = ball_errors(8, solid), fine = ball_errors(16, solid);
        // Half a voxel aside two balls of 8 and 6 have bent away by a thirtieth of a voxel; up to
        // a voxel is aside where points are.
        EXPECT_LT(coarse.depth * 8, 0.1);
        EXPECT_LT(fine.depth, coarse.depth / 2.8);
        EXPECT_LT(coarse.sine, 0.1);
        EXPECT_LT(fine.sine, 0.07);
    }
}

TEST(VoxelPairs, ABallOnAPlaneIsAsDeepAsItsPointsAreClose)
{
    Shapes shapes;
    shapes.solids = {small_ball(1, 0.125)};
    shapes.planes = {{Vec3::UnitZ(), 0}};
    Dice dice(92);
    for (int i = 0; i < 100; ++i) {
        const Quat turn = dice.turn();
        const double separation = dice.between(-0.3, 0.04);
        const Vec3 down = turn * -Vec3::UnitZ();
        // The plane as the ball sees it.
        const Pose pose{down * (1 + separation), turn};
        const auto found = patches(shapes, {ShapeKind::plane, 0}, pose, 0.05);
        ASSERT_EQ(found.size(), 1U);
        ASSERT_LT((found[0].manifold.normal - down).norm(), 1e-12);
        double depth = 0;
        deepest(found, depth);
        // A voxel aside the ball is up by 1/16 of one; a little for the faces of the mesh.
        ASSERT_GT(depth, separation - 1e-12);
        ASSERT_LT(depth, separation + 0.125 * 0.08) << "seed 92, ball " << i;
    }
}

// Standing on a face, an edge or a corner, whatever the turn about the way down.
TEST(VoxelPairs, BoxOnBoxIsExactWhereACornerOrAnEdgeMeetsAFace)
{
    const double voxel = 1.0 / 12;
    Shapes shapes;
    shapes.solids = {small_box({1, 1, 0.5}, voxel), small_box({0.4, 0.3, 0.5}, voxel)};
    shapes.boxes = {{Vec3(0.4, 0.3, 0.5)}};
    std::vector<Vec3> corners;
    for (int c = 0; c < 8; ++c)
        corners.emplace_back(c & 1 ? 0.4 : -0.4, c & 2 ? 0.3 : -0.3, c & 4 ? 0.5 : -0.5);
    shapes.hulls = {build_hull(corners).hull};
    Dice dice(93);
    for (int i = 0; i < 60; ++i) {
        const double angle = dice.between(-3, 3);
        Quat turn(std::cos(angle), 0, 0, std::sin(angle));
        if (i % 3 == 1) turn = turn * Quat(0.9, 0.4, 0, 0).normalized();
        if (i % 3 == 2) turn = dice.turn();
        const Mat3 axes = turn.toRotationMatrix();
        const double half = axes.row(2).cwiseAbs().dot(Vec3(0.4, 0.3, 0.5));
        const double separation = dice.between(-1.5, 0.5) * voxel;
        const Pose pose{
            Vec3(dice.between(-0.3, 0.3), dice.between(-0.3, 0.3), 0.5 + half + separation), turn};
        for (const ShapeRef other :
             {kSecond, ShapeRef{ShapeKind::box, 0}, ShapeRef{ShapeKind::hull, 0}}) {
            const auto found = patches(shapes, other, pose, voxel);
            double depth = 0;
            const PartManifold& patch = deepest(found, depth);
            // A step of depth: which of the deepest is told. What is still apart may be told by
            // what is round a rim, seen from 20 degrees aside; what is deep by a normal a tenth
            // aslant.
            ASSERT_LT(depth, separation + 2e-3 * voxel + 5e-3 * std::abs(separation))
                << "seed 93, box " << i;
            ASSERT_GT(depth, std::min(separation, 0.94 * separation) - 2e-3 * voxel)
                << "seed 93, box " << i;
            // Nothing is pushed sideways: what leans is round a rim, by its 20 degrees and the
            // grid's share. A flat face is held by its four corners.
            int points = 0;
            for (const PartManifold& one : found) {
                ASSERT_GT(one.manifold.normal.z(), 0.92) << "seed 93, box " << i;
                points += one.manifold.count;
            }
            // Cells at the rim of a face mix what is round the edge into its normal; the fewer
            // points touch, the more that counts: of a face, an edge, a corner.
            const double tilt[] = {0.002, 0.01, 0.1};
            ASSERT_LT((patch.manifold.normal - Vec3::UnitZ()).norm(), tilt[i % 3]);
            ASSERT_GE(points, i % 3 == 0 ? 4 : 1);
        }
    }
}

TEST(VoxelPairs, ACornerBelowAFaceIsNotPushedSideways)
{
    const double voxel = 1.0 / 12;
    Shapes shapes;
    shapes.solids = {small_box({1, 1, 0.5}, voxel), small_box({0.5, 0.5, 0.5}, voxel)};
    Dice dice(94);
    for (int i = 0; i < 30; ++i) {
        // The small box below, its corner up, turned about the way up.
        const double angle = dice.between(-3, 3);
        const Quat corner = Quat(1 + std::sqrt(3.0), 1, -1, 0).normalized();
        const Quat turn = Quat(std::cos(angle), 0, 0, std::sin(angle)) * corner;
        const double separation = -1.2 * voxel;
        const Pose below{Vec3(dice.between(-0.5, 0.5), dice.between(-0.5, 0.5),
                              -0.5 - separation - std::sqrt(0.75)),
                         turn};
        const auto found = patches(shapes, kSecond, below, voxel);
        ASSERT_EQ(found.size(), 1U);
        ASSERT_LT((found[0].manifold.normal + Vec3::UnitZ()).norm(), 0.05) << "seed 94, " << i;
        double depth = 0;
        deepest(found, depth);
        ASSERT_NEAR(depth, separation, 0.05 * voxel);
    }
}

TEST(VoxelPairs, CrossedEdgesAreToldTheWayOutOfAFaceWithinHalfAVoxel)
{
    const double voxel = 1.0 / 12;
    Shapes shapes;
    shapes.solids = {small_box({1, 0.5, 0.5}, voxel), small_box({0.5, 1, 0.5}, voxel)};
    shapes.boxes = {{Vec3(0.5, 1, 0.5)}};
    const Quat about_x = Quat(std::cos(std::numbers::pi / 8), std::sin(std::numbers::pi / 8), 0, 0);
    const Quat about_y = Quat(std::cos(std::numbers::pi / 8), 0, std::sin(std::numbers::pi / 8), 0);
    Dice dice(95);
    for (int i = 0; i < 40; ++i) {
        // Both stand on an edge; in the frame of the first.
        const double separation = dice.between(-1.5, 0.5) * voxel;
        const Vec3 apart(dice.between(-0.3, 0.3), dice.between(-0.3, 0.3),
                         2 * std::sqrt(0.5) + separation);
        const Quat back = about_x.conjugate();
        const Pose pose{back * apart, back * about_y};
        for (const ShapeRef other : {kSecond, ShapeRef{ShapeKind::box, 0}}) {
            const auto candidate = deepest(shapes, other, pose, voxel);
            // Each edge sees the faces of the other, at 45 degrees; points are half a voxel aside.
            ASSERT_GT(candidate.separation, separation - 1e-5 * voxel) << "seed 95, pair " << i;
            ASSERT_LT(candidate.separation, 0.7 * separation + 0.5 * voxel)
                << "seed 95, pair " << i;
        }
    }
}

TEST(VoxelPairs, ATorusTightRoundAPegTouchesAllRoundIt)
{
    const double voxel = 1.0 / 24;
    Shapes shapes;
    shapes.solids = {small_torus(0.7, 0.25, voxel)};
    for (const double separation : {-0.5 * voxel, 0.3 * voxel}) {
        shapes.cylinders = {{0.45 - separation, 1}};
        const Pose pose{Vec3(0, 0, 0.3), Quat::Identity()};
        double depth = 0, around = 0;
        const auto found = patches(shapes, {ShapeKind::cylinder, 0}, pose, voxel);
        deepest(found, depth);
        EXPECT_NEAR(depth, separation, 0.1 * voxel);
        ASSERT_GE(found.size(), 6U);
        Vec3 sum = Vec3::Zero();
        for (const PartManifold& patch : found) {
            // Towards the axis, hardly along it.
            EXPECT_LT(std::abs(patch.manifold.normal.z()), 0.1);
            around += 1;
            sum += patch.manifold.normal;
        }
        EXPECT_LT(sum.norm() / around, 0.35);
    }
    // Off to one side: it is held there alone.
    shapes.cylinders = {{0.3, 1}};
    const auto found = patches(shapes, {ShapeKind::cylinder, 0},
                               {Vec3(0.15 + 0.4 * voxel, 0, 0), Quat::Identity()}, 0.5 * voxel);
    double depth = 0;
    const PartManifold& patch = deepest(found, depth);
    EXPECT_NEAR(depth, -0.4 * voxel, 0.1 * voxel);
    EXPECT_LT((patch.manifold.normal + Vec3::UnitX()).norm(), 0.1);
}

// The same touches, each told by the other side.
TEST(VoxelPairs, SwappedTheyTouchTheSame)
{
    const double voxel = 1.0 / 12;
    Shapes shapes;
    shapes.solids = {small_box({0.6, 0.4, 0.5}, voxel), small_torus(0.6, 0.3, voxel)};
    Dice dice(96);
    std::size_t compared = 0;
    for (int i = 0; i < 20; ++i) {
        const Pose pose{dice.point(0.5) + Vec3(0.7, 0, 0), dice.turn()};
        const Quat turn = pose.orientation.conjugate();
        const Pose back{turn * -pose.position, turn};
        std::map<std::uint32_t, ContactCandidate> one;
        for (const ContactCandidate& candidate : touches_of(shapes, kFirst, kSecond, pose, voxel))
            one[candidate.feature ^ (1U << 30)] = candidate;
        const auto other = touches_of(shapes, kSecond, kFirst, back, voxel);
        ASSERT_EQ(one.size(), other.size());
        for (const ContactCandidate& candidate : other) {
            ASSERT_EQ(one.count(candidate.feature), 1U);
            const ContactCandidate& same = one[candidate.feature];
            ASSERT_NEAR(candidate.separation, same.separation, 1e-12);
            ASSERT_LT((pose * candidate.position - same.position).norm(), 1e-9);
            ASSERT_LT((pose.orientation * candidate.normal + same.normal).norm(), 1e-9);
            ++compared;
        }
    }
    EXPECT_GT(compared, 300U);
}

// The slow twin: every point.
TEST(VoxelPairs, CullingMissesNothing)
{
    const double voxel = 1.0 / 10;
    Shapes shapes;
    shapes.solids = {small_torus(0.6, 0.3, voxel), small_torus(0.6, 0.3, voxel)};
    shapes.capsules = {{0.3, 0.5}};
    const SurfacePoints& points = shapes.solids[0].points;
    const auto count = [&](const auto& side, const Pose& pose, double speculative_margin) {
        std::size_t all = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            using Real = typename std::decay_t<decltype(side)>::Real;
            LeafSample<Real> leaf{};
            leaf.count = 1;
            const Vec3 place = Vec3T<float>(points.x[i], points.y[i], points.z[i]).cast<double>();
            const Vec3 seen = pose.to_local(place);
            leaf.x[0] = static_cast<Real>(seen.x());
            leaf.y[0] = static_cast<Real>(seen.y());
            leaf.z[0] = static_cast<Real>(seen.z());
            side.sample(leaf);
            if (!(leaf.distance[0] <= speculative_margin) || !(leaf.distance[0] < side.furthest()))
                continue;
            const Vec3 gradient(leaf.gx[0], leaf.gy[0], leaf.gz[0]);
            if (gradient.norm() < kNoGradient) {
                ++all;
                continue;
            }
            const Vec3 outward = pose.orientation * gradient.normalized();
            all += -points.normals[i].cast<double>().dot(outward) >= double{points.cones[i]};
        }
        return all;
    };
    Dice dice(97);
    std::size_t total = 0;
    for (int i = 0; i < 60; ++i) {
        const Pose pose{dice.point(1.2), dice.turn()};
        std::vector<PointCandidate> found;
        const FieldSide field(shapes.solids[1]);
        walk_surface(points, field, pose, voxel, found);
        ASSERT_EQ(found.size(), count(field, pose, voxel)) << "seed 97, pose " << i;
        total += found.size();
        found.clear();
        const ConvexSide capsule(shapes, {ShapeKind::capsule, 0});
        walk_surface(points, capsule, pose, voxel, found);
        ASSERT_EQ(found.size(), count(capsule, pose, voxel)) << "seed 97, pose " << i;
    }
    EXPECT_GT(total, 300U);
}

// What is told to be apart may come closer by that, in any way, and has no touch yet.
TEST(VoxelPairs, WhatIsToldApartTouchesNothingUntilItHasComeSoMuchCloser)
{
    const double voxel = 1.0 / 10, speculative_margin = 0.5 * voxel;
    Shapes shapes;
    shapes.solids = {small_torus(0.6, 0.3, voxel), small_torus(0.6, 0.3, voxel)};
    shapes.capsules = {{0.3, 0.5}};
    shapes.boxes = {{Vec3(0.3, 0.2, 0.5)}};
    Dice dice(101);
    std::size_t known = 0;
    for (int i = 0; i < 300; ++i) {
        const ShapeRef kinds[] = {kSecond, {ShapeKind::capsule, 0}, {ShapeKind::box, 0}};
        const ShapeRef other = kinds[i % 3];
        const Pose pose{dice.point(2), dice.turn()};
        std::vector<PartManifold> out;
        const SolidAnswer answer =
            collide_solid({shapes, kFirst, other, pose, speculative_margin}, out);
        const double free = answer.apart - speculative_margin;
        if (!out.empty() || !(free > 0)) continue;
        ++known;
        // Straight on, and turned about its own middle: none of them reaches further than 1 m.
        const Pose closer{pose.position - free * pose.position.normalized(), pose.orientation};
        const double angle = 0.999 * free;
        const Quat turn(Eigen::AngleAxisd(angle, dice.point(1).normalized()));
        const Pose turned{pose.position, turn * pose.orientation};
        for (const Pose& moved : {closer, turned})
            collide_solid({shapes, kFirst, other, moved, speculative_margin}, out);
        ASSERT_TRUE(out.empty()) << "seed 101, pose " << i << " apart " << answer.apart;
    }
    EXPECT_GT(known, 100U);
}

// Whichever way float rounds the band: up for the one, down for the other.
TEST(VoxelPairs, WhereTheFieldEndsNothingIsTold)
{
    for (const double voxel : {0.1, 0.03}) {
        Shapes shapes;
        shapes.solids = {small_ball(0.3, voxel), small_ball(0.2, voxel)};
        const double band = shapes.solids[0].field.band;
        const Pose pose{Vec3(0.05, 0.02, 0.5 + 0.6 * band), Quat::Identity()};
        const auto candidates = touches_of(shapes, kFirst, kSecond, pose, 2 * band);
        ASSERT_FALSE(candidates.empty());
        for (const ContactCandidate& candidate : candidates)
            ASSERT_LT(candidate.separation, double{static_cast<float>(band)}) << "voxel " << voxel;
    }
}

TEST(VoxelPairs, NothingSmallFallsThroughBetweenThePoints)
{
    const double voxel = 1.0 / 8, small = 0.2 * voxel;
    Shapes shapes;
    shapes.solids = {small_box({1, 1, 0.5}, voxel)};
    shapes.spheres = {{small}};
    shapes.capsules = {{small, 2 * small}};
    shapes.cylinders = {{small, small}};
    shapes.boxes = {{Vec3::Constant(small)}};
    Dice dice(98);
    for (int i = 0; i < 100; ++i) {
        const Vec3 at(dice.between(-0.8, 0.8), dice.between(-0.8, 0.8), 0);
        const double sunk = dice.between(-0.5, 0.5) * small;
        // Each by how far it reaches down as it is placed: upright.
        const std::pair<ShapeKind, double> kinds[] = {{ShapeKind::sphere, small},
                                                      {ShapeKind::capsule, 3 * small},
                                                      {ShapeKind::cylinder, small},
                                                      {ShapeKind::box, small}};
        for (const auto& [kind, low] : kinds) {
            const Pose pose{at + Vec3(0, 0, 0.5 + low + sunk), Quat::Identity()};
            const ContactCandidate candidate = deepest(shapes, {kind, 0}, pose, voxel);
            ASSERT_NEAR(candidate.separation, sunk, 1e-5 * voxel) << static_cast<int>(kind);
            ASSERT_LT((candidate.normal - Vec3::UnitZ()).norm(), 1e-5);
        }
        // And well inside it is still told the way out.
        const Pose within{at + Vec3(0, 0, 0.2), dice.turn()};
        for (const auto& [kind, low] : kinds)
            ASSERT_LT(deepest(shapes, {kind, 0}, within, voxel).separation, -0.1);
    }
}

// What carries impulses from step to step: names of patches and features of points.
TEST(VoxelPairs, BodiesThatTrembleKeepTheirPoints)
{
    const double voxel = 1.0 / 12;
    Shapes shapes;
    shapes.solids = {small_torus(0.7, 0.25, voxel), small_box({1, 1, 0.5}, voxel)};
    shapes.planes = {{Vec3::UnitZ(), -0.25}};
    shapes.cylinders = {{0.45, 1}};
    const std::pair<ShapeRef, Pose> pairs[] = {
        {{ShapeKind::plane, 0}, {}},
        {{ShapeKind::cylinder, 0}, {Vec3(0.01, 0, 0), Quat::Identity()}},
        {kSecond, {Vec3(0.2, 0.1, -0.75), Quat::Identity()}}};
    Dice dice(100);
    for (const auto& [other, pose] : pairs) {
        const auto still = patches(shapes, other, pose, 0.3 * voxel);
        int kept = 0;
        for (int i = 0; i < 50; ++i) {
            Pose moved = pose;
            moved.position += dice.point(1e-6);
            const Vec3 by = dice.point(1e-6);
            moved.orientation = (Quat(1, by.x(), by.y(), by.z()) * pose.orientation).normalized();
            const auto now = patches(shapes, other, moved, 0.3 * voxel);
            bool same = now.size() == still.size();
            for (std::size_t p = 0; same && p < now.size(); ++p) {
                same = now[p].part == still[p].part
                    && now[p].manifold.count == still[p].manifold.count;
                for (std::size_t k = 0; same && k < std::size_t(now[p].manifold.count); ++k)
                    same = now[p].manifold.points[k].feature == still[p].manifold.points[k].feature;
            }
            kept += same;
        }
        EXPECT_EQ(kept, 50) << "seed 100, kind " << static_cast<int>(other.kind);
    }
}

TEST(VoxelPairs, AStaticMeshIsTouchedInFrontAlone)
{
    const double voxel = 1.0 / 8;
    Shapes shapes;
    shapes.solids = {small_ball(1, voxel), small_box({0.5, 0.5, 0.5}, voxel)};
    const std::vector<Vec3> square = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    // A pyramid so sharp that its tip falls between the points of a solid.
    const std::vector<Vec3> spike = {
        {-0.5, -0.5, -2}, {0.5, -0.5, -2}, {0.5, 0.5, -2}, {-0.5, 0.5, -2}, {0, 0, 0}};
    shapes.meshes = {build_mesh(square, {{0, 1, 2}, {0, 2, 3}}).mesh,
                     build_mesh(spike, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}).mesh};
    Dice dice(99);
    for (int i = 0; i < 40; ++i) {
        const double separation = dice.between(-1, 0.5) * voxel;
        const Quat turn = dice.turn();
        const Vec3 down = turn * -Vec3::UnitZ(), aside = turn * Vec3(0.3, 1, 0);
        const Pose front{down * (1 + separation) + aside, turn};
        const auto found = patches(shapes, {ShapeKind::mesh, 0}, front, voxel);
        ASSERT_EQ(found.size(), 1U);
        double depth = 0;
        ASSERT_LT((deepest(found, depth).manifold.normal - down).norm(), 1e-6);
        ASSERT_NEAR(depth, separation, 0.1 * voxel) << "seed 99, ball " << i;
        const Pose behind{-down * (1 + separation) + aside, turn};
        ASSERT_TRUE(patches(shapes, {ShapeKind::mesh, 0}, behind, voxel).empty());

        std::vector<PartManifold> stung;
        const Pose tip{Vec3(dice.between(-0.3, 0.3), dice.between(-0.3, 0.3), -0.5 - separation),
                       Quat::Identity()};
        collide_solid({shapes, kSecond, {ShapeKind::mesh, 1}, tip, voxel}, stung);
        ASSERT_FALSE(stung.empty());
        deepest(stung, depth);
        ASSERT_NEAR(depth, separation, 0.1 * voxel) << "seed 99, tip " << i;
    }
}

TEST(VoxelPairs, WhatWasPressedIntoAStaticMeshIsStillInIt)
{
    const double voxel = 1.0 / 8, half = 0.5;
    Shapes shapes;
    shapes.solids = {small_box({half, half, half}, voxel)};
    const std::vector<Vec3> square = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    shapes.meshes = {build_mesh(square, {{0, 1, 2}, {0, 2, 3}}).mesh};
    const auto found = [&](const Vec3& mesh_at, double pressed_in) {
        std::vector<PartManifold> all;
        collide_solid(
            {shapes, kFirst, {ShapeKind::mesh, 0}, Pose{mesh_at, Quat::Identity()}, voxel / 2}, all,
            pressed_in);
        return all;
    };
    // Who has his middle before it is in it as deep as he lies.
    for (const double depth : {0.1, 0.3, 0.45}) {
        double told = 0;
        const auto before = found(Vec3(0.3, 0.2, depth - half), 0);
        ASSERT_FALSE(before.empty()) << depth;
        EXPECT_LT((deepest(before, told).manifold.normal - Vec3(0, 0, -1)).norm(), 1e-6) << depth;
        EXPECT_NEAR(told, -depth, 1e-6);
    }
    for (const double depth : {0.6, 0.9}) {
        const Vec3 up(0.3, 0.2, depth - half);
        EXPECT_TRUE(found(up, 0).empty()) << depth;
        double told = 0;
        const auto pressed = found(up, depth);
        ASSERT_FALSE(pressed.empty()) << depth;
        EXPECT_LT((deepest(pressed, told).manifold.normal - Vec3(0, 0, -1)).norm(), 1e-6) << depth;
        EXPECT_NEAR(told, -depth, 1e-6);
        // What hangs over the rim went round it: no push but of what has the mesh over it.
        const auto half_over = found(up + Vec3(4.8, 0, 0), depth);
        ASSERT_FALSE(half_over.empty()) << depth;
        for (const PartManifold& patch : half_over)
            EXPECT_LT((patch.manifold.normal - Vec3(0, 0, -1)).norm(), 1e-6) << depth;
    }
}

}  // namespace
}  // namespace throng::test
