// Coming effects: bodies go on by the same bits whether somebody far away calls for an effect, or
// comes to and no longer does; and whatever other scene there is.
#include "tests/support/solid_scenes.hpp"
#include "throng/catalog.hpp"
#include "throng/world.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace throng {
namespace {

using given::SceneOf;
using given::tetrahedron;

constexpr int kSteps = 100, kChanges = 10;

// Islands of many kinds, that fall, slide, lean, roll over and come to rest.
Scene crowd()
{
    SceneOf made;
    made.floor();
    const std::uint32_t hull = made.shape(HullShape{tetrahedron(0.25).vertices});
    const std::uint32_t capsule = made.shape(CapsuleShape{0.15, 0.2}),
                        coin = made.shape(CylinderShape{0.3, 0.05}),
                        needle = made.shape(CapsuleShape{0.02, 0.5});
    for (int i = 0; i < 3; ++i) made.box(Vec3(0.3, 0.3, 0.2), Vec3(0.02 * i, 0, 0.2 + 0.401 * i));
    for (int i = 0; i < 4; ++i) made.box(Vec3(0.2, 0.2, 0.2), Vec3(0.1 * i, 3, 0.2 + 0.6 * i));
    for (int i = 0; i < 5; ++i)
        made.ball(0.2, Vec3(3 + 0.05 * i, 0.04 * i, 0.3 + 0.5 * i)).velocity = Vec3(0.4, 0, 0);
    for (int i = 0; i < 4; ++i) made.body(hull, Vec3(6 + 0.1 * i, 0.05 * i, 0.4 + 0.5 * i));
    for (int i = 0; i < 3; ++i) made.body(capsule, Vec3(3 + 0.1 * i, 3, 0.4 + 0.5 * i));
    made.body(needle, Vec3(6, 3, 0.6)).angular_velocity = Vec3(0.5, 0, 0);
    made.box(Vec3(0.1, 0.1, 0.8), Vec3(9, 0, 0.9)).angular_velocity = Vec3(0, 0.4, 0);
    made.box(Vec3(2, 2, 0.5), Vec3(9, 3, 0.5)).mass = 1000;
    made.box(Vec3(0.2, 0.2, 0.2), Vec3(9, 3, 1.3));
    made.body(coin, Vec3(0, 6, 0.5)).orientation = Quat(std::cos(0.6), std::sin(0.6), 0, 0);
    return made.scene;
}

// Where nothing turns, nothing rubs.
Scene marbles()
{
    SceneOf made;
    made.scene.materials[0].friction = 0;
    made.floor();
    for (int i = 0; i < 12; ++i)
        made.ball(0.2, Vec3(i % 3 * 0.39, i / 3 * 1.5, 0.25 + 0.1 * i)).velocity = Vec3(0.2, 0, 0);
    return made.scene;
}

// Where forces follow bodies: dragged ones that bounce, roll and rest, some on springs.
Scene dragged()
{
    SceneOf made;
    made.scene.materials[0].restitution = 0.4;
    made.floor();
    for (int i = 0; i < 12; ++i) {
        const Vec3 at(1.5 * (i % 4), 1.5 * (i / 4), 0.25 + 0.15 * i);
        BodyDescription& body =
            i % 2 == 0 ? made.ball(0.25, at) : made.box(Vec3(0.2, 0.2, 0.2), at);
        body.velocity = Vec3(0.3, 0, 0);
        body.linear_drag = 0.2 * i;
        body.angular_drag = 0.01;
        if (i % 3 != 0) continue;
        Spring spring;
        spring.a = static_cast<std::uint32_t>(i + 1);
        spring.at_b = at + Vec3(0, 0, 1);
        spring.stiffness = i % 2 == 0 ? 60 : 5e4;
        spring.length = 1;
        made.scene.springs.push_back(spring);
    }
    return made.scene;
}

struct Caller {
    const char* name;
    void (*call)(SceneOf&, const Vec3& at);
};
std::ostream& operator<<(std::ostream& out, const Caller& caller) { return out << caller.name; }

struct How {
    const char* name;
    void (*set)(Settings&);
};
std::ostream& operator<<(std::ostream& out, const How& how) { return out << how.name; }

BodyDescription& far_box(SceneOf& made, const Vec3& at)
{
    return made.box(Vec3(0.2, 0.2, 0.2), at);
}

// A shelf, and what lies on it.
BodyDescription& shelved(SceneOf& made, const Vec3& at)
{
    made.box(Vec3(2, 2, 0.1), at - Vec3(0, 0, 0.3)).motion = Motion::static_;
    return far_box(made, at);
}

void pull(SceneOf& made, std::uint32_t body, const Vec3& at)
{
    Spring spring;
    spring.a = body;
    spring.at_a = Vec3(0.1, 0, 0);
    spring.at_b = at + Vec3(0, 0, 1);
    spring.stiffness = 300;
    spring.length = 0.5;
    made.scene.springs.push_back(spring);
}

const Caller kCallers[] = {
    {"body", [](SceneOf& made, const Vec3& at) { far_box(made, at); }},
    {"force", [](SceneOf& made, const Vec3& at) { far_box(made, at).force = Vec3(1, 0, 0); }},
    {"torque", [](SceneOf& made, const Vec3& at) { shelved(made, at).torque = Vec3(1, 0, 0); }},
    {"drive", [](SceneOf& made, const Vec3& at) { far_box(made, at).drive_velocity[0] = 1; }},
    {"drive_on_shelf",
     [](SceneOf& made, const Vec3& at) { shelved(made, at).drive_velocity[0] = 0.1; }},
    {"spin",
     [](SceneOf& made, const Vec3& at) {
         BodyDescription& body = made.box(Vec3(0.1, 0.2, 0.4), at);
         body.angular_velocity = Vec3(3, 0.1, 0);
     }},
    {"rolling_friction",
     [](SceneOf& made, const Vec3& at) {
         made.scene.materials[0].rolling_friction = 0.02;
         made.ball(0.2, at);
         shelved(made, at + Vec3(0, 0, 3));
     }},
    {"restitution",
     [](SceneOf& made, const Vec3& at) {
         made.scene.materials[0].restitution = 0.7;
         shelved(made, at).velocity = Vec3(0, 0, -2);
     }},
    {"fast", [](SceneOf& made, const Vec3& at) { far_box(made, at).velocity = Vec3(300, 0, 0); }},
    {"mesh",
     [](SceneOf& made, const Vec3& at) {
         const std::uint32_t mesh = made.shape(given::mesh_of(given::block_under(
             [](double x, double y) { return 0.05 * (x * x + y * y); }, 6, 0.5)));
         made.body(mesh, at).motion = Motion::static_;
         made.ball(0.2, at + Vec3(0, 0, 0.6));
     }},
    {"solid",
     [](SceneOf& made, const Vec3& at) {
         const std::uint32_t ring = made.shape(given::mesh_of(torus_mesh(0.3, 0.12, 12, 6)));
         made.body(ring, at + Vec3(0, 0, 0.3));
         shelved(made, at);
     }},
    {"seams",
     [](SceneOf& made, const Vec3& at) {
         for (int i = 0; i < 2; ++i)
             made.box(Vec3(0.5, 0.5, 0.1), at + Vec3(i, 0, 0)).motion = Motion::static_;
         made.box(Vec3(0.3, 0.3, 0.1), at + Vec3(0.4, 0, 0.21)).velocity = Vec3(1, 0, 0);
     }},
    {"spring",
     [](SceneOf& made, const Vec3& at) {
         far_box(made, at);
         pull(made, 0, at);
     }},
    {"spring_on_shelf",
     [](SceneOf& made, const Vec3& at) {
         shelved(made, at);
         pull(made, 1, at);
     }},
    {"drag",
     [](SceneOf& made, const Vec3& at) {
         BodyDescription& body = shelved(made, at);
         body.linear_drag = 0.3;
         body.angular_drag = 0.1;
     }},
    {"pivot", [](SceneOf& made, const Vec3& at) { far_box(made, at).pivot = Vec3(0.2, 0.2, 0.2); }},
    {"dragged_balls",
     [](SceneOf& made, const Vec3& at) {
         made.scene.materials[0].restitution = 0.6;
         made.box(Vec3(3, 3, 0.1), at - Vec3(0, 0, 0.5)).motion = Motion::static_;
         for (int i = 0; i < 4; ++i) {
             BodyDescription& ball = made.ball(0.2, at + Vec3(0.6 * i, 0, 0.3 * i));
             ball.linear_drag = 0.1;
             ball.velocity = Vec3(0, 0.4, -1);
         }
     }},
    {"rolling_can",
     [](SceneOf& made, const Vec3& at) {
         made.box(Vec3(3, 3, 0.1), at - Vec3(0, 0, 0.6)).motion = Motion::static_;
         BodyDescription& coin = made.body(made.shape(CylinderShape{0.3, 0.05}), at);
         coin.orientation = Quat(std::cos(0.5), std::sin(0.5), 0, 0);
         coin.angular_velocity = Vec3(0, 0, 6);
     }},
    {"carousel",
     [](SceneOf& made, const Vec3& at) {
         BodyDescription& plate = made.box(Vec3(2, 2, 0.1), at - Vec3(0, 0, 0.3));
         plate.motion = Motion::kinematic;
         plate.angular_velocity = Vec3(0, 0, 1);
         far_box(made, at);
     }},
    {"seesaw",
     [](SceneOf& made, const Vec3& at) {
         made.body(made.shape(CapsuleShape{0.2, 0.5}), at).motion = Motion::static_;
         BodyDescription& plank = made.box(Vec3(0.2, 1, 0.05), at + Vec3(0, 0.02, 0.26));
         plank.orientation = Quat(std::cos(0.02), std::sin(0.02), 0, 0);
     }},
    {"load",
     [](SceneOf& made, const Vec3& at) {
         shelved(made, at);
         made.box(Vec3(0.4, 0.4, 0.4), at + Vec3(0, 0, 0.61)).mass = 40000;
     }},
    {"blow",
     [](SceneOf& made, const Vec3& at) {
         shelved(made, at);
         for (int i = 1; i < 8; ++i)
             far_box(made, at + Vec3(0, 0, 0.41 * i)).velocity = Vec3(0, 0, -4);
     }},
};

const How kSettings[] = {
    {"soft_step", [](Settings&) {}},
    {"doubles", [](Settings& s) { s.precision = Precision::double_; }},
    {"pgs", [](Settings& s) { s.solver = Solver::pgs; }},
    {"direct", [](Settings& s) { s.solver = Solver::direct; }},
    {"penalty", [](Settings& s) { s.response = Response::penalty; }},
    {"kinematic", [](Settings& s) { s.response = Response::kinematic; }},
    {"point_friction", [](Settings& s) { s.friction_at = FrictionAt::points; }},
    {"splitting", [](Settings& s) { s.integrator = Integrator::splitting; }},
    {"effects_auto", [](Settings& s) { s.effects = EffectChoice::auto_; }},
};

Scene far_away(const Caller& caller)
{
    SceneOf made;
    caller.call(made, Vec3(500, 20, 40));
    return made.scene;
}

using Motions = std::vector<std::array<double, 13>>;

Motions motions_of(const World& world, std::span<const BodyId> bodies)
{
    Motions motions;
    for (const BodyId body : bodies) {
        const Pose pose = world.pose(body);
        const Vec3 v = world.velocity(body), w = world.angular_velocity(body);
        motions.push_back({pose.position.x(), pose.position.y(), pose.position.z(),
                           pose.orientation.w(), pose.orientation.x(), pose.orientation.y(),
                           pose.orientation.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z()});
    }
    return motions;
}

// Once more with the caller there throughout, or coming and going by turns.
std::vector<Motions> run(Scene scene, const How& how, const Caller& caller, bool throughout)
{
    how.set(scene.settings);
    World world(scene, 1);
    const std::vector<BodyId> bodies = world.bodies();
    std::vector<Motions> motions;
    std::vector<BodyId> others;
    if (throughout) others = world.add(far_away(caller));
    for (int step = 0; step < kSteps; ++step) {
        if (!throughout && step % (kSteps / (kChanges + 1)) == 5) {
            if (others.empty()) {
                others = world.add(far_away(caller));
            } else {
                world.remove(others);
                others.clear();
            }
        }
        world.step();
        motions.push_back(motions_of(world, bodies));
    }
    return motions;
}

class ComingEffects : public ::testing::TestWithParam<std::tuple<How, Caller>> { };

TEST_P(ComingEffects, LeaveOthersTheirBits)
{
    const auto& [how, caller] = GetParam();
    for (Scene (*made)() : {crowd, marbles, dragged}) {
        const std::vector<Motions> with = run(made(), how, caller, true),
                                   by_turns = run(made(), how, caller, false);
        for (int step = 0; step < kSteps; ++step)
            for (std::size_t body = 0; body < with[0].size(); ++body)
                ASSERT_EQ(with[static_cast<std::size_t>(step)][body],
                          by_turns[static_cast<std::size_t>(step)][body])
                    << "body " << body << " after " << step + 1 << " steps";
    }
}

INSTANTIATE_TEST_SUITE_P(Callers,
                         ComingEffects,
                         ::testing::Combine(::testing::ValuesIn(kSettings),
                                            ::testing::ValuesIn(kCallers)),
                         [](const ::testing::TestParamInfo<std::tuple<How, Caller>>& info) {
                             return std::string(std::get<0>(info.param).name) + "_"
                                 + std::get<1>(info.param).name;
                         });

// One of the catalogue, as small as it is made.
Scene small_scene(std::string_view name)
{
    constexpr int kBodies = 14;
    const CatalogEntry& entry = *find_scene(name);
    return make_scene(name, std::min(entry.default_size, std::max(kBodies, entry.least)));
}

void move(Scene& scene, const Vec3& by)
{
    for (BodyDescription& body : scene.bodies) {
        body.position += by;
        body.name.clear();
    }
    for (Instances& group : scene.instances)
        for (std::size_t at = 0; at < group.records.size(); at += group.stride())
            for (std::size_t k = 0; k < 3; ++k)
                group.records[at + k] += by[static_cast<Eigen::Index>(k)];
    for (Spring& spring : scene.springs) {
        if (spring.a == kNone) spring.at_a += by;
        if (spring.b == kNone) spring.at_b += by;
    }
}

// With those whose islands share batches with many kinds of others.
class FarScenes : public ::testing::TestWithParam<std::string> { };

TEST_P(FarScenes, LeaveBodiesTheirBits)
{
    constexpr int kShort = 45;
    const Scene scene = small_scene(GetParam());
    World alone(scene, 1);
    const std::vector<BodyId> bodies = alone.bodies();
    std::vector<Motions> motions;
    for (int step = 0; step < kShort; ++step) {
        alone.step();
        motions.push_back(motions_of(alone, bodies));
    }
    World beside(scene, 1);
    Vec3 at(3000, 1000, 50);
    for (const char* other : {"knots", "meshes", "pile", "wall"}) {
        Scene far = small_scene(other);
        move(far, at);
        beside.add(far);
        at.x() += 1000;
    }
    for (int step = 0; step < kShort; ++step) {
        beside.step();
        ASSERT_EQ(motions_of(beside, bodies), motions[static_cast<std::size_t>(step)])
            << "after " << step + 1 << " steps";
    }
}

std::vector<std::string> names_of_catalog()
{
    std::vector<std::string> names;
    for (const CatalogEntry& entry : catalog()) names.emplace_back(entry.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Catalog,
                         FarScenes,
                         ::testing::ValuesIn(names_of_catalog()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace throng
