#include "cooking/hulls/hull.hpp"

#include "tests/support/shared_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace throng {
namespace {

using Points = std::vector<Vec3>;

double extent_of(const Points& points)
{
    Vec3 lower = points[0], upper = points[0];
    for (const Vec3& point : points) {
        lower = lower.cwiseMin(point);
        upper = upper.cwiseMax(point);
    }
    return (upper - lower).maxCoeff();
}

// Digits that coordinates far from the origin have lost before the hull sees them.
double rounding_of(const Points& points)
{
    double farthest = 0;
    for (const Vec3& point : points) farthest = std::max(farthest, point.cwiseAbs().maxCoeff());
    return 1e-14 * farthest;
}

// How far the points are above the faces at most, and the faces' own corners below them.
struct Fit {
    double above = 0, below = 0;
};

Fit fit_of(const Hull& hull, const Points& points)
{
    Fit fit;
    for (std::size_t f = 0; f < hull.normals.size(); ++f) {
        for (const Vec3& point : points)
            fit.above = std::max(fit.above, hull.normals[f].dot(point) - hull.offsets[f]);
        for (std::size_t i = hull.face_begin[f]; i < hull.face_begin[f + 1]; ++i)
            fit.below = std::max(fit.below,
                                 hull.offsets[f]
                                     - hull.normals[f].dot(hull.vertices[hull.face_vertices[i]]));
    }
    return fit;
}

// Each side of a face exactly once, each edge with its two faces, neighbors as the edges say.
void expect_joined(const Hull& hull)
{
    std::map<std::pair<int, int>, std::size_t> sides;
    std::vector<int> faces_at(hull.vertices.size(), 0);
    for (std::size_t f = 0; f + 1 < hull.face_begin.size(); ++f) {
        const std::size_t begin = hull.face_begin[f], end = hull.face_begin[f + 1];
        EXPECT_GE(end - begin, 3U);
        for (std::size_t i = begin; i < end; ++i) {
            const int from = hull.face_vertices[i];
            const int to = hull.face_vertices[i + 1 < end ? i + 1 : begin];
            EXPECT_TRUE(sides.emplace(std::pair(from, to), f).second) << from << " to " << to;
            ++faces_at[static_cast<std::size_t>(from)];
        }
    }
    EXPECT_EQ(sides.size(), 2 * hull.edges.size());
    EXPECT_EQ(hull.vertices.size() + hull.normals.size(), hull.edges.size() + 2);
    for (const int count : faces_at) EXPECT_GE(count, 3);
    std::set<std::pair<int, int>> joins;
    for (const Hull::Edge& edge : hull.edges) {
        EXPECT_LT(edge.from, edge.to);
        EXPECT_EQ(sides.at({edge.from, edge.to}), edge.left);
        EXPECT_EQ(sides.at({edge.to, edge.from}), edge.right);
        EXPECT_TRUE(joins.emplace(edge.from, edge.to).second);
        EXPECT_TRUE(joins.emplace(edge.to, edge.from).second);
    }
    ASSERT_EQ(hull.neighbor_begin.size(), hull.vertices.size() + 1);
    ASSERT_EQ(hull.neighbor_begin.back(), hull.neighbors.size());
    EXPECT_EQ(hull.neighbors.size(), joins.size());
    for (std::size_t v = 0; v < hull.vertices.size(); ++v)
        for (std::size_t i = hull.neighbor_begin[v]; i < hull.neighbor_begin[v + 1]; ++i)
            EXPECT_EQ(joins.count({static_cast<int>(v), hull.neighbors[i]}), 1U);
}

// Polygons turn left all the way, by the tolerance.
void expect_convex_polygons(const Hull& hull, double tolerance)
{
    for (std::size_t f = 0; f < hull.normals.size(); ++f) {
        const std::size_t begin = hull.face_begin[f], count = hull.face_begin[f + 1] - begin;
        const auto corner = [&](std::size_t i) -> const Vec3& {
            return hull.vertices[hull.face_vertices[begin + i % count]];
        };
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 chord = (corner(i + 2) - corner(i)).normalized();
            const double inside = hull.normals[f].cross(chord).dot(corner(i + 1) - corner(i));
            EXPECT_LE(inside, tolerance) << "face " << f;
        }
    }
}

