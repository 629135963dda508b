#include "apps/throng/run_frames.hpp"

#include "apps/throng/options.hpp"
#include "throng/version.hpp"

namespace throng {

RunFrames::RunFrames(OutputFile& file,
                     const SceneArgument& argument,
                     const World& world,
                     std::int64_t every)
    : file_(file), world_(world), every_(every)
{
    if (!file.asked_for()) return;
    try {
        writer_.emplace(file.growing_path(), argument.scene, world,
                        RunFacts{argument.label, version(), argument.seed, every});
    } catch (const RunFileError& error) {
        throw BadInput("--out: " + file.path() + ": " + error.what());
    }
}

// The first trouble is the cause of the others.
template <class Write>
void RunFrames::attempt(Write write)
{
    try {
        write();
    } catch (const RunFileError& error) {
        if (trouble_.empty()) trouble_ = error.what();
    }
}

void RunFrames::step_done(std::int64_t step, const StepError& error, bool last)
{
    const bool wanted = last ? step != written_ : step % every_ == 0;
    if (!writer_ || !trouble_.empty() || !wanted) return;
    attempt([&] { writer_->write_frame(world_, error); });
    written_ = step;
}

void RunFrames::effects_told(std::span<const EffectEntry> effects)
{
    if (writer_ && trouble_.empty()) attempt([&] { writer_->write_effects(effects); });
}

std::string RunFrames::close()
{
    if (!writer_) return {};
    attempt([&] { writer_->close(); });
    const std::size_t frames = writer_->whole_frames();
    // What could not be closed cannot be read.
    const bool readable = writer_->closed();
    writer_.reset();
    std::string not_kept = readable ? file_.try_keep() : "";
    if (trouble_.empty()) return not_kept;
    const std::string what_is_left = readable && not_kept.empty() ? "its first "
            + std::to_string(frames) + (frames == 1 ? " frame is" : " frames are") + " there"
                                                                  : "nothing of it is left";
    return "--out: " + file_.path() + ": " + trouble_ + "; " + what_is_left;
}

}  // namespace throng
