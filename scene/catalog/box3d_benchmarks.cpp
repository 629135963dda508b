// Box3D's benchmarks: the scenes that Box3D times itself by, at its sizes unless another is asked
// for. Its y is up where here z is.
//
// Source: Catto, Box3D (2026), shared/benchmarks.c.
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"
#include "scene/catalog/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {

namespace {

// As Box3D's bodies have it where nothing else is said.
Scene begin_box3d(std::string_view name, int size)
{
    Scene scene = begin_scene(name, size);
    scene.materials[0].friction = 0.6;
    return scene;
}

// Cubes in a pyramid one cube thick, the middle of its lowest row at x = 0.
void add_flat_pyramid(Instances& cubes, int base, const Vec3& middle)
{
    for (int row = 0; row < base; ++row)
        for (int i = 0; i < base - row; ++i)
            add_record(cubes,
                       {middle + Vec3(i - (base - row - 1) / 2.0, 0, 0.5 + row), Quat::Identity()});
}

// A prism of so many corners that stands on z = 0 of its frame.
HullShape prism(int sides, double radius, double height, const Vec3& foot)
{
    HullShape hull;
    for (int i = 0; i < sides; ++i) {
        const Vec3 corner =
            turn(Vec3::UnitZ(), 2 * std::numbers::pi * i / sides) * Vec3(radius, 0, 0);
        hull.points.emplace_back(foot + corner);
        hull.points.emplace_back(foot + corner + Vec3(0, 0, height));
    }
    return hull;
}

// A piece of a ring about y between two angles.
HullShape ring_piece(double inner, double outer, double half_width, double from, double to)
{
    HullShape hull;
    for (const double angle : {from, to})
        for (const double radius : {inner, outer})
            for (const double y : {-half_width, half_width})
                hull.points.push_back(turn(Vec3::UnitY(), angle) * Vec3(radius, y, 0));
    return hull;
}

// Ten corners spread evenly over a ball, each a golden angle further round.
HullShape rock(double radius)
{
    constexpr int kCorners = 10;
    HullShape hull;
    for (int i = 0; i < kCorners; ++i) {
        const double z = 1 - (2 * i + 1.0) / kCorners;
        const double angle = 2 * std::numbers::pi * i / std::numbers::phi;
        hull.points.emplace_back(radius
                                 * (turn(Vec3::UnitZ(), angle) * Vec3(std::sqrt(1 - z * z), 0, z)));
    }
    return hull;
}

}  // namespace

// Cubes of 1 m in one pyramid that is one cube thick, of whole rows, as near to the size as is not
// above it: Box3D's 5,050 are a hundred rows.
Scene make_large_pyramid(int size, std::uint64_t /*seed*/)
{
    int base = 1;
    while ((base + 1) * (base + 2.0) / 2 <= size) ++base;
    Scene scene = begin_box3d("large_pyramid", size);
    scene.materials[0].density = 100;
    const double half = std::max(400.0, 4.0 * base);
    add_static_box(scene, "floor", {0, 0, -1}, {half, half, 1});
    const std::uint32_t cube = add_shape(scene, "cube", BoxShape{Vec3::Constant(0.5)});
    const auto count = static_cast<std::size_t>(base) * static_cast<std::size_t>(base + 1) / 2;
    add_flat_pyramid(add_instances(scene, cube, count, false), base, Vec3::Zero());
    return scene;
}

// Pyramids of 55 cubes, each one cube thick, side by side in a square: Box3D's 10,780 cubes are 14
// by 14 of them.
Scene make_many_pyramids(int size, std::uint64_t /*seed*/)
{
    constexpr int kBase = 10, kCubes = kBase * (kBase + 1) / 2;
    const int pyramids = std::max(1, size / kCubes);
    const int side = static_cast<int>(std::ceil(std::sqrt(pyramids)));
    const double pitch = kBase + 1;
    Scene scene = begin_box3d("many_pyramids", size);
    scene.materials[0].density = 100;
    const double half = pitch * side / 2;
    add_static_box(scene, "floor", {0, 0, -1}, {half, half, 1});
    const std::uint32_t cube = add_shape(scene, "cube", BoxShape{Vec3::Constant(0.5)});
    Instances& cubes =
        add_instances(scene, cube, static_cast<std::size_t>(pyramids * kCubes), false);
    for (int i = 0; i < pyramids; ++i) {
        const Vec3 middle((i % side - (side - 1) / 2.0) * pitch,
                          (i / side - (side - 1) / 2.0) * pitch, 0);
        add_flat_pyramid(cubes, kBase, middle);
    }
    return scene;
}