// All that a hull promises, measured against the points it was made from.
void expect_sound(const HullResult& result, const Points& points)
{
    ASSERT_EQ(result.trouble, "");
    const Hull& hull = result.hull;
    const double extent = extent_of(points), rounding = rounding_of(points);
    expect_joined(hull);
    expect_convex_polygons(hull, 1.1e-5 * extent + rounding);
    for (const Vec3& normal : hull.normals) EXPECT_NEAR(normal.norm(), 1, 1e-12);

    const Fit own = fit_of(hull, hull.vertices), all = fit_of(hull, points);
    EXPECT_LE(own.above, std::max(1e-14 * extent, rounding));
    EXPECT_LE(own.below, 2.1e-5 * extent + rounding);
    EXPECT_LE(all.above, 4.1e-5 * extent + rounding);
    const auto is_vertex = [&](const Vec3& point) {
        return std::find(points.begin(), points.end(), point) != points.end();
    };
    if (points.size() < 20000) {
        EXPECT_TRUE(std::all_of(hull.vertices.begin(), hull.vertices.end(), is_vertex));
    }

    EXPECT_GT(hull.inner_radius, 0);
    for (std::size_t f = 0; f < hull.normals.size(); ++f)
        EXPECT_GE(hull.offsets[f] - hull.normals[f].dot(hull.center), hull.inner_radius - rounding);
    for (const Vec3& vertex : hull.vertices)
        EXPECT_LE((vertex - hull.center).norm(), hull.outer_radius * (1 + 1e-12));
}

void expect_counts(const Hull& hull, std::size_t vertices, std::size_t faces)
{
    EXPECT_EQ(hull.vertices.size(), vertices);
    EXPECT_EQ(hull.normals.size(), faces);
}

Points cube()
{
    Points points;
    for (int i = 0; i < 8; ++i)
        points.emplace_back((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5);
    return points;
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) { }
    double uniform() { return 2 * unit_(engine_) - 1; }
    int below(int count) { return static_cast<int>(unit_(engine_) * count); }
    Vec3 in_box() { return {uniform(), uniform(), uniform()}; }
    Vec3 on_sphere()
    {
        while (true) {
            const Vec3 p = in_box();
            if (p.norm() > 0.1 && p.norm() < 1) return p.normalized();
        }
    }
    Quat turn() { return Quat(uniform(), uniform(), uniform(), uniform() + 1.5).normalized(); }

private:
    std::mt19937_64 engine_;
    std::uniform_real_distribution<double> unit_{0, 1};
};

// A cube with points all over its faces and edges, and inside.
Points crowded_cube(Random& random)
{
    Points points = cube();
    for (int i = 0; i < 1000; ++i) {
        Vec3 point = 0.5 * random.in_box();
        point[i % 3] = random.below(2) - 0.5;
        if (i % 4 == 0) point[(i + 1) % 3] = random.below(2) - 0.5;
        points.push_back(point);
        points.push_back(0.49 * random.in_box());
    }
    return points;
}

Points stretched(Points points, const Vec3& sizes, const Quat& turn, const Vec3& offset)
{
    for (Vec3& point : points) point = turn * point.cwiseProduct(sizes) + offset;
    return points;
}

Points in_single_precision(Points points)
{
    for (Vec3& point : points) point = point.cast<float>().cast<double>();
    return points;
}

bool same_bits(const Hull& a, const Hull& b)
{
    const auto same_edges = [](const Hull::Edge& x, const Hull::Edge& y) {
        return x.from == y.from && x.to == y.to && x.left == y.left && x.right == y.right;
    };
    return a.vertices == b.vertices && a.normals == b.normals && a.offsets == b.offsets
        && a.face_begin == b.face_begin && a.face_vertices == b.face_vertices
        && a.neighbors == b.neighbors && a.neighbor_begin == b.neighbor_begin
        && std::equal(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(), same_edges)
        && a.center == b.center && a.inner_radius == b.inner_radius
        && a.outer_radius == b.outer_radius;
}

