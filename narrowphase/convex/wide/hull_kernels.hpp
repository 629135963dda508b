// Hull kernels: where two polytopes touch, in float, over the width of the machine's registers.
//
// Plain numbers only: the sources behind this are compiled once for each instruction set, and give
// the same bits with every one.
#pragma once

#include "kernels/data/wide_polytope.hpp"

namespace throng {

/// Two polytopes, b seen from a.
///
///   turn    b's axes into a's, by rows
///   offset  from a's center to b's, in a's axes, m
///   bias    m, by how much an axis must be better than a face to lead in its place
struct HullPair {
    WidePolytope a, b;
    float turn[9];
    float offset[3];
    float speculative_margin, bias;
};

/// The feature whose axis parted the two most when they were last looked at.
struct HullGuess {
    enum Kind : std::uint32_t { none, face_a, face_b, edges };
    std::uint32_t kind = none;
    std::uint32_t a = 0, b = 0;  // the face, or an edge of each
};

/// Points of touch, about a's center and in a's axes.
struct HullOverlap {
    static constexpr int kMost = 3 * kWideCorners;
    struct Point {
        float position[3];  // midway between the surfaces
        float separation;
        std::uint32_t feature;
    };
    float normal[3];  // from a to b
    int count;
    float apart;  // m, how far the best axis parts them where there is no point; 0 for not at all
    // Of two edges that cross: the cosine of the angle from the normal to the nearest of that of
    // their faces. Else 0.
    float edge_to_face;
    Point points[kMost];
};

/// Looks at all axes that could part the two best; the guess is where it begins, and what it
/// leaves behind. The answer is the same to the last bit whatever the guess.
using HullKernel = void (*)(const HullPair& pair, HullGuess& guess, HullOverlap& out);

/// The kernel of "scalar", "avx2" or "avx512"; null where this machine has not got it.
const HullKernel* hull_kernel_of(const char* width);

/// The one that this run takes.
const HullKernel& hull_kernel();

}  // namespace throng
