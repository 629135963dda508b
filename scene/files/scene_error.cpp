// Scene error: bad input, with its place.
#include "scene/files/scene_error.hpp"

#include <algorithm>

namespace throng {

TextPlace place_in(std::string_view text, std::size_t at)
{
    const std::string_view before = text.substr(0, at);
    TextPlace place;
    place.line += static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
    const std::size_t newline = before.rfind('\n');
    const std::string_view line =
        newline == std::string_view::npos ? before : before.substr(newline + 1);
    // The bytes that continue a character of UTF-8 are not counted.
    place.column += static_cast<std::size_t>(std::count_if(line.begin(), line.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    }));
    return place;
}

SceneError scene_error(std::string_view file,
                       std::string_view text,
                       std::size_t at,
                       std::string_view path,
                       std::string_view wanted)
{
    const TextPlace place = place_in(text, at);
    return SceneError(std::string(file) + ':' + std::to_string(place.line) + ':'
                      + std::to_string(place.column) + ": error: " + std::string(path) + ": "
                      + std::string(wanted));
}

}  // namespace throng
