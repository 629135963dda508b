#include "kernels/geometry/hill_climbing.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace throng {
namespace {

// Up to here it is quicker to look at all vertices than to climb.
constexpr std::uint32_t kFew = 12;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The highest vertex so far; of those that tie, the first.
struct Top {
    double height;
    std::uint16_t vertex;

    void offer(double other, std::uint16_t at)
    {
        if (other > height || (other == height && at < vertex)) *this = {other, at};
    }
};

std::uint16_t
look_at_all(const HillClimbingShape& shape, const Vec3& direction, HillClimbingCount& count)
{
    Top top{direction.dot(shape.vertices[0]), 0};
    for (std::uint32_t i = 1; i < shape.count; ++i) {
        const double height = direction.dot(shape.vertices[i]);
        if (height > top.height) top = {height, static_cast<std::uint16_t>(i)};
    }
    count.looked += shape.count;
    return top.vertex;
}

// Marks of the vertices seen on a plateau; grows to the greatest hull met and is kept.
struct Seen {
    std::vector<std::uint32_t> marks;
    std::vector<std::uint16_t> waiting;
    std::uint32_t now = 0;

    void begin(std::size_t vertices)
    {
        if (marks.size() < vertices) marks.resize(vertices, 0);
        if (++now == 0) {
            std::fill(marks.begin(), marks.end(), 0);
            now = 1;
        }
        waiting.clear();
    }
    bool first_time(std::uint16_t vertex)
    {
        if (marks[vertex] == now) return false;
        marks[vertex] = now;
        return true;
    }
};

// Looks at all that hangs together with the top and lies no more than the slack below it.
std::uint16_t search_plateau(const HillClimbingShape& shape,
                             const Vec3& direction,
                             double slack,
                             Top top,
                             HillClimbingCount& count)
{
    thread_local Seen seen;
    seen.begin(shape.count);
    seen.first_time(top.vertex);
    seen.waiting.push_back(top.vertex);
    while (!seen.waiting.empty()) {
        const std::size_t here = seen.waiting.back();
        seen.waiting.pop_back();
        ++count.steps;
        for (std::uint32_t i = shape.begin[here]; i < shape.begin[here + 1]; ++i) {
            const std::uint16_t next = shape.links[i];
            if (!seen.first_time(next)) continue;
            const double height = direction.dot(shape.vertices[next]);
            ++count.looked;
            top.offer(height, next);
            if (height >= top.height - slack) seen.waiting.push_back(next);
        }
    }
    return top.vertex;
}

std::uint16_t
climb(const HillClimbingShape& shape, const Vec3& direction, Top top, HillClimbingCount& count)
{
    // Each step is strictly upwards, so that the walk ends.
    double runner_up = 0;
    for (bool climbed = true; climbed;) {
        climbed = false;
        runner_up = -std::numeric_limits<double>::infinity();
        const std::uint32_t end = shape.begin[top.vertex + 1u];
        std::uint32_t i = shape.begin[top.vertex];
        ++count.steps;
        count.looked += end - i;
        for (; i < end; ++i) {
            const std::uint16_t next = shape.links[i];
            const double height = direction.dot(shape.vertices[next]);
            runner_up = std::max(runner_up, height);
            if (!(height > top.height)) continue;
            top = {height, next};
            climbed = true;
        }
    }
    const double slack = shape.guide->slack * direction.cwiseAbs().sum();
    if (runner_up < top.height - slack) return top.vertex;
    return search_plateau(shape, direction, slack, top, count);
}

}  // namespace

HillClimbingShape::HillClimbingShape(const Hull& hull)
    : vertices(hull.vertices.data()), count(static_cast<std::uint32_t>(hull.vertices.size()))
{
    // Hulls put together by hand have no guide.
    if (count <= kFew || hull.guide.toward.empty()) return;
    guide = &hull.guide;
    begin = guide->begin.empty() ? hull.neighbor_begin.data() : guide->begin.data();
    links = guide->begin.empty() ? hull.neighbors.data() : guide->links.data();
}

