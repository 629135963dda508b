// Continuous collision: who goes so far in a step that it could pass through something is held
// where it first meets it, turned as it was then. The contacts of the next step find it there.
//
// Of two fast bodies that meet both are held. One that meets what is not fast goes on with that: it
// stays where it is against a wall, and on a pivot; else it rides on a plate that moves by itself.
// Impacts are taken in the order of their times, so that one held out of the way of another is not
// met there any more.
//
// Sources: Catto, Continuous Collision (GDC 2013), for holding bodies at their time of impact after
//          the solver has run; Mirtich, Timewarp Rigid Body Simulation (2000), for the order.
#include "kernels/parallel/blocks.hpp"
#include "narrowphase/ccd/time_of_impact.hpp"
#include "pipeline/contacts/swept_pairs.hpp"
#include "pipeline/forces/held_energy.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <span>

namespace throng {
namespace {

constexpr std::size_t kPairs = 8;  // a block: some 20 microseconds of work

// Of a shape that touches another from the start contact takes care. What it does not hold back
// must not get through all the same: that is for the same shape, smaller by so much, or for balls
// within it. The greatest of them that does not touch yet is taken; contact may have pressed a thin
// one in by more than a tenth. Last a ball at the middle: of a needle that lies half through what
// it met a tenth still touches on either side.
struct Smaller {
    double scale;
    bool ball = false;
};
constexpr Smaller kSmaller[] = {{1}, {0.9}, {0.6}, {0.3}, {0.1}, {0.1, true}};

// What a sliding one may meet with no more than this share of its smallest half extent, it is not
// held by.
constexpr double kSkin = 0.1;

// The first of these: of two that are triangles, of which none but what is within one is
// asked; of what touches; and of what contacts look ahead of: they will have held it.
constexpr std::size_t kWhole = 0, kTouching = 1, kHeldAhead = 2;

class ContinuousCollision {
public:
    ContinuousCollision(const StepContext& context,
                        const ImpactParameters& parameters,
                        const Shapes& shapes,
                        const Colliders& colliders,
                        const Surfaces& surfaces,
                        const PairFilter& filter,
                        const Forces& forces,
                        const Masses& masses,
                        const Bounds& bounds,
                        const Pairs& pairs,
                        const BodyStates& states,
                        const Islands& islands,
                        std::span<const std::uint32_t> followed,
                        std::span<const std::uint32_t> on_meshes,
                        Poses& poses,
                        Velocities& velocities,
                        FastBodies& fast)
        : parameters_(parameters), shapes_(shapes), colliders_(colliders), surfaces_(surfaces),
          masses_(masses), states_(states), velocities_(velocities), fast_(fast),
          held_energy_(context, forces, masses, states, poses, velocities),
          swept_(context,
                 parameters,
                 shapes,
                 colliders,
                 filter,
                 masses,
                 bounds,
                 pairs,
                 states,
                 islands,
                 followed,
                 on_meshes,
                 poses,
                 velocities,
                 fast.scratch.flags)
    { }

    void run(const std::vector<std::uint32_t>& woke)
    {
        fast_.held.clear();
        swept_.find(woke);
        if (candidates_.empty()) return;
        for_each_block(candidates_.size(), kPairs, [&](auto begin, auto end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) ask(candidates_[i], 0);
        });
        note_sliding();
        for_each_block(candidates_.size(), kPairs, [&](auto begin, auto end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) leave_to_contact(candidates_[i], 0);
        });
        hold_all();
    }

private:
    bool has_triangles(std::uint32_t at) const
    {
        const ShapeKind kind = colliders_.shape[at].kind;
        return kind == ShapeKind::mesh || kind == ShapeKind::solid;
    }

    std::uint32_t way_at(std::uint32_t body) const
    {
        const auto less = [](const SweptWay& way, std::uint32_t wanted) {
            return way.body < wanted;
        };
        const auto found = std::lower_bound(ways_.begin(), ways_.end(), body, less);
        return static_cast<std::uint32_t>(found - ways_.begin());
    }
    SweptWay& way_of(std::uint32_t body) { return ways_[way_at(body)]; }

