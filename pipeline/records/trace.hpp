// Trace: which stage and which block of its loops ran when on which thread, in the last steps.
//
// For looking at: Chrome's trace format, which chrome://tracing and ui.perfetto.dev show as rows of
// bars, one row a thread. A world that nobody traces does nothing for it.
#pragma once

#include <cstdint>
#include <memory>
#include <ostream>
#include <string_view>
#include <vector>

namespace throng {

class World;

/// Keeps what the last steps of one world did. Have it watch a world, and call begin_step() before
/// and end_step() after each of its steps.
class Trace {
public:
    /// Of one thread in one step; what goes beyond is counted and left out.
    static constexpr std::size_t kMostEvents = std::size_t{1} << 16;

    explicit Trace(std::size_t steps_kept);
    ~Trace();
    Trace(Trace&&) noexcept;
    Trace& operator=(Trace&&) noexcept;

    /// Sees a world's steps from now on; the world must not outlive it, unless leave() is called.
    void watch(World& world);
    static void leave(World& world);

    void begin_step(std::uint64_t number);
    void end_step();

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
    class Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace throng
