#include "narrowphase/solid/sphere_candidates.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "narrowphase/convex/sphere_pairs.hpp"
#include "narrowphase/mesh/triangle_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

using Node = SphereTree::Node;
using Nodes = std::vector<Node>;

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = 0xffffffff;

// A feature tells levels apart, so that what was kept of one is not taken for another's. Where
// there are more places than a level has features for, as of spheres on a mesh of some hundred
// thousand triangles, they are mixed: seldom do two candidates of a pair share one, and what is
// lost by it is that the next step begins with the impulse of the other.
std::uint32_t feature_of(int level, std::uint64_t place)
{
    constexpr int kBits = 28;
    if (place >> kBits != 0) place = place * 0x9e3779b97f4a7c15U >> (64 - kBits);
    return static_cast<std::uint32_t>(place) | static_cast<std::uint32_t>(level % 8) << kBits;
}

template <class Scratch>
Scratch& of_this_thread()
{
    thread_local Scratch scratch;
    return scratch;
}

// ---- two trees ----

struct NodePair {
    std::uint32_t a, b;
};

// The one that a sphere is deepest in, or nearest to; of several the one that comes first.
struct Partner {
    std::uint32_t other = kNone;
    double separation = kFar;

    void offer(std::uint32_t which, double distance)
    {
        if (distance > separation || (distance == separation && which > other)) return;
        separation = distance;
        other = which;
    }
};

struct TwoTreesScratch {
    std::vector<NodePair> pairs, half, next;
    std::vector<Partner> partners_a, partners_b;
};

class TwoTrees {
public:
    TwoTrees(const SphereTree& a,
             const SphereTree& b,
             const Pose& b_in_a,
             double speculative_margin)
        : a_(a), b_(b), b_in_a_(b_in_a), turn_(b_in_a.orientation.toRotationMatrix()),
          speculative_margin_(speculative_margin)
    { }

    SphereAnswer find(const SphereBudget& budget, std::vector<ContactCandidate>& candidates)
    {
        const int last = static_cast<int>(std::max(a_.levels.size(), b_.levels.size())) - 1;
        scratch_.pairs.clear();
        for (std::uint32_t i = 0; i < a_.levels[0].nodes.size(); ++i)
            for (std::uint32_t k = 0; k < b_.levels[0].nodes.size(); ++k)
                if (meets(a_.levels[0].nodes[i], b_.levels[0].nodes[k]))
                    scratch_.pairs.push_back({i, k});
        answer_.tests = a_.levels[0].nodes.size() * b_.levels[0].nodes.size();
        while (answer_.level < std::min(last, budget.level) && error() > budget.error) {
            if (!descend(budget.tests)) break;
            ++answer_.level;
        }
        answer_.error = error();
        tell(candidates);
        return answer_;
    }

private:
    // A tree that has no deeper level stays at its last.
    static const SphereTree::Level& at_level(const SphereTree& tree, int level)
    {
        return tree.levels[std::min(static_cast<std::size_t>(level), tree.levels.size() - 1)];
    }
    static bool goes_beyond(const SphereTree& tree, int level)
    {
        return static_cast<std::size_t>(level) + 1 < tree.levels.size();
    }
    const Nodes& nodes_a() const { return at_level(a_, answer_.level).nodes; }
    const Nodes& nodes_b() const { return at_level(b_, answer_.level).nodes; }
    double error() const
    {
        return at_level(a_, answer_.level).error + at_level(b_, answer_.level).error;
    }

    Vec3 center_a(const Node& node) const { return node.center.cast<double>(); }
    Vec3 center_b(const Node& node) const
    {
        return turn_ * node.center.cast<double>() + b_in_a_.position;
    }

    // Whether anything below the two is within the margin.
    bool meets(const Node& a, const Node& b) const
    {
        const double limit = double{a.bound} + double{b.bound} + speculative_margin_;
        return (center_b(b) - center_a(a)).squaredNorm() <= limit * limit;
    }

