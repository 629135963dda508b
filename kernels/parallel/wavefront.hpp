// Wavefront: several passes over a row of places, of which neighbours share data.
#pragma once

#include "kernels/parallel/blocks.hpp"

#include <cstdint>
#include <vector>

namespace throng {

/// Runs passes over places as if pass by pass, and place by place within each, for a body that
/// touches nothing but what belongs to a place and to the next one. In truth a thread takes one
/// pass after another down a diagonal, so that the passes over a place follow one another while its
/// data are in cache, and threads follow each other from diagonal to diagonal.
///
/// Source: Wolfe, Loops Skewing: The Wavefront Method Revisited (1986).
class Wavefront {
public:
    /// Calls body(pass, place) once for each, after (pass, place - 1) and (pass - 1, place + 1).
    /// The body may not begin a loop of its own: the thread could come to wait for itself.
    template <class Body>
    void run(std::size_t passes, std::size_t places, const Body& body)
    {
        run_diagonals(passes, places,
                      [&](std::size_t pass, std::size_t place, std::size_t) { body(pass, place); });
    }

private:
    // How many passes a place has had, each on a cache line of its own.
    struct alignas(64) Progress {
        std::uint32_t passes = 0;
    };

    void run_diagonals(std::size_t passes, std::size_t places, const BlockBody& body);
    void wait_for(std::size_t place, std::size_t passes);

    std::vector<Progress> progress_;
};

}  // namespace throng
