// Coloring: each contact laid out once, no color moves a body twice, batches share nothing.
#include "kernels/solve/coloring.hpp"

#include "kernels/solve/islands.hpp"
#include "tests/kernels/solve/random_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace throng {
namespace {

using testing::add_body;
using testing::Graph;
using testing::random_graph;

void lay_out_again(const Graph& graph, Layout& layout)
{
    DisjointSets sets;
    Islands islands;
    build_islands(graph.contacts, graph.states, sets, islands);
    lay_out(islands, graph.contacts, graph.states, layout);
}

Layout laid_out(const Graph& graph)
{
    Layout layout;
    lay_out_again(graph, layout);
    return layout;
}

void add_contact(Graph& graph, std::uint32_t a, std::uint32_t b, int points)
{
    ActiveContacts::Entry entry;
    entry.body_a = a;
    entry.body_b = b;
    entry.points = static_cast<std::uint8_t>(points);
    graph.contacts.entries.push_back(entry);
}

// Everything that a layout promises.
void check_layout(const Graph& graph, const Layout& layout)
{
    ASSERT_EQ(layout.slot_a.size(), layout.lanes.size());
    ASSERT_EQ(layout.slot_b.size(), layout.lanes.size());
    ASSERT_EQ(layout.lanes.size() % kBlock, 0u);
    ASSERT_EQ(layout.points.size(), layout.lanes.size() / kBlock);
    std::vector<int> times(graph.contacts.entries.size(), 0);
    std::set<std::uint32_t> moved;  // by some batch
    std::size_t next_block = 0, next_body = 0, next_color = 0;
    for (const Batch& batch : layout.batches) {
        ASSERT_EQ(batch.first_block, next_block);
        ASSERT_EQ(batch.first_body, next_body);
        ASSERT_EQ(batch.first_color, next_color);
        next_block += batch.blocks;
        const std::uint32_t after = &batch == &layout.batches.back()
            ? static_cast<std::uint32_t>(layout.body_of_slot.size())
            : (&batch + 1)->first_body;
        next_body = after;
        next_color += batch.colors;

        // Seats: the still one, the movable ones, the kinematic ones, conveyors.
        ASSERT_EQ(layout.body_of_slot[batch.first_body], kNobody);
        for (std::uint32_t i = 1; i <= batch.dynamic; ++i) {
            const std::uint32_t body = layout.body_of_slot[batch.first_body + i];
            ASSERT_TRUE(graph.movable(body));
            ASSERT_TRUE(moved.insert(body).second) << "body " << body << " is in two batches";
        }
        for (std::uint32_t i = 1; i <= batch.kinematic; ++i)
            ASSERT_EQ(graph.states.kind[layout.body_of_slot[batch.first_body + batch.dynamic + i]],
                      BodyKind::kinematic);
        std::set<std::uint32_t> seated;
        for (std::uint32_t i = batch.first_body + 1; i < after; ++i) {
            const std::uint32_t body = layout.body_of_slot[i];
            ASSERT_TRUE(seated.insert(body).second) << "body " << body << " has two seats";
            ASSERT_EQ(i > batch.first_body + batch.dynamic + batch.kinematic,
                      graph.states.carries(body));
        }

        std::size_t contacts = 0, on_faces = 0, block = batch.first_block;
        for (std::uint32_t c = 0; c < batch.colors; ++c) {
            const Color& color = layout.colors[batch.first_color + c];
            ASSERT_EQ(color.first, block);
            ASSERT_GT(color.count, 0u);
            block += color.count;
            std::set<std::uint32_t> of_color;
            int last = 4;  // points
            for (std::uint32_t b = color.first; b < color.first + color.count; ++b) {
                std::set<std::uint32_t> of_block;
                int most = 0;
                for (std::size_t lane = std::size_t{b} * kBlock; lane < (b + 1u) * kBlock; ++lane) {
                    const std::uint32_t entry = layout.lanes[lane].entry;
                    if (entry == LaneSource{}.entry) {
                        ASSERT_EQ(layout.slot_a[lane], static_cast<int>(batch.first_body));
                        ASSERT_EQ(layout.slot_b[lane], static_cast<int>(batch.first_body));
                        continue;
                    }
                    ++times[entry];
                    ++contacts;
                    on_faces += graph.contacts.entries[entry].points >= 3 ? 1 : 0;
                    const auto& contact = graph.contacts.entries[entry];
                    most = std::max<int>(most, contact.points);
                    // Of more points before those of fewer.
                    ASSERT_LE(contact.points, last);
                    last = contact.points;
                    for (const auto& [body, slot] :
                         {std::pair(contact.body_a, layout.slot_a[lane]),
                          std::pair(contact.body_b, layout.slot_b[lane])}) {
                        const auto at = static_cast<std::uint32_t>(slot);
                        ASSERT_GE(at, batch.first_body);
                        ASSERT_LT(at, after);
                        if (seated.contains(body)) {
                            ASSERT_EQ(layout.body_of_slot[at], body);
                        } else {
                            ASSERT_FALSE(graph.movable(body) || graph.states.carries(body)
                                         || graph.states.kind[body] == BodyKind::kinematic);
                            ASSERT_EQ(at, batch.first_body);
                        }
                        if (!graph.movable(body)) continue;
                        ASSERT_TRUE(of_block.insert(body).second)
                            << "body " << body << " is twice in a block";
                        ASSERT_TRUE(of_color.insert(body).second || color.serial)
                            << "body " << body << " is twice in a color";
                    }
                }
                ASSERT_EQ(layout.points[b], most);
                // Only the last block of a color has lanes to spare.
                if (!color.serial && b + 1 < color.first + color.count) {
                    ASSERT_NE(layout.lanes[b * kBlock + 15u].entry, LaneSource{}.entry);
                }
            }
        }
        ASSERT_EQ(block, batch.first_block + batch.blocks);
        ASSERT_EQ(batch.contacts, contacts);
        ASSERT_EQ(batch.on_faces, on_faces);
        ASSERT_EQ(batch.wide, contacts > kBatchContacts);
        ASSERT_LE(batch.colors, 64u);
    }
    ASSERT_EQ(next_block * kBlock, layout.lanes.size());
    ASSERT_EQ(next_body, layout.body_of_slot.size());
    for (const int count : times) ASSERT_EQ(count, 1);
}

TEST(LayOut, KeepsItsPromisesOnRandomGraphs)
{
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const auto bodies = static_cast<std::uint32_t>(2 + random() % 600);
        const Graph graph = random_graph(bodies, random() % (4 * bodies), random);
        SCOPED_TRACE("seed " + std::to_string(seed));
        check_layout(graph, laid_out(graph));
        if (::testing::Test::HasFatalFailure()) return;
    }
}

