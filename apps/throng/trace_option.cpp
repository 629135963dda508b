// Trace option: `--trace FILE`, which keeps what the last steps of a run did on each thread.
#include "apps/throng/trace_option.hpp"

namespace throng {

TraceOption::TraceOption(const Options& options) : file_("--trace", options.text("--trace"))
{
    const std::int64_t steps = options.whole("--trace-steps", 10, 1, 1000);
    if (file_.asked_for())
        trace_ = std::make_unique<Trace>(static_cast<std::size_t>(steps));
    else if (options.has("--trace-steps"))
        throw BadInput("--trace-steps: says how many steps --trace keeps; give --trace as well");
}

void TraceOption::watch(World& world)
{
    if (trace_) trace_->watch(world);
}

void TraceOption::begin_step(std::uint64_t number)
{
    if (trace_) trace_->begin_step(number);
}

void TraceOption::end_step()
{
    if (trace_) trace_->end_step();
}

std::string TraceOption::write(World& world, std::string_view label)
{
    if (!trace_) return {};
    const std::vector<World::StageInfo> stages = world.step_stages();
    std::vector<Trace::Wait> waits;
    for (const World::StageInfo& stage : stages)
        for (const std::size_t earlier : stage.waits_for)
            waits.push_back({stages[earlier].name, stage.name});
    trace_->write(label, waits, file_.stream());
    return file_.try_keep();
}

}  // namespace throng
