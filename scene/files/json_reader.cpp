// JSON reader: values of a document as the types a caller wants, or an error with their place.
#include "scene/files/json_reader.hpp"

#include "scene/names.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

void JsonReader::refuse(Node node, const std::string& wanted) const
{
    throw json_.error(node, wanted);
}

void JsonReader::refuse_value(Node node, std::string_view wanted) const
{
    const auto shown = [&]() -> std::string {
        switch (json_.kind(node)) {
        case JsonKind::null:
            return "null";
        case JsonKind::boolean:
            return json_.boolean(node) ? "true" : "false";
        case JsonKind::number:
            return std::string(json_.text(node).substr(0, 40));
        case JsonKind::string:
            return in_quotes(json_.text(node));
        case JsonKind::array:
            return "a list of " + std::to_string(json_.size(node));
        case JsonKind::object:
            return "an object";
        }
        return {};
    };
    refuse(node, "wanted " + std::string(wanted) + ", not " + shown());
}

void JsonReader::refuse_name(Node node, std::string_view what, Keys known) const
{
    const std::string near = nearest_names(json_.text(node), known);
    std::string wanted = "wanted " + std::string(what) + ", not " + in_quotes(json_.text(node));
    if (!near.empty())
        wanted += "; perhaps " + near;
    else if (!known.empty() && known.size() <= 12)
        wanted += "; known: " + either_of(known);
    refuse(node, wanted);
}

JsonReader::Node JsonReader::need(Node node, JsonKind kind, std::string_view what) const
{
    if (json_.kind(node) != kind) refuse_value(node, what);
    return node;
}

double JsonReader::number(Node node) const
{
    return json_.number(need(node, JsonKind::number, "a number"));
}

bool JsonReader::boolean(Node node) const
{
    return json_.boolean(need(node, JsonKind::boolean, "true or false"));
}

std::string_view JsonReader::text(Node node) const
{
    return json_.text(need(node, JsonKind::string, "text"));
}

std::string_view JsonReader::text_or_number(Node node) const
{
    if (json_.kind(node) != JsonKind::number) need(node, JsonKind::string, "a number or text");
    return json_.text(node);
}

double JsonReader::whole(Node node, double greatest) const
{
    const double value = json_.kind(node) == JsonKind::number ? json_.number(node) : -1;
    if (!(value >= 0 && value <= greatest && value == std::floor(value)))
        refuse_value(node,
                     "a whole number from 0 to "
                         + std::to_string(static_cast<std::uint64_t>(greatest)));
    return value;
}

template <std::size_t count>
std::array<double, count> JsonReader::numbers(Node node, std::string_view what) const
{
    if (json_.kind(node) != JsonKind::array || json_.size(node) != count) refuse_value(node, what);
    std::array<double, count> values{};
    Node at = json_.first(node);
    for (double& value : values) {
        value = number(at);
        at = json_.next(at);
    }
    return values;
}

Vec3 JsonReader::vector(Node node) const
{
    const auto [x, y, z] = numbers<3>(node, "three numbers [x, y, z]");
    return {x, y, z};
}

Quat JsonReader::quaternion(Node node) const
{
    const auto [w, x, y, z] = numbers<4>(node, "a quaternion [w, x, y, z]");
    return {w, x, y, z};
}

Sym3 JsonReader::symmetric(Node node) const
{
    const auto [xx, yy, zz, xy, xz, yz] = numbers<6>(node, "six numbers [xx, yy, zz, xy, xz, yz]");
    return {xx, yy, zz, xy, xz, yz};
}

JsonReader::Node
JsonReader::required(Node object, std::string_view key, std::string_view wanted) const
{
    need(object, JsonKind::object, "an object");
    if (const Node member = json_.find(object, key)) return member;
    // What is not there has no place: that of the object it should be in.
    ScenePath path = json_.path(object);
    path.emplace_back(std::string(key));
    throw json_.error(object, path, "wanted " + std::string(wanted));
}

void JsonReader::need_keys(Node object, Keys known, Keys more) const
{
    each_member(object, [&](Node key, Node) {
        const auto has = [name = json_.text(key)](Keys keys) {
            return std::find(keys.begin(), keys.end(), name) != keys.end();
        };
        if (has(known) || has(more)) return;
        std::vector<std::string_view> all(known.begin(), known.end());
        all.insert(all.end(), more.begin(), more.end());
        refuse_name(key, "a known key", all);
    });
}

}  // namespace throng
