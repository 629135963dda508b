// Update bounds: poses into boxes. A body that stays within its margin keeps its box, and the broad
// phase is not asked about it.
#include "broadphase/margins.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kGrain = 512;  // colliders a block: some 50 microseconds of work

// Contacts are looked for this far from a resting surface, as a share of the shape's smallest half
// extent: far enough that a body at rest never loses its contacts to a breath.
constexpr double kRestingReach = 0.04;

// A plane has no size to take a share of: it looks only as far as it moves.
double resting_reach(const Colliders& colliders, std::size_t collider)
{
    const bool plane = colliders.shape[collider].kind == ShapeKind::plane;
    return plane ? 0 : kRestingReach * colliders.inner_extent[collider];
}

Box3 grown(const Box3& box, double by) { return {box.lower.array() - by, box.upper.array() + by}; }

struct Mover {
    Vec3 velocity;  // m/s, of the collider's middle
    double sweep;   // m/s, of its fastest point besides
    double widest;  // m, turning takes no point further than this
};

Mover mover_of(const Colliders& colliders,
               const Velocities& velocities,
               const Pose& placed,
               const Poses& poses,
               std::size_t collider)
{
    const std::uint32_t body = colliders.body[collider];
    const Vec3& spin = velocities.angular[body];
    const Vec3 arm = placed.position - poses.position[body];
    // A plane has no furthest point; one that stands has no fast one either.
    const double sweep = spin.isZero(0) ? 0 : spin.norm() * colliders.outer_radius[collider];
    return {velocities.linear[body] + spin.cross(arm), sweep, 2 * colliders.outer_radius[collider]};
}

}  // namespace

void update_bounds(const Conditions& conditions,
                   const Shapes& shapes,
                   const Colliders& colliders,
                   const Poses& poses,
                   const Velocities& velocities,
                   const BodyStates& states,
                   Bounds& bounds)
{
    const double dt = conditions.settings.dt;
    const std::size_t count = colliders.size();
    bounds.boxes.resize(count);
    bounds.reach.resize(count, 0.0);
    bounds.moving.resize(count, 0);
    bounds.placed.resize(count);
    std::vector<std::uint8_t> touched(count, 0);
    for (const std::uint32_t collider : bounds.touched) touched[collider] = 1;
    bounds.still_changed = !bounds.touched.empty();
    bounds.touched.clear();

    const auto update = [&](std::size_t collider, std::vector<std::uint32_t>& asked) {
        const std::uint32_t body = colliders.body[collider];
        if (body == kNobody) {
            if (touched[collider] == 0) return;
            bounds.boxes[collider] = {};
            asked.push_back(static_cast<std::uint32_t>(collider));
            return;
        }
        if (touched[collider] == 0 && !states.moves(body)) return;
        const Pose placed = poses.at(body) * colliders.local[collider];
        bounds.placed[collider] = placed;
        const bool moving = states.kind[body] != BodyKind::still;
        bounds.moving[collider] = moving ? 1 : 0;
        const Box3 tight = shape_bounds(shapes, colliders.shape[collider], placed);
        if (!moving) {
            bounds.reach[collider] = 0;
            bounds.boxes[collider] = tight;
            asked.push_back(static_cast<std::uint32_t>(collider));
            return;
        }
        const Mover mover = mover_of(colliders, velocities, placed, poses, collider);
        // Small bodies fall further in a step than a share of their size.
        const double falls = states.dynamic(body) ? conditions.gravity.norm() * dt * dt : 0;
        const double rest = std::max(resting_reach(colliders, collider), falls);
        const double reach =
            rest + mover.velocity.norm() * dt + std::min(mover.sweep * dt, mover.widest);
        bounds.reach[collider] = reach;
        if (colliders.shape[collider].kind == ShapeKind::plane) {
            // Its box holds everything and says nothing of where it is now.
            if (touched[collider] == 0 && reach == 0) return;
            bounds.boxes[collider] = tight;
            asked.push_back(static_cast<std::uint32_t>(collider));
            return;
        }
        if (touched[collider] == 0 && bounds.boxes[collider].contains(grown(tight, reach))) return;
        bounds.boxes[collider] =
            fattened(grown(tight, reach), mover.velocity, colliders.inner_extent[collider], dt);
        asked.push_back(static_cast<std::uint32_t>(collider));
    };

    bounds.of_block.resize(block_count(count, kGrain));
    for_each_block(count, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        bounds.of_block[block].clear();
        for (std::size_t i = begin; i < end; ++i) update(i, bounds.of_block[block]);
    });
    bounds.asked.clear();
    for (const auto& found : bounds.of_block)
        bounds.asked.insert(bounds.asked.end(), found.begin(), found.end());
}

}  // namespace throng
