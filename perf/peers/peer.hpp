// Peer: another engine, behind as little as a comparison needs.
//
// Peers live in a module of their own that the command loads when a comparison is asked for, so
// that neither the library nor the command links them. A scene reaches them as plain numbers, in
// the frame of each body's center of mass; poses come back the same way, and what they are worth is
// measured by throng's own geometry.
#pragma once

#include "kernels/data/shapes.hpp"
#include "pipeline/scene.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace throng::perf {

/// A shape as a body wears it.
struct PeerShape {
    ShapeKind kind = ShapeKind::sphere;
    Vec3 size = Vec3::Zero();  // half extents of a box; else radius and half length
    std::uint32_t hull = 0;    // place in PeerScene::hulls, of a hull
    Pose local;                // from the center of mass, body axes

    /// It is where its body is, turned as its body is.
    bool is_centered() const;
};

struct PeerHull {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

struct PeerBody {
    Motion motion = Motion::dynamic;
    double mass = 0;  // kg; 0 unless dynamic
    Sym3 inertia;     // kg m2 about the center of mass, body axes
    Pose pose;        // of the center of mass
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
    double friction = 0, restitution = 0;
    bool lock_rotation = false;
    std::array<std::optional<double>, 3> drive;  // m/s, set before every step where given
    std::uint32_t first_shape = 0, shapes = 0;
};

struct PeerScene {
    Vec3 gravity = Vec3::Zero();
    std::vector<PeerHull> hulls;
    std::vector<PeerShape> shapes;
    std::vector<PeerBody> bodies;
};

/// Where a body is and how it moves, of the center of mass.
struct PeerState {
    Pose pose;
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

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
