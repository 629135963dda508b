// Collide solids: what is looked at once and found far away is looked at again in time.
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/sheets.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;

// Thin rings that fall flat on wide triangles, each from a little higher up.
TEST(CollideSolids, RingsThatFallFlatOnASheetStayOnIt)
{
    constexpr int kRings = 60;
    constexpr double kThick = 0.04;
    for (const double dt : {1.0 / 60, 1.0 / 240}) {
        SceneOf made;
        made.scene.settings.dt = dt;
        const MeshShape floor =
            mesh_shape(sheet_mesh(12, [](int i, int k) { return Vec3(8.3 * i, 8.3 * k, 0); }));
        made.body(made.shape(floor), Vec3::Zero()).motion = Motion::static_;
        const auto ring = made.shape(mesh_shape(torus_mesh(0.56, kThick, 16, 8)));
        for (int i = 0; i < kRings; ++i)
            made.body(ring, {3 + 4.0 * (i % 10), 3 + 4.0 * (i / 10), kThick + 0.4 + 2e-3 * i});
        World world(made.scene);
        world.step(static_cast<int>(1.5 / dt));
        for (std::size_t i = 1; i <= kRings; ++i)
            EXPECT_GT(world.pose(world.bodies()[i]).position.z(), 0.9 * kThick)
                << "dt " << dt << ", ring " << i;
    }
}

}  // namespace
}  // namespace throng
