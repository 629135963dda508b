// Recipes: one function a catalogue scene. Each makes the scene of about `size` bodies (or levels,
// or stones: catalog.cpp says of what) from a seed; the same size and seed give the same bits.
// Those named make_..._of put a mesh of the user's in the place of the generated ones, at their
// size.
#pragma once

#include "scene/catalog/closed_meshes.hpp"
#include "throng/scene.hpp"

#include <cstdint>

namespace throng {

// piles.cpp
Scene make_pile(int size, std::uint64_t seed);
Scene make_spheres(int size, std::uint64_t seed);
Scene make_hulls(int size, std::uint64_t seed);
Scene make_sparse(int size, std::uint64_t seed);
Scene make_mixed(int size, std::uint64_t seed);
Scene make_tumbler(int size, std::uint64_t seed);

// terrain.cpp
Scene make_meshes(int size, std::uint64_t seed);
Scene make_hills(int size, std::uint64_t seed);
Scene make_terrain(int size, std::uint64_t seed);
Scene make_terrain_of(int size, std::uint64_t seed, const TriangleSoup& mesh);

// tangles.cpp
Scene make_knots(int size, std::uint64_t seed);
Scene make_knots_of(int size, std::uint64_t seed, const TriangleSoup& mesh);
Scene make_chain(int size, std::uint64_t seed);
Scene make_peg(int size, std::uint64_t seed);
Scene make_bolt(int size, std::uint64_t seed);

// stacks.cpp
Scene make_pyramid(int size, std::uint64_t seed);
Scene make_wall(int size, std::uint64_t seed);
Scene make_stacks(int size, std::uint64_t seed);

// balances.cpp
Scene make_card_house(int size, std::uint64_t seed);
Scene make_arch(int size, std::uint64_t seed);

// machines.cpp
Scene make_dominoes(int size, std::uint64_t seed);
Scene make_cradle(int size, std::uint64_t seed);
Scene make_bullet_plate(int size, std::uint64_t seed);
Scene make_spring(int size, std::uint64_t seed);

// simbenchmark.cpp
Scene make_rolling(int size, std::uint64_t seed);
Scene make_bouncing(int size, std::uint64_t seed);
Scene make_ball_cube(int size, std::uint64_t seed);
Scene make_elastic_ball_cube(int size, std::uint64_t seed);
Scene make_kapla(int size, std::uint64_t seed);

// box3d_benchmarks.cpp
Scene make_washer(int size, std::uint64_t seed);
Scene make_large_pyramid(int size, std::uint64_t seed);
Scene make_many_pyramids(int size, std::uint64_t seed);
Scene make_junkyard(int size, std::uint64_t seed);
Scene make_trees(int size, std::uint64_t seed);
Scene make_large_world(int size, std::uint64_t seed);

// crowds.cpp
Scene make_crowd(int size, std::uint64_t seed);

}  // namespace throng
