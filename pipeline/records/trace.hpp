// Trace: which stage and which block of its loops ran when on which thread, in the last steps.
//
// For looking at: Chrome's trace format, which chrome://tracing and ui.perfetto.dev show as rows of
// bars, one row a thread. A world that nobody traces does nothing for it.
#pragma once

#include "kernels/parallel/block_watch.hpp"
#include "pipeline/step/step_graph.hpp"

#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <ostream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace throng {

class World;

/// Keeps what the last steps of one world did. Have it watch a world (watch_steps()), and
/// call begin_step() before and end_step() after each of its steps.
class Trace final : public StepWatch {
public:
    /// Of one thread in one step; what goes beyond is counted and left out.
    static constexpr std::size_t kMostEvents = std::size_t{1} << 16;

    explicit Trace(std::size_t steps_kept);
    ~Trace() override;
    Trace(const Trace&) = delete;
    Trace& operator=(const Trace&) = delete;

    void begin_step(std::uint64_t number);
    void end_step();
    void run_stage(std::string_view name, const std::function<void()>& stage) override;

    /// How many of the steps it holds.
    std::size_t steps() const;
    /// Stages and blocks that did not fit.
    std::uint64_t left_out() const;

    /// A stage and one that waits for it, by name.
    struct Wait {
        std::string_view earlier, later;
    };
    /// Writes the steps, oldest first, as one JSON object; times in microseconds from the first of
    /// them. Waits become arrows. `label` says what was run.
    void write(std::string_view label, const std::vector<Wait>& waits, std::ostream& out) const;

private:
    using Clock = std::chrono::steady_clock;
    class Blocks;

    struct Event {
        std::string_view stage;
        std::int64_t block = kWholeStage;
        Clock::time_point begin, end;
    };
    static constexpr std::int64_t kWholeStage = -1;

    /// What one thread did, by the step's slot. Nobody else writes there.
    struct Row {
        std::thread::id thread;
        std::vector<std::vector<Event>> steps;
        std::uint64_t left_out = 0;
    };
    struct Step {
        std::uint64_t number = 0;
        Clock::time_point begin, end;
    };

    Row& row_of_thread();
    void add(const Event& event);
    std::vector<std::size_t> slots_in_order() const;
    static void write_bar(std::string_view name,
                          std::string_view kind,
                          std::size_t row,
                          const Event& event,
                          Clock::time_point zero,
                          std::ostream& out);
    void write_arrows(const std::vector<Wait>& waits,
                      std::size_t slot,
                      Clock::time_point zero,
                      std::ostream& out) const;

    const std::uint64_t id_;  // no two traces share one, not even one after another
    std::size_t slot_ = 0;
    std::uint64_t begun_ = 0;
    std::vector<Step> kept_;
    std::mutex guard_;  // of rows_, not of what is in them
    std::deque<Row> rows_;
};

/// Has the trace watch a world's steps from now on; the world must not outlive it.
void watch_steps(World& world, Trace& trace);

}  // namespace throng
