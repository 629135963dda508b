// Peer scene: a world as plain numbers that another engine can take.
#pragma once

#include "kernels/data/shapes.hpp"
#include "throng/world.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace throng {

/// A shape as a body wears it.
struct PeerShape {
    ShapeKind kind = ShapeKind::sphere;
    Vec3 size = Vec3::Zero();  // half extents of a box, normal of a plane; else radius, half length
    std::uint32_t index = 0;   // place in PeerScene::hulls, of a hull; in meshes, of a mesh
    Pose local;                // from the center of mass, body axes

    /// It is where its body is, turned as its body is.
    bool is_centered() const;
};

struct PeerTriangles {
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
    Vec3 force = Vec3::Zero();                   // N, world axes, at the center of mass, constant
    std::array<std::optional<double>, 3> drive;  // m/s, set before every step where given
    std::uint32_t first_shape = 0, shapes = 0;
};

struct PeerScene {
    Vec3 gravity = Vec3::Zero();
    std::vector<PeerTriangles> hulls, meshes;
    std::vector<PeerShape> shapes;
    std::vector<PeerBody> bodies;
};

/// Where a body is and how it moves, of the center of mass.
struct PeerState {
    Pose pose;
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

inline bool PeerShape::is_centered() const
{
    // A hull's center of mass is found by sums that round: a billionth of a body is no offset.
    const double extent = size.cwiseAbs().maxCoeff() > 0 ? size.cwiseAbs().maxCoeff() : 1;
    return local.position.cwiseAbs().maxCoeff() <= 1e-9 * extent
        && local.orientation.vec().cwiseAbs().maxCoeff() <= 1e-12;
}

/// The bodies of a world as it is.
PeerScene peer_scene(const World& world, const Scene& scene);

/// The state of a world as another engine would tell it.
std::vector<PeerState> peer_states(const World& world);

}  // namespace throng
