#include "throng/impact_query.hpp"

#include "scene/rules/scene_check.hpp"
#include "throng/dials.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace throng {
namespace {

ShapeDescription ball(double radius) { return {"", SphereShape{radius}}; }

TEST(ImpactQuery, TellsWhenTwoShapesMeet)
{
    const ImpactQuery query(ball(0.5), {"", PlaneShape{}});
    ASSERT_EQ(query.trouble(), "");
    EXPECT_EQ(query.size(), 0.5);
    ShapeMotion falling, still;
    falling.pose.position = Vec3(0, 0, 2.5);
    falling.velocity = Vec3(0, 0, -4);
    const ImpactAnswer answer = query.ask(falling, still, 1);
    EXPECT_EQ(answer.trouble, "");
    EXPECT_TRUE(answer.meets);
    EXPECT_FALSE(answer.touching);
    EXPECT_LE(answer.time, 0.5);
    EXPECT_GE(answer.time, 0.5 - 1e-4 * 0.5 / 4);
    EXPECT_NEAR(answer.normal.z(), -1, 1e-12);
    EXPECT_GT(answer.evaluations, 0);
    EXPECT_FALSE(query.ask(falling, still, 0.4).meets);
    EXPECT_EQ(query.ask(falling, still, 0.4).time, 0.4);
}

TEST(ImpactQuery, RefusesWhatItCannotAnswer)
{
    const ShapeDescription plane{"", PlaneShape{}};
    EXPECT_NE(ImpactQuery(plane, plane).trouble(), "");
    EXPECT_NE(ImpactQuery(ball(-1), plane).trouble(), "");
    EXPECT_NE(ImpactQuery(ball(1), {"", CompoundShape{}}).trouble(), "");
    const ImpactQuery query(ball(1), plane);
    ShapeMotion lost;
    lost.velocity.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(query.ask(lost, {}, 1).trouble, "");
    EXPECT_NE(query.ask({}, {}, 0).trouble, "");
    EXPECT_NE(query.ask({}, {}, 1, ToiMethod::newton, 1e-13).trouble, "");
    EXPECT_NE(ask_linear_paths({}, ToiMethod::newton, -1).trouble, "");
}

// Told by all methods, of what turns as it falls: the time is no later than the one that is looked
// for with a hundredth of the tolerance, and no further from it than the tolerance takes.
TEST(ImpactQuery, MeetsTheLeastTolerance)
{
    const ImpactQuery query({"", BoxShape{{0.5, 0.3, 0.2}}}, {"", BoxShape{{2, 2, 0.5}}});
    ShapeMotion falling, still;
    falling.pose.position = Vec3(0.1, -0.2, 3);
    falling.pose.orientation = Quat(0.8, 0.6, 0, 0);
    falling.velocity = Vec3(0.5, 0.2, -4);
    falling.angular_velocity = Vec3(1, 2, 3);
    for (const ToiMethod method :
         {ToiMethod::newton, ToiMethod::bisection, ToiMethod::conservative}) {
        double before = 0;
        for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
            const ImpactAnswer answer = query.ask(falling, still, 1, method, tolerance);
            ASSERT_EQ(answer.trouble, "");
            ASSERT_TRUE(answer.meets);
            // It falls by more than 2 m/s there, and the tolerance is of 0.2 m.
            EXPECT_GE(answer.time, before);
            if (before > 0) {
                EXPECT_LE(answer.time - before, 100 * tolerance * 0.2 / 2) << tolerance;
            }
            EXPECT_LE(answer.distance, tolerance * 0.2);
            before = answer.time;
        }
    }
}

TEST(ImpactQuery, SaysWhatToleranceFloatResolves)
{
    Scene scene;
    Settings& settings = scene.settings;
    EXPECT_EQ(dial_value(settings, "toi_tolerance"), "1e-04");
    EXPECT_EQ(set_dial(settings, "toi_tolerance", "1e-12"), "");
    const std::string trouble = check_scene(scene);
    EXPECT_NE(trouble.find("settings: toi_tolerance: wanted 1.1920928955078125e-07 or more"),
              std::string::npos)
        << trouble;
    settings.precision = Precision::double_;
    EXPECT_EQ(check_scene(scene), "");
    settings.precision = Precision::float_;
    EXPECT_EQ(set_dial(settings, "toi_tolerance", "1e-6"), "");
    EXPECT_EQ(settings.toi_tolerance, 1e-6);
    EXPECT_EQ(set_dial(settings, "toi_method", "bisection"), "");
    EXPECT_EQ(settings.toi_method, ToiMethod::bisection);
    EXPECT_EQ(check_scene(scene), "");
}

}  // namespace
}  // namespace throng
