// Subdivide: a step in pieces, each done again as two halves while it ends in overlap, for those
// concerned (step_event_driven.cpp).
//
// A piece is flown, those that touched as it began are held, and then it is looked at: two that
// overlap by more than the tolerance, or that have met on the way and come out on the other side,
// send the group back to where the piece began. So the search for a touch is that of halving, and
// every touch is late, by the shortest piece at most. What touches then bounces, or is held from
// there on at half the tolerance from one another, as it is in back_up.cpp.
#include "kernels/math/rotation.hpp"
#include "pipeline/event_driven/event_driven_group.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

// Of a substep. A fall of a meter then ends within 2e-5 m of the touch, in four substeps of 1/60 s.
constexpr int kHalvings = 12;
// Who is deeper than the tolerance already, for whatever reason, comes no deeper but for this
// share.
constexpr double kRounding = 1e-9;
// Shortest pieces of a substep that two may end too deep. They are jammed: after these no more
// halving is done for them alone, and what is left of the substep takes its contacts as they are.
constexpr int kMostDeep = 64;
// Of a substep: further from a touch than this nobody is taken there. And how often it is asked how
// far: each answer is as good as the square of the one before.
constexpr double kLate = 1.0 / 256;
constexpr int kCloser = 2;

}  // namespace

// m, by how much two overlap at the end of the way ahead; not above 0 where they do not.
double EventDrivenGroup::depth_of(PairKey key, double end)
{
    const std::uint32_t a = scene_.colliders.body[first_of(key)];
    const std::uint32_t b = scene_.colliders.body[second_of(key)];
    return -separation_of(key, end_of(a, end), end_of(b, end), 0);
}

// Whether two go so far past one another that they might meet and part again unseen.
bool EventDrivenGroup::may_pass(PairKey key, double begin, double span) const
{
    const Colliders& colliders = scene_.colliders;
    const std::uint32_t first = first_of(key), second = second_of(key);
    Vec3 passed = Vec3::Zero();
    double turned = 0;
    for (const auto& [at, sign] : {std::pair{first, -1.0}, std::pair{second, 1.0}}) {
        const std::uint32_t body = colliders.body[at];
        const Pose from = pose_at(body, begin), to = end_of(body, begin + span);
        const std::int32_t member = member_of(body);
        const Vec3 spin = member >= 0 ? ends_[static_cast<std::size_t>(member)].spin
                                      : scene_.velocities.angular[body];
        passed += sign * (to.position - from.position);
        // Of a plane only its own place counts: it has no far end.
        if (colliders.shape[at].kind != ShapeKind::plane)
            turned += spin.norm() * span * colliders.outer_radius[at];
    }
    double size = impact_size(scene_.shapes, colliders.shape[first], colliders.shape[second]);
    for (const std::uint32_t at : {first, second}) size = std::min(size, least_piece(at));
    return passed.norm() + turned > size;
}

// m, the radius of the smallest sphere that stands for a solid, or what of its triangles is too
// small to be told; infinity for all else.
double EventDrivenGroup::least_piece(std::uint32_t collider) const
{
    double least = std::numeric_limits<double>::infinity();
    const ShapeRef shape = scene_.colliders.shape[collider];
    if (shape.kind != ShapeKind::solid) return least;
    const Solid& solid = scene_.shapes.solids[shape.index];
    if (solid.spheres.levels.empty()) return solid.error;
    for (const auto& node : solid.spheres.levels.back().nodes)
        least = std::min(least, double{node.radius});
    return least;
}

bool EventDrivenGroup::is_mesh(PairKey key) const
{
    const auto& shape = scene_.colliders.shape;
    return shape[first_of(key)].kind == ShapeKind::mesh
        || shape[second_of(key)].kind == ShapeKind::mesh;
}

// Whether the piece just flown may stay as it is, and what it is told to have come to.
bool EventDrivenGroup::ends_well(double begin, double span, bool shortest)
{
    std::vector<PairKey> fast;
    double deepest = 0;
    bool deep = false;
    for (const PairKey key : pairs_) {
        const double depth = depth_of(key, begin + span);
        deepest = std::max(deepest, depth);
        double most = tolerance_of(key);
        const auto now = separation_now_.find(key);
        const bool touched = now != separation_now_.end();
        if (touched) most = std::max(most, kRounding * most - now->second);
        if (!(depth <= most)) {
            const auto before = too_deep_.find(key);
            if (!shortest && (before == too_deep_.end() || before->second < kMostDeep))
                return false;
            ++too_deep_[key];
            deep = true;
        } else if (may_pass(key, begin, span)) {
            // One place of a mesh that touches does not tell of its others.
            if (touched && is_mesh(key) && !shortest) return false;
            fast.push_back(key);
        }
    }
    if (!fast.empty() && look_ahead(fast, begin, span).impact.state == ToiState::hit) {
        if (!shortest) return false;
        deep = true;
    }
    outcome_.deepest = std::max(outcome_.deepest, deepest);
    outcome_.deep_pieces += deep ? 1 : 0;
    return true;
}

// False where it has to be done again, in halves; nothing has moved then.
bool EventDrivenGroup::advance_piece(double begin, double span, bool shortest)
{
    if (!fly(begin, span)) {
        outcome_.held = true;
        return true;
    }
    solve_resting(span);
    find_pairs(begin, span);
    if (!ends_well(begin, span, shortest)) return false;
    commit();
    const auto touched = separation_now_;
    list_contacts(begin + span);
    if (go_to_touch(touched, begin + span)) list_contacts(begin + span);
    settle_impacts();
    return true;
}

