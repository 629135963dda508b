#include "cooking/sphere_trees/mesh_cells.hpp"

#include "kernels/geometry/mesh_distance.hpp"
#include "tests/support/closed_meshes.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

TEST(MeshCells, NoPlaceIsDeeperThanTheyTell)
{
    RandomShapes random(5);
    for (const Mesh& mesh : {closed(box_mesh({0.5, 0.4, 0.3})), closed(noisy_ball(7, 0.5, 0.1)),
                             closed(torus_mesh(0.35, 0.15, 24, 12))}) {
        MeshCells cells(mesh);
        int told_outside = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3 place = random.vector(-0.7, 0.7);
            const double depth = -signed_distance(mesh, place), bound = cells.depth_bound(place);
            EXPECT_LE(depth, bound);
            // In a cell the bound is off by twice half its diagonal at most; a cell is a 24th of
            // the longest side, which is 1.2 at most.
            if (depth > 0) {
                EXPECT_LE(bound, depth + 1.7321 * 1.2 / 24);
            }
            told_outside += bound <= 0;
        }
        EXPECT_GT(told_outside, 1000);
    }
}

TEST(MeshCells, CornersOfTheBoundsBelongToACell)
{
    const Mesh mesh = closed(box_mesh({0.5, 0.4, 0.3}));
    MeshCells cells(mesh);
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.4, 0.4})
            for (const double z : {-0.3, 0.3}) EXPECT_GE(cells.depth_bound({x, y, z}), 0);
}

}  // namespace
}  // namespace throng
