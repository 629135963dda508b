// JSON writer: values as text that reads back to the same bits.
#include "scene/files/json_writer.hpp"

#include "scene/fields.hpp"
#include "scene/files/json.hpp"
#include "scene/names.hpp"

#include <cmath>

namespace throng {

std::string json_text(double number)
{
    return std::isfinite(number) ? number_text(number) : "null";
}

std::string json_text(std::initializer_list<double> numbers)
{
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "[" : ", ") + json_text(number);
    return text + ']';
}

std::string json_text(const Vec3& vector)
{
    return json_text({vector.x(), vector.y(), vector.z()});
}

std::string json_text(const Quat& quaternion)
{
    return json_text({quaternion.w(), quaternion.x(), quaternion.y(), quaternion.z()});
}

std::string json_text(const Sym3& matrix)
{
    return json_text({matrix.xx, matrix.yy, matrix.zz, matrix.xy, matrix.xz, matrix.yz});
}

std::string json_text(const std::vector<Vec3>& vectors)
{
    std::string text;
    for (const Vec3& vector : vectors) text += (text.empty() ? "[" : ", ") + json_text(vector);
    return text.empty() ? "[]" : text + ']';
}

std::string json_text(const std::array<std::optional<double>, 3>& axes)
{
    const auto axis = [](const std::optional<double>& of) { return of ? json_text(*of) : "null"; };
    return '[' + axis(axes[0]) + ", " + axis(axes[1]) + ", " + axis(axes[2]) + ']';
}

std::string json_text(const std::string& text) { return json_string(text); }

std::string json_text(Motion motion)
{
    return json_string(kMotions[static_cast<std::size_t>(motion)]);
}

std::string json_dial_value(const std::string& value)
{
    return std::isnan(parse_number(value)) ? json_string(value) : value;
}

JsonMembers& JsonMembers::add(std::string_view key, std::string_view json)
{
    text_ += text_.empty() ? "{" : ", ";
    text_ += json_string(key);
    text_ += ": ";
    text_ += json;
    return *this;
}

JsonMembers& JsonMembers::add(std::string_view key, double number)
{
    return add(key, json_text(number));
}

JsonMembers& JsonMembers::add_text(std::string_view key, std::string_view text)
{
    return add(key, json_string(text));
}

std::string
json_lines(std::string_view key, const std::vector<std::string>& items, std::string_view brackets)
{
    if (items.empty()) return {};
    std::string text = ",\n  " + json_string(key) + ": " + brackets[0];
    for (std::size_t i = 0; i < items.size(); ++i) {
        text += i ? ",\n    " : "\n    ";
        text += items[i];
    }
    return text + "\n  " + brackets[1];
}

}  // namespace throng
