// Touching pairs: who touches whom, from step to step, for a program that listens.
#pragma once

#include "kernels/parallel/compact.hpp"
#include "pipeline/step/sleeping_pairs.hpp"
#include "throng/math.hpp"

#include <limits>
#include <unordered_set>
#include <vector>

namespace throng {

/// Empty while nobody listens.
///
///   keys        ascending: of the pairs that a step goes through, those that touched in the last
///   asleep      of those that sleep, who touched as they fell asleep
///   begun, ended  in this step, ascending
///   approaches  of this step, those that near at hit_speed or faster, in order of keys
///   hits        of these, whose pair touches
struct TouchingPairs {
    /// Where two near each other fastest as a step begins: m, on the surface of the first; unit,
    /// to the second; m/s.
    struct Approach {
        PairKey key = 0;
        Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
        double speed = 0;
    };
    /// How a body moves, and how fast its turning moves any point of it, m/s.
    struct Motion {
        float x = 0, y = 0, z = 0, turning = 0;
    };
    std::vector<PairKey> keys;
    std::unordered_set<PairKey> asleep;
    std::vector<PairKey> begun, ended;
    std::vector<Approach> approaches, hits;
    double hit_speed = std::numeric_limits<double>::infinity();  // m/s

    struct Scratch {
        BlockLists<PairKey> keys_of_block;
        BlockLists<Approach> approaches_of_block;
        std::vector<Motion> motions;  // [bodies] all 0 between stages
        std::vector<PairKey> before;
        std::vector<std::uint8_t> convex, meshes, solids;  // [contacts] 1: was thrown apart
    } scratch;

    /// Takes those that fell asleep out of the keys, and puts those that woke back.
    void follow(std::vector<SleepingPairs::Change>& changes);
};

}  // namespace throng