    // One level down: a's children first, then for those that are left b's. False, and all as it
    // was, where that would take too many tests.
    bool descend(std::size_t most)
    {
        std::size_t tests = answer_.tests;
        if (!descend_a(most, tests) || !descend_b(most, tests)) return false;
        scratch_.pairs.swap(scratch_.next);
        answer_.tests = tests;
        return true;
    }

    bool descend_a(std::size_t most, std::size_t& tests)
    {
        std::vector<NodePair>& half = scratch_.half;
        half = scratch_.pairs;
        if (!goes_beyond(a_, answer_.level)) return true;
        const Nodes& below = at_level(a_, answer_.level + 1).nodes;
        half.clear();
        for (const NodePair& pair : scratch_.pairs) {
            const Node& parent = nodes_a()[pair.a];
            tests += parent.count;
            if (tests > most) return false;
            for (std::uint32_t i = parent.first; i < parent.first + parent.count; ++i)
                if (meets(below[i], nodes_b()[pair.b])) half.push_back({i, pair.b});
        }
        return true;
    }

    bool descend_b(std::size_t most, std::size_t& tests)
    {
        std::vector<NodePair>& next = scratch_.next;
        next = scratch_.half;
        if (!goes_beyond(b_, answer_.level)) return true;
        const Nodes& below_a = at_level(a_, answer_.level + 1).nodes;
        const Nodes& below_b = at_level(b_, answer_.level + 1).nodes;
        next.clear();
        for (const NodePair& pair : scratch_.half) {
            const Node& parent = nodes_b()[pair.b];
            tests += parent.count;
            if (tests > most) return false;
            for (std::uint32_t k = parent.first; k < parent.first + parent.count; ++k)
                if (meets(below_a[pair.a], below_b[k])) next.push_back({pair.a, k});
        }
        return true;
    }

    void tell(std::vector<ContactCandidate>& candidates)
    {
        scratch_.partners_a.assign(nodes_a().size(), Partner{});
        scratch_.partners_b.assign(nodes_b().size(), Partner{});
        double least = speculative_margin_;
        for (const NodePair& pair : scratch_.pairs) {
            const Node &a = nodes_a()[pair.a], &b = nodes_b()[pair.b];
            const double separation =
                (center_b(b) - center_a(a)).norm() - double{a.radius} - double{b.radius};
            least = std::min(least, separation);
            scratch_.partners_a[pair.a].offer(pair.b, separation);
            scratch_.partners_b[pair.b].offer(pair.a, separation);
        }
        answer_.apart = least - answer_.error;
        for (std::uint32_t i = 0; i < scratch_.partners_a.size(); ++i)
            if (scratch_.partners_a[i].other != kNone)
                add(i, scratch_.partners_a[i].other, candidates);
        for (std::uint32_t k = 0; k < scratch_.partners_b.size(); ++k) {
            const std::uint32_t i = scratch_.partners_b[k].other;
            if (i != kNone && scratch_.partners_a[i].other != k) add(i, k, candidates);
        }
    }

    void add(std::uint32_t i, std::uint32_t k, std::vector<ContactCandidate>& candidates) const
    {
        const Node &a = nodes_a()[i], &b = nodes_b()[k];
        const Vec3 from = center_a(a), apart = center_b(b) - from;
        const double distance = apart.norm(), radius = double{a.radius};
        const double separation = distance - radius - double{b.radius};
        if (!(separation <= speculative_margin_)) return;
        const Vec3 normal = distance > 0 ? Vec3(apart / distance) : Vec3(Vec3::UnitZ());
        candidates.push_back({from + normal * (radius + separation / 2), normal, separation,
                              feature_of(answer_.level, i * nodes_b().size() + k)});
    }

    const SphereTree &a_, &b_;
    const Pose& b_in_a_;
    const Mat3 turn_;
    const double speculative_margin_;
    SphereAnswer answer_;
    TwoTreesScratch& scratch_ = of_this_thread<TwoTreesScratch>();
};

// ---- a tree and another shape ----

