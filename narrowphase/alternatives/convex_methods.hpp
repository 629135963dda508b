// Convex methods: every way to ask whether two convex shapes touch, behind one signature.
//
// Each answers for itself and says what it cannot tell; none answers through another. To add one:
// write it in a file of its own, list it in convex_methods.cpp, and every test and table of methods
// runs on it.
#pragma once

#include "narrowphase/convex/convex_pair.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace throng {

/// What a method can tell, to be added up.
enum Tells : std::uint8_t {
    tells_touch = 1,
    tells_distance = 2,  // of those that are apart, with points and normal
    tells_depth = 4,     // of those that touch, with normal
    tells_volume = 8,    // of those that touch, with surface and center
};

struct ConvexMethod {
    std::string_view name;
    std::string_view about;
    std::uint8_t tells = 0;
    /// Whether it serves pairs of polytopes (boxes and hulls) alone.
    bool polytopes_only = false;
    /// Never throws, allocates only where its file says so, ends for every input.
    ///
    ///   speculative_margin  m, pairs known to be further apart need no better answer than `apart`
    MethodAnswer (*ask)(const ConvexPair& pair,
                        double speculative_margin,
                        MethodStart start,
                        MethodMemory& memory) = nullptr;

    bool serves(const ConvexPair& pair) const
    {
        return !polytopes_only || pair.polytopes() != nullptr;
    }
};

/// All methods, the plainest first; the filters, which tell only what is far apart, come last.
std::span<const ConvexMethod> convex_methods();

/// The method of that name, or null.
const ConvexMethod* find_convex_method(std::string_view name);

}  // namespace throng
