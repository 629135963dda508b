// Progress: how far a run is, on a terminal and nowhere else.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace throng {

/// A line on a terminal that is written anew, and taken away in the end.
class NoteLine {
public:
    /// Silent unless wanted and the standard error is a terminal.
    explicit NoteLine(bool wanted);
    /// Takes its line away.
    ~NoteLine() { clear(); }
    NoteLine(const NoteLine&) = delete;
    NoteLine& operator=(const NoteLine&) = delete;

    /// Whether it is time to show something; the eye takes in no more than ten a second.
    bool is_due();
    /// s, from when it was made to when it was last due.
    double seconds() const;
    /// Says what is at work and for how long, where nobody knows how much of it there is.
    void show(const std::string& note);
    /// The line as it is given, due or not.
    void write(const std::string& line);
    void clear();

private:
    using Clock = std::chrono::steady_clock;
    bool on_ = false, shown_ = false;
    Clock::time_point begin_, last_;
};

class Progress {
public:
    /// Silent unless wanted and the standard error is a terminal.
    Progress(std::int64_t steps, bool wanted) : line_(wanted), steps_(steps) { }

    void show(std::int64_t done, std::size_t bodies_awake);
    /// The note says what is at work.
    void show(std::int64_t done, const std::string& note);
    /// Takes its line away until there is more to show, so that something else can be written.
    void clear() { line_.clear(); }

private:
    void write(std::int64_t done, const std::string& note);

    NoteLine line_;
    std::int64_t steps_ = 0;
};

}  // namespace throng
