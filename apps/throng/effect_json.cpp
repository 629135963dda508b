#include "apps/throng/effect_json.hpp"

#include "apps/throng/json_lines.hpp"
#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/names.hpp"

namespace throng {

std::string effect_ledger_json(const std::vector<EffectEntry>& entries)
{
    const auto item = [](const EffectEntry& entry) {
        return "\n    "
            + JsonMembers()
                  .add_text("effect", name_of(entry.effect))
                  .add("on", entry.on ? "true" : "false")
                  .add("first", entry.first.empty() ? "null" : json_string(entry.first))
                  .add("callers", std::to_string(entry.callers))
                  .add("stages", '[' + joined(entry.stages, ", ", json_string) + ']')
                  .add("ms", entry.ms)
                  .add("rows", std::to_string(entry.rows))
                  .add("bytes", std::to_string(entry.bytes))
                  .add("neglected", std::to_string(entry.neglected))
                  .add("bound", entry.bound)
                  .text();
    };
    return '[' + joined(entries, ",", item) + ']';
}

}  // namespace throng
