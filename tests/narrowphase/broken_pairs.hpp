// Broken pairs: those of the hard cases, for tests of what throng collides with.
#pragma once

#include "cost/hard_cases/broken_pairs.hpp"
#include "tests/narrowphase/polyhedra.hpp"
