// Budget: what a step of 10,000 bodies should take on one thread, ms, worked out from unit costs
// before the solver was built. A first real build may take half as much again.
//
//   scene     bounds and integration, pairs, narrow phase, rows, solve
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace throng::perf {

inline constexpr int kBudgetParts = 5;
inline constexpr std::array<std::string_view, kBudgetParts> kBudgetPartNames = {
    "bounds+integrate", "pairs", "narrow", "rows", "solve"};

/// The size that the budget is for.
inline constexpr int kBudgetSize = 10'000;

struct Budget {
    std::string_view scene;
    std::array<double, kBudgetParts> ms;
    double sum_ms;
};

// clang-format off
inline constexpr Budget kBudget[] = {
    {"pile",    {1.0, 2.0, 4.0, 3.0, 12.0}, 22},
    {"spheres", {0.7, 2.0, 1.2, 1.7,  3.0},  9},
    {"hulls",   {1.0, 3.0, 9.0, 2.0,  6.0}, 21},
    {"wall",    {1.0, 0.5, 1.5, 3.5, 13.0}, 20},
    {"pyramid", {1.0, 0.5, 2.0, 4.5, 17.0}, 25},
    {"stacks",  {0.7, 0.3, 0.6, 1.2,  2.6}, 5.5},
    {"tumbler", {1.0, 2.0, 3.0, 2.0,  7.0}, 15},
    {"crowd",   {0.5, 2.0, 0.5, 1.0,  3.6},  8},
    {"sparse",  {0.8, 0.3, 0.0, 0.0,  0.0}, 1.2},
};

/// The part that a stage belongs to. What decides who touches whom is of the narrow phase, what
/// puts contacts into an order or into rows is of the rows, and what moves bodies of the first.
struct StagePart { std::string_view stage; int part; };
inline constexpr StagePart kStageParts[] = {
    {"prescribe_velocities", 0}, {"update_bounds", 0}, {"integrate_poses", 0},
    {"quarantine_bodies", 0}, {"sleep_islands", 0}, {"wake_islands", 0},
    {"find_pairs", 1},
    {"collide_convex", 2}, {"collide_meshes", 2},
    {"gather_contacts", 3}, {"split_islands", 3}, {"color_constraints", 3},
    {"prepare_constraints", 3},
    {"solve_soft_step", 4}, {"solve_pgs", 4}, {"solve_direct", 4}, {"solve_penalty", 4},
    {"solve_kinematic", 4}, {"measure_strain", 4}, {"store_solution", 4},
};
// clang-format on

/// The budget of a scene, or null.
constexpr const Budget* find_budget(std::string_view scene)
{
    for (const Budget& budget : kBudget)
        if (budget.scene == scene) return &budget;
    return nullptr;
}

/// The part of the budget that a stage belongs to; one that nobody has listed is of the rows.
constexpr int part_of_stage(std::string_view stage)
{
    for (const StagePart& known : kStageParts)
        if (known.stage == stage) return known.part;
    return 3;
}

}  // namespace throng::perf
