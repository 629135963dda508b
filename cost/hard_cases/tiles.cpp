// Floors of tiles: H81.
//
// Answers: a smooth floor takes no speed, whatever it is laid of; with friction a box slides
// v^2 / (2 mu g), as on one piece. A tile that stands out is a step: it is met.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr double kSpeed = 8;
const Vec3 kTile(0.5, 0.5, 0.25);  // half extents

enum class Floor { boxes, hulls, meshes, compound };
enum class Slider { ball, box, voxels, depth_image };  // the last two: the box as a mesh

const char* name_of(Slider slider)
{
    constexpr const char* kNames[] = {"ball", "box", "box of voxels", "box by depth_image"};
    return kNames[static_cast<int>(slider)];
}

// How a floor is laid, and where.
struct Laid {
    Floor of = Floor::boxes;
    double separation = 0,
           step = 0;  // m, between tiles; that those from the fourth on stand higher by
    Pose at = {};
    bool backwards = false;  // the slider is made first, and the far tiles before the near ones
};

HullShape tile_hull()
{
    HullShape hull;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0})
                hull.points.emplace_back(kTile.cwiseProduct(Vec3(x, y, z)));
    return hull;
}

// Its top alone.
MeshShape tile_mesh()
{
    MeshShape mesh;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        mesh.vertices.emplace_back(kTile.cwiseProduct(Vec3(x, y, 1)));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

std::vector<Pose> places_of(const Laid& laid, int tiles)
{
    std::vector<Pose> places;
    for (int i = -2; i < tiles; ++i)
        for (int j = -1; j <= 1; ++j) {
            Pose place;
            const double high = i < 4 ? 0 : laid.step;
            place.position =
                Vec3(i * (1 + laid.separation), j * (1 + laid.separation), high - kTile.z());
            places.push_back(place);
        }
    if (laid.backwards) std::reverse(places.begin(), places.end());
    return places;
}

void lay_floor(Scene& scene, const Laid& laid, int tiles)
{
    const auto shape = [&](auto kind) {
        scene.shapes.push_back({"tile" + std::to_string(scene.shapes.size()), std::move(kind)});
        return static_cast<std::uint32_t>(scene.shapes.size() - 1);
    };
    BodyDescription body;
    body.motion = Motion::static_;
    body.material = 0;
    body.shape = laid.of == Floor::hulls ? shape(tile_hull())
        : laid.of == Floor::meshes       ? shape(tile_mesh())
                                         : shape(BoxShape{kTile});
    const std::vector<Pose> places = places_of(laid, tiles);
    if (laid.of == Floor::compound) {
        CompoundShape whole;
        for (const Pose& place : places) whole.parts.push_back({body.shape, place});
        body.shape = shape(std::move(whole));
    }
    for (const Pose& place : laid.of == Floor::compound ? std::vector<Pose>{Pose{}} : places) {
        const Pose placed = laid.at * place;
        body.position = placed.position;
        body.orientation = placed.orientation;
        scene.bodies.push_back(body);
    }
}

std::uint32_t put_slider(SceneParts& parts, Slider slider, std::uint32_t material, const Pose& at)
{
    const Vec3 half = Vec3::Constant(0.25);
    if (slider == Slider::ball) return parts.ball(material, 1, 0.5, at.position);
    const std::uint32_t body = parts.box(material, 1, half, at);
    if (slider == Slider::box) return body;
    Scene& scene = parts.scene();
    MeshShape mesh = mesh_shape(box_mesh(half));
    mesh.nonconvex = slider == Slider::voxels ? "voxels" : "depth_image";
    scene.shapes[scene.bodies[body].shape].shape = std::move(mesh);
    return body;
}

Scene tiled(const CaseBench& bench, const Laid& laid, Slider kind, double friction, int tiles)
{
    SceneParts parts(bench.scene());
    const std::uint32_t material = parts.material(friction);
    if (!laid.backwards) lay_floor(parts.scene(), laid, tiles);
    const Vec3 begin(0, 0.13, kind == Slider::ball ? 0.5 : 0.25);
    const std::uint32_t slider =
        put_slider(parts, kind, material, laid.at * Pose{begin, Quat::Identity()});
    parts.body(slider).velocity = laid.at.orientation * Vec3(kSpeed, 0, 0);
    if (laid.backwards) lay_floor(parts.scene(), laid, tiles);
    parts.scene().gravity = laid.at.orientation * Vec3(0, 0, -kGravity);
    parts.scene().settings.sleep = false;
    return parts.scene();
}

// Where the slider is on the floor, and how fast along it, after a time.
struct Slid {
    double way = 0, speed = 0;
};

Slid slide(CaseBench& bench, const Scene& scene, const Laid& laid, double seconds)
{
    Slid seen;
    bench.run(scene, seconds, [&](World& world, double) {
        const BodyId id = laid.backwards ? world.bodies().front() : world.bodies().back();
        seen.way = laid.at.to_local(world.pose(id).position).x();
        seen.speed = (laid.at.orientation.conjugate() * world.velocity(id)).x();
        return true;
    });
    return seen;
}

void keeps_speed(CaseBench& bench,
                 const std::string& name,
                 const Laid& laid,
                 const std::function<void(Settings&)>& set)
{
    const double seconds = bench.brief() ? 0.5 : 4;
    for (const Slider slider : {Slider::ball, Slider::box, Slider::voxels, Slider::depth_image}) {
        Scene scene = tiled(bench, laid, slider, 0, static_cast<int>(kSpeed * seconds) + 3);
        set(scene.settings);
        const Slid seen = slide(bench, scene, laid, seconds);
        const std::string which = name + ", " + name_of(slider);
        bench.report(which, "speed lost or gained", std::abs(seen.speed / kSpeed - 1), 0.01, "1");
        bench.report(which, "error of the way", std::abs(seen.way / (kSpeed * seconds) - 1), 0.01,
                     "1");
    }
}

}  // namespace

