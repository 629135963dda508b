// No overlap: H15 (a) and (b), H16, H41 and H48, by overlap=back_up; H48 by subdivide too.
//
// The step is cut at every touch, so an impact is where and when it is, however long the step; or
// it is halved until what overlaps is within the tolerance.
#include "cost/hard_cases/hard_cases.hpp"
#include "cost/hard_cases/quad_truth.hpp"
#include "pipeline/queries/mesh_overlap.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "scene/catalog/random.hpp"
#include "throng/box3.hpp"
#include "throng/catalog.hpp"
#include "throng/convex_query.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

namespace throng {

namespace {

// `radius` m of the smallest ball or half extent, tolerance as the dial has it.
SceneParts backed_up(const CaseBench& bench, double dt, double tolerance)
{
    SceneParts parts(bench.scene());
    Settings& settings = parts.scene().settings;
    ask_exactly(settings);
    settings.overlap = Overlap::back_up;
    settings.integrator = Integrator::midpoint;
    settings.dt = dt;
    settings.toi_tolerance = tolerance;
    settings.sleep = false;
    return parts;
}

// A ball is let fall; when it comes to rest, and how far it has gone by then.
void bounce_to_rest(CaseBench& bench, const char* name, double height, double e, double path)
{
    const double radius = 0.1, dt = 1e-3, tolerance = 1e-6;
    SceneParts parts = backed_up(bench, dt, tolerance);
    const std::uint32_t material = parts.material(0, e);
    parts.plane(material, Vec3::UnitZ(), 0);
    parts.ball(material, 1, radius, Vec3(0, 0, radius + height));
    const double wanted = std::sqrt(2 * height / kGravity) * (1 + e) / (1 - e);
    // Slower than a fall through the tolerance it rests; the bounces that are left out would take
    // this long.
    const double slowest = std::sqrt(2 * kGravity * tolerance * radius);
    const double left_out = 2 * slowest / kGravity / (1 - e);
    double last = 0, clearance = height, gone = 0, z = radius + height, speed = 0;
    bench.run(parts.scene(), wanted + 1, [&](World& world, double now) {
        const double before = z;
        z = world.pose(world.bodies()[1]).position.z();
        speed = world.velocity(world.bodies()[1]).norm();
        clearance = std::min(clearance, z - radius);
        gone += std::abs(z - before);
        if (speed > 0.1 * slowest) last = now;  // as it turns round it may be slow for a moment
        return true;
    });
    bench.report(name, "error of the time to rest", std::abs(last - wanted), left_out + dt, "s");
    // A step in which it turns round shows less than it went: twice a step's fall at most.
    bench.report(name, "error of the path, relative", std::abs(gone - path) / path, 1e-2, "1");
    bench.report(name, "overlap", -std::min(clearance, 0.0), 0, "m");
    bench.report(name, "speed 1 s later", speed, 1e-9, "m/s");
}

// Seven by seven elastic balls fall for 20 s: the root mean square error of their energy.
double energy_error(CaseBench& bench, double dt, Integrator integrator)
{
    SceneParts parts = backed_up(bench, dt, 1e-4);
    parts.scene().settings.integrator = integrator;
    const std::uint32_t material = parts.material(0, 1);
    parts.plane(material, Vec3::UnitZ(), 0);
    for (int i = 0; i < 7; ++i)
        for (int k = 0; k < 7; ++k) parts.ball(material, 10, 0.1, Vec3(i, k, 5));
    const double wanted = 49 * 10 * kGravity * 5, time = bench.brief() ? 3 : 20;
    double sum = 0;
    int steps = 0;
    bench.run(parts.scene(), time, [&](World& world, double) {
        const Measures measures = world.measure();
        const double error = measures.kinetic_energy + measures.potential_energy - wanted;
        sum += error * error;
        ++steps;
        return true;
    });
    return std::sqrt(sum / steps) / wanted;
}

}  // namespace

void bounces(CaseBench& bench)
{
    bounce_to_rest(bench, "(a) h=1, e=0.5, back_up", 1, 0.5, 5.0 / 3);
    bounce_to_rest(bench, "(a) h=1, e=0.8, back_up", 1, 0.8, 41.0 / 9);
    if (!bench.brief()) bounce_to_rest(bench, "(a) h=5, e=0.9, back_up", 5, 0.9, 905.0 / 19);
    // 5.7e-6 is the best published at 1e-3, by a method of second order.
    for (const auto& [name, dt, published] :
         {std::tuple("(b) 49 balls, midpoint, dt 1e-3", 1e-3, 5.7e-6),
          std::tuple("(b) 49 balls, midpoint, dt 1e-2", 1e-2, 5.7e-4)}) {
        bench.report(name, "rms error of the energy, relative",
                     energy_error(bench, dt, Integrator::midpoint), published, "1");
        bench.report_time(name, "time a step", bench.time_a_step());
    }
}

namespace {

// Six by six by six balls, each a little off its place, the lowest so far above a floor.
void add_balls(SceneParts& parts, double lowest, double e)
{
    const std::uint32_t material = parts.material(0, e);
    parts.plane(material, Vec3::UnitZ(), 0);
    Random random(42);
    for (int i = 0; i < 216; ++i) {
        Vec3 at(i % 6, i / 6 % 6, i / 36);
        at = 0.21 * at + Vec3(0, 0, 0.1 + lowest);
        for (int axis = 0; axis < 3; ++axis) at[axis] += random.uniform(0, 1e-3);
        parts.ball(material, 10, 0.1, at);
    }
}

// m2, the squares of all overlaps of those balls, added up.
double squared_overlaps(const World& world)
{
    std::vector<Vec3> places;
    for (const BodyId body : world.bodies()) places.push_back(world.pose(body).position);
    double sum = 0;
    const auto add = [&](double distance) { sum += std::pow(std::min(distance, 0.0), 2); };
    for (std::size_t i = 1; i < places.size(); ++i) {
        add(places[i].z() - 0.1);
        for (std::size_t k = 1; k < i; ++k) add((places[i] - places[k]).norm() - 0.2);
    }
    return sum;
}

// Balls that do not bounce fall from a millimeter and spread; the best published error at this dt.
void spread(CaseBench& bench, Scene scene, double seconds, const char* name)
{
    scene.settings.dt = 1e-3;
    scene.settings.sleep = false;
    double sum = 0;
    int steps = 0;
    bench.run(scene, seconds, [&](World& world, double) {
        sum += squared_overlaps(world);
        ++steps;
        return true;
    });
    bench.report(name, "mean over steps of the squared overlaps", sum / steps, 1.4e-4, "m2");
    bench.report_time(name, "time a step", bench.time_a_step());
}

}  // namespace

void case_pile_of_balls(CaseBench& bench)
{
    SceneParts usual(bench.scene());
    add_balls(usual, 1e-3, 0);
    spread(bench, usual.scene(), bench.brief() ? 0.3 : 10, "216 balls that do not bounce, dt 1e-3");
    SceneParts apart = backed_up(bench, 1e-3, 1e-4);
    add_balls(apart, 1e-3, 0);
    spread(bench, apart.scene(), bench.brief() ? 0.03 : 10,
           "216 balls that do not bounce, dt 1e-3, back_up");

    SceneParts parts = backed_up(bench, 1e-3, 1e-4);
    parts.scene().settings.solver = Solver::soft_step;  // for whom bodies overlap all the same
    add_balls(parts, 1.001, 1);
    double wanted = 0, sum = 0, overlap = 0;
    for (const BodyDescription& body : parts.scene().bodies)
        if (body.mass) wanted += *body.mass * kGravity * body.position.z();
    int steps = 0;
    bench.run(parts.scene(), bench.brief() ? 0.7 : 10, [&](World& world, double) {
        const Measures measures = world.measure();
        const double error = measures.kinetic_energy + measures.potential_energy - wanted;
        sum += error * error;
        overlap = std::max(overlap, measures.greatest_overlap);
        ++steps;
        return true;
    });
    const char* const name = "216 elastic balls, midpoint, dt 1e-3, back_up";
    bench.report(name, "mean square error of the energy", sum / steps, 8.4, "J2");
    bench.report(name, "greatest overlap", overlap, 0, "m");
    bench.report_time(name, "time a step", bench.time_a_step());
}

void case_backed_up(CaseBench& bench)
{
    const double tolerance = 1e-6;
    SceneParts parts = backed_up(bench, 0.1, tolerance);
    parts.scene().gravity = Vec3::Zero();
    const std::uint32_t material = parts.material(0, 1);
    for (int i = 0; i < 3; ++i) parts.ball(material, 1, 0.5, Vec3(2 * i, 0, 0));
    parts.body(0).velocity = Vec3(100, 0, 0);
    double place = 0, speed = 0;
    bench.run(parts.scene(), 0.1, [&](World& world, double) {
        const double places[3] = {1, 3, 12}, speeds[3] = {0, 0, 100};
        for (std::size_t i = 0; i < 3; ++i) {
            const BodyId body = world.bodies()[i];
            place = std::max(place, (world.pose(body).position - Vec3(places[i], 0, 0)).norm());
            speed = std::max(speed, (world.velocity(body) - Vec3(speeds[i], 0, 0)).norm());
        }
        return true;
    });
    const char* const name = "three balls in one step, back_up";
    // Two impacts, each up to the tolerance early.
    bench.report(name, "error of the places", place, 2 * tolerance * 0.5, "m");
    bench.report(name, "error of the velocities", speed, 1e-9, "m/s");
}

namespace {

// What any way of holding bodies apart is asked for: its price, and what it holds.
struct Price {
    double overlap = 0, ms = 0;  // the greatest at any step, and the mean time of one
    int steps = 0;

