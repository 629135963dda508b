// Random graphs of bodies and contacts, for tests of islands and colors.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/contacts.hpp"

#include <random>

namespace throng::given {

struct Graph {
    BodyStates states;
    ActiveContacts contacts;
    std::vector<Vec3> positions;

    bool movable(std::uint32_t body) const { return states.movable(body); }
    std::vector<std::uint32_t> movable_bodies() const
    {
        std::vector<std::uint32_t> bodies;
        for (std::uint32_t body = 0; body < states.kind.size(); ++body)
            if (movable(body)) bodies.push_back(body);
        return bodies;
    }
};

inline void add_body(Graph& graph, BodyKind kind, bool awake)
{
    graph.states.kind.push_back(kind);
    graph.states.awake.push_back(awake ? 1 : 0);
    graph.positions.push_back(Vec3::Zero());
}

/// Some bodies still (every second one a conveyor), kinematic, asleep or gone; every contact has a
/// movable side.
inline Graph random_graph(std::uint32_t bodies, std::size_t contacts, std::mt19937& random)
{
    Graph graph;
    for (std::uint32_t i = 0; i < bodies; ++i) switch (random() % 10) {
        case 0:
            add_body(graph, BodyKind::static_, false);
            graph.states.is_conveyor.resize(i + std::size_t{1});
            graph.states.is_conveyor[i] = random() % 2 == 0;
            break;
        case 1:
            add_body(graph, BodyKind::kinematic, true);
            break;
        case 2:
            add_body(graph, BodyKind::dynamic, false);
            break;
        case 3:
            add_body(graph, BodyKind::removed, false);
            break;
        default:
            add_body(graph, BodyKind::dynamic, true);
        }
    for (std::size_t i = 0; i < contacts; ++i) {
        const auto a = static_cast<std::uint32_t>(random() % bodies);
        const auto b = static_cast<std::uint32_t>(random() % bodies);
        const auto gone = [&](std::uint32_t x) {
            return graph.states.kind[x] == BodyKind::removed;
        };
        if (a == b || gone(a) || gone(b) || (!graph.movable(a) && !graph.movable(b))) continue;
        ActiveContacts::Entry entry;
        entry.body_a = a;
        entry.body_b = b;
        entry.list_index = static_cast<std::uint32_t>(i);
        entry.points = static_cast<std::uint8_t>(1 + random() % 4);
        graph.contacts.entries.push_back(entry);
    }
    return graph;
}

}  // namespace throng::given