// Cubes of 0.4 m in a ring with four paddles that turns about a level axis, 25 degrees a second; it
// is open at both ends, and a floor is below. Wide enough for the cubes: Box3D's 8,000 are in one
// of 14 m.
Scene make_washer(int size, std::uint64_t /*seed*/)
{
    const int side = static_cast<int>(std::ceil(std::cbrt(size)));
    const double scale = std::max(1, side) / 20.0, half_width = 10 * scale, height = 21 * scale;
    Scene scene = begin_box3d("washer", size);
    add_static_box(scene, "floor", {0, 0, -1}, {60 * scale, 60 * scale, 1});

    constexpr int kPieces = 36, kPaddles = 4;
    const double piece = 2 * std::numbers::pi / kPieces, lap = piece / 10;
    CompoundShape ring;
    const auto add_piece = [&](std::string_view name, const HullShape& hull) {
        ring.parts.push_back({add_shape(scene, name, hull), {}});
    };
    for (int i = 0; i < kPieces; ++i) {
        const double from = i * piece, to = from + piece;
        const std::string number = std::to_string(i);
        add_piece("ring " + number,
                  ring_piece(16 * scale, 18 * scale, half_width, from - lap, to + lap));
        if (i % (kPieces / kPaddles) == 0)
            add_piece("paddle " + number, ring_piece(14 * scale, 16 * scale, half_width, from, to));
    }
    BodyDescription drum;
    drum.name = "drum";
    drum.shape = add_shape(scene, "drum", std::move(ring));
    drum.material = 0;
    drum.motion = Motion::kinematic;
    drum.position = {0, 0, height};
    drum.center = Vec3::Zero();
    drum.angular_velocity = {0, std::numbers::pi / 180 * 25, 0};
    scene.bodies.push_back(std::move(drum));

    constexpr double kHalf = 0.2, kPitch = 4 * kHalf;
    const std::uint32_t cube = add_shape(scene, "cube", BoxShape{Vec3::Constant(kHalf)});
    Instances& cubes = add_instances(scene, cube, static_cast<std::size_t>(size), false);
    for (int i = 0; i < size; ++i) {
        const Vec3 cell(i / (side * side), i % side, i / side % side);
        const Vec3 from_middle = cell - Vec3::Constant((side - 1) / 2.0);
        add_record(cubes, {Vec3(0, 0, height) + kPitch * from_middle, Quat::Identity()});
    }
    return scene;
}

// Stones of ten corners and 3 m dropped into a yard of 100 m, 441 to a layer, in which a pillar
// goes round, 6 degrees a second: Box3D's 10,584 are 24 layers.
Scene make_junkyard(int size, std::uint64_t /*seed*/)
{
    constexpr int kSide = 21;
    Scene scene = begin_box3d("junkyard", size);
    add_static_box(scene, "floor", {0, 0, -1}, {120, 120, 1});
    for (const double sign : {-1.0, 1.0}) {
        const std::string which = sign < 0 ? " -" : " +";
        add_static_box(scene, "wall x" + which, {50 * sign, 0, 8}, {1, 51, 8});
        add_static_box(scene, "wall y" + which, {0, 50 * sign, 8}, {49, 1, 8});
    }

    BodyDescription pillar;
    pillar.name = "pillar";
    pillar.shape = add_shape(scene, "pillar", prism(16, 4, 24, {35, 0, 0}));
    pillar.material = 0;
    pillar.motion = Motion::kinematic;
    pillar.center = Vec3::Zero();
    pillar.angular_velocity = {0, 0, std::numbers::pi / 180 * 6};
    scene.bodies.push_back(std::move(pillar));

    const std::uint32_t stone = add_shape(scene, "stone", rock(1.5));
    Instances& stones = add_instances(scene, stone, static_cast<std::size_t>(size), false);
    for (int i = 0; i < size; ++i) {
        const Vec3 cell(i / kSide % kSide, i % kSide, i / (kSide * kSide));
        add_record(stones, {4 * cell + Vec3(-40, -40, 25), Quat::Identity()});
    }
    return scene;
}

