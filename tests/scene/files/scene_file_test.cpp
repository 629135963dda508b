// Scene file: what is read of one.
#include "scene/shapes/level_set.hpp"
#include "tests/scene/files/scene_texts.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

TEST(SceneFile, ReadsWhatItSays)
{
    const Scene scene = given::read_given(R"({
  "throng": 1, "gravity": [0, 0, -1.5],
  "settings": {"dt": "1/120", "substeps": 8, "contact_rate": "fixed:30", "sleep": "off"},
  "springs": [{"a": "b0", "b": null, "at_b": [0, 0, 3], "stiffness": 1e4, "length": 1}],
  "attractors": [{"position": [1, 2, 3], "strength": -4}], "wind": [1, 0, 0],
  "bodies": [
    {"name": "ground", "shape": "floor", "motion": "static"},
    {"name": "b0", "shape": "bin", "material": "wood", "position": [0, 0, 2],
     "orientation": [0.7071068, 0, 0, 0.7071068], "velocity": [1, 2, 3],
     "angular_velocity": [4, 5, 6], "mass": 12, "group": 4294967295, "mask": 0, "fast": true,
     "inertia": [1, 1, 2, 0, 0, 0], "center": [0, 0, 0.1], "force": [1, 0, 0],
     "torque": [0, 1, 0], "drag": {"angular": 2}, "drive_velocity": [1.4, 0, null]},
    {"shape": null, "mass": 2, "lock_rotation": true, "pivot": [0, 0, -0.05]}],
  "instances": [{"shape": "crate", "file": "ten.bin"},
                {"shape": "crate", "count": 1, "sizes": "file", "file": "box.bin"}],
  "shapes": {
    "bin": {"compound": [{"shape": "crate"}, {"shape": "pill", "position": [0, 0, 1]}]},
    "crate": {"box": {"half_extents": [0.5, 0.4, 0.3]}},
    "pill": {"capsule": {"radius": 0.25, "half_length": 0.6}},
    "floor": {"plane": {"normal": [0, 0, 1.0000005], "offset": 2}},
    "tri": {"mesh": {"file": "tri.obj", "scale": 2, "nonconvex": "voxels"}}},
  "pairs": [{"materials": ["wood", "ice"], "friction": 0.09}],
  "materials": {"wood": {"density": 700}, "ice": {"friction": 0, "rolling_friction": 0.1}}
})");
    EXPECT_EQ(scene.gravity, Vec3(0, 0, -1.5));
    EXPECT_EQ(scene.settings.dt, 1.0 / 120);
    EXPECT_EQ(scene.settings.substeps, 8);
    EXPECT_EQ(scene.settings.contact_hertz, 30);
    EXPECT_FALSE(scene.settings.sleep);
    EXPECT_EQ(scene.dials_set,
              (std::vector<std::string>{"dt", "substeps", "contact_rate", "sleep"}));
    ASSERT_EQ(scene.body_count(), 14u);

    const BodyDescription& b0 = scene.bodies[1];
    EXPECT_EQ(scene.shapes[b0.shape].name, "bin");
    EXPECT_EQ(scene.materials[b0.material].name, "wood");
    EXPECT_NEAR(b0.orientation.norm(), 1, 1e-15);
    EXPECT_EQ(b0.velocity, Vec3(1, 2, 3));
    EXPECT_EQ(b0.angular_velocity, Vec3(4, 5, 6));
    EXPECT_EQ(b0.mass, 12);
    EXPECT_EQ(b0.group, 4294967295u);
    EXPECT_EQ(b0.mask, 0u);
    EXPECT_TRUE(b0.fast);
    EXPECT_EQ(b0.inertia, (Sym3{1, 1, 2, 0, 0, 0}));
    EXPECT_EQ(b0.angular_drag, 2);
    EXPECT_EQ(b0.drive_velocity[0], 1.4);
    EXPECT_FALSE(b0.drive_velocity[2].has_value());
    EXPECT_EQ(scene.bodies[2].shape, kNone);
    EXPECT_EQ(scene.bodies[2].motion, Motion::dynamic);
    EXPECT_EQ(scene.bodies[2].pivot, Vec3(0, 0, -0.05));

    const auto& plane = std::get<PlaneShape>(scene.shapes[3].shape);
    EXPECT_EQ(plane.normal, Vec3(0, 0, 1));
    EXPECT_NEAR(plane.offset, 2 / 1.0000005, 1e-15);
    EXPECT_EQ(std::get<MeshShape>(scene.shapes[4].shape).vertices[1], Vec3(2, 0, 0));
    EXPECT_EQ(std::get<CompoundShape>(scene.shapes[0].shape).parts[1].shape, 2u);

    EXPECT_EQ(scene.springs[0].a, 1u);
    EXPECT_EQ(scene.springs[0].b, kNone);
    EXPECT_EQ(scene.attractors[0].strength, -4);
    EXPECT_EQ(scene.pairs[0].friction, 0.09);
    EXPECT_FALSE(scene.pairs[0].restitution.has_value());
    EXPECT_EQ(scene.instances[1].stride(), 16u);
}