TEST(BuildHull, CubeOfRepeatedCornersIsACube)
{
    Points points;
    for (int i = 0; i < 8; ++i)
        for (const Vec3& corner : cube()) points.push_back(corner);
    const HullResult result = build_hull(points);
    expect_sound(result, points);
    expect_counts(result.hull, 8, 6);
    EXPECT_EQ(result.hull.vertices, cube());
    EXPECT_LT(result.hull.center.norm(), 1e-15);
    EXPECT_EQ(result.hull.inner_radius, 0.5);
    for (const Vec3& normal : result.hull.normals) EXPECT_EQ(normal.cwiseAbs().sum(), 1);
}

TEST(BuildHull, PointsOnFacesAndEdgesAndInsideAreLeftOut)
{
    Random random(1);
    for (int i = 0; i < 20; ++i) {
        const Points points = crowded_cube(random);
        const Quat turn = i == 0 ? Quat(1, 0, 0, 0) : random.turn();
        const Points turned = stretched(points, Vec3::Ones(), turn, random.in_box());
        for (const Points& cloud : {points, turned, in_single_precision(turned)}) {
            const HullResult result = build_hull(cloud);
            expect_sound(result, cloud);
            expect_counts(result.hull, 8, 6);
        }
    }
}

TEST(BuildHull, WorksAtEverySizeAndFarFromTheOrigin)
{
    Random random(2);
    const Points points = crowded_cube(random);
    for (double size = 1e-6; size < 2e6; size *= 10) {
        for (const double away : {0.0, 10.0, 1e4}) {
            const Points cloud = stretched(points, Vec3::Constant(size), random.turn(),
                                           away * size * random.in_box());
            const HullResult result = build_hull(cloud);
            expect_sound(result, cloud);
            expect_counts(result.hull, 8, 6);
            EXPECT_NEAR(result.hull.inner_radius, 0.5 * size, 1e-9 * size);
        }
    }
}

TEST(BuildHull, NeedlesAndPlatesKeepTheirSides)
{
    Random random(3);
    const Vec3 sizes[] = {{2000, 1e-3, 1e-3}, {1e-3, 2000, 1e-3}, {1e3, 1e3, 1e-3}, {1e3, 1, 1e-3}};
    for (int i = 0; i < 20; ++i)
        for (const Vec3& size : sizes) {
            const Quat turn = i == 0 ? Quat(1, 0, 0, 0) : random.turn();
            const Points few = stretched(cube(), size, turn, Vec3::Zero());
            const Points many = stretched(crowded_cube(random), size, turn, Vec3::Zero());
            for (const Points& cloud : {few, many}) {
                const HullResult result = build_hull(cloud);
                expect_sound(result, cloud);
                expect_counts(result.hull, 8, 6);
                EXPECT_NEAR(result.hull.inner_radius, 5e-4, 1e-8);
            }
        }
}

TEST(BuildHull, RefusesWhatEnclosesNothing)
{
    Random random(4);
    const Vec3 u = random.on_sphere(), v = random.on_sphere(), offset = random.in_box();
    Points plane, line, repeated(50, offset);
    for (int i = 0; i < 50; ++i) {
        plane.push_back(offset + random.uniform() * u + random.uniform() * v);
        line.push_back(offset + random.uniform() * u);
    }
    const std::string volume = "; give points that enclose a volume";
    const std::string distinct = " distinct ones; give at least 4 that enclose a volume";
    EXPECT_EQ(build_hull(plane).trouble, "points lie in one plane" + volume);
    EXPECT_EQ(build_hull(line).trouble, "points lie on one line" + volume);
    EXPECT_EQ(build_hull(repeated).trouble, "points are 1" + distinct);
    EXPECT_EQ(build_hull({}).trouble, "points are 0" + distinct);
    plane[7].y() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(build_hull(plane).trouble, "point 7 is not finite; give finite coordinates");
    EXPECT_NE(build_hull(stretched(cube(), Vec3::Constant(1e300), Quat::Identity(), Vec3::Zero()))
                  .trouble,
              "");
}

