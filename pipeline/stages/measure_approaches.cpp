// Measure approaches: who nears whom fast enough to be told of, before contacts stop them.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/contacts/collide.hpp"
#include "pipeline/step/stages.hpp"

#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kPairs = 2048;    // a block
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

    // Before any contact is looked at: how fast its two may near each other at most.
    void bound_speeds(std::vector<float>& greatest)
    {
        greatest.resize(states_.kind.size(), 0);
        const auto bound = [&](std::uint32_t body) {
            const double arm = states_.radius[body];
            greatest[body] = static_cast<float>(
                kMore * (velocities_.linear[body].norm() + arm * velocities_.angular[body].norm()));
        };
        for (const std::uint32_t body : states_.active_bodies.dynamic) bound(body);
        for (const std::uint32_t body : states_.active_bodies.kinematic) bound(body);
    }
    bool may_hit(PairKey key, const std::vector<float>& greatest) const
    {
        return double{greatest[colliders_.body[first_of(key)]]}
            + double{greatest[colliders_.body[second_of(key)]]}
        >= hit_speed_;
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
    static constexpr double kMore = 1.01;
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
    std::vector<float>& greatest = touching.scratch.greatest_speed;
    approaches.bound_speeds(greatest);
    auto& of_block = touching.scratch.approaches_of_block;
    const auto measure_all = [&](std::size_t count, std::size_t grain, const auto& measure) {
        of_block.start(block_count(count, grain));
        for_each_block(count, grain, [&](auto begin, auto end, auto block) {
            for (std::size_t i = begin; i < end; ++i) measure(i, of_block[block]);
        });
        of_block.append_to(touching.approaches);
    };
    measure_all(convex.of_pair.size(), kPairs, [&](std::size_t i, auto& found) {
        if (const Contact<Real>* contact = convex.at(i))
            if (approaches.may_hit(pairs.keys[i], greatest))
                approaches.measure(pairs.keys[i], *contact, found);
    });
    const std::size_t of_convex = touching.approaches.size();
    for (const ManyContacts<Real>* many : {static_cast<const ManyContacts<Real>*>(&meshes),
                                           static_cast<const ManyContacts<Real>*>(&solids)})
        measure_all(many->entries.size(), kEntries, [&](std::size_t i, auto& found) {
            const auto& entry = many->entries[i];
            if (approaches.may_hit(pairs.keys[entry.pair], greatest))
                approaches.measure(pairs.keys[entry.pair], entry.contact, found);
        });
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