bool same_layout(const Layout& x, const Layout& y)
{
    const auto equal = [](const auto& a, const auto& b, auto numbers) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [&](const auto& i, const auto& k) { return numbers(i) == numbers(k); });
    };
    return x.points == y.points && x.slot_a == y.slot_a && x.slot_b == y.slot_b
        && x.body_of_slot == y.body_of_slot
        && equal(x.lanes, y.lanes, [](const LaneSource& lane) { return lane.entry; })
        && equal(x.colors, y.colors,
                 [](const Color& c) { return std::tuple(c.first, c.count, c.serial); })
        && equal(x.batches, y.batches, [](const Batch& b) {
               return std::tuple(b.first_body, b.dynamic, b.kinematic, b.first_color, b.colors,
                                 b.first_block, b.blocks, b.contacts, b.on_faces, b.wide);
           });
}

// What one step leaves behind does not show in the next: bodies fall asleep, wake, come and go.
TEST(LayOut, RemembersNothing)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        Layout layout;
        for (int step = 0; step < 10; ++step) {
            const auto bodies = static_cast<std::uint32_t>(2 + random() % 600);
            Graph graph = random_graph(bodies, random() % (4 * bodies), random);
            lay_out_again(graph, layout);
            ASSERT_TRUE(same_layout(layout, laid_out(graph))) << "seed " << seed;
            // The same again, some asleep by now, with what they touched.
            for (std::uint32_t body = 0; body < bodies; body += 3)
                if (graph.states.dynamic(body)) graph.states.awake[body] = 0;
            std::erase_if(graph.contacts.entries, [&](const auto& contact) {
                return !graph.movable(contact.body_a) && !graph.movable(contact.body_b);
            });
            lay_out_again(graph, layout);
            ASSERT_NO_FATAL_FAILURE(check_layout(graph, layout)) << "seed " << seed;
            ASSERT_TRUE(same_layout(layout, laid_out(graph))) << "seed " << seed;
        }
    }
}

