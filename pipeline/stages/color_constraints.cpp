// Color constraints: islands into batches, slices, colors and blocks.
#include "pipeline/step/stages.hpp"

#include <limits>

namespace throng {

void color_constraints(const StepContext& context,
                       const SolverParameters& parameters,
                       const Islands& islands,
                       const OverloadedIslands& overloaded,
                       const ActiveContacts& contacts,
                       const BodyStates& states,
                       const Poses& poses,
                       ConstraintGraph& graph,
                       Layout& layout)
{
    // Forces and pushes go island by island, however great.
    graph.direct_limit = context.response != Response::impulse
        ? std::numeric_limits<std::size_t>::max()
        : parameters.solver == Solver::direct ? static_cast<std::size_t>(parameters.direct_limit)
                                              : 0;
    graph.efforts = overloaded.efforts;
    graph.lay_out(islands, contacts, states, poses.position, layout);
}

}  // namespace throng
