// Shared volume: H36, what two polytopes have in common.
//
// Answer: closed forms where there is one; the last of the cubes in four times the digits. Surfaces
// by hand: of a box, of an octagonal prism, of an octahedron.
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

constexpr double kBound = 1e-12, kOrderBound = 1e-13;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

using Points = std::vector<Vec3>;

struct Shared {
    const char* name;
    Points a, b;
    Pose b_in_a;
    double volume, surface;  // m3, m2
    Vec3 center;
};

Points cube()
{
    Points points;
    for (unsigned i = 0; i < 8; ++i)
        points.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    return points;
}

std::vector<Shared> known_volumes()
{
    const double across = std::sqrt(2.0) - 1;
    const Points tetrahedron = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    Points mirrored = tetrahedron;
    for (Vec3& point : mirrored) point = -point;
    const Vec3 diagonal = Vec3::Constant(1 / std::sqrt(3.0));
    return {
        {"cubes at 45 deg about z",
         cube(),
         cube(),
         {Vec3::Zero(), exponential({0, 0, kPi / 4})},
         2 * across,
         12 * across,
         Vec3::Zero()},
        {"cubes at 60 deg about (1, 1, 1)",
         cube(),
         cube(),
         {Vec3::Zero(), exponential(kPi / 3 * diagonal)},
         0.75,
         kUnknown,
         Vec3::Zero()},
        {"cubes off by (0.3, 0.4, 0.5)",
         cube(),
         cube(),
         {Vec3(0.3, 0.4, 0.5), Quat::Identity()},
         0.21,
         2.14,
         Vec3(0.15, 0.2, 0.25)},
        {"cubes turned and off",
         cube(),
         cube(),
         {Vec3(0.6, 0.2, 0.1), Quat(1, 2, 3, 4).normalized()},
         0.287341666666667,
         kUnknown,
         Vec3(0.286826222644, 0.131183743211, 0.0564773156152)},
        {"mirrored tetrahedra", tetrahedron, mirrored, Pose{}, 4.0 / 3, 4 * std::sqrt(3.0),
         Vec3::Zero()},
    };
}

ShapeDescription hull(Points points) { return {"", HullShape{std::move(points)}}; }

void judge_volume(CaseBench& bench,
                  MethodTally& tally,
                  const MethodDescription& method,
                  const Shared& shared)
{
    const auto ask = [&](const Points& a, const Points& b, const Pose& b_in_a, MethodStart start) {
        ConvexQuery query(hull(a), hull(b));
        return bench.ask(query, method.name, Pose{}, b_in_a, 1, start);
    };
    const auto inspect = [&](const ConvexAnswer& answer, const Vec3& center) {
        tally.count(method.name, shared.name, "wrong or no answers",
                    answer.verdict == QueryVerdict::touching && !answer.cut_short ? 0 : 1);
        tally.worst(method.name, shared.name, "error of the volume",
                    std::abs(answer.volume - shared.volume), kBound, "m3");
        tally.worst(method.name, shared.name, "error of the center",
                    (answer.center - center).norm(), kBound, "m");
        if (!std::isnan(shared.surface))
            tally.worst(method.name, shared.name, "error of the surface",
                        std::abs(answer.surface - shared.surface), kBound, "m2");
    };
    const Pose a_in_b = seen_from(shared.b_in_a, Pose{});
    const Vec3 center_in_b = shared.b_in_a.to_local(shared.center);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    Points a = shared.a, b = shared.b;
    // Corners in another order make faces in another order, which are then cut by in another order.
    for (int order = 0; order < 8; ++order) {
        for (const MethodStart start : {MethodStart::cold, MethodStart::plain}) {
            const ConvexAnswer there = ask(a, b, shared.b_in_a, start);
            const ConvexAnswer back = ask(b, a, a_in_b, start);
            inspect(there, shared.center);
            inspect(back, center_in_b);
            least = std::min({least, there.volume, back.volume});
            most = std::max({most, there.volume, back.volume});
        }
        std::rotate(a.begin(), a.begin() + 1, a.end());
        std::rotate(b.begin(), b.begin() + 3, b.end());
        if (order == 3) std::reverse(a.begin(), a.end());
    }
    tally.worst(method.name, shared.name, "change with the order of planes", most - least,
                kOrderBound, "m3");
}

// Face to face, edge to edge and corner to corner.
void judge_merely_touching(CaseBench& bench, MethodTally& tally, const MethodDescription& method)
{
    for (const Vec3& shift : {Vec3(1, 0, 0), Vec3(1, 0.25, -0.5), Vec3(1, 1, 0), Vec3(-1, 1, 1)}) {
        const ShapeDescription box{"", BoxShape{Vec3::Constant(0.5)}};
        ConvexQuery query(box, box);
        const ConvexAnswer answer =
            bench.ask(query, method.name, Pose{}, {shift, Quat::Identity()}, 1, MethodStart::cold);
        tally.worst(method.name, "merely touching", "volume", std::abs(answer.volume), 1e-15, "m3");
        tally.count(method.name, "merely touching", "refused",
                    answer.verdict == QueryVerdict::refused ? 1 : 0);
    }
}

}  // namespace

void case_shared_volume(CaseBench& bench)
{
    MethodTally tally;
    bool any = false;
    for (const MethodDescription& method : known_methods()) {
        if (!method.volume) continue;
        any = true;
        for (const Shared& shared : known_volumes()) judge_volume(bench, tally, method, shared);
        judge_merely_touching(bench, tally, method);
    }
    if (!any) bench.skip("all methods", "shared volume", "no method tells it");
    tally.report(bench);
}

}  // namespace throng
