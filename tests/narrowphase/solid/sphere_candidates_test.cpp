#include "narrowphase/solid/sphere_candidates.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "cooking/sphere_trees/sphere_cover.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "narrowphase/dispatch.hpp"
#include "tests/support/closed_meshes.hpp"

#include <gtest/gtest.h>

#include <set>

namespace throng {
namespace {

constexpr ShapeRef kRing{ShapeKind::solid, 0}, kLump{ShapeKind::solid, 1};
constexpr ShapeRef kFieldBox{ShapeKind::solid, 2}, kBareBox{ShapeKind::solid, 3};
constexpr double kVoxel = 0.05;

Solid box_in_voxels(const Vec3& half)
{
    Solid solid;
    solid.mesh = closed(box_mesh(half));
    solid.field = bake_bricks({-half, half}, kVoxel, 3 * kVoxel,
                              [&](const Vec3& at) { return signed_distance(solid.mesh, at); });
    // Near the edges, where the distance is round and its values are joined by straight lines.
    solid.error = kVoxel / 2;
    return solid;
}

const Shapes& shapes()
{
    static const Shapes made = [] {
        Shapes all;
        all.solids.push_back(in_spheres(torus_mesh(0.35, 0.15, 24, 12)));
        all.solids.push_back(in_spheres(noisy_ball(7, 0.4, 0.1)));
        const Vec3 half(0.5, 0.4, 0.3);
        all.solids.push_back(box_in_voxels(half));
        all.solids.push_back({});
        all.solids.back().mesh = closed(box_mesh(half));
        all.boxes = {{half}};
        all.spheres = {{0.3}};
        all.capsules = {{0.2, 0.3}};
        all.cylinders = {{0.2, 0.3}};
        all.hulls.push_back(build_hull(corners_of(half)).hull);
        all.planes = {{Vec3(1, 2, 2) / 3, 0.1}};
        all.meshes = {closed(box_mesh(half))};
        return all;
    }();
    return made;
}

struct Told {
    SphereAnswer answer;
    std::vector<ContactCandidate> candidates;
};

Told ask(ShapeRef a,
         ShapeRef b,
         const Pose& b_in_a,
         double speculative_margin,
         const SphereBudget& budget = {})
{
    Told told;
    told.answer = find_sphere_candidates({shapes(), a, b, b_in_a, speculative_margin}, budget,
                                         told.candidates);
    return told;
}

double deepest(const Told& told)
{
    double least = std::numeric_limits<double>::infinity();
    for (const ContactCandidate& candidate : told.candidates)
        least = std::min(least, candidate.separation);
    return least;
}

// How near places of b's surface come to a's, and of a's to b's; below 0 where one is inside.
double sampled_distance(const Mesh& a, const Mesh& b, const Pose& b_in_a, RandomShapes& random)
{
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 600; ++i) {
        least = std::min(least, signed_distance(a, b_in_a * place_on(b, random)));
        least = std::min(least, signed_distance(b, b_in_a.to_local(place_on(a, random))));
    }
    return least;
}

// Boxes as each kind of shape that can be one.
const std::vector<ShapeRef>& box_kinds()
{
    static const std::vector<ShapeRef> kinds = {
        {ShapeKind::box, 0}, {ShapeKind::hull, 0}, {ShapeKind::mesh, 0}, kFieldBox, kBareBox};
    return kinds;
}

TEST(SphereCandidates, NeverSaysApartWhatIsNearer)
{
    RandomShapes random(21);
    int apart = 0;
    for (int i = 0; i < 40; ++i) {
        const Pose pose = random.pose(1);
        const double truth =
            sampled_distance(shapes().solids[0].mesh, shapes().solids[1].mesh, pose, random);
        for (int level = 0; level < 3; ++level) {
            const Told told = ask(kRing, kLump, pose, 0.5, {level});
            EXPECT_LE(told.answer.apart, std::max(0.0, truth));
            // Nor less than that by more than twice the error; of 600 random samples
            // hardly a place is further than 0.15.
            if (truth > 0) {
                EXPECT_GE(told.answer.apart, std::min(0.5, truth - 0.15) - 2 * told.answer.error);
            }
            apart += told.answer.apart > 0 ? 1 : 0;
        }
    }
    EXPECT_GT(apart, 10);
}

TEST(SphereCandidates, SwappedTouchesAreTheSame)
{
    RandomShapes random(22);
    std::size_t count = 0;
    for (int i = 0; i < 40; ++i) {
        const Pose pose = random.pose(0.5);
        Told one = ask(kRing, kLump, pose, 0.05);
        Told other = ask(kLump, kRing, inverse(pose), 0.05);
        EXPECT_NEAR(one.answer.apart, other.answer.apart, 1e-12);
        ASSERT_EQ(one.candidates.size(), other.candidates.size());
        const auto by_depth = [](const ContactCandidate& a, const ContactCandidate& b) {
            return a.separation < b.separation;
        };
        std::sort(one.candidates.begin(), one.candidates.end(), by_depth);
        std::sort(other.candidates.begin(), other.candidates.end(), by_depth);
        for (std::size_t k = 0; k < one.candidates.size(); ++k) {
            const ContactCandidate &a = one.candidates[k], &b = other.candidates[k];
            EXPECT_NEAR(a.separation, b.separation, 1e-12);
            EXPECT_LT((a.position - pose * b.position).norm(), 1e-12);
            EXPECT_LT((a.normal + pose.orientation * b.normal).norm(), 1e-12);
        }
        count += one.candidates.size();
    }
    EXPECT_GT(count, 100U);
}

TEST(SphereCandidates, EachTouchHasItsOwnFeatureAndAUnitNormal)
{
    RandomShapes random(23);
    for (int i = 0; i < 40; ++i) {
        for (const ShapeRef other : {kLump, ShapeRef{ShapeKind::mesh, 0}}) {
            const Told told = ask(kRing, other, random.pose(0.5), 0.05);
            std::vector<std::uint32_t> features;
            for (const ContactCandidate& candidate : told.candidates) {
                EXPECT_NEAR(candidate.normal.norm(), 1, 1e-9);
                EXPECT_LE(candidate.separation, 0.05);
                features.push_back(candidate.feature);
            }
            std::sort(features.begin(), features.end());
            EXPECT_EQ(std::adjacent_find(features.begin(), features.end()), features.end());
        }
    }
}

// A floor of 180,000 triangles and 2000 spheres over it: more pairs than features of a level.
TEST(SphereCandidates, FeaturesStayApartAndOnTheirLevelOnALargeMesh)
{
    constexpr std::uint32_t kCells = 300;
    TriangleSoup floor;
    for (std::uint32_t i = 0; i <= kCells; ++i)
        for (std::uint32_t k = 0; k <= kCells; ++k) floor.vertices.emplace_back(i, k, 0);
    for (std::uint32_t i = 0; i < kCells; ++i)
        for (std::uint32_t k = 0; k < kCells; ++k) {
            const std::uint32_t at = i * (kCells + 1) + k, next = at + kCells + 1;
            floor.triangles.push_back({at, next, next + 1});
            floor.triangles.push_back({at, next + 1, at + 1});
        }
    Shapes all;
    all.meshes.push_back(build_mesh(floor.vertices, floor.triangles).mesh);
    all.solids.resize(1);
    RandomShapes random(21);
    SphereTree::Level level;
    level.error = 0.01;
    for (int i = 0; i < 2000; ++i)
        level.nodes.push_back(
            {Vec3(random.number(1, 299), random.number(1, 299), 0.09).cast<float>(), 0.1F, 0.1F,
             static_cast<std::uint32_t>(i), 1});
    // The second is the first, so that there is a level to be told.
    all.solids[0].spheres.levels = {level, level};

    std::vector<ContactCandidate> candidates;
    find_sphere_candidates({all, kRing, {ShapeKind::mesh, 0}, {}, 0}, {}, candidates);
    ASSERT_GE(candidates.size(), 2000U);
    std::set<std::uint32_t> features;
    for (const ContactCandidate& candidate : candidates) {
        EXPECT_EQ(candidate.feature >> 28, 1U);
        features.insert(candidate.feature);
    }
    EXPECT_EQ(features.size(), candidates.size());
}

TEST(SphereCandidates, StaysWithinItsTestsAndSaysWhatItReached)
{
    RandomShapes random(24);
    const SphereTree& ring = shapes().solids[0].spheres;
    const SphereTree& lump = shapes().solids[1].spheres;
    for (int i = 0; i < 30; ++i) {
        const Pose pose = random.pose(0.4);
        int last = -1;
        for (const std::size_t tests : {1, 10, 100, 1000, 10000}) {
            SphereBudget budget;
            budget.tests = tests;
            const SphereAnswer answer = ask(kRing, kLump, pose, 0.05, budget).answer;
            const auto level = static_cast<std::size_t>(answer.level);
            const auto error_at = [level](const SphereTree& tree) {
                return tree.levels[std::min(level, tree.levels.size() - 1)].error;
            };
            EXPECT_LE(answer.tests, tests);
            EXPECT_GE(answer.level, last);
            EXPECT_EQ(answer.error, error_at(ring) + error_at(lump));
            last = answer.level;
        }
        // The same level, asked for by name, gives the same.
        const Told told = ask(kRing, kLump, pose, 0.05, {1});
        EXPECT_EQ(told.answer.level, 1);
        SphereBudget error;
        error.error = told.answer.error;
        EXPECT_EQ(ask(kRing, kLump, pose, 0.05, error).answer.level, 1);
    }
}

TEST(SphereCandidates, EverySphereWithinReachFindsItsDeepestPartner)
{
    RandomShapes random(25);
    const auto& ring = shapes().solids[0].spheres.levels.back().nodes;
    const auto& lump = shapes().solids[1].spheres.levels.back().nodes;
    for (int i = 0; i < 40; ++i) {
        const Pose pose = random.pose(0.5);
        const Told told = ask(kRing, kLump, pose, 0.05);
        double least = std::numeric_limits<double>::infinity();
        std::size_t within = 0;
        for (const auto& a : ring) {
            double of_a = std::numeric_limits<double>::infinity();
            for (const auto& b : lump) {
                const Vec3 apart = pose * Vec3(b.center.cast<double>()) - a.center.cast<double>();
                of_a = std::min(of_a, apart.norm() - double{a.radius} - double{b.radius});
            }
            within += of_a <= 0.05 ? 1 : 0;
            least = std::min(least, of_a);
        }
        EXPECT_GE(told.candidates.size(), within);
        EXPECT_LE(told.candidates.size(), ring.size() + lump.size());
        if (within > 0) {
            EXPECT_NEAR(deepest(told), least, 1e-12);
        }
    }
}

TEST(SphereCandidates, DepthAgainstABoxIsWithinTheErrorWhateverTheBoxIsMadeOf)
{
    RandomShapes random(26);
    const Mesh& ring = shapes().solids[0].mesh;
    int touching = 0;
    // Places so near together that none of the surface is 0.025 from the next.
    const std::vector<CoverPoint> places = cover_points(ring, 8000);
    const Mesh& box = shapes().solids[3].mesh;
    const auto depth_in_box = [&](const Pose& pose) {
        double least = std::numeric_limits<double>::infinity();
        for (const CoverPoint& place : places)
            if (place.depth == 0)
                least = std::min(least, signed_distance(box, pose.to_local(place.at)));
        return least;
    };
    for (int i = 0; i < 12; ++i) {
        // The box lies shallow on the ring: turned at random, moved to where it just touches.
        Pose pose{random.vector(-1, 1).normalized(), random.turn()};
        double truth = depth_in_box(pose);
        for (int k = 0; k < 6 && truth > 0.02; ++k) {
            pose.position -= pose.position.normalized() * (0.5 * truth);
            truth = depth_in_box(pose);
        }
        for (const ShapeRef kind : box_kinds()) {
            const Told told = ask(kRing, kind, pose, 0.3);
            ASSERT_FALSE(told.candidates.empty());
            EXPECT_LE(deepest(told), truth + told.answer.error + 1e-9)
                << static_cast<int>(kind.kind);
            EXPECT_GE(deepest(told), truth - 0.025 - told.answer.error)
                << static_cast<int>(kind.kind);
            ++touching;
        }
    }
    EXPECT_EQ(touching, 60);
}

TEST(SphereCandidates, DepthInAPlaneIsWithinTheError)
{
    RandomShapes random(27);
    const Plane& plane = shapes().planes[0];
    for (int i = 0; i < 60; ++i) {
        const Pose pose = random.pose(0.4);
        double lowest = std::numeric_limits<double>::infinity();
        for (const Vec3& vertex : shapes().solids[1].mesh.vertices)
            lowest = std::min(lowest, plane.normal.dot(pose.to_local(vertex)) - plane.offset);
        for (int level = 0; level < 3; ++level) {
            const Told told = ask(kLump, {ShapeKind::plane, 0}, pose, 2, {level});
            ASSERT_FALSE(told.candidates.empty());
            EXPECT_NEAR(deepest(told), lowest, told.answer.error);
            EXPECT_LT((told.candidates[0].normal + pose.orientation * plane.normal).norm(), 1e-12);
        }
    }
}

TEST(SphereCandidates, AgreesWithSphereByCollide)
{
    // Each sphere of the tree as a shape of its own.
    RandomShapes random(28);
    Shapes all = shapes();
    const auto& nodes = all.solids[1].spheres.levels.back().nodes;
    const std::size_t first = all.spheres.size();
    for (const auto& node : nodes) all.spheres.push_back({double{node.radius}});
    for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder,
                                 ShapeKind::box, ShapeKind::hull, ShapeKind::plane})
        for (int i = 0; i < 10; ++i) {
            const Pose pose = random.pose(0.5);
            const Told told = ask(kLump, {kind, 0}, pose, 0.05);
            std::size_t found = 0;
            for (std::size_t k = 0; k < nodes.size(); ++k) {
                const Vec3 center = nodes[k].center.cast<double>();
                PairCache cache;
                LocalManifold<double> out;
                const auto ball = static_cast<std::uint32_t>(first + k);
                collide<double>({all,
                                 {ShapeKind::sphere, ball},
                                 {kind, 0},
                                 {pose.position - center, pose.orientation},
                                 0.05},
                                cache, out);
                if (out.count == 0) continue;
                ASSERT_LT(found, told.candidates.size());
                const ContactCandidate& candidate = told.candidates[found++];
                EXPECT_NEAR(candidate.separation, out.points[0].separation, 1e-9);
                EXPECT_LT((candidate.normal - out.normal).norm(), 1e-6);
                EXPECT_LT((candidate.position - center - out.points[0].position).norm(), 1e-6);
            }
            EXPECT_EQ(found, told.candidates.size());
        }
}

TEST(SphereCandidates, SaysNothingOfASolidWithoutSpheres)
{
    const Told told = ask(kBareBox, kRing, at(0, 0, 0), 0.1);
    EXPECT_TRUE(told.candidates.empty());
    EXPECT_LT(told.answer.apart, 0);
}

}  // namespace
}  // namespace throng
