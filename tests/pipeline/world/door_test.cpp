// Door: one call at a time is let into a world; who comes in the middle of another is told so.
#include "tests/support/small_scenes.hpp"
#include "throng/queries.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <mutex>
#include <thread>

namespace throng {
namespace {

Scene two_boxes()
{
    given::SceneOf made;
    made.floor();
    for (const int i : {0, 1}) made.box(Vec3::Constant(0.5), Vec3(3 * i, 0, 0.5));
    return made.scene;
}

struct Call {
    const char* name;
    std::function<void(World&, BodyId)> make;
};

const Vec3 kAnything(1, 1, 1);

// What changes a world, or makes something of it and keeps that.
const Call kChanges[] = {
    {"add", [](World& world, BodyId) { world.add(two_boxes()); }},
    {"remove", [](World& world, BodyId body) { world.remove(std::span(&body, 1)); }},
    {"step", [](World& world, BodyId) { world.step(); }},
    {"set_settings", [](World& world, BodyId) { world.set_settings(world.settings()); }},
    {"set_gravity", [](World& world, BodyId) { world.set_gravity(kAnything); }},
    {"set_force_field", [](World& world, BodyId) { world.set_force_field({}); }},
    {"set_pose", [](World& world, BodyId body) { world.set_pose(body, {}); }},
    {"set_velocity",
     [](World& world, BodyId body) { world.set_velocity(body, kAnything, kAnything); }},
    {"write_state", [](World& world, BodyId body) { world.write_state(std::span(&body, 1), {}); }},
    {"add_impulse", [](World& world, BodyId body) { world.add_impulse(body, kAnything); }},
    {"add_force", [](World& world, BodyId body) { world.add_force(body, kAnything, kAnything); }},
    {"add_torque", [](World& world, BodyId body) { world.add_torque(body, kAnything); }},
    {"move_to", [](World& world, BodyId body) { world.move_to(body, {}, 1); }},
    {"wake", [](World& world, BodyId body) { world.wake(body); }},
    {"sleep", [](World& world, BodyId body) { world.sleep(body); }},
    {"set_motion", [](World& world, BodyId body) { world.set_motion(body, Motion::static_); }},
    {"set_mass", [](World& world, BodyId body) { world.set_mass(body, 3); }},
    {"set_filter", [](World& world, BodyId body) { world.set_filter(body, 1, 2); }},
    {"set_sensor", [](World& world, BodyId body) { world.set_sensor(body, true); }},
    {"set_user_data", [](World& world, BodyId body) { world.set_user_data(body, 7); }},
    {"listen", [](World& world, BodyId) { world.listen({.touches = true}); }},
    {"leave_out", [](World& world, BodyId) { world.leave_out({}); }},
    {"run_in_order", [](World& world, BodyId) { world.run_in_order(true); }},
};
const Call kLooks[] = {
    {"pose", [](World& world, BodyId body) { world.pose(body); }},
    {"velocity", [](World& world, BodyId body) { world.velocity(body); }},
    {"bodies", [](World& world, BodyId) { world.bodies(); }},
    {"contacts", [](World& world, BodyId) { world.contacts(); }},
    {"events", [](World& world, BodyId) { world.events(); }},
    {"measure", [](World& world, BodyId) { world.measure(); }},
    {"state_hash", [](World& world, BodyId) { world.state_hash(); }},
    {"stored_state", [](World& world, BodyId) { world.stored_state(); }},
};

std::string refusal_of(const std::function<void()>& call)
{
    try {
        call();
    } catch (const std::logic_error& error) {
        return error.what();
    }
    return {};
}

std::string within_step(const Call& call)
{
    return std::string(call.name) + ": the world is within step(); call it once that has returned,"
        + " and from one thread at a time";
}

TEST(Door, LetsNobodyInFromWhatAStepCalls)
{
    std::vector<Call> calls(std::begin(kChanges), std::end(kChanges));
    calls.insert(calls.end(), std::begin(kLooks), std::end(kLooks));
    for (const int threads : {1, 2}) {
        World world(two_boxes(), threads), other(two_boxes(), threads);
        const BodyId body = world.bodies().back();
        std::mutex mutex;
        std::vector<std::string> refusals(calls.size());
        world.set_force_field([&](const FieldPlace&) {
            const std::lock_guard lock(mutex);
            for (std::size_t i = 0; i < calls.size(); ++i)
                refusals[i] = refusal_of([&] { calls[i].make(world, body); });
            return Wrench{};
        });
        other.set_force_field([](const FieldPlace&) { return Wrench{}; });
        for (World* const one : {&world, &other}) one->step();
        for (std::size_t i = 0; i < calls.size(); ++i)
            EXPECT_EQ(refusals[i], within_step(calls[i]));
        // What was refused has changed nothing.
        for (World* const one : {&world, &other}) {
            one->set_force_field({});
            one->step(3);
        }
        EXPECT_EQ(world.state_hash(), other.state_hash());
    }
}

TEST(Door, LetsNobodyInFromAnotherThread)
{
    World world(two_boxes());
    const BodyId body = world.bodies().back();
    Queries queries(world);
    std::promise<void> within, asked;
    world.set_force_field([&, first = true](const FieldPlace&) mutable {
        if (std::exchange(first, false)) {
            within.set_value();
            asked.get_future().wait();
        }
        return Wrench{};
    });
    std::thread stepping([&] { world.step(); });
    within.get_future().wait();
    for (const Call& call : kChanges)
        EXPECT_EQ(refusal_of([&] { call.make(world, body); }), within_step(call));
    EXPECT_EQ(refusal_of([&] {
                  queries.cast_ray({Vec3(0, 0, 9), Vec3(0, 0, -1)});
              }),
              within_step({"cast_rays", {}}));
    asked.set_value();
    stepping.join();
    EXPECT_EQ(world.report().step, 1u);
    world.step();
}

TEST(Door, IsShutOnceAnExceptionHasEndedAStep)
{
    for (const int threads : {1, 2}) {
        for (const bool in_order : {false, true}) {
            World world(two_boxes(), threads);
            world.run_in_order(in_order);
            const BodyId body = world.bodies().back();
            world.set_force_field(
                [](const FieldPlace&) -> Wrench { throw std::runtime_error("no force today"); });
            EXPECT_THROW(world.step(), std::runtime_error);
            for (const Call& call : kChanges)
                EXPECT_EQ(refusal_of([&] { call.make(world, body); }),
                          std::string(call.name)
                              + ": an exception ended a step of this world halfway; it can be read,"
                                " and has to be made anew");
            EXPECT_TRUE(world.pose(body).position.allFinite());
            EXPECT_EQ(world.state_hash().size(), 16u);
            world.measure();
        }
    }
}

}  // namespace
}  // namespace throng
