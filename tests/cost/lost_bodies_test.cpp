// Lost bodies: a run that had to take a body out proves nothing.
#include "cost/cases.hpp"
#include "pipeline/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

TEST(CaseBench, NoLinePassesThatARunWithAQuarantinedBodyIsIn)
{
    CaseBench bench;
    Scene scene = bench.scene();
    scene.gravity = Vec3(0, 0, 1e15);
    scene.shapes.push_back({"ball", SphereShape{1}});
    BodyDescription& ball = scene.bodies.emplace_back();
    ball.shape = 0;
    bench.run(scene, 20, [](World&, double) { return true; });
    bench.report("falls for ever", "error", 0, 1, "1");
    bench.report("the next line", "error", 0, 1, "1");
    const std::vector<CaseResult> results = bench.take_results("H0");
    EXPECT_EQ(results[0].verdict, Verdict::fail);
    EXPECT_EQ(results[0].why, "bodies quarantined: 1");
    EXPECT_EQ(results[1].verdict, Verdict::pass);
}

}  // namespace
}  // namespace throng
