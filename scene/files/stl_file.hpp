// STL file: triangles from a stereolithography file, in text or in bytes.
//
// Either says each corner of each triangle anew: corners of the same bits become one vertex.
// Normals, names and colors are passed over, since the corners say which way round a triangle is;
// several solids of one file are one mesh. An STL file names no unit: a mesh's `scale` does.
#pragma once

#include "scene/files/mesh_file.hpp"

namespace throng {

/// Whether these are an STL file's bytes, whatever its name.
bool is_stl(std::string_view bytes);

/// Throws SceneError. In a text the path is the keyword that was wanted or met, `cow.stl:7:3:
/// error: vertex: wanted ...`; in bytes the place is told by byte and triangle, `cow.stl: byte 134:
/// error: triangle 2: wanted ...`, both counted from 1 but bytes from 0.
MeshFile read_stl(std::string_view bytes, std::string_view file);

}  // namespace throng