    MovingShape moving(std::uint32_t at)
    {
        const SweptWay& way = way_of(colliders_.body[at]);
        return {colliders_.shape[at], way.trajectory, way.attached * colliders_.local[at]};
    }

    // How many shapes within a collider there are, none of which must get through.
    std::size_t core_count(std::uint32_t at) const
    {
        const ShapeRef shape = colliders_.shape[at];
        return shape.kind == ShapeKind::solid
            ? std::max<std::size_t>(shapes_.solids[shape.index].cores.size(), 1)
            : 1;
    }

    // One of those, smaller. The middle of a solid may be outside of it.
    MovingShape smaller(std::uint32_t at, Smaller how, std::size_t part = 0)
    {
        MovingShape inner = moving(at);
        const ShapeKind kind = inner.shape.kind;
        SolidCore ball = {Vec3::Zero(), colliders_.inner_extent[at]};
        if (kind == ShapeKind::hull) ball.center = shapes_.hulls[inner.shape.index].center;
        if (kind == ShapeKind::solid && !shapes_.solids[inner.shape.index].cores.empty())
            ball = shapes_.solids[inner.shape.index].cores[part];
        if (how.ball || kind == ShapeKind::hull || kind == ShapeKind::solid
            || kind == ShapeKind::mesh) {
            inner.local.position += inner.local.orientation * ball.center;
            inner.ball = how.scale * ball.radius;
        } else {
            inner.scale = how.scale;
        }
        return inner;
    }

    ImpactRule rule_of(PairKey key) const
    {
        const double size =
            impact_size(shapes_, colliders_.shape[first_of(key)], colliders_.shape[second_of(key)]);
        return impact_rule(parameters_.method, parameters_.tolerance * size);
    }

    // When two meet next. Of those that touch already contact takes care.
    void ask(SweptPair& candidate, double since)
    {
        candidate.time = kNever;
        const std::uint32_t a = first_of(candidate.key), b = second_of(candidate.key);
        const ImpactRule rule = rule_of(candidate.key);
        const SweptWay &way_a = way_of(colliders_.body[a]), &way_b = way_of(colliders_.body[b]);
        const bool ahead = (way_a.ahead || way_b.ahead) && !candidate.followed;
        const bool triangles = has_triangles(a) && has_triangles(b);
        Impact impact;
        if (ahead && !triangles)
            impact = time_of_impact(shapes_, moving(a), moving(b), since, 1, rule);
        candidate.pressed = impact.state == ToiState::touching_at_start;
        if (!ahead || triangles || candidate.pressed) {
            const std::size_t first = !ahead ? kHeldAhead : triangles ? kWhole : kTouching;
            const bool of_a = way_a.fast || (!way_b.fast && states_.dynamic(way_a.body));
            impact = impact_of_cores(candidate, of_a, since, first);
        }
        if (impact.state != ToiState::hit) return;
        candidate.time = impact.time;
        candidate.normal = impact.normal;
    }

    // The first of what is within one of the two with the other.
    Impact impact_of_cores(SweptPair& candidate, bool of_a, double since, std::size_t first)
    {
        const std::uint32_t a = first_of(candidate.key), b = second_of(candidate.key);
        const std::uint32_t at = of_a ? a : b;
        Impact impact;
        if (!(colliders_.inner_extent[at] > 0)) return impact;
        const std::size_t cores = core_count(at);
        for (std::size_t part = 0; part < cores; ++part) {
            if (cores > 1 && !core_comes_near(at, part, of_a ? b : a)) continue;
            const Impact met = impact_of_core(candidate, of_a, part, since, first);
            if (met.state == ToiState::hit
                && (impact.state != ToiState::hit || met.time < impact.time))
                impact = met;
        }
        return impact;
    }

