// Convex cover: a mesh as hulls that may share volume, each grown until inward edges stop it.
//
// What is connected and has no inward edge is convex. So a hull is grown from a place within the
// mesh by planes, each along an inward edge, until none is left on the near side of all of them.
// Unlike pieces of a split, hulls may overlap: a bolt is its core and the turns of its thread, each
// of which goes through the core. What is a few dozen of convex shapes put together becomes as many
// hulls that are nearly exact; round hollows have more edges than it can do with.
//
// Source: notches resolved by planes after Lien and Amato, Approximate Convex Decomposition of
//         Polyhedra and Its Applications (2008), section 3; regions grown from a place by planes at
//         what is nearest after Deits and Tedrake, Computing Large Convex Regions of Obstacle-Free
//         Space through Semidefinite Programming (2015), without their ellipsoids. That what is
//         connected and convex near each of its points is convex: Tietze (1928), Nakajima (1928).
#pragma once

#include "cooking/decomposition/part_search.hpp"

namespace throng {

/// Hulls of at most kMostPartVertices that reach outside by little more than the search's error;
/// of the surface next to nothing is further than that outside of all of them
/// (find_bare_surface()), and of points spread through the mesh none. Empty where that takes more
/// than `most`. The same mesh gives the same bits.
std::vector<HullMesh> cover_by_hulls(const PartSearch& search, std::size_t most);

}  // namespace throng
