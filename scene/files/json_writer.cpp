// JSON writer: values as text that reads back to the same bits.
#include "scene/files/json_writer.hpp"

#include "scene/files/json.hpp"
#include "scene/names.hpp"

#include <bit>
#include <cstdint>

namespace throng {

bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const Vec3& a, const Vec3& b)
{
    return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y()) && same_bits(a.z(), b.z());
}

bool same_bits(const Quat& a, const Quat& b)
{
    return same_bits(a.w(), b.w()) && same_bits(a.vec(), b.vec());
}

std::string json_text(double number) { return number_text(number); }

std::string json_text(std::initializer_list<double> numbers)
{
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "[" : ", ") + number_text(number);
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

void JsonMembers::add(std::string_view key, std::string_view value)
{
    text_ += text_.empty() ? "{" : ", ";
    text_ += json_string(key);
    text_ += ": ";
    text_ += value;
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
