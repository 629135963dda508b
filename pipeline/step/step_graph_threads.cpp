// The step graph on plain threads: rounds of stages whose waits are over, each round on the pool.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/step/step_graph.hpp"

#include <algorithm>

namespace throng {

template <class Real>
struct StepGraph<Real>::Nodes {
    std::vector<std::vector<std::size_t>> rounds;
};

template <class Real>
StepGraph<Real>::StepGraph(std::vector<Stage<Real>> stages, StepData<Real>& data)
    : stages_(std::move(stages)), data_(&data), times_(stages_.size(), 0.0),
      nodes_(std::make_unique<Nodes>())
{
    std::vector<std::size_t> round(stages_.size(), 0);
    for (const auto& [earlier, later] : waits(stages_))
        round[later] = std::max(round[later], round[earlier] + 1);
    for (std::size_t place = 0; place < stages_.size(); ++place) {
        nodes_->rounds.resize(std::max(nodes_->rounds.size(), round[place] + 1));
        nodes_->rounds[round[place]].push_back(place);
    }
}

template <class Real>
StepGraph<Real>::~StepGraph() = default;

template <class Real>
void StepGraph<Real>::run()
{
    for (const auto& round : nodes_->rounds)
        for_each_block(round.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) run_stage(round[i]);
        });
}

template class StepGraph<float>;
template class StepGraph<double>;

}  // namespace throng
