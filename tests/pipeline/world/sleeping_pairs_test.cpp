// Sleeping pairs: a step that does not go through them leaves the same bits as one that goes
// through all.
#include "pipeline/world/world_state.hpp"
#include "tests/support/solid_scenes.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

using given::SceneOf;
using given::tetrahedron;

// Little heaps beside one another, of every kind of pair, on all kinds of floor; a ball that rolls
// through them, bodies that fall on them later, and a shelf.
Scene heaps()
{
    SceneOf made;
    made.scene.materials[0].rolling_friction = 0.02;
    made.floor();
    made.box(Vec3(1, 1, 0.1), Vec3(3, 0, 0.1)).motion = Motion::static_;
    made.box(Vec3(1, 1, 0.1), Vec3(5, 0, 0.1)).motion = Motion::static_;
    const std::uint32_t hull = made.shape(HullShape{tetrahedron(0.25).vertices});
    const std::uint32_t mesh = made.shape(given::mesh_of(
        given::block_under([](double x, double y) { return 0.05 * (x * x + y * y); }, 6, 0.5)));
    made.body(mesh, Vec3(0, 4, 0)).motion = Motion::static_;
    const std::uint32_t ring = made.shape(given::mesh_of(torus_mesh(0.3, 0.12, 12, 6)));
    for (int heap = 0; heap < 4; ++heap) {
        const Vec3 at(heap % 2 * 4.0, heap / 2 * 4.0, heap == 0 ? 0 : 0.25);
        made.box(Vec3(0.3, 0.3, 0.2), at + Vec3(0, 0, 0.21));
        made.box(Vec3(0.2, 0.3, 0.2), at + Vec3(0.05, 0, 0.62));
        made.box(Vec3(0.2, 0.2, 0.2), at + Vec3(0.56, 0.05, 0.21));
        made.ball(0.2, at + Vec3(-0.6, 0.1, 0.3));
        made.body(made.shape(CapsuleShape{0.15, 0.2}), at + Vec3(-0.6, -0.6, 0.4));
        made.body(hull, at + Vec3(0.1, 0.8, 0.5));
        made.body(hull, at + Vec3(0.6, 0.8, 0.5));
    }
    for (int i = 0; i < 2; ++i) made.body(ring, Vec3(0.1 * i, 4.1, 1.0 + 0.4 * i));
    BodyDescription& roller = made.ball(0.35, Vec3(-4, 0.1, 0.35));
    roller.velocity = Vec3(1.6, 0, 0);
    roller.angular_velocity = Vec3(0, 1.6 / 0.35, 0);
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(4.1, 4.1, 40));
    made.scene.settings.voxel_size = 0.08;
    return made.scene;
}

// What a program may do meanwhile, to sleepers above all.
void edit(World& world, int step)
{
    const std::vector<BodyId> bodies = world.bodies();
    if (step == 130) world.set_pose(bodies[6], {Vec3(0.6, 0.05, 0.25), Quat::Identity()});
    if (step == 150) world.remove(std::span(&bodies[2], 1));  // from below a heap
    if (step == 160) world.set_velocity(bodies[20], Vec3(0, 0, 1), Vec3::Zero());
    if (step == 210) {
        SceneOf more;
        more.ball(0.2, Vec3(3.6, 0.1, 3));
        more.box(Vec3(0.5, 0.5, 0.5), Vec3(0.2, 6, 0.5)).motion = Motion::static_;
        world.add(more.scene);
    }
    if (step == 230) {
        Settings settings = world.settings();
        settings.substeps = settings.substeps == 4 ? 5 : 4;
        world.set_settings(settings);
    }
    if (step == 250) world.set_pose(bodies[1], {Vec3(3.1, 0, 0.1), Quat::Identity()});
    if (step == 270) world.remove(std::span(&bodies[0], 1));
}

struct How {
    const char* name;
    void (*set)(Settings&);
};

std::ostream& operator<<(std::ostream& out, const How& how) { return out << how.name; }

struct Outcome {
    std::string hash;
    std::size_t pairs = 0, gone_through = 0;
    std::vector<Vec3> forces;
};

Outcome after(const How& how, int steps, bool all_pairs)
{
    Scene scene = heaps();
    how.set(scene.settings);
    World world(scene, 2);
    Outcome outcome;
    for (int step = 0; step < steps; ++step) {
        edit(world, step);
        if (all_pairs) static_cast<void>(world.state_hash());
        world.step();
    }
    outcome.gone_through = state_of(world).get<Pairs>().keys.size();
    outcome.pairs = world.report().pairs;
    for (const BodyId body : world.bodies()) outcome.forces.push_back(world.contact_force(body));
    outcome.hash = world.state_hash();
    return outcome;
}

class SleepingPairs : public ::testing::TestWithParam<How> { };

TEST_P(SleepingPairs, AreAsGoodAsGoneThrough)
{
    double fewest = 1;  // share of the pairs
    for (const int steps : {100, 140, 180, 248, 260, 300, 420}) {
        const Outcome apart = after(GetParam(), steps, false);
        const Outcome all = after(GetParam(), steps, true);
        EXPECT_EQ(apart.hash, all.hash) << steps << " steps";
        EXPECT_EQ(apart.pairs, all.pairs) << steps << " steps";
        ASSERT_EQ(apart.forces.size(), all.forces.size());
        for (std::size_t i = 0; i < all.forces.size(); ++i)
            EXPECT_NEAR((apart.forces[i] - all.forces[i]).norm(), 0, 1e-9 * all.forces[i].norm());
        EXPECT_EQ(all.gone_through, all.pairs);
        fewest = std::min(fewest, double(apart.gone_through) / double(all.gone_through));
    }
    EXPECT_LT(fewest, 0.5);
}

INSTANTIATE_TEST_SUITE_P(
    Settings,
    SleepingPairs,
    ::testing::Values(How{"default", [](Settings&) {}},
                      How{"doubles", [](Settings& s) { s.precision = Precision::double_; }},
                      How{"gjk", [](Settings& s) { s.narrowphase = NarrowPhase::gjk; }},
                      How{"spheres",
                          [](Settings& s) {
                              s.nonconvex = NonConvex::spheres;
                              s.sphere_levels = 2;
                          }},
                      How{"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
                      How{"partial_rest", [](Settings& s) { s.partial_rest = true; }}),
    ::testing::PrintToStringParamName());

}  // namespace
}  // namespace throng