TEST(BuildHull, AlmostFlatIsRefusedOrSound)
{
    Random random(5);
    for (double height = 1e-16; height < 1; height *= 10)
        for (int i = 0; i < 20; ++i) {
            const Quat turn = random.turn();
            Points points;
            for (int k = 0; k < 4 + 10 * (i % 2); ++k)
                points.push_back(
                    turn * Vec3(random.uniform(), random.uniform(), height * random.uniform()));
            const HullResult result = build_hull(points);
            if (height < 1e-9) {
                EXPECT_NE(result.trouble, "") << height;
            }
            if (height > 1e-6) {
                EXPECT_EQ(result.trouble, "") << height;
            }
            if (result.trouble.empty()) expect_sound(result, points);
        }
}

// Points that leave a plane by about as much as rounding to the grid moves them: near each other,
// and far, so that climbing from one to the next may end below the highest.
TEST(BuildHull, NoVertexIsAboveTheFaceOfPointsThatAlmostLieInOnePlane)
{
    Random random(9);
    for (int i = 0; i < 500; ++i) {
        SCOPED_TRACE(i);
        const double stray = std::pow(10.0, -8 - i % 5), spread = std::pow(10.0, -(i / 5 % 4));
        Points points{{0.2 * random.uniform(), 0.2 * random.uniform(), -1}};
        for (int k = 0; k < 6 + i % 40; ++k) {
            const double near = k % 3 == 0 ? spread : 1;
            points.emplace_back(near * random.uniform(), near * random.uniform(),
                                stray * random.uniform());
        }
        const Quat turn = i % 2 == 0 ? Quat(1, 0, 0, 0) : random.turn();
        points = stretched(points, Vec3::Ones(), turn, Vec3::Zero());
        expect_sound(build_hull(points), points);
    }
}

TEST(BuildHull, RefusesMoreVerticesThanIndicesCanName)
{
    Random random(6);
    Points points;
    for (int i = 0; i < 50000; ++i) points.push_back(random.on_sphere());
    EXPECT_NE(build_hull(points).trouble.find("give fewer points"), std::string::npos);
}

TEST(BuildHull, TenThousandVerticesTakeLessThanASecond)
{
    Random random(7);
    Points points;
    for (int i = 0; i < 10000; ++i) points.push_back(random.on_sphere());
    const auto begin = std::chrono::steady_clock::now();
    const HullResult result = build_hull(points);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    EXPECT_GT(result.hull.vertices.size(), 9900U);
    expect_joined(result.hull);
    // Generous: other programs and sanitizers share the machine.
    EXPECT_LT(taken.count(), 5);
}

// A corner with as many round it as there are faces costs each face some boxes, not all of them.
TEST(BuildHull, TipsOfManyFacesTakeNoLongerThanRoundOnes)
{
    Random random(9);
    Points ball, cones;
    constexpr int kPoints = 8192;
    for (int i = 0; i < kPoints; ++i) {
        ball.push_back(random.on_sphere());
        const double angle = 2 * std::numbers::pi * i / kPoints;
        cones.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    cones.emplace_back(0, 0, 1);
    cones.emplace_back(0, 0, -1);
    const auto seconds = [](const Points& points) {
        double least = 1e9;
        for (int i = 0; i < 3; ++i) {
            const auto begin = std::chrono::steady_clock::now();
            expect_joined(build_hull(points).hull);
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
            least = std::min(least, taken.count());
        }
        return least;
    };
    // Five times before boxes.
    EXPECT_LT(seconds(cones), 3 * seconds(ball));
}

TEST(BuildHull, SamePointsGiveTheSameBits)
{
    Random random(8);
    const Points points = crowded_cube(random);
    EXPECT_TRUE(same_bits(build_hull(points).hull, build_hull(points).hull));
}

// The plain twin for points in general position: every triple with all points on one side.
std::set<std::set<std::size_t>> supporting_triples(const Points& p)
{
    std::set<std::set<std::size_t>> found;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = i + 1; j < p.size(); ++j)
            for (std::size_t k = j + 1; k < p.size(); ++k) {
                int above = 0, below = 0;
                const Vec3 normal = (p[j] - p[i]).cross(p[k] - p[i]);
                for (std::size_t l = 0; l < p.size(); ++l) {
                    if (l == i || l == j || l == k) continue;
                    ++(normal.dot(p[l] - p[i]) > 0 ? above : below);
                }
                if (above == 0 || below == 0) found.insert({i, j, k});
            }
    return found;
}

