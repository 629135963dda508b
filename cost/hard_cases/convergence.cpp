// Convergence: H45, how the error of shared volumes and of depths falls with the resolution.
//
// Answers: closed forms, of the lens that two balls share and of two cubes turned against one
// another. Errors are root mean squares over pairs that are turned at random, so that no grid is in
// step with a face. An order is the slope of a line through the logarithms.
#include "cost/hard_cases/hard_cases.hpp"
#include "cost/hard_cases/solid_parts.hpp"
#include "scene/catalog/noisy_balls.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/box3.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace throng {

namespace {

constexpr int kTurns = 32;
// How far a fitted order may be off.
constexpr double kOrderSlack = 0.3;

/// Two shapes, and what they share.
///
///   side  of the bounds that they share, against that of the pair that laws are stated for
struct SharedPair {
    ShapeDescription a, b;
    Pose b_in_a;
    double volume = 0;
    Vec3 center = Vec3::Zero();
    double side = 1;
};

Quat random_orientation(Random& random) { return random_turn(random, kPi); }

// Balls of radius 1 and 0.7, 1.1 apart in any direction.
SharedPair lens(Random& random)
{
    constexpr double kA = 1, kB = 0.7, kApart = 1.1;
    const Vec3 along = random_orientation(random) * Vec3(0.36, 0.48, 0.8);
    // Where the plane of their circle is, and the caps to either side of it with their centers.
    const double plane = (kApart * kApart + kA * kA - kB * kB) / (2 * kApart);
    const double high_a = kA - plane, high_b = kB - (kApart - plane);
    const auto volume = [](double r, double h) { return kPi * h * h * (3 * r - h) / 3; };
    const auto middle = [](double r, double h) {
        return 3 * (2 * r - h) * (2 * r - h) / (4 * (3 * r - h));
    };
    const double volume_a = volume(kA, high_a), volume_b = volume(kB, high_b);
    const double whole = volume_a + volume_b;
    const double center =
        (volume_a * middle(kA, high_a) + volume_b * (kApart - middle(kB, high_b))) / whole;
    return {{"", SphereShape{kA}},
            {"", SphereShape{kB}},
            {kApart * along, Quat::Identity()},
            whole,
            center * along};
}

// The longest side of what the bounds of two meshes share.
double shared_side(const TriangleSoup& a, const TriangleSoup& b)
{
    Box3 box_a, box_b;
    for (const Vec3& vertex : a.vertices) box_a = joined(box_a, {vertex, vertex});
    for (const Vec3& vertex : b.vertices) box_b = joined(box_b, {vertex, vertex});
    return (box_a.upper.cwiseMin(box_b.upper) - box_a.lower.cwiseMax(box_b.lower)).maxCoeff();
}

// Unit cubes about one center, the one turned by 60 degrees about a diagonal of the other; both
// aslant to the axes.
SharedPair turned_cubes(Random& random)
{
    const Quat aslant = random_orientation(random);
    const Quat turned = aslant * turn(Vec3::Constant(1 / std::sqrt(3.0)), kPi / 3);
    const auto cube = [](const Quat& by) {
        TriangleSoup soup = box_mesh(Vec3::Constant(0.5));
        for (Vec3& vertex : soup.vertices) vertex = by * vertex;
        return soup;
    };
    const TriangleSoup a = cube(aslant), b = cube(turned);
    return {{"", mesh_shape(a)}, {"", mesh_shape(b)}, Pose{}, 0.75,
            Vec3::Zero(),        shared_side(a, b)};
}

// Unit cubes whose axes are those of every lattice, the one pushed into the other: at worst a whole
// layer of cells is counted or is not.
SharedPair aligned_cubes(Random& random)
{
    Vec3 off;
    for (int axis = 0; axis < 3; ++axis) off[axis] = random.uniform(0.01, 0.49);
    const ShapeDescription cube{"", BoxShape{Vec3::Constant(0.5)}};
    return {cube, cube, {off, Quat::Identity()}, (Vec3::Ones() - off).prod(), off / 2};
}

// Errors against numbers of cells, rays or voxels, and the line through them.
struct Fall {
    std::vector<double> cells, errors;

    void add(double count, double error)
    {
        cells.push_back(std::log(count));
        errors.push_back(std::log(error));
    }
    double order() const
    {
        const auto n = static_cast<double>(cells.size());
        double x = 0, y = 0, xx = 0, xy = 0;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            x += cells[i];
            y += errors[i];
            xx += cells[i] * cells[i];
            xy += cells[i] * errors[i];
        }
        return -(n * xy - x * y) / (n * xx - x * x);
    }
};

struct SharedError {
    double volume = 0, center = 0;  // of the volume; of the cube root of it
    double side2 = 0;               // mean square of the sides
};

