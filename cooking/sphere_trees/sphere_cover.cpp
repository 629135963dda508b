#include "cooking/sphere_trees/sphere_cover.hpp"

#include "kernels/data/bounds.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/parallel/blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace throng {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Rounds of moving balls and putting them elsewhere: after the third the gap hardly falls.
constexpr int kRounds = 4;

double need(const CoverPoint& point, double separation)
{
    return point.depth > 0 ? 2 * std::min(separation, point.depth) : separation;
}

// Places that lie side by side, in a ball; most balls of a cover have to do with few of them.
struct Block {
    std::size_t begin = 0, end = 0;
    Vec3 center = Vec3::Zero();
    double radius = 0;
    double furthest = kFar;  // the greatest `next` of them
    double need = kFar;      // the greatest
};

constexpr std::size_t kBlock = 32;

// Of radii, more than rounding takes from them.
constexpr double kSlack = 1 + 1e-9;

class Cover {
public:
    Cover(MeshCells& cells, std::span<const CoverPoint> points)
        : cells_(cells), points_(points.begin(), points.end())
    {
        sort_into_blocks();
        serve_all();
    }

    std::vector<Ball> choose(std::size_t count, double& separation)
    {
        std::vector<Ball> best;
        separation = kFar;
        for (int round = 0; round <= kRounds; ++round) {
            while (balls_.size() < count && worst() > 0) put_at_worst();
            if (round < kRounds) add_hollows();
            for (int k = 0; k < 2; ++k) {
                move_all();
                serve_all();
                if (const double now = worst(); now < separation) {
                    separation = now;
                    best = balls_;
                }
            }
            if (round < kRounds) drop_spare();
        }
        return best;
    }

private:
    const Mesh& mesh() const { return cells_.mesh(); }

