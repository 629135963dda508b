// Trace option: `--trace FILE`, which keeps what the last steps of a run did on each thread.
#pragma once

#include "apps/throng/options.hpp"
#include "apps/throng/output_file.hpp"
#include "pipeline/records/trace.hpp"
#include "throng/world.hpp"

#include <memory>

namespace throng {

inline constexpr Option kTraceOption = {
    "--trace", "FILE.json",
    "the last steps on each thread, stage by stage and block by block, for ui.perfetto.dev or "
    "chrome://tracing"};
inline constexpr Option kTraceStepsOption = {
    "--trace-steps", "N", "how many steps --trace keeps, 1 to 1000 (default 10)"};

/// The trace that was asked for, if any.
class TraceOption {
public:
    /// Throws BadInput when it cannot be written.
    explicit TraceOption(const Options& options);

    bool asked_for() const { return file_.asked_for(); }
    const OutputFile& file() const { return file_; }
    /// Watches a world from now on; it must not outlive this.
    void watch(World& world);
    /// Around a step of it.
    void begin_step(std::uint64_t number);
    void end_step();
    /// Writes and completes the file. `label` says what was run. Answers what could not be written,
    /// or nothing.
    std::string write(World& world, std::string_view label);
    /// Removes what was begun of the file.
    void discard() { file_.discard(); }

private:
    OutputFile file_;
    std::unique_ptr<Trace> trace_;
};

}  // namespace throng
