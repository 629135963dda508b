// Update bounds: poses into boxes. A body that stays within its margin keeps its box, and the broad
// phase is not asked about it.
#include "broadphase/active_bounds.hpp"
#include "broadphase/margins.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/step/fast_bodies.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace throng {

namespace {

constexpr std::size_t kGrain = 1024;  // bodies a block: some 20 microseconds of work

// A plane has no size to take a share of: it looks only as far as it moves.
double resting_margin(const Colliders& colliders, std::size_t collider)
{
    const bool plane = colliders.shape[collider].kind == ShapeKind::plane;
    return plane ? 0 : kRestingMargin * colliders.inner_extent[collider];
}

Box3 grown(const Box3& box, double by) { return {box.lower.array() - by, box.upper.array() + by}; }

// What the box, grown, holds in float: rounded outward by two units in the last place and more.
NearBox near_box(const Box3& tight, double speculative_margin)
{
    constexpr float kOutward = 3 * 0x1p-24f;
    constexpr float kLeast = std::numeric_limits<float>::min();
    NearBox box{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto lower = static_cast<float>(tight.lower[axis] - speculative_margin);
        const auto upper = static_cast<float>(tight.upper[axis] + speculative_margin);
        box.lower[axis] = lower - (std::abs(lower) * kOutward + kLeast);
        box.upper[axis] = upper + (std::abs(upper) * kOutward + kLeast);
    }
    return box;
}

// Overlaps nothing, not even what is everywhere.
NearBox nowhere()
{
    constexpr float kNever = std::numeric_limits<float>::quiet_NaN();
    return {{kNever, kNever, kNever, kNever}, {kNever, kNever, kNever, kNever}};
}

struct ActiveBody {
    Vec3 velocity;     // m/s, of the collider's middle
    double tip_speed;  // m/s, of its fastest point besides
    double widest;     // m, turning takes no point further than this
};

ActiveBody mover_of(const Colliders& colliders,
                    const Velocities& velocities,
                    const Pose& placed,
                    const Poses& poses,
                    std::size_t collider)
{
    const std::uint32_t body = colliders.body[collider];
    const Vec3& spin = velocities.angular[body];
    const Vec3 arm = placed.position - poses.position[body];
    // A plane has no furthest point; one that stands has no fast one either.
    const double tip_speed = spin.isZero(0) ? 0 : spin.norm() * colliders.outer_radius[collider];
    return {velocities.linear[body] + spin.cross(arm), tip_speed,
            2 * colliders.outer_radius[collider]};
}

float rounded_up(double x)
{
    const auto near = static_cast<float>(x);
    return double{near} < x ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
}

// What the wide kernel needs to know of a collider's shape; a form of `other` where it cannot help.
void note_form(const Shapes& shapes, const Colliders& colliders, std::size_t at, Bounds& bounds)
{
    const ShapeRef shape = colliders.shape[at];
    const Pose& local = colliders.local[at];
    Vec3 half = Vec3::Zero();
    double round = 0;
    ActiveBoundsForm form = ActiveBoundsForm::box;
    switch (shape.kind) {
    case ShapeKind::sphere:
        round = shapes.spheres[shape.index].radius;
        break;
    case ShapeKind::capsule:
        half.z() = shapes.capsules[shape.index].half_length;
        round = shapes.capsules[shape.index].radius;
        break;
    case ShapeKind::cylinder:
        half.z() = shapes.cylinders[shape.index].half_length;
        round = shapes.cylinders[shape.index].radius;
        form = ActiveBoundsForm::cylinder;
        break;
    case ShapeKind::box:
        half = shapes.boxes[shape.index].half_extents;
        break;
    default:
        form = ActiveBoundsForm::other;
    }
    const bool centered = local.position.isZero(0) && local.orientation.vec().isZero(0);
    const double greatest = std::max(half.maxCoeff(), round);
    // Sizes that float would hold badly go the long way.
    if (!centered || !(greatest < 1e30) || !(colliders.inner_extent[at] > 1e-30))
        form = ActiveBoundsForm::other;
    bounds.form[at] = static_cast<std::uint8_t>(form);
    if (form == ActiveBoundsForm::other) return;
    for (int axis = 0; axis < 3; ++axis) bounds.half[axis][at] = rounded_up(half[axis]);
    bounds.round[at] = rounded_up(round);
}

// One call of the stage.
class Update {
public:
    Update(const StepContext& context,
           const ImpactParameters& parameters,
           const Shapes& shapes,
           const Colliders& colliders,
           const Poses& poses,
           const Velocities& velocities,
           const BodyStates& states,
           Bounds& bounds)
        : dt_(context.dt), falls_(context.gravity.norm() * dt_ * dt_), shapes_(shapes),
          colliders_(colliders), poses_(poses), velocities_(velocities), states_(states),
          bounds_(bounds), tolerance_(parameters.tolerance),
          sweeps_(context.has(Effect::fast_motion))
    { }

