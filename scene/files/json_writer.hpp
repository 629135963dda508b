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

/// Whether two values are the same to the last bit, the sign of a zero included.
bool same_bits(double a, double b);
bool same_bits(const Vec3& a, const Vec3& b);

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
std::string json_text(std::same_as<bool> auto value) { return value ? "true" : "false"; }

/// The members of an object, one after another.
class JsonMembers {
public:
    /// The value is JSON already.
    JsonMembers& add(std::string_view key, std::string_view json);
    JsonMembers& add(std::string_view key, double number);
    JsonMembers& add_text(std::string_view key, std::string_view text);
    /// Only where it differs from its default.
    template <class Value>
    void add(std::string_view key, const Value& value, const Value& standard)
    {
        if (!same_bits(value, standard)) add(key, json_text(value));
    }
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
