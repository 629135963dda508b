// The step graph on a oneTBB flow graph.
#include "pipeline/step_graph.hpp"

#include <tbb/flow_graph.h>
#include <tbb/task_arena.h>

#include <deque>

namespace throng {

using Signal = tbb::flow::continue_msg;

template <class Real>
struct StepGraph<Real>::Nodes {
    tbb::flow::graph graph;
    tbb::flow::broadcast_node<Signal> start{graph};
    std::deque<tbb::flow::continue_node<Signal>> stages;
};

template <class Real>
StepGraph<Real>::StepGraph(std::vector<Stage<Real>> stages, StepData<Real>& data)
    : stages_(std::move(stages)), data_(&data), times_(stages_.size(), 0.0),
      nodes_(std::make_unique<Nodes>())
{
    for (std::size_t place = 0; place < stages_.size(); ++place) {
        auto& node =
            nodes_->stages.emplace_back(nodes_->graph, [this, place](Signal) { run_stage(place); });
        tbb::flow::make_edge(nodes_->start, node);
    }
    for (const auto& [earlier, later] : waits(stages_))
        tbb::flow::make_edge(nodes_->stages[earlier], nodes_->stages[later]);
}

template <class Real>
StepGraph<Real>::~StepGraph() = default;

template <class Real>
void StepGraph<Real>::run()
{
    if (tbb::this_task_arena::max_concurrency() == 1) {
        run_in_order();
        return;
    }
    nodes_->start.try_put(Signal());
    nodes_->graph.wait_for_all();
}

template class StepGraph<float>;
template class StepGraph<double>;

}  // namespace throng
