// Peer: another engine, behind as little as a comparison needs.
//
// Peers live in a module of their own that the command loads when a comparison is asked for, so
// that neither the library nor the command links them. A scene reaches them as plain numbers, in
// the frame of each body's center of mass; poses come back the same way, and what they are worth is
// measured by throng's own geometry.
#pragma once

#include "pipeline/records/peer_scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace throng::perf {

/// An engine with a scene in it. Nobody sleeps, nothing is damped; all else is as the engine has
/// it.
class Peer {
public:
    virtual ~Peer() = default;
    /// Sets what is driven, and advances.
    virtual void step(double dt) = 0;
    /// Points of contact in the last step.
    virtual std::size_t contacts() const = 0;
    /// Of every body, in the scene's order.
    virtual std::vector<PeerState> states() const = 0;
    /// What it was set to, in words.
    virtual std::string settings() const = 0;
};

/// An engine on offer.
struct PeerEntry {
    const char* name;
    std::unique_ptr<Peer> (*make)(const PeerScene& scene);  // null when it is not in this build
};

/// The kinds of shape that an engine was given here; throws std::invalid_argument for another.
[[noreturn]] void refuse_shape(const char* engine, ShapeKind kind);

std::unique_ptr<Peer> make_bullet(const PeerScene& scene);
std::unique_ptr<Peer> make_ode(const PeerScene& scene);

/// The name under which the module offers its engines: `const PeerEntry* throng_peers()`, the last
/// entry without a name.
inline constexpr const char* kPeersSymbol = "throng_peers";
using PeersFunction = const PeerEntry* (*)();

}  // namespace throng::perf
