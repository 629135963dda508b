// Finders: every way to find pairs gives the same pairs as comparing every two boxes.
#include "broadphase/broadphase.hpp"
#include "kernels/parallel/blocks.hpp"
#include "tests/broadphase/random_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace throng::test {
namespace {

constexpr FinderKind kFast[] = {FinderKind::embree, FinderKind::grid, FinderKind::sweep};
constexpr const char* kNames[] = {"embree", "grid", "sweep", "all_pairs"};

const char* name_of(FinderKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

// Pairs by the definition, sharing nothing with the finders: not even the boxes' own test.
std::vector<PairKey> pairs_by_definition(const BoxScene& scene, const PairFilter* filter = nullptr)
{
    const std::set<std::uint32_t> asked(scene.asked.begin(), scene.asked.end());
    std::vector<PairKey> pairs;
    for (std::uint32_t a = 0; a < scene.boxes.size(); ++a)
        for (std::uint32_t b = a + 1; b < scene.boxes.size(); ++b) {
            bool overlap =
                scene.moving[a] + scene.moving[b] > 0 && asked.count(a) + asked.count(b) > 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double low = std::max(scene.boxes[a].lower[axis], scene.boxes[b].lower[axis]);
                const double high =
                    std::min(scene.boxes[a].upper[axis], scene.boxes[b].upper[axis]);
                overlap = overlap && low <= high && !std::isnan(scene.boxes[a].lower[axis])
                    && !std::isnan(scene.boxes[b].lower[axis])
                    && !std::isnan(scene.boxes[a].upper[axis])
                    && !std::isnan(scene.boxes[b].upper[axis])
                    && scene.boxes[a].lower[axis] <= scene.boxes[a].upper[axis]
                    && scene.boxes[b].lower[axis] <= scene.boxes[b].upper[axis];
            }
            if (filter != nullptr && overlap)
                overlap = filter->body[a] != filter->body[b] && (filter->group[a] & filter->mask[b])
                    && (filter->group[b] & filter->mask[a]);
            if (overlap) pairs.push_back(std::uint64_t{a} << 32 | b);
        }
    return pairs;
}

// A finder of each kind, asked the same; the answers are compared.
class AllFinders {
public:
    void expect_agreement(const BoxScene& scene,
                          const std::string& where,
                          const PairFilter* filter = nullptr)
    {
        const std::vector<PairKey> wanted = pairs_by_definition(scene, filter);
        for (std::size_t kind = 0; kind < std::size(kNames); ++kind) {
            std::vector<PairKey> found = {1, 2, 3};  // leftovers of an earlier call
            find_overlaps(scene.query(filter), finders_[kind], found);
            ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
            ASSERT_EQ(found.size(), wanted.size()) << kNames[kind] << ", " << where;
            ASSERT_EQ(found, wanted) << kNames[kind] << ", " << where;
        }
    }

private:
    AnyPairFinder finders_[4] = {make_finder(FinderKind::embree), make_finder(FinderKind::grid),
                                 make_finder(FinderKind::sweep),
                                 make_finder(FinderKind::all_pairs)};
};

TEST(Finders, AgreeOnRandomScenes)
{
    for (const BoxKind& kind : box_kinds())
        for (const std::uint32_t count : {0u, 1u, 2u, 3u, 17u, 120u, 700u})
            for (std::uint64_t seed = 1; seed <= 4; ++seed) {
                Dice dice(seed);
                AllFinders finders;
                const BoxScene scene = random_scene(dice, kind, count, seed % 2 == 0 ? 0.3 : 0);
                finders.expect_agreement(scene,
                                         kind.name + ", " + std::to_string(count) + " boxes, seed "
                                             + std::to_string(seed));
                if (HasFatalFailure()) return;
            }
}

// Moves, adds, removes, freezes and asks at random, and says so as a caller would.
void change(BoxScene& scene, Dice& dice, const BoxKind& kind)
{
    std::set<std::uint32_t> asked;
    scene.still_changed = false;
    const double share = dice.chance(0.2) ? 1.0 : dice.chance(0.3) ? 0.4 : 0.05;
    for (std::uint32_t id = 0; id < scene.boxes.size(); ++id)
        if (scene.moving[id] != 0 && dice.chance(share)) {
            asked.insert(id);
            // Often only asked about, as one that came to life again is.
            if (dice.chance(0.7)) scene.boxes[id] = random_box(dice, kind);
        }
    if (dice.chance(0.3))
        for (int i = 0; i < 5; ++i) {
            scene.boxes.push_back(random_box(dice, kind));
            scene.moving.push_back(dice.chance(0.2) ? 0 : 1);
            scene.still_changed |= scene.moving.back() == 0;
            asked.insert(static_cast<std::uint32_t>(scene.boxes.size() - 1));
        }
    for (int i = 0; i < 3 && dice.chance(0.3); ++i) {
        const std::uint32_t id = dice.below(static_cast<std::uint32_t>(scene.boxes.size()));
        scene.still_changed |= scene.moving[id] == 0;
        scene.boxes[id] = Box3();
        asked.insert(id);
    }
    if (dice.chance(0.15))
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t id = dice.below(static_cast<std::uint32_t>(scene.boxes.size()));
            scene.moving[id] ^= 1;
            scene.still_changed = true;
            asked.insert(id);
        }
    if (dice.chance(0.1))
        for (std::uint32_t id = 0; id < scene.boxes.size(); ++id)
            if (scene.moving[id] == 0 && dice.chance(0.2)) {
                scene.boxes[id] = random_box(dice, kind);
                scene.still_changed = true;
                asked.insert(id);
            }
    scene.asked.assign(asked.begin(), asked.end());
}

