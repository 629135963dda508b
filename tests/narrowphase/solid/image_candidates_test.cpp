// Image candidates: depths against the truth, and ids that stay.
#include "narrowphase/solid/image_candidates.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/image_views.hpp"
#include "kernels/math/turn_between.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace throng {
namespace {

constexpr int kRays = 32;

Solid solid_of(const TriangleSoup& soup)
{
    Solid solid;
    solid.representation = SolidRepresentation::depth_image;
    solid.mesh = build_mesh(soup.vertices, soup.triangles).mesh;
    solid.rays = kRays;
    return solid;
}

Pose at(const Vec3& place) { return {place, Quat::Identity()}; }

constexpr ShapeRef kSolid{ShapeKind::solid, 0};

std::vector<ContactCandidate>
candidate(const Shapes& shapes, ShapeRef other, const Pose& pose, double speculative_margin = 0)
{
    std::vector<ContactCandidate> candidates;
    find_image_candidates({shapes, kSolid, other, pose, speculative_margin}, candidates);
    return candidates;
}

double deepest(const std::vector<ContactCandidate>& candidates)
{
    double least = std::numeric_limits<double>::infinity();
    for (const ContactCandidate& one : candidates) least = std::min(least, one.separation);
    return least;
}

// Two balls of radius 1 and 0.6, the second as a sphere and as a solid.
Shapes balls()
{
    Shapes shapes;
    shapes.solids = {solid_of(ball_mesh(1, 96, 48)), solid_of(ball_mesh(0.6, 96, 48))};
    shapes.spheres = {{0.6}};
    return shapes;
}

Shapes boxes()
{
    Shapes shapes;
    shapes.solids = {solid_of(box_mesh({1, 1, 0.2})), solid_of(box_mesh({0.5, 0.4, 0.3}))};
    shapes.boxes = {{{0.5, 0.4, 0.3}}};
    shapes.hulls = {build_hull(corners_of({0.5, 0.4, 0.3})).hull};
    return shapes;
}

TEST(ImageCandidates, OfBallsTellDepthAndGapWhereverTheyMeet)
{
    const Shapes shapes = balls();
    const double pixel = 1.2 / kRays, facets = 2e-3;
    RandomShapes random(21);
    for (int i = 0; i < 60; ++i) {
        const Vec3 along = random.vector(-1, 1).normalized();
        const double separation = i % 2 == 0 ? random.number(-0.1, -0.03) : random.number(0, 0.03);
        const double speculative_margin = 0.05;
        for (const ShapeRef other : {ShapeRef{ShapeKind::sphere, 0}, {ShapeKind::solid, 1}}) {
            const std::vector<ContactCandidate> candidates =
                candidate(shapes, other, at(along * (1.6 + separation)), speculative_margin);
            ASSERT_FALSE(candidates.empty()) << i;
            // The ray nearest the line of centers passes it within 0.71 pixels times 1.73, and
            // there the balls have bent away by the square of that over twice their radii.
            const double bent = 1.5 * pixel * pixel / 2 * (1 + 1 / 0.6);
            EXPECT_LT(deepest(candidates), separation + bent + facets) << i;
            // Where the ray leans by up to 55 degrees its ends lie apart by as much as it is deep,
            // and the normals there lean by that over the radii.
            const double lean = separation * separation * (1 + 1 / 0.6) / 2;
            EXPECT_GT(deepest(candidates), separation - lean - facets) << i;
            for (const ContactCandidate& one : candidates) {
                EXPECT_LE(one.separation, speculative_margin);
                EXPECT_NEAR(one.normal.norm(), 1, 1e-12);
                EXPECT_GT(one.normal.dot(along), 0.8) << i;
            }
        }
    }
}

TEST(ImageCandidates, OfTwoSolidsAreAsFineAsEitherAsksFor)
{
    Shapes shapes = boxes();
    const ShapeRef other{ShapeKind::solid, 1};
    const Pose pose = at({0.3, 0.1, 0.49});
    shapes.solids[0].rays = 2 * kRays;
    const std::size_t both = candidate(shapes, other, pose).size();
    shapes.solids[0].rays = 0;  // of another way
    shapes.solids[1].rays = 2 * kRays;
    EXPECT_EQ(candidate(shapes, other, pose).size(), both);
    shapes.solids[1].rays = kRays;
    EXPECT_LT(candidate(shapes, other, pose).size(), both / 2);
}

TEST(ImageCandidates, OfBoxesAreExactAndLookTheShortWayOut)
{
    const Shapes shapes = boxes();
    // A thin overlap is deep as seen from the side; that is not the way out.
    for (const double depth : {0.001, 0.01, 0.1}) {
        for (const ShapeRef other :
             {ShapeRef{ShapeKind::box, 0}, {ShapeKind::hull, 0}, {ShapeKind::solid, 1}}) {
            const std::vector<ContactCandidate> candidates =
                candidate(shapes, other, at({0.3, 0.1, 0.5 - depth}));
            ASSERT_GT(candidates.size(), 500u);
            for (const ContactCandidate& one : candidates) {
                EXPECT_NEAR((one.normal - Vec3::UnitZ()).norm(), 0, 1e-12);
                EXPECT_NEAR(one.separation, -depth, 1e-12);
                EXPECT_NEAR(one.position.z(), 0.2 - depth / 2, 1e-12);
            }
        }
    }
}

TEST(ImageCandidates, OfAThinOverlapAtAnEdgeLookTheShortWayOut)
{
    // Half of the box hangs over the plate's rim, and a face of it is 3 mm inside the plate's side.
    const Shapes shapes = boxes();
    for (const ContactCandidate& one :
         candidate(shapes, {ShapeKind::box, 0}, at({0.9, 0, 0.5 - 0.002}))) {
        EXPECT_NEAR((one.normal - Vec3::UnitZ()).norm(), 0, 1e-12);
        EXPECT_NEAR(one.separation, -0.002, 1e-12);
    }
    for (const ContactCandidate& one :
         candidate(shapes, {ShapeKind::box, 0}, at({1.5 - 0.003, 0, 0.3}))) {
        EXPECT_NEAR((one.normal - Vec3::UnitX()).norm(), 0, 1e-12);
        EXPECT_NEAR(one.separation, -0.003, 1e-12);
    }
}

TEST(ImageCandidates, ACornerInAFaceIsPushedOutOfTheFace)
{
    const Shapes shapes = boxes();
    const Vec3 tip(0.5, 0.4, 0.3);
    // The box stands on its corner, 0.1 deep.
    const Quat turn = turn_between(tip, Vec3(0.05, 0.02, -1));
    const double lowest = (turn * tip).z();
    const std::vector<ContactCandidate> candidates =
        candidate(shapes, {ShapeKind::box, 0}, {{0.1, 0.2, 0.2 - 0.1 - lowest}, turn});
    ASSERT_FALSE(candidates.empty());
    // A corner comes to its point between rays: some pixel less, as its faces climb.
    EXPECT_GE(deepest(candidates), -0.1 - 1e-12);
    EXPECT_LE(deepest(candidates), -0.1 + 1.5 * 0.6 / kRays);
    for (const ContactCandidate& one : candidates) {
        if (one.separation > 0.5 * deepest(candidates)) continue;
        EXPECT_NEAR((one.normal - Vec3::UnitZ()).norm(), 0, 1e-3);
    }
}

TEST(ImageCandidates, OfAPlaneAndOfAnOpenMeshAreThoseOfABox)
{
    Shapes shapes;
    shapes.solids = {solid_of(box_mesh({0.5, 0.4, 0.3}))};
    shapes.planes = {{Vec3::UnitZ(), 0}};
    TriangleSoup floor{{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    shapes.meshes = {build_mesh(floor.vertices, floor.triangles).mesh};
    for (const ShapeRef other : {ShapeRef{ShapeKind::plane, 0}, {ShapeKind::mesh, 0}}) {
        for (const double separation : {-0.05, -1e-4, 0.01}) {
            const std::vector<ContactCandidate> candidates =
                candidate(shapes, other, at({0.1, 0, -0.3 - separation}), 0.02);
            ASSERT_GT(candidates.size(), 500u);
            for (const ContactCandidate& one : candidates) {
                EXPECT_NEAR((one.normal + Vec3::UnitZ()).norm(), 0, 1e-12);
                EXPECT_NEAR(one.separation, separation, 1e-12);
            }
        }
        EXPECT_TRUE(candidate(shapes, other, at({0.1, 0, -0.35}), 0.02).empty());
    }
    // From below nothing of the open mesh is met, once it is past the box's middle.
    EXPECT_TRUE(candidate(shapes, {ShapeKind::mesh, 0}, at({0.1, 0, 0.65}), 0.02).empty());
}

// Its bottom and its upright sides are far, and none of them pushes through to where it looks.
TEST(ImageCandidates, OfAThickBlockOnlyTheSideThatIsNearIsMet)
{
    Shapes shapes;
    shapes.solids = {solid_of(box_mesh({0.5, 0.4, 0.3}))};
    const TriangleSoup block = box_mesh({20, 16, 2});
    shapes.meshes = {build_mesh(block.vertices, block.triangles).mesh};
    for (const Vec3& beside : {Vec3(0, 0, 0), Vec3(13, -9, 0), Vec3(-18, 14, 0)})
        for (const double depth : {-0.01, 0.002, 0.05, 0.13}) {
            const Pose pose = at(beside + Vec3(0, 0, -2.3 + depth));
            const auto candidates = candidate(shapes, {ShapeKind::mesh, 0}, pose, 0.02);
            ASSERT_FALSE(candidates.empty());
            for (const ContactCandidate& one : candidates) {
                ASSERT_NEAR(one.separation, -depth, 1e-12);
                ASSERT_LT((one.normal + Vec3::UnitZ()).norm(), 1e-12);
            }
        }
}

TEST(ImageCandidates, KeepTheirIdsWhileTheOtherTrembles)
{
    const Shapes shapes = balls();
    const auto ids = [&](const Vec3& shift) {
        const std::vector<ContactCandidate> candidates = candidate(
            shapes, {ShapeKind::solid, 1}, {Vec3(0.9, 0.6, 1.05) + shift, Quat::Identity()}, 0.02);
        std::set<std::uint32_t> all;
        for (const ContactCandidate& one : candidates) EXPECT_TRUE(all.insert(one.feature).second);
        return all;
    };
    RandomShapes random(2);
    const std::set<std::uint32_t> still = ids(Vec3::Zero());
    ASSERT_GT(still.size(), 50u);
    for (int i = 0; i < 10; ++i) {
        const std::set<std::uint32_t> moved = ids(random.vector(-1e-6, 1e-6));
        std::vector<std::uint32_t> kept;
        std::set_intersection(still.begin(), still.end(), moved.begin(), moved.end(),
                              std::back_inserter(kept));
        // A ray on the rim may come or go.
        EXPECT_GE(kept.size() + 2, still.size());
        EXPECT_GE(kept.size() + 2, moved.size());
    }
}

TEST(ImageCandidates, AreTheSamePushesSeenFromEitherSide)
{
    Shapes ab = boxes(), ba;
    ba.solids = {ab.solids[1], ab.solids[0]};
    const Pose pose{{0.3, 0.1, 0.48}, Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()))};
    const Pose back{pose.to_local(Vec3::Zero()), pose.orientation.conjugate()};
    const auto there = candidate(ab, {ShapeKind::solid, 1}, pose, 0.01);
    const auto here = candidate(ba, {ShapeKind::solid, 1}, back, 0.01);
    ASSERT_FALSE(here.empty());
    EXPECT_NEAR(deepest(there), deepest(here), 1e-12);
    for (const ContactCandidate& one : here)
        EXPECT_NEAR((pose.orientation * one.normal + Vec3::UnitZ()).norm(), 0, 1e-12);
}

TEST(ImageCandidates, SeeThroughTheHoleOfATorus)
{
    Shapes shapes;
    shapes.solids = {solid_of(torus_mesh(0.7, 0.2, 48, 24)), solid_of(ball_mesh(0.4, 48, 24))};
    shapes.capsules = {{0.4, 2}};
    EXPECT_TRUE(candidate(shapes, {ShapeKind::solid, 1}, {}, 0.05).empty());
    EXPECT_TRUE(candidate(shapes, {ShapeKind::capsule, 0}, {}, 0.05).empty());
    // Moved to one side it touches the ring there alone.
    const auto candidates = candidate(shapes, {ShapeKind::capsule, 0}, at({0.12, 0, 0}), 0.02);
    ASSERT_FALSE(candidates.empty());
    EXPECT_NEAR(deepest(candidates), -0.02, 5e-3);
    for (const ContactCandidate& one : candidates) {
        EXPECT_GT(one.position.x(), 0.3);
        EXPECT_LT(one.normal.x(), -0.6);  // 0.1 - 0.12 of it is a gap of 0.02
    }
}

// Where rays run along a static mesh, the back of its layers is further than they are thick.
TEST(ImageCandidates, NoneOfALinkAndTheMeshOfThatThroughIt)
{
    const TriangleSoup link = torus_mesh(0.4, 0.1, 32, 16);
    Shapes shapes;
    shapes.solids = {solid_of(link)};
    shapes.meshes = {build_mesh(link.vertices, link.triangles).mesh};
    const Quat upright(std::sqrt(0.5), std::sqrt(0.5), 0, 0);
    for (const double place : {-0.55, 0.5499, 0.553}) {
        const Pose pose{{place, 0.001, -0.002}, upright};
        EXPECT_TRUE(candidate(shapes, {ShapeKind::mesh, 0}, pose).empty()) << place;
    }
}

// Against one that is larger, as large and smaller, of which the last asks for other rays.
TEST(ImageCandidates, LayersDrawnAheadChangeNoBit)
{
    Shapes drawn;
    drawn.solids = {solid_of(torus_mesh(0.4, 0.15, 24, 12)), solid_of(ball_mesh(1, 24, 12)),
                    solid_of(torus_mesh(0.4, 0.15, 24, 12)), solid_of(ball_mesh(0.3, 24, 12))};
    drawn.boxes = {{{1, 1, 0.2}}};
    Shapes ahead = drawn;
    for (Solid& solid : ahead.solids) solid.layers = layers_of(solid);
    RandomShapes random(31);
    std::size_t met = 0;
    for (int i = 0; i < 60; ++i) {
        const Pose pose{random.vector(-0.8, 0.8), random.turn()};
        for (const ShapeRef other : {ShapeRef{ShapeKind::solid, 1}, ShapeRef{ShapeKind::solid, 2},
                                     ShapeRef{ShapeKind::solid, 3}, ShapeRef{ShapeKind::box, 0}}) {
            const auto plain = candidate(drawn, other, pose, 0.01);
            const auto told = candidate(ahead, other, pose, 0.01);
            ASSERT_EQ(told.size(), plain.size());
            met += plain.size();
            for (std::size_t k = 0; k < plain.size(); ++k) {
                EXPECT_EQ(told[k].position, plain[k].position);
                EXPECT_EQ(told[k].normal, plain[k].normal);
                EXPECT_EQ(told[k].separation, plain[k].separation);
                EXPECT_EQ(told[k].feature, plain[k].feature);
            }
        }
    }
    EXPECT_GT(met, 1000U);
    // And they are what is looked at.
    for (RayLayers& layers : ahead.solids[0].layers) layers.begin.assign(layers.begin.size(), 0);
    EXPECT_FALSE(candidate(drawn, {ShapeKind::box, 0}, {}).empty());
    EXPECT_TRUE(candidate(ahead, {ShapeKind::box, 0}, {}).empty());
}

TEST(ImageCandidates, OfWhatIsFarAreNone)
{
    const Shapes shapes = boxes();
    EXPECT_TRUE(candidate(shapes, {ShapeKind::box, 0}, at({0, 0, 0.52}), 0.01).empty());
    EXPECT_TRUE(candidate(shapes, {ShapeKind::box, 0}, at({50, 0, 0}), 0.01).empty());
}

}  // namespace
}  // namespace throng
