// Through the hole: H43, shapes that only what is true of their holes can answer for.
//
// Answers: a torus round a peg lies on the floor, at most the play between them off the axis. Links
// of a chain are linked for ever, and with middles no further apart than where they touch. A bolt
// comes down by its pitch a turn. Where all move as one body would, the bounds are what the ways
// themselves say they are off by.
#include "cooking/repair/build_mesh.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "cost/hard_cases/solid_parts.hpp"
#include "kernels/geometry/mass.hpp"
#include "pipeline/queries/mesh_overlap.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/threads.hpp"
#include "throng/catalog.hpp"
#include "throng/convex_query.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// H43's torus, and the links of its chain.
constexpr double kRing = 1, kTube = 0.25, kPeg = 0.5;
constexpr double kLink = 0.4, kLinkTube = 0.1;

// Of what a tube is thick, what its surface may be off by.
constexpr double kOff = 0.05;

void judge_mass(CaseBench& bench)
{
    const TriangleSoup soup = torus_mesh(kRing, kTube, 512, 256);
    const MassProperties mass = mass_of(build_mesh(soup.vertices, soup.triangles).mesh);
    const double r2 = kTube * kTube, ring2 = kRing * kRing;
    const auto error = [](double figure, double truth) { return std::abs(figure / truth - 1); };
    const double volume = error(mass.volume, 2 * kPi * kPi * kRing * r2);
    const double axial = error(mass.inertia.zz / mass.volume, ring2 + 0.75 * r2);
    const double across = error(mass.inertia.xx / mass.volume, 0.5 * ring2 + 0.625 * r2);
    // Corners lie on the torus: polygons of n sides lack (2 pi / n)^2 / 6 of their circles' area.
    bench.report("262144 triangles", "error of the volume", volume, 2e-4, "1");
    bench.report("262144 triangles", "error of Iz / m", axial, 3e-4, "1");
    bench.report("262144 triangles", "error of Ix / m", across, 3e-4, "1");
}

double off_axis(const Vec3& place) { return std::hypot(place.x(), place.y()); }

void drop_over_peg(CaseBench& bench, const SolidRepresentationName& way)
{
    const Scene scene = taken(bench, make_scene("peg", 1), way);
    Vec3 place = Vec3::Zero();
    double speed = 0;
    bench.run(scene, 10, [&](World& world, double) {
        place = world.pose(world.bodies().back()).position;
        speed = greatest_speed(world);
        return true;
    });
    const std::string setting = "torus over a peg, " + std::string(way.name);
    if (!way.keeps_holes) {
        const bool fits = off_axis(place) < kRing - kPeg && place.z() < kRing;
        bench.report(setting, "round the peg, which a hull cannot be", fits ? 1 : 0, 0, "1");
        return;
    }
    bench.report(setting, "center off its height on the floor", std::abs(place.z() - kTube),
                 kOff * kTube, "m");
    bench.report(setting, "center off the axis", off_axis(place),
                 kRing - kTube - kPeg + kOff * kTube, "m");
    bench.report(setting, "speed after 10 s", speed, 1e-2, "m/s");
}

// The middle line of a link.
struct Ring {
    Vec3 center = Vec3::Zero(), axis = Vec3::UnitZ();
};

Ring ring_of(const World& world, BodyId body)
{
    const Pose pose = world.pose(body);
    return {pose.position, pose.orientation * Vec3::UnitZ()};
}

// Two circles of one radius: b goes through the disc of a once, and not twice or never.
bool are_linked(const Ring& a, const Ring& b, double radius)
{
    const Vec3 up = a.axis - a.axis.dot(b.axis) * b.axis;  // in b's plane
    const double steep = up.norm();
    const double cosine = -a.axis.dot(b.center - a.center) / (radius * steep);
    if (!(std::abs(cosine) < 1)) return false;
    const Vec3 along = up / steep, side = b.axis.cross(along);
    const double sine = std::sqrt(1 - cosine * cosine);
    const auto within = [&](double turn) {
        const Vec3 place = b.center + radius * (cosine * along + turn * sine * side);
        return (place - a.center).norm() < radius;
    };
    return within(1) != within(-1);
}

// Neighbors that are not linked after a step, and how far apart the middles of neighbors came.
struct Links {
    int parted = 0;
    double furthest = 0, now = 0;

    void look(const World& world, const std::vector<BodyId>& chain)
    {
        now = 0;
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
            const Ring a = ring_of(world, chain[i]), b = ring_of(world, chain[i + 1]);
            parted += are_linked(a, b, kLink) ? 0 : 1;
            now = std::max(now, (a.center - b.center).norm());
        }
        furthest = std::max(furthest, now);
    }
    void report(CaseBench& bench, const std::string& setting) const
    {
        // Taut, the tubes touch.
        const double taut = 2 * (kLink - kLinkTube);
        bench.report(setting, "links not linked, over all steps", parted, 0, "1");
        // What holds a jerk gives way first; tubes are within one another by half then.
        bench.report(setting, "middles further apart than taut, at most",
                     std::max(0.0, furthest - taut), kLinkTube, "m");
        bench.report(setting, "middles further apart than taut, at the end",
                     std::max(0.0, now - taut), kOff * kLinkTube, "m");
    }
};

void hang_chain(CaseBench& bench, const SolidRepresentationName& way)
{
    Links links;
    const Scene scene = taken(bench, make_scene("chain", 10), way);
    bench.run(scene, 5, [&](World& world, double) {
        // Ids run from end to end, but for the last link, which is body 1.
        std::vector<BodyId> chain = world.bodies();
        std::rotate(chain.begin() + 1, chain.begin() + 2, chain.end());
        links.look(world, chain);
        return true;
    });
    links.report(bench, "chain of ten, " + std::string(way.name));
}

