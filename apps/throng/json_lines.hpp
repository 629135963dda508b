// JSON lines: what the command writes for programs, put together from its members.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

namespace throng {

/// Writes the members of an object, one a line.
class JsonLines {
public:
    explicit JsonLines(std::ostream& out);
    /// The value is JSON already.
    void add(std::string_view key, const std::string& json);
    void add(std::string_view key, double number);
    void add(std::string_view key, std::uint64_t number);
    void end();

private:
    std::ostream& out_;
    bool first_ = true;
};

/// text(item) of every item, with `between` from one to the next.
template <class List, class Text>
std::string joined(const List& list, std::string_view between, const Text& text)
{
    std::string all;
    for (const auto& item : list) all += (all.empty() ? "" : std::string(between)) + text(item);
    return all;
}

}  // namespace throng
