// JSON: what a document answers; json_parser.cpp makes one.
#include "scene/files/json.hpp"

#include <stdexcept>

namespace throng {

std::size_t utf8_length(std::string_view bytes)
{
    const auto byte = [&](std::size_t i) {
        return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u;
    };
    const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
    const unsigned lead = byte(0), second = byte(1);
    if (lead < 0x80) return 1;
    if (lead < 0xc2 || lead > 0xf4 || !continues(1)) return 0;
    if (lead < 0xe0) return 2;
    // Overlong forms, surrogates, and what lies beyond U+10FFFF.
    if (lead == 0xe0 && second < 0xa0) return 0;
    if (lead == 0xed && second > 0x9f) return 0;
    if (lead == 0xf0 && second < 0x90) return 0;
    if (lead == 0xf4 && second > 0x8f) return 0;
    if (!continues(2)) return 0;
    if (lead < 0xf0) return 3;
    return continues(3) ? 4 : 0;
}

std::string json_string(std::string_view text)
{
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string out = "\"";
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t length = utf8_length(text.substr(at, 4));
        if (length == 0) throw std::invalid_argument("wanted text in UTF-8");
        const auto byte = static_cast<unsigned char>(text[at]);
        if (byte < 0x20) {
            out += "\\u00";
            out += kHex[byte >> 4];
            out += kHex[byte & 15];
        } else {
            if (byte == '"' || byte == '\\') out += '\\';
            out += text.substr(at, length);
        }
        at += length;
    }
    return out + '"';
}

std::string_view JsonDocument::text(Node node) const
{
    const Item& item = nodes_[node];
    if (item.escaped) return unescaped_[static_cast<std::size_t>(item.number)];
    const std::size_t quote = item.kind == JsonKind::string ? 1 : 0;
    return std::string_view(text_).substr(item.at + quote, item.size);
}

JsonDocument::Node JsonDocument::find(Node object, std::string_view key) const
{
    for (Node at = first(object); at != next(object); at = next(at + 1))
        if (text(at) == key) return at + 1;
    return kRoot;
}

ScenePath JsonDocument::path(Node node) const
{
    ScenePath path;
    Node at = kRoot;
    while (at != node) {
        const bool object = kind(at) == JsonKind::object;
        const Node end = next(at);
        Node child = first(at);
        std::size_t place = 0;
        // A key leads to the same path as its value.
        for (Node after = child; after != end; ++place) {
            after = next(object ? child + 1 : child);
            if (node < after) break;
            child = after;
        }
        if (child == end) break;
        if (object)
            path.emplace_back(std::string(text(child)));
        else
            path.emplace_back(place);
        if (object && node == child) break;
        at = object ? child + 1 : child;
    }
    return path;
}

JsonDocument::Node JsonDocument::resolve(const ScenePath& path) const
{
    Node at = kRoot;
    for (const PathStep& step : path) {
        if (kind(at) != (step.is_index ? JsonKind::array : JsonKind::object)) break;
        if (!step.is_index) {
            const Node found = find(at, step.key);
            if (found == kRoot) break;
            at = found;
            continue;
        }
        if (step.index >= size(at)) break;
        Node element = first(at);
        for (std::size_t i = 0; i < step.index; ++i) element = next(element);
        at = element;
    }
    return at;
}

SceneError JsonDocument::error(Node node, std::string_view wanted) const
{
    return error(node, path(node), wanted);
}

SceneError JsonDocument::error(Node node, const ScenePath& path, std::string_view wanted) const
{
    return scene_error(file_, text_, nodes_[node].at, path_text(path), wanted);
}

}  // namespace throng