    void add(const World& world)
    {
        overlap = std::max(overlap, world.measure().greatest_overlap);
        ms += (world.report().time_ms - ms) / ++steps;
    }
};

// The dials of a scene that nobody sleeps in, with so much exactness as keeping apart needs.
void hold_apart(Settings& settings, Overlap overlap)
{
    settings.overlap = overlap;
    settings.sleep = false;
    if (overlap != Overlap::allow) settings.precision = Precision::double_;
}

struct Tower : Price {
    double clearance = 1, deepest = 0, speed = 0;
};

// H8: ten cubes of 1 m, as they fall asleep nowhere. The least gap between the middles of faces.
Tower tower(CaseBench& bench, Overlap overlap)
{
    SceneParts parts(bench.scene());
    hold_apart(parts.scene().settings, overlap);
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    for (int k = 0; k < 10; ++k)
        parts.box(material, 1, Vec3::Constant(0.5), {Vec3(0, 0, 0.501 + k * 1.001), {1, 0, 0, 0}});
    Tower seen;
    bench.run(parts.scene(), bench.brief() ? 1 : 10, [&](World& world, double) {
        double below = 0;
        seen.speed = 0;
        for (std::size_t i = 1; i < world.bodies().size(); ++i) {
            const double z = world.pose(world.bodies()[i]).position.z();
            seen.clearance = std::min(seen.clearance, z - 0.5 - below);
            below = z + 0.5;
            seen.speed = std::max(seen.speed, world.velocity(world.bodies()[i]).norm());
        }
        seen.deepest = world.report().deepest;
        seen.add(world);
        return true;
    });
    return seen;
}

// How far apart boxes and the ground at z = 0 are: the least of all pairs within reach, in four
// times the digits and by nothing that a step knows.
class BoxSeparations {
public:
    explicit BoxSeparations(const Vec3& half) : half_(half) { }

