#include "throng/convex_query.hpp"

#include "narrowphase/alternatives/convex_methods.hpp"
#include "narrowphase/alternatives/k_dop_tree.hpp"
#include "narrowphase/dispatch.hpp"
#include "pipeline/queries/query_shape.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// A reach beyond all that a scene may hold, whose square is finite still.
constexpr double kAnywhere = 1e30;

std::string trouble_with_convex(const ShapeDescription& shape)
{
    if (std::holds_alternative<PlaneShape>(shape.shape)
        || std::holds_alternative<MeshShape>(shape.shape)
        || std::holds_alternative<CompoundShape>(shape.shape)
        || std::holds_alternative<VoxelsShape>(shape.shape))
        return "wanted a sphere, capsule, cylinder, box or hull";
    return trouble_with(shape);
}

QueryVerdict verdict_of(OverlapState touch)
{
    switch (touch) {
    case OverlapState::apart:
        return QueryVerdict::apart;
    case OverlapState::touching:
        return QueryVerdict::touching;
    default:
        return QueryVerdict::undecided;
    }
}

ConvexAnswer refusal(std::string trouble)
{
    ConvexAnswer answer;
    answer.trouble = std::move(trouble);
    return answer;
}

std::string unknown_method(std::string_view method)
{
    std::vector<std::string_view> names;
    for (const ConvexMethod& one : convex_methods()) names.push_back(one.name);
    return "there is no method " + in_quotes(method) + "; there are: " + either_of(names);
}

std::string trouble_with(const Pose& pose, double max_separation)
{
    if (std::string trouble = trouble_with(pose); !trouble.empty()) return trouble;
    if (!(max_separation >= 0)) return "reach is below 0 or no number; give a distance in m";
    return {};
}

// What the points of a manifold span. Of four, in whatever order, the most that two diagonals or
// one triangle of them give.
template <class Real>
double spanned_area(const LocalManifold<Real>& found)
{
    const auto at = [&](int i) -> Vec3 {
        return found.points[static_cast<std::size_t>(i)].position.template cast<double>();
    };
    const auto crossed = [&](int a, int c, int b, int d) {
        return 0.5 * (at(c) - at(a)).cross(at(d) - at(b)).norm();
    };
    const auto triangle = [&](int a, int b, int c) { return crossed(a, b, a, c); };
    if (found.count < 3) return 0;
    if (found.count == 3) return triangle(0, 1, 2);
    return std::max({crossed(0, 1, 2, 3), crossed(0, 2, 1, 3), crossed(0, 3, 1, 2),
                     triangle(0, 1, 2), triangle(0, 1, 3), triangle(0, 2, 3), triangle(1, 2, 3)});
}

template <class Real>
ConvexAnswer contacts_of(const Shapes& shapes, ShapeRef a, ShapeRef b, const Pose& b_in_a)
{
    PairCache cache;
    LocalManifold<Real> found;
    collide<Real>({shapes,
                   a,
                   b,
                   {b_in_a.position.cast<Real>(), b_in_a.orientation.normalized().cast<Real>()},
                   Real(0)},
                  cache, found);
    ConvexAnswer answer;
    answer.verdict = found.count > 0 ? QueryVerdict::touching : QueryVerdict::apart;
    for (int i = 0; i < found.count; ++i)
        answer.separation = std::min(answer.separation,
                                     double{found.points[static_cast<std::size_t>(i)].separation});
    if (found.count > 0) answer.normal = found.normal.template cast<double>();
    answer.surface = spanned_area(found);
    return answer;
}

}  // namespace

struct ConvexQuery::Inside {
    std::string trouble;
    Shapes shapes;
    ShapeRef a, b;
    std::optional<ConvexPair> pair;
    std::vector<MethodMemory> memories;  // by method, so that none sees another's
    std::vector<KDopTree> trees;         // of a and of b, for the k asked last
};

std::vector<MethodDescription> known_methods()
{
    std::vector<MethodDescription> known;
    for (const ConvexMethod& method : convex_methods())
        known.push_back({method.name, method.about, (method.tells & tells_touch) != 0,
                         (method.tells & tells_distance) != 0, (method.tells & tells_depth) != 0,
                         (method.tells & tells_volume) != 0, method.polytopes_only});
    return known;
}

