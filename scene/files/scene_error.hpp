// Scene error: bad input, with its place.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace throng {

/// Refused input. what() reads `file:line:col: error: path: what was wanted`.
class SceneError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

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

}  // namespace throng
