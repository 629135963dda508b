// Run frames: the frames of a run, as long as there is room for them on the disk.
#pragma once

#include "apps/throng/output_file.hpp"
#include "apps/throng/scene_argument.hpp"
#include "throng/run_file.hpp"

#include <optional>

namespace throng {

/// The frames of a run, where they are asked for. A run goes on without them where they cannot be
/// written: what was written stays, and its other outputs are there in the end.
class RunFrames {
public:
    /// Throws BadInput where the file cannot even be begun.
    RunFrames(OutputFile& file,
              const SceneArgument& argument,
              const World& world,
              std::int64_t every);
    /// After a step, of which this is told; the last one is a frame whatever its number.
    void step_done(std::int64_t step, const StepError& error, bool last);
    /// As the run ended.
    void effects_told(std::span<const EffectEntry> effects);
    bool asked_for() const { return writer_.has_value(); }
    /// Closes the file. Answers what went wrong since it was begun, and what is there, or nothing.
    std::string close();

private:
    template <class Write>
    void attempt(Write write);

    OutputFile& file_;
    const World& world_;
    std::int64_t every_ = 1, written_ = -1;
    std::optional<RunFile> writer_;
    std::string trouble_;
};

}  // namespace throng
