// Orders: how fast errors fall as a dial is turned.
#pragma once

#include "cost/sweep/sweep.hpp"

#include <optional>

namespace throng {

/// The power with which an error grows with a step.
///
///   dial    dt or substeps; of substeps the step is what they cut dt into
///   order   slope of log error over log step, by least squares
///   points  that it was fitted to
///   helps   the last value that brought the error down by a tenth or more; empty where none did
struct FittedOrder {
    std::string dial;
    double order = 0;
    std::size_t points = 0;
    std::string helps;
};

/// By the points in which that dial alone differs from the scene, above what the reference is off
/// by; none where there are less than three.
std::optional<FittedOrder> fitted_order(const Scene& scene,
                                        const SweepResult& found,
                                        std::string_view dial,
                                        std::size_t measure,
                                        double floor);

}  // namespace throng