TEST(BuildHull, RandomCloudsMatchEverySupportingTriple)
{
    for (unsigned seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        Points points;
        const int count = 4 + random.below(20);
        for (int i = 0; i < count; ++i)
            points.push_back(seed % 2 == 0 ? random.in_box() : random.on_sphere());
        const HullResult result = build_hull(points);
        expect_sound(result, points);
        std::set<std::set<std::size_t>> faces;
        for (std::size_t f = 0; f < result.hull.normals.size(); ++f) {
            std::set<std::size_t> face;
            for (std::size_t i = result.hull.face_begin[f]; i < result.hull.face_begin[f + 1];
                 ++i) {
                const Vec3& vertex = result.hull.vertices[result.hull.face_vertices[i]];
                face.insert(static_cast<std::size_t>(std::find(points.begin(), points.end(), vertex)
                                                     - points.begin()));
            }
            faces.insert(face);
        }
        // Two triples that all but share a plane make one face.
        const auto triples = supporting_triples(points);
        std::size_t covered = 0;
        for (const std::set<std::size_t>& face : faces) covered += face.size() - 2;
        EXPECT_EQ(covered, triples.size());
        for (const std::set<std::size_t>& triple : triples)
            EXPECT_TRUE(std::any_of(faces.begin(), faces.end(), [&](const auto& face) {
                return std::includes(face.begin(), face.end(), triple.begin(), triple.end());
            }));
    }
}

// The plain twin in whole numbers, for points with many in one plane and on one line: each
// supporting plane once, as its normal divided by what its numbers share.
using Lattice = std::array<int, 3>;

std::map<Lattice, std::set<Lattice>> supporting_planes(const std::vector<Lattice>& p)
{
    std::map<Lattice, std::set<Lattice>> planes;
    const auto minus = [](const Lattice& a, const Lattice& b) {
        return Lattice{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    };
    const auto dot = [](const Lattice& a, const Lattice& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    for (const Lattice& a : p)
        for (const Lattice& b : p)
            for (const Lattice& c : p) {
                const Lattice u = minus(b, a), v = minus(c, a);
                Lattice n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0]};
                const int shared = std::gcd(std::gcd(n[0], n[1]), n[2]);
                if (shared == 0) continue;
                for (int& x : n) x /= shared;
                std::set<Lattice> on;
                bool supporting = true;
                for (const Lattice& q : p) {
                    const int height = dot(n, minus(q, a));
                    supporting = supporting && height <= 0;
                    if (height == 0) on.insert(q);
                }
                if (supporting) planes[n] = on;
            }
    return planes;
}

TEST(BuildHull, LatticeCloudsMatchEverySupportingPlane)
{
    int solid = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const int side = 2 + random.below(4), count = 4 + random.below(24);
        std::vector<Lattice> lattice;
        Points points;
        for (int i = 0; i < count; ++i) {
            lattice.push_back({random.below(side), random.below(side), random.below(side)});
            points.emplace_back(lattice[static_cast<std::size_t>(i)][0],
                                lattice[static_cast<std::size_t>(i)][1],
                                lattice[static_cast<std::size_t>(i)][2]);
        }
        const auto planes = supporting_planes(lattice);
        const HullResult result = build_hull(points);
        // A flat cloud has its own plane twice, once from either side, or no plane at all.
        const bool flat = planes.size() < 4;
        EXPECT_EQ(result.trouble.empty(), !flat) << result.trouble;
        if (flat || !result.trouble.empty()) continue;
        ++solid;
        expect_sound(result, points);
        ASSERT_EQ(result.hull.normals.size(), planes.size());
        std::map<Lattice, int> planes_at;
        for (const auto& [normal, on] : planes)
            for (const Lattice& q : on) ++planes_at[q];
        const auto corners = std::count_if(planes_at.begin(), planes_at.end(),
                                           [](const auto& entry) { return entry.second > 2; });
        EXPECT_EQ(result.hull.vertices.size(), static_cast<std::size_t>(corners));
    }
    EXPECT_GT(solid, 100);
}