SharedError
shared_error(CaseBench& bench, SharedPair (*make)(Random&), std::string_view way, int cells)
{
    Random random(5);
    SharedError error;
    for (int i = 0; i < kTurns; ++i) {
        const SharedPair pair = make(random);
        const VolumeAnswer answer = bench.ask_volume(way, pair.a, pair.b, pair.b_in_a, cells);
        const double off = answer.volume / pair.volume - 1;
        const Vec3 center = (answer.center - pair.center) / std::cbrt(pair.volume);
        error.volume += off * off / kTurns;
        error.center += center.squaredNorm() / kTurns;
        error.side2 += pair.side * pair.side / kTurns;
    }
    return {std::sqrt(error.volume), std::sqrt(error.center), error.side2};
}

// Twice a law of order 2, since other pairs are asked than it was measured on.
//
//   law  error of the volume, times the square of the number of cells, at the worst of the
//        resolutions from 8 to 256 that were measured
struct VolumeBounds {
    const char* pair;
    SharedPair (*make)(Random&);
    std::string_view way;
    double law;
    int finest;
    bool flat = false;
};

void judge_volumes(CaseBench& bench, const VolumeBounds& bounds)
{
    Fall volumes, centers;
    const std::string setting = std::string(bounds.pair) + ", " + std::string(bounds.way);
    const int finest = bench.brief() ? 32 : bounds.finest;
    for (int cells = 8; cells <= finest; cells *= 2) {
        const SharedError error = shared_error(bench, bounds.make, bounds.way, cells);
        volumes.add(cells, error.volume);
        centers.add(cells, error.center);
        bench.report(setting + ", " + std::to_string(cells) + " cells", "error of the volume",
                     error.volume, 2 * bounds.law * error.side2 / (cells * cells), "1");
    }
    // What is flat and aslant to all axes is met by lattices more evenly than by chance, and errors
    // fall faster than by order 2.
    const auto order = [&](const char* what, double fitted) {
        const double off = bounds.flat ? std::max(0.0, 2 - fitted) : std::abs(fitted - 2);
        bench.report(setting,
                     std::string("order of the ") + what + (bounds.flat ? " short of 2" : " off 2"),
                     off, kOrderSlack, "1");
    };
    order("volume", volumes.order());
    order("center", centers.order());
}

void judge_exact(CaseBench& bench)
{
    const SharedError error = shared_error(bench, turned_cubes, "exact", 1);
    bench.report("cubes, exact", "error of the volume", error.volume, 1e-12, "1");
    bench.report("cubes, exact", "error of the center", error.center, 1e-12, "1");
}

// Flat faces in step with the lattice, the worst there is: order 1. Sides are half of the longest
// at least, and the count along each of the two others is off by half a cell at most.
void judge_aligned(CaseBench& bench)
{
    Fall volumes;
    for (int cells = 8; cells <= (bench.brief() ? 32 : 256); cells *= 2) {
        const SharedError error = shared_error(bench, aligned_cubes, "voxels", cells);
        volumes.add(cells, error.volume);
        bench.report("aligned cubes, voxels, " + std::to_string(cells) + " cells",
                     "error of the volume", error.volume, 2.0 / cells, "1");
    }
    bench.report("aligned cubes, voxels", "order of the volume short of 1",
                 std::max(0.0, 1 - volumes.order()), kOrderSlack, "1");
}

// A post through the hole of a torus: one layer of depths fills it, and says so.
void judge_hole(CaseBench& bench)
{
    const ShapeDescription torus{"", mesh_shape(torus_mesh(0.7, 0.2, 32, 16))};
    const ShapeDescription post{"", BoxShape{{0.2, 0.2, 1}}};
    for (const char* way : {"voxels", "depth_image", "exact"}) {
        const ShapeDescription mesh_post{"", mesh_shape(box_mesh({0.2, 0.2, 1}))};
        const VolumeAnswer answer = bench.ask_volume(way, torus, mesh_post, Pose{}, 48);
        bench.report("post through a torus, " + std::string(way), "shared volume", answer.volume,
                     1e-12, "m3");
    }
    const VolumeAnswer filled = bench.ask_volume("single_layer", torus, post, Pose{}, 48);
    bench.report("post through a torus, single_layer", "sees the hole, which it cannot",
                 filled.volume > 0.01 ? 0 : 1, 0, "1");
}

/// Two bodies, and where b is in a's frame when they overlap by kDepth.
constexpr double kDepth = 0.1;
struct DepthPair {
    TriangleSoup a;
    ShapeDescription b;
    std::function<Vec3(Random&)> place;
};

