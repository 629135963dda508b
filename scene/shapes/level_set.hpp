// Level set: what the public one holds.
#pragma once

#include "kernels/data/solids.hpp"
#include "throng/level_set.hpp"

namespace throng {

/// A signed distance and where it is 0.
///
///   field    what is inside is known to any depth
///   surface  but for a thousandth of a voxel; closed even where the level set ends before its
///            surface does: it is cut off there. Vertex normals included
///   whole    the surface ends nowhere but in itself, so that the shape has a volume and may move
///   error    m, of the field against the mesh it was made from, at the greatest; 0 where none is
///            known
struct LevelSet {
    VoxelBricks field;
    Mesh surface;
    bool whole = false;
    double error = 0;
};

/// Whether two are the same in every bit that a step could feel.
bool same_level_set(const LevelSet& a, const LevelSet& b);

}  // namespace throng
