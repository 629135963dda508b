// Scene refusals: what a scene file is refused for, with which place and which words.
#include "tests/scene/files/scene_texts.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

// What goes round a part, so that the part alone is written down.
constexpr const char* kTop[] = {"{\"throng\": 1,\n ", "}"};
constexpr const char* kMaterial[] = {"{\"throng\": 1, \"materials\": {\"m\": {", "}}}"};
constexpr const char* kShape[] = {
    "{\"throng\": 1,\n\"shapes\": {\"box\": {\"box\": {\"half_extents\": "
    "[1, 1, 1]}},\n\"s\": {",
    "}}}"};
constexpr const char* kBody[] = {
    "{\"throng\": 1,\n\"materials\": {\"wood\": {}, \"gas\": {\"density\": 1e29}},\n\"shapes\": "
    "{\"box\": {\"box\": {\"half_extents\": [1, 1, 1]}}, \"floor\": {\"plane\": {\"normal\": "
    "[0, 0, 1]}}, \"tri\": {\"mesh\": {\"file\": \"tri.obj\"}}, \"ball\": {\"sphere\": "
    "{\"radius\": 1}}, \"pill\": {\"capsule\": {\"radius\": 1, \"half_length\": 1}}},\n"
    "\"bodies\": [{\"name\": \"first\", \"shape\": null, \"motion\": \"static\"},\n{",
    "}]}"};
constexpr const char* kMoving[] = {
    "{\"throng\": 1,\n\"bodies\": [{\"shape\": \"s\"}],\n\"shapes\": {\"s\": {", "}}}"};
constexpr const char* kGroup[] = {
    "{\"throng\": 1,\n\"shapes\": {\"box\": {\"box\": {\"half_extents\": [1, 1, 1]}}, \"floor\": "
    "{\"plane\": {\"normal\": [0, 0, 1]}}, \"ball\": {\"sphere\": {\"radius\": 1}}, \"pill\": "
    "{\"capsule\": {\"radius\": 1, \"half_length\": 1}}},\n\"instances\": [{",
    "}]}"};

/// `part` has an @ where the error's place is.
struct Bad {
    const char* const* round;
    std::string part;
    std::string expected;  // after the place
};

void expect_refused(const std::vector<Bad>& all)
{
    for (const Bad& bad : all) {
        std::string text = bad.round[0] + bad.part + bad.round[1];
        const std::size_t at = text.find('@');
        ASSERT_NE(at, text.npos) << text;
        text.erase(at, 1);
        std::size_t line = 1, column = 1;
        for (std::size_t i = 0; i < at; ++i) {
            column = text[i] == '\n' ? 1 : column + 1;
            line += text[i] == '\n' ? 1 : 0;
        }
        const std::string expected = "s.json:" + std::to_string(line) + ":" + std::to_string(column)
            + ": error: " + bad.expected;
        const std::string error = given::refusal_of(text);
        EXPECT_EQ(error.substr(0, expected.size()), expected) << bad.part << "\n  " << error;
        EXPECT_EQ(error.find('\n'), error.npos) << error;
    }
}

