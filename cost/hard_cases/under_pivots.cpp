// Under pivots: H117, boxes, balls and cylinders are thrown under bodies that can only turn, with
// next to no lever arm to make way by.
//
// Answer: no energy is made.
//
// Squeezed between the floor and a ball on a pivot near its middle, what comes under it gets out
// only if the ball turns far, and bears great impulses until then; as do capsules in a row that
// overlap end to end. Once arms have turned, these are spin.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/random.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace throng {

namespace {

constexpr double kMade = 2e-3;
constexpr double kSeconds = 10, kBriefSeconds = 3;  // s
constexpr int kSide = 3, kThrown = 30, kDraws = 120, kFewDraws = 20, kBriefDraws = 6;

struct How {
    const char* setting;
    void (*set)(Settings&) = [](Settings&) {};
    int draws = kFewDraws;
    bool locked = false;  // by their middle, else on a pivot beside it
    bool last_first = false;
    Vec3 far = Vec3::Zero();
    Quat turn = Quat::Identity();
};

class Draw {
public:
    Draw(const CaseBench& bench, const How& how, std::uint64_t seed)
        : how_(how), random_(seed), parts_(bench.scene())
    {
        how.set(parts_.scene().settings);
        parts_.scene().gravity = how.turn * Vec3(0, 0, -kGravity);
        material_ = parts_.material(random_.uniform(0, 0.6), random_.uniform(0, 1) < 0.7 ? 0 : 0.3);
        parts_.plane(material_, how.turn * Vec3::UnitZ(), (how.turn * Vec3::UnitZ()).dot(how.far));
        size_ = std::pow(10, random_.uniform(-2, 0));
        half_ = random_.uniform(0.2, 0.9) * size_;
        if (how.last_first) throw_under();
        put_up();
        if (!how.last_first) throw_under();
    }
    const Scene& scene() { return parts_.scene(); }

private:
    Vec3 at(double x, double y, double z) const { return how_.far + how_.turn * Vec3(x, y, z); }

    void add(const decltype(ShapeDescription::shape)& shape, BodyDescription body)
    {
        body.material = material_;
        parts_.add(shape, body);
    }

    // Low enough that what comes under them is pressed in, or nearly.
    void put_up()
    {
        const int kind = static_cast<int>(random_.uniform(0, 3));
        const double lowest = (kind == 0 ? 1 : kind == 1 ? 0.7 : 0.6) * size_;
        decltype(ShapeDescription::shape) shape = SphereShape{size_};
        if (kind == 1) shape = BoxShape{Vec3(lowest, size_, size_)};
        if (kind == 2) shape = CapsuleShape{lowest, size_};
        for (int i = 0; i < kSide * kSide; ++i) {
            const double z = lowest + 2 * half_ * random_.uniform(0.93, 1.02);
            BodyDescription body;
            body.position = at(3 * size_ * (i % kSide), 3 * size_ * (i / kSide), z);
            body.orientation = how_.turn * turn(Vec3::UnitY(), kPi / 2);
            const double beside = size_ * std::pow(10, random_.uniform(-3.5, -0.7));
            const Vec3 way = random_direction(random_);
            if (how_.locked)
                body.lock_position = true;
            else
                body.pivot = beside * way;
            add(shape, body);
        }
    }

    void throw_under()
    {
        const int kind = static_cast<int>(random_.uniform(0, 3));
        decltype(ShapeDescription::shape) shape = SphereShape{half_};
        if (kind == 1) shape = BoxShape{half_ * Vec3(1.5, 1.2, 1)};
        if (kind == 2) shape = CylinderShape{half_, 1.5 * half_};
        const double height = kind == 2 ? 1.6 * half_ : 1.05 * half_;
        for (int i = 0; i < kThrown; ++i) {
            const SinCos from = sin_cos(random_.uniform(0, 2 * kPi));
            const double away = size_ * (12 + 2.4 * i), middle = 3 * size_;
            const double speed =
                random_.uniform(1, 6) * std::sqrt(kGravity * size_) * (1 + 0.1 * i);
            BodyDescription body;
            body.position = at(middle + away * from.cos, middle + away * from.sin, height);
            body.orientation = how_.turn;
            body.velocity = how_.turn * Vec3(-speed * from.cos, -speed * from.sin, 0);
            add(shape, body);
        }
    }

    const How& how_;
    Random random_;
    SceneParts parts_;
    std::uint32_t material_ = 0;
    double size_ = 0, half_ = 0;  // m, of those that only turn, and of those that come under them
};

}  // namespace

void case_under_pivots(CaseBench& bench)
{
    const How hows[] = {
        {.setting = "default", .draws = kDraws},
        {.setting = "default, locked", .draws = kDraws, .locked = true},
        {.setting = "default, dt 1/240", .set = [](Settings& s) { s.dt = 1.0 / 240; }},
        {.setting = "double", .set = [](Settings& s) { s.precision = Precision::double_; }},
        {.setting = "default, last first", .last_first = true},
        {.setting = "default, far off", .far = Vec3(3e6, -2e6, 0)},
        {.setting = "default, turned", .turn = exponential(Vec3(0.29, 0.59, 0.88))},
        {.setting = "16 substeps", .set = [](Settings& s) { s.substeps = 16; }},
        {.setting = "pgs", .set = [](Settings& s) { s.solver = Solver::pgs; }},
    };
    for (const How& how : hows) {
        double worst = 0;
        for (int seed = 0; seed < (bench.brief() ? kBriefDraws : how.draws); ++seed) {
            Draw draw(bench, how, static_cast<std::uint64_t>(seed));
            const double seconds = bench.brief() ? kBriefSeconds : kSeconds;
            worst = std::max(worst, energy_made(bench, draw.scene(), seconds));
        }
        bench.report(how.setting, "energy made, over the greatest in motion", worst, kMade, "1");
        if (bench.brief()) return;
    }
}

}  // namespace throng