    // Halves across the longest side, over and over.
    void sort_into_blocks()
    {
        std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points_.size()}};
        while (!open.empty()) {
            const auto [begin, end] = open.back();
            open.pop_back();
            Box3 box;
            for (std::size_t i = begin; i < end; ++i) {
                box.lower = box.lower.cwiseMin(points_[i].at);
                box.upper = box.upper.cwiseMax(points_[i].at);
            }
            if (end - begin <= kBlock) {
                Block block{begin, end, (box.lower + box.upper) / 2, 0};
                for (std::size_t i = begin; i < end; ++i)
                    block.radius = std::max(block.radius, (points_[i].at - block.center).norm());
                blocks_.push_back(block);
                continue;
            }
            Eigen::Index axis = 0;
            (box.upper - box.lower).maxCoeff(&axis);
            const std::size_t half = (begin + end) / 2;
            const auto at = [&](std::size_t i) {
                return points_.begin() + static_cast<std::ptrdiff_t>(i);
            };
            std::nth_element(at(begin), at(half), at(end),
                             [axis](const CoverPoint& a, const CoverPoint& b) {
                                 return a.at[axis] < b.at[axis];
                             });
            open.emplace_back(half, end);
            open.emplace_back(begin, half);
        }
    }

    std::size_t worst_place() const
    {
        const auto less = [](const Block& a, const Block& b) { return a.need < b.need; };
        const Block& block = *std::max_element(blocks_.begin(), blocks_.end(), less);
        std::size_t worst = block.begin;
        for (std::size_t i = block.begin; i < block.end; ++i)
            if (need_of(i) > need_of(worst)) worst = i;
        return worst;
    }
    double worst() const { return need_of(worst_place()); }

    // Before there are balls, the deepest place is served worst.
    double need_of(std::size_t i) const
    {
        if (balls_.empty()) return points_[i].depth;
        return need(points_[i], served_[i].separation);
    }

    void update(Block& block) const
    {
        block.furthest = block.need = -kFar;
        for (std::size_t i = block.begin; i < block.end; ++i) {
            block.furthest = std::max(block.furthest, served_[i].next);
            block.need = std::max(block.need, need_of(i));
        }
    }

    void serve_point(std::size_t i, std::uint32_t ball)
    {
        served_[i].offer(ball, distance_to(balls_[ball], points_[i].at));
    }
    NearestBalls nearest_of(std::span<const std::uint32_t> balls, const Vec3& place) const
    {
        NearestBalls found;
        for (const std::uint32_t which : balls) {
            const Ball& ball = balls_[which];
            // Most are not worth a root.
            const double furthest = (found.next + ball.radius) * kSlack;
            if (furthest > 0 && (place - ball.center).squaredNorm() > furthest * furthest) continue;
            found.offer(which, distance_to(ball, place));
        }
        return found;
    }
    void serve(std::uint32_t which)
    {
        const Ball& ball = balls_[which];
        for (Block& block : blocks_) {
            const double furthest = block.furthest + block.radius + ball.radius;
            if ((block.center - ball.center).squaredNorm() > furthest * furthest) continue;
            for (std::size_t i = block.begin; i < block.end; ++i) serve_point(i, which);
            update(block);
        }
    }
    // Of a place in a block none but those are nearest or next that are so for its middle, to
    // within the block.
    void serve_all()
    {
        served_.resize(points_.size());
        const BallTree tree(balls_);
        for_each_block(blocks_.size(), 16, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<std::uint32_t> near;
            for (std::size_t b = begin; b < end; ++b) {
                Block& block = blocks_[b];
                const double next = tree.nearest(block.center).next;
                near.clear();
                tree.find_within(block.center, next + 2 * block.radius * kSlack, near);
                for (std::size_t i = block.begin; i < block.end; ++i)
                    served_[i] = nearest_of(near, points_[i].at);
                update(block);
            }
        });
    }

    // Steps along axes and diagonals, halved where none betters the ball, as `value` has it, which
    // need not tell values above the one it is given from that one. The places that the ball was
    // found to touch tell of most steps that they are no good.
    template <class Value>
    void climb(Ball& ball, double step, int halvings, const Value& value) const
    {
        double now = value(ball, kFar);
        std::array<Vec3, 12> touched;
        std::size_t count = 0;
        touched[count++] = nearest_on_mesh(mesh(), ball.center).point;
        for (int round = 0; round < 40 && halvings > 0; ++round) {
            Ball best = ball;
            double least = now;
            for (int i = 0; i < 27; ++i) {
                const Vec3 way(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
                const double kind = way.squaredNorm();
                if (kind != 1 && kind != 3) continue;
                const double length = step / std::sqrt(kind);
                Ball tried{ball.center + way * length, kFar};
                for (std::size_t k = 0; k < std::min(count, touched.size()); ++k)
                    tried.radius = std::min(tried.radius, (tried.center - touched[k]).norm());
                if (!(value(tried, least) < least)) continue;  // even if it could be that large
                const MeshPoint nearest =
                    nearest_on_mesh(mesh(), tried.center, tried.radius * kSlack);
                if (nearest.distance == kFar) continue;
                touched[count++ % touched.size()] = nearest.point;
                tried.radius = -signed_distance(mesh(), tried.center, nearest);
                const double then = value(tried, least);
                if (!(then < least)) continue;
                least = then;
                best = tried;
            }
            if (least < now) {
                ball = best;
                now = least;
            } else {
                step /= 2;
                --halvings;
            }
        }
    }

    // The largest ball that comes within half of the present gap of the worst place.
    void put_at_worst()
    {
        const CoverPoint& point = points_[worst_place()];
        Ball ball{point.at, point.depth};
        const bool first = balls_.empty();
        const double near = first ? kFar : worst() / 2, step = first ? point.depth : worst();
        climb(ball, step, 5, [&](const Ball& tried, double) {
            const double off = (tried.center - point.at).norm() - tried.radius;
            return off <= near ? -tried.radius : kFar;
        });
        balls_.push_back(ball);
        if (first)
            for (Block& block : blocks_) update(block);
        serve(static_cast<std::uint32_t>(balls_.size() - 1));
    }

    // Places below the surface that no ball would hold if all were grown by half the gap.
    void add_hollows()
    {
        const double separation = worst();
        const BallTree tree(balls_);
        std::vector<CoverPoint> found;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (points_[i].depth > 0) continue;
            for (const double step : {0.75, 1.5, 3.0, 6.0, 12.0}) {
                const double below = step * separation;
                const Vec3 at = points_[i].at + points_[i].inward * below;
                if (distance_to(balls_[served_[i].by], at) <= separation / 2) continue;
                if (cells_.depth_bound(at) <= separation / 2) continue;
                if (tree.least_separation(at, separation / 2) <= separation / 2) continue;
                const double depth = -signed_distance(mesh(), at);
                if (depth > separation / 2) found.push_back({at, depth, Vec3::Zero()});
            }
        }
        if (found.empty()) return;
        points_.insert(points_.end(), found.begin(), found.end());
        blocks_.clear();
        sort_into_blocks();
        serve_all();
    }

    // Each ball to where the furthest of its own places is nearest.
    void move_all()
    {
        std::vector<std::vector<std::uint32_t>> own(balls_.size());
        for (std::uint32_t i = 0; i < points_.size(); ++i) own[served_[i].by].push_back(i);
        for_each_block(balls_.size(), 8, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t b = begin; b < end; ++b) move(balls_[b], own[b]);
        });
    }

    void move(Ball& ball, std::span<const std::uint32_t> own) const
    {
        double widest = 0;
        for (const std::uint32_t i : own) widest = std::max(widest, served_[i].separation);
        if (!(widest > 0)) return;
        climb(ball, 2 * widest, 5, [&](const Ball& tried, double enough) {
            double most = -kFar;
            for (const std::uint32_t i : own) {
                most = std::max(most, need(points_[i], distance_to(tried, points_[i].at)));
                if (most >= enough) break;
            }
            return most;
        });
    }

    // Takes out the balls whose places others come as near to as the worst place has it.
    void drop_spare()
    {
        const BallTree tree(balls_);
        const double most = 0.9 * worst();
        std::vector<double> alone(balls_.size(), -kFar);
        for (std::size_t i = 0; i < points_.size(); ++i) {
            double& without = alone[served_[i].by];
            without = std::max(without, need(points_[i], served_[i].next));
        }
        // One at a time, the least missed first: two may be each other's stand-in.
        for (std::size_t count = balls_.size() / 8; count > 0; --count) {
            const auto spare = std::min_element(alone.begin(), alone.end());
            if (!(*spare < most) || balls_.size() < 2) break;
            const auto which = static_cast<std::uint32_t>(spare - alone.begin());
            remove(which, tree, alone);
        }
        serve_all_again();
    }

    void remove(std::uint32_t which, const BallTree& tree, std::vector<double>& alone)
    {
        // Its places go to the next best; what that is was not kept.
        gone_.resize(balls_.size(), 0);
        gone_[which] = 1;
        alone[which] = kFar;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const bool second = served_[i].next == distance_to(balls_[which], points_[i].at);
            if (served_[i].by != which && !second) continue;
            served_[i] = tree.nearest(points_[i].at, gone_);
            double& without = alone[served_[i].by];
            without = std::max(without, need(points_[i], served_[i].next));
        }
    }

    void serve_all_again()
    {
        if (gone_.empty()) return;
        std::vector<Ball> kept;
        for (std::size_t b = 0; b < balls_.size(); ++b)
            if (gone_[b] == 0) kept.push_back(balls_[b]);
        balls_.swap(kept);
        gone_.clear();
        serve_all();
    }

    MeshCells& cells_;
    std::vector<CoverPoint> points_;
    std::vector<Block> blocks_;
    std::vector<NearestBalls> served_;
    std::vector<Ball> balls_;
    std::vector<std::uint8_t> gone_;
};

