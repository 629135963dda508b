// Coloring: each contact laid out once, no color moves a body twice, batches share nothing.
#include "kernels/solver/coloring.hpp"

#include "kernels/solver/islands.hpp"
#include "tests/kernels/solver/random_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace throng {
namespace {

using given::add_body;
using given::Graph;
using given::random_graph;

void lay_out_again(const Graph& graph, ConstraintGraph& constraint_graph, Layout& layout)
{
    Islands islands;
    IslandFinder().find(graph.contacts, graph.states, graph.movable_bodies(), {}, islands);
    constraint_graph.lay_out(islands, graph.contacts, graph.states, graph.positions, layout);
}

Layout laid_out(const Graph& graph, const SplitRule& cut = {})
{
    ConstraintGraph constraint_graph;
    constraint_graph.split_rule = cut;
    Layout layout;
    lay_out_again(graph, constraint_graph, layout);
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

// What a layout promises of the solver bodies of a slice: the movable ones, and copies of those
// that it touches and that move by themselves, then of conveyors and of who rests.
void check_solver_bodies(const Graph& graph, const Layout& layout, const Slice& slice)
{
    for (std::uint32_t i = 0; i < slice.dynamic; ++i) {
        const std::uint32_t body = layout.body_of_solver_index[slice.first_body + i];
        ASSERT_TRUE(graph.movable(body));
        ASSERT_EQ(layout.solver_index[body], slice.first_body + i)
            << "body " << body << " has two seats";
    }
    const std::uint32_t after = &slice == &layout.slices.back()
        ? static_cast<std::uint32_t>(layout.body_of_solver_index.size())
        : (&slice + 1)->first_kinematic_copy;
    std::set<std::uint32_t> kinematic_copies;
    for (std::uint32_t i = slice.first_kinematic_copy; i < after; ++i) {
        const std::uint32_t body = layout.body_of_solver_index[i];
        ASSERT_TRUE(kinematic_copies.insert(body).second) << "body " << body << " has two seats";
        if (i < slice.first_kinematic_copy + slice.kinematic) {
            ASSERT_EQ(graph.states.kind[body], BodyKind::kinematic);
        } else {
            ASSERT_TRUE(graph.states.carries(body) || graph.states.rests(body));
        }
    }
}

// And of the solver body on one side of a contact. `next` is the slice after, if there is one.
void check_side(const Graph& graph,
                const Layout& layout,
                const Slice& slice,
                const Slice* next,
                std::uint32_t body,
                std::int32_t solver_index)
{
    const auto at = static_cast<std::uint32_t>(solver_index);
    const auto within = [&](std::uint32_t first, std::uint32_t count) {
        return at >= first && at < first + count;
    };
    if (graph.movable(body)) {
        ASSERT_EQ(layout.body_of_solver_index[at], body);
        ASSERT_TRUE(within(slice.first_body, slice.dynamic)
                    || (next != nullptr && within(next->first_body, next->dynamic)));
    } else if (graph.states.kind[body] == BodyKind::kinematic) {
        ASSERT_EQ(layout.body_of_solver_index[at], body);
        ASSERT_TRUE(within(slice.first_kinematic_copy, slice.kinematic));
    } else if (graph.states.carries(body) || graph.states.rests(body)) {
        ASSERT_EQ(layout.body_of_solver_index[at], body);
        ASSERT_GE(at, slice.first_kinematic_copy + slice.kinematic);
    } else {
        ASSERT_EQ(at, 0u);
    }
}

// Colors of a slice: contiguous, no body twice, those of more points first. Counts the contacts.
void check_colors(const Graph& graph,
                  const Layout& layout,
                  const Slice& slice,
                  const Slice* next,
                  bool wide,
                  std::size_t& block,
                  std::vector<int>& times)
{
    std::size_t contacts = 0;
    for (std::uint32_t c = 0; c < slice.colors; ++c) {
        const Color& color = layout.colors[slice.first_color + c];
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
                    ASSERT_EQ(layout.solver_index_a[lane], 0);
                    ASSERT_EQ(layout.solver_index_b[lane], 0);
                    continue;
                }
                ++times[entry];
                ++contacts;
                const auto& contact = graph.contacts.entries[entry];
                most = std::max<int>(most, contact.points);
                ASSERT_LE(contact.points, last);
                last = contact.points;
                for (const auto& [body, solver_index] :
                     {std::pair(contact.body_a, layout.solver_index_a[lane]),
                      std::pair(contact.body_b, layout.solver_index_b[lane])}) {
                    ASSERT_NO_FATAL_FAILURE(
                        check_side(graph, layout, slice, next, body, solver_index));
                    if (!graph.movable(body)) continue;
                    ASSERT_TRUE(of_block.insert(body).second)
                        << "body " << body << " is twice in a block";
                    ASSERT_TRUE(of_color.insert(body).second || color.serial)
                        << "body " << body << " is twice in a color";
                }
            }
            // Of shared batches none is told to be of single points, which may be as others are.
            ASSERT_EQ(layout.points[b], wide ? most : std::max(most, 2));
            // Only the last block of a color has lanes to spare.
            if (!color.serial && b + 1 < color.first + color.count) {
                ASSERT_NE(layout.lanes[b * kBlock + 15u].entry, LaneSource{}.entry);
            }
        }
    }
    ASSERT_EQ(slice.contacts, contacts);
    ASSERT_LE(slice.colors, 64u);
}