// Two links through one another, one pulled away at a speed that it is given again before every
// step. One that is kinematic is its triangles and cannot be slowed; one that is not is a solid as
// the other.
Scene pulled_links(const CaseBench& bench, const SolidRepresentationName& way, Motion motion)
{
    Scene scene = begin_scene("links", 2);
    scene.gravity = Vec3::Zero();
    const std::uint32_t link =
        add_shape(scene, "link", mesh_shape(torus_mesh(kLink, kLinkTube, 32, 16)));
    for (const bool pulled : {true, false}) {
        BodyDescription& body = scene.bodies.emplace_back();
        body.shape = link;
        body.material = 0;
        if (pulled) {
            body.motion = motion;
            body.velocity = Vec3(10, 0, 0);
            if (motion == Motion::dynamic) body.drive_velocity = {10.0, 0.0, 0.0};
        } else {
            body.position = Vec3(-0.55, 0, 0);
            body.orientation = turn(Vec3::UnitX(), kPi / 2);
        }
    }
    return taken(bench, std::move(scene), way);
}

void pull_links(CaseBench& bench, const SolidRepresentationName& way)
{
    for (const Motion motion : {Motion::kinematic, Motion::dynamic}) {
        Links links;
        bench.run(pulled_links(bench, way, motion), 1, [&](World& world, double) {
            links.look(world, world.bodies());
            return true;
        });
        const std::string by = motion == Motion::dynamic ? "by a solid, " : "by triangles, ";
        bench.report("link pulled at 10 m/s " + by + std::string(way.name),
                     "steps in which they are not linked", links.parted, 0, "1");
    }
}

// How a bolt came down its nut.
//
//   overlap    m, as the way itself sees it, at eight moments
//   triangles  m, by the triangles of both after every step
struct Descent {
    double way = 0, turns = 0, overlap = 0, triangles = 0;
};

Descent watch_bolt(CaseBench& bench, const Scene& scene)
{
    Descent descent;
    const MeshOverlap meshes(std::get<MeshShape>(scene.shapes[0].shape),
                             std::get<MeshShape>(scene.shapes[1].shape));
    double angle = 0, start = 0, next_look = 0.25;
    bool begun = false;
    int step = 0;
    bench.run(scene, 2, [&](World& world, double now) {
        const Pose pose = world.pose(world.bodies().back());
        const Vec3 x = pose.orientation * Vec3::UnitX();
        const double at = std::atan2(x.y(), x.x());
        if (!begun) start = pose.position.z();
        // Less than half a turn a step.
        descent.turns += begun ? std::remainder(at - angle, 2 * kPi) / (2 * kPi) : 0;
        descent.way = start - pose.position.z();
        angle = at;
        begun = true;
        if (++step % (bench.brief() ? 20 : 1) == 0) {
            const Pose nut = world.pose(world.bodies().front());
            descent.triangles = std::max(descent.triangles, meshes.greatest(seen_from(nut, pose)));
        }
        if (now + 1e-9 >= next_look) {
            next_look += 0.25;
            descent.overlap = std::max(descent.overlap, world.measure().greatest_overlap);
        }
        return true;
    });
    return descent;
}

void turn_bolt(CaseBench& bench, const SolidRepresentationName& way, int image_resolution = 0)
{
    // As the catalogue has it.
    constexpr double kPitch = 0.005, kClearance = 0.00025;
    Scene scene = taken(bench, make_scene("bolt", 1), way);
    scene.settings.dt = 0.01;
    std::string setting = "bolt in nut, " + std::string(way.name);
    const std::string finer = "image_resolution=128";
    if (image_resolution > 0) {
        scene.settings.image_resolution = image_resolution;
        setting += ", " + finer;
    }
    const Descent descent = watch_bolt(bench, scene);
    bench.report(setting, "short of one turn down", std::max(0.0, 1 + descent.turns), 0, "turns");
    // Up and down between flanks that stand at 30 degrees to the way across.
    const double play = 2 * kClearance / std::cos(kPi / 6) / kPitch;
    bench.report(setting, "way against the thread's",
                 std::abs(descent.way / kPitch + descent.turns), play, "turns");
    // What a ray is wide is as much as the play by default.
    const bool coarse = way.name == "depth_image" && image_resolution == 0;
    const auto judge = [&](const char* quantity, double figure) {
        if (coarse)
            bench.report_default(setting, quantity, figure, 0.2 * kClearance, "m", finer);
        else
            bench.report(setting, quantity, figure, 0.2 * kClearance, "m");
    };
    judge("greatest overlap", descent.overlap);
    judge("greatest overlap of the triangles, at any step", descent.triangles);
}

}  // namespace

void case_through_hole(CaseBench& bench)
{
    judge_mass(bench);
    spikes_and_wedges(bench);
    edges_and_cracks(bench);
    for (const SolidRepresentationName& way : kSolidWays)
        if (!bench.brief() || way.name == "voxels" || !way.keeps_holes) drop_over_peg(bench, way);
    if (bench.brief()) {
        pull_links(bench, kSolidWays[0]);
        turn_bolt(bench, kSolidWays[2]);
        return;
    }
    for (const SolidRepresentationName& way : kSolidWays) {
        if (!way.keeps_holes) continue;
        hang_chain(bench, way);
        pull_links(bench, way);
        turn_bolt(bench, way);
    }
    turn_bolt(bench, kSolidWays[3], 128);
}

}  // namespace throng
