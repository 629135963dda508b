// Thrown rings: H116, small bodies that are not convex are thrown on a floor, and slide and turn on
// it.
//
// Answer: none is below the floor, or deep in it. In a step they fall by more than they are thick,
// and turn by radians.
#include "cost/hard_cases/floors.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace throng {

namespace {

constexpr double kSeconds = 4, kLanded = 2;  // s
constexpr double kSpeed = 7, kSpin = 10;     // m/s, rad/s
constexpr double kDeep = 1, kMean = 0.05;    // 1, of their thickness
constexpr double kApart = 5;                 // m
constexpr char kMetBy[] = "dt=1/240";
constexpr int kSide = 3;      // bodies of a side
constexpr double kWide = 60;  // m, half of a floor's side
constexpr int kCells = 30;

struct Below {
    Floor floor;
    double thick;  // m, half of it
};

constexpr Below kFloorsBelow[] = {
    {Floor::plane, 0}, {Floor::box, 1}, {Floor::box, 0.05}, {Floor::box, 0.01}, {Floor::grid, 0}};

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    int seeds = 2;
    const char* met_by = kMetBy;
    Vec3 far = Vec3::Zero();
    bool last_first = false;
};

struct Ring {
    const char* name;
    double radius, tube;  // m
};

constexpr Ring kRings[] = {
    {"rings of 4 cm", 0.015, 0.005}, {"rings of 22 cm", 0.1, 0.01}, {"rings of 1 m", 0.4, 0.1}};

struct End {
    int below = 0, bodies = 0;
    double deepest = 0, sum = 0;  // m; of depths at the end
};

void throw_them(CaseBench& bench,
                const How& how,
                const Ring& ring,
                const Below& floor,
                double friction,
                int seed,
                End& worst)
{
    Random random(static_cast<std::uint64_t>(seed));
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    const std::uint32_t material = parts.material(friction);
    const MeshShape mesh = mesh_shape(torus_mesh(ring.radius, ring.tube, 16, 8));
    const Pose frame{how.far, Quat::Identity()};
    std::vector<BodyDescription> thrown;
    for (int i = 0; i < kSide * kSide; ++i) {
        BodyDescription body;
        body.material = material;
        body.mass = 1e4 * ring.radius * ring.tube * ring.tube;
        body.position = how.far
            + Vec3(kApart * (i % kSide - 1), kApart * (i / kSide - 1),
                   random.uniform(1.5, 4) * (ring.radius + ring.tube));
        body.orientation = random_turn(random, kPi);
        body.velocity = random_vector(random, -kSpeed, kSpeed);
        body.velocity.z() = -std::abs(body.velocity.z());
        body.angular_velocity = random_vector(random, -kSpin, kSpin);
        thrown.push_back(body);
    }
    std::vector<std::uint32_t> ids;
    const FloorSize size{kWide, floor.thick, kCells};
    if (!how.last_first) put_floor(parts, material, floor.floor, frame, size);
    for (const BodyDescription& body : thrown) ids.push_back(parts.add(mesh, body));
    if (how.last_first) put_floor(parts, material, floor.floor, frame, size);
    int below = 0, bodies = 0;
    double sum = 0;
    bench.run(parts.scene(), bench.brief() ? 2.5 : kSeconds, [&](World& world, double now) {
        below = bodies = 0;
        sum = 0;
        for (const std::uint32_t id : ids) {
            Pose pose = world.pose(world.bodies()[id]);
            pose.position -= how.far;
            if (pose.position.head<2>().cwiseAbs().maxCoeff() > kWide - ring.radius) continue;
            const double depth = -lowest_of(mesh.vertices, pose);
            // As they land they go in by what they fall in a step.
            if (now > kLanded) worst.deepest = std::max(worst.deepest, depth);
            sum += std::max(depth, 0.0);
            ++bodies;
            below += depth > 2 * (ring.radius + ring.tube) ? 1 : 0;
        }
        return true;
    });
    bench.forgive_residual();
    worst.below += below;
    worst.bodies += bodies;
    worst.sum += sum;
}

}  // namespace

void case_thrown_rings(CaseBench& bench)
{
    const How hows[] = {
        {"default", [](Settings&) {}, 2, ""},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }, 1, ""},
        {"1 substep", [](Settings& s) { s.substeps = 1; }, 1},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }, 1},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }, 1},
        {"direct", [](Settings& s) { s.solver = Solver::direct; }, 1},
        {"double", [](Settings& s) { s.precision = Precision::double_; }, 1},
        {"default, far off", [](Settings&) {}, 1, kMetBy, Vec3(3e4, -1e4, 2e4)},
        {"default, made last", [](Settings&) {}, 1, kMetBy, Vec3::Zero(), true},
        {"parts", [](Settings& s) { s.nonconvex = NonConvex::parts; }, 1},
        {"spheres", [](Settings& s) { s.nonconvex = NonConvex::spheres; }, 1},
        {"depth_image", [](Settings& s) { s.nonconvex = NonConvex::depth_image; }, 1},
        {"hull", [](Settings& s) { s.nonconvex = NonConvex::hull; }, 1},
    };
    // The last two are those that most fell through.
    const auto floors = std::span(kFloorsBelow).last(bench.brief() ? 2 : std::size(kFloorsBelow));
    for (const How& how : hows) {
        for (const Ring& ring : kRings) {
            End worst;
            for (const Below& floor : floors)
                for (const double friction : {0.0, 0.5}) {
                    if (bench.brief() && friction > 0) continue;
                    for (int seed = 0; seed < (bench.brief() ? 1 : how.seeds); ++seed)
                        throw_them(bench, how, ring, floor, friction, seed, worst);
                }
            const std::string name = ring.name;
            bench.report_default(how.setting, name + " below the floor at the end", worst.below, 0,
                                 "1", how.met_by);
            bench.report_default(how.setting, name + ": deepest from 2 s on, over their thickness",
                                 worst.deepest / (2 * ring.tube), kDeep, "1", how.met_by);
            bench.report_default(how.setting, name + ": mean depth at the end, over that",
                                 worst.sum / (2 * ring.tube * std::max(worst.bodies, 1)), kMean,
                                 "1", how.met_by);
            if (bench.brief()) return;
        }
    }
}

}  // namespace throng
