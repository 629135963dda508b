// Step graph: who waits for whom, and the step run that way.
//
// Every edge follows from what stages read and write. The graph is built when the set of effects
// changes and not each step; running the rows top to bottom leaves the same bits.
#pragma once

#include "kernels/parallel/work_count.hpp"
#include "pipeline/step/stage.hpp"

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace throng {

/// Each wait as (earlier, later), places in the list; waits implied by others are left out.
template <class Real>
std::vector<std::pair<std::size_t, std::size_t>> waits(const std::vector<Stage<Real>>& stages);

/// Time spent in each stage of the graph in the last run, ms, in its order.
using StageTimes = std::vector<double>;

/// Somebody who sees the stages of a step as they run: a trace, or a benchmark that empties the
/// caches before each.
class StepWatch {
public:
    virtual ~StepWatch() = default;
    /// Calls stage() once, on the thread that it is called on. Stages may run at the same time.
    virtual void run_stage(std::string_view name, const std::function<void()>& stage) = 0;
};

/// The stages of a scene, ready to run. Build and run it inside the thread pool it is to use.
template <class Real>
class StepGraph {
public:
    StepGraph(std::vector<Stage<Real>> stages, StepData<Real>& data);
    ~StepGraph();
    StepGraph(const StepGraph&) = delete;
    StepGraph& operator=(const StepGraph&) = delete;

    /// One step. Stages that do not wait for one another may run at the same time.
    void run();
    /// The same, top to bottom on the calling thread: the reference.
    void run_in_order();

    /// From now on somebody watches; null for nobody.
    void watch(StepWatch* watch) { watch_ = watch; }
    /// From now on the threads that work are counted; null for nobody.
    void count(WorkCount* count) { count_ = count; }

    /// Nothing was run: no stage took any time.
    void rest() { times_.assign(times_.size(), 0.0); }

    const std::vector<Stage<Real>>& stages() const { return stages_; }
    const StageTimes& times() const { return times_; }

private:
    struct Nodes;
    void run_stage(std::size_t place);
    void time_stage(std::size_t place);

    std::vector<Stage<Real>> stages_;
    StepData<Real>* data_;
    StageTimes times_;
    StepWatch* watch_ = nullptr;
    WorkCount* count_ = nullptr;
    std::unique_ptr<Nodes> nodes_;
};

}  // namespace throng
