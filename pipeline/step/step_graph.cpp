#include "pipeline/step/step_graph.hpp"

#include <chrono>

namespace throng {

template <class Real>
std::vector<std::pair<std::size_t, std::size_t>> waits(const std::vector<Stage<Real>>& stages)
{
    const std::size_t count = stages.size();
    std::vector<std::pair<std::size_t, std::size_t>> found;
    std::vector<std::vector<bool>> behind(count, std::vector<bool>(count, false));
    for (std::size_t later = 0; later < count; ++later) {
        // Nearest first, so that a wait already implied by a nearer one is seen as such.
        for (std::size_t earlier = later; earlier-- > 0;) {
            if (behind[later][earlier] || !stages[later].waits_for(stages[earlier])) continue;
            found.emplace_back(earlier, later);
            behind[later][earlier] = true;
            for (std::size_t i = 0; i < earlier; ++i)
                if (behind[earlier][i]) behind[later][i] = true;
        }
    }
    return found;
}

template <class Real>
void StepGraph<Real>::run_stage(std::size_t place)
{
    const WorkCountScope counted(count_);
    if (watch_ == nullptr)
        time_stage(place);
    else
        watch_->run_stage(stages_[place].name, [this, place] { time_stage(place); });
}

template <class Real>
void StepGraph<Real>::time_stage(std::size_t place)
{
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    stages_[place].run(*data_);
    times_[place] = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

template <class Real>
void StepGraph<Real>::run_in_order()
{
    for (std::size_t place = 0; place < stages_.size(); ++place) run_stage(place);
}

template std::vector<std::pair<std::size_t, std::size_t>> waits(const std::vector<Stage<float>>&);
template std::vector<std::pair<std::size_t, std::size_t>> waits(const std::vector<Stage<double>>&);
template void StepGraph<float>::run_stage(std::size_t);
template void StepGraph<double>::run_stage(std::size_t);
template void StepGraph<float>::time_stage(std::size_t);
template void StepGraph<double>::time_stage(std::size_t);
template void StepGraph<float>::run_in_order();
template void StepGraph<double>::run_in_order();

}  // namespace throng