    void run()
    {
        grow_lists();
        const std::vector<std::uint32_t> touched = take_touched();
        const bool were_still = any_still(touched);
        bounds_.asked.clear();
        if (!bounds_.fast.empty()) std::fill(bounds_.kept.begin(), bounds_.kept.end(), 0.0);
        bounds_.fast.clear();
        bounds_.fast_candidates.clear();
        of_movers(states_.active_bodies.kinematic, 0);
        of_movers(states_.active_bodies.dynamic, falls_);
        of_others(touched);
        bounds_.still_changed = were_still || any_still(touched);
        note_placed_anew(touched);
        keep_each_once(bounds_.fast);
        keep_each_once(bounds_.fast_candidates);
        for (const std::uint32_t collider : touched) bounds_.scratch.flags[collider] = 0;
    }

private:
    void grow_lists()
    {
        const std::size_t count = colliders_.size();
        if (sweeps_ && bounds_.kept.size() != count) bounds_.kept.resize(count, 0.0);
        if (bounds_.boxes.size() == count && bounds_.scratch.flags.size() == count) return;
        bounds_.boxes.resize(count);
        bounds_.speculative_margin.resize(count, 0.0);
        bounds_.near.resize(count, nowhere());
        bounds_.moving.resize(count, 0);
        bounds_.placed.resize(count);
        for (std::vector<float>& half : bounds_.half) half.resize(count, 0.0f);
        bounds_.round.resize(count, 0.0f);
        bounds_.form.resize(count, 0);
        bounds_.flush.resize(count, 0);
        bounds_.scratch.flags.resize(count, 0);
    }

    // Ascending, none twice; their flags are up until the end.
    std::vector<std::uint32_t> take_touched()
    {
        std::vector<std::uint32_t> touched;
        touched.swap(bounds_.touched);
        keep_each_once(touched);
        for (const std::uint32_t collider : touched) bounds_.scratch.flags[collider] = 1;
        return touched;
    }

    bool any_still(const std::vector<std::uint32_t>& colliders) const
    {
        return std::any_of(colliders.begin(), colliders.end(),
                           [&](std::uint32_t at) { return bounds_.moving[at] == 0; });
    }

    // Every collider of some bodies that move: most of them side by side.
    void of_movers(const std::vector<std::uint32_t>& bodies, double falls)
    {
        const ActiveBoundsArrays arrays = arrays_of();
        const MarginRule margin = margin_of();
        const ActiveBoundsRule rule{dt_,          kRestingMargin, falls,       margin.base,
                                    margin.steps, margin.longest, margin.loose};
        const std::size_t blocks = block_count(bodies.size(), kGrain);
        bounds_.scratch.fast_candidates_of_block.start(blocks);
        bounds_.scratch.fast_of_block.start(blocks);
        in_blocks(bodies.size(), [&](std::size_t begin, std::size_t end, auto& asked) {
            std::array<std::uint32_t, kGrain> colliders, owners, found;
            std::size_t count = 0;
            const std::size_t block = begin / kGrain;
            const auto flush = [&] {
                const std::size_t left =
                    kernel_(rule, arrays, colliders.data(), owners.data(), count, found.data());
                asked.insert(asked.end(), found.data(), found.data() + left);
                for (std::size_t i = 0; i < count; ++i)
                    note_if_fast(colliders[i], owners[i], falls, block);
                count = 0;
            };
            for_each_collider(bodies, begin, end, [&](std::uint32_t at, std::uint32_t body) {
                if (goes_alone(at)) {
                    if (colliders_.body[at] != body) return;
                    update(at, asked);
                    note_if_fast(at, body, falls, block);
                    return;
                }
                colliders[count] = at;
                owners[count] = body;
                if (++count == kGrain) flush();
            });
            flush();
        });
        bounds_.scratch.fast_of_block.append_to(bounds_.fast);
        bounds_.scratch.fast_candidates_of_block.append_to(bounds_.fast_candidates);
    }

    // Those of bodies that move.
    template <class Process>
    void for_each_collider(const std::vector<std::uint32_t>& bodies,
                           std::size_t begin,
                           std::size_t end,
                           const Process& process) const
    {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = bodies[i], first = colliders_.begin[body];
            if (!states_.moves(body)) continue;
            for (std::uint32_t at = first; at < first + colliders_.count[body]; ++at)
                process(at, body);
        }
    }

    // Whether it was touched, or is no form that the wide kernel knows.
    bool goes_alone(std::uint32_t collider) const
    {
        return bounds_.scratch.flags[collider] != 0
            || bounds_.form[collider] == static_cast<std::uint8_t>(ActiveBoundsForm::other);
    }

