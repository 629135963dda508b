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

NoteLine::NoteLine(bool wanted)
    : on_(wanted && ::isatty(STDERR_FILENO) == 1), begin_(Clock::now()), last_(begin_)
{ }

bool NoteLine::is_due()
{
    if (!on_) return false;
    const auto now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) return false;
    last_ = now;
    return true;
}

double NoteLine::seconds() const { return std::chrono::duration<double>(last_ - begin_).count(); }

void NoteLine::show(const std::string& note)
{
    constexpr std::size_t kMost = 100;  // letters, so that the line is one
    if (is_due()) write(duration_text(seconds()) + ", " + note.substr(0, kMost));
}

void NoteLine::write(const std::string& line)
{
    std::fprintf(stderr, "\r\x1b[K%s", line.c_str());
    std::fflush(stderr);
    shown_ = true;
}

void NoteLine::clear()
{
    if (shown_) std::fputs("\r\x1b[K", stderr);
    shown_ = false;
}

void Progress::show(std::int64_t done, std::size_t bodies_awake)
{
    if (done > 0 && line_.is_due()) write(done, std::to_string(bodies_awake) + " awake");
}

void Progress::show(std::int64_t done, const std::string& note)
{
    if (done > 0 && line_.is_due()) write(done, note);
}

void Progress::write(std::int64_t done, const std::string& note)
{
    const double each = line_.seconds() / static_cast<double>(done);
    const double part = static_cast<double>(done) / static_cast<double>(steps_);
    const auto filled = static_cast<std::size_t>(part * kWidth);
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    char figures[96];
    std::snprintf(figures, sizeof figures, "] %lld/%lld steps, %.3g ms/step, ",
                  static_cast<long long>(done), static_cast<long long>(steps_), each * 1e3);
    line_.write('[' + bar + figures + duration_text(each * static_cast<double>(steps_ - done))
                + " left, " + note);
}

}  // namespace throng