// Trees of 22 prisms each, 57 m high, that fall one way and the other onto waves of triangles of
// 1 m, three meters apart: Box3D's trees100 has 50 of them.
Scene make_trees(int size, std::uint64_t /*seed*/)
{
    constexpr int kPrisms = 22, kAcross = 150;
    Scene scene = begin_box3d("trees", size);
    scene.materials[0].friction = 0.9;
    scene.materials[0].rolling_friction = 0.05;
    scene.materials[0].density = 1;
    const int along = 3 * size + 50;
    const auto wave = [](double cycles) {
        return (turn(Vec3::UnitZ(), 2 * std::numbers::pi * cycles) * Vec3::UnitX()).y();
    };
    TriangleSoup ground = sheet_mesh(kAcross, along, [&](int x, int y) {
        return Vec3(x - kAcross / 2.0, y - along / 2.0, 0.4 * wave(0.1 * x) * wave(0.05 * y));
    });
    BodyDescription waves;
    waves.name = "waves";
    waves.shape = add_shape(scene, "waves", mesh_shape(std::move(ground)));
    waves.material = 0;
    waves.motion = Motion::static_;
    scene.bodies.push_back(std::move(waves));

    CompoundShape trunk;
    double radius = 0.75, foot = 1, weight = 0, moment = 0;
    constexpr double kLength = 1.5;
    for (int i = 0; i < kPrisms; ++i) {
        const double height = kLength + 2 * radius, volume = radius * radius * height;
        const std::uint32_t part = add_shape(scene, "prism " + std::to_string(i),
                                             prism(6, radius, height, {0, 0, foot - radius}));
        trunk.parts.push_back({part, {}});
        weight += volume;
        moment += volume * (foot - radius + height / 2);
        foot += height;
        radius *= 0.95;
    }
    const std::uint32_t tree = add_shape(scene, "tree", std::move(trunk));
    Instances& trees = add_instances(scene, tree, static_cast<std::size_t>(size), false);
    for (int i = 0; i < size; ++i) {
        const double rate = (i % 2 == 0 ? 0.5 : -0.5) * (0.5 + 0.5 * i / size);
        const Vec3 spin(0, rate, 0), center(0, 0, moment / weight);
        add_record(trees, {{0, 3.0 * i - 1.5 * (size - 1), 0.2}, Quat::Identity()},
                   spin.cross(center), spin);
    }
    return scene;
}

// Static slabs of 10 m side by side, and a hundred balls that fall on them: Box3D's 1,000,000 are
// 10 km wide. There the balls come one after the other, here they fall at once.
Scene make_large_world(int size, std::uint64_t /*seed*/)
{
    const int side = static_cast<int>(std::ceil(std::sqrt(size))), balls_aside = std::min(10, side);
    constexpr double kCell = 10;
    Scene scene = begin_box3d("large_world", size);
    const std::uint32_t slab = add_shape(scene, "slab", BoxShape{{kCell / 2, kCell / 2, 0.25}});
    Instances& slabs = add_instances(scene, slab, static_cast<std::size_t>(size), false);
    slabs.common.motion = Motion::static_;
    for (int i = 0; i < size; ++i)
        add_record(
            slabs,
            {{(i % side - (side - 1) / 2.0) * kCell, (i / side - (side - 1) / 2.0) * kCell, 0},
             Quat::Identity()});
    const std::uint32_t ball = add_shape(scene, "ball", SphereShape{0.5});
    const int count = balls_aside * balls_aside;
    Instances& balls = add_instances(scene, ball, static_cast<std::size_t>(count), false);
    const double pitch = 0.8 * side * kCell / balls_aside;
    for (int i = 0; i < count; ++i)
        add_record(balls,
                   {{(i % balls_aside - (balls_aside - 1) / 2.0) * pitch,
                     (i / balls_aside - (balls_aside - 1) / 2.0) * pitch, 1.5},
                    Quat::Identity()});
    return scene;
}

}  // namespace throng
