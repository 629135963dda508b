// Peer scene: a world as numbers that another engine can take, and such an engine's state as a
// world.
#pragma once

#include "apps/throng/bench/quality.hpp"
#include "perf/peers/peer.hpp"

namespace throng::bench {

/// The scene as other engines can take it: meshes that move by their convex parts, or as hulls
/// where that was asked for.
Scene scene_of_peers(Scene scene);

/// The bodies of a world as it is.
perf::PeerScene peer_scene(const World& world, const Scene& scene);

/// The state of a world as another engine would tell it.
std::vector<perf::PeerState> peer_states(const World& world);

/// What a peer's state is worth: that of throng's world of the same scene with these poses and
/// velocities. A state that is not finite counts as infinitely bad.
Quality quality_of(const Scene& scene, const std::vector<perf::PeerState>& states);

}  // namespace throng::bench
