// On ridges: H120, plates that fall on ridges and bars come to lie still.
//
// Answer: what lies on two edges of a floor, with friction, lies still, and no deeper than what it
// weighs makes it.
//
// A ridge touches the face of a plate all along. Told of the two as of edges that cross, it is at
// one point, the deeper end; held there alone the plate turns about it until the other end is the
// deeper one. Ridges are of a sheet of triangles that runs on beyond the plate, and bars boxes that
// stand on an edge, prisms, capsules and cylinders.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <string>

namespace throng {

namespace {

constexpr double kSeconds = 10, kBriefSeconds = 4;
// m/s; in a groove, where what has two places of touch rocks to and fro about the line between
// them, and rightly so; of the plate's thickness
constexpr double kRests = 1e-3, kRocks = 0.5, kSinks = 0.1;
constexpr double kHalf = 0.3, kThick = 0.02;                 // m, half extents of a plate
constexpr double kBar = 0.05, kBarLength = 4, kApart = 0.8;  // m; from plate to plate
// m, from one ridge to the next: plates lie on two or more of them, or in a groove.
constexpr double kNarrow = 0.3, kWide = 0.8;

enum class Floor { sheet, boxes, prisms, capsules, cylinders };
enum class Plate { box, disc, hull };

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
    int draws = 2;
};

struct Ridges {
    Floor of = Floor::sheet;
    double apart = kNarrow, high = 0.02;  // m, from one to the next; of a sheet
};

// Ridges along y, and no corner under most of the plates.
MeshShape sheet_of(const Ridges& ridges)
{
    MeshShape mesh;
    const int half = static_cast<int>(std::ceil(4 * kApart / ridges.apart));
    for (int i = -2 * half; i <= 2 * half; ++i)
        for (const double y : {-1.0, -0.1, 1.0})
            mesh.vertices.emplace_back(0.5 * ridges.apart * i, kBarLength * y,
                                       i % 2 == 0 ? 0 : ridges.high);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(4 * half); ++i)
        for (std::uint32_t k = 0; k < 2; ++k) {
            const std::uint32_t a = 3 * i + k, b = a + 3;
            mesh.triangles.push_back({a, b, b + 1});
            mesh.triangles.push_back({a, b + 1, a + 1});
        }
    return mesh;
}

HullShape prism()
{
    HullShape shape;
    for (const double y : {-kBarLength, kBarLength})
        for (const Vec3& corner : {Vec3(-kBar, y, -kBar), Vec3(kBar, y, -kBar), Vec3(0, y, kBar)})
            shape.points.push_back(corner);
    return shape;
}

void lay_floor(const Ridges& ridges, std::uint32_t material, const Pose& place, SceneParts& parts)
{
    BodyDescription body;
    body.motion = Motion::static_;
    body.material = material;
    const auto put = [&](auto shape, const Pose& at) {
        body.position = (place * at).position;
        body.orientation = (place * at).orientation;
        parts.add(std::move(shape), body);
    };
    if (ridges.of == Floor::sheet) return put(sheet_of(ridges), {});
    const Quat lain = exponential(Vec3(kPi / 2, 0, 0)), on_edge = exponential(Vec3(0, kPi / 4, 0));
    const int half = static_cast<int>(std::ceil(2 * kApart / ridges.apart));
    for (int i = -half; i <= half; ++i) {
        const Vec3 at(ridges.apart * i, 0, 0);
        if (ridges.of == Floor::boxes) put(BoxShape{Vec3(kBar, kBarLength, kBar)}, {at, on_edge});
        if (ridges.of == Floor::prisms) put(prism(), {at, Quat::Identity()});
        if (ridges.of == Floor::capsules) put(CapsuleShape{kBar, kBarLength}, {at, lain});
        if (ridges.of == Floor::cylinders) put(CylinderShape{kBar, kBarLength}, {at, lain});
    }
}

void add_plate(Plate plate, std::uint32_t material, const Pose& at, SceneParts& parts)
{
    BodyDescription body;
    body.material = material;
    body.position = at.position;
    body.orientation = at.orientation;
    if (plate == Plate::box) parts.add(BoxShape{Vec3(kHalf, 0.7 * kHalf, kThick)}, body);
    if (plate == Plate::disc) parts.add(CylinderShape{kHalf, kThick}, body);
    if (plate != Plate::hull) return;
    HullShape shape;
    for (int corner = 0; corner < 6; ++corner)
        for (const double z : {-kThick, kThick})
            shape.points.emplace_back(kHalf * std::cos(kPi / 3 * corner),
                                      kHalf * std::sin(kPi / 3 * corner), z);
    parts.add(std::move(shape), body);
}

