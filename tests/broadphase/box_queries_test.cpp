// Box queries: the tree gives the same candidates as the list, and neither misses what a ray meets.
#include "broadphase/box_queries.hpp"

#include "tests/broadphase/random_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace throng::test {
namespace {

// Rays that start anywhere about the scene, at any distance, along axes, along nothing, towards it.
std::vector<Ray> random_rays(Dice& dice, const BoxKind& kind, std::span<const Box3> boxes)
{
    std::vector<Ray> rays;
    const double extent = kind.half_world + kind.largest;
    for (int i = 0; i < 200; ++i) {
        Ray ray;
        const double away = i % 4 == 0 ? 1e3 : i % 4 == 1 ? 1e12 : 1;
        ray.from = kind.center + dice.point(extent * away);
        ray.along = dice.point(1);
        if (i % 3 == 0 && !boxes.empty()) {
            // Through the corner of a box.
            const Box3& box = boxes[dice.below(static_cast<std::uint32_t>(boxes.size()))];
            ray.along = (dice.chance(0.5) ? box.lower : box.upper) - ray.from;
        }
        if (i % 7 == 0) ray.along[static_cast<int>(dice.below(3))] = 0;
        if (i % 11 == 0) ray.along[static_cast<int>(dice.below(3))] = 1e-30;
        if (i % 23 == 0) ray.along.setZero();
        if (i % 29 == 0) ray.along *= 1e-300;
        if (i % 2 == 0) ray.longest = dice.between(0, 2);
        if (i % 31 == 0) ray.along[0] = std::nan("");
        if (i % 37 == 0) ray.from[1] = std::numeric_limits<double>::infinity();
        rays.push_back(ray);
    }
    return rays;
}

TEST(BoxQueries, TreeAndListGiveTheSameCandidatesOfRays)
{
    for (const BoxKind& kind : box_kinds())
        for (const std::size_t count : {0u, 1u, 2u, 300u}) {
            Dice dice(count + 1);
            EmbreeRays tree;
            for (int turn = 0; turn < 2; ++turn) {  // built again over what was there
                const BoxScene scene = random_scene(dice, kind, count, 0.1);
                const std::vector<Ray> rays = random_rays(dice, kind, scene.boxes);
                ListedBoxes list;
                list.build(scene.boxes);
                tree.build(scene.boxes);
                Candidates wanted, found;
                list.meet_rays(rays, wanted);
                tree.meet_rays(rays, found);
                ASSERT_EQ(found.begin, wanted.begin) << kind.name << ", " << count << " boxes";
                ASSERT_EQ(found.ids, wanted.ids) << kind.name << ", " << count << " boxes";
            }
        }
}

TEST(BoxQueries, TreeAndListGiveTheSameCandidatesOfRegions)
{
    for (const BoxKind& kind : box_kinds())
        for (const std::size_t count : {0u, 1u, 2u, 300u}) {
            Dice dice(count + 7);
            const BoxScene scene = random_scene(dice, kind, count, 0.1);
            BoxKind odd = kind;
            odd.infinite_share = odd.not_a_number_share = odd.empty_share = 0.05;
            const BoxScene regions = random_scene(dice, odd, 50, 0);
            ListedBoxes list;
            EmbreeRays tree;
            list.build(scene.boxes);
            tree.build(scene.boxes);
            Candidates wanted, found;
            list.meet_boxes(regions.boxes, wanted);
            tree.meet_boxes(regions.boxes, found);
            ASSERT_EQ(found.begin, wanted.begin) << kind.name << ", " << count << " boxes";
            ASSERT_EQ(found.ids, wanted.ids) << kind.name << ", " << count << " boxes";
        }
}

TEST(BoxQueries, ARayThroughAPointOfABoxFindsTheBox)
{
    Dice dice(2);
    for (int i = 0; i < 100000; ++i) {
        const double away = i % 3 == 0 ? 1e7 : 1;
        const Vec3 center = dice.point(10 * away);
        const Box3 box = box_around(center, Vec3::Constant(0.5) + dice.point(0.5));
        // A point of the box that is a number: on its surface, or a corner.
        Vec3 point;
        for (int axis = 0; axis < 3; ++axis)
            point[axis] = dice.chance(0.5) ? box.lower[axis] : box.upper[axis];
        Ray ray;
        ray.along = dice.point(1);
        ray.from = point;  // touching at its very start
        ASSERT_TRUE(may_meet(ray, box)) << i;
        // A ray whose numbers are whole, so that it passes through the corner without rounding.
        const Vec3 steps =
            Vec3(dice.below(100), dice.below(100), dice.below(100)) - Vec3::Constant(50);
        const Vec3 corner = dice.point(1e6).array().round();
        ray.from = corner - 64 * steps;
        ray.along = steps;
        ray.longest = 64;
        ASSERT_TRUE(may_meet(ray, {corner, corner + Vec3::Ones()})) << i;
        ASSERT_TRUE(may_meet(ray, {corner - Vec3::Ones(), corner})) << i;
    }
}

TEST(BoxQueries, ARayEndsAtItsLength)
{
    Ray ray{Vec3::Zero(), Vec3::UnitX(), 2};
    EXPECT_TRUE(may_meet(ray, {Vec3(2, -1, -1), Vec3(3, 1, 1)}));
    EXPECT_FALSE(may_meet(ray, {Vec3(2.001, -1, -1), Vec3(3, 1, 1)}));
    EXPECT_FALSE(may_meet(ray, {Vec3(-3, -1, -1), Vec3(-0.001, 1, 1)}));
    EXPECT_FALSE(may_meet(ray, {Vec3(1, 0.001, -1), Vec3(3, 1, 1)}));
}

}  // namespace
}  // namespace throng::test
