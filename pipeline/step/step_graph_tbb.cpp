// The step graph on a oneTBB flow graph, or, where a step is over before other threads are awake,
// on one thread.
#include "kernels/parallel/race_notes.hpp"
#include "pipeline/step/step_graph.hpp"

#include <tbb/flow_graph.h>
#include <tbb/task_arena.h>

#include <array>
#include <chrono>
#include <deque>

namespace throng {

namespace {

// Which is quicker, one thread or all: what both took of late, and from time to time a step the
// other way, as scenes change. Who runs a step changes no bit of it.
class Quicker {
public:
    enum Way : std::size_t { shared, alone };

    Way next()
    {
#ifdef THRONG_CHECKS
        return ++steps_ % 4 == 0 ? alone : shared;  // tests of the smallest scenes see both
#else
        if (ms_[shared] == 0 || ms_[shared] > kWorthThreads) return shared;
        const Way quicker = ms_[alone] < ms_[shared] ? alone : shared;
        if (ms_[alone] != 0 && ++steps_ % kTrial != 0) return quicker;
        return quicker == alone ? shared : alone;
#endif
    }
    void took(Way way, double ms) { ms_[way] = ms_[way] == 0 ? ms : 0.9 * ms_[way] + 0.1 * ms; }

private:
    static constexpr double kWorthThreads = 0.3;  // ms, from which it is not asked
    static constexpr unsigned kTrial = 64;

    std::array<double, 2> ms_ = {};  // 0: not known
    unsigned steps_ = 0;
};

}  // namespace

using Signal = tbb::flow::continue_msg;

template <class Real>
struct StepGraph<Real>::Nodes {
    tbb::flow::graph graph;
    tbb::flow::broadcast_node<Signal> start{graph};
    std::deque<tbb::flow::continue_node<Signal>> stages;
    tbb::task_arena one_thread{1};
    Quicker quicker;

    // For the race checker alone: that stages begun, and that each has ended.
    using Waits = std::vector<std::pair<std::size_t, std::size_t>>;
    Waits waits;
    std::vector<char> ended;
    char begun = 0;

    void run_stage(StepGraph& step, std::size_t place) const
    {
        note_after(begun);
        if (kChecksRaces)
            for (const auto& [earlier, later] : waits)
                if (later == place) note_after(ended[earlier]);
        step.run_stage(place);
        if (kChecksRaces) note_before(ended[place]);
    }
};

namespace {

template <class Nodes, class Step>
struct RunStage {
    const Nodes* nodes;
    Step* step;
    std::size_t place;

    THRONG_CALLED_BY_SCHEDULER void operator()(Signal) const { nodes->run_stage(*step, place); }
};

}  // namespace

template <class Real>
StepGraph<Real>::StepGraph(std::vector<Stage<Real>> stages, StepData<Real>& data)
    : stages_(std::move(stages)), data_(&data), times_(stages_.size(), 0.0),
      nodes_(std::make_unique<Nodes>())
{
    for (std::size_t place = 0; place < stages_.size(); ++place) {
        auto& node = nodes_->stages.emplace_back(
            nodes_->graph, RunStage<Nodes, StepGraph>{nodes_.get(), this, place});
        tbb::flow::make_edge(nodes_->start, node);
    }
    for (const auto& [earlier, later] : waits(stages_))
        tbb::flow::make_edge(nodes_->stages[earlier], nodes_->stages[later]);
    if (!kChecksRaces) return;
    nodes_->waits = waits(stages_);
    nodes_->ended.resize(stages_.size());
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
    using Clock = std::chrono::steady_clock;
    const Quicker::Way way = nodes_->quicker.next();
    const auto begin = Clock::now();
    if (way == Quicker::alone) {
        nodes_->one_thread.execute([this] { run_in_order(); });
    } else {
        note_before(nodes_->begun);
        nodes_->start.try_put(Signal());
        nodes_->graph.wait_for_all();
        for (const char& ended : nodes_->ended) note_after(ended);
    }
    nodes_->quicker.took(way,
                         std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
}

template class StepGraph<float>;
template class StepGraph<double>;

}  // namespace throng