TEST(SceneFile, RefusesBadTops)
{
    expect_refused({
        {kTop, "@\"bodeis\": []", "bodeis: wanted a known key, not \"bodeis\"; perhaps bodies"},
        {kTop, "\"gravity\": @9.81", "gravity: wanted three numbers [x, y, z], not 9.81"},
        {kTop, "\"gravity\": @[0, 0]", "gravity: wanted three numbers [x, y, z], not a list of 2"},
        {kTop, "\"gravity\": [0, 0, @\"x\"]", "gravity[2]: wanted a number, not \"x\""},
        {kTop, "\"gravity\": [0, 0, @1e200]", "gravity[2]: wanted an acceleration in m/s2"},
        {kTop, "\"gravity\": [0, 0, @1e999]", "gravity[2]: wanted a number that a double can hold"},
        {kTop, "\"wind\": @null", "wind: wanted three numbers [x, y, z], not null"},
        {kTop, "\"bodies\": @{}", "bodies: wanted a list, not an object"},
        {kTop, "\"bodies\": [@7]", "bodies[0]: wanted an object, not 7"},
        {kTop, "\"shapes\": @[]", "shapes: wanted an object, not a list of 0"},
        {kTop, "\"materials\": @true", "materials: wanted an object, not true"},
        {kTop, "\"wind\": [0, 0, 0], @\"wind\": [1, 0, 0]", "wind: wanted each key once"},
        {kTop, "\"attractors\": [@{\"position\": [0, 0, 0]}]",
         "attractors[0].strength: wanted a strength"},
        {kTop, "\"attractors\": [{@\"strenght\": 1}]",
         "attractors[0].strenght: wanted a known key, not \"strenght\"; perhaps strength"},
        {kTop, "\"settings\": {@\"substep\": 4}",
         "settings.substep: wanted a known key, not \"substep\"; perhaps substeps"},
        {kTop, "\"settings\": {\"substeps\": @0}",
         "settings.substeps: wanted a whole number from 1 to 1000, not \"0\""},
        {kTop, "\"settings\": {\"substeps\": @true}",
         "settings.substeps: wanted a number or text, not true"},
        {kTop, "\"settings\": {\"dt\": @\"1/0\"}", "settings.dt: wanted a time from 1e-9 to 1e4 s"},
        {kTop, "\"settings\": {\"dt\": @-0.1}", "settings.dt: wanted a time from 1e-9 to 1e4 s"},
        {kTop, "\"settings\": {\"solver\": @\"exact\"}",
         "settings.solver: wanted soft_step, pgs or direct, not \"exact\""},
        {kTop, "\"settings\": {\"max_parts\": @0}",
         "settings.max_parts: wanted auto or a whole number from 1 to 256, not \"0\""},
    });
    EXPECT_EQ(given::refusal_of("{}"),
              "s.json:1:1: error: throng: wanted 1, the version of the format");
    EXPECT_EQ(given::refusal_of("{\"throng\": 2}"),
              "s.json:1:12: error: throng: wanted 1, the version of the format, not 2");
    EXPECT_EQ(given::refusal_of("{\"throng\": \"1\"}"),
              "s.json:1:12: error: throng: wanted 1, the version of the format, not \"1\"");
    EXPECT_EQ(given::refusal_of("[]"),
              "s.json:1:1: error: scene: wanted an object, not a list of 0");
    EXPECT_EQ(given::refusal_of("{\"throng\": 1}\n{}"),
              "s.json:2:1: error: scene: wanted nothing after the end, not \"{\"");
}

TEST(SceneFile, RefusesBadMaterials)
{
    expect_refused({
        {kMaterial, "\"density\": @0", "materials.m.density: wanted a density above 0 kg/m3"},
        {kMaterial, "\"density\": @-1",
         "materials.m.density: wanted a density above 0 kg/m3, not -1"},
        {kMaterial, "\"density\": @1e300",
         "materials.m.density: wanted a density above 0 kg/m3, of"},
        {kMaterial, "\"friction\": @-0.1", "materials.m.friction: wanted a friction of at least 0"},
        {kMaterial, "\"restitution\": @1.01",
         "materials.m.restitution: wanted a restitution from 0"},
        {kMaterial, "\"restitution\": @-0.01",
         "materials.m.restitution: wanted a restitution from"},
        {kMaterial, "\"rolling_friction\": @-1", "materials.m.rolling_friction: wanted a rolling"},
        {kMaterial, "@\"frction\": 1",
         "materials.m.frction: wanted a known key, not \"frction\"; perhaps friction"},
        {kMaterial, "\"friction\": @\"0.5\"", "materials.m.friction: wanted a number, not \"0.5\""},
        {kMaterial, "}, @\"\": {", "materials[\"\"]: wanted a name of at least one letter"},
        {kMaterial, "}, @\"m\": {", "materials.m: wanted each key once, not \"m\" again"},
        {kMaterial,
         "}}, \"pairs\": [{\"materials\": [\"m\", @\"n\"]}], \"shapes\": {\"b\": {\"sphere\": "
         "{\"radius\": 1}",
         "pairs[0].materials[1]: wanted the name of a material, not \"n\""},
        {kTop, "\"pairs\": [@{}]", "pairs[0].materials: wanted a list of two names of materials"},
        {kTop, "\"pairs\": [{\"materials\": @[\"a\"]}]",
         "pairs[0].materials: wanted a list of two"},
        {kTop,
         "\"materials\": {\"a\": {}}, \"pairs\": [{\"materials\": [\"a\", \"a\"]}, {\"materials\": "
         "@[\"a\", \"a\"]}]",
         "pairs[1].materials: wanted each pair of materials once"},
        {kTop,
         "\"materials\": {\"a\": {}}, \"pairs\": [{\"materials\": [\"a\", \"a\"], \"friction\": "
         "@-1}]",
         "pairs[0].friction: wanted a friction of at least 0, not -1"},
        {kTop,
         "\"materials\": {\"a\": {}}, \"pairs\": [{\"materials\": [\"a\", \"a\"], \"restitution\": "
         "@2}]",
         "pairs[0].restitution: wanted a restitution from 0 to 1, not 2"},
    });
}

