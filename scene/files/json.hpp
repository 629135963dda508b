// JSON: a strict reader that remembers where everything stood.
//
// Written here because errors of meaning need a place as much as errors of syntax: the libraries at
// hand forget where a value stood, or take twice the memory to remember. A document is one array of
// small nodes in the order of the text; a place is worked out only when there is an error to
// report.
#pragma once

#include "scene/files/scene_error.hpp"
#include "scene/scene_path.hpp"

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace throng {

/// Length of the UTF-8 character at the start of the bytes; 0 where they are none.
std::size_t utf8_length(std::string_view bytes);

/// A text as a JSON string, quotes included. Throws std::invalid_argument when it is no UTF-8.
std::string json_string(std::string_view text);

enum class JsonKind : std::uint8_t { null, boolean, number, string, array, object };

/// A text as a tree of values. Refuses what RFC 8259 does, and duplicate keys, numbers beyond
/// double, lone surrogates, more than 64 levels, and texts of 4 GiB or more.
class JsonDocument {
public:
    static constexpr int kDeepest = 64;

    /// A value: its place in the array of nodes. A member's key is a string right before its value.
    using Node = std::uint32_t;
    static constexpr Node kRoot = 0;

    /// Throws SceneError; file is what the error calls the text.
    JsonDocument(std::string text, std::string file);

    JsonKind kind(Node node) const { return nodes_[node].kind; }
    double number(Node node) const { return nodes_[node].number; }
    bool boolean(Node node) const { return nodes_[node].number != 0; }
    /// The content of a string; the digits of a number.
    std::string_view text(Node node) const;

    /// Elements of an array, members of an object.
    std::size_t size(Node node) const { return nodes_[node].size; }
    /// First element or first key; equal to next(node) when there is none.
    Node first(Node node) const { return node + 1; }
    /// What follows the value and all that is in it.
    Node next(Node node) const { return nodes_[node].next; }
    /// The value of a key, or kRoot when the object has no such key.
    Node find(Node object, std::string_view key) const;

    /// How the value is reached from the top.
    ScenePath path(Node node) const;
    /// The value that a path leads to, or the last one on the way that exists.
    Node resolve(const ScenePath& path) const;

    /// The error for a value (or key): its place, then its path, then what was wanted.
    SceneError error(Node node, std::string_view wanted) const;
    SceneError error(Node node, const ScenePath& path, std::string_view wanted) const;

private:
    friend class JsonParser;
    struct Item {
        double number = 0;       // of a string with escapes: place in unescaped_
        std::uint32_t at = 0;    // first byte in the text
        std::uint32_t size = 0;  // bytes of a string or number; elements; members
        std::uint32_t next = 0;
        JsonKind kind = JsonKind::null;
        bool escaped = false;
    };
    std::string text_, file_;
    std::vector<Item> nodes_;
    std::deque<std::string> unescaped_;  // strings whose text has escapes
};

}  // namespace throng
