// JSON writer: values as text that reads back to the same bits.
#pragma once

#include "throng/scene.hpp"

#include <array>
#include <concepts>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace throng {

/// What is not finite has no number in JSON: null.
std::string json_text(double number);
std::string json_text(std::initializer_list<double> numbers);
std::string json_text(const Vec3& vector);
std::string json_text(const Quat& quaternion);  // [w, x, y, z]
std::string json_text(const Sym3& matrix);      // [xx, yy, zz, xy, xz, yz]
std::string json_text(const std::vector<Vec3>& vectors);
std::string
json_text(const std::array<std::optional<double>, 3>& axes);  // null where there is none
std::string json_text(const std::string& text);
std::string json_text(Motion motion);
std::string json_text(std::same_as<std::uint64_t> auto number) { return std::to_string(number); }
std::string json_text(std::same_as<bool> auto value) { return value ? "true" : "false"; }
/// A dial's value as scene files have it: a number, or text for a fraction or a word.
std::string json_dial_value(const std::string& value);

/// The members of an object, one after another.
class JsonMembers {
public:
    /// The value is JSON already.
    JsonMembers& add(std::string_view key, std::string_view json);
    JsonMembers& add(std::string_view key, double number);
    JsonMembers& add_text(std::string_view key, std::string_view text);
    bool empty() const { return text_.empty(); }
    std::string text() const { return text_.empty() ? "{}" : text_ + '}'; }

private:
    std::string text_;
};

/// A member of the outermost object with one item a line, between the two brackets; nothing at all
/// where there are no items.
std::string
json_lines(std::string_view key, const std::vector<std::string>& items, std::string_view brackets);

}  // namespace throng