TEST(SceneFile, RefusesBadShapes)
{
    const std::string part = "\"compound\": [{\"shape\": ";
    expect_refused({
        {kTop, "\"shapes\": {\"s\": @{}}",
         "shapes.s: wanted one kind of shape, one of sphere, capsule"},
        {kTop, "\"shapes\": {\"s\": @{\"sphere\": {\"radius\": 1}, \"box\": {}}}",
         "shapes.s: wanted one kind of shape"},
        {kShape, "@\"shpere\": {\"radius\": 1}",
         "shapes.s.shpere: wanted a known key, not \"shpere\"; perhaps sphere"},
        {kShape, "\"sphere\": @{}", "shapes.s.sphere.radius: wanted a length in m"},
        {kShape, "\"sphere\": {\"radius\": @0}",
         "shapes.s.sphere.radius: wanted a length above 0 m"},
        {kShape, "\"sphere\": {\"radius\": @-1}",
         "shapes.s.sphere.radius: wanted a length above 0 m, not -1"},
        {kShape, "\"sphere\": {\"radius\": @1e300}",
         "shapes.s.sphere.radius: wanted a length above 0 m, of a size that a step can hold, not "
         "1e+300"},
        {kShape, "\"sphere\": {\"radius\": @1e-300}",
         "shapes.s.sphere.radius: wanted a length above 0 m, of a size"},
        {kShape, "\"sphere\": {\"radius\": @null}",
         "shapes.s.sphere.radius: wanted a number, not null"},
        {kShape, "\"sphere\": {\"radius\": 1, @\"r\": 1}", "shapes.s.sphere.r: wanted a known key"},
        {kShape, "\"capsule\": {\"radius\": 1, \"half_length\": @0}",
         "shapes.s.capsule.half_length: wanted a length above 0 m, not 0"},
        {kShape, "\"capsule\": @{\"radius\": 1}",
         "shapes.s.capsule.half_length: wanted a length in m"},
        {kShape, "\"cylinder\": {\"radius\": @-0, \"half_length\": 1}",
         "shapes.s.cylinder.radius: wanted a length above 0 m"},
        {kShape, "\"box\": {\"half_extents\": [1, @0, 1]}",
         "shapes.s.box.half_extents[1]: wanted a length above 0 m, not 0"},
        {kShape, "\"box\": {\"half_extents\": @[1, 1]}",
         "shapes.s.box.half_extents: wanted three numbers"},
        {kShape, "\"hull\": @{}", "shapes.s.hull.points: wanted a list of points"},
        {kShape, "\"hull\": {\"points\": @[]}", "shapes.s.hull.points: wanted a hull; "},
        {kShape, "\"hull\": {\"points\": @[[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0.5,0.5,0]]}",
         "shapes.s.hull.points: wanted a hull; "},
        {kShape, "\"hull\": {\"points\": @[[0,0,0],[0,0,0],[0,0,0],[0,0,0]]}",
         "shapes.s.hull.points: wanted a hull; "},
        {kShape, "\"hull\": {\"points\": [@[0,0],[1,0,0]]}",
         "shapes.s.hull.points[0]: wanted three numbers [x, y, z], not a list of 2"},
        {kShape, "\"hull\": {\"points\": [[0,@1e300,0],[1,0,0]]}",
         "shapes.s.hull.points[0][1]: wanted a place in m"},
        {kShape, "\"plane\": @{}", "shapes.s.plane.normal: wanted a direction [x, y, z]"},
        {kShape, "\"plane\": {\"normal\": @[0, 0, 0]}",
         "shapes.s.plane.normal: wanted a direction of unit length"},
        {kShape, "\"plane\": {\"normal\": @[0, 0, 1.00001]}",
         "shapes.s.plane.normal: wanted a direction of unit length"},
        {kShape, "\"mesh\": @{}", "shapes.s.mesh.file: wanted the name of an OBJ or STL file"},
        {kShape, "\"mesh\": {\"file\": @7}", "shapes.s.mesh.file: wanted text, not 7"},
        {kShape, "\"mesh\": {\"file\": @\"\"}", "shapes.s.mesh.file: wanted the name of a file"},
        {kShape, "\"mesh\": {\"file\": @\"a\\u0000b\"}",
         "shapes.s.mesh.file: wanted the name of a file"},
        {kShape, "\"mesh\": {\"file\": @\"none.obj\"}",
         "shapes.s.mesh.file: wanted a file that can be read, not \"none.obj\" (no such file)"},
        {kShape, "\"mesh\": {\"file\": @\"empty.obj\"}",
         "shapes.s.mesh.file: wanted a mesh with triangles, not an empty one"},
        {kShape, "\"mesh\": {\"file\": @\"huge.obj\"}",
         "shapes.s.mesh.file: wanted vertices of a size that a step can hold"},
        {kShape, "\"mesh\": {\"file\": \"tri.obj\", \"scale\": @0}",
         "shapes.s.mesh.scale: wanted a factor above 0, not 0"},
        {kShape, "\"mesh\": {\"file\": \"tri.obj\", \"nonconvex\": @\"part\"}",
         "shapes.s.mesh.nonconvex: wanted voxels, parts, spheres, depth_image or hull, not "
         "\"part\""},
        {kShape, "\"mesh\": {\"file\": \"tri.obj\", \"voxel_size\": @0}",
         "shapes.s.mesh.voxel_size: wanted auto or a length from 1e-9 to 1e9 m, not \"0\""},
        {kShape, "\"mesh\": {\"file\": \"tri.obj\", \"max_parts\": @257}",
         "shapes.s.mesh.max_parts: wanted auto or a whole number from 1 to 256, not \"257\""},
        {kMoving, "\"mesh\": {\"file\": @\"tri.obj\"}",
         "shapes.s.mesh.file: wanted a mesh that encloses a volume, for a body that moves"},
        {kShape, "\"voxels\": @{}", "shapes.s.voxels.file: wanted the name of a .vdb file"},
        {kShape, "\"voxels\": {\"file\": @3}", "shapes.s.voxels.file: wanted text, not 3"},
        {kShape, "\"voxels\": {\"file\": @\"\"}",
         "shapes.s.voxels.file: wanted the name of a file, not \"\""},
        {kShape, "\"voxels\": {\"file\": \"hill.vdb\", @\"scale\": 2}",
         "shapes.s.voxels.scale: wanted a known key, not \"scale\""},
        {kShape, "\"voxels\": {\"file\": @\"x.vdb\"}",
         "shapes.s.voxels.file: wanted a file that can be read, not \"x.vdb\" (no such file)"},
        {kShape, "\"voxels\": {\"file\": @\"tri.obj\"}",
         "shapes.s.voxels.file: wanted a level set; \"tri.obj\" is no .vdb file that can be read"},
        {kShape, "\"voxels\": {\"file\": @\"torn.vdb\"}",
         "shapes.s.voxels.file: wanted a level set; \"torn.vdb\" is no .vdb file that can be read"},
        {kMoving, "\"voxels\": {\"file\": @\"hill.vdb\"}",
         "shapes.s.voxels.file: wanted a level set whose surface is closed, for a body that moves"},
        {kShape, "\"compound\": @[]", "shapes.s.compound: wanted at least one part"},
        {kShape, "\"compound\": @{}", "shapes.s.compound: wanted a list, not an object"},
        {kShape, "\"compound\": [@{}]", "shapes.s.compound[0].shape: wanted the name of a shape"},
        {kShape, part + "@\"bx\"}]",
         "shapes.s.compound[0].shape: wanted the name of a shape, not \"bx\"; perhaps box"},
        {kShape, part + "@\"s\"}]",
         "shapes.s.compound[0].shape: wanted a sphere, capsule, cylinder, box or hull as part of a "
         "compound"},
        {kShape, part + "@\"t\"}]}, \"t\": {" + part + "\"s\"}]",
         "shapes.s.compound[0].shape: wanted a sphere, capsule"},
        {kShape, part + "@\"p\"}]}, \"p\": {\"plane\": {\"normal\": [0, 0, 1]}",
         "shapes.s.compound[0].shape: wanted a sphere, capsule"},
        {kShape, part + "@\"m\"}]}, \"m\": {\"mesh\": {\"file\": \"tri.obj\"}",
         "shapes.s.compound[0].shape: wanted a sphere, capsule"},
        {kShape, part + "\"box\", \"orientation\": @[0, 0, 0, 0]}]",
         "shapes.s.compound[0].orientation: wanted a quaternion [w, x, y, z] of unit length, not "
         "of length 0"},
        {kShape, part + "\"box\", @\"pos\": [0, 0, 0]}]",
         "shapes.s.compound[0].pos: wanted a known key, not \"pos\"; perhaps position"},
        {kShape, "\"sphere\": {\"radius\": 1}}, @\"box\": {\"sphere\": {\"radius\": 1}",
         "shapes.box: wanted each key once"},
    });
    EXPECT_EQ(given::refusal_of(
                  "{\"throng\": 1, \"shapes\": {\"s\": {\"mesh\": {\"file\": \"bad.obj\"}}}}"),
              "bad.obj:2:7: error: f: wanted one of the 1 vertices");
}

