// Foreign memory: what a pair remembers may be of another pair, of another method, or nonsense, and
// no method gives another answer for it.
#include "narrowphase/alternatives/convex_methods.hpp"
#include "tests/support/polyhedra.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace throng {
namespace {

constexpr double kAnyReach = 1e30;

Shapes shapes()
{
    RandomShapes random(17);
    Shapes made = two_boxes({0.5, 0.4, 0.3}, {0.2, 0.5, 0.6});
    made.hulls = {random.hull(30, 0.6), random.hull(8, 0.4)};
    made.spheres = {{0.4}};
    made.capsules = {{0.2, 0.5}};
    made.cylinders = {{0.3, 0.4}};
    return made;
}

constexpr ShapeRef kRefs[] = {
    {ShapeKind::box, 0},    {ShapeKind::box, 1},     {ShapeKind::hull, 0},    {ShapeKind::hull, 1},
    {ShapeKind::sphere, 0}, {ShapeKind::capsule, 0}, {ShapeKind::cylinder, 0}};

std::vector<MethodMemory> nonsense(RandomShapes& random)
{
    std::vector<MethodMemory> all;
    const double endless = std::numeric_limits<double>::infinity();
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const double length : {0.0, 1e-3, 1.0, 1e9, 1e300, endless, none})
        for (std::uint32_t kind = 0; kind < 16; ++kind) {
            MethodMemory memory;
            memory.axis = Vec3(0.6, 0, 0.8) * length;
            memory.kind = kind;
            memory.count = kind % 6;
            for (int i = 0; i < 4; ++i) {
                memory.a[i] = static_cast<std::uint32_t>(random.number(0, 40));
                memory.b[i] = kind % 5 == 4 ? 0xffffffff : memory.a[i];
            }
            all.push_back(memory);
        }
    return all;
}

class ForeignMemory : public ::testing::TestWithParam<std::size_t> { };

TEST_P(ForeignMemory, ChangesNoAnswer)
{
    const ConvexMethod& method = convex_methods()[GetParam()];
    const Shapes all = shapes();
    RandomShapes random(23);
    const std::vector<MethodMemory> memories = nonsense(random);
    for (const ShapeRef a : kRefs)
        for (const ShapeRef b : kRefs) {
            // Square and aslant, apart and touching.
            for (const double away : {0.1, 0.6, 3.0})
                for (const bool aslant : {false, true}) {
                    const Quat turn = aslant ? random.turn() : Quat(Quat::Identity());
                    ConvexPair pair(all, a, b, {Vec3(away, 0.01, 0.02), turn});
                    if (!method.serves(pair)) continue;
                    MethodMemory fresh;
                    const MethodAnswer cold = method.ask(pair, kAnyReach, MethodStart::cold, fresh);
                    for (MethodMemory memory : memories) {
                        const MethodAnswer told =
                            method.ask(pair, kAnyReach, MethodStart::cached, memory);
                        ASSERT_EQ(told.overlap, cold.overlap);
                        ASSERT_NEAR(told.normal.norm(), 1, 1e-12);
                        const bool apart = told.overlap == OverlapState::apart;
                        if (method.tells & (apart ? tells_distance : tells_depth)) {
                            ASSERT_NEAR(told.separation, cold.separation, 1e-6);
                        }
                    }
                }
        }
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         ForeignMemory,
                         ::testing::Range(std::size_t{0}, convex_methods().size()),
                         [](const auto& tested) {
                             std::string name(convex_methods()[tested.param].name);
                             std::replace(name.begin(), name.end(), ':', '_');
                             return name;
                         });

}  // namespace
}  // namespace throng
