#include "cooking/decomposition/convex_cover.hpp"

#include "cooking/decomposition/bare_surface.hpp"
#include "cooking/decomposition/convex_parts.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "scene/catalog/threads.hpp"
#include "tests/support/closed.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace throng {
namespace {

PartSearch search_of(const Mesh& mesh, double error)
{
    return {mesh, longest_side(mesh), error, inward_edges(mesh)};
}

double out_of_all(const std::vector<HullMesh>& hulls, const Vec3& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const HullMesh& hull : hulls) least = std::min(least, distance_outside(hull, point));
    return least;
}

// As the catalogue has it, but shorter.
constexpr Thread kThread{0.01, 0.005, 0.00025};

TEST(ConvexCover, ThreadIsItsCoreAndItsTurns)
{
    const Mesh bolt = closed(bolt_mesh(kThread, 3 * kThread.pitch, 24));
    // Less than half of the play between it and its nut.
    const double error = 1e-4;
    const PartSearch search = search_of(bolt, error);
    const std::vector<HullMesh> hulls = cover_by_hulls(search, 64);
    ASSERT_FALSE(hulls.empty());
    // Wedges between the columns of its vertices would be 24 a turn.
    EXPECT_LT(hulls.size(), 72u);
    for (const HullMesh& hull : hulls) {
        EXPECT_LE(hull.vertices.size(), kMostPartVertices);
        EXPECT_LE(find_overhang(bolt, hull, error / 4, error, 400).least, error);
    }
    EXPECT_LE(find_bare_surface(bolt, hulls, error).bound, 4 * error);
    const std::vector<SurfaceSample> samples = sample_surface(bolt);
    for (std::size_t i = 0; i < samples.size(); i += 16)
        EXPECT_LE(out_of_all(hulls, samples[i].point), error);
}

TEST(ConvexCover, GivesUpOnWhatTakesMore)
{
    const Mesh bolt = closed(bolt_mesh(kThread, 4 * kThread.pitch, 24));
    EXPECT_TRUE(cover_by_hulls(search_of(bolt, 1e-4), 8).empty());
}

TEST(ConvexCover, ConvexMeshIsOneHull)
{
    const Mesh ball = closed(ball_mesh(1, 8, 8));
    const std::vector<HullMesh> hulls = cover_by_hulls(search_of(ball, 1e-3), 4);
    ASSERT_EQ(hulls.size(), 1u);
    EXPECT_NEAR(hulls[0].volume, mass_of(ball).volume, 1e-2);
}

TEST(ConvexCover, TurnedMeshIsCoveredAsWell)
{
    TriangleSoup soup = bolt_mesh(kThread, 2 * kThread.pitch, 24);
    for (Vec3& vertex : soup.vertices)
        vertex = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())) * vertex;
    const Mesh bolt = closed(soup);
    const std::vector<HullMesh> hulls = cover_by_hulls(search_of(bolt, 1e-4), 40);
    ASSERT_FALSE(hulls.empty());
    EXPECT_LE(find_bare_surface(bolt, hulls, 1e-4).bound, 4e-4);
}

TEST(BareSurface, IsAsFarOutAsWhatNoHullCovers)
{
    const Mesh box = closed(box_mesh({1, 1, 1}));
    // The lower three quarters of it.
    std::vector<Vec3> corners = box.vertices;
    double upper = 0, lower = 0;
    for (const Vec3& corner : corners) {
        upper = std::max(upper, corner.z());
        lower = std::min(lower, corner.z());
    }
    const double quarter = (upper - lower) / 4;
    for (Vec3& corner : corners) corner.z() = std::min(corner.z(), upper - quarter);
    const std::vector<HullMesh> most = {hull_mesh(corners)};
    const BareSurface bare = find_bare_surface(box, most, 0.01);
    EXPECT_NEAR(bare.bound, quarter, 1e-9);
    EXPECT_GT(bare.where.z(), upper - quarter);
    EXPECT_LE(find_bare_surface(box, {hull_mesh(box.vertices)}, 0.01).bound, 1e-12);
}

TEST(BareSurface, HullsTogetherCoverWhatNoneDoes)
{
    const Mesh box = closed(box_mesh({1, 1, 1}));
    std::vector<HullMesh> halves;
    for (const double side : {-1.0, 1.0}) {
        std::vector<Vec3> corners = box.vertices;
        // A little over the middle, so that the two overlap.
        for (Vec3& corner : corners)
            if (side * corner.x() < 0) corner.x() = -0.1 * side;
        halves.push_back(hull_mesh(corners));
    }
    EXPECT_LE(find_bare_surface(box, halves, 0.02).bound, 0.02);
}

}  // namespace
}  // namespace throng
