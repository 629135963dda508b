// Piles of coins: H122, what is stacked high beside its thickness, and many light ones that bear
// somebody heavy together, stand.
//
// Answer: where they were built, but for what their load makes them give.
//
// In a step of 1/60 s a coin falls by more than its thickness, so that a pile has to bear itself
// within a few substeps: one of ten coins sinks into itself by the usual ones. A plate on a hundred
// balls is borne by each a little, and they take many iterations to share what lies on it.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "throng/rotation.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace throng {

namespace {

constexpr double kSeconds = 5, kBriefSeconds = 2;
constexpr double kRadius = 0.012, kHalf = 0.001;             // m, of a coin
constexpr double kBall = 0.05, kHeavyBall = 0.4;             // m, radii
constexpr double kRests = 1e-3, kMoved = 0.25, kDeep = 0.1;  // m/s; of the thickness
constexpr const char* kMetBy = "dt 1/240";

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    Pose place = {};
};

struct Built {
    const char* name;
    Scene scene;
    double thickness;  // m, of what is stacked
};

class Builder {
public:
    Builder(const CaseBench& bench, const How& how) : parts_(bench.scene()), place_(how.place)
    {
        how.set(parts_.scene().settings);
        parts_.scene().settings.sleep = false;
        parts_.scene().gravity = place_.orientation * Vec3(0, 0, -kGravity);
        body_.material = parts_.material(0.3);
        body_.motion = Motion::static_;
        put(PlaneShape{}, Vec3::Zero());
        body_.motion = Motion::dynamic;
    }
    template <class Shape>
    void put(Shape shape, const Vec3& at, std::optional<double> mass = {})
    {
        body_.position = place_.position + place_.orientation * at;
        body_.orientation = place_.orientation;
        body_.mass = mass;
        parts_.add(std::move(shape), body_);
    }
    Scene& scene() { return parts_.scene(); }

private:
    SceneParts parts_;
    Pose place_;
    BodyDescription body_;
};

Scene piles(const CaseBench& bench, const How& how, int across, int high)
{
    Builder builder(bench, how);
    for (int i = 0; i < across * across; ++i)
        for (int k = 0; k < high; ++k)
            builder.put(CylinderShape{kRadius, kHalf},
                        {0.1 * (i % across), 0.1 * (i / across), kHalf * (2 * k + 1)},
                        8000 * kPi * kRadius * kRadius * 2 * kHalf);
    return builder.scene();
}

// 1 t on 58 kg on 100 times half a kilogram.
Scene on_balls(const CaseBench& bench, const How& how)
{
    Builder builder(bench, how);
    for (int i = 0; i < 100; ++i)
        builder.put(SphereShape{kBall}, {2 * kBall * (i % 10), 2 * kBall * (i / 10), kBall});
    const double middle = 9 * kBall;
    builder.put(BoxShape{Vec3(0.6, 0.6, 0.02)}, {middle, middle, 2 * kBall + 0.02});
    builder.put(SphereShape{kHeavyBall}, {middle, middle, 2 * kBall + 0.04 + kHeavyBall + 0.5},
                1000);
    return builder.scene();
}

struct Stands {
    double speed = 0, moved = 0, deep = 0;  // m/s; of the thickness
};

Stands stand(CaseBench& bench, const Built& built, bool falls)
{
    Stands stands;
    const double seconds = bench.brief() ? kBriefSeconds : kSeconds;
    bench.run(built.scene, seconds, [&](World& world, double now) {
        if (now < seconds - 0.1) return true;
        const std::vector<BodyId> bodies = world.bodies();
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            stands.speed = std::max(stands.speed, world.velocity(bodies[i]).norm());
            const Vec3 off = world.pose(bodies[i]).position - built.scene.bodies[i].position;
            if (!falls) stands.moved = std::max(stands.moved, off.norm() / built.thickness);
        }
        stands.deep = std::max(stands.deep, world.measure().greatest_overlap / built.thickness);
        return true;
    });
    return stands;
}

}  // namespace

void case_piles_of_coins(CaseBench& bench)
{
    const How hows[] = {
        {"default"},
        {"dt 1/240", [](Settings& s) { s.dt = 1.0 / 240; }},
        {"default, turned, far off",
         [](Settings&) {},
         {Vec3(7, -3, 0), exponential(Vec3(0.3, 0.6, 0.9))}},
        {"double", [](Settings& s) { s.precision = Precision::double_; }},
        {"16 substeps", [](Settings& s) { s.substeps = 16; }},
    };
    for (const How& how : std::span(hows).first(bench.brief() ? 1 : std::size(hows))) {
        std::vector<Built> all;
        const double thick = 2 * kHalf;
        all.push_back({"a pile of 10 coins", piles(bench, how, 1, 10), thick});
        all.push_back({"1 t on a plate on 100 balls", on_balls(bench, how), 2 * kBall});
        if (!bench.brief()) {
            all.push_back({"9 piles of 30 coins", piles(bench, how, 3, 30), thick});
            all.push_back({"a pile of 100 coins", piles(bench, how, 1, 100), thick});
        }
        for (const Built& built : all) {
            const bool falls = built.thickness > thick;
            const Stands stands = stand(bench, built, falls);
            bench.forgive_residual();
            const std::string of = std::string(built.name) + ": ";
            // What is more than a step's budget of finer substeps holds sways.
            const char* const met_by = built.scene.bodies.size() == 101 ? kMetBy : "";
            bench.report_default(how.setting, of + "fastest", stands.speed, kRests, "m/s", met_by);
            bench.report(how.setting, of + "overlap, over the thickness", stands.deep, kDeep, "1");
            if (!falls)
                bench.report_default(how.setting, of + "moved, over the thickness", stands.moved,
                                     kMoved, "1", met_by);
        }
    }
}

}  // namespace throng
