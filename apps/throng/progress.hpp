// Progress: how far a run is, on a terminal and nowhere else.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace throng {

class Progress {
public:
    /// Silent unless wanted and the standard error is a terminal.
    Progress(std::int64_t steps, bool wanted);
    /// Takes its line away.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(std::int64_t done, std::size_t bodies_awake);
    /// The note says what is at work.
    void show(std::int64_t done, const std::string& note);
    /// Takes its line away until there is more to show, so that something else can be written.
    void clear();

private:
    /// Whether it is time to show something; the eye takes in no more than ten a second.
    bool is_due(std::int64_t done);
    void write(std::int64_t done, const std::string& note);

    using Clock = std::chrono::steady_clock;
    std::int64_t steps_ = 0;
    bool on_ = false, shown_ = false;
    Clock::time_point begin_, last_;
};

/// A line that says what is at work, where nobody knows how much of it there is.
class NoteLine {
public:
    /// Silent unless wanted and the standard error is a terminal.
    explicit NoteLine(bool wanted);
    /// Takes its line away.
    ~NoteLine();
    NoteLine(const NoteLine&) = delete;
    NoteLine& operator=(const NoteLine&) = delete;

    void show(const std::string& note);

private:
    using Clock = std::chrono::steady_clock;
    bool on_ = false, shown_ = false;
    Clock::time_point begin_, last_;
};

}  // namespace throng
