// Scene file, written: what is written reads back to the same bits.
#include "scene/catalog/closed_meshes.hpp"
#include "scene/shapes/level_set.hpp"
#include "tests/support/same_bytes.hpp"
#include "throng/catalog.hpp"
#include "throng/scene_file.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>

namespace throng {
namespace {

/// A folder of the test's own, gone when it ends.
class WriteScene : public ::testing::Test {
protected:
    void SetUp() override
    {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path()
            / ("throng_" + std::string(test->name()) + '_'
               + std::to_string(std::random_device{}()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string text(const std::string& name) const
    {
        std::ifstream file(path(name), std::ios::binary);
        std::stringstream all;
        all << file.rdbuf();
        return all.str();
    }

    std::filesystem::path folder_;
};

Instances many(std::size_t count, std::uint32_t shape, bool own_sizes)
{
    Instances group;
    group.common.shape = shape;
    group.own_sizes = own_sizes;
    std::mt19937_64 random(7);
    const auto number = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (std::size_t i = 0; i < count; ++i) {
        Quat turn(number() - 0.5, number(), number(), number());
        turn.normalize();
        const double record[16] = {number(), -0.0,         number() * 1e9, turn.w(),
                                   turn.x(), turn.y(),     turn.z(),       number(),
                                   1e-310,   number(),     number(),       number(),
                                   number(), 1 + number(), 1 + number(),   1 + number()};
        group.records.insert(group.records.end(), record, record + group.stride());
    }
    return group;
}

/// Something of everything, and numbers that are hard to print.
Scene full_scene()
{
    Scene scene;
    scene.gravity = Vec3(-0.0, 0.1, -1.0 / 3);
    scene.wind = Vec3(5e-324, 0, 0);
    scene.settings.dt = 1.0 / 90;
    scene.settings.substeps = 7;
    scene.settings.contact_hertz = 30;
    scene.settings.precision = Precision::double_;
    scene.dials_set = {"sleep", "dt"};
    scene.materials = {{"wood \"x\"\n\u00e9", 700, 0.1, 0.3, 0.01}, {"", 1000, 0.5, 0, 0}};
    scene.pairs = {{0, 1, 0.25, std::nullopt}, {1, 1, std::nullopt, 1.0}};
    scene.shapes = {
        {"ball", SphereShape{0.1}},
        {"pill", CapsuleShape{0.1, 1.0 / 3}},
        {"can", CylinderShape{0.7, 0.1}},
        {"", BoxShape{Vec3(0.1, 0.2, 1e6)}},
        {"a b", HullShape{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 0.1)}}},
        {"floor", PlaneShape{Vec3(0.6, 0, 0.8), -0.1}},
        {"tri",
         MeshShape{
             {}, 1, "voxels", {Vec3(0, 0, 0.1), Vec3(1, -0.0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}}},
        {"both", CompoundShape{{{0, {Vec3(0.1, 0, 0), Quat(0, 1, 0, 0)}}, {3, {}}}}}};
    BodyDescription body;
    body.name = "b";
    body.shape = 7;
    body.material = 0;
    body.position = Vec3(1e15, -0.0, 0.1);
    body.orientation = Quat(0.5, 0.5, 0.5, -0.5);
    body.velocity = Vec3(0.1, 0, 0);
    body.angular_velocity = Vec3(0, 0.7, 0);
    body.mass = 0.1;
    body.inertia = Sym3{1, 1, 1, 0.1, -0.0, 0.2};
    body.center = Vec3(0, 0, -0.0);
    body.force = Vec3(0, 0, 0.3);
    body.torque = Vec3(0.3, 0, 0);
    body.linear_drag = 0.1;
    body.angular_drag = 0.2;
    body.group = 6;
    body.mask = 0;
    body.fast = true;
    scene.bodies.push_back(body);
    scene.bodies.push_back({});
    scene.bodies[1].shape = 5;
    scene.bodies[1].motion = Motion::static_;
    scene.bodies[1].drive_velocity = {1.4, std::nullopt, -0.0};
    scene.bodies.push_back({});
    scene.bodies[2].mass = 3;
    scene.bodies[2].lock_rotation = true;
    scene.bodies[2].pivot = Vec3(0, 0, -0.05);
    scene.springs = {{0, kNone, Vec3(0.1, 0, 0), Vec3(0, 0, 3), 1e4, 0.1, 1},
                     {2, 0, {0, 0, 0}, {0, 0, 0}, 1, 0, 0}};
    scene.attractors = {{Vec3(1, 2, 3), -0.1}};
    scene.instances.push_back(many(20, 3, false));
    scene.instances.push_back(many(5000, 3, true));
    scene.instances.push_back(many(3, 0, false));
    scene.instances[1].common.lock_position = false;
    return scene;
}

TEST_F(WriteScene, ReadsBackToTheSameText)
{
    write_scene(full_scene(), path("a.json"));
    const Scene first = read_scene(path("a.json"));
    EXPECT_EQ(first.name, "a");
    write_scene(first, path("b.json"));
    EXPECT_EQ(text("a.json"), text("b.json"));
}

TEST_F(WriteScene, ReadsBackToTheSameBits)
{
    const Scene a = full_scene();
    write_scene(a, path("a.json"));
    const Scene b = read_scene(path("a.json"));
    const auto same = [](const auto& x, const auto& y) { return given::same_bytes(x, y); };
    EXPECT_TRUE(same(a.gravity, b.gravity));
    EXPECT_TRUE(same(a.wind, b.wind));
    EXPECT_EQ(a.settings.dt, b.settings.dt);
    EXPECT_EQ(a.settings.contact_hertz, b.settings.contact_hertz);
    EXPECT_EQ(b.settings.precision, Precision::double_);
    EXPECT_EQ(a.materials[0], b.materials[0]);
    ASSERT_EQ(b.body_count(), a.body_count());
    const BodyDescription &x = a.bodies[0], &y = b.bodies[0];
    EXPECT_TRUE(same(x.position, y.position));
    EXPECT_TRUE(same(x.orientation, y.orientation));
    EXPECT_TRUE(same(*x.inertia, *y.inertia));
    EXPECT_TRUE(same(*x.center, *y.center));
    EXPECT_TRUE(same(*a.bodies[1].drive_velocity[2], *b.bodies[1].drive_velocity[2]));
    EXPECT_FALSE(b.bodies[1].drive_velocity[1].has_value());

    // Twenty instances became bodies; the groups after them kept their files and their order.
    ASSERT_EQ(b.bodies.size(), 23u);
    ASSERT_EQ(b.instances.size(), 2u);
    EXPECT_EQ(b.bodies[5].position.z(), a.instances[0].records[2 * 13 + 2]);
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<double>&p = a.instances[i + 1].records, &q = b.instances[i].records;
        ASSERT_EQ(p.size(), q.size());
        EXPECT_EQ(std::memcmp(p.data(), q.data(), p.size() * sizeof(double)), 0);
    }
    const auto &mesh = std::get<MeshShape>(a.shapes[6].shape),
               &mesh_again = std::get<MeshShape>(b.shapes[6].shape);
    EXPECT_TRUE(same(mesh.vertices[1], mesh_again.vertices[1]));
    EXPECT_EQ(mesh.triangles, mesh_again.triangles);
    EXPECT_EQ(b.springs[1].a, 2u);
    EXPECT_FALSE(b.bodies[2].name.empty());  // a spring has to name it
}

TEST_F(WriteScene, KeepsAFileThatHoldsWhatTheGroupHolds)
{
    Scene scene;
    scene.shapes = {{"box", BoxShape{Vec3(1, 1, 1)}}};
    scene.instances = {many(10, 0, false)};
    scene.instances[0].file = "mine.bin";
    write_scene(scene, path("a.json"));
    EXPECT_FALSE(std::filesystem::exists(path("mine.bin")));
    EXPECT_TRUE(std::filesystem::exists(path("a.0.bin")));

    std::filesystem::rename(path("a.0.bin"), path("mine.bin"));
    write_scene(scene, path("a.json"));
    EXPECT_FALSE(std::filesystem::exists(path("a.0.bin")));
    EXPECT_EQ(read_scene(path("a.json")).instances[0].file, "mine.bin");
}

TEST_F(WriteScene, PutsALevelSetInAFileBesideItOnce)
{
    const TriangleSoup torus = torus_mesh(0.4, 0.15, 24, 12);
    const auto level_set = make_level_set(torus.vertices, torus.triangles, 0.06).level_set;
    ASSERT_NE(level_set, nullptr);
    Scene scene;
    scene.shapes = {{"ball", SphereShape{1}}, {"ring", VoxelsShape{"", level_set}}};
    write_scene(scene, path("a.json"));
    const Scene again = read_scene(path("a.json"));
    const auto& voxels = std::get<VoxelsShape>(again.shapes[1].shape);
    EXPECT_EQ(voxels.file, "a.1.vdb");
    EXPECT_TRUE(same_level_set(*voxels.level_set, *level_set));

    // The file that says the same is left alone, one that does not is not written over.
    const std::string bytes = text("a.1.vdb");
    write_scene(again, path("b.json"));
    EXPECT_FALSE(std::filesystem::exists(path("b.1.vdb")));
    EXPECT_EQ(text("a.1.vdb"), bytes);
    EXPECT_EQ(text("b.json"), text("a.json"));
    Scene other = again;
    const auto finer = make_level_set(torus.vertices, torus.triangles, 0.05).level_set;
    std::get<VoxelsShape>(other.shapes[1].shape).level_set = finer;
    write_scene(other, path("c.json"));
    EXPECT_EQ(text("a.1.vdb"), bytes);
    const Scene third = read_scene(path("c.json"));
    EXPECT_TRUE(same_level_set(*std::get<VoxelsShape>(third.shapes[1].shape).level_set, *finer));
}

TEST_F(WriteScene, ATerrainOfTheCatalogueMovesOnAsItDidBefore)
{
    const Scene made = make_scene("terrain", 8);
    write_scene(made, path("t.json"));
    EXPECT_TRUE(std::filesystem::exists(path("t.0.vdb")));
    const Scene read = read_scene(path("t.json"));
    World a(made), b(read);
    EXPECT_EQ(a.state_hash(), b.state_hash());
    a.step(100);
    b.step(100);
    EXPECT_GT(a.report().contacts, 0u);
    EXPECT_EQ(a.state_hash(), b.state_hash());
}

TEST_F(WriteScene, NeverWritesOverTheFileOfAnotherGroup)
{
    Scene scene;
    scene.shapes = {{"box", BoxShape{Vec3(1, 1, 1)}}};
    scene.instances = {many(2000, 0, false), many(2, 0, true)};
    write_scene(scene, path("b.json"));  // b.0.bin and b.1.bin
    scene.instances[1].file = "b.0.bin";
    std::filesystem::rename(path("b.1.bin"), path("b.0.bin"));
    write_scene(scene, path("b.json"));
    const Scene again = read_scene(path("b.json"));
    EXPECT_EQ(again.instances[0].records, scene.instances[0].records);
    EXPECT_EQ(again.instances[1].records, scene.instances[1].records);
}

TEST_F(WriteScene, RefusesWhatCouldNotBeReadBack)
{
    Scene scene;
    scene.gravity.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(write_scene(scene, path("a.json")), std::runtime_error);
    EXPECT_FALSE(std::filesystem::exists(path("a.json")));
    EXPECT_THROW(write_scene(Scene{}, path("none/a.json")), std::runtime_error);
    scene = Scene{};
    scene.shapes = {{"box", BoxShape{Vec3(1, 1, 1)}}};
    scene.instances = {many(2, 0, false)};
    scene.springs = {{0, kNone, Vec3::Zero(), Vec3::Zero(), 1, 0, 0}};
    EXPECT_THROW(write_scene(scene, path("a.json")), std::runtime_error);
}

TEST_F(WriteScene, AnEmptySceneIsAScene)
{
    write_scene(Scene{}, path("a.json"));
    EXPECT_EQ(text("a.json"), "{\n  \"throng\": 1\n}\n");
    EXPECT_EQ(read_scene(path("a.json")).body_count(), 0u);
}

}  // namespace
}  // namespace throng
