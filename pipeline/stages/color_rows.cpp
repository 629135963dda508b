// Color rows: islands into batches, colors and blocks.
#include "kernels/solve/coloring.hpp"
#include "pipeline/stages.hpp"

namespace throng {

void color_rows(const Islands& islands,
                const ActiveContacts& contacts,
                const BodyStates& states,
                Layout& layout)
{
    lay_out(islands, contacts, states, layout);
}

}  // namespace throng
