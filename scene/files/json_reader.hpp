// JSON reader: values of a document as the types a caller wants, or an error with their place.
#pragma once

#include "scene/files/json.hpp"
#include "throng/math.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace throng {

using Keys = std::span<const std::string_view>;

/// Asks one document. Every refusal reads `wanted THIS, not THAT`.
class JsonReader {
public:
    using Node = JsonDocument::Node;

    explicit JsonReader(const JsonDocument& json) : json_(json) { }

    [[noreturn]] void refuse(Node node, const std::string& wanted) const;
    /// The same, and what stands there instead.
    [[noreturn]] void refuse_value(Node node, std::string_view wanted) const;
    /// A name that is none of the known ones; says which are near.
    [[noreturn]] void refuse_name(Node node, std::string_view what, Keys known) const;

    JsonKind kind(Node node) const { return json_.kind(node); }
    Node need(Node node, JsonKind kind, std::string_view what) const;
    double number(Node node) const;
    bool boolean(Node node) const;
    std::string_view text(Node node) const;
    /// The text, or the digits of a number.
    std::string_view text_or_number(Node node) const;
    double whole(Node node, double greatest) const;
    Vec3 vector(Node node) const;
    Quat quaternion(Node node) const;
    Sym3 symmetric(Node node) const;

    /// A member, or JsonDocument::kRoot (which is false) where there is none.
    Node find(Node object, std::string_view key) const { return json_.find(object, key); }
    Node required(Node object, std::string_view key, std::string_view wanted) const;
    /// Refuses members with other keys.
    void need_keys(Node object, Keys known, Keys more = {}) const;

    /// Visits each element of a list.
    template <class Visitor>
    void each(Node list, Visitor visit) const
    {
        need(list, JsonKind::array, "a list");
        for (Node at = json_.first(list); at != json_.next(list); at = json_.next(at)) visit(at);
    }
    /// Visits key and value of each member.
    template <class Visitor>
    void each_member(Node object, Visitor visit) const
    {
        need(object, JsonKind::object, "an object");
        for (Node at = json_.first(object); at != json_.next(object); at = json_.next(at + 1))
            visit(at, at + 1);
    }

protected:
    template <std::size_t count>
    std::array<double, count> numbers(Node node, std::string_view what) const;

    const JsonDocument& json_;
};

}  // namespace throng
