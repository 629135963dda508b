// Scene error: how bad input is told, with its place.
#pragma once

#include "scene/rules/scene_check.hpp"
#include "throng/scene_file.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace throng {

/// Lines and columns count from 1; a column is a character, however many bytes it takes.
struct TextPlace {
    std::size_t line = 1, column = 1;
};

/// Where a byte of a text is.
TextPlace place_in(std::string_view text, std::size_t at);

/// The error for a byte of a file's text.
SceneError scene_error(std::string_view file,
                       std::string_view text,
                       std::size_t at,
                       std::string_view path,
                       std::string_view wanted);

/// The error for a part of a scene that was read from a file and cannot become a world, with its
/// place there.
SceneError error_in_scene(const std::string& path, const SceneTrouble& trouble);

}  // namespace throng