// Everything that a layout promises.
void check_layout(const Graph& graph, const Layout& layout)
{
    ASSERT_EQ(layout.solver_index_a.size(), layout.lanes.size());
    ASSERT_EQ(layout.solver_index_b.size(), layout.lanes.size());
    ASSERT_EQ(layout.lanes.size() % kBlock, 0u);
    ASSERT_EQ(layout.points.size(), layout.lanes.size() / kBlock);
    ASSERT_EQ(layout.body_of_solver_index[0], kNoBody);
    ASSERT_EQ(layout.lane.size(), layout.contacts.size());
    for (std::size_t i = 0; i < layout.contacts.size(); ++i)
        ASSERT_EQ(layout.lanes[layout.lane[i]].entry, layout.contacts[i]);
    std::vector<int> times(graph.contacts.entries.size(), 0);
    std::size_t block = 0, solver_index = 1, color = 0, contact = 0, slices = 0;
    for (const Batch& batch : layout.batches) {
        ASSERT_EQ(batch.first_slice, slices);
        ASSERT_GT(batch.slices, 0u);
        slices += batch.slices;
        std::size_t contacts = 0;
        for (std::uint32_t i = 0; i < batch.slices; ++i) {
            const Slice& slice = layout.slices[batch.first_slice + i];
            ASSERT_EQ(slice.first_body, solver_index);
            ASSERT_EQ(slice.first_color, color);
            ASSERT_EQ(slice.first_contact, contact);
            solver_index += slice.dynamic;
            color += slice.colors;
            contact += slice.contacts;
            contacts += slice.contacts;
            const Slice* const next = i + 1 < batch.slices ? &slice + 1 : nullptr;
            ASSERT_NO_FATAL_FAILURE(check_solver_bodies(graph, layout, slice));
            ASSERT_NO_FATAL_FAILURE(
                check_colors(graph, layout, slice, next, batch.wide, block, times));
        }
        ASSERT_EQ(batch.contacts, contacts);
        ASSERT_EQ(batch.wide, contacts > kBatchContacts);
        ASSERT_LE(batch.on_faces, batch.contacts);
    }
    ASSERT_EQ(slices, layout.slices.size());
    ASSERT_EQ(block * kBlock, layout.lanes.size());
    ASSERT_EQ(solver_index, layout.dynamic + 1u);
    ASSERT_EQ(color, layout.colors.size());
    std::size_t on_faces = 0, wanted = 0;
    for (const Batch& batch : layout.batches) on_faces += batch.on_faces;
    for (const auto& entry : graph.contacts.entries) wanted += entry.points >= 3 ? 1 : 0;
    ASSERT_EQ(on_faces, wanted);
    for (const int count : times) ASSERT_EQ(count, 1);
    for (std::uint32_t body = 0; body < layout.solver_index.size(); ++body)
        if (layout.solver_index[body] != Layout::kNoSolverIndex) {
            ASSERT_EQ(layout.body_of_solver_index[layout.solver_index[body]], body);
        }
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

// Neighbours in a row of bodies touch, and some touch those a little further on.
Graph random_row(std::uint32_t bodies, std::mt19937& random)
{
    Graph graph = random_graph(bodies, 0, random);
    for (std::uint32_t body = 0; body < bodies; ++body)
        if (random() % 8 != 0) {
            graph.states.kind[body] = BodyKind::dynamic;
            graph.states.awake[body] = 1;
        }
    const auto gone = [&](std::uint32_t x) { return graph.states.kind[x] == BodyKind::removed; };
    for (std::uint32_t body = 0; body < bodies; ++body) {
        graph.positions[body] = Vec3(0.1 * static_cast<double>(random() % 100), body, 0);
        const auto end = std::min(bodies, body + 1 + static_cast<std::uint32_t>(random() % 8));
        for (std::uint32_t other = body + 1; other < end; ++other) {
            if (gone(body) || gone(other) || (!graph.movable(body) && !graph.movable(other)))
                continue;
            const bool swapped = random() % 2 == 0;
            add_contact(graph, swapped ? other : body, swapped ? body : other,
                        1 + static_cast<int>(random() % 4));
        }
    }
    return graph;
}

TEST(LayOut, KeepsItsPromisesWhenItCuts)
{
    std::size_t cut = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        std::mt19937 random(seed);
        const Graph graph = random_row(static_cast<std::uint32_t>(600 + random() % 3000), random);
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Layout layout = laid_out(graph, {.from = 600, .slice = 30 + random() % 200});
        check_layout(graph, layout);
        if (::testing::Test::HasFatalFailure()) return;
        for (const Batch& batch : layout.batches) cut += batch.slices > 2 ? 1 : 0;
    }
    EXPECT_GT(cut, 20u);
}

