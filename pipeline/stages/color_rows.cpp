// Color rows: islands into batches, slices, colors and blocks.
#include "pipeline/stages.hpp"

namespace throng {

void color_rows(const Islands& islands,
                const ActiveContacts& contacts,
                const BodyStates& states,
                const Poses& poses,
                Painter& painter,
                Layout& layout)
{
    painter.lay_out(islands, contacts, states, poses.position, layout);
}

}  // namespace throng