void case_tiles(CaseBench& bench)
{
    const auto by_default = [](Settings&) {};
    const Quat turned = exponential(Vec3(0.3, -0.5, 0.7));
    keeps_speed(bench, "boxes", {}, by_default);
    keeps_speed(bench, "hulls", {.of = Floor::hulls}, by_default);
    keeps_speed(bench, "meshes", {.of = Floor::meshes}, by_default);
    keeps_speed(bench, "a compound", {.of = Floor::compound}, by_default);
    keeps_speed(bench, "boxes 1 mm apart", {.separation = 1e-3}, by_default);
    keeps_speed(bench, "boxes, turned", {.at = {Vec3::Zero(), turned}}, by_default);
    keeps_speed(bench, "boxes, far off", {.at = {Vec3(1e5, -2e5, 1e4), turned}}, by_default);
    keeps_speed(bench, "boxes, made last", {.backwards = true}, by_default);
    for (const auto& [dt, name] : {std::pair{1.0 / 240, "dt 1/240"}, {1e-3, "dt 1e-3"}})
        keeps_speed(bench, std::string("boxes, ") + name, {},
                    [dt = dt](Settings& settings) { settings.dt = dt; });
    keeps_speed(bench, "boxes, direct", {}, ask_exactly);

    const double friction = 0.3, way = kSpeed * kSpeed / (2 * friction * kGravity);
    for (const Floor of : {Floor::boxes, Floor::meshes}) {
        const std::string name = of == Floor::boxes ? "boxes, mu 0.3, " : "meshes, mu 0.3, ";
        for (const Slider slider : {Slider::box, Slider::voxels, Slider::depth_image}) {
            const Slid seen = slide(bench, tiled(bench, {.of = of}, slider, friction, 15), {}, 4);
            bench.report(name + name_of(slider), "error of the way to rest",
                         std::abs(seen.way / way - 1), 0.01, "1");
        }
    }
    // Depth images see what is higher than their rays are apart, 16 mm.
    for (const auto& [slider, step] :
         {std::pair{Slider::box, 5}, {Slider::voxels, 5}, {Slider::depth_image, 20}}) {
        const Laid stepped{.step = 1e-3 * step};
        const Slid seen = slide(bench, tiled(bench, stepped, slider, 0, 15), stepped, 1);
        bench.report("boxes, one " + std::to_string(step) + " mm higher, " + name_of(slider),
                     "not met: wrong outcomes", seen.speed < 0.9 * kSpeed ? 0 : 1, 0, "1");
    }
}

}  // namespace throng
