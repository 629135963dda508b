// Certified pairs: random placings of two hulls whose answer is known from how they were made.
//
// Those that are apart come with a plane between them, those that touch with a point in both: no
// method was asked, and no search is needed however many vertices the hulls have. Half of them are
// set up to be awkward: parallel, all but parallel, face to face, edge to edge, about one center.
#pragma once

#include "cooking/hulls/hull.hpp"
#include "scene/catalog/random.hpp"

namespace throng {

/// touching: a ball of radius `separation` lies in a and has its center in b; else a slab
/// `separation` thick lies between the two.
struct CertifiedPair {
    Pose b_in_a;
    bool touching = false;
    double separation = 0;  // m
};

/// m, what gaps are relative to: the radius of the greater ball round the two.
double certified_size(const Hull& a, const Hull& b);

/// Beyond this, of the size, any filter can tell that two hulls about their origins are apart.
inline constexpr double kFarSeparation = 5;

/// A placing whose gap is from 1e-9 to 0.3 of the size, all magnitudes alike; one in sixteen is far
/// apart.
CertifiedPair certified_pair(const Hull& a, const Hull& b, Random& random);

/// A turn, each as likely as the others.
Quat random_turn(Random& random);

/// The hull of random points on an ellipsoid with half axes of 0.3 to 1 m.
Hull random_hull(Random& random, int points);

}  // namespace throng
