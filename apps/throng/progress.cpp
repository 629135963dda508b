// Progress: how far a run is, on a terminal and nowhere else.
#include "apps/throng/progress.hpp"

#include <cstdio>
#include <string>
#include <unistd.h>

namespace throng {
namespace {

constexpr int kWidth = 30;  // of the bar, letters

std::string duration_text(double seconds)
{
    char text[32];
    if (seconds < 60)
        std::snprintf(text, sizeof text, "%.0f s", seconds);
    else if (seconds < 3600)
        std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
    else
        std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
    return text;
}

}  // namespace

Progress::Progress(std::int64_t steps, bool wanted)
    : steps_(steps), on_(wanted && ::isatty(STDERR_FILENO) == 1), begin_(Clock::now()),
      last_(begin_)
{ }

Progress::~Progress() { clear(); }

void Progress::clear()
{
    if (shown_) std::fputs("\r\x1b[K", stderr);
    shown_ = false;
}

bool Progress::is_due(std::int64_t done)
{
    if (!on_ || done == 0) return false;
    const auto now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) return false;
    last_ = now;
    return true;
}

void Progress::show(std::int64_t done, std::size_t bodies_awake)
{
    if (is_due(done)) write(done, std::to_string(bodies_awake) + " awake");
}

void Progress::show(std::int64_t done, const std::string& note)
{
    if (is_due(done)) write(done, note);
}

void Progress::write(std::int64_t done, const std::string& note)
{
    const double seconds = std::chrono::duration<double>(last_ - begin_).count();
    const double each = seconds / static_cast<double>(done);
    const double part = static_cast<double>(done) / static_cast<double>(steps_);
    const auto filled = static_cast<std::size_t>(part * kWidth);
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    std::fprintf(stderr, "\r\x1b[K[%s] %lld/%lld steps, %.3g ms/step, %s left, %s", bar.c_str(),
                 static_cast<long long>(done), static_cast<long long>(steps_), each * 1e3,
                 duration_text(each * static_cast<double>(steps_ - done)).c_str(), note.c_str());
    std::fflush(stderr);
    shown_ = true;
}

NoteLine::NoteLine(bool wanted)
    : on_(wanted && ::isatty(STDERR_FILENO) == 1), begin_(Clock::now()), last_(begin_)
{ }

NoteLine::~NoteLine()
{
    if (shown_) std::fputs("\r\x1b[K", stderr);
}

void NoteLine::show(const std::string& note)
{
    const auto now = Clock::now();
    if (!on_ || (shown_ && now - last_ < std::chrono::milliseconds(100))) return;
    last_ = now;
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    constexpr std::size_t kMost = 100;  // letters, so that the line is one
    std::fprintf(stderr, "\r\x1b[K%s, %s", duration_text(seconds).c_str(),
                 note.substr(0, kMost).c_str());
    std::fflush(stderr);
    shown_ = true;
}

}  // namespace throng
