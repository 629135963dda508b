#include "scene/catalog/noisy_balls.hpp"

#include "kernels/check.hpp"
#include "scene/catalog/parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace throng {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// Corners and faces of an icosahedron, counter-clockwise seen from outside.
constexpr double kGolden = std::numbers::phi;
const Vec3 kCorners[12] = {{-1, kGolden, 0}, {1, kGolden, 0}, {-1, -kGolden, 0}, {1, -kGolden, 0},
                           {0, -1, kGolden}, {0, 1, kGolden}, {0, -1, -kGolden}, {0, 1, -kGolden},
                           {kGolden, 0, -1}, {kGolden, 0, 1}, {-kGolden, 0, -1}, {-kGolden, 0, 1}};
constexpr Triangle kFaces[20] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

/// Adds vertices as they are asked for; those of an edge are shared by its two faces.
class CutIcosahedron {
public:
    explicit CutIcosahedron(std::uint32_t cuts) : cuts_(cuts)
    {
        mesh_.vertices.assign(std::begin(kCorners), std::end(kCorners));
        for (const Triangle& face : kFaces) cut(face);
    }
    TriangleSoup take() { return std::move(mesh_); }

private:
    std::uint32_t add(const Vec3& vertex)
    {
        mesh_.vertices.push_back(vertex);
        return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
    }

    /// `step` cuts from corner a on the way to corner b.
    std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t step)
    {
        if (step == 0) return a;
        if (step == cuts_) return b;
        if (a > b) return on_edge(b, a, cuts_ - step);
        std::uint32_t& start = first_on_edge_[a][b];
        if (start == 0) {
            start = static_cast<std::uint32_t>(mesh_.vertices.size());
            for (std::uint32_t i = 1; i < cuts_; ++i)
                add((kCorners[a] * (cuts_ - i) + kCorners[b] * i) / cuts_);
        }
        return start + step - 1;
    }

    /// `i` cuts from a towards b, then `k` in the direction from a to c.
    std::uint32_t place(const Triangle& face, std::uint32_t i, std::uint32_t k)
    {
        const auto [a, b, c] = face;
        if (k == 0) return on_edge(a, b, i);
        if (i == 0) return on_edge(a, c, k);
        if (i + k == cuts_) return on_edge(b, c, k);
        return add((kCorners[a] * (cuts_ - i - k) + kCorners[b] * i + kCorners[c] * k) / cuts_);
    }

    void cut(const Triangle& face)
    {
        std::vector<std::uint32_t> row, next;
        for (std::uint32_t i = 0; i <= cuts_; ++i) row.push_back(place(face, i, 0));
        for (std::uint32_t k = 1; k <= cuts_; ++k) {
            next.clear();
            for (std::uint32_t i = 0; i + k <= cuts_; ++i) next.push_back(place(face, i, k));
            for (std::size_t i = 0; i < next.size(); ++i) {
                mesh_.triangles.push_back({row[i], row[i + 1], next[i]});
                if (i + 1 < next.size())
                    mesh_.triangles.push_back({row[i + 1], next[i + 1], next[i]});
            }
            std::swap(row, next);
        }
    }

    std::uint32_t cuts_;
    TriangleSoup mesh_;
    std::array<std::array<std::uint32_t, 12>, 12> first_on_edge_{};  // 0: none yet
};

/// Smooth in every direction, between -1 and 1: waves of several lengths, the longer the higher.
class Noise {
public:
    explicit Noise(std::uint64_t seed)
    {
        Random random(seed);
        double squares = 0;
        for (Wave& wave : waves_) {
            const double turns = random.uniform(2, 7);  // radians from the middle to the surface
            wave.along = turns * random_direction(random);
            wave.start = random.uniform(0, 2 * std::numbers::pi);
            wave.height = 1 / turns;
            squares += wave.height * wave.height / 2;
        }
        // The mean of the squares is then 1.
        for (Wave& wave : waves_) wave.height /= std::sqrt(squares);
    }
    double at(const Vec3& direction) const
    {
        double sum = 0;
        for (const Wave& wave : waves_)
            sum += wave.height * std::cos(wave.along.dot(direction) + wave.start);
        return sum / std::sqrt(1 + sum * sum);
    }

private:
    struct Wave {
        Vec3 along = Vec3::Zero();
        double start = 0, height = 0;
    };
    std::array<Wave, 16> waves_;
};

}  // namespace

TriangleSoup geodesic_ball(double radius, std::uint32_t cuts)
{
    THRONG_CHECK(cuts >= 1, "a ball needs at least its twenty triangles");
    TriangleSoup mesh = CutIcosahedron(cuts).take();
    for (Vec3& vertex : mesh.vertices) vertex *= radius / vertex.norm();
    return mesh;
}

TriangleSoup
noisy_ball(double radius, double roughness, std::uint32_t triangles, std::uint64_t seed)
{
    const double cuts = std::nearbyint(std::sqrt(triangles / 20.0));
    TriangleSoup mesh = geodesic_ball(1, static_cast<std::uint32_t>(std::max(1.0, cuts)));
    const Noise noise(seed);
    for (Vec3& vertex : mesh.vertices) vertex *= radius * (1 + roughness * noise.at(vertex));
    return mesh;
}

}  // namespace throng
