// Known apart: a pair that is not looked at, because the two cannot have met since, is apart
// indeed.
#include "kernels/geometry/gjk.hpp"
#include "narrowphase/dispatch.hpp"
#include "pipeline/world/world_state.hpp"
#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace throng {
namespace {

// How many pairs of polytopes are known to be apart; each is measured in double.
template <class Real>
std::size_t count_known_apart(World& world)
{
    const auto& data = std::get<Step<Real>>(state_of(world).step).data;
    const auto& contacts = std::get<ConvexContacts<Real>>(data);
    const auto& keys = std::get<Pairs>(data).keys;
    const auto& bounds = std::get<Bounds>(data);
    const auto& shapes = std::get<Shapes>(data);
    const auto& colliders = std::get<Colliders>(data);
    const auto& approach = contacts.travels.approach;
    std::size_t known = 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const std::uint32_t a = first_of(keys[i]), b = second_of(keys[i]);
        if (!(approach[a] + approach[b] < double{contacts.apart_until[i]})) continue;
        ++known;
        EXPECT_EQ(contacts.of_pair[i].contact, PairState::kApart);
        // Not the separation along an axis: where corners are nearest that is less than how far
        // the two are apart.
        const Pose seen =
            pose_seen_from_a(shapes, colliders.shape[b], bounds.placed[a], bounds.placed[b]);
        const Distance distance =
            gjk(ConvexCorePair(shapes, colliders.shape[a], colliders.shape[b], seen),
                std::numeric_limits<double>::infinity());
        EXPECT_TRUE(distance.apart) << "pair " << i;
        const double near = 1e-5 * (colliders.outer_radius[a] + colliders.outer_radius[b]);
        EXPECT_GT(distance.distance,
                  bounds.speculative_margin[a] + bounds.speculative_margin[b] - near)
            << "pair " << i;
    }
    return known;
}

template <class Real>
void check_while_hulls_fall()
{
    Scene scene = make_scene("hulls", 100);
    scene.settings.precision =
        std::is_same_v<Real, double> ? Precision::double_ : Precision::float_;
    World world(scene);
    std::size_t known = 0, pairs = 0;
    for (int step = 0; step < 150; ++step) {
        // Whoever is put elsewhere has come as far as that.
        if (step % 40 == 39) {
            const std::vector<BodyId> bodies = world.bodies();
            const BodyId last = bodies.back();
            world.set_pose(last,
                           {world.pose(bodies[bodies.size() / 2]).position, Quat::Identity()});
        }
        if (step % 40 == 19) {
            const std::vector<BodyId> bodies = world.bodies();
            world.remove(std::span(bodies).subspan(bodies.size() / 3, 1));
        }
        world.step();
        known += count_known_apart<Real>(world);
        pairs += world.report().pairs;
        ASSERT_FALSE(::testing::Test::HasFailure()) << "step " << step;
    }
    // Of pairs that do not touch, most.
    EXPECT_GT(known, pairs / 4);
}

}  // namespace

TEST(KnownApart, PairsThatAreNotLookedAtAreOutOfReachInFloat) { check_while_hulls_fall<float>(); }
TEST(KnownApart, PairsThatAreNotLookedAtAreOutOfReachInDouble) { check_while_hulls_fall<double>(); }

}  // namespace throng
