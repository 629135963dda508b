// Measure approaches: who nears whom fast enough to be told of, before contacts stop them.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/contacts/collide.hpp"
#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/step/stages.hpp"

#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kEntries = 1024;  // of meshes and solids, a block

template <class Real>
class Approaches {
public:
    Approaches(const Colliders& colliders,
               const Poses& poses,
               const Velocities& velocities,
               const BodyStates& states,
               double hit_speed)
        : colliders_(colliders), poses_(poses), velocities_(velocities), states_(states),
          hit_speed_(hit_speed)
    { }

    // Before any contact is looked at: whether its two may near each other so fast.
    void note_motions(std::vector<TouchingPairs::Motion>& motions)
    {
        motions.resize(states_.kind.size());
        for_active([&](std::uint32_t body) {
            const Vec3& linear = velocities_.linear[body];
            const double spin = velocities_.angular[body].norm();
            motions[body] = {static_cast<float>(linear.x()), static_cast<float>(linear.y()),
                             static_cast<float>(linear.z()),
                             static_cast<float>(spin * states_.radius[body])};
        });
    }
    // Who is not active has none.
    void forget_motions(std::vector<TouchingPairs::Motion>& motions)
    {
        for_active([&](std::uint32_t body) { motions[body] = {}; });
    }
    bool may_hit(PairKey key, const std::vector<TouchingPairs::Motion>& motions) const
    {
        const auto& a = motions[colliders_.body[first_of(key)]];
        const auto& b = motions[colliders_.body[second_of(key)]];
        const float x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
        const float left = static_cast<float>(hit_speed_) / kMore - a.turning - b.turning;
        return left <= 0 || x * x + y * y + z * z >= left * left;
    }

    // Adds a contact's fastest point, where that is fast enough; of a pair's contacts the fastest.
    void
    measure(PairKey key, const Contact<Real>& contact, std::vector<TouchingPairs::Approach>& found)
    {
        const std::uint32_t a = colliders_.body[first_of(key)];
        const std::uint32_t b = colliders_.body[second_of(key)];
        // A conveyor's velocity is its surface's.
        const Vec3 still = Vec3::Zero();
        const bool stands_a = states_.kind[a] == BodyKind::static_,
                   stands_b = states_.kind[b] == BodyKind::static_;
        const Vec3 linear =
            (stands_b ? still : velocities_.linear[b]) - (stands_a ? still : velocities_.linear[a]);
        const Vec3 &spin_a = stands_a ? still : velocities_.angular[a],
                   &spin_b = stands_b ? still : velocities_.angular[b];
        const Vec3 normal = contact.normal.template cast<double>();
        TouchingPairs::Approach fastest{key, {}, normal, 0};
        int point = 0;
        for (int k = 0; k < contact.count; ++k) {
            const Vec3 anchor_a =
                contact.points[static_cast<std::size_t>(k)].anchor_a.template cast<double>();
            const Vec3 anchor_b = contact.anchor_b(k).template cast<double>();
            const Vec3 relative = linear + spin_b.cross(anchor_b) - spin_a.cross(anchor_a);
            if (const double speed = -relative.dot(normal); speed > fastest.speed) {
                fastest.speed = speed;
                point = k;
            }
        }
        if (!(fastest.speed >= hit_speed_)) return;
        fastest.point = anchor_origin(a, b, states_, poses_)
            + contact.points[static_cast<std::size_t>(point)].anchor_a.template cast<double>();
        if (found.empty() || found.back().key != key)
            found.push_back(fastest);
        else if (fastest.speed > found.back().speed)
            found.back() = fastest;
    }

private:
    // Anchors may lie a little outside of what they are on, and numbers are rounded.
    static constexpr float kMore = 1.01f;

    template <class Each>
    void for_active(const Each& each) const
    {
        for (const std::uint32_t body : states_.active_bodies.dynamic) each(body);
        for (const std::uint32_t body : states_.active_bodies.kinematic) each(body);
    }

    const Colliders& colliders_;
    const Poses& poses_;
    const Velocities& velocities_;
    const BodyStates& states_;
    double hit_speed_;
};

}  // namespace

template <class Real>
void measure_approaches(const Pairs& pairs,
                        const Colliders& colliders,
                        const Poses& poses,
                        const Velocities& velocities,
                        const BodyStates& states,
                        const ConvexContacts<Real>& convex,
                        const MeshContacts<Real>& meshes,
                        const SolidContacts<Real>& solids,
                        TouchingPairs& touching)
{
    touching.approaches.clear();
    if (std::isinf(touching.hit_speed)) return;
    Approaches<Real> approaches(colliders, poses, velocities, states, touching.hit_speed);
    std::vector<TouchingPairs::Motion>& motions = touching.scratch.motions;
    approaches.note_motions(motions);
    auto& of_block = touching.scratch.approaches_of_block;
    const auto measure_all = [&](std::size_t count, std::size_t grain, const auto& measure) {
        of_block.start(block_count(count, grain));
        for_each_block(count, grain, [&](auto begin, auto end, auto block) {
            measure(begin, end, of_block[block]);
        });
        of_block.append_to(touching.approaches);
    };
    const auto measure_one = [&](std::uint32_t pair, const Contact<Real>& contact, auto& found) {
        const PairKey key = pairs.keys[pair];
        if (approaches.may_hit(key, motions)) approaches.measure(key, contact, found);
    };
    measure_all(convex.of_pair.size(), kPairsAtOnce, [&](auto begin, auto end, auto& found) {
        for_each_contact_of_block(convex, begin, end, [&](std::uint32_t pair, std::uint32_t at) {
            measure_one(pair, convex.contacts[at], found);
        });
    });
    const std::size_t of_convex = touching.approaches.size();
    for (const ManyContacts<Real>* many : {static_cast<const ManyContacts<Real>*>(&meshes),
                                           static_cast<const ManyContacts<Real>*>(&solids)})
        measure_all(many->entries.size(), kEntries, [&](auto begin, auto end, auto& found) {
            for (std::size_t i = begin; i < end; ++i)
                measure_one(many->entries[i].pair, many->entries[i].contact, found);
        });
    approaches.forget_motions(motions);
    if (touching.approaches.size() == of_convex) return;
    // A pair's contacts may lie in two blocks.
    const auto before = [](const auto& a, const auto& b) {
        return a.key != b.key ? a.key < b.key : a.speed > b.speed;
    };
    const auto same = [](const auto& a, const auto& b) { return a.key == b.key; };
    std::stable_sort(touching.approaches.begin(), touching.approaches.end(), before);
    touching.approaches.erase(
        std::unique(touching.approaches.begin(), touching.approaches.end(), same),
        touching.approaches.end());
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void measure_approaches<Real>(const Pairs&, const Colliders&, const Poses&,           \
                                           const Velocities&, const BodyStates&,                   \
                                           const ConvexContacts<Real>&, const MeshContacts<Real>&, \
                                           const SolidContacts<Real>&, TouchingPairs&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
