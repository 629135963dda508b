#include "cost/sweep/orders.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Times what the reference is off by, from where an error can be told.
constexpr double kAbove = 3;
constexpr double kHelps = 0.9;

struct Placed {
    double step = 0, error = 0;
    std::string value;
};

}  // namespace

std::optional<FittedOrder> fitted_order(const Scene& scene,
                                        const SweepResult& found,
                                        std::string_view dial,
                                        std::size_t measure,
                                        double floor)
{
    std::vector<Placed> placed;
    for (const Point& point : found.points) {
        const bool alone =
            point.changes.empty() || (point.changes.size() == 1 && point.changes[0].dial == dial);
        if (!alone || !point.had() || !std::isfinite(point.error(measure))) continue;
        const Settings settings = changed(scene, point.changes).settings;
        const double step = dial == "dt" ? settings.dt : settings.dt / settings.substeps;
        placed.push_back(
            {step, point.error(measure), point.changes.empty() ? "" : point.changes[0].value});
    }
    std::sort(placed.begin(), placed.end(),
              [](const Placed& a, const Placed& b) { return a.step > b.step; });
    FittedOrder fitted{std::string(dial), 0, 0, {}};
    double x = 0, y = 0, xx = 0, xy = 0, best = std::numeric_limits<double>::infinity();
    for (const Placed& each : placed) {
        if (each.error < kHelps * best) {
            if (std::isfinite(best) && !each.value.empty()) fitted.helps = each.value;
            best = each.error;
        }
        if (!(each.error > kAbove * floor)) continue;
        const double at = std::log(each.step), error = std::log(each.error);
        ++fitted.points;
        x += at;
        y += error;
        xx += at * at;
        xy += at * error;
    }
    if (fitted.points < 3) return {};
    const auto count = static_cast<double>(fitted.points);
    fitted.order = (count * xy - x * y) / (count * xx - x * x);
    return fitted;
}

}  // namespace throng
