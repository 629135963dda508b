// JSON lines: what the command writes for programs, put together from its members.
#include "apps/throng/json_lines.hpp"

#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"

namespace throng {

JsonLines::JsonLines(std::ostream& out) : out_(out) { out_ << '{'; }

void JsonLines::add(std::string_view key, const std::string& json)
{
    out_ << (first_ ? "\n  " : ",\n  ") << json_string(key) << ": " << json;
    first_ = false;
}

void JsonLines::add(std::string_view key, double number) { add(key, json_text(number)); }

void JsonLines::add(std::string_view key, std::uint64_t number)
{
    add(key, std::to_string(number));
}

void JsonLines::end() { out_ << "\n}\n"; }

}  // namespace throng
