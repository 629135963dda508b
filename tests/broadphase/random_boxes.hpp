// Random boxes: scenes of boxes for the tests of finders, the same on every machine.
#pragma once

#include "broadphase/overlap_query.hpp"
#include "tests/support/dice.hpp"

#include <random>
#include <string>

namespace throng::test {

inline Box3 box_around(const Vec3& center, const Vec3& half)
{
    return {center - half, center + half};
}

/// What a scene's boxes are like.
struct BoxKind {
    std::string name;
    double half_world = 10;                // m
    Vec3 flatten = Vec3::Ones();           // of the world, per axis
    double smallest = 0.3, largest = 0.7;  // m, half extents
    double large_share = 1;                // how many may exceed the smallest
    Vec3 center = Vec3::Zero();
    double infinite_share = 0, not_a_number_share = 0, empty_share = 0;
};

inline const std::vector<BoxKind>& box_kinds()
{
    const double inf = std::numeric_limits<double>::infinity();
    static_cast<void>(inf);
    static const std::vector<BoxKind> kinds = {
        {.name = "uniform"},
        {.name = "mixed_sizes",
         .half_world = 30,
         .smallest = 0.1,
         .largest = 10,
         .large_share = 0.02},
        {.name = "few_larger",
         .half_world = 12,
         .smallest = 0.3,
         .largest = 2,
         .large_share = 0.03},
        {.name = "coincident", .half_world = 0},
        {.name = "points", .half_world = 1e-3, .smallest = 0, .largest = 1e-4, .large_share = 0.5},
        {.name = "flat_crowd", .half_world = 20, .flatten = Vec3(1, 1, 0)},
        {.name = "long_row", .half_world = 200, .flatten = Vec3(0, 0, 1)},
        {.name = "far_away", .center = Vec3(1e7, -1e7, 1e7)},
        {.name = "tiny_far_away",
         .half_world = 1e-4,
         .smallest = 1e-6,
         .largest = 1e-5,
         .center = Vec3(1e3, 1e3, 1e3)},
        {.name = "vast", .half_world = 1e8, .smallest = 1e6, .largest = 1e7},
        {.name = "beyond_float", .half_world = 1e40, .smallest = 1e38, .largest = 1e39},
        {.name = "broken", .infinite_share = 0.02, .not_a_number_share = 0.05, .empty_share = 0.05},
    };
    return kinds;
}

inline Box3 random_box(Dice& dice, const BoxKind& kind)
{
    const double inf = std::numeric_limits<double>::infinity();
    const double largest = dice.chance(kind.large_share) ? kind.largest : kind.smallest;
    Vec3 half;
    for (int axis = 0; axis < 3; ++axis) half[axis] = dice.between(kind.smallest, largest);
    Box3 box =
        box_around(kind.center + dice.point(kind.half_world).cwiseProduct(kind.flatten), half);
    const int axis = static_cast<int>(dice.below(3));
    if (dice.chance(kind.infinite_share)) box.lower[axis] = -inf;
    if (dice.chance(kind.infinite_share)) box.upper[axis] = inf;
    if (dice.chance(kind.infinite_share)) box = {Vec3::Constant(-inf), Vec3::Constant(inf)};
    if (dice.chance(kind.not_a_number_share)) box.lower[axis] = std::nan("");
    if (dice.chance(kind.not_a_number_share)) box.upper[axis] = std::nan("");
    if (dice.chance(kind.empty_share)) std::swap(box.lower[axis], box.upper[axis]);
    if (dice.chance(kind.empty_share)) box = Box3();
    return box;
}

/// A scene that changes from step to step, and the query that says so.
struct BoxScene {
    std::vector<Box3> boxes;
    std::vector<std::uint8_t> moving;
    std::vector<std::uint32_t> asked;
    bool still_changed = true;

    OverlapQuery query(const PairFilter* filter = nullptr) const
    {
        return {boxes, moving, asked, still_changed, filter};
    }
    void ask_all()
    {
        asked.clear();
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            if (moving[id] != 0) asked.push_back(id);
    }
};

inline BoxScene random_scene(Dice& dice, const BoxKind& kind, std::size_t count, double still_share)
{
    BoxScene scene;
    for (std::size_t i = 0; i < count; ++i) {
        scene.boxes.push_back(random_box(dice, kind));
        scene.moving.push_back(dice.chance(still_share) ? 0 : 1);
    }
    scene.ask_all();
    return scene;
}

}  // namespace throng::test