// One body under all others reaches from end to end: nothing can be cut.
TEST(LayOut, DoesNotCutWhatHangsTogether)
{
    Graph graph;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        add_body(graph, BodyKind::dynamic, true);
        graph.positions.back() = Vec3(i, 0, 0);
        if (i > 0) add_contact(graph, 0, i, 1);
    }
    const Layout whole = laid_out(graph, {.from = 600, .slice = 50});
    check_layout(graph, whole);
    EXPECT_LE(whole.batches[0].slices, 2u);
    // Nor where all stand at one spot.
    for (Vec3& position : graph.positions) position.setZero();
    const Layout spot = laid_out(graph, {.from = 600, .slice = 50});
    check_layout(graph, spot);
    EXPECT_EQ(spot.batches[0].slices, 1u);
}

bool same_layout(const Layout& x, const Layout& y)
{
    const auto equal = [](const auto& a, const auto& b, auto numbers) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [&](const auto& i, const auto& k) { return numbers(i) == numbers(k); });
    };
    return x.points == y.points && x.solver_index_a == y.solver_index_a
        && x.solver_index_b == y.solver_index_b && x.contacts == y.contacts && x.lane == y.lane
        && x.body_of_solver_index == y.body_of_solver_index
        && equal(x.lanes, y.lanes, [](const LaneSource& lane) { return lane.entry; })
        && equal(x.colors, y.colors,
                 [](const Color& c) { return std::tuple(c.first, c.count, c.serial); })
        && equal(x.slices, y.slices,
                 [](const Slice& s) {
                     return std::tuple(s.first_body, s.dynamic, s.first_kinematic_copy, s.kinematic,
                                       s.first_color, s.colors, s.first_contact, s.contacts);
                 })
        && equal(x.batches, y.batches, [](const Batch& b) {
               return std::tuple(b.first_slice, b.slices, b.contacts, b.on_faces, b.wide);
           });
}

