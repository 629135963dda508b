// Color rows: islands into batches, slices, colors and blocks.
#include "pipeline/step/stages.hpp"

#include <limits>

namespace throng {

void color_rows(const Conditions& conditions,
                const Islands& islands,
                const Stubborn& stubborn,
                const ActiveContacts& contacts,
                const BodyStates& states,
                const Poses& poses,
                Painter& painter,
                Layout& layout)
{
    const Settings& settings = conditions.settings;
    // Forces and pushes go island by island, however great.
    painter.direct_limit = settings.response != Response::impulse
        ? std::numeric_limits<std::size_t>::max()
        : settings.solver == Solver::direct ? static_cast<std::size_t>(settings.direct_limit)
                                            : 0;
    painter.efforts = stubborn.efforts;
    painter.lay_out(islands, contacts, states, poses.position, layout);
}

}  // namespace throng
