// Unlike stacks: H109, what a user puts on one another by hand comes to rest: boxes, cylinders and
// prisms, each turned and put aside by chance, and of any mass.
//
// Of two faces with many corners between them four points are chosen. Where those change as a body
// leans, the load stands now on the one four and now on the other, and nothing comes to rest.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/random.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace throng {

namespace {

constexpr double kLight = 30;      // kg, about the middle of masses
constexpr double kAcross = 0.4;    // m, radius of cylinders and prisms
constexpr double kResting = 1e-3;  // m/s
constexpr double kBound = 0.02;    // share of stacks
constexpr double kLow = 0.05;      // of its height, by which what fell is lower at least

constexpr char kPgs[] = "pgs", kExactly[] = "direct, double";

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
    bool from_above = false;
};

enum Kind { kBox, kCylinder, kPrism, kAny };
constexpr const char* kKindNames[] = {"boxes", "cylinders", "prisms", "all kinds"};

HullShape prism(int sides, double half_height)
{
    HullShape hull;
    for (int i = 0; i < sides; ++i) {
        const SinCos at = sin_cos(2 * kPi * i / sides);
        for (const double z : {-half_height, half_height})
            hull.points.push_back(Vec3(kAcross * at.cos, kAcross * at.sin, z));
    }
    return hull;
}

decltype(ShapeDescription::shape) shape_of(Kind kind, double half_height, Random& random)
{
    if (kind == kAny) kind = static_cast<Kind>(random.below(3));
    if (kind == kCylinder) return CylinderShape{kAcross, half_height};
    if (kind == kPrism) {
        constexpr int kSides[] = {5, 6, 8, 12};
        return prism(kSides[random.below(4)], half_height);
    }
    const double long_half = random.uniform(0.3, 0.5), wide_half = random.uniform(0.3, 0.5);
    return BoxShape{Vec3(long_half, wide_half, half_height)};
}

class Stack {
public:
    Stack(CaseBench& bench, const How& how) : parts_(bench.scene()), how_(how)
    {
        Scene& scene = parts_.scene();
        how.set(scene.settings);
        material_ = parts_.material(0.5);
        const Vec3 up = how.place.orientation * Vec3::UnitZ();
        scene.gravity = -kGravity * up;
        parts_.plane(material_, up, up.dot(how.place.position));
    }

    void add(decltype(ShapeDescription::shape) shape,
             double half_height,
             const Vec3& aside,
             double turn,
             double mass)
    {
        Scene& scene = parts_.scene();
        scene.shapes.push_back({"body" + std::to_string(scene.shapes.size()), std::move(shape)});
        BodyDescription& body = scene.bodies.emplace_back();
        body.shape = static_cast<std::uint32_t>(scene.shapes.size() - 1);
        body.material = material_;
        body.mass = mass;
        // A hair over what it comes to lie on.
        const Pose at{aside + Vec3(0, 0, top_ + half_height + 5e-4), exponential(Vec3(0, 0, turn))};
        body.position = how_.place * at.position;
        body.orientation = how_.place.orientation * at.orientation;
        middle_of_top_ = top_ + half_height;
        top_ += 2 * half_height;
    }

    // Whether it is still in motion after 10 s, or lies lower than it was made.
    bool is_restless(CaseBench& bench)
    {
        Scene& scene = parts_.scene();
        if (how_.from_above) std::reverse(scene.bodies.begin() + 1, scene.bodies.end());
        double square = 0, low = 0;
        bench.run(scene, bench.brief() ? 6 : 10, [&](World& world, double) {
            double mass = 0, highest = 0;
            square = 0;
            for (const BodyId body : world.bodies()) {
                if (world.motion(body) != Motion::dynamic) continue;
                mass += world.mass(body);
                square += world.mass(body) * world.velocity(body).squaredNorm();
                highest = std::max(highest, how_.place.to_local(world.pose(body).position).z());
            }
            square /= mass;
            low = middle_of_top_ - highest;
            return true;
        });
        return square > kResting * kResting || low > kLow * top_;
    }

private:
    SceneParts parts_;
    const How& how_;
    std::uint32_t material_ = 0;
    double top_ = 0, middle_of_top_ = 0;  // m
};

// Two to four of a kind, masses up to `ratio` from the middle on either side.
bool mixed(CaseBench& bench, const How& how, Kind kind, double ratio, std::uint64_t draw)
{
    Random random(draw);
    Stack stack(bench, how);
    const std::uint32_t levels = 2 + random.below(3);
    for (std::uint32_t i = 0; i < levels; ++i) {
        const double half_height = random.uniform(0.1, 0.3);
        auto shape = shape_of(kind, half_height, random);
        const double x = random.uniform(-0.06, 0.06), y = random.uniform(-0.06, 0.06);
        const double turn = random.uniform(0, 2 * kPi);
        const double mass = kLight * std::pow(ratio, random.uniform(-1, 1));
        stack.add(std::move(shape), half_height, Vec3(x, y, 0), turn, mass);
    }
    return stack.is_restless(bench);
}

// A box so many times as heavy as the one that it lies on, anywhere on it.
bool aside(CaseBench& bench, const How& how, double ratio, std::uint64_t draw)
{
    const Vec3 half(0.346, 0.595, 0.268);
    Random random(draw);
    Stack stack(bench, how);
    stack.add(BoxShape{half}, half.z(), Vec3::Zero(), 0, kLight);
    const double x = random.uniform(-0.9, 0.9), y = random.uniform(-0.9, 0.9);
    const double turn = random.uniform(0, kPi);
    stack.add(BoxShape{half}, half.z(), Vec3(x * half.x(), y * half.y(), 0), turn, ratio * kLight);
    return stack.is_restless(bench);
}

}  // namespace

void case_unlike_stacks(CaseBench& bench)
{
    const Pose turned{Vec3(700, -300, 50), exponential(Vec3(0.3, -0.5, 0.7))};
    const How hows[] = {
        {"default"},
        {"default, dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
        {kPgs, [](Settings& s) { s.solver = Solver::pgs; }},
        {kExactly, ask_exactly},
        {"default, turned, far off", [](Settings&) {}, turned},
        {"default, made from above", [](Settings&) {}, {}, true},
    };
    // What iterations do not all bring to rest, exact solves do.
    const auto tell = [&](const How& how, const std::string& what, bool in_all, double share) {
        const std::string setting = std::string(how.setting) + ", " + what;
        constexpr char kQuantity[] = "share that moves after 10 s, or fell";
        const bool is_met = in_all && std::string_view(how.setting) != kPgs;
        bench.report_default(setting, kQuantity, share, kBound, "1", is_met ? "" : kExactly);
    };
    for (const How& how : hows) {
        const std::uint64_t draws = bench.brief() ? 2 : 20;
        for (const Kind kind : {kBox, kCylinder, kPrism, kAny}) {
            double restless = 0, count = 0;
            for (const double ratio : {1.0, 3.0, 10.0})
                for (std::uint64_t draw = 0; draw < draws; ++draw) {
                    restless += mixed(bench, how, kind, ratio, draw) ? 1 : 0;
                    ++count;
                }
            tell(how, kKindNames[kind], kind == kBox, restless / count);
        }
        double restless = 0, count = 0;
        for (const double ratio : {3.0, 10.0, 30.0, 100.0, 1000.0})
            for (std::uint64_t draw = 0; draw < draws; ++draw) {
                restless += aside(bench, how, ratio, draw) ? 1 : 0;
                ++count;
            }
        tell(how, "1:3 to 1:1000 aside", true, restless / count);
        if (bench.brief()) break;
    }
}

}  // namespace throng