HillClimbingShape::HillClimbingShape(const PolytopeView& shape)
    : vertices(shape.vertices.data()), count(static_cast<std::uint32_t>(shape.vertices.size()))
{
    if (count <= kFew || !shape.guide || shape.guide->toward.empty()) return;
    guide = shape.guide;
    begin = guide->begin.empty() ? shape.neighbor_begin.data() : guide->begin.data();
    links = guide->begin.empty() ? shape.neighbors.data() : guide->links.data();
}

std::uint16_t
furthest_vertex(const HillClimbingShape& shape, const Vec3& direction, HillClimbingCount& count)
{
    const std::uint16_t named =
        shape.guide ? shape.guide->toward[shape.guide->cell(direction)] : std::uint16_t{0};
    return furthest_vertex(shape, direction, named, count);
}

std::uint16_t furthest_vertex(const HillClimbingShape& shape,
                              const Vec3& direction,
                              std::uint16_t start,
                              HillClimbingCount& count)
{
    ++count.supports;
    if (!shape.guide) return look_at_all(shape, direction, count);
    THRONG_CHECK(start < shape.count, "climbing starts at a vertex");
    ++count.looked;
    return climb(shape, direction, {direction.dot(shape.vertices[start]), start}, count);
}

std::uint16_t furthest_vertex_near(const HillClimbingShape& shape,
                                   const Vec3& direction,
                                   std::uint16_t start,
                                   HillClimbingCount& count)
{
    ++count.supports;
    if (!shape.guide) return look_at_all(shape, direction, count);
    THRONG_CHECK(start < shape.count, "climbing starts at a vertex");
    const std::uint16_t named = shape.guide->toward[shape.guide->cell(direction)];
    Top top{direction.dot(shape.vertices[start]), start};
    top.offer(direction.dot(shape.vertices[named]), named);
    count.looked += 2;
    return climb(shape, direction, top, count);
}

HillClimbingSupports::Side::Side(const ConvexCore<double>& of, bool climbs)
    : core(of), shape(of.hull ? HillClimbingShape(*of.hull) : HillClimbingShape()), last(kNone)
{
    if (!climbs) shape.guide = nullptr;
}

SupportPoint<double> HillClimbingSupports::Side::furthest(const Vec3& direction,
                                                          HillClimbingCount& count)
{
    if (!shape.guide) return support(core, direction);
    const auto start = static_cast<std::uint16_t>(last);
    if (is_near) {
        last = furthest_vertex(shape, direction, start, count);
    } else if (last != kNone) {
        last = furthest_vertex_near(shape, direction, start, count);
    } else {
        last = furthest_vertex(shape, direction, count);
    }
    is_near = false;
    return {shape.vertices[last], last};
}

void HillClimbingSupports::Side::start_at(std::uint32_t feature)
{
    if (!shape.guide || feature >= shape.count) return;
    last = feature;
    is_near = true;
}

HillClimbingSupports::HillClimbingSupports(const ConvexCorePair& pair, bool climbs)
    : pair_(pair), a_(pair.a, climbs), b_(pair.b, climbs)
{ }

MinkowskiVertex HillClimbingSupports::operator()(const Vec3& direction)
{
    MinkowskiVertex difference;
    const Vec3 against = pair_.b_turn.transpose() * -direction;
    const SupportPoint<double> of_a = a_.furthest(direction, count_);
    const SupportPoint<double> of_b = b_.furthest(against, count_);
    difference.on_a = of_a.position;
    difference.on_b = pair_.b_turn * of_b.position + pair_.b_position;
    difference.point = difference.on_a - difference.on_b;
    difference.feature_a = of_a.feature;
    difference.feature_b = of_b.feature;
    return difference;
}

void HillClimbingSupports::start_at(std::uint32_t feature_a, std::uint32_t feature_b)
{
    a_.start_at(feature_a);
    b_.start_at(feature_b);
}

}  // namespace throng
