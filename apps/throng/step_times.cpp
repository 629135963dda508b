// Step times: what steps and their stages took, over a run of any length.
#include "apps/throng/step_times.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

void TimeSample::add(double time_ms)
{
    // Past this many, every second one is dropped: a run of days stays small, and its sample even.
    constexpr std::size_t kMost = 1 << 16;
    if (count_++ % every_ == 0) sample_.push_back(time_ms);
    total_ += time_ms;
    greatest_ = std::max(greatest_, time_ms);
    if (sample_.size() < kMost) return;
    for (std::size_t i = 0; 2 * i < sample_.size(); ++i) sample_[i] = sample_[2 * i];
    sample_.resize(sample_.size() / 2);
    every_ *= 2;
}

double TimeSample::percentile(double part) const
{
    if (sample_.empty()) return 0;
    std::vector<double> sorted = sample_;
    const double rank = std::ceil(part * static_cast<double>(sorted.size()));
    const auto place = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(place),
                     sorted.end());
    return sorted[place];
}

void StepTimes::add(double step_ms, std::span<const StageReport> stages)
{
    steps_.add(step_ms);
    for (std::size_t i = 0; i < stages.size(); ++i) {
        // The list hardly ever changes, so a stage is mostly where it was.
        const auto named = [&](const OfStage& known) { return known.name == stages[i].name; };
        auto found = i < stages_.size() && named(stages_[i])
            ? stages_.begin() + static_cast<std::ptrdiff_t>(i)
            : std::find_if(stages_.begin(), stages_.end(), named);
        if (found == stages_.end()) found = stages_.insert(found, {stages[i].name, {}});
        found->times.add(stages[i].time_ms);
    }
}

std::vector<StageReport> StepTimes::mean_stages() const
{
    std::vector<StageReport> means;
    const auto count = static_cast<double>(std::max<std::uint64_t>(1, steps_.count()));
    for (const OfStage& stage : stages_) means.push_back({stage.name, stage.times.total() / count});
    return means;
}

}  // namespace throng