    // Whether the ways of a ball within a solid and of another shape cross.
    bool core_comes_near(std::uint32_t at, std::size_t part, std::uint32_t other)
    {
        const SweptWay& way = way_of(colliders_.body[at]);
        if (way.held || way_of(colliders_.body[other]).held) return true;
        if (colliders_.shape[other].kind == ShapeKind::plane) return true;
        const MovingShape ball = smaller(at, {1}, part);
        const Vec3 begins = ball.trajectory.at(0) * ball.local.position;
        const Vec3 ends = ball.trajectory.at(1) * ball.local.position;
        // An arc is no further from its chord than this, nor any place of it than across.
        const double arm = ball.local.position.norm();
        const double angle = ball.trajectory.angle();
        const double arc = std::min(arm * angle * angle / 8, 2 * arm);
        const double slack = ball.ball + arc + parameters_.tolerance * colliders_.inner_extent[at];
        const Box3 box{begins.cwiseMin(ends).array() - slack,
                       begins.cwiseMax(ends).array() + slack};
        return box.overlaps(swept_.box_of_way(other));
    }

    // When a shape within one of the two meets the other: the greatest that does not touch it yet.
    Impact impact_of_core(
        SweptPair& candidate, bool of_a, std::size_t part, double since, std::size_t first)
    {
        const std::uint32_t a = first_of(candidate.key), b = second_of(candidate.key);
        const ImpactRule rule = rule_of(candidate.key);
        Impact impact;
        for (std::size_t i = first; i < std::size(kSmaller); ++i) {
            impact = of_a
                ? time_of_impact(shapes_, smaller(a, kSmaller[i], part), moving(b), since, 1, rule)
                : time_of_impact(shapes_, moving(a), smaller(b, kSmaller[i], part), since, 1, rule);
            if (impact.state != ToiState::touching_at_start) break;
            candidate.pressed = true;
        }
        return impact;
    }

    // Who touches from the start what is not dynamic.
    void note_sliding()
    {
        for (const SweptPair& candidate : candidates_) {
            if (!candidate.pressed) continue;
            SweptWay& a = way_of(colliders_.body[first_of(candidate.key)]);
            SweptWay& b = way_of(colliders_.body[second_of(candidate.key)]);
            a.slides = a.slides || !states_.dynamic(b.body);
            b.slides = b.slides || !states_.dynamic(a.body);
        }
    }

    // What slides is a little deep in what bears it, and all but its skin clears a rim that lies
    // flush with that: not held there, but left to contact, which knows both.
    void leave_to_contact(SweptPair& candidate, double since)
    {
        if (candidate.time == kNever || candidate.pressed) return;
        const std::uint32_t a = first_of(candidate.key), b = second_of(candidate.key);
        const SweptWay &way_a = way_of(colliders_.body[a]), &way_b = way_of(colliders_.body[b]);
        const bool of_a = way_a.slides && !states_.dynamic(way_b.body);
        const bool of_b = way_b.slides && !states_.dynamic(way_a.body);
        if (!of_a && !of_b) return;
        const std::uint32_t at = of_a ? a : b, other = of_a ? b : a;
        const ShapeKind kind = colliders_.shape[at].kind;
        if (kind == ShapeKind::hull || kind == ShapeKind::solid || kind == ShapeKind::mesh) return;
        const double thick = kSkin * colliders_.inner_extent[at];
        // What comes no further than through its skin, it would be held by too late.
        const double closing =
            candidate.normal.dot(way_a.trajectory.shift - way_b.trajectory.shift);
        if (closing * (1 - candidate.time) <= thick) return;
        const double skin = thick / outer_radius(shapes_, colliders_.shape[at]);
        const ImpactRule rule = rule_of(candidate.key);
        const Impact impact =
            time_of_impact(shapes_, smaller(at, {1 - skin}), moving(other), since, 1, rule);
        if (impact.state == ToiState::separated) candidate.time = kNever;
    }

    static Pose pose_on(const SweptWay& way, double time)
    {
        return way.trajectory.at(time) * way.attached;
    }

    // From now on a body goes where another does, as it is against it now.
    void ride(SweptWay& way, std::uint32_t on, double time)
    {
        const Pose now = pose_on(way, time);
        const RigidTrajectory& trajectory = way_of(on).trajectory;
        way.attached = trajectory.at(time).inverse() * now;
        way.trajectory = trajectory;
        way.rides = on;
        way.held = true;
        way.since = time;
        riders_.push_back(way_at(way.body));
    }