// What a place is to the other shape: how far from its surface at least, and whether that is the
// distance itself with the way out known.
struct Outside {
    double distance = kFar;
    bool exact = true;
    Vec3 outward = Vec3::UnitZ();
};

// The other shape, asked in its own frame.
class Other {
public:
    Other(const Shapes& shapes, ShapeRef ref) : shapes_(shapes), ref_(ref) { }

    // How far the place is, at least; no more is asked than whether it is within `limit`.
    double at_least(const Vec3& at, double limit)
    {
        if (ref_.kind == ShapeKind::solid && !solid().field.empty())
            return sample_bricks<double>(solid().field, at).distance - field_error();
        return look(at, limit).distance;
    }

    Outside look(const Vec3& at, double limit)
    {
        switch (ref_.kind) {
        case ShapeKind::plane: {
            const Plane& plane = shapes_.planes[ref_.index];
            return {plane.normal.dot(at) - plane.offset, true, plane.normal};
        }
        case ShapeKind::mesh:
            return {nearest_on_mesh(shapes_.meshes[ref_.index], at, limit).distance, true,
                    Vec3::UnitZ()};
        case ShapeKind::solid:
            return look_at_solid(at, limit);
        default: {
            const auto [direction, distance] = outward_of_convex(shapes_, ref_, at, limit, cache_);
            return {distance, true, direction};
        }
        }
    }

    double error() const { return ref_.kind == ShapeKind::solid ? solid().error : 0; }

private:
    const Solid& solid() const { return shapes_.solids[ref_.index]; }
    // Trilinear values of what changes no faster than the place does.
    double field_error() const { return solid().field.voxel * 1.7320508075688774; }

    Outside look_at_solid(const Vec3& at, double limit)
    {
        const VoxelBricks& field = solid().field;
        if (!field.empty()) {
            const FieldSample<double> sample = sample_bricks<double>(field, at);
            const double slope = sample.gradient.norm();
            // On a crease inside the gradient fades: the triangles tell then.
            if (slope > 0.5) return {sample.distance, true, sample.gradient / slope};
        }
        const Mesh& mesh = solid().mesh;
        MeshPoint nearest = nearest_on_mesh(mesh, at, limit);
        // Beyond the margin, or deep inside.
        if (nearest.distance > limit) nearest = nearest_on_mesh(mesh, at);
        const double distance = signed_distance(mesh, at, nearest);
        const Vec3 away = at - nearest.point;
        const double length = away.norm();
        const Vec3 outward = length > 0 ? Vec3(away * ((distance < 0 ? -1 : 1) / length))
                                        : outward_at(mesh, nearest);
        return {distance, true, outward};
    }

    const Shapes& shapes_;
    const ShapeRef ref_;
    PairCache cache_;
};

struct OneTreeScratch {
    std::vector<std::uint32_t> nodes, next, triangles;
};

class OneTree {
public:
    OneTree(const SphereTree& tree,
            const Shapes& shapes,
            ShapeRef other,
            const Pose& other_in_solid,
            double speculative_margin)
        : tree_(tree), shapes_(shapes), ref_(other), other_(shapes, other), pose_(other_in_solid),
          speculative_margin_(speculative_margin)
    { }

    SphereAnswer find(const SphereBudget& budget, std::vector<ContactCandidate>& candidates)
    {
        const int last = static_cast<int>(tree_.levels.size()) - 1;
        scratch_.nodes.clear();
        for (std::uint32_t i = 0; i < nodes().size(); ++i)
            if (meets(nodes()[i])) scratch_.nodes.push_back(i);
        answer_.tests = nodes().size();
        while (answer_.level < std::min(last, budget.level) && error() > budget.error) {
            if (!descend(budget.tests)) break;
            ++answer_.level;
        }
        answer_.error = error();
        answer_.apart = speculative_margin_;
        for (const std::uint32_t i : scratch_.nodes) tell(i, candidates);
        answer_.apart -= answer_.error;
        return answer_;
    }

private:
    const Nodes& nodes() const { return tree_.levels[level()].nodes; }
    std::size_t level() const { return static_cast<std::size_t>(answer_.level); }
    double error() const { return tree_.levels[level()].error + other_.error(); }
    Vec3 place(const Node& node) const { return pose_.to_local(node.center.cast<double>()); }

