// Large hulls: beyond the wide kernels, where GJK leads to the points of contact.
#include "scene/catalog/random.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// The catalogue's hulls, each of so many points on a ball of its size.
Scene heap_of_large_hulls(int bodies, int points)
{
    Scene scene = make_scene("hulls", bodies);
    Random random(61);
    for (auto& shape : scene.shapes) {
        auto* const hull = std::get_if<HullShape>(&shape.shape);
        if (hull == nullptr) continue;
        double radius = 0;
        for (const Vec3& point : hull->points) radius = std::max(radius, point.norm());
        hull->points.clear();
        while (std::ssize(hull->points) < points) {
            const Vec3 to(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            if (to.norm() > 0.1 && to.norm() < 1) hull->points.push_back(radius * to.normalized());
        }
    }
    return scene;
}

TEST(LargeHulls, AHeapComesToRest)
{
    for (const Precision precision : {Precision::float_, Precision::double_}) {
        Scene scene = heap_of_large_hulls(40, 128);
        scene.settings.precision = precision;
        World world(scene, 1);
        const double fallen = world.measure().potential_energy;
        world.step(600);
        const Measures measures = world.measure();
        EXPECT_LT(measures.kinetic_energy, 1e-6 * fallen);
        // What contacts let bodies at rest overlap is some tenths of a millimetre here.
        EXPECT_LT(measures.mean_overlap, 1e-3);
        EXPECT_LT(measures.greatest_overlap, 5e-3);
        EXPECT_EQ(world.report().fallbacks, 0U);
    }
}

}  // namespace
}  // namespace throng
