#include "narrowphase/alternatives/k_dop_tree.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace throng {
namespace {

constexpr std::size_t kAxes = 4, kEdges = 7;  // where slabs of the kind begin
constexpr std::size_t kRoundsOfNode = 8;

// A direction as the sum of three slabs' directions. A weight below 0 is that of the opposite
// direction.
struct Cone {
    std::array<std::size_t, 3> slabs;
    std::array<double, 3> weights;
};

// A direction's coordinates with their axes, the greatest in size first.
struct Sorted {
    std::array<std::size_t, 3> axes = {0, 1, 2};
    std::array<double, 3> sizes, signs;

    explicit Sorted(const Vec3& direction)
    {
        const Vec3 size = direction.cwiseAbs();
        std::sort(axes.begin(), axes.end(), [&](std::size_t i, std::size_t k) {
            return size[static_cast<int>(i)] > size[static_cast<int>(k)];
        });
        for (std::size_t i = 0; i < 3; ++i) {
            sizes[i] = size[static_cast<int>(axes[i])];
            signs[i] = direction[static_cast<int>(axes[i])] < 0 ? -1 : 1;
        }
    }
};

void put_axis(const Sorted& sorted, double weight, std::size_t place, Cone& cone)
{
    cone.slabs[place] = kAxes + sorted.axes[0];
    cone.weights[place] = weight * sorted.signs[0];
}

// The edge between two of the sorted axes.
void put_edge(const Sorted& sorted,
              std::size_t first,
              std::size_t second,
              double weight,
              std::size_t place,
              Cone& cone)
{
    if (sorted.axes[first] > sorted.axes[second]) std::swap(first, second);
    // xy, xz, yz, and each with the second negative.
    const std::size_t pair = sorted.axes[first] + sorted.axes[second] - 1;
    const bool opposed = sorted.signs[first] != sorted.signs[second];
    cone.slabs[place] = kEdges + 2 * pair + (opposed ? 1 : 0);
    cone.weights[place] = weight * sorted.signs[first];
}

// The corner with the signs of the direction, but for the least coordinate where that is flipped.
void put_corner(const Sorted& sorted, bool flipped, double weight, std::size_t place, Cone& cone)
{
    std::array<double, 3> signs = {};
    for (std::size_t i = 0; i < 3; ++i) signs[sorted.axes[i]] = sorted.signs[i];
    if (flipped) signs[sorted.axes[2]] *= -1;
    cone.slabs[place] = (signs[1] != signs[0] ? 2U : 0U) + (signs[2] != signs[0] ? 1U : 0U);
    cone.weights[place] = weight * signs[0];
}

// The three directions that a direction lies between.
Cone cone_of(const Vec3& direction, int k)
{
    const Sorted sorted(direction);
    const auto [x, y, z] = sorted.sizes;
    Cone cone = {};
    if (k == 6)
        return {{kAxes, kAxes + 1, kAxes + 2}, {direction.x(), direction.y(), direction.z()}};
    if (k == 18 && x < y + z) {
        put_edge(sorted, 0, 1, (x + y - z) / 2, 0, cone);
        put_edge(sorted, 0, 2, (x + z - y) / 2, 1, cone);
        put_edge(sorted, 1, 2, (y + z - x) / 2, 2, cone);
    } else if (k == 18) {
        put_axis(sorted, x - y - z, 0, cone);
        put_edge(sorted, 0, 1, y, 1, cone);
        put_edge(sorted, 0, 2, z, 2, cone);
    } else if (k == 14) {
        put_axis(sorted, x - y, 0, cone);
        put_corner(sorted, false, (y + z) / 2, 1, cone);
        put_corner(sorted, true, (y - z) / 2, 2, cone);
    } else {
        put_axis(sorted, x - y, 0, cone);
        put_edge(sorted, 0, 1, y - z, 1, cone);
        put_corner(sorted, false, z, 2, cone);
    }
    return cone;
}

// A shape and its tree in the frame of another.
struct PlacedTree {
    const KDopTree& tree;
    const PolytopeView& shape;
    const Mat3& turn;
    const Vec3& shift;
    Slabs slabs;
    std::array<Cone, kMaxSlabs> cones;
    std::array<double, kMaxSlabs> shifts;

    /// pair   the shape is its b
    PlacedTree(const PolytopePair& pair, const KDopTree& its_tree)
        : tree(its_tree), shape(pair.b), turn(pair.turn), shift(pair.shift),
          slabs(slabs_of(its_tree.k()))
    {
        for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
            cones[slab] = cone_of(turn.transpose() * slab_direction(slab), tree.k());
            shifts[slab] = slab_direction(slab).dot(shift);
        }
    }

    // Round what the node holds: of a face the least, of more what the slabs tell.
    KDop dop(const KDopTree::Node& node) const
    {
        if (node.left == 0) {
            KDop face = empty_k_dop(slabs);
            for (const std::uint16_t corner : shape.face(node.face))
                add(turn * shape.vertices[corner] + shift, slabs, face);
            return face;
        }
        KDop turned;
        for (std::size_t slab = slabs.begin; slab < slabs.end; ++slab) {
            turned.lower[slab] = turned.upper[slab] = shifts[slab];
            for (std::size_t i = 0; i < 3; ++i) {
                const double weight = cones[slab].weights[i];
                const double lower = weight * node.dop.lower[cones[slab].slabs[i]];
                const double upper = weight * node.dop.upper[cones[slab].slabs[i]];
                turned.lower[slab] += std::min(lower, upper);
                turned.upper[slab] += std::max(lower, upper);
            }
        }
        return turned;
    }
};

