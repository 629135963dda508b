// Scene path: which part of a scene is meant, by name.
#include "scene/scene_path.hpp"

#include "scene/names.hpp"

#include <algorithm>

namespace throng {
namespace {

bool is_plain(const std::string& key)
{
    const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')
            || c == '_' || c == '-';
    };
    return !key.empty() && key.size() <= 60 && std::all_of(key.begin(), key.end(), plain);
}

}  // namespace

std::string path_text(const ScenePath& path)
{
    if (path.empty()) return "scene";
    std::string text;
    for (const PathStep& step : path) {
        if (step.is_index)
            text += "[" + std::to_string(step.index) + "]";
        else if (!is_plain(step.key))
            text += "[" + in_quotes(step.key) + "]";
        else
            text += (text.empty() ? "" : ".") + step.key;
    }
    return text;
}

}  // namespace throng