TEST(SceneFile, RefusesBadBodies)
{
    const std::string box = "\"shape\": \"box\", ";
    const std::string none = "\"shape\": null, ";
    expect_refused({
        {kTop, "\"bodies\": [@{}]", "bodies[0].shape: wanted the name of a shape, or null"},
        {kBody, "\"shape\": @\"bxo\"",
         "bodies[1].shape: wanted the name of a shape, not \"bxo\"; perhaps box"},
        {kBody, "\"shape\": @3", "bodies[1].shape: wanted the name of a shape, or null, not 3"},
        {kBody, box + "\"material\": @\"wod\"",
         "bodies[1].material: wanted the name of a material, not \"wod\"; perhaps wood"},
        {kBody, box + "\"motion\": @\"Static\"",
         "bodies[1].motion: wanted static, kinematic or dynamic, not \"Static\""},
        {kBody, box + "\"motion\": @1",
         "bodies[1].motion: wanted static, kinematic or dynamic, not 1"},
        {kBody, box + "@\"postion\": [0, 0, 0]",
         "bodies[1].postion: wanted a known key, not \"postion\"; perhaps position or motion"},
        {kBody, box + "@\"zzz\": 0", "bodies[1].zzz: wanted a known key, not \"zzz\""},
        {kBody, box + "\"name\": @\"first\"",
         "bodies[1].name: wanted a name of its own, not \"first\" again"},
        {kBody, box + "\"name\": @1", "bodies[1].name: wanted text, not 1"},
        {kBody, box + "\"position\": [0, @1e300, 0]", "bodies[1].position[1]: wanted a place in m"},
        {kBody, box + "\"orientation\": @[0, 0, 0, 0]",
         "bodies[1].orientation: wanted a quaternion [w, x, y, z] of unit length, not of length 0"},
        {kBody, box + "\"orientation\": @[1.0001, 0, 0, 0]",
         "bodies[1].orientation: wanted a quaternion"},
        {kBody, box + "\"orientation\": @[1, 0, 0]",
         "bodies[1].orientation: wanted a quaternion [w, x, y, z], not a list of 3"},
        {kBody, box + "\"orientation\": @[1e200, 1e200, 0, 0]",
         "bodies[1].orientation: wanted a quaternion"},
        {kBody, box + "\"velocity\": [@\"fast\", 0, 0]",
         "bodies[1].velocity[0]: wanted a number, not \"fast\""},
        {kBody, box + "\"motion\": \"static\", \"velocity\": @[1, 0, 0]",
         "bodies[1].velocity: wanted [0, 0, 0] for a body that never moves"},
        {kBody, box + "\"motion\": \"static\", \"angular_velocity\": @[1, 0, 0]",
         "bodies[1].angular_velocity: wanted [0, 0, 0] for a body that never turns"},
        {kBody, box + "\"lock_rotation\": true, \"angular_velocity\": @[1, 0, 0]",
         "bodies[1].angular_velocity: wanted [0, 0, 0] for a body that never turns"},
        {kBody, box + "\"lock_position\": true, \"velocity\": @[1, 0, 0]",
         "bodies[1].velocity: wanted [0, 0, 0] for a body that never moves"},
        {kBody, box + "\"mass\": @0", "bodies[1].mass: wanted a mass above 0 kg, not 0"},
        {kBody, box + "\"mass\": @-3", "bodies[1].mass: wanted a mass above 0 kg, not -3"},
        {kBody, box + "\"mass\": @1e308",
         "bodies[1].mass: wanted a mass above 0 kg, of a size that a step can hold"},
        {kBody, box + "\"mass\": @\"12\"", "bodies[1].mass: wanted a number, not \"12\""},
        {kBody, box + "\"mass\": 1, @\"mass\": 2",
         "bodies[1].mass: wanted each key once, not \"mass\" again"},
        {kBody, box + "\"lock_rotation\": @1",
         "bodies[1].lock_rotation: wanted true or false, not 1"},
        {kBody, box + "\"fast\": @null", "bodies[1].fast: wanted true or false, not null"},
        {kBody, box + "\"group\": @-1",
         "bodies[1].group: wanted a whole number from 0 to 4294967295, not -1"},
        {kBody, box + "\"mask\": @4294967296",
         "bodies[1].mask: wanted a whole number from 0 to 4294967295, not 4294967296"},
        {kBody, box + "\"mask\": @1.5", "bodies[1].mask: wanted a whole number"},
        {kBody, "\"shape\": \"floor\", \"motion\": @\"dynamic\"",
         "bodies[1].motion: wanted static or kinematic for a plane"},
        {kBody, box + "\"inertia\": @[1, 1, 1]",
         "bodies[1].inertia: wanted six numbers [xx, yy, zz, xy, xz, yz], not a list of 3"},
        {kBody, box + "\"inertia\": @[1, 1, -1, 0, 0, 0]",
         "bodies[1].inertia: wanted three principal moments above 0 kg m2"},
        {kBody, box + "\"inertia\": @[1, 1, 1, 2, 0, 0]",
         "bodies[1].inertia: wanted three principal moments above 0 kg m2"},
        {kBody, box + "\"inertia\": @[1, 1, 3, 0, 0, 0]",
         "bodies[1].inertia: wanted principal moments none of which"},
        {kBody, box + "\"inertia\": @[1e300, 1e300, 1e300, 0, 0, 0]",
         "bodies[1].inertia: wanted moments of a size that a step can hold"},
        {kBody, box + "\"center\": @0", "bodies[1].center: wanted three numbers [x, y, z], not 0"},
        {kBody, box + "\"force\": [0, 0, @1e200]", "bodies[1].force[2]: wanted a force in N"},
        {kBody, box + "\"motion\": \"kinematic\", \"force\": @[0, 0, 1]",
         "bodies[1].force: wanted a body of motion dynamic for this"},
        {kBody, box + "\"motion\": \"static\", \"torque\": @[0, 0, 1]",
         "bodies[1].torque: wanted a body of motion dynamic for this"},
        {kBody, box + "\"motion\": \"static\", \"pivot\": @[0, 0, 1]",
         "bodies[1].pivot: wanted a body of motion dynamic for this"},
        {kBody, box + "\"lock_position\": true, \"pivot\": @[0, 0, 1]",
         "bodies[1].pivot: wanted either pivot or lock_position, not both"},
        {kBody, box + "\"lock_position\": true, \"drive_velocity\": @[1, null, null]",
         "bodies[1].drive_velocity: wanted no drive_velocity with lock_position"},
        {kBody, box + "\"drive_velocity\": @[1, null]",
         "bodies[1].drive_velocity: wanted three numbers or nulls [x, y, z], not a list of 2"},
        {kBody, box + "\"drive_velocity\": [1, @true, 1]",
         "bodies[1].drive_velocity[1]: wanted a number or null, not true"},
        {kBody, box + "\"drag\": @1", "bodies[1].drag: wanted an object, not 1"},
        {kBody, box + "\"drag\": {\"linear\": @-1}",
         "bodies[1].drag.linear: wanted a drag of at least 0 kg/s, not -1"},
        {kBody, box + "\"drag\": {@\"lin\": 1}",
         "bodies[1].drag.lin: wanted a known key, not \"lin\"; perhaps linear"},
        {kTop, "\"bodies\": [@{\"shape\": null}]",
         "bodies[0].mass: wanted a mass for a body without a shape"},
        {kTop, "\"bodies\": [@{\"shape\": null, \"mass\": 1}]",
         "bodies[0].inertia: wanted an inertia (or lock_rotation) for a body without a shape"},
        {kTop,
         "\"materials\": {\"gas\": {\"density\": 1e29}}, \"shapes\": {\"box\": {\"box\": "
         "{\"half_extents\": [1e6, 1, 1]}}}, \"bodies\": [@{\"shape\": \"box\", \"material\": "
         "\"gas\"}]",
         "bodies[0].mass: wanted a mass that a step can hold; density and shape give"},
        {kTop,
         "\"shapes\": {\"box\": {\"sphere\": {\"radius\": 1e-12}}}, \"bodies\": [@{\"shape\": "
         "\"box\"}]",
         "bodies[0].mass: wanted a mass that a step can hold"},
    });
}

