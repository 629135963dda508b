// Chosen method: every method of the narrow phase carries a heap, on any number of threads alike;
// filters change nothing but the time.
#include "pipeline/world/world_state.hpp"
#include "tests/support/small_scenes.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <string>

namespace throng {
namespace {

using given::hash_after;

constexpr NarrowPhase kMethods[] = {NarrowPhase::gjk, NarrowPhase::sat, NarrowPhase::chung_wang,
                                    NarrowPhase::clip_volume, NarrowPhase::containment};
constexpr MethodStart kStarts[] = {MethodStart::cached, MethodStart::cold, MethodStart::plain};

Scene heap(const char* name, int size, NarrowPhase method, MethodStart start = MethodStart::cached)
{
    Scene scene = make_scene(name, size);
    scene.settings.narrowphase = method;
    scene.settings.method_start = start;
    return scene;
}

class ChosenMethod : public ::testing::TestWithParam<NarrowPhase> { };

TEST_P(ChosenMethod, BringsAHeapToRest)
{
    for (const char* name : {"pile", "hulls"}) {
        Scene scene = heap(name, 60, GetParam());
        scene.settings.sleep = false;
        World world(scene, 2);
        world.step(400);
        const Measures measures = world.measure();
        EXPECT_LT(measures.kinetic_energy, 60 * 0.05) << name;  // J
        EXPECT_LT(measures.mean_overlap, 1.5e-3) << name;       // m
        EXPECT_LT(measures.greatest_overlap, 2e-2) << name;
        EXPECT_GT(world.report().contacts, 60u) << name;
        EXPECT_EQ(world.report().bodies_quarantined, 0u) << name;
    }
}

TEST_P(ChosenMethod, GivesTheSameBitsOnAnyNumberOfThreads)
{
    for (const char* name : {"pile", "hulls", "tumbler"})
        for (const MethodStart start : kStarts) {
            const Scene scene = heap(name, 40, GetParam(), start);
            const std::string wanted = hash_after(scene, 1, 60, true);
            EXPECT_EQ(hash_after(scene, 1, 60), wanted) << name;
            EXPECT_EQ(hash_after(scene, 3, 60), wanted) << name;
        }
}

TEST_P(ChosenMethod, LeavesToAutoWhatItCannotTellAndCountsIt)
{
    const bool tells_where =
        GetParam() != NarrowPhase::chung_wang && GetParam() != NarrowPhase::containment;
    World pile(heap("pile", 40, GetParam()), 2);
    pile.step(120);
    if (tells_where)
        EXPECT_EQ(pile.report().fallbacks, 0u);
    else
        EXPECT_GT(pile.report().fallbacks, 0u);
    World plain(heap("pile", 40, NarrowPhase::auto_), 2);
    plain.step(120);
    EXPECT_EQ(plain.report().fallbacks, 0u);
}

TEST_P(ChosenMethod, ComesAndGoesWithBodiesInMidRun)
{
    World world(heap("hulls", 60, NarrowPhase::auto_), 2);
    for (int round = 0; round < 6; ++round) {
        Settings settings = world.settings();
        settings.narrowphase = round % 2 == 0 ? GetParam() : NarrowPhase::auto_;
        world.set_settings(settings);
        world.step(25);
        const auto bodies = world.bodies();
        const BodyId last[] = {bodies.back(), bodies[bodies.size() / 2]};
        world.remove(last);
        world.step(25);
    }
    EXPECT_EQ(world.report().bodies_quarantined, 0u);
    EXPECT_LT(world.measure().greatest_overlap, 5e-2);
}

INSTANTIATE_TEST_SUITE_P(Methods, ChosenMethod, ::testing::ValuesIn(kMethods));

TEST(BoundsFilter, ChangesNoBit)
{
    for (const char* name : {"pile", "hulls", "spheres", "tumbler"}) {
        const Scene plain = make_scene(name, 100);
        const std::string wanted = hash_after(plain, 1, 100);
        for (const BoundsFilter filter :
             {BoundsFilter::sphere, BoundsFilter::k_dop_6, BoundsFilter::k_dop_14,
              BoundsFilter::k_dop_18, BoundsFilter::k_dop_26}) {
            Scene scene = plain;
            scene.settings.bounds_filter = filter;
            EXPECT_EQ(hash_after(scene, 2, 100), wanted) << name << " " << static_cast<int>(filter);
        }
    }
}

}  // namespace
}  // namespace throng