    // What may be the collider of a fast body is looked at.
    void note_if_fast(std::uint32_t collider, std::uint32_t body, double falls, std::size_t block)
    {
        if (bounds_.speculative_margin[collider]
                > kFastCandidateMargin * colliders_.inner_extent[collider]
            || (sweeps_ && states_.marked_fast(body)))
            note_fast_candidate(collider, falls, block);
    }

    // Few ever come here.
    void note_fast_candidate(std::uint32_t collider, double falls, std::size_t block)
    {
        const std::uint32_t body = colliders_.body[collider];
        if (is_fast_candidate(colliders_, velocities_, body, dt_, falls))
            bounds_.scratch.fast_candidates_of_block[block].push_back(body);
        if (!sweeps_ || !states_.dynamic(body)) return;
        const double inner = colliders_.inner_extent[collider];
        const double turning =
            way_of_turning(colliders_, collider, velocities_.angular[body].norm() * dt_);
        const double way = velocities_.linear[body].norm() * dt_ + turning;
        const double most = states_.marked_fast(body) ? kRestingMargin : kAheadOfContacts;
        if (!(way > most * inner)) return;
        // It is stopped where it meets something, so that what it only may meet is no contact: one
        // far ahead would turn aside what flies past a corner. Its box holds all of its way. What
        // it touches already it goes on touching, as far ahead as contacts see: a rod that falls
        // over would lose the floor at every other step.
        const double speculative_margin = kHeldMargin * tolerance_ * inner,
                     rest = kRestingMargin * inner;
        bounds_.kept[collider] =
            turning > 0 ? rest : std::max(bounds_.speculative_margin[collider], rest);
        bounds_.speculative_margin[collider] = speculative_margin;
        bounds_.near[collider] =
            near_box(shape_bounds(shapes_, colliders_.shape[collider], bounds_.placed[collider]),
                     std::max(speculative_margin, bounds_.kept[collider]));
        std::vector<std::uint32_t>& fast = bounds_.scratch.fast_of_block[block];
        if (fast.empty() || fast.back() != body) fast.push_back(body);
    }

