// Scene file: JSON in and out.
//
// SI units, radians, quaternions [w, x, y, z]. An error names file, line, column, path and what was
// wanted; scene/files/scene.schema.json describes the format for other programs.
#pragma once

#include "throng/scene.hpp"

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace throng {

/// Refused input. what() reads `file:line:col: error: path: what was wanted`.
class SceneError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What a file holds.
struct FileContent {
    std::string bytes;       // at most as many as were asked for
    std::uint64_t size = 0;  // of the whole file
    std::string trouble;     // empty, or why it cannot be read
};

/// How the files that a scene names are read; at most `limit` bytes of each are wanted.
using FileReader = std::function<FileContent(const std::string& path, std::uint64_t limit)>;

/// Reads from the disk.
FileContent read_file(const std::string& path, std::uint64_t limit);

/// Reads and checks a scene; its name is that of the file, without what follows the last dot.
/// Throws SceneError.
Scene read_scene(const std::string& path);

/// The same from a text. Files that the scene names are looked for in folder; file is what errors
/// call the text.
Scene read_scene_text(std::string text,
                      const std::string& file,
                      const std::string& folder,
                      const FileReader& reader = read_file);

/// Writes a scene that reads back to the same values, bit for bit, save for Scene::name.
///
/// Instances go to bulk files beside it, `NAME.0.bin`, unless their own file holds them already;
/// up to a thousand without one are written as bodies. So do meshes that programs made, as
/// `NAME.SHAPE.obj`, and level sets, as `NAME.SHAPE.vdb`. Throws std::runtime_error where a file
/// cannot be written or a scene cannot be told (a spring to one of many instances has no name to be
/// told by).
void write_scene(const Scene& scene, const std::string& path);

}  // namespace throng