// As many pairs as there are turns, each far from the others. The greatest error of the depths that
// the world measures, and of their mean.
double depth_error(CaseBench& bench, const Settings& settings, const DepthPair& pair)
{
    Random random(9);
    Scene scene = begin_scene("depths", kTurns);
    scene.settings = settings;
    const std::uint32_t a = add_shape(scene, "a", mesh_shape(pair.a));
    scene.shapes.push_back(pair.b);
    for (int i = 0; i < kTurns; ++i) {
        const Vec3 at(10.0 * i, 0, 0), b_in_a = pair.place(random);
        for (const bool first : {true, false}) {
            BodyDescription& body = scene.bodies.emplace_back();
            body.shape = first ? a : a + 1;
            body.material = 0;
            body.position = first ? at : Vec3(at + b_in_a);
        }
    }
    double error = 0;
    bench.inspect(scene, [&](const World& world) {
        const Measures measures = world.measure();
        error = std::max(std::abs(measures.greatest_overlap - kDepth),
                         std::abs(measures.mean_overlap - kDepth));
    });
    return error;
}

// Balls of radius 1 made of triangles, which meet at corners: these lie on the round balls, and
// each has another one opposite.
DepthPair round_pair(std::uint32_t cuts)
{
    TriangleSoup ball = geodesic_ball(1, cuts);
    const auto place = [corners = ball.vertices](Random& random) -> Vec3 {
        const double which = random.uniform(0, 1) * static_cast<double>(corners.size());
        return (2 - kDepth) * corners[static_cast<std::size_t>(which)];
    };
    return {ball, {"b", mesh_shape(ball)}, place};
}

// A ball on a box, where it is flat.
DepthPair flat_pair()
{
    const auto place = [](Random& random) -> Vec3 {
        const double x = random.uniform(-0.9, 0.9), y = random.uniform(-0.7, 0.7);
        return {x, y, 1 - kDepth};
    };
    return {box_mesh({1, 0.8, 0.5}), {"b", SphereShape{0.5}}, place};
}

void judge_voxel_depths(CaseBench& bench)
{
    Fall fall;
    const DepthPair pair = round_pair(bench.brief() ? 20 : 60);
    for (const int cells : {8, 16, 32, 64}) {
        if (bench.brief() && cells > 16) continue;
        Settings settings = bench.settings();
        settings.nonconvex = NonConvex::voxels;
        settings.voxel_size = 2.0 / cells;
        const double error = depth_error(bench, settings, pair);
        fall.add(cells, error);
        bench.report("balls, voxels, " + std::to_string(cells) + " across",
                     "error of the depth, in voxels", error / settings.voxel_size, 0.5, "1");
    }
    bench.report("balls, voxels", "order of the depth off 2", std::abs(fall.order() - 2),
                 kOrderSlack, "1");
}

// A small ball inside an edge, half way between its faces, where distances bend: order 1.
DepthPair edge_pair()
{
    const auto place = [](Random& random) -> Vec3 {
        return {1 - kDepth / 2, random.uniform(-0.7, 0.7), 0.5 - kDepth / 2};
    };
    return {box_mesh({1, 0.8, 0.5}), {"b", SphereShape{kDepth / 2}}, place};
}

void judge_edge_depths(CaseBench& bench)
{
    for (const int cells : {16, 32, 64, 128}) {
        if (bench.brief() && cells > 32) continue;
        Settings settings = bench.settings();
        settings.nonconvex = NonConvex::voxels;
        settings.voxel_size = 2.0 / cells;
        const double error = depth_error(bench, settings, edge_pair());
        bench.report("edge of a box, voxels, " + std::to_string(cells) + " along",
                     "error of the depth, in voxels", error / settings.voxel_size, 0.5, "1");
    }
}

void judge_sphere_depths(CaseBench& bench)
{
    double before = 0;
    for (int levels = 1; levels <= (bench.brief() ? 3 : 4); ++levels) {
        Settings settings = bench.settings();
        settings.nonconvex = NonConvex::spheres;
        settings.sphere_levels = levels;
        const double error = depth_error(bench, settings, flat_pair());
        if (levels > 1)
            bench.report("box, spheres, " + std::to_string(levels) + " levels",
                         "error of the depth, of that with one less", error / before, 1, "1");
        before = error;
    }
}

}  // namespace

void case_convergence(CaseBench& bench)
{
    judge_exact(bench);
    for (const VolumeBounds& bounds :
         {VolumeBounds{"lens", lens, "voxels", 6.2, 256},
          VolumeBounds{"cubes", turned_cubes, "voxels", 0.92, 256, true},
          VolumeBounds{"lens", lens, "depth_image", 1.8, 256},
          VolumeBounds{"cubes", turned_cubes, "depth_image", 0.39, 256, true},
          VolumeBounds{"lens", lens, "single_layer", 1.8, 256},
          VolumeBounds{"cubes", turned_cubes, "single_layer", 0.39, 256, true}})
        judge_volumes(bench, bounds);
    judge_aligned(bench);
    judge_hole(bench);
    judge_voxel_depths(bench);
    judge_edge_depths(bench);
    judge_sphere_depths(bench);
}

}  // namespace throng