TEST(SceneFile, RefusesBadInstances)
{
    const std::string box = "\"shape\": \"box\", \"count\": 10, \"file\": @";
    const std::string sizes = "\"count\": 1, \"sizes\": \"file\", \"file\": @";
    expect_refused({
        {kGroup, "\"shape\": \"box\", \"count\": 10, @\"position\": [0, 0, 0]",
         "instances[0].position: wanted a known key, not \"position\""},
        {kTop, "\"instances\": [@{\"shape\": null, \"motion\": \"static\"}]",
         "instances[0].file: wanted the name of a file of records"},
        {kGroup, "\"shape\": \"box\", \"count\": @-1, \"file\": \"ten.bin\"",
         "instances[0].count: wanted a whole number from 0 to 4294967294, not -1"},
        {kGroup, "\"shape\": \"box\", \"count\": @1e10, \"file\": \"ten.bin\"",
         "instances[0].count: wanted a whole number from 0 to 4294967294"},
        {kGroup, "\"shape\": \"box\", \"count\": 11, \"file\": @\"ten.bin\"",
         "instances[0].file: wanted 1144 bytes, 11 records of 104 bytes, not 1040 bytes in "
         "\"ten.bin\""},
        {kGroup, "\"shape\": \"box\", \"file\": @\"short.bin\"",
         "instances[0].file: wanted whole records of 104 bytes, not 1039 bytes"},
        {kGroup, box + "\"short.bin\"", "instances[0].file: wanted 1040 bytes"},
        {kGroup, box + "\"long.bin\"", "instances[0].file: wanted 1040 bytes"},
        {kGroup, box + "\"none.bin\"",
         "instances[0].file: wanted a file that can be read, not \"none.bin\""},
        {kGroup, box + "\"nan.bin\"",
         "instances[0].file: nan.bin: record 7: wanted finite numbers"},
        {kGroup, box + "\"turn.bin\"",
         "instances[0].file: turn.bin: record 3: wanted a quaternion [w, x, y, z] of unit length"},
        {kGroup, "\"motion\": \"static\", " + box + "\"fast.bin\"",
         "instances[0].file: fast.bin: record 9: wanted velocity 0"},
        {kGroup, "\"lock_rotation\": true, " + box + "\"spin.bin\"",
         "instances[0].file: spin.bin: record 9: wanted angular velocity 0"},
        {kGroup, "\"shape\": \"box\", \"file\": \"box.bin\", \"sizes\": @\"own\"",
         "instances[0].sizes: wanted \"file\", not \"own\""},
        {kGroup,
         "\"motion\": \"static\", \"shape\": \"floor\", \"file\": \"box.bin\", \"sizes\": "
         "@\"file\"",
         "instances[0].sizes: wanted a sphere, capsule, cylinder or box to size"},
        {kGroup, "\"shape\": \"box\", " + sizes + "\"flat.bin\"",
         "instances[0].file: flat.bin: record 0: wanted a size of three half extents above 0"},
        {kGroup, "\"shape\": \"ball\", " + sizes + "\"ball2.bin\"",
         "instances[0].file: ball2.bin: record 0: wanted a size of radius above 0, 0, 0"},
        {kGroup, "\"shape\": \"pill\", " + sizes + "\"pill2.bin\"",
         "instances[0].file: pill2.bin: record 0: wanted a size of radius and half length"},
        {kGroup, "\"shape\": \"box\", " + sizes + "\"giant.bin\"",
         "instances[0].file: giant.bin: record 0: wanted a mass that a step can hold"},
        {kGroup, "\"mass\": @-1, \"shape\": \"box\", \"file\": \"ten.bin\"",
         "instances[0].mass: wanted a mass above 0 kg, not -1"},
    });
}