    // Those that were touched and do not move.
    void of_others(const std::vector<std::uint32_t>& touched)
    {
        in_blocks(touched.size(), [&](std::size_t begin, std::size_t end, auto& asked) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t body = colliders_.body[touched[i]];
                if (body == kNoBody || !states_.moves(body)) update(touched[i], asked);
            }
        });
    }

    void note_flush(std::uint32_t collider, std::uint32_t body)
    {
        bounds_.flush[collider] = 0;
        if (states_.dynamic(body) && colliders_.count[body] < 2) return;
        const bool plane = colliders_.shape[collider].kind == ShapeKind::plane;
        bounds_.flush[collider] = plane ? Bounds::kPlane : Bounds::kRimmed;
        // Of those that are touched many are looked at at the same time.
        std::atomic_ref<std::uint32_t> end(bounds_.flush_end);
        std::uint32_t before = end.load();
        while (before <= collider && !end.compare_exchange_weak(before, collider + 1)) { }
    }

    void note_placed_anew(const std::vector<std::uint32_t>& touched)
    {
        std::vector<std::uint32_t>& anew = bounds_.placed_anew;
        anew.clear();
        // Hulls alone are asked for: they recycle what was found of them.
        if (shapes_.hulls.empty()) return;
        for (const auto* bodies :
             {&states_.active_bodies.kinematic, &states_.active_bodies.dynamic})
            for_each_collider(*bodies, 0, bodies->size(), [&](std::uint32_t at, std::uint32_t) {
                if (bounds_.scratch.flags[at] == 0) anew.push_back(at);
            });
        anew.insert(anew.end(), touched.begin(), touched.end());
    }

    MarginRule margin_of() const
    {
        MarginRule rule;
        rule.steps *= bounds_.stretch;
        rule.longest *= bounds_.stretch;
        // Where bodies are far apart, wide boxes bring no pairs to be rid of.
        if (bounds_.stretch > 1) rule.loose = std::numeric_limits<double>::infinity();
        return rule;
    }

    // Calls body(begin, end, asked) block by block; what is asked ends up in order among the rest.
    template <class Body>
    void in_blocks(std::size_t count, const Body& body)
    {
        if (count == 0) return;
        const std::size_t blocks = block_count(count, kGrain);
        if (bounds_.scratch.of_block.size() < blocks) bounds_.scratch.of_block.resize(blocks);
        for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
            std::vector<std::uint32_t>& asked = bounds_.scratch.of_block[block];
            asked.clear();
            body(begin, end, asked);
            if (!std::is_sorted(asked.begin(), asked.end())) std::sort(asked.begin(), asked.end());
        });
        std::vector<std::uint32_t>& all = bounds_.asked;
        const auto middle = static_cast<std::ptrdiff_t>(all.size());
        for (std::size_t block = 0; block < blocks; ++block) {
            const std::vector<std::uint32_t>& found = bounds_.scratch.of_block[block];
            all.insert(all.end(), found.begin(), found.end());
        }
        // Places of removed bodies are taken again in any order.
        if (!std::is_sorted(all.begin() + middle, all.end()))
            std::sort(all.begin() + middle, all.end());
        std::inplace_merge(all.begin(), all.begin() + middle, all.end());
    }

    ActiveBoundsArrays arrays_of()
    {
        if (colliders_.size() == 0 || poses_.position.empty()) return {};
        return {poses_.position[0].data(),
                velocities_.linear[0].data(),
                velocities_.angular[0].data(),
                poses_.orientation[0].coeffs().data(),
                {bounds_.half[0].data(), bounds_.half[1].data(), bounds_.half[2].data()},
                bounds_.round.data(),
                bounds_.form.data(),
                colliders_.inner_extent.data(),
                colliders_.outer_radius.data(),
                bounds_.placed[0].position.data(),
                bounds_.boxes[0].lower.data(),
                bounds_.speculative_margin.data(),
                bounds_.near[0].lower};
    }

    // One collider, the long way.
    void update(std::uint32_t collider, std::vector<std::uint32_t>& asked)
    {
        const bool touched = bounds_.scratch.flags[collider] != 0;
        const std::uint32_t body = colliders_.body[collider];
        if (body == kNoBody) {
            bounds_.flush[collider] = 0;
            bounds_.boxes[collider] = {};
            bounds_.near[collider] = nowhere();
            asked.push_back(collider);
            return;
        }
        if (touched) {
            note_form(shapes_, colliders_, collider, bounds_);
            note_flush(collider, body);
        }
        const Pose placed = poses_.at(body) * colliders_.local[collider];
        bounds_.placed[collider] = placed;
        const bool moving = states_.kind[body] != BodyKind::static_;
        bounds_.moving[collider] = moving ? 1 : 0;
        const Box3 tight = shape_bounds(shapes_, colliders_.shape[collider], placed);
        if (!moving) {
            bounds_.speculative_margin[collider] = 0;
            bounds_.near[collider] = near_box(tight, 0);
            bounds_.boxes[collider] = tight;
            asked.push_back(collider);
            return;
        }
        const ActiveBody active = mover_of(colliders_, velocities_, placed, poses_, collider);
        // Small bodies fall further in a step than a share of their size.
        const double falls = states_.dynamic(body) ? falls_ : 0;
        const double rest = std::max(resting_margin(colliders_, collider), falls);
        const double speculative_margin =
            rest + active.velocity.norm() * dt_ + std::min(active.tip_speed * dt_, active.widest);
        bounds_.speculative_margin[collider] = speculative_margin;
        bounds_.near[collider] = near_box(tight, speculative_margin);
        if (colliders_.shape[collider].kind == ShapeKind::plane) {
            // Its box holds everything and says nothing of where it is now.
            if (!touched && speculative_margin == 0) return;
            bounds_.boxes[collider] = tight;
            asked.push_back(collider);
            return;
        }
        const Box3 wanted = grown(tight, speculative_margin);
        const double size = colliders_.inner_extent[collider];
        const MarginRule rule = margin_of();
        Box3& box = bounds_.boxes[collider];
        if (!touched && box.contains(wanted)
            && !loose(box, wanted, active.velocity, size, dt_, rule))
            return;
        box = fattened(wanted, active.velocity, size, dt_, rule);
        asked.push_back(collider);
    }

    double dt_, falls_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    const Poses& poses_;
    const Velocities& velocities_;
    const BodyStates& states_;
    Bounds& bounds_;
    double tolerance_;  // see Settings::toi_tolerance
    bool sweeps_;       // a later stage stops who is fast
    ActiveBoundsKernel kernel_ = active_bounds_kernel();
};

}  // namespace

void update_bounds(const StepContext& context,
                   const ImpactParameters& parameters,
                   const Shapes& shapes,
                   const Colliders& colliders,
                   const Poses& poses,
                   const Velocities& velocities,
                   const BodyStates& states,
                   Bounds& bounds)
{
    static_assert(sizeof(Pose) == 7 * sizeof(double) && sizeof(Box3) == 6 * sizeof(double)
                  && sizeof(NearBox) == 8 * sizeof(float));
    Update(context, parameters, shapes, colliders, poses, velocities, states, bounds).run();
}

}  // namespace throng