    bool meets(const Node& node)
    {
        const double limit = double{node.bound} + speculative_margin_;
        return other_.at_least(place(node), limit) <= limit;
    }

    bool descend(std::size_t most)
    {
        scratch_.next.clear();
        std::size_t tests = answer_.tests;
        for (const std::uint32_t which : scratch_.nodes) {
            const Node& parent = nodes()[which];
            tests += parent.count;
            if (tests > most) return false;
            for (std::uint32_t i = parent.first; i < parent.first + parent.count; ++i)
                if (meets(tree_.levels[level() + 1].nodes[i])) scratch_.next.push_back(i);
        }
        scratch_.nodes.swap(scratch_.next);
        answer_.tests = tests;
        return true;
    }

    void tell(std::uint32_t i, std::vector<ContactCandidate>& candidates)
    {
        const Node& node = nodes()[i];
        if (ref_.kind == ShapeKind::mesh) {
            tell_triangles(i, candidates);
            return;
        }
        const auto radius = double{node.radius};
        const Outside outside = other_.look(place(node), radius + speculative_margin_);
        const double separation = outside.distance - radius;
        answer_.apart = std::min(answer_.apart, separation);
        if (!(separation <= speculative_margin_)) return;
        const Vec3 normal = -(pose_.orientation * outside.outward);
        candidates.push_back({node.center.cast<double>() + normal * (radius + separation / 2),
                              normal, separation, feature_of(answer_.level, i)});
    }

    void tell_triangles(std::uint32_t i, std::vector<ContactCandidate>& candidates)
    {
        const Mesh& mesh = shapes_.meshes[ref_.index];
        const Node& node = nodes()[i];
        const Vec3 center = place(node);
        const auto radius = double{node.radius};
        const double nearest = nearest_on_mesh(mesh, center, radius + speculative_margin_).distance;
        answer_.apart = std::min(answer_.apart, nearest - radius);
        const Vec3 grown = Vec3::Constant(radius + speculative_margin_);
        scratch_.triangles.clear();
        find_triangles(mesh, {center - grown, center + grown}, scratch_.triangles);
        LocalManifold<double> found;
        for (const std::uint32_t triangle : scratch_.triangles) {
            collide_triangle_ball(MeshTriangle(mesh, triangle), center, radius, speculative_margin_,
                                  found);
            if (found.count == 0) continue;
            candidates.push_back({pose_ * found.points[0].position,
                                  pose_.orientation * -found.normal, found.points[0].separation,
                                  feature_of(answer_.level, i * mesh.triangles.size() + triangle)});
        }
    }

    const SphereTree& tree_;
    const Shapes& shapes_;
    const ShapeRef ref_;
    Other other_;
    const Pose& pose_;
    const double speculative_margin_;
    SphereAnswer answer_;
    OneTreeScratch& scratch_ = of_this_thread<OneTreeScratch>();
};

}  // namespace

SphereAnswer find_sphere_candidates(const PairInput<double>& in,
                                    const SphereBudget& budget,
                                    std::vector<ContactCandidate>& candidates)
{
    const auto& [shapes, solid, other, other_in_solid, speculative_margin] = in;
    THRONG_CHECK(solid.kind == ShapeKind::solid, "spheres stand for a solid");
    const SphereTree& tree = shapes.solids[solid.index].spheres;
    // Without spheres nothing is known.
    if (tree.levels.empty()) return {kFar, 0, -kFar, 0};
    if (other.kind == ShapeKind::solid && !shapes.solids[other.index].spheres.levels.empty())
        return TwoTrees(tree, shapes.solids[other.index].spheres, other_in_solid,
                        speculative_margin)
            .find(budget, candidates);
    return OneTree(tree, shapes, other, other_in_solid, speculative_margin)
        .find(budget, candidates);
}

}  // namespace throng
