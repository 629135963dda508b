// Wobbling: H119, cans, coins and rods that stand on their rim roll round on it, or tip over.
//
// Answer: no energy is made.
//
// The place of touch runs round the rim many times as fast as anything moves. A contact that is
// held for a step where it was found lags behind, and its push turns the body on the way that it
// goes; so does friction in the middle of points of which one bears.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kMade = 2e-2, kMadeAsItTips = 1e-2, kMadeAsItTipsByDirect = 5e-2;
constexpr double kSeconds = 10, kTipSeconds = 4, kBriefSeconds = 3;

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    double made_as_it_tips = kMadeAsItTips;
    bool box = false;  // on a box, else on a plane
    Vec3 far = Vec3::Zero();
    Quat turn = Quat::Identity();
};

struct Can {
    double radius = 0, half_length = 0, tilt = 0, round = 0, friction = 0;  // m, m, rad, rad/s, 1
};

struct Tipping {
    double thick = 0, lean = 0, spin = 0, friction = 0;  // 1, of its length; rad, rad/s, 1
};

// The energy that a can makes which stands on the lowest place of its rim, leaning by an angle.
double stand(CaseBench& bench,
             const How& how,
             const CylinderShape& can,
             double angle,
             const Vec3& angular_velocity,
             double friction,
             double seconds)
{
    SceneParts parts(bench.scene());
    how.set(parts.scene().settings);
    parts.scene().gravity = how.turn * Vec3(0, 0, -kGravity);
    const std::uint32_t material = parts.material(friction, 0);
    if (how.box) {
        BodyDescription floor;
        floor.motion = Motion::static_;
        floor.material = material;
        floor.position = how.far + how.turn * Vec3(0, 0, -1);
        floor.orientation = how.turn;
        parts.add(BoxShape{Vec3(100, 100, 1)}, floor);
    } else {
        const Vec3 up = how.turn * Vec3::UnitZ();
        parts.plane(material, up, up.dot(how.far));
    }
    const Quat lean = exponential(Vec3(0, angle, 0));
    const Vec3 arm = lean * Vec3(can.radius, 0, -can.half_length);
    BodyDescription body;
    body.material = material;
    body.position = how.far + how.turn * Vec3(0, 0, -arm.z());
    body.orientation = how.turn * lean;
    body.angular_velocity = how.turn * angular_velocity;
    parts.add(can, body);
    return energy_made(bench, parts.scene(), bench.brief() ? kBriefSeconds : seconds);
}

// Its middle stays, and so does the place of touch for a moment: it turns about the line through
// both, so fast that its axis goes round as asked.
double wobble(CaseBench& bench, const How& how, const Can& can)
{
    const Quat lean = exponential(Vec3(0, can.tilt, 0));
    const Vec3 axis = lean * Vec3::UnitZ();
    const Vec3 arm = lean * Vec3(can.radius, 0, -can.half_length);
    const double about =
        -can.round * arm.x() / (std::cos(can.tilt) * arm.x() - std::sin(can.tilt) * arm.z());
    return stand(bench, how, {can.radius, can.half_length}, can.tilt,
                 axis * about + Vec3(0, 0, can.round), can.friction, kSeconds);
}

// From beyond where it would stand.
double tip(CaseBench& bench, const How& how, const Tipping& tipping)
{
    const double angle = std::atan(tipping.thick) + tipping.lean;
    return stand(bench, how, {tipping.thick, 1}, angle,
                 exponential(Vec3(0, angle, 0)) * Vec3(0, 0, tipping.spin), tipping.friction,
                 kTipSeconds);
}

double worst_wobble(CaseBench& bench, const How& how)
{
    const Can shapes[] = {{0.84, 0.98}, {1, 0.1}, {0.5, 1}, {1, 0.02}};
    double worst = 0;
    for (const Can& can : shapes)
        for (const double size : {0.02, 1.0})
            for (const double tilt : {0.05, 0.3, 0.7, 1.1})
                for (const double round : {1.0, 2.0, 4.0, 8.0})
                    for (const double friction : {0.3, 1.0}) {
                        if (bench.brief() && (round != 4 || tilt != 0.3)) continue;
                        worst = std::max(worst,
                                         wobble(bench, how,
                                                {can.radius * size, can.half_length * size, tilt,
                                                 round / std::sqrt(size), friction}));
                    }
    return worst;
}

double worst_tip(CaseBench& bench, const How& how)
{
    double worst = 0;
    for (const double thick : {0.03, 0.1, 0.3, 1.0, 3.0})
        for (const double lean : {0.02, 0.1, 0.3})
            for (const double spin : {0.0, 3.0, 20.0})
                for (const double friction : {0.0, 0.3, 1.0}) {
                    if (bench.brief() && lean != 0.1) continue;
                    worst = std::max(worst, tip(bench, how, {thick, lean, spin, friction}));
                }
    return worst;
}

}  // namespace

void case_wobbling(CaseBench& bench)
{
    const How hows[] = {
        {.setting = "default"},
        {.setting = "default, on a box", .box = true},
        {.setting = "default, dt 1/240", .set = [](Settings& s) { s.dt = 1.0 / 240; }},
        {.setting = "default, dt 1e-3", .set = [](Settings& s) { s.dt = 1e-3; }},
        {.setting = "default, far off", .far = Vec3(3e6, -2e6, 0)},
        {.setting = "default, turned", .turn = exponential(Vec3(0.29, 0.59, 0.88))},
        {.setting = "double", .set = [](Settings& s) { s.precision = Precision::double_; }},
        {.setting = "16 substeps", .set = [](Settings& s) { s.substeps = 16; }},
        {.setting = "1 substep", .set = [](Settings& s) { s.substeps = 1; }},
        {.setting = "pgs", .set = [](Settings& s) { s.solver = Solver::pgs; }},
        {.setting = "direct",
         .set = [](Settings& s) { s.solver = Solver::direct; },
         .made_as_it_tips = kMadeAsItTipsByDirect},
    };
    for (const How& how : hows) {
        const double wobbled = worst_wobble(bench, how), tipped = worst_tip(bench, how);
        // Coins that slap down at meters a second may miss the law in a step by 1e-8 and a bit.
        bench.forgive_residual();
        const char* const made = "energy made, over the greatest in motion";
        bench.report(how.setting, made, wobbled, kMade, "1");
        bench.report(how.setting, std::string("tips over: ") + made, tipped, how.made_as_it_tips,
                     "1");
        if (bench.brief()) return;
    }
}

}  // namespace throng
