// Live boxes: after any moves they name whom a list of all boxes names, and nobody who is far off.
#include "broadphase/live_boxes.hpp"

#include "tests/support/dice.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace throng {
namespace {

using test::Dice;

constexpr double kAround = 0.05;  // m

Box3 box_at(const Vec3& middle, double half)
{
    return {middle.array() - half, middle.array() + half};
}

struct Crowd {
    LiveBoxes live;
    std::vector<Box3> boxes;

    void put(std::uint32_t id, const Box3& box, const Vec3& ahead)
    {
        boxes[id] = box;
        live.put(id, box, ahead, kAround);
    }
    void grow(std::size_t count)
    {
        live.resize(count);
        boxes.resize(count);
    }
};

// Whoever meets the question is named once; whoever is named is held where it meets.
template <class Question>
void expect_named(const Candidates& named,
                  const std::vector<Question>& questions,
                  const Crowd& crowd,
                  const Candidates& wanted)
{
    ASSERT_EQ(named.questions(), questions.size());
    for (std::size_t i = 0; i < questions.size(); ++i) {
        std::vector<std::uint32_t> ids(named.of(i).begin(), named.of(i).end());
        std::sort(ids.begin(), ids.end());
        ASSERT_TRUE(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
        for (const std::uint32_t id : wanted.of(i))
            ASSERT_TRUE(std::binary_search(ids.begin(), ids.end(), id)) << id;
        for (const std::uint32_t id : ids) {
            ASSERT_TRUE(crowd.live.held(id).contains(crowd.boxes[id]));
            if constexpr (std::is_same_v<Question, Ray>) {
                ASSERT_TRUE(may_meet(questions[i], crowd.live.held(id)));
            } else {
                ASSERT_TRUE(questions[i].overlaps(crowd.live.held(id)));
            }
        }
    }
}

TEST(LiveBoxes, NameWhomAListNamesAfterAnyMoves)
{
    for (const std::uint32_t count : {3u, 100u, 1500u}) {
        Dice dice(count);
        Crowd crowd;
        crowd.grow(count);
        for (int round = 0; round < 60; ++round) {
            const std::uint32_t moves = round == 0 ? count : dice.below(count);
            for (std::uint32_t k = 0; k < moves; ++k) {
                const std::uint32_t id = round == 0 ? k : dice.below(count);
                const bool gone = dice.chance(0.05);
                crowd.put(id, gone ? Box3{} : box_at(dice.point(5), dice.between(0.01, 0.3)),
                          dice.chance(0.5) ? dice.point(0.3) : Vec3(Vec3::Zero()));
            }
            // Some go on a little, as who moves does, within their room or out of it.
            for (std::uint32_t id = 0; id < count; id += 3)
                if (!crowd.boxes[id].empty()) {
                    Box3 box = crowd.boxes[id];
                    const Vec3 way = dice.point(0.03);
                    box.lower += way;
                    box.upper += way;
                    crowd.put(id, box, 5 * way);
                }
            crowd.live.settle();
            std::vector<Ray> rays;
            std::vector<Box3> regions;
            for (int i = 0; i < 20; ++i) {
                rays.push_back({dice.point(6), dice.direction(), dice.between(0, 10)});
                regions.push_back(box_at(dice.point(5), dice.between(0.1, 1)));
            }
            ListedBoxes listed;
            listed.build(crowd.boxes);
            Candidates named, wanted;
            crowd.live.meet_rays(rays, named);
            listed.meet_rays(rays, wanted);
            expect_named(named, rays, crowd, wanted);
            crowd.live.meet_boxes(regions, named);
            listed.meet_boxes(regions, wanted);
            expect_named(named, regions, crowd, wanted);
            for (const Box3& box : crowd.boxes) {
                ASSERT_TRUE(box.empty() || crowd.live.bounds().contains(box));
            }
        }
    }
}

}  // namespace
}  // namespace throng
