#include "cost/sweep/trials.hpp"

namespace throng {

std::string with_unit(const std::string& figure, const Quantity& quantity)
{
    return quantity.unit == "1" ? figure : figure + ' ' + quantity.unit;
}

std::string label_of(const Quantity& quantity)
{
    return quantity.unit == "1" ? quantity.name : quantity.name + ", " + quantity.unit;
}

WindowTrials::WindowTrials(const Scene& scene, const Windows& windows)
    : scene_(scene), windows_(windows)
{ }

Trial WindowTrials::run(const Changes& changes, std::size_t trial, double patience) const
{
    const WindowRun run = windows_.run(changed(scene_, changes), trial, patience);
    return {run.errors, run.time_ms};
}

double WindowTrials::time_ms(const Changes& changes, std::size_t trial) const
{
    return windows_.time_ms(changed(scene_, changes), trial);
}

std::vector<StageTime> WindowTrials::stage_times(const Changes& changes) const
{
    return windows_.stage_times(changed(scene_, changes));
}

std::vector<Quantity> WindowTrials::of_windows()
{
    std::vector<Quantity> all;
    for (std::size_t i = 0; i < kMeasures; ++i) {
        const MeasureInfo& each = info(static_cast<Measure>(i));
        all.push_back({std::string(each.name), std::string(each.unit), std::string(each.about)});
    }
    return all;
}

}  // namespace throng