TEST(Finders, AgreeStepAfterStepWhileTheSceneChanges)
{
    for (const BoxKind& kind : box_kinds())
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            Dice dice(seed);
            AllFinders finders;
            BoxScene scene = random_scene(dice, kind, 250, 0.2);
            for (int step = 0; step < 40; ++step) {
                finders.expect_agreement(scene,
                                         kind.name + ", step " + std::to_string(step) + ", seed "
                                             + std::to_string(seed));
                if (HasFatalFailure()) return;
                change(scene, dice, kind);
            }
        }
}

TEST(Finders, AgreeAfterTheWorldShrinksAndMoves)
{
    Dice dice(5);
    AllFinders finders;
    BoxKind kind = box_kinds().front();
    for (const std::size_t count : {300u, 40u, 300u, 0u, 5u, 400u}) {
        BoxScene scene = random_scene(dice, kind, count, 0.2);
        finders.expect_agreement(scene, std::to_string(count) + " boxes");
        if (HasFatalFailure()) return;
        // The still ones stay where they are, the others are carried far off: the origin follows.
        for (std::size_t id = 0; id < count; ++id)
            if (scene.moving[id] != 0)
                for (Vec3* corner : {&scene.boxes[id].lower, &scene.boxes[id].upper})
                    *corner += Vec3(1e6, 0, 0);
        scene.still_changed = false;
        finders.expect_agreement(scene, std::to_string(count) + " boxes, carried off");
        if (HasFatalFailure()) return;
    }
}

TEST(Finders, AgreeWithAFilter)
{
    Dice dice(11);
    for (const BoxKind& kind : box_kinds()) {
        AllFinders finders;
        BoxScene scene = random_scene(dice, kind, 300, 0.2);
        PairFilter filter;
        for (std::size_t id = 0; id < 300; ++id)
            filter.add(dice.below(100), 1u << dice.below(4), dice.below(16));
        finders.expect_agreement(scene, kind.name, &filter);
        if (HasFatalFailure()) return;
    }
}

TEST(Finders, TouchingBoxesMeetAndAHairsBreadthParts)
{
    for (const double place : {0.0, 1.0, 1e7}) {
        AllFinders finders;
        BoxScene scene;
        const double end = place + 1;
        for (const double begin : {end, std::nextafter(end, 1e9), std::nextafter(end, -1e9)})
            scene.boxes.push_back({Vec3(begin, 0, 0), Vec3(begin + 1, 1, 1)});
        scene.boxes.push_back({Vec3(place, 0, 0), Vec3(end, 1, 1)});
        scene.moving = {1, 1, 1, 1};
        scene.asked = {3};
        finders.expect_agreement(scene, std::to_string(place));
        EXPECT_EQ(pairs_by_definition(scene).size(), 2u);
    }
}

TEST(Finders, APlaneMeetsWhatIsNearItOnly)
{
    const double inf = std::numeric_limits<double>::infinity();
    AllFinders finders;
    BoxScene scene;
    scene.boxes = {{Vec3(-inf, -inf, -inf), Vec3(inf, inf, 0)},
                   {Vec3(0, 0, -0.1), Vec3(1, 1, 0.9)},
                   {Vec3(0, 0, 5), Vec3(1, 1, 6)},
                   {Vec3(-inf, -inf, -inf), Vec3(inf, inf, inf)}};
    scene.moving = {0, 1, 1, 0};
    scene.asked = {1, 2};
    finders.expect_agreement(scene, "plane");
    EXPECT_EQ(pairs_by_definition(scene),
              (std::vector<PairKey>{pair_key(0, 1), pair_key(1, 3), pair_key(2, 3)}));
}