// What one step leaves behind does not show in the next: bodies fall asleep, wake, come and go.
TEST(LayOut, RemembersNothing)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        ConstraintGraph constraint_graph;
        constraint_graph.split_rule = {.from = 600, .slice = 40};
        Layout layout;
        for (int step = 0; step < 10; ++step) {
            const auto bodies = static_cast<std::uint32_t>(2 + random() % 600);
            Graph graph = step % 2 == 0 ? random_graph(bodies, random() % (4 * bodies), random)
                                        : random_row(bodies, random);
            lay_out_again(graph, constraint_graph, layout);
            ASSERT_TRUE(same_layout(layout, laid_out(graph, constraint_graph.split_rule)))
                << "seed " << seed;
            // The same again, some asleep by now, with what they touched.
            for (std::uint32_t body = 0; body < bodies; body += 3)
                if (graph.states.dynamic(body)) graph.states.awake[body] = 0;
            std::erase_if(graph.contacts.entries, [&](const auto& contact) {
                return !graph.movable(contact.body_a) && !graph.movable(contact.body_b);
            });
            lay_out_again(graph, constraint_graph, layout);
            ASSERT_NO_FATAL_FAILURE(check_layout(graph, layout)) << "seed " << seed;
            ASSERT_TRUE(same_layout(layout, laid_out(graph, constraint_graph.split_rule)))
                << "seed " << seed;
        }
    }
}

TEST(LayOut, WhoRestsStandsInPlaceOfItsSolverBody)
{
    // Two islands, the second of which touches somebody of the first who rests in the next step.
    Graph graph;
    for (std::uint32_t i = 0; i < 1200; ++i) add_body(graph, BodyKind::dynamic, true);
    for (std::uint32_t i = 0; i + 1 < 600; ++i) add_contact(graph, i, i + 1, 2);
    for (std::uint32_t i = 600; i + 1 < 1200; ++i) add_contact(graph, i, i + 1, 2);
    add_contact(graph, 3, 900, 1);
    ConstraintGraph constraint_graph;
    Layout layout;
    lay_out_again(graph, constraint_graph, layout);
    ASSERT_EQ(layout.batches.size(), 1u);
    for (std::uint32_t i = 0; i < 600; ++i) graph.states.awake[i] = 0;
    std::erase_if(graph.contacts.entries, [](const auto& at) { return at.body_b < 600; });
    lay_out_again(graph, constraint_graph, layout);
    check_layout(graph, layout);
    ASSERT_EQ(layout.batches.size(), 1u);
    EXPECT_EQ(layout.slices[0].dynamic, 600u);
    ASSERT_EQ(layout.body_of_solver_index.size(), 602u);
    EXPECT_EQ(layout.body_of_solver_index.back(), 3u);
}

TEST(LayOut, PutsConveyorsLast)
{
    Graph graph;
    add_body(graph, BodyKind::static_, false);
    add_body(graph, BodyKind::static_, false);
    add_body(graph, BodyKind::kinematic, true);
    graph.states.is_conveyor = {1};
    for (std::uint32_t i = 0; i < 700; ++i) {
        add_body(graph, BodyKind::dynamic, true);
        for (const std::uint32_t other : {0, 1, 2}) add_contact(graph, other, 3 + i, 4);
    }
    const Layout layout = laid_out(graph);
    check_layout(graph, layout);
    ASSERT_GT(layout.batches.size(), 2u);
    for (const Slice& slice : layout.slices) {
        EXPECT_EQ(slice.kinematic, 1u);
        EXPECT_EQ(layout.body_of_solver_index[slice.first_kinematic_copy], 2u);
        EXPECT_EQ(layout.body_of_solver_index[slice.first_kinematic_copy + 1u], 0u);
    }
}

TEST(LayOut, PutsWhatExceedsTheColorsOneAfterAnother)
{
    // A plate under a hundred things, each of which touches a kinematic one and the ground too.
    Graph graph;
    add_body(graph, BodyKind::dynamic, true);
    add_body(graph, BodyKind::static_, false);
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
    EXPECT_EQ(layout.slices[0].kinematic, 1u);
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
    for (const Slice& slice : layout.slices) EXPECT_EQ(slice.kinematic, 1u);
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
    EXPECT_EQ(layout.slices[0].colors, 2u);
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
