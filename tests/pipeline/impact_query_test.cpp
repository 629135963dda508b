#include "pipeline/impact_query.hpp"

#include "pipeline/dials.hpp"

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
    EXPECT_NE(query.ask({}, {}, 1, ToiMethod::newton, 1e-9).trouble, "");
    EXPECT_NE(ask_linear_paths({}, ToiMethod::newton, -1).trouble, "");
}

TEST(ImpactQuery, SaysWhatToleranceFloatResolves)
{
    Settings settings;
    EXPECT_EQ(dial_value(settings, "toi_tolerance"), "1e-04");
    const std::string trouble = set_dial(settings, "toi_tolerance", "1e-8");
    EXPECT_NE(trouble.find("1.1920928955078125e-07"), std::string::npos) << trouble;
    EXPECT_EQ(set_dial(settings, "toi_tolerance", "1e-6"), "");
    EXPECT_EQ(settings.toi_tolerance, 1e-6);
    EXPECT_EQ(set_dial(settings, "toi_method", "bisection"), "");
    EXPECT_EQ(settings.toi_method, ToiMethod::bisection);
}

}  // namespace
}  // namespace throng
