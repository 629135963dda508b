// Peer at: an engine that the user has built, behind an adapter that is built for it here.
#pragma once

#include "apps/throng/bench/engine.hpp"

#include <string_view>

namespace throng::bench {

/// Which engine, and where it is.
struct PeerAt {
    std::string name, directory;
};

/// `box3d=DIR`, `jolt=DIR` or `physx=DIR`. Throws BadInput.
PeerAt peer_at(std::string_view text);

/// The engine on each of these numbers of threads. Builds its adapter, which takes CMake, a
/// compiler and some seconds; throws BadInput where that fails.
std::vector<EngineKind> engines_at(const PeerAt& peer, const std::vector<int>& threads);

}  // namespace throng::bench
