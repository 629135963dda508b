#include "cost/changes.hpp"

#include "scene/files/json_writer.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <stdexcept>

namespace throng {

std::string text_of(const Changes& changes)
{
    std::string text;
    for (const Change& each : changes)
        text += (text.empty() ? "" : " ") + each.dial + '=' + each.value;
    return text;
}

std::string as_options(const Changes& changes)
{
    std::string text;
    for (const Change& each : changes)
        text += (text.empty() ? "--set " : " --set ") + each.dial + '=' + each.value;
    return text;
}

std::string as_settings(const Changes& changes)
{
    std::string text;
    for (const Change& each : changes)
        text +=
            (text.empty() ? "" : ", ") + json_text(each.dial) + ": " + json_dial_value(each.value);
    return "\"settings\": {" + text + '}';
}

Changes joined(const Changes& first, const Changes& second)
{
    Changes both = first;
    for (const Change& each : second) {
        const auto same = std::find_if(
            both.begin(), both.end(), [&](const Change& other) { return other.dial == each.dial; });
        if (same == both.end())
            both.push_back(each);
        else
            same->value = each.value;
    }
    return both;
}

Scene changed(const Scene& scene, const Changes& changes)
{
    Scene by = scene;
    for (const Change& each : changes) {
        const std::string trouble = set_dial(by.settings, each.dial, each.value);
        if (!trouble.empty()) throw std::invalid_argument(trouble);
        by.dials_set.push_back(each.dial);
    }
    const std::string clash = clashing_dials(by.settings);
    if (!clash.empty()) throw std::invalid_argument(clash);
    return by;
}

}  // namespace throng
