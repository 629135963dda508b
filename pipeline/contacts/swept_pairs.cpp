#include "pipeline/contacts/swept_pairs.hpp"

#include "kernels/parallel/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace throng {
namespace {

constexpr std::size_t kMovers = 4096;    // a block
constexpr std::size_t kKeys = 1 << 13;   // a block
constexpr std::size_t kWays = 512;       // a block
constexpr std::size_t kBoxes = 1 << 14;  // a block

}  // namespace

void SweptPairs::find(const std::vector<std::uint32_t>& woke)
{
    find_fast(woke);
    if (found_.empty()) return;
    flags_.resize(states_.kind.size(), 0);
    for (const std::uint32_t body : found_) flags_[body] = 1;
    find_pairs();
    for (const std::uint32_t body : found_) flags_[body] = 0;
    find_ways();
}

// Before the step, from where a collider of it was.
Pose SweptPairs::began(std::uint32_t body) const
{
    const std::uint32_t at = colliders_.begin[body];
    const Pose& local = colliders_.local[at];
    const Pose& placed = bounds_.placed[at];
    if (local.position.isZero(0) && local.orientation.vec().isZero(0)) return placed;
    return placed * local.inverse();
}

Box3 SweptPairs::box_of_way(std::uint32_t at) const
{
    const Box3 before = shape_bounds(shapes_, colliders_.shape[at], bounds_.placed[at]);
    const std::uint32_t body = colliders_.body[at];
    if (states_.kind[body] == BodyKind::static_) return before;
    const Pose ends = poses_.at(body) * colliders_.local[at];
    Box3 box = joined(before, shape_bounds(shapes_, colliders_.shape[at], ends));
    // Between the two it may reach further, by as much as its turning takes any point of it.
    const double angle = velocities_.angular[body].norm() * context_.dt;
    const double turning = angle > 0 ? beyond_ends(angle) * colliders_.outer_radius[at] : 0;
    const double slack = turning + parameters_.tolerance * colliders_.inner_extent[at];
    box.lower.array() -= slack;
    box.upper.array() += slack;
    return box;
}

// Whether a body has come far enough to have passed through something. What moves by itself is
// measured against those that it may run over: see worth_asking().
bool SweptPairs::went_far(std::uint32_t body) const
{
    if (colliders_.count[body] == 0 || states_.kind[body] == BodyKind::removed) return false;
    if (is_surely_slow(colliders_, bounds_, velocities_, body, context_.dt)) return false;
    const Pose before = began(body);
    const double length = (poses_.position[body] - before.position).norm();
    const double angle = velocities_.angular[body].norm() * context_.dt;
    // What it turned by, where it has been stopped since.
    const Vec3 half_turn = (before.orientation.conjugate() * poses_.orientation[body]).vec();
    const double square = std::max(angle * angle, 4 * half_turn.squaredNorm());
    if (!(length > 0 || square > 0) || !std::isfinite(length)) return false;
    return may_have_passed(colliders_, body, length, angle, square);
}

// Ascending: those that were known to be fast before, and those that a blow made so. Who was no
// candidate and touched nothing is not asked, where no forces drove him.
void SweptPairs::find_fast(const std::vector<std::uint32_t>& woke)
{
    found_ = bounds_.fast;
    const auto ask = [&](const std::vector<std::uint32_t>& bodies) {
        BlockLists<std::uint32_t> lists;
        lists.start(block_count(bodies.size(), kMovers));
        for_each_block(bodies.size(), kMovers, [&](auto begin, auto end, auto block) {
            for (std::size_t i = begin; i < end; ++i)
                if (went_far(bodies[i])) lists[block].push_back(bodies[i]);
        });
        lists.append_to(found_);
    };
    if (context_.effects.meets(kForces)) {
        ask(states_.active_bodies.dynamic);
    } else {
        ask(bounds_.fast_candidates);
        ask(islands_.bodies);
    }
    ask(states_.active_bodies.kinematic);
    ask(woke);
    keep_each_once(found_);
}