TEST(LayOut, WhoSleepsHasNoSeat)
{
    // Two islands in two batches, the second of which touches a sleeper of the first step.
    Graph graph;
    for (std::uint32_t i = 0; i < 1200; ++i) add_body(graph, BodyKind::dynamic, true);
    for (std::uint32_t i = 0; i + 1 < 600; ++i) add_contact(graph, i, i + 1, 2);
    for (std::uint32_t i = 600; i + 1 < 1200; ++i) add_contact(graph, i, i + 1, 2);
    add_contact(graph, 3, 900, 1);
    Layout layout;
    lay_out_again(graph, layout);
    ASSERT_EQ(layout.batches.size(), 1u);
    for (std::uint32_t i = 0; i < 600; ++i) graph.states.awake[i] = 0;
    std::erase_if(graph.contacts.entries, [](const auto& at) { return at.body_b < 600; });
    lay_out_again(graph, layout);
    check_layout(graph, layout);
    ASSERT_EQ(layout.batches.size(), 1u);
    EXPECT_EQ(layout.batches[0].dynamic, 600u);
    EXPECT_EQ(layout.body_of_slot.size(), 601u);
}

TEST(LayOut, SeatsConveyorsLast)
{
    Graph graph;
    add_body(graph, BodyKind::still, false);
    add_body(graph, BodyKind::still, false);
    add_body(graph, BodyKind::kinematic, true);
    graph.states.conveys = {1};
    for (std::uint32_t i = 0; i < 700; ++i) {
        add_body(graph, BodyKind::dynamic, true);
        for (const std::uint32_t other : {0, 1, 2}) add_contact(graph, other, 3 + i, 4);
    }
    const Layout layout = laid_out(graph);
    check_layout(graph, layout);
    ASSERT_GT(layout.batches.size(), 2u);
    for (const Batch& batch : layout.batches) {
        EXPECT_EQ(batch.kinematic, 1u);
        const std::uint32_t seat = batch.first_body + batch.dynamic + batch.kinematic + 1;
        EXPECT_EQ(layout.body_of_slot[seat], 0u);
    }
}

TEST(LayOut, PutsWhatExceedsTheColorsOneAfterAnother)
{
    // A plate under a hundred things, each of which touches a kinematic one and the ground too.
    Graph graph;
    add_body(graph, BodyKind::dynamic, true);
    add_body(graph, BodyKind::still, false);
    add_body(graph, BodyKind::kinematic, true);
    for (std::uint32_t i = 0; i < 100; ++i) {
        add_body(graph, BodyKind::dynamic, true);
        add_contact(graph, 0, 3 + i, 4);
        add_contact(graph, 1, 3 + i, i % 2 == 0 ? 1 : 3);
        add_contact(graph, 3 + i, 2, 1);
    }
    const Layout layout = laid_out(graph);
    check_layout(graph, layout);
    ASSERT_EQ(layout.batches.size(), 1u);
    EXPECT_TRUE(layout.colors.back().serial);
    EXPECT_EQ(layout.colors.back().count, 100u - 63u);
    EXPECT_EQ(layout.batches[0].kinematic, 1u);
}

TEST(LayOut, GivesEachBatchItsOwnCopyOfAKinematicBody)
{
    Graph graph;
    add_body(graph, BodyKind::kinematic, true);
    for (std::uint32_t i = 0; i < 1200; ++i) {
        add_body(graph, BodyKind::dynamic, true);
        add_contact(graph, 0, 1 + i, 4);
    }
    const Layout layout = laid_out(graph);
    check_layout(graph, layout);
    ASSERT_EQ(layout.batches.size(), 3u);
    for (const Batch& batch : layout.batches) EXPECT_EQ(batch.kinematic, 1u);
}

TEST(LayOut, SharesABigIslandAndLeavesItAlone)
{
    Graph graph;
    for (std::uint32_t i = 0; i < 1000; ++i) add_body(graph, BodyKind::dynamic, true);
    for (std::uint32_t i = 0; i + 1 < 700; ++i) add_contact(graph, i, i + 1, 2);
    for (std::uint32_t i = 700; i + 1 < 1000; i += 2) add_contact(graph, i, i + 1, 2);
    const Layout layout = laid_out(graph);
    check_layout(graph, layout);
    ASSERT_EQ(layout.batches.size(), 2u);
    EXPECT_TRUE(layout.batches[0].wide);
    EXPECT_FALSE(layout.batches[1].wide);
    // A chain needs two colors.
    EXPECT_EQ(layout.batches[0].colors, 2u);
}

TEST(LayOut, OfNothingIsEmpty)
{
    Graph graph;
    add_body(graph, BodyKind::dynamic, true);
    const Layout layout = laid_out(graph);
    EXPECT_TRUE(layout.batches.empty());
    EXPECT_TRUE(layout.lanes.empty());
}

}  // namespace
}  // namespace throng