    double least(std::span<const Pose> poses) const
    {
        std::vector<QuadSolid> solids;
        std::vector<Box3> boxes;
        double clearance = kReach;
        for (const Pose& pose : poses) {
            solids.push_back(quad_box(half_, QuadPose(pose)));
            const Vec3 extent = pose.orientation.toRotationMatrix().cwiseAbs() * half_;
            boxes.push_back({pose.position - extent - Vec3::Constant(kReach / 2),
                             pose.position + extent + Vec3::Constant(kReach / 2)});
            clearance = std::min(clearance, pose.position.z() - extent.z());
        }
        for (std::size_t i = 0; i < solids.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (boxes[i].overlaps(boxes[k]))
                    clearance = std::min(clearance, quad_truth(solids[i], solids[k]).separation);
        return clearance;
    }

private:
    static constexpr double kReach = 1e-3;  // m, what is further apart is not looked at
    Vec3 half_;
};

struct House : Price {
    double drift = 0, clearance = 1;
    std::uint64_t fallbacks = 0;
};

// H10: a house of cards as the catalogue builds it, standing for 10 s.
House house(CaseBench& bench, Overlap overlap, int levels)
{
    Scene scene = make_scene("card_house", levels);
    scene.settings = bench.settings();
    hold_apart(scene.settings, overlap);
    const World built(scene);
    const BoxSeparations separations(
        std::get<BoxShape>(scene.shapes[scene.instances.front().common.shape].shape).half_extents);
    House seen;
    bench.run(scene, bench.brief() ? 1 : 10, [&](World& world, double) {
        seen.drift = 0;
        std::vector<Pose> cards;  // the ground comes first
        for (std::size_t i = 1; i < world.bodies().size(); ++i) {
            cards.push_back(world.pose(world.bodies()[i]));
            const Vec3 drift = cards.back().position - built.pose(built.bodies()[i]).position;
            seen.drift = std::max(seen.drift, drift.norm());
        }
        if (overlap != Overlap::allow)
            seen.clearance = std::min(seen.clearance, separations.least(cards));
        seen.fallbacks = world.report().fallbacks;
        seen.add(world);
        return true;
    });
    return seen;
}

void report_house(CaseBench& bench)
{
    const auto name_of = [](int levels) {
        return "H10, cards, levels: " + std::to_string(levels) + ", ";
    };
    const auto report = [&](Overlap overlap, int levels) {
        const House seen = house(bench, overlap, levels);
        const bool backs = overlap == Overlap::back_up;
        const std::string by = name_of(levels) + (backs ? "back_up" : "subdivide");
        const double half = 0.001;  // m, of a card's thickness
        const double most = backs ? 0 : bench.settings().toi_tolerance * half;
        bench.report(by, "greatest overlap, at any step", seen.overlap, most, "m");
        if (backs)
            bench.report(by, "least distance by geometry, at any step, wanting",
                         seen.clearance > 0 ? 0 : 1, 0, "1");
        else
            bench.report(by, "greatest overlap by geometry, at any step",
                         std::max(0.0, -seen.clearance), most, "m");
        bench.show(by, "least distance by geometry, at any step", seen.clearance, "m");
        bench.report(by, "drift at the end", seen.drift, 1e-3, "m");
        bench.report(by, "groups or pieces given up", static_cast<double>(seen.fallbacks), 0, "1");
        bench.report_time(by, "time a step", seen.ms * 1e6);
    };
    const int few = bench.brief() ? 1 : 2;
    report(Overlap::back_up, few);
    report(Overlap::subdivide, few);
    if (!bench.brief()) report(Overlap::back_up, 5);
    bench.report_time(name_of(few) + "allow", "time a step",
                      house(bench, Overlap::allow, few).ms * 1e6);
}

struct Rings : Price {
    double deepest = 0, speed = 0;
    double triangles = 0;  // m, greatest overlap by their triangles, of voxels alone
    std::uint64_t fallbacks = 0;
};

// Six rings, let fall into a shaft one above the other, leaning ever more.
Scene rings_in_a_shaft(const CaseBench& bench, Overlap overlap, NonConvex way)
{
    SceneParts parts(bench.scene());
    hold_apart(parts.scene().settings, overlap);
    parts.scene().settings.nonconvex = way;
    if (bench.brief()) parts.scene().settings.sphere_levels = 3;
    const std::uint32_t material = parts.material(0.5);
    parts.plane(material, Vec3::UnitZ(), 0);
    for (const double side : {-1.0, 1.0})
        for (const Vec3& across : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())})
            parts.plane(material, side * across, -0.6);
    const TriangleSoup soup = torus_mesh(0.3, 0.12, 24, 12);
    MeshShape ring;
    ring.vertices = soup.vertices;
    ring.triangles = soup.triangles;
    Scene& scene = parts.scene();
    scene.shapes.push_back({"ring", ring});
    for (int i = 0; i < 6; ++i) {
        BodyDescription body;
        body.shape = static_cast<std::uint32_t>(scene.shapes.size() - 1);
        body.material = material;
        body.position = Vec3(0.04 * i - 0.1, 0.07 - 0.03 * i, 0.45 + 0.85 * i);
        const double lean = 0.1 + 0.2 * i;
        body.orientation = Quat(std::cos(lean), 0.8 * std::sin(lean), 0.6 * std::sin(lean), 0);
        scene.bodies.push_back(body);
    }
    return std::move(scene);
}

// m, by which rings are in one another, by their triangles.
double triangles_overlap(const World& world, const MeshOverlap& rings)
{
    std::vector<Pose> poses;
    for (const BodyId body : world.bodies())
        if (world.motion(body) == Motion::dynamic) poses.push_back(world.pose(body));
    double overlap = 0;
    for (std::size_t i = 0; i < poses.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            overlap = std::max(overlap, rings.greatest(seen_from(poses[i], poses[k])));
    return overlap;
}

Rings rings(CaseBench& bench, Overlap overlap, NonConvex way = NonConvex::spheres)
{
    Rings seen;
    const Scene scene = rings_in_a_shaft(bench, overlap, way);
    const auto& ring = std::get<MeshShape>(scene.shapes.back().shape);
    const MeshOverlap pair(ring, ring);
    bench.run(scene, bench.brief() ? 0.5 : 3, [&](World& world, double) {
        if (way == NonConvex::voxels)
            seen.triangles = std::max(seen.triangles, triangles_overlap(world, pair));
        seen.speed = 0;
        for (const BodyId body : world.bodies())
            seen.speed = std::max(seen.speed, world.velocity(body).norm());
        seen.fallbacks = world.report().fallbacks;
        seen.deepest = world.report().deepest;
        seen.add(world);
        return true;
    });
    return seen;
}

// The triangles are held apart; what is measured here is told by the voxels.
void report_voxel_rings(CaseBench& bench)
{
    const Rings seen = rings(bench, Overlap::back_up, NonConvex::voxels);
    const char* const by = "six rings as voxels in a shaft, back_up";
    const double half_voxel = 0.84 / 48 / 2;
    bench.report(by, "greatest overlap as voxels tell it", seen.overlap, half_voxel, "m");
    bench.report(by, "greatest overlap of the triangles, at any step", seen.triangles, 0, "m");
    if (!bench.brief()) bench.report(by, "speed at the end", seen.speed, 1e-3, "m/s");
    bench.report(by, "groups or pieces given up", static_cast<double>(seen.fallbacks), 0, "1");
    bench.report_time(by, "time a step", seen.ms * 1e6);
}

void report_rings(CaseBench& bench)
{
    const double tolerance = bench.settings().toi_tolerance * 0.12;
    for (const Overlap overlap : {Overlap::back_up, Overlap::subdivide}) {
        const Rings seen = rings(bench, overlap);
        const bool backs = overlap == Overlap::back_up;
        const std::string by =
            std::string("six rings as spheres in a shaft, ") + (backs ? "back_up" : "subdivide");
        bench.report(by, "greatest overlap, at any step", seen.overlap, backs ? 0 : tolerance, "m");
        if (!backs)
            bench.report(by, "greatest overlap, in any piece of one", seen.deepest, tolerance, "m");
        if (!bench.brief()) bench.report(by, "speed at the end", seen.speed, 1e-3, "m/s");
        bench.report(by, "groups or pieces given up", static_cast<double>(seen.fallbacks), 0, "1");
        bench.report_time(by, "time a step", seen.ms * 1e6);
    }
    report_voxel_rings(bench);
    const Rings usual = rings(bench, Overlap::allow);
    const char* const allowed = "six rings as spheres in a shaft, allow";
    constexpr double kAnyOverlap = 0.1;  // m, not a bound that anything is held to
    bench.report(allowed, "greatest overlap, at any step", usual.overlap, kAnyOverlap, "m");
    bench.report_time(allowed, "time a step", usual.ms * 1e6);
}

}  // namespace

void case_no_overlap(CaseBench& bench)
{
    const Tower seen = tower(bench, Overlap::back_up), usual = tower(bench, Overlap::allow);
    const Tower halved = tower(bench, Overlap::subdivide);
    const char* const name = "H8, ten cubes from 1 mm gaps, back_up";
    bench.report(name, "least distance, at any step, wanting", seen.clearance > 0 ? 0 : 1, 0, "1");
    bench.report(name, "greatest overlap, at any step", seen.overlap, 0, "m");
    bench.report(name, "speed at the end", seen.speed, 1e-3, "m/s");
    bench.report_time(name, "time a step", seen.ms * 1e6);
    const char* const by_halves = "the same, overlap=subdivide";
    const double tolerance = bench.settings().toi_tolerance * 0.5;
    bench.report(by_halves, "greatest overlap, at any step", halved.overlap, tolerance, "m");
    bench.report(by_halves, "greatest overlap, in any piece of one", halved.deepest, tolerance,
                 "m");
    bench.report(by_halves, "speed at the end", halved.speed, 1e-3, "m/s");
    bench.report_time(by_halves, "time a step", halved.ms * 1e6);
    constexpr double kAnyOverlap = 0.1;  // m, likewise
    const char* const allowed = "the same, overlap=allow";
    bench.report(allowed, "greatest overlap, at any step", usual.overlap, kAnyOverlap, "m");
    bench.report_time(allowed, "time a step", usual.ms * 1e6);
    report_house(bench);
    report_rings(bench);
}

}  // namespace throng
