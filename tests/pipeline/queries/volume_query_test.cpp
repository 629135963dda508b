// Volume query: ways asked by name through the public door, and what is refused there.
#include "scene/catalog/closed_meshes.hpp"
#include "throng/throng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace throng {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ShapeDescription box(double x, double y, double z) { return {"", BoxShape{{x, y, z}}}; }
ShapeDescription ball(double radius) { return {"", SphereShape{radius}}; }
ShapeDescription mesh(const TriangleSoup& soup)
{
    MeshShape shape;
    shape.vertices = soup.vertices;
    shape.triangles = soup.triangles;
    return {"", shape};
}
Pose at(double x, double y, double z) { return {{x, y, z}, Quat::Identity()}; }

TEST(KnownVolumeWays, HaveNamesOfTheirOwn)
{
    const std::vector<VolumeWayDescription> ways = known_volume_ways();
    ASSERT_EQ(ways.size(), 4u);
    for (std::size_t i = 0; i < ways.size(); ++i) {
        EXPECT_FALSE(ways[i].about.empty()) << ways[i].name;
        for (std::size_t k = 0; k < i; ++k) EXPECT_NE(ways[i].name, ways[k].name);
    }
}

TEST(VolumeQuery, EachWayTellsWhatItClaimsOfBoxesHoweverStated)
{
    const ShapeDescription first[] = {box(0.5, 0.5, 0.5), mesh(box_mesh({0.5, 0.5, 0.5}))};
    const ShapeDescription second[] = {box(0.5, 1, 1), mesh(box_mesh({0.5, 1, 1}))};
    for (const ShapeDescription& a : first)
        for (const ShapeDescription& b : second) {
            VolumeQuery query(a, b);
            ASSERT_EQ(query.trouble(), "");
            for (const VolumeWayDescription& way : known_volume_ways()) {
                const VolumeAnswer answer = query.ask(way.name, at(0.75, 0.1, 0.2), 64);
                ASSERT_EQ(answer.trouble, "");
                // The last layer of pixels sticks out by as much as it likes: one in 64.
                const double slack = way.converges ? 0.25 / 64 : 1e-12;
                EXPECT_NEAR(answer.volume, 0.25, slack) << way.name;
                EXPECT_NEAR((answer.center - Vec3(0.375, 0, 0)).norm(), 0, 4 * slack) << way.name;
                if (way.pushes) {
                    EXPECT_NEAR((answer.normal - Vec3::UnitX()).norm(), 0, 1e-12) << way.name;
                    EXPECT_NEAR(answer.depth, 0.25, 1e-12) << way.name;
                }
                EXPECT_EQ(query.ask(way.name, at(1.25, 0, 0), 64).volume, 0) << way.name;
            }
        }
}

TEST(VolumeQuery, OnlyASingleLayerFillsTheHoleOfATorus)
{
    VolumeQuery query(mesh(torus_mesh(0.7, 0.2, 32, 16)), mesh(box_mesh({0.2, 0.2, 1})));
    for (const VolumeWayDescription& way : known_volume_ways()) {
        const VolumeAnswer answer = query.ask(way.name, Pose{}, 48);
        ASSERT_EQ(answer.trouble, "");
        if (way.name == "single_layer") {
            EXPECT_GT(answer.volume, 0.01);
        } else {
            EXPECT_NEAR(answer.volume, 0, 1e-12) << way.name;
        }
    }
}

TEST(VolumeQuery, RefusesMeshesThatEncloseNothing)
{
    TriangleSoup open = box_mesh({1, 1, 1});
    open.triangles.pop_back();
    TriangleSoup inverted = box_mesh({1, 1, 1});
    for (auto& triangle : inverted.triangles) std::swap(triangle[1], triangle[2]);
    TriangleSoup flat = box_mesh({1, 1, 1});
    for (Vec3& vertex : flat.vertices) vertex.x() = vertex.y() = 0;
    const auto trouble = [](const ShapeDescription& shape) {
        VolumeQuery first(shape, ball(1)), second(ball(1), shape);
        EXPECT_EQ(first.trouble().find("shape a: "), 0u) << first.trouble();
        EXPECT_EQ(second.trouble().find("shape b: "), 0u) << second.trouble();
        EXPECT_EQ(first.ask("voxels", Pose{}).trouble, first.trouble());
        return first.trouble();
    };
    EXPECT_NE(trouble(mesh(open)).find("open, 3 edges"), std::string::npos);
    EXPECT_NE(trouble(mesh(inverted)).find("inside out"), std::string::npos);
    EXPECT_NE(trouble(mesh(flat)), "");
    EXPECT_NE(trouble(mesh({})).find("wanted a mesh with triangles"), std::string::npos);
    EXPECT_NE(trouble({"", PlaneShape{}}).find("wanted a sphere"), std::string::npos);
    EXPECT_NE(trouble(ball(0)).find("sphere.radius"), std::string::npos);
}

TEST(VolumeQuery, RefusesQuestionsThatMakeNoSenseOrTakeTooLong)
{
    VolumeQuery query(box(1, 1, 1), ball(1));
    const auto trouble = [&](std::string_view way, const Pose& pose, int resolution = 32) {
        return query.ask(way, pose, resolution).trouble;
    };
    EXPECT_NE(trouble("voxel", Pose{}).find("there is no way \"voxel\""), std::string::npos);
    EXPECT_NE(trouble("voxels", at(kNaN, 0, 0)).find("position"), std::string::npos);
    EXPECT_NE(trouble("voxels", {Vec3::Zero(), Quat(0, 0, 0, 0)}).find("unit"), std::string::npos);
    EXPECT_NE(trouble("voxels", Pose{}, 0).find("give 1 to 1024"), std::string::npos);
    EXPECT_NE(trouble("depth_image", Pose{}, 1025).find("give 1 to 1024"), std::string::npos);
    EXPECT_NE(trouble("exact", Pose{}).find("boxes, hulls and meshes"), std::string::npos);
    EXPECT_EQ(trouble("single_layer", Pose{}, 1024 / 32), "");
    const TriangleSoup fine = ball_mesh(1, 80, 40);
    VolumeQuery large(mesh(fine), mesh(fine));
    EXPECT_NE(large.ask("exact", Pose{}).trouble.find("20000000 are the limit"), std::string::npos);
}

}  // namespace
}  // namespace throng
