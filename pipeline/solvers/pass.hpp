// Pass: what a batch is gone through for, slice by slice.
#pragma once

#include <cstdint>

namespace throng {

/// One pass over the contacts or the bodies of a slice.
struct Pass {
    enum class Kind : std::uint8_t {
        prepare,
        begin,
        warm_start,
        update_surface_velocity,
        solve_biased,
        advance,
        relax,
        apply_restitution,
        store,
        save,
        solve_split_impulse,
        restore
    } kind;
    bool first = false;     // of the step
    bool backward = false;  // from the last slice and color to the first
};

}  // namespace throng