TEST(SceneFile, RefusesBadSprings)
{
    const std::string bodies =
        "\"bodies\": [{\"name\": \"p\", \"shape\": null, \"motion\": \"static\"}, {\"name\": "
        "\"q\", \"shape\": null, \"motion\": \"static\"}],\n\"springs\": [";
    expect_refused({
        {kTop, bodies + "@{}]", "springs[0].a: wanted the name of a body, or null for the world"},
        {kTop, bodies + "@{\"a\": \"p\", \"b\": \"q\"}]",
         "springs[0].stiffness: wanted a stiffness in N/m"},
        {kTop, bodies + "{\"a\": \"p\", \"b\": @\"body\", \"stiffness\": 1}]",
         "springs[0].b: wanted the name of a body, not \"body\"; known: p or q"},
        {kTop, bodies + "{\"a\": \"p\", \"b\": @0, \"stiffness\": 1}]",
         "springs[0].b: wanted the name of a body, or null for the world, not 0"},
        {kTop, bodies + "{\"a\": null, \"b\": @null, \"stiffness\": 1}]",
         "springs[0].b: wanted another end than a"},
        {kTop, bodies + "{\"a\": \"p\", \"b\": @\"p\", \"stiffness\": 1}]",
         "springs[0].b: wanted another end than a"},
        {kTop, bodies + "{\"a\": \"p\", \"b\": null, \"stiffness\": @-1}]",
         "springs[0].stiffness: wanted a stiffness of at least 0 N/m, not -1"},
        {kTop, bodies + "{\"a\": \"p\", \"b\": null, \"stiffness\": 1, \"length\": @-1}]",
         "springs[0].length: wanted a length of at least 0 m, not -1"},
        {kTop, bodies + "{\"a\": \"p\", \"b\": null, \"stiffness\": 1, \"damping\": @-1}]",
         "springs[0].damping: wanted a damping of at least 0 N s/m, not -1"},
    });
}

}  // namespace
}  // namespace throng
