// Degenerate hulls: H30, points that enclose nothing, and cubes stated in more points than they
// have corners.
//
// Answer: the first are refused in words; the others answer as the clean cube does, to 1e-12.
#include "cooking/hulls/hull.hpp"
#include "cost/hard_cases/convex_judge.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "kernels/geometry/mass.hpp"
#include "scene/catalog/random.hpp"
#include "throng/rotation.hpp"

#include <cmath>
#include <set>

namespace throng {

namespace {

using Points = std::vector<Vec3>;

constexpr int kPlacings = 12;
constexpr double kBound = 1e-12;

struct Given {
    const char* name;
    Points points;
    Points clean;  // empty: encloses nothing
};

Points cube()
{
    Points points;
    for (unsigned i = 0; i < 8; ++i)
        points.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    return points;
}

Points joined(Points first, const Points& second)
{
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

Points repeated(const Points& points, int times)
{
    Points all;
    for (int i = 0; i < times; ++i) all = joined(std::move(all), points);
    return all;
}

Points turned(Points points, const Quat& turn)
{
    for (Vec3& point : points) point = turn * point;
    return points;
}

Points on_faces(int count)
{
    Random random(30);
    Points points;
    for (int i = 0; i < count; ++i) {
        Vec3 point(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
        point[i % 3] = i % 2 == 0 ? 0.5 : -0.5;
        points.push_back(point);
    }
    return points;
}

Points mid_edges()
{
    const Points corners = cube();
    Points points;
    for (unsigned i = 0; i < 8; ++i)
        for (const unsigned bit : {1u, 2u, 4u})
            if ((i & bit) == 0) points.push_back((corners[i] + corners[i | bit]) / 2);
    return points;
}

Points jittered(Points points, double by)
{
    Random random(33);
    for (Vec3& point : points)
        for (int axis = 0; axis < 3; ++axis) point[axis] += random.uniform(-by, by);
    return points;
}

std::vector<Given> hulls()
{
    const Quat turn = exponential(Vec3(0.4, -0.3, 0.8));
    const Points quad = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const Points flat = {{0, 0, 0}, {1, 0, 1e-12}, {1, 1, -1e-12}, {0, 1, 1e-12}};
    return {
        {"no point", {}, {}},
        {"point", {{1, 2, 3}}, {}},
        {"point, eight times", repeated({{1, 2, 3}}, 8), {}},
        {"segment", {{0, 0, 0}, {1, 1, 1}}, {}},
        {"four points on a line", {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, {}},
        {"triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}},
        {"flat quad", quad, {}},
        {"flat quad, turned", turned(quad, turn), {}},
        {"four points within 1e-12 of a plane", flat, {}},
        {"point that is no number", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}, {}},
        {"cube", cube(), cube()},
        {"cube, each corner 8 times", repeated(cube(), 8), cube()},
        {"cube, 1000 points on its faces", joined(on_faces(1000), cube()), cube()},
        {"turned cube, 1000 points on its faces", turned(joined(on_faces(1000), cube()), turn),
         turned(cube(), turn)},
        {"cube, one point inside", joined({{0.1, 0.2, -0.05}}, cube()), cube()},
        {"cube, a point amid each edge", joined(mid_edges(), cube()), cube()},
        {"turned cube, a point amid each edge", turned(joined(mid_edges(), cube()), turn),
         turned(cube(), turn)},
        {"cube, each corner 8 times to within 1e-14", jittered(repeated(cube(), 8), 1e-14), cube()},
    };
}

// Every edge between two faces that run along it both ways, Euler's number, and the cube's volume.
bool is_closed(const Hull& hull)
{
    std::set<std::pair<std::uint16_t, std::uint16_t>> sides;
    for (std::size_t face = 0; face < hull.normals.size(); ++face) {
        const std::size_t begin = hull.face_begin[face], end = hull.face_begin[face + 1];
        for (std::size_t i = begin; i < end; ++i)
            if (!sides
                     .insert(
                         {hull.face_vertices[i], hull.face_vertices[i + 1 < end ? i + 1 : begin]})
                     .second)
                return false;
    }
    for (const auto& [from, to] : sides)
        if (sides.count({to, from}) == 0) return false;
    return sides.size() == 2 * hull.edges.size()
        && hull.vertices.size() + hull.normals.size() == hull.edges.size() + 2
        && std::abs(mass_of(hull).volume - 1) < kBound;
}

// Clear is: it says what is wrong and what to give instead.
bool refused_clearly(const Points& points)
{
    const ConvexQuery query({"", HullShape{points}}, {"", SphereShape{1}});
    const std::string& trouble = query.trouble();
    return trouble.find("give ") != std::string::npos
        || trouble.find("wanted a place") != std::string::npos;
}

// Like placings for every hull, from deep inside one another to well apart.
void judge_hull(CaseBench& bench, MethodTally& tally, const Given& given)
{
    const Vec3 half(0.3, 0.4, 0.2);
    Random random(34);
    for (int i = 0; i < kPlacings; ++i) {
        Pose pose;
        for (int axis = 0; axis < 3; ++axis) pose.position[axis] = random.uniform(-1, 1);
        Vec3 about = Vec3::Zero();
        for (int axis = 0; axis < 3; ++axis) about[axis] = random.uniform(-2, 2);
        pose.orientation = exponential(about);
        KnownPair pair{{"", HullShape{given.points}}, {"", BoxShape{half}}, Pose{}, pose};
        pair.solid_a = quad_cloud(given.clean, QuadPose(Pose{}));
        pair.solid_b = quad_box(half, QuadPose(pose));
        pair.truth = quad_truth(*pair.solid_a, *pair.solid_b).separation;
        judge(bench, tally, pair, "", {.value = kBound});
        judge_in_float(bench, tally, pair, "");
    }
}

}  // namespace

void case_degenerate_hulls(CaseBench& bench)
{
    MethodTally tally;
    for (const Given& given : hulls()) {
        if (given.clean.empty()) {
            bench.report(given.name, "not refused, or not in words",
                         refused_clearly(given.points) ? 0 : 1, 0, "1");
            continue;
        }
        const HullResult built = build_hull(given.points);
        const bool good = built.trouble.empty() && is_closed(built.hull);
        bench.report(given.name, "refused, open or inside out", good ? 0 : 1, 0, "1");
        judge_hull(bench, tally, given);
    }
    tally.report(bench);
}

}  // namespace throng
