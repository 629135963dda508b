#include "cost/sweep/idle_dials.hpp"

#include <algorithm>

namespace throng {

namespace {

bool is_without(const Changes& less, const Changes& changes, const std::string& dial)
{
    Changes rest = changes;
    std::erase_if(rest, [&](const Change& each) { return each.dial == dial; });
    return less == rest;
}

bool err_alike(const Point& a, const Point& b, std::size_t measure)
{
    const std::size_t both = std::min(a.errors.size(), b.errors.size());
    for (std::size_t k = 0; k < both; ++k)
        if (of(a.errors[k], measure) != of(b.errors[k], measure)) return false;
    return true;
}

}  // namespace

std::vector<std::string> idle_dials(std::span<const Point> points, std::size_t measure)
{
    std::vector<std::string> idle, matter;
    const auto note = [](std::vector<std::string>& list, const std::string& dial) {
        if (std::find(list.begin(), list.end(), dial) == list.end()) list.push_back(dial);
    };
    const bool none_errs = std::all_of(points.begin(), points.end(), [&](const Point& point) {
        return !point.had() || point.error(measure) == 0;
    });
    if (none_errs) return {};
    for (const Point& point : points) {
        if (!point.had()) continue;
        for (const Change& each : point.changes) {
            const auto without =
                std::find_if(points.begin(), points.end(), [&](const Point& other) {
                    return other.had() && is_without(other.changes, point.changes, each.dial);
                });
            if (without == points.end()) continue;
            note(err_alike(point, *without, measure) ? idle : matter, each.dial);
        }
    }
    std::erase_if(idle, [&](const std::string& dial) {
        return std::find(matter.begin(), matter.end(), dial) != matter.end();
    });
    return idle;
}

}  // namespace throng
