// Events option: `--events FILE`, who began and who ceased to touch in a run, and who hit whom.
#pragma once

#include "apps/throng/options.hpp"
#include "apps/throng/output_file.hpp"
#include "throng/world.hpp"

namespace throng {

inline constexpr Option kEventsOption = {
    "--events", "FILE.csv", "who begins and ceases to touch whom, and who hits whom, step by step"};
inline constexpr Option kHitSpeedOption = {
    "--hit-speed", "V", "m/s at which two meet for --events to call it a hit (default 1)"};

/// The events that were asked for, if any: a line each, of
///
///   step, event (begin, end, hit; sense, leave of sensors), a, b (indices of bodies), part_a,
///   part_b; of hits the speed, m/s, the point and the normal, unit, from a to b
class EventsOption {
public:
    /// Throws BadInput when they cannot be written.
    explicit EventsOption(const Options& options);

    bool asked_for() const { return file_.asked_for(); }
    const OutputFile& file() const { return file_; }
    void listen(World& world);
    /// After each step of it.
    void after_step(const World& world);
    /// Completes the file. Answers what could not be written, or nothing.
    std::string try_keep() { return file_.try_keep(); }
    /// Removes what was begun of it.
    void discard() { file_.discard(); }

private:
    OutputFile file_;
    double hit_speed_ = 1;
};

}  // namespace throng
