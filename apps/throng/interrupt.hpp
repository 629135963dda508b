// Interrupt: somebody wants the command to end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace throng {

/// From now on SIGINT, SIGTERM and SIGHUP are noted and do nothing else, so that the step ends and
/// files are closed. A second one ends the process at once.
void note_interrupts();

/// One was noted.
bool interrupted();

/// Ends the process where an interrupt finds a step that is not done within its patience: some take
/// minutes. One lives at a time.
class StepGuard {
public:
    static constexpr std::chrono::milliseconds kPatience{800};

    /// last_words: closes files, from another thread, while the step still runs: it may touch
    /// nothing that a step does.
    explicit StepGuard(std::function<void()> last_words);
    ~StepGuard();
    StepGuard(const StepGuard&) = delete;
    StepGuard& operator=(const StepGuard&) = delete;

    void begin_step() { set_within(true); }
    void end_step() { set_within(false); }

private:
    void set_within(bool within);
    void watch();

    std::function<void()> last_words_;
    std::mutex guard_;
    std::condition_variable ended_;
    bool within_ = false, over_ = false;
    std::thread watch_;
};

}  // namespace throng