double area_of(const Mesh& mesh, std::size_t triangle)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3& from = mesh.vertices[a];
    return (mesh.vertices[b] - from).cross(mesh.vertices[c] - from).norm() / 2;
}

// A grid on a triangle, without its corners.
void add_grid(const Mesh& mesh, std::size_t triangle, double step, std::vector<CoverPoint>& points)
{
    const auto& [i, j, k] = mesh.triangles[triangle];
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int parts = std::clamp(static_cast<int>(std::lround(longest / step)), 1, 400);
    for (int u = 0; u <= parts; ++u)
        for (int v = 0; u + v <= parts; ++v) {
            const int w = parts - u - v;
            if (u == parts || v == parts || w == parts) continue;
            // Those of an edge come with one of its triangles.
            const auto is_mine = [&](std::size_t edge) {
                return mesh.adjacent[triangle][edge] < static_cast<std::int32_t>(triangle);
            };
            if ((w == 0 && !is_mine(0)) || (u == 0 && !is_mine(1)) || (v == 0 && !is_mine(2)))
                continue;
            points.push_back({(a * u + b * v + c * w) / parts, 0, -mesh.normals[triangle]});
        }
}

}  // namespace

std::vector<CoverPoint> cover_points(const Mesh& mesh, std::size_t wanted)
{
    std::vector<CoverPoint> points;
    Box3 box;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec3& vertex = mesh.vertices[i];
        points.push_back({vertex, 0, -mesh.vertex_normals[i]});
        box.lower = box.lower.cwiseMin(vertex);
        box.upper = box.upper.cwiseMax(vertex);
    }
    double area = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += area_of(mesh, t);
    const auto count = static_cast<double>(wanted);
    const double step = std::sqrt(2 * area / count);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) add_grid(mesh, t, step, points);

    const Vec3 size = box.upper - box.lower;
    const double inner = std::cbrt(size.prod() / (count + 8));
    for (double z = box.lower.z() + inner / 2; z < box.upper.z(); z += inner)
        for (double y = box.lower.y() + inner / 2; y < box.upper.y(); y += inner) {
            // No further than that of the last one, and the way from there.
            double limit = kFar;
            for (double x = box.lower.x() + inner / 2; x < box.upper.x(); x += inner) {
                const Vec3 at(x, y, z);
                const MeshPoint nearest = nearest_on_mesh(mesh, at, limit);
                limit = (nearest.distance + inner) * kSlack;
                if (const double depth = -signed_distance(mesh, at, nearest); depth > 0)
                    points.push_back({at, depth, Vec3::Zero()});
            }
        }
    return points;
}

std::vector<Ball> cover_mesh(MeshCells& cells,
                             std::span<const CoverPoint> points,
                             std::size_t count,
                             double& separation)
{
    return Cover(cells, points).choose(count, separation);
}

}  // namespace throng
