// Level set: a shape told by how far every place is from its surface, as .vdb files hold it.
//
// It may be large: bodies, shapes and scenes share one, and none of them changes it.
#pragma once

#include "throng/box3.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace throng {

/// A signed distance and the surface where it is 0; see facts_of().
struct LevelSet;

/// What there is to know of a level set.
///
///   voxel      m, the side of one
///   error      m, of the distances against the mesh they were made from, at the greatest; 0 where
///              none is known
///   whole      the surface ends nowhere but in itself, so that the shape has a volume and may move
///   bounds     m, of the surface
///   triangles  of the surface
struct LevelSetFacts {
    double voxel = 0, error = 0;
    bool whole = false;
    Box3 bounds;
    std::size_t triangles = 0;
};
LevelSetFacts facts_of(const LevelSet& level_set);

/// A level set, or what is wrong and what is wanted.
struct LevelSetResult {
    std::shared_ptr<const LevelSet> level_set;
    std::string trouble;
};

/// From the bytes of a .vdb file: its first float level set. Its voxels must be cubes along the
/// axes. Damage is told of files that throng wrote; OpenVDB, which reads those of other tools, sees
/// little of it.
LevelSetResult read_level_set(std::string bytes);

/// Of triangles that enclose a volume, whichever way they are turned.
///
///   voxel  m; 0: a 48th of the longest side
///   band   m, how far outside distances are known; at least 3 voxels. What is round and no larger
///          than the band less 1.8 voxels touches as exactly as the field tells
LevelSetResult make_level_set(const std::vector<Vec3>& vertices,
                              const std::vector<std::array<std::uint32_t, 3>>& triangles,
                              double voxel = 0,
                              double band = 0);

/// Writes a .vdb file that reads back to the same bits, with a checksum behind it. Answers what
/// went wrong, or nothing.
std::string write_level_set(const LevelSet& level_set, const std::string& path);

}  // namespace throng
