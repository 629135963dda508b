// Mesh file: triangles from a Wavefront OBJ text, and back; or from an STL file (stl_file.hpp).
//
// Of an OBJ text vertices and faces are read, polygons cut into triangles (polygon_cut.hpp says
// how); what else a file may say (normals, textures, groups, materials) is passed over.
#pragma once

#include "throng/math.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace throng {

/// Bytes; far beyond what a step could take.
inline constexpr std::uint64_t kGreatestMeshFile = std::uint64_t{4} << 30;

struct MeshFile {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A mesh by what the bytes are, OBJ or STL; those of other formats are refused by their name.
/// Throws SceneError. The answer may be empty.
MeshFile read_mesh_file(std::string_view bytes, std::string_view file);

/// Throws SceneError, in which the path is the keyword of the line: `cow.obj:7:3: error: f: wanted
/// ...`. The answer may be empty.
MeshFile read_mesh_text(std::string_view text, std::string_view file);

/// A text that reads back to the same bits.
std::string mesh_text(const MeshFile& mesh);

}  // namespace throng