TEST(SceneFile, ReadsALevelSetOnceForAllBodiesThatAreOfIt)
{
    const Scene scene = given::read_given(
        R"({"throng": 1, "shapes": {"hill": {"voxels": {"file": "hill.vdb"}}},
            "bodies": [{"shape": "hill", "motion": "static"}, {"shape": "hill", "motion": "static"}]})");
    const auto& voxels = std::get<VoxelsShape>(scene.shapes[0].shape);
    EXPECT_EQ(voxels.file, "hill.vdb");
    EXPECT_FALSE(voxels.level_set->whole);
    EXPECT_DOUBLE_EQ(voxels.level_set->field.voxel, 0.1);
    const Scene copy = scene;
    EXPECT_EQ(std::get<VoxelsShape>(copy.shapes[0].shape).level_set, voxels.level_set);
}

// The example of the format's description, as it is printed there.
constexpr const char* kExample = R"({
  "throng": 1,
  "gravity": [0, 0, -9.81],
  "settings": {"dt": "1/60", "substeps": 4},
  "materials": {"wood": {"density": 700, "friction": 0.5, "restitution": 0.1}},
  "shapes": {
    "ball":  {"sphere": {"radius": 0.5}},
    "crate": {"box": {"half_extents": [0.5, 0.4, 0.3]}},
    "pill":  {"capsule": {"radius": 0.25, "half_length": 0.6}},
    "can":   {"cylinder": {"radius": 0.3, "half_length": 0.5}},
    "stone": {"hull": {"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}},
    "floor": {"plane": {"normal": [0, 0, 1], "offset": 0}},
    "cow":   {"mesh": {"file": "spot.obj", "scale": 1.0}},
    "bin":   {"compound": [{"shape": "crate", "position": [0, 0, 0], "orientation": [1, 0, 0, 0]}]}
  },
  "bodies": [
    {"name": "ground", "shape": "floor", "motion": "static"},
    {"name": "b0", "shape": "crate", "material": "wood", "motion": "dynamic", "position": [0, 0, 2],
     "orientation": [1, 0, 0, 0], "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0],
     "mass": 12, "lock_rotation": false, "group": 1, "mask": 65535, "fast": false}
  ]
})";

TEST(SceneFile, ReadsTheExampleOfItsDescription)
{
    given::GivenFiles files = given::given_files();
    files.content["in/spot.obj"] = files.content["in/tri.obj"];
    const Scene scene = read_scene_text(kExample, "s.json", "in", files);
    EXPECT_EQ(scene.shapes.size(), 8u);
    EXPECT_EQ(scene.bodies.size(), 2u);
    EXPECT_EQ(scene.bodies[1].mask, 65535u);
    EXPECT_EQ(scene.settings.dt, 1.0 / 60);
    EXPECT_EQ(scene.materials[0], (Material{"wood", 700, 0.5, 0.1, 0}));
}

TEST(SceneFile, NamesTheFileAsItWasGiven)
{
    try {
        read_scene("no/such/scene.json");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "no/such/scene.json:1:1: error: scene: wanted a file that can be read (No such "
                  "file or directory)");
    }
}

}  // namespace
}  // namespace throng
