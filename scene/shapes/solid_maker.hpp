// Solid maker: a stated mesh made into what a moving body collides as, by the way it is to be
// taken; and a level set into what any body does.
#pragma once

#include "kernels/data/shapes.hpp"
#include "kernels/geometry/mass.hpp"
#include "throng/scene.hpp"

#include <string>
#include <variant>
#include <vector>

namespace throng {

/// What a moving mesh or a level set became: one solid, or convex parts of it.
///
///   at       m, of the shape's axes in the mesh's: 0 but for a mesh far from its own origin
///   mass     in the mesh's axes, of unit density: of the mesh where it is closed, else of what its
///            way makes of it
///
///   summary  how it is taken, and how exactly
///
///   warnings  what was found wrong with the mesh and what was done about it, as sentences
///
///   trouble  empty, or why it cannot be had, and what would do
struct MadeSolid {
    std::variant<Solid, std::vector<Hull>> shape;
    Vec3 at = Vec3::Zero();
    MassProperties mass;
    std::string summary;
    std::vector<std::string> warnings;
    std::string trouble;
};

/// What a mesh is made by: its own way and dials where it states them, else the scene's.
Settings settings_of(const MeshShape& mesh, Settings scene);

/// Makes a mesh that is to move, by settings_of() it.
///
///   cache_folder  where fields, parts and spheres are kept between runs; empty: nowhere
MadeSolid
make_solid(const MeshShape& mesh, const Settings& settings, const std::string& cache_folder);

/// By voxels, whatever the dial says. Mass is that of its surface, and none where this is cut off.
MadeSolid make_solid(const LevelSet& level_set);

}  // namespace throng