// Takes those of a pair that are carried along their ways for a time, back where it is below 0.
void EventDrivenGroup::go_along(PairKey key, double time)
{
    for (const std::uint32_t at : {first_of(key), second_of(key)}) {
        const std::uint32_t body = scene_.colliders.body[at];
        if (member_of(body) < 0) continue;
        Vec3& velocity = scene_.velocities.linear[body];
        scene_.poses.position[body] += velocity * time;
        scene_.poses.orientation[body] =
            turned(scene_.poses.orientation[body], scene_.velocities.angular[body], time);
        velocity += scene_.context.gravity * time;
    }
}

// s, until two that close touch; below 0 where they did. Not a number where they do not close.
double EventDrivenGroup::time_to_touch(PairKey key, double time)
{
    const std::uint32_t a = scene_.colliders.body[first_of(key)];
    const std::uint32_t b = scene_.colliders.body[second_of(key)];
    const double separation =
        separation_of(key, pose_at(a, time), pose_at(b, time), 2 * tolerance_of(key));
    if (manifolds_.manifolds.size() != 1) return std::numeric_limits<double>::quiet_NaN();
    const LocalManifold<double>& found = manifolds_.manifolds.front();
    const Vec3 normal = manifolds_.at_first.orientation * found.normal;
    const auto speed = [&](std::uint32_t body, const Vec3& at) {
        const Vec3 arm = at - scene_.poses.position[body];
        return normal.dot(scene_.velocities.linear[body]
                          + scene_.velocities.angular[body].cross(arm));
    };
    double closing = 0;
    for (int k = 0; k < found.count; ++k) {
        const Vec3 at = manifolds_.at_first * found.points[static_cast<std::size_t>(k)].position;
        closing = std::max(closing,
                           speed(scene_.colliders.body[manifolds_.first], at)
                               - speed(scene_.colliders.body[manifolds_.second], at));
    }
    return closing > 0 ? separation / closing : std::numeric_limits<double>::quiet_NaN();
}

// Whether a body may be taken along its way: nothing but gravity bends it, and it touches nobody
// but whom it has met. Who stands still need not be.
bool EventDrivenGroup::may_go(std::uint32_t collider, std::map<std::uint32_t, int>& touches) const
{
    const std::uint32_t body = scene_.colliders.body[collider];
    if (member_of(body) < 0) return scene_.states.kind[body] == BodyKind::static_;
    const Forces& forces = scene_.forces;
    const bool pulled = body < forces.force.size() && !forces.force[body].isZero(0);
    return touches[body] == 1 && scene_.masses.inverse_mass[body] > 0 && !pulled
        && !forces.depends_on_state(body);
}

// Two that have met in the piece just flown, and touch nobody else, are taken to where they touch:
// what is left of the search for it would turn their normal. None goes for longer than a few
// shortest pieces. False where nothing moved.
bool EventDrivenGroup::go_to_touch(const std::map<PairKey, double>& touched, double time)
{
    std::map<std::uint32_t, int> touches;  // of each body
    for (const auto& [key, separation] : separation_now_)
        for (const std::uint32_t at : {first_of(key), second_of(key)})
            ++touches[scene_.colliders.body[at]];
    const double most = scene_.context.substep() * kLate;
    bool any = false;
    for (const auto& [key, separation] : separation_now_) {
        if (touched.count(key) > 0) continue;
        const bool alone = may_go(first_of(key), touches) && may_go(second_of(key), touches);
        double gone = 0;
        for (int turn = 0; alone && turn < kCloser; ++turn) {
            const double way = time_to_touch(key, time);
            if (!(std::abs(gone + way) < most)) break;
            go_along(key, way);
            gone += way;
        }
        any = any || gone != 0;
    }
    return any;
}

void EventDrivenGroup::subdivide()
{
    const double substep = scene_.context.substep();
    const std::uint64_t whole = std::uint64_t{1}
        << (scene_.parameters.halvings > 0 ? scene_.parameters.halvings : kHalvings);
    outcome_.held = !fly(0, substep);
    find_pairs(0, substep);
    list_contacts(0);
    settle_impacts();
    for (int k = 0; k < scene_.context.substeps && !outcome_.held; ++k) {
        too_deep_.clear();
        // After a piece comes the greatest that begins where it ends, as two halves follow one
        // another: of as many shortest pieces as the last bit that is set.
        std::uint64_t done = 0, size = whole;
        while (done < whole && !outcome_.held) {
            const auto share = [&](std::uint64_t pieces) {
                return static_cast<double>(pieces) / static_cast<double>(whole);
            };
            if (!advance_piece((k + share(done)) * substep, share(size) * substep,
                               size == 1 || !may_go_on())) {
                size /= 2;
                continue;
            }
            done += size;
            size = done & ~(done - 1);
        }
    }
}

std::vector<PassRow> EventDrivenGroup::passes_of_subdivide()
{
    using Group = EventDrivenGroup;
    return {
        {function_name<&Group::fly>(), kEventDriven, "each piece, at first a substep"},
        {function_name<&Group::solve_resting>(), kEventDriven, "each piece, of those that touch"},
        {function_name<&Group::ends_well>(), kEventDriven,
         "each piece, done again as two halves if not"},
        {function_name<&Group::list_contacts>(), kEventDriven, "where a piece ends"},
        {function_name<&Group::resolve_impacts>(),
         {Effect::restitution},
         "where it ends, until none bounces"},
    };
}

}  // namespace throng