    void hold(SweptWay& way, double time)
    {
        way.trajectory = {pose_on(way, time), Vec3::Zero(), Vec3::Zero()};
        way.attached = Pose{};
        way.rides = kNoBody;
        way.held = true;
        way.since = time;
    }

    // What becomes of two that meet. Whoever is changed by it is told.
    void process(const SweptPair& candidate, std::vector<std::uint32_t>& changed)
    {
        SweptWay& a = way_of(colliders_.body[first_of(candidate.key)]);
        SweptWay& b = way_of(colliders_.body[second_of(candidate.key)]);
        const double time = candidate.time;
        const bool free_a = may_change(a), free_b = may_change(b);
        if (free_a && free_b && a.fast == b.fast) {
            hold(a, time);
            hold(b, time);
            changed = {a.body, b.body};
            return;
        }
        // The fast one yields, else the one that may.
        const bool yields_a = free_a && (a.fast || !free_b);
        if (!free_a && !free_b) return;
        SweptWay &yields = yields_a ? a : b, &other = yields_a ? b : a;
        if (candidate.pressed && !states_.dynamic(other.body) && !only_turns(yields.body))
            stop_pressing(yields.body, other.body,
                          yields_a ? candidate.normal : Vec3(-candidate.normal),
                          restitution_of(candidate.key));
        if (yields.rides != kNoBody || other.trajectory.still() || only_turns(yields.body))
            hold(yields, time);
        else
            ride(yields, other.body, time);
        changed = {yields.body};
    }

    // Its middle goes no further into what it is pressed into, and cannot move: a corner that holds
    // it at its side, while it turns about that faster than steps can follow, would let it. What
    // bounces is thrown back.
    void stop_pressing(std::uint32_t body, std::uint32_t on, const Vec3& normal, double restitution)
    {
        Vec3& velocity = velocities_.linear[body];
        const double pressing = normal.dot(velocity - velocities_.linear[on]);
        if (pressing > 0) velocity -= (1 + restitution) * pressing * normal;
    }

    // A pivot stays where it is, whatever runs into the body that turns about it.
    bool only_turns(std::uint32_t body) const { return !(masses_.inverse_mass[body] > 0); }

    double restitution_of(PairKey key) const
    {
        return surfaces_
            .between(colliders_.material[first_of(key)], colliders_.material[second_of(key)])
            .restitution;
    }

    // Where what goes by itself carries who rides on it, it lifts and lowers him: his fall is from
    // where he would have been there.
    void hold_at(const SweptWay& way, const Pose& end)
    {
        const bool driven = way.rides != kNoBody && !states_.dynamic(way.rides);
        const Vec3 fell_to = driven ? pose_on(way, way.since).position : end.position;
        if (held_energy_.hold(way.body, end, fell_to)) fast_.held.push_back(way.body);
    }

    // Each is stopped on its own way once, and once more on that of what carries it.
    bool may_change(const SweptWay& way) const
    {
        return states_.dynamic(way.body) && !(way.held && way.trajectory.still());
    }

    // Those that ride on a body that was stopped are stopped with it.
    void stop_riders(double time, std::vector<std::uint32_t>& changed)
    {
        for (std::size_t i = 0; i < changed.size(); ++i)
            for (const std::uint32_t rider : riders_) {
                SweptWay& way = ways_[rider];
                if (way.rides != changed[i]) continue;
                hold(way, time);
                changed.push_back(way.body);
            }
    }