TEST(Finders, AskingOnlyAboutThoseThatLeftTheirFatBoxesKeepsEveryPair)
{
    // Pairs are kept while both fat boxes stay; new ones come from asking alone.
    for (const FinderKind fast : kFast) {
        Dice dice(3);
        AnyPairFinder finder = make_finder(fast);
        BoxScene scene = random_scene(dice, box_kinds().front(), 400, 0.1);
        std::vector<Vec3> drift(400);
        for (Vec3& of_one : drift) of_one = dice.point(0.05);
        std::vector<Box3> tight = scene.boxes;
        std::set<PairKey> kept;
        std::vector<PairKey> found;
        scene.asked.clear();
        for (int step = 0; step < 60; ++step) {
            for (std::uint32_t id = 0; id < 400; ++id) {
                if (scene.moving[id] == 0) continue;
                tight[id].lower += drift[id];
                tight[id].upper += drift[id];
                if (step > 0 && scene.boxes[id].contains(tight[id])) continue;
                scene.boxes[id] = {tight[id].lower - Vec3::Constant(0.3),
                                   tight[id].upper + Vec3::Constant(0.3)};
                scene.asked.push_back(id);
            }
            std::erase_if(kept, [&](PairKey key) {
                const auto is_asked = [&](std::uint32_t id) {
                    return std::binary_search(scene.asked.begin(), scene.asked.end(), id);
                };
                return is_asked(first_of(key)) || is_asked(second_of(key));
            });
            find_overlaps(scene.query(), finder, found);
            kept.insert(found.begin(), found.end());
            scene.still_changed = false;
            scene.asked.clear();

            BoxScene whole = scene;
            whole.ask_all();
            const std::vector<PairKey> wanted = pairs_by_definition(whole);
            ASSERT_EQ(std::vector<PairKey>(kept.begin(), kept.end()), wanted)
                << name_of(fast) << ", step " << step;
        }
    }
}

TEST(Finders, GiveTheSamePairsOnAnyNumberOfThreads)
{
    for (const FinderKind fast : kFast) {
        std::vector<PairKey> first;
        for (const int threads : {1, 2, 5}) {
            ThreadPool pool(threads);
            const auto body = [&](std::size_t, std::size_t, std::size_t) {
                Dice dice(9);
                AnyPairFinder finder = make_finder(fast);
                BoxKind kind = box_kinds()[0];
                kind.half_world = 13;
                BoxScene scene = random_scene(dice, kind, 6000, 0.2);
                std::vector<PairKey> pairs, all;
                for (int step = 0; step < 3; ++step) {
                    find_overlaps(scene.query(), finder, pairs);
                    all.insert(all.end(), pairs.begin(), pairs.end());
                    change(scene, dice, kind);
                }
                if (first.empty()) first = all;
                EXPECT_GT(all.size(), 5000u);
                EXPECT_EQ(all, first) << name_of(fast) << ", " << threads << " threads";
            };
            pool.run(body);
        }
    }
}

TEST(Finders, ChoiceDependsOnCountAndMixture)
{
    Dice dice(1);
    const auto choice = [&](const BoxKind& kind, std::size_t count) {
        const BoxScene scene = random_scene(dice, kind, count, 0.1);
        return choose_finder(scene.boxes, scene.moving);
    };
    EXPECT_EQ(choice(box_kinds()[0], 0), FinderKind::all_pairs);
    EXPECT_EQ(choice(box_kinds()[0], 10), FinderKind::all_pairs);
    EXPECT_EQ(choice(box_kinds()[0], 5000), FinderKind::grid);
    EXPECT_EQ(choice(box_kinds()[0], 150), FinderKind::sweep);
    EXPECT_EQ(choice(box_kinds()[1], 5000), FinderKind::grid);
    // From cups to buildings, and from dust.
    EXPECT_EQ(choice({.name = "cups", .smallest = 0.1, .largest = 10, .large_share = 0.2}, 5000),
              FinderKind::embree);
    EXPECT_EQ(choice({.name = "dust", .smallest = 1e-4, .largest = 10, .large_share = 0.2}, 5000),
              FinderKind::embree);
    for (const BoxKind& kind : box_kinds()) choice(kind, 3000);  // nothing crashes
}

}  // namespace
}  // namespace throng::test
