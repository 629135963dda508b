// Peer quality: what another engine's state is worth.
#pragma once

#include "apps/throng/bench/quality.hpp"
#include "pipeline/records/peer_scene.hpp"

namespace throng::bench {

/// The scene as other engines can take it: meshes that move by their convex parts, or as hulls
/// where that was asked for.
Scene scene_of_peers(Scene scene);

/// What a peer's state is worth: that of throng's world of the same scene with these poses and
/// velocities. A state that is not finite counts as infinitely bad.
Quality quality_of(const Scene& scene, const std::vector<PeerState>& states);

}  // namespace throng::bench