// Nine plates, each turned by up to a fifth of a radian about any axis, and about the upright one
// by any angle.
Scene strewn(const CaseBench& bench, const Ridges& ridges, Plate plate, const How& how, int draw)
{
    SceneParts parts(bench.scene());
    Settings& settings = parts.scene().settings;
    how.set(settings);
    settings.sleep = false;
    parts.scene().gravity = how.place.orientation * Vec3(0, 0, -kGravity);
    Random random(static_cast<std::uint64_t>(draw));
    const std::uint32_t material = parts.material(random.below(2) == 0 ? 0.3 : 0.6);
    lay_floor(ridges, material, how.place, parts);
    for (int i = -1; i <= 1; ++i)
        for (int k = -1; k <= 1; ++k) {
            const Vec3 aside = random_vector(random, -0.05, 0.05);
            const Vec3 lean = random_vector(random, -0.2, 0.2);
            const Quat turn = exponential(Vec3(0, 0, random.uniform(0, kPi)));
            const Vec3 at = Vec3(kApart * i, kApart * k + 0.5, ridges.high + 0.2) + aside;
            add_plate(plate, material, how.place * Pose{at, exponential(lean) * turn}, parts);
        }
    return parts.scene();
}

struct Lies {
    double speed = 0, deep = 0;  // m/s; of the thickness
};

Lies lie(CaseBench& bench, const Ridges& ridges, Plate plate, const How& how, int draw)
{
    Lies lies;
    const double seconds = bench.brief() ? kBriefSeconds : kSeconds;
    bench.run(strewn(bench, ridges, plate, how, draw), seconds, [&](World& world, double now) {
        if (now < seconds - 0.5) return true;
        for (const BodyId body : world.bodies())
            lies.speed = std::max(lies.speed, world.velocity(body).norm());
        lies.deep = std::max(lies.deep, world.measure().greatest_overlap / (2 * kThick));
        return true;
    });
    return lies;
}

}  // namespace

void case_on_ridges(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"default, dt 1e-3", [](Settings& s) { s.dt = 1e-3; }, {}, 1},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(700, -300, 0), exponential(Vec3(0.3, 0.6, 0.9))}},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
        {"1 substep", [](Settings& s) { s.substeps = 1; }},
        {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
        {"direct", [](Settings& s) { s.solver = Solver::direct; }},
    };
    constexpr const char* kPlates[] = {"boxes", "discs", "hulls"};
    std::vector<Ridges> floors;
    for (const double apart : {kNarrow, kWide})
        for (const double high : {0.005, 0.02, 0.1}) floors.push_back({Floor::sheet, apart, high});
    for (const Floor of : {Floor::boxes, Floor::prisms, Floor::capsules, Floor::cylinders})
        for (const double apart : {0.12, 0.25}) floors.push_back({of, apart, kBar});
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows)))
        for (const Plate plate : {Plate::box, Plate::disc, Plate::hull}) {
            Lies on_ridges, in_grooves, on_bars;
            for (const Ridges& ridges : floors) {
                if (bench.brief() && ridges.high != 0.02 && ridges.of != Floor::prisms) continue;
                Lies& worst = ridges.of != Floor::sheet ? on_bars
                    : ridges.apart == kWide             ? in_grooves
                                                        : on_ridges;
                for (int draw = 1; draw <= (bench.brief() ? 1 : how.draws); ++draw) {
                    const Lies lies = lie(bench, ridges, plate, how, draw);
                    worst.speed = std::max(worst.speed, lies.speed);
                    worst.deep = std::max(worst.deep, lies.deep);
                }
            }
            // What lands flat may miss the law in a step by 1e-8 and a bit.
            bench.forgive_residual();
            const auto report = [&](const char* where, const Lies& lies, double rests) {
                const std::string of = std::string(kPlates[static_cast<int>(plate)]) + where;
                bench.report(how.setting, of + ": fastest", lies.speed, rests, "m/s");
                bench.report(how.setting, of + ": overlap, over the thickness", lies.deep, kSinks,
                             "1");
            };
            report(" on ridges", on_ridges, kRests);
            report(" in grooves", in_grooves, kRocks);
            report(" on bars", on_bars, kRests);
        }
}

}  // namespace throng
