#include "cooking/sphere_trees/ball_tree.hpp"

#include "kernels/data/bounds.hpp"

#include <array>
#include <numeric>

namespace throng {
namespace {

constexpr std::uint32_t kLeaf = 8;

// More than rounding takes from a distance.
constexpr double kSlack = 1e-12;

}  // namespace

BallTree::BallTree(std::span<const Ball> balls) : balls_(balls), order_(balls.size())
{
    if (balls.empty()) return;
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.resize(1);
    build(0, 0, static_cast<std::uint32_t>(balls.size()));
}

// Halves along the longest side.
void BallTree::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end)
{
    Box3 box;
    for (std::uint32_t i = begin; i < end; ++i) {
        const Vec3& center = balls_[order_[i]].center;
        box = joined(box, {center, center});
    }
    Node made{0.5 * (box.lower + box.upper), 0, begin, end - begin};
    for (std::uint32_t i = begin; i < end; ++i) {
        const Ball& ball = balls_[order_[i]];
        made.outer_radius =
            std::max(made.outer_radius, (ball.center - made.center).norm() + ball.radius);
    }
    made.outer_radius += kSlack * (made.outer_radius + made.center.cwiseAbs().maxCoeff());
    nodes_[node] = made;
    if (end - begin <= kLeaf) return;
    Eigen::Index axis = 0;
    (box.upper - box.lower).maxCoeff(&axis);
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double at_a = balls_[a].center[axis], at_b = balls_[b].center[axis];
                         return at_a != at_b ? at_a < at_b : a < b;
                     });
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = left;
    nodes_[node].count = 0;
    nodes_.resize(nodes_.size() + 2);
    build(left, begin, half);
    build(left + 1, half, end);
}

// No ball of the node is nearer.
double BallTree::least_of(const Node& node, const Vec3& place) const
{
    return (place - node.center).norm() * (1 - kSlack) - node.outer_radius;
}

// All balls but those that are further than the limit, as it stands by then; the nearer node first.
template <class Limit, class Visitor>
void BallTree::visit(const Vec3& place, Limit limit, Visitor visit) const
{
    struct Waiting {
        std::uint32_t node;
        double least;
    };
    // Halved 32 times there are none left of any count.
    std::array<Waiting, 64> waiting;
    std::size_t count = 0;
    if (!nodes_.empty()) waiting[count++] = {0, least_of(nodes_[0], place)};
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (next.least > limit()) continue;
        const Node& node = nodes_[next.node];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            visit(order_[i], distance_to(balls_[order_[i]], place));
        if (node.count > 0) continue;
        Waiting near{node.first, least_of(nodes_[node.first], place)};
        Waiting far{node.first + 1, least_of(nodes_[node.first + 1], place)};
        if (far.least < near.least) std::swap(near, far);
        waiting[count++] = far;
        waiting[count++] = near;
    }
}

double BallTree::least_separation(const Vec3& place, double enough) const
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double least = kInfinity;
    visit(
        place, [&] { return least < enough ? -kInfinity : least; },
        [&](std::uint32_t, double separation) { least = std::min(least, separation); });
    return least;
}

NearestBalls BallTree::nearest(const Vec3& place, std::span<const std::uint8_t> gone) const
{
    NearestBalls found;
    visit(
        place, [&] { return found.next; },
        [&](std::uint32_t which, double separation) {
            if (gone.empty() || gone[which] == 0) found.offer(which, separation);
        });
    return found;
}

void BallTree::find_within(const Vec3& place,
                           double separation,
                           std::vector<std::uint32_t>& found) const
{
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    visit(
        place, [&] { return separation; },
        [&](std::uint32_t which, double here) {
            if (here <= separation) found.push_back(which);
        });
    std::sort(found.begin() + begin, found.end());
}

}  // namespace throng
