#include "cooking/sphere_trees/sphere_tree.hpp"

#include "cooking/sphere_trees/sphere_cover.hpp"
#include "cooking/sphere_trees/sphere_error.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Places to cover for each sphere of a level: with half as many, spheres move to where the gaps
// between places let them; and the least and greatest number of places.
constexpr std::size_t kPlaces = 20, kFewest = 2000, kMost = 16000;

constexpr double kBetter = 0.9;

// How much more than the least bound an error may be: less costs looks, and tells little.
constexpr double kSlack = 0.1;

// Rounded to what the tree holds, so that the error is that of what is used.
std::vector<Ball> rounded(std::vector<Ball> balls, double grown)
{
    for (Ball& ball : balls) {
        ball.center = ball.center.cast<float>().cast<double>();
        ball.radius = double{static_cast<float>(ball.radius + grown)};
    }
    return balls;
}

// Each sphere of the lower level to the one above that has to reach least further for it.
void hand_down(SphereTree::Level& above, SphereTree::Level& below)
{
    std::vector<std::vector<SphereTree::Node>> children(above.nodes.size());
    for (const SphereTree::Node& node : below.nodes) {
        std::size_t best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < above.nodes.size(); ++i) {
            const SphereTree::Node& parent = above.nodes[i];
            const double furthest =
                double{(parent.center - node.center).norm()} - double{parent.radius};
            if (furthest >= least) continue;
            least = furthest;
            best = i;
        }
        children[best].push_back(node);
    }
    below.nodes.clear();
    for (std::size_t i = 0; i < above.nodes.size(); ++i) {
        above.nodes[i].first = static_cast<std::uint32_t>(below.nodes.size());
        above.nodes[i].count = static_cast<std::uint32_t>(children[i].size());
        below.nodes.insert(below.nodes.end(), children[i].begin(), children[i].end());
    }
}

// From the last level up: round the sphere itself and all below.
void find_bounds(SphereTree& tree)
{
    for (std::size_t level = tree.levels.size(); level-- > 0;)
        for (SphereTree::Node& node : tree.levels[level].nodes) {
            double bound = node.radius;
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                const SphereTree::Node& child = tree.levels[level + 1].nodes[i];
                const Vec3 apart = (child.center - node.center).cast<double>();
                bound = std::max(bound, apart.norm() + double{child.bound});
            }
            // Outward, whatever float makes of it.
            node.bound = static_cast<float>(bound * (1 + 1e-6));
        }
}

}  // namespace

SphereTree build_sphere_tree(const Mesh& mesh, const SphereTreeLimits& limits)
{
    SphereTree tree;
    if (mesh.tree.empty()) return tree;
    MeshCells cells(mesh);
    double last = std::numeric_limits<double>::infinity();
    std::size_t count = 1;
    // One level may miss; where the next does too, no more spheres will help.
    int missed = 0;
    for (int level = 0; level < limits.levels && last > limits.error && missed < 2;
         ++level, count *= 8) {
        count = std::min(count, limits.spheres);
        const auto points = cover_points(mesh, std::clamp(kPlaces * count, kFewest, kMost));
        if (points.empty()) break;
        double separation = 0;
        const std::vector<Ball> cover = cover_mesh(cells, points, count, separation);
        const std::vector<Ball> balls = rounded(cover, separation / 2);
        const double error = sphere_error(mesh, balls, kSlack, limits.looks, kBetter * last);
        if (!(error < kBetter * last)) {
            ++missed;
            continue;
        }
        missed = 0;
        last = error;
        SphereTree::Level made;
        made.error = error;
        for (const Ball& ball : balls)
            made.nodes.push_back({ball.center.cast<float>(), static_cast<float>(ball.radius)});
        if (!tree.levels.empty()) hand_down(tree.levels.back(), made);
        tree.levels.push_back(std::move(made));
    }
    find_bounds(tree);
    return tree;
}

}  // namespace throng
