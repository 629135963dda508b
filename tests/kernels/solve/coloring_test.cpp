// Coloring: each contact laid out once, no color moves a body twice, batches share nothing.
#include "kernels/solve/coloring.hpp"

#include "kernels/solve/islands.hpp"
#include "tests/kernels/solve/random_graph.hpp"

#include <gtest/gtest.h>

#include <set>

namespace throng {
namespace {

using testing::add_body;
using testing::Graph;
using testing::random_graph;

Layout laid_out(const Graph& graph)
{
    DisjointSets sets;
    Islands islands;
    build_islands(graph.contacts, graph.states, sets, islands);
    Layout layout;
    lay_out(islands, graph.contacts, graph.states, layout);
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
    std::vector<int> times(graph.contacts.entries.size(), 0);
    std::set<std::uint32_t> moved;  // by some batch
    std::size_t next_block = 0, next_body = 0, next_color = 0;
    for (const Batch& batch : layout.batches) {
        ASSERT_EQ(batch.first_block, next_block);
        ASSERT_EQ(batch.first_body, next_body);
        ASSERT_EQ(batch.first_color, next_color);
        next_block += batch.blocks;
        next_body += 1 + batch.dynamic + batch.kinematic;
        next_color += batch.colors;

        // Seats: the still one, the movable ones, the kinematic ones.
        ASSERT_EQ(layout.body_of_slot[batch.first_body], kNobody);
        for (std::uint32_t i = 1; i <= batch.dynamic; ++i) {
            const std::uint32_t body = layout.body_of_slot[batch.first_body + i];
            ASSERT_TRUE(graph.movable(body));
            ASSERT_TRUE(moved.insert(body).second) << "body " << body << " is in two batches";
        }
        for (std::uint32_t i = 1; i <= batch.kinematic; ++i)
            ASSERT_EQ(graph.states.kind[layout.body_of_slot[batch.first_body + batch.dynamic + i]],
                      BodyKind::kinematic);

        std::size_t contacts = 0, block = batch.first_block;
        for (std::uint32_t c = 0; c < batch.colors; ++c) {
            const Color& color = layout.colors[batch.first_color + c];
            ASSERT_EQ(color.first, block);
            ASSERT_GT(color.count, 0u);
            block += color.count;
            std::set<std::uint32_t> of_color;
            bool singles = false;
            for (std::uint32_t b = color.first; b < color.first + color.count; ++b) {
                std::set<std::uint32_t> of_block;
                int most = 0, least = 9;
                for (std::size_t lane = std::size_t{b} * kBlock; lane < (b + 1u) * kBlock; ++lane) {
                    const std::uint32_t entry = layout.lanes[lane].entry;
                    if (entry == LaneSource{}.entry) {
                        ASSERT_EQ(layout.slot_a[lane], static_cast<int>(batch.first_body));
                        ASSERT_EQ(layout.slot_b[lane], static_cast<int>(batch.first_body));
                        continue;
                    }
                    ++times[entry];
                    ++contacts;
                    const auto& contact = graph.contacts.entries[entry];
                    most = std::max<int>(most, contact.points);
                    least = std::min<int>(least, contact.points);
                    for (const auto& [body, slot] :
                         {std::pair(contact.body_a, layout.slot_a[lane]),
                          std::pair(contact.body_b, layout.slot_b[lane])}) {
                        const auto at = static_cast<std::uint32_t>(slot);
                        ASSERT_GE(at, batch.first_body);
                        ASSERT_LE(at, batch.first_body + batch.dynamic + batch.kinematic);
                        if (graph.movable(body) || graph.states.kind[body] == BodyKind::kinematic) {
                            ASSERT_EQ(layout.body_of_slot[at], body);
                        } else {
                            ASSERT_EQ(at, batch.first_body);
                        }
                        if (!graph.movable(body)) continue;
                        ASSERT_TRUE(of_block.insert(body).second)
                            << "body " << body << " is twice in a block";
                        ASSERT_TRUE(of_color.insert(body).second || color.serial)
                            << "body " << body << " is twice in a color";
                    }
                }
                // Single points stand apart, after the others.
                ASSERT_TRUE(most == 1 || least > 1);
                ASSERT_TRUE(most == 1 || !singles || color.serial);
                singles = singles || most == 1;
            }
        }
        ASSERT_EQ(block, batch.first_block + batch.blocks);
        ASSERT_EQ(batch.wide, contacts > kBatchContacts);
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
