#include "narrowphase/ccd/linear_paths.hpp"

#include "tests/support/moving_pairs.hpp"
#include "tests/support/shared_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace throng {
namespace {

using test::Dice;
using test::kToiMethods;

constexpr PathKind kKinds[] = {PathKind::vertex_face, PathKind::edge_edge};

// Weights of the points of each side that make a point of it, and the time at which they meet.
struct Crossing {
    std::array<double, 4> weights;
    double time;
};

Crossing random_crossing(Dice& dice, PathKind kind)
{
    // In eighths, so that sums of small whole numbers are exact.
    const double u = dice.below(9) / 8.0, v = dice.below(9) / 8.0;
    if (kind == PathKind::edge_edge) return {{1 - u, u, 1 - v, v}, dice.below(9) / 8.0};
    return {{1, 1 - u, u * (1 - v), u * v}, dice.below(9) / 8.0};
}

// Four points on ways that meet as the crossing says: the last of them is moved so that they do.
LinearPaths crossing_paths(Dice& dice, PathKind kind, const Crossing& crossing, bool whole)
{
    LinearPaths paths;
    paths.kind = kind;
    const auto place = [&] {
        const Vec3 any = dice.point(whole ? 64 : 1);
        return whole ? Vec3(any.array().round()) : any;
    };
    for (std::size_t i = 0; i < 4; ++i) {
        paths.from[i] = place();
        paths.to[i] = place();
    }
    Vec3 apart = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
        const double side = kind == PathKind::vertex_face ? (i < 1 ? 1 : -1) : (i < 2 ? 1 : -1);
        apart += side * crossing.weights[i]
            * (paths.from[i] + crossing.time * (paths.to[i] - paths.from[i]));
    }
    // The first side as a whole, by what the two are apart then.
    for (std::size_t i = 0; i < (kind == PathKind::vertex_face ? 1u : 2u); ++i) {
        paths.from[i] -= apart;
        paths.to[i] -= apart;
    }
    return paths;
}

double distance_at(const LinearPaths& paths, double time)
{
    LinearPaths then = paths;
    for (std::size_t i = 0; i < 4; ++i)
        then.from[i] = then.to[i] = paths.from[i] + time * (paths.to[i] - paths.from[i]);
    return time_of_impact(then, ToiMethod::newton, 0).distance;
}

TEST(LinearPaths, MissNothingThatMeetsExactly)
{
    Dice dice(11);
    for (int i = 0; i < 3000; ++i)
        for (const PathKind kind : kKinds) {
            const Crossing crossing = random_crossing(dice, kind);
            const LinearPaths paths = crossing_paths(dice, kind, crossing, true);
            for (const ToiMethod method : kToiMethods) {
                const Impact impact = time_of_impact(paths, method, 0);
                ASSERT_NE(impact.state, ToiState::separated) << i;
                EXPECT_LE(impact.time, crossing.time) << i;
            }
        }
}

TEST(LinearPaths, AreNotTooEarly)
{
    Dice dice(12);
    for (int i = 0; i < 500; ++i)
        for (const PathKind kind : kKinds) {
            const LinearPaths paths =
                crossing_paths(dice, kind, random_crossing(dice, kind), false);
            for (const ToiMethod method : kToiMethods) {
                const Impact impact = time_of_impact(paths, method, 1e-9);
                ASSERT_NE(impact.state, ToiState::separated);
                if (impact.cut_short || impact.state == ToiState::touching_at_start) continue;
                EXPECT_LE(distance_at(paths, impact.time), 1e-9);
            }
        }
}

TEST(LinearPaths, MissWhatStaysApart)
{
    Dice dice(13);
    int apart = 0;
    for (int i = 0; i < 500; ++i)
        for (const PathKind kind : kKinds) {
            LinearPaths paths = crossing_paths(dice, kind, random_crossing(dice, kind), false);
            for (std::size_t k = 0; k < 2; ++k) paths.to[k] += Vec3(0.3, 0.2, 0.1);
            const auto near = [&] {
                double speed = 0;
                for (std::size_t k = 0; k < 4; ++k)
                    speed = std::max(speed, (paths.to[k] - paths.from[k]).norm());
                for (int k = 0; k <= 200; ++k)
                    if (distance_at(paths, k / 200.0) < 2 * speed / 400 + 1e-6) return true;
                return false;
            };
            if (near()) continue;
            ++apart;
            for (const ToiMethod method : kToiMethods)
                EXPECT_EQ(time_of_impact(paths, method, 1e-6).state, ToiState::separated);
        }
    EXPECT_GT(apart, 100);
}

TEST(LinearPaths, TakeTrianglesAndEdgesOfNoSize)
{
    LinearPaths paths;
    for (std::size_t i = 0; i < 4; ++i) paths.from[i] = paths.to[i] = Vec3(1, 2, 3);
    for (const PathKind kind : kKinds)
        for (const ToiMethod method : kToiMethods) {
            paths.kind = kind;
            paths.from[0] = paths.from[1] = paths.to[0] = paths.to[1] = Vec3(1, 2, 3);
            EXPECT_EQ(time_of_impact(paths, method, 0).state, ToiState::touching_at_start);
            if (kind == PathKind::vertex_face) paths.from[1] = paths.to[1] = Vec3(1, 2, 3);
            paths.from[0] = paths.to[0] = Vec3(1, 2, 4);
            if (kind == PathKind::edge_edge) paths.from[1] = paths.to[1] = Vec3(2, 2, 4);
            EXPECT_EQ(time_of_impact(paths, method, 0).state, ToiState::separated);
            paths.to[0] = Vec3(1, 2, 2);
            EXPECT_NE(time_of_impact(paths, method, 0).state, ToiState::separated);
        }
}

// The sets with exact answers: every touch is told.
TEST(LinearPaths, MissNothingOfThePublicSets)
{
    const std::filesystem::path folder = shared_data("ccd");
    if (folder.empty()) GTEST_SKIP() << "shared/data/ccd is absent";
    std::size_t queries = 0, missed = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".csv") continue;
        LinearPaths paths;
        paths.kind = entry.path().parent_path().filename() == "edge-edge" ? PathKind::edge_edge
                                                                          : PathKind::vertex_face;
        std::ifstream file(entry.path());
        std::string line;
        for (std::size_t row = 0; std::getline(file, line); row = (row + 1) % 8) {
            std::replace(line.begin(), line.end(), ',', ' ');
            std::istringstream numbers(line);
            Vec3 above, below;
            int truth = 0;
            numbers >> above.x() >> below.x() >> above.y() >> below.y() >> above.z() >> below.z()
                >> truth;
            (row < 4 ? paths.from : paths.to)[row % 4] = above.cwiseQuotient(below);
            if (row != 7 || truth == 0) continue;
            ++queries;
            for (const ToiMethod method : kToiMethods)
                for (const double tolerance : {0.0, 1e-6})
                    if (time_of_impact(paths, method, tolerance).state == ToiState::separated)
                        ++missed;
        }
    }
    EXPECT_GT(queries, 0u);
    EXPECT_EQ(missed, 0u);
}

}  // namespace
}  // namespace throng
