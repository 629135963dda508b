// Step times: what steps and their stages took, over a run of any length.
#pragma once

#include "throng/report.hpp"

#include <cstdint>
#include <deque>
#include <span>
#include <string_view>
#include <vector>

namespace throng {

/// Times of one kind: their mean, and their percentiles from an even sample.
class TimeSample {
public:
    void add(double time_ms);
    double total() const { return total_; }
    double greatest() const { return greatest_; }
    std::uint64_t count() const { return count_; }
    double mean() const { return count_ == 0 ? 0 : total_ / static_cast<double>(count_); }
    /// The time that the given part of all stay at or below; 0 when there are none.
    double percentile(double part) const;

private:
    double total_ = 0, greatest_ = 0;
    std::uint64_t count_ = 0;
    std::uint64_t every_ = 1;  // which of the times are in the sample
    std::vector<double> sample_;
};

/// Times of the steps of a run, and of each stage in them.
class StepTimes {
public:
    struct OfStage {
        std::string_view name;
        TimeSample times;
    };

    void add(double step_ms, std::span<const StageReport> stages);
    const TimeSample& steps() const { return steps_; }
    /// In the order in which they were met first: that of the step.
    const std::deque<OfStage>& stages() const { return stages_; }
    /// Of each, the time a step on the average.
    std::vector<StageReport> mean_stages() const;

private:
    TimeSample steps_;
    std::deque<OfStage> stages_;
};

}  // namespace throng
