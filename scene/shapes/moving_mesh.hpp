// Moving mesh: a stated mesh made fit to move, once for all who ask about it on its way from a file
// into a world.
#pragma once

#include "cooking/repair/mesh_health.hpp"
#include "throng/scene.hpp"

#include <memory>

namespace throng {

/// A mesh that is to move, repaired.
///
///   at      m, of its axes in the stated mesh's: 0 but for a mesh far from its own origin, which
///   is
///           taken about its middle. What is made of it is in float, and loses nothing so
///   repaired  about `at`
struct MovingMesh {
    Vec3 at = Vec3::Zero();
    RepairedMesh repaired;
};

/// Makes a mesh fit to move. The answer is kept until it is forgotten, and given again for the same
/// vertices and triangles: a scene is checked as it is read and as it becomes a world, and mending
/// takes longer than reading. Of all that is kept the oldest goes where it becomes some 100 MB.
///
/// Needs: triangles between vertices. Any number of threads may ask.
std::shared_ptr<const MovingMesh> moving_mesh(const MeshShape& stated);

/// No longer keeps what it knows of a mesh: whoever has the answer still has it.
void forget_moving_mesh(const MeshShape& stated);

}  // namespace throng
