// Run file: the run, written while it runs, in HDF5.
//
// F frames of N bodies, in the order of their ids; SI units, world axes. Each dataset says its unit
// in the attribute `unit`.
//
//   /                         attributes: throng (version), scene, seed, dt, every, gravity
//   /dials                    attributes: each dial's value as text
//   /bodies/name              [N] text, empty where a body has none
//   /bodies/motion            [N] 0 static, 1 kinematic, 2 dynamic
//   /bodies/mass              [N] kg, 0 unless dynamic
//   /bodies/shape_kind        [N] a place in its attribute `kinds`: none, sphere, capsule, ...
//   /bodies/size              [N, 3] m: radius of a sphere; radius and half length of a capsule or
//                             cylinder; half extents of a box; 0 for the rest
//   /effects/name             [E] text, of each effect (effect_ledger.hpp); of a run that ended
//   /effects/on, callers, ms, rows, bytes, neglected, bound  [E] as at its end; ms a step
//   /effects/first            [E] text, who calls first
//   /frames/step, time        [F] steps done; s
//   /frames/position          [F, N, 3] of the body's own frame, double
//   /frames/orientation       [F, N, 4] w, x, y, z, of the body's own frame, float
//   /frames/velocity          [F, N, 3] of the center of mass, float
//   /frames/angular_velocity  [F, N, 3] float
//   /frames/error             [F] m, rms over bodies, what the last step before was about off by
//   /frames/greatest_error    [F] m, of any body; 0 where nobody estimated it, as is the one above
//                             (error_estimate.hpp)
//   /frames/worst_body        [F] whose that was, by its place among the N; 4294967295: nobody's
//
// `time` grows last, so its length is the number of frames that are whole. What was written is
// flushed every second or so: after a crash all but the last moments can be read. Room on the disk
// is made sure of before anything is written, so that what was written before the disk was full can
// be read, too. A program that uses HDF5 itself closes its own files: with a run file about, HDF5
// no longer does so at exit.
#pragma once

#include "throng/effect_ledger.hpp"
#include "throng/error_estimate.hpp"
#include "throng/world.hpp"

#include <memory>
#include <span>
#include <stdexcept>

namespace throng {

/// A run file could not be written; what() says why.
class RunFileError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What a run file says of the run besides the world.
struct RunFacts {
    std::string scene;    // as its user calls it
    std::string version;  // of throng
    std::uint64_t seed = 0;
    std::int64_t every = 1;  // steps from one frame to the next
};

class RunFile {
public:
    static constexpr double kBytesPerBody = 64;  // in each frame, before compression

    /// Starts the file of a world that was made of the scene and nothing else. All members throw
    /// RunFileError.
    RunFile(const std::string& path, const Scene& scene, const World& world, const RunFacts& facts);
    /// Closes the file, whatever comes of it.
    ~RunFile();
    RunFile(RunFile&&) noexcept;
    RunFile& operator=(RunFile&&) noexcept;

    /// Adds the world as it is now, and what its last step was about off by. After this has failed
    /// there are no more frames.
    void write_frame(const World& world, const StepError& error = {});
    /// Adds what effects the run called for and what they cost; once, and before the file is
    /// closed.
    void write_effects(std::span<const EffectEntry> effects);
    /// Writes what is left and closes the file; where a frame has failed, closes it with those that
    /// are whole.
    void close();
    bool closed() const { return !inside_; }
    /// How many there are that are whole; the others wait to be written.
    std::size_t whole_frames() const;

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
    std::size_t whole_frames_ = 0;  // once it is closed
};

}  // namespace throng