    // Which candidates each way is in.
    void index_candidates()
    {
        in_way_.begin.assign(ways_.size() + 1, 0);
        in_way_.candidates.resize(2 * candidates_.size());
        const auto for_each_end = [&](auto&& visit) {
            for (std::uint32_t i = 0; i < candidates_.size(); ++i)
                for (const std::uint32_t at :
                     {first_of(candidates_[i].key), second_of(candidates_[i].key)})
                    visit(way_at(colliders_.body[at]), i);
        };
        for_each_end([&](std::uint32_t way, std::uint32_t) { ++in_way_.begin[way + 1]; });
        std::partial_sum(in_way_.begin.begin(), in_way_.begin.end(), in_way_.begin.begin());
        std::vector<std::uint32_t> next(in_way_.begin.begin(), in_way_.begin.end() - 1);
        for_each_end(
            [&](std::uint32_t way, std::uint32_t i) { in_way_.candidates[next[way]++] = i; });
    }

    // The earliest impact, what it changes, and again. Of those at one time the first goes first.
    void hold_all()
    {
        index_candidates();
        using Due = std::pair<double, std::uint32_t>;  // when, and which candidate
        std::priority_queue<Due, std::vector<Due>, std::greater<>> due;
        const auto await = [&](std::uint32_t i) {
            if (candidates_[i].time < kNever) due.emplace(candidates_[i].time, i);
        };
        for (std::uint32_t i = 0; i < candidates_.size(); ++i) await(i);
        // Each impact changes a body, and no body more than twice.
        std::size_t left = 2 * ways_.size();
        while (left > 0 && !due.empty()) {
            const auto [time, which] = due.top();
            due.pop();
            if (candidates_[which].time != time) continue;  // it has been asked again since
            --left;
            std::vector<std::uint32_t> changed;
            process(candidates_[which], changed);
            candidates_[which].time = kNever;
            stop_riders(time, changed);
            for (const std::uint32_t body : changed) {
                const std::uint32_t way = way_at(body);
                for (std::uint32_t k = in_way_.begin[way]; k < in_way_.begin[way + 1]; ++k) {
                    const std::uint32_t other = in_way_.candidates[k];
                    if (other == which) continue;
                    ask(candidates_[other], time);
                    leave_to_contact(candidates_[other], time);
                    await(other);
                }
            }
        }
        for (const SweptWay& way : ways_)
            if (way.held) hold_at(way, pose_on(way, 1));
    }

    const ImpactParameters& parameters_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    const Surfaces& surfaces_;
    const Masses& masses_;
    const BodyStates& states_;
    Velocities& velocities_;
    FastBodies& fast_;
    HeldEnergy held_energy_;
    SweptPairs swept_;
    std::vector<SweptPair>& candidates_ = swept_.pairs;
    std::vector<SweptWay>& ways_ = swept_.ways;
    std::vector<std::uint32_t> riders_;  // ways that ride, or did
    struct {
        std::vector<std::uint32_t> begin;  // [ways + 1]
        std::vector<std::uint32_t> candidates;
    } in_way_;
};

}  // namespace

template <class Real>
void continuous_collision(const StepContext& context,
                          const ImpactParameters& parameters,
                          const Shapes& shapes,
                          const Colliders& colliders,
                          const Surfaces& surfaces,
                          const PairFilter& filter,
                          const Forces& forces,
                          const Masses& masses,
                          const Bounds& bounds,
                          const Pairs& pairs,
                          const BodyStates& states,
                          const Islands& islands,
                          const SleepEvents& sleep_events,
                          const ConvexContacts<Real>& contacts,
                          const MeshContacts<Real>& on_meshes,
                          Poses& poses,
                          Velocities& velocities,
                          FastBodies& fast)
{
    // Where nothing can touch, nothing is in the way.
    if (bounds.placed.size() != colliders.size()) return;
    ContinuousCollision(context, parameters, shapes, colliders, surfaces, filter, forces, masses,
                        bounds, pairs, states, islands, contacts.followed, on_meshes.followed,
                        poses, velocities, fast)
        .run(sleep_events.woke);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void continuous_collision<Real>(                                                      \
        const StepContext&, const ImpactParameters&, const Shapes&, const Colliders&,              \
        const Surfaces&, const PairFilter&, const Forces&, const Masses&, const Bounds&,           \
        const Pairs&, const BodyStates&, const Islands&, const SleepEvents&,                       \
        const ConvexContacts<Real>&, const MeshContacts<Real>&, Poses&, Velocities&, FastBodies&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
