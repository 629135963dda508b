// Error estimate: what each step is about off by, told beside the steps and without a reference.
//
// Kept by whoever asks; a world that nobody keeps one of spends nothing on it.
#pragma once

#include "throng/world.hpp"

#include <cstdint>
#include <memory>

namespace throng {

/// Of one step.
///
///   step      steps done when it ended; 0: none was seen
///   rms       m, over dynamic bodies that are awake and sound, of how far it may have put their
///             centers of mass from where they should be
///   greatest  m, of any of them
///   worst     whose that is; of index kNone where there is nobody
struct StepError {
    std::uint64_t step = 0;
    double rms = 0, greatest = 0;
    BodyId worst{kNone, 0};
};

/// Tells of each step how far its end may be from where the exact motion would have led from its
/// beginning. A step has two ways to say where it leads: where it put a body, and the mean of the
/// velocities that it found and left, times dt; they part by the square of dt where nothing hits
/// anything, and by as much as an impact's time is unknown where something does. What contacts hold
/// has a share of what they stop besides, as they give way.
///
/// It is made to be rather too great than too small: beside exact ends it is less than half of the
/// truth in 2 % of steps, and more than 7 times the truth in half of them (docs/accuracy.md, H103).
/// It knows nothing of what a scene leaves out, of shapes that are not what they stand for, nor of
/// how errors add up over steps.
///
/// Source: Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I (1993), II.4: the
///         difference of two rules as the error of the lesser.
class ErrorEstimate {
public:
    ErrorEstimate();
    ~ErrorEstimate();
    ErrorEstimate(ErrorEstimate&&) noexcept;
    ErrorEstimate& operator=(ErrorEstimate&&) noexcept;

    /// Looks at a world before a step and after it. Bodies that come or go in between are left out.
    void before_step(const World& world);
    void after_step(const World& world);

    /// Of the last step, and of that in which a body had the greatest of all.
    const StepError& last() const;
    const StepError& worst() const;
    /// m, over all steps and their bodies.
    double rms() const;

private:
    class Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