Pose seen_from(const Pose& a, const Pose& b) { return pose_seen_from_a({}, {}, a, b); }

ConvexQuery::ConvexQuery(const ShapeDescription& a, const ShapeDescription& b)
    : inside_(std::make_unique<Inside>())
{
    for (const auto& [name, shape] : {std::pair("a", &a), std::pair("b", &b)}) {
        const std::string trouble = trouble_with_convex(*shape);
        if (trouble.empty()) continue;
        inside_->trouble = std::string("shape ") + name + ": " + trouble;
        return;
    }
    const ShapeRef first = append_convex(inside_->shapes, a);
    const ShapeRef second = append_convex(inside_->shapes, b);
    inside_->a = first;
    inside_->b = second;
    inside_->pair.emplace(inside_->shapes, first, second, Pose{});
    inside_->memories.resize(convex_methods().size());
}

ConvexQuery::~ConvexQuery() = default;
ConvexQuery::ConvexQuery(ConvexQuery&&) noexcept = default;
ConvexQuery& ConvexQuery::operator=(ConvexQuery&&) noexcept = default;

const std::string& ConvexQuery::trouble() const { return inside_->trouble; }

ConvexAnswer ConvexQuery::ask(std::string_view method,
                              const Pose& b_in_a,
                              MethodStart start,
                              double max_separation)
{
    if (!inside_->trouble.empty()) return refusal(inside_->trouble);
    const ConvexMethod* const found = find_convex_method(method);
    if (found == nullptr) return refusal(unknown_method(method));
    if (!found->serves(*inside_->pair))
        return refusal("method " + in_quotes(method) + " serves boxes and hulls alone");
    if (std::string trouble = trouble_with(b_in_a, max_separation); !trouble.empty())
        return refusal(std::move(trouble));

    inside_->pair->place({b_in_a.position, b_in_a.orientation.normalized()});
    const auto at = static_cast<std::size_t>(found - convex_methods().data());
    const MethodAnswer told = found->ask(*inside_->pair, std::min(max_separation, kAnywhere), start,
                                         inside_->memories[at]);
    return {verdict_of(told.overlap),
            {},
            told.separation,
            told.normal,
            told.on_a,
            told.on_b,
            told.volume,
            told.surface,
            told.center,
            told.rounds,
            told.cut_short};
}

ConvexAnswer ConvexQuery::ask_trees(const Pose& b_in_a, int k)
{
    if (!inside_->trouble.empty()) return refusal(inside_->trouble);
    const PolytopePair* const pair = inside_->pair->polytopes();
    if (pair == nullptr) return refusal("trees of k-DOPs serve boxes and hulls alone");
    if (k != 6 && k != 14 && k != 18 && k != 26) return refusal("k is 6, 14, 18 or 26");
    if (std::string trouble = trouble_with(b_in_a, 0); !trouble.empty())
        return refusal(std::move(trouble));

    std::vector<KDopTree>& trees = inside_->trees;
    if (trees.empty() || trees.front().k() != k) {
        trees.clear();
        for (const PolytopeView* shape : {&pair->a, &pair->b}) trees.emplace_back(*shape, k);
    }
    inside_->pair->place({b_in_a.position, b_in_a.orientation.normalized()});
    const MethodAnswer told = query_k_dop_trees(*inside_->pair->polytopes(), trees[0], trees[1]);
    ConvexAnswer answer;
    answer.verdict = verdict_of(told.overlap);
    answer.rounds = told.rounds;
    answer.cut_short = told.cut_short;
    return answer;
}

ConvexAnswer ConvexQuery::touch(const Pose& b_in_a, Precision precision) const
{
    if (!inside_->trouble.empty()) return refusal(inside_->trouble);
    if (std::string trouble = trouble_with(b_in_a, 0); !trouble.empty())
        return refusal(std::move(trouble));
    return precision == Precision::float_
        ? contacts_of<float>(inside_->shapes, inside_->a, inside_->b, b_in_a)
        : contacts_of<double>(inside_->shapes, inside_->a, inside_->b, b_in_a);
}

}  // namespace throng