// Two of which one at least is dynamic and one fast. A thing that moves by itself has to go
// further than the half extent of what it runs over.
bool SweptPairs::worth_asking(PairKey key) const
{
    std::uint32_t a = colliders_.body[first_of(key)], b = colliders_.body[second_of(key)];
    if (a == kNoBody || b == kNoBody || a == b) return false;
    if (!is_fast(a) && !is_fast(b)) return false;
    if (!states_.dynamic(a) && !states_.dynamic(b)) return false;
    for (const auto& [fast, slow, at] :
         {std::tuple(a, b, second_of(key)), std::tuple(b, a, first_of(key))})
        if (is_fast(fast) && states_.kind[fast] == BodyKind::kinematic && !is_fast(slow)) {
            const double way = (poses_.position[fast] - began(fast).position).norm()
                + velocities_.angular[fast].norm() * context_.dt * states_.radius[fast];
            return way > colliders_.inner_extent[at];
        }
    return true;
}

bool SweptPairs::on_mesh(PairKey key) const
{
    return colliders_.shape[first_of(key)].kind == ShapeKind::mesh
        || colliders_.shape[second_of(key)].kind == ShapeKind::mesh;
}

bool SweptPairs::ways_cross(PairKey key) const
{
    const std::uint32_t a = first_of(key), b = second_of(key);
    if (colliders_.shape[a].kind == ShapeKind::plane
        || colliders_.shape[b].kind == ShapeKind::plane)
        return true;
    return box_of_way(a).overlaps(box_of_way(b));
}

void SweptPairs::find_pairs()
{
    BlockLists<SweptPair> lists;
    lists.start(block_count(pairs_.keys.size(), kKeys));
    for_each_block(pairs_.keys.size(), kKeys, [&](auto begin, auto end, auto block) {
        for (std::size_t i = begin; i < end; ++i) {
            const PairKey key = pairs_.keys[i];
            if (!worth_asking(key) || !ways_cross(key)) continue;
            SweptPair& found = lists[block].emplace_back();
            found.key = key;
            const auto list = on_mesh(key) ? on_meshes_ : followed_;
            found.followed = std::binary_search(list.begin(), list.end(), i);
        }
    });
    lists.append_to(pairs);
    for (const std::uint32_t body : found_)
        for (std::uint32_t k = 0; k < colliders_.count[body]; ++k)
            look_beyond_box(colliders_.begin[body] + k);
    const auto less = [](const SweptPair& a, const SweptPair& b) { return a.key < b.key; };
    const auto same = [](const SweptPair& a, const SweptPair& b) { return a.key == b.key; };
    std::stable_sort(pairs.begin(), pairs.end(), less);
    pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
}

// What a blow has driven out of its box may meet what the broad phase did not think of.
void SweptPairs::look_beyond_box(std::uint32_t at)
{
    if (colliders_.shape[at].kind == ShapeKind::plane) return;
    const Box3 way = box_of_way(at);
    if (bounds_.boxes[at].contains(way)) return;
    BlockLists<SweptPair> lists;
    lists.start(block_count(colliders_.size(), kBoxes));
    for_each_block(colliders_.size(), kBoxes, [&](auto begin, auto end, auto block) {
        for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
            if (colliders_.body[i] == kNoBody || !bounds_.boxes[i].overlaps(way)) continue;
            const PairKey key = pair_key(at, i);
            if (i != at && filter_.allows(at, i) && worth_asking(key) && ways_cross(key))
                lists[block].push_back({key});
        }
    });
    lists.append_to(pairs);
}

void SweptPairs::find_ways()
{
    std::vector<std::uint32_t> bodies;
    for (const SweptPair& pair : pairs)
        for (const std::uint32_t at : {first_of(pair.key), second_of(pair.key)})
            bodies.push_back(colliders_.body[at]);
    keep_each_once(bodies);
    ways.resize(bodies.size());
    for_each_block(bodies.size(), kWays, [&](auto begin, auto end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) ways[i] = way_from_start(bodies[i]);
    });
}

SweptWay SweptPairs::way_from_start(std::uint32_t body) const
{
    SweptWay way;
    way.body = body;
    way.fast = std::binary_search(found_.begin(), found_.end(), body) && states_.dynamic(body);
    way.ahead = std::binary_search(bounds_.fast.begin(), bounds_.fast.end(), body);
    if (states_.kind[body] == BodyKind::static_)
        way.trajectory.begin = poses_.at(body);
    else
        way.trajectory = trajectory_of(masses_, body, began(body), poses_.at(body),
                                       velocities_.angular[body] * context_.dt);
    return way;
}

}  // namespace throng