double extent_of(const KDop& dop)
{
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i)
        most = std::max(most, dop.upper[kAxes + i] - dop.lower[kAxes + i]);
    return most;
}

bool is_outside(const PolytopeView& shape, const Vec3& point, double slack)
{
    for (std::size_t i = 0; i < shape.normals.size(); ++i)
        if (shape.normals[i].dot(point) - shape.offsets[i] > slack) return true;
    return false;
}

}  // namespace

KDopTree::KDopTree(const PolytopeView& shape, int k) : k_(k)
{
    struct Face {
        KDop dop;
        Vec3 middle;
        std::uint32_t index;
    };
    struct Task {
        std::uint32_t node;
        std::size_t begin, end;
    };
    const Slabs slabs = slabs_of(k);
    std::vector<Face> faces;
    for (std::size_t i = 0; i < shape.normals.size(); ++i) {
        Face face = {empty_k_dop(slabs), Vec3::Zero(), static_cast<std::uint32_t>(i)};
        for (const std::uint16_t corner : shape.face(i))
            add(shape.vertices[corner], slabs, face.dop);
        for (std::size_t axis = 0; axis < 3; ++axis)
            face.middle[static_cast<int>(axis)] =
                face.dop.lower[kAxes + axis] + face.dop.upper[kAxes + axis];
        if (!shape.face(i).empty()) faces.push_back(face);
    }
    THRONG_CHECK(!faces.empty(), "a tree is built over the faces of a shape");

    nodes_.resize(1);
    std::vector<Task> tasks = {{0, 0, faces.size()}};
    while (!tasks.empty()) {
        const Task task = tasks.back();
        tasks.pop_back();
        KDop dop = empty_k_dop(slabs);
        Vec3 lower = faces[task.begin].middle, upper = lower;
        for (std::size_t i = task.begin; i < task.end; ++i) {
            add(faces[i].dop, slabs, dop);
            lower = lower.cwiseMin(faces[i].middle);
            upper = upper.cwiseMax(faces[i].middle);
        }
        nodes_[task.node].dop = dop;
        nodes_[task.node].face = faces[task.begin].index;
        if (task.end - task.begin == 1) continue;
        // Halves along the side on which the faces lie furthest apart.
        Eigen::Index axis = 0;
        (upper - lower).maxCoeff(&axis);
        const std::size_t half = (task.begin + task.end) / 2;
        const auto at = [&](std::size_t i) {
            return faces.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(
            at(task.begin), at(half), at(task.end),
            [axis](const Face& a, const Face& b) { return a.middle[axis] < b.middle[axis]; });
        const auto left = static_cast<std::uint32_t>(nodes_.size());
        nodes_[task.node].left = left;
        nodes_.resize(nodes_.size() + 2);
        tasks.push_back({left, task.begin, half});
        tasks.push_back({left + 1, half, task.end});
    }
}

MethodAnswer query_k_dop_trees(const PolytopePair& pair, const KDopTree& a, const KDopTree& b)
{
    THRONG_CHECK(a.k() == b.k(), "two trees are compared slab by slab");
    const Slabs slabs = slabs_of(a.k());
    const PolytopePair mirrored = pair.mirrored();
    const PlacedTree a_in_b(mirrored, a), b_in_a(pair, b);
    const double slack = pair.noise();
    thread_local std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
    open.assign(1, {0, 0});
    MethodAnswer answer;
    const auto most = static_cast<int>(kRoundsOfNode * (a.count() + b.count()));
    while (!open.empty()) {
        const auto [in_a, in_b] = open.back();
        const KDopTree::Node &of_a = a.node(in_a), &of_b = b.node(in_b);
        open.pop_back();
        if (answer.rounds++ == most) {
            answer.cut_short = true;
            return answer;
        }
        if (parting_slab(of_a.dop, b_in_a.dop(of_b), slabs, slack) != slabs.end) continue;
        if (parting_slab(of_b.dop, a_in_b.dop(of_a), slabs, slack) != slabs.end) continue;
        if (of_a.left == 0 && of_b.left == 0) return answer;
        // The larger of the two is looked at more closely.
        const bool split_a =
            of_b.left == 0 || (of_a.left != 0 && extent_of(of_a.dop) >= extent_of(of_b.dop));
        for (std::uint32_t i = 0; i < 2; ++i)
            open.emplace_back(split_a ? of_a.left + i : in_a, split_a ? in_b : of_b.left + i);
    }
    // Surfaces that are apart may still be one inside the other.
    const Vec3 center_b = pair.turn * pair.b.center + pair.shift;
    const Vec3 center_a = mirrored.turn * pair.a.center + mirrored.shift;
    if (is_outside(pair.a, center_b, slack) && is_outside(pair.b, center_a, slack))
        answer.overlap = OverlapState::apart;
    return answer;
}

}  // namespace throng