// Points rounded to few digits, nearly in one plane, nearly on one line, in clumps: whatever makes
// hull builders stumble.
TEST(BuildHull, HardCloudsAreSound)
{
    for (unsigned seed = 0; seed < 400; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(1000 + seed);
        const double noise = std::pow(10.0, -random.below(17));
        const double clump = std::pow(10.0, -random.below(9));
        Points centers, points;
        for (int i = 0; i < 8; ++i) centers.push_back(seed % 3 == 0 ? cube()[i] : random.in_box());
        for (int i = 0; i < 300; ++i) {
            const Vec3& a = centers[static_cast<std::size_t>(random.below(8))];
            const Vec3& b = centers[static_cast<std::size_t>(random.below(8))];
            const double at = seed % 2 == 0 ? random.uniform() : random.below(5) / 4.0;
            points.emplace_back(a + at * (b - a) + noise * random.in_box()
                                + clump * random.on_sphere());
        }
        const HullResult result = build_hull(points);
        expect_sound(result, points);
    }
}

TEST(BuildHull, RoundedShapesAreSound)
{
    Random random(9);
    for (const int around : {3, 8, 100}) {
        Points disks, ball;
        for (int i = 0; i < around; ++i) {
            const double angle = 2 * M_PI * i / around;
            for (const double z : {-1.0, 1.0}) disks.emplace_back(cos(angle), sin(angle), z);
            for (int k = 0; k < 20; ++k) {
                const double polar = M_PI * (k + 0.5) / 20;
                ball.emplace_back(cos(angle) * sin(polar), sin(angle) * sin(polar), cos(polar));
            }
        }
        const Quat turn = random.turn();
        for (const Points& exact : {disks, ball}) {
            const Points turned = stretched(exact, Vec3::Ones(), turn, Vec3::Zero());
            for (const Points& cloud : {exact, turned, in_single_precision(turned)})
                expect_sound(build_hull(cloud), cloud);
        }
        expect_counts(build_hull(disks).hull, static_cast<std::size_t>(2 * around),
                      static_cast<std::size_t>(around + 2));
    }
}

TEST(BuildHull, HullsFromGamesAreSoundOrRefused)
{
    const std::filesystem::path path = shared_data("hulls/game_hulls.bin");
    if (path.empty()) GTEST_SKIP() << "hulls/game_hulls.bin is not there; set THRONG_DATA";
    std::ifstream file(path, std::ios::binary);
    std::uint32_t count = 0;
    int built = 0, refused = 0;
    std::size_t most = 0;
    while (file.read(reinterpret_cast<char*>(&count), sizeof count)) {
        std::vector<Vec3T<float>> read(count);
        file.read(reinterpret_cast<char*>(read.data()), static_cast<std::streamsize>(12) * count);
        Points points;
        for (const Vec3T<float>& point : read) points.push_back(point.cast<double>());
        const HullResult result = build_hull(points);
        SCOPED_TRACE("hull " + std::to_string(built + refused));
        ++(result.trouble.empty() ? built : refused);
        if (result.trouble.empty()) expect_sound(result, points);
        most = std::max(most, result.hull.vertices.size());
    }
    std::printf("hulls built: %d, refused: %d, most vertices: %zu\n", built, refused, most);
    EXPECT_GT(built, 50 * refused);
}

}  // namespace
}  // namespace throng
