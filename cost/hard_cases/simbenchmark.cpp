// SimBenchmark: H102, the published tasks at the published steps, and no more error than the best
// engine there.
//
// Bounds are the least errors of any engine in SimBenchmark's tables, whatever its solver took for
// them: data/rolling, bouncing, 666 and 666-elastic/sample.csv, and for rolling by iterations the
// figures of its page. Bullet, ODE, MuJoCo, DART and RaiSim are in them.
//
// Source: Kang and Hwangbo, SimBenchmark (leggedrobotics), 2018.
#include "cost/answers/answers.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace throng {

namespace {

/// What a task is run with.
///
///   name  as lines tell it; empty: the default dials
struct Way {
    const char* name;
    void (*set)(Settings& settings);
};

const Way kDefault = {"", [](Settings&) {}};
const Way kDirect = {"solver=direct, precision=double, substeps=1", ask_exactly};
const Way kFortyIterations = {"solver=pgs, iterations=40, precision=double, substeps=1",
                              [](Settings& settings) {
                                  ask_exactly(settings);
                                  settings.solver = Solver::pgs;
                                  settings.iterations = 40;
                              }};
// The step is cut at every touch. With the tolerance by default, 1e-4, one impact in many comes in
// so slowly that it is taken for rest.
const Way kBackUp = {
    "overlap=back_up, integrator=midpoint, precision=double, substeps=1, toi_tolerance=1e-5",
    [](Settings& settings) {
        settings.overlap = Overlap::back_up;
        settings.integrator = Integrator::midpoint;
        settings.precision = Precision::double_;
        settings.substeps = 1;
        settings.toi_tolerance = 1e-5;
    }};

/// The least published error of a scene at a step, of any engine, and what throng has there.
///
///   met_by   for a line about the default: the way of the same scene and step that meets it
///   seconds  of a brief run
struct Point {
    const char* scene;
    double dt, published;
    const Way& way;
    const Way* met_by;
    double seconds;
    bool brief;
};

const Point kPoints[] = {
    // By iterations, pulled aslant: Bullet with 400 and more, and with 40.
    {"rolling", 1e-3, 3.9e-27, kDirect, nullptr, 0.1, true},
    {"rolling", 1e-3, 4.4e-15, kFortyIterations, nullptr, 0.1, true},
    {"rolling", 1e-2, 7.54888e-9, kDirect, nullptr, 0.2, true},
    {"rolling", 1e-3, 6.42665e-9, kDefault, &kDirect, 0.1, true},
    {"rolling", 1e-2, 7.54888e-9, kDefault, &kDirect, 0.2, true},

    {"bouncing", 1e-4, 1.86413e-6, kBackUp, nullptr, 0, false},
    {"bouncing", 1e-3, 0.0186204, kBackUp, nullptr, 1.5, true},
    {"bouncing", 1e-2, 63.1893, kBackUp, nullptr, 3, true},
    {"bouncing", 1e-1, 557224, kBackUp, nullptr, 3, true},
    {"bouncing", 1e-4, 1.86413e-6, kDefault, &kBackUp, 0, false},
    {"bouncing", 1e-3, 0.0186204, kDefault, &kBackUp, 3, true},
    {"bouncing", 1e-2, 63.1893, kDefault, &kBackUp, 3, true},
    {"bouncing", 1e-1, 557224, kDefault, &kBackUp, 3, true},

    {"ball_cube", 1e-4, 1.54658e-6, kDefault, nullptr, 0, false},
    {"ball_cube", 1e-3, 1.3534e-4, kDefault, nullptr, 0.3, true},
    {"ball_cube", 1e-2, 0.0152745, kDefault, nullptr, 1, true},
    {"ball_cube", 1e-1, 0.961629, kDefault, nullptr, 3, true},

    {"elastic_ball_cube", 1e-4, 1.10304e-3, kBackUp, nullptr, 0, false},
    {"elastic_ball_cube", 1e-3, 8.36835, kBackUp, nullptr, 0.6, true},
    {"elastic_ball_cube", 1e-2, 5.18417e6, kBackUp, nullptr, 0.6, true},
    {"elastic_ball_cube", 1e-1, 1.88435e7, kBackUp, nullptr, 0.6, true},
    {"elastic_ball_cube", 1e-4, 1.10304e-3, kDefault, &kBackUp, 0, false},
    {"elastic_ball_cube", 1e-3, 8.36835, kDefault, &kBackUp, 1, true},
    {"elastic_ball_cube", 1e-2, 5.18417e6, kDefault, &kBackUp, 2, true},
    {"elastic_ball_cube", 1e-1, 1.88435e7, kDefault, &kBackUp, 2, true},
};

// The published size, seed and step; nobody sleeps.
Scene published(const CaseBench& bench, const char* name, double dt, const Way& way)
{
    Scene scene = make_scene(name, find_scene(name)->default_size, 42);
    scene.settings = bench.settings();
    scene.settings.sleep = false;
    scene.settings.dt = dt;
    way.set(scene.settings);
    return scene;
}

void run_point(CaseBench& bench, const Point& point)
{
    const SceneAnswer& answer = *find_answer(point.scene);
    const Scene scene = published(bench, point.scene, point.dt, point.way);
    RunError error(answer, scene);
    bench.run(scene, bench.brief() ? point.seconds : answer.time, [&](World& world, double now) {
        error.add(now, peer_states(world));
        return true;
    });
    const bool by_default = *point.way.name == '\0';
    char name[160];
    std::snprintf(name, sizeof name, "%s, dt %g, %s", point.scene, point.dt,
                  by_default ? "default" : point.way.name);
    const std::string quantity = "mean " + std::string(answer.quantity);
    const std::string unit(answer.unit);
    if (point.met_by != nullptr)
        bench.report_default(name, quantity, error.mean(), point.published, unit,
                             point.met_by->name);
    else
        bench.report(name, quantity, error.mean(), point.published, unit);
    bench.report_time(name, "time a step", bench.time_a_step());
}

// The tower of which published engines count the steps: Bullet 24 to 147 without ERP and 20,246
// with it, ODE up to 6,453, MuJoCo 3,297, DART 19, RaiSim 60,000 by 1,000 iterations, which is
// where counting ends. Its last plank tells that it has come down.
void kapla(CaseBench& bench)
{
    const Scene scene = published(bench, "kapla", 0.01, kDefault);
    const int steps = bench.brief() ? 20 : 60000;
    const double falls = scene.bodies.back().position.z() - 0.15;
    int stood = 0;
    double drift = 0;
    bench.run(scene, steps * scene.settings.dt, [&](World& world, double) {
        const std::vector<BodyId> ids = world.bodies();
        for (std::size_t i = 1; i < ids.size(); ++i)
            drift =
                std::max(drift, (world.pose(ids[i]).position - scene.bodies[i].position).norm());
        if (!(world.pose(ids.back()).position.z() > falls)) return false;
        ++stood;
        return true;
    });
    const char* const name = "kapla, dt 0.01, default";
    bench.report(name, "steps short of " + std::to_string(steps), steps - stood, 0, "1");
    bench.show(name, "greatest drift of any", drift, "m");
    bench.report_time(name, "time a step", bench.time_a_step());
}

}  // namespace

void case_simbenchmark(CaseBench& bench)
{
    for (const Point& point : kPoints)
        if (point.brief || !bench.brief()) run_point(bench, point);
    kapla(bench);
}

}  // namespace throng
