// Scene reader: a document into a Scene, as it is stated.
#pragma once

#include "scene/files/json.hpp"
#include "throng/scene_file.hpp"

namespace throng {

/// Values have the right types, names have been looked up, files read. Whether it all makes sense
/// is still to be asked (scene/rules/scene_check.hpp). Throws SceneError.
Scene scene_of(const JsonDocument& json, const std::string& folder, const FileReader& files);

}  // namespace throng
