// Margins: how far a box reaches beyond a collider, so that it need not be looked at every step.
//
// A collider inside its fat box costs the broad phase nothing, and its pairs live on. Wide margins
// are left seldom but bring pairs that never touch. To be asked about costs as much as some 80 such
// pairs in a step; the defaults weigh that for piles, drums and crowds.
#pragma once

#include "kernels/data/bounds.hpp"

namespace throng {

/// What margins are made of; all relative, so that a scene in millimeters is treated like one in
/// kilometers.
struct MarginRule {
    double base = 0.08;  // of the size, on every side: room for jitter, turning and rest
    double steps = 8;    // ahead along the velocity, on the sides that it points to
    double longest = 2;  // of the size: most that looking further ahead than one step may add
    // Of the size. A box that on some side is wider by this than it would be made now is made anew:
    // what has come to rest would keep the pairs of its fall, a third of all in a heap. Half as
    // much asks a tumbling heap too often, twice as much keeps most of those pairs.
    double loose = 0.75;
};

/// How many times further margins may look ahead in a scene with so many pairs for so many
/// colliders that move: where these are far apart, wide margins bring next to no pairs.
double stretch_for(std::size_t pairs, std::size_t active);

/// True for a box that holds `tight` but is loose, see MarginRule. One of fattened() is not, as
/// long as the velocity stays the same.
bool loose(const Box3& box,
           const Box3& tight,
           const Vec3& velocity,
           double size,
           double dt,
           const MarginRule& rule = MarginRule());

/// The box of a moving collider with its margin.
///
/// On every side `base * size`. Ahead, on each axis on its own, the way of `steps` steps, but no
/// more than `longest * size`, and never less than the way of one step: a fast body is looked at
/// every step, and even then its box covers the step. An axis along which it does not move gets the
/// base alone. Where velocity is not finite the margin is the base.
///
///   tight     m    where the collider is now
///   velocity  m/s  of the collider; what turning adds is for the caller to put into `size` or base
///   size      m    of the collider, such as its smallest side or its bounding radius; at least 0
///   dt        s    the step
///
/// Gives:    a box that contains `tight`, and `tight` moved by velocity * t for t up to dt.
Box3 fattened(const Box3& tight,
              const Vec3& velocity,
              double size,
              double dt,
              const MarginRule& rule = MarginRule());

}  // namespace throng
