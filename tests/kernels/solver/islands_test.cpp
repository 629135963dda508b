// Islands: union-find against a search through the graph.
#include "kernels/solver/islands.hpp"

#include "tests/kernels/solver/random_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

namespace throng {
namespace {

using given::Graph;
using given::random_graph;

// Breadth first from each body in turn, smallest first.
Islands islands_by_search(const Graph& graph)
{
    const auto bodies = static_cast<std::uint32_t>(graph.states.kind.size());
    const auto& contacts = graph.contacts.entries;
    Islands islands;
    islands.body_begin = islands.contact_begin = {0};
    std::vector<bool> seen(bodies, false);
    for (std::uint32_t start = 0; start < bodies; ++start) {
        if (!graph.movable(start) || seen[start]) continue;
        std::vector<std::uint32_t> island, of_island;
        std::deque<std::uint32_t> next = {start};
        seen[start] = true;
        while (!next.empty()) {
            const std::uint32_t body = next.front();
            next.pop_front();
            island.push_back(body);
            for (const auto& contact : contacts) {
                if (contact.body_a != body && contact.body_b != body) continue;
                const std::uint32_t other =
                    contact.body_a == body ? contact.body_b : contact.body_a;
                if (!graph.movable(other) || seen[other]) continue;
                seen[other] = true;
                next.push_back(other);
            }
        }
        std::sort(island.begin(), island.end());
        for (std::uint32_t i = 0; i < contacts.size(); ++i)
            for (const std::uint32_t side : {contacts[i].body_a, contacts[i].body_b})
                if (std::binary_search(island.begin(), island.end(), side)) {
                    of_island.push_back(i);
                    break;
                }
        if (of_island.empty()) {
            islands.lone.push_back(start);
            continue;
        }
        islands.bodies.insert(islands.bodies.end(), island.begin(), island.end());
        islands.contacts.insert(islands.contacts.end(), of_island.begin(), of_island.end());
        islands.body_begin.push_back(static_cast<std::uint32_t>(islands.bodies.size()));
        islands.contact_begin.push_back(static_cast<std::uint32_t>(islands.contacts.size()));
    }
    return islands;
}

TEST(Islands, AreThoseOfASearchThroughTheGraph)
{
    for (unsigned seed = 0; seed < 400; ++seed) {
        std::mt19937 random(seed);
        const auto bodies = static_cast<std::uint32_t>(1 + random() % 120);
        const Graph graph = random_graph(bodies, random() % (2 * bodies), random);
        Islands got;
        IslandFinder().find(graph.contacts, graph.states, graph.movable_bodies(), {}, got);
        const Islands wanted = islands_by_search(graph);
        ASSERT_EQ(got.body_begin, wanted.body_begin) << "seed " << seed;
        ASSERT_EQ(got.bodies, wanted.bodies) << "seed " << seed;
        ASSERT_EQ(got.contact_begin, wanted.contact_begin) << "seed " << seed;
        ASSERT_EQ(got.contacts, wanted.contacts) << "seed " << seed;
        ASSERT_EQ(got.lone, wanted.lone) << "seed " << seed;
    }
}

TEST(Islands, HoldTheSameBodiesWhateverTheOrderOfContacts)
{
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937 random(seed);
        Graph graph = random_graph(100, 90, random);
        Islands before, after;
        IslandFinder().find(graph.contacts, graph.states, graph.movable_bodies(), {}, before);
        std::shuffle(graph.contacts.entries.begin(), graph.contacts.entries.end(), random);
        for (auto& contact : graph.contacts.entries) std::swap(contact.body_a, contact.body_b);
        IslandFinder().find(graph.contacts, graph.states, graph.movable_bodies(), {}, after);
        ASSERT_EQ(before.body_begin, after.body_begin) << "seed " << seed;
        ASSERT_EQ(before.bodies, after.bodies) << "seed " << seed;
        ASSERT_EQ(before.contact_begin, after.contact_begin) << "seed " << seed;
    }
}

TEST(Islands, OfNothingAreNone)
{
    Islands islands;
    IslandFinder().find({}, {}, {}, {}, islands);
    EXPECT_EQ(islands.size(), 0u);
    EXPECT_TRUE(islands.lone.empty());
}

// Enough for many blocks of the loop, in chains that only meet late.
TEST(Islands, DoNotDependOnThreads)
{
    std::mt19937 random(1);
    const std::uint32_t bodies = 60'000;
    const Graph graph = random_graph(bodies, bodies, random);
    Islands wanted;
    IslandFinder().find(graph.contacts, graph.states, graph.movable_bodies(), {}, wanted);
    ASSERT_GT(wanted.size(), 1000u);
    ThreadPool pool(4);
    IslandFinder finder;
    for (int again = 0; again < 5; ++again) {
        Islands got;
        pool.run([&](std::size_t, std::size_t, std::size_t) {
            finder.find(graph.contacts, graph.states, graph.movable_bodies(), {}, got);
        });
        ASSERT_EQ(got.body_begin, wanted.body_begin);
        ASSERT_EQ(got.bodies, wanted.bodies);
        ASSERT_EQ(got.contact_begin, wanted.contact_begin);
        ASSERT_EQ(got.contacts, wanted.contacts);
        ASSERT_EQ(got.lone, wanted.lone);
    }
}

}  // namespace
}  // namespace throng
