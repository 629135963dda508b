// Collide convex: pairs of convex shapes into contacts.
//
// Pairs that sleep, or that nothing can push, keep what they have. Impulses carry over from the
// contact that the pair had before.
#include "kernels/parallel/blocks.hpp"
#include "kernels/solve/contact_rows.hpp"
#include "narrowphase/narrowphase.hpp"
#include "pipeline/stages/collide.hpp"

namespace throng {

namespace {

constexpr std::size_t kGrain = 64;  // pairs a block: some 30 microseconds of work

// After the list of pairs has changed: what each pair knew, at its new place.
template <class Real>
void follow_pairs(const Pairs& pairs, ConvexContacts<Real>& contacts)
{
    std::swap(contacts.of_pair, contacts.before);
    contacts.of_pair.resize(pairs.keys.size());
    for_each_block(pairs.keys.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            contacts.of_pair[i] =
                pairs.from[i] == Pairs::kNewPair ? Contact<Real>{} : contacts.before[pairs.from[i]];
    });
}

bool on_mesh(const Colliders& colliders, const PairPlace& pair)
{
    return colliders.shape[pair.a].kind == ShapeKind::mesh
        || colliders.shape[pair.b].kind == ShapeKind::mesh;
}

}  // namespace

template <class Real>
void collide_convex(const Conditions& conditions,
                    const Pairs& pairs,
                    const Shapes& shapes,
                    const Surfaces& surfaces,
                    const Colliders& colliders,
                    const Bounds& bounds,
                    const Poses& poses,
                    const BodyStates& states,
                    ConvexContacts<Real>& contacts)
{
    if (pairs.changed) follow_pairs(pairs, contacts);
    const Real scale = static_cast<Real>(impulse_scale(conditions));

    const auto refresh = [&](std::size_t i) {
        const PairPlace pair = place_of(pairs.keys[i], colliders, bounds);
        Contact<Real>& contact = contacts.of_pair[i];
        if (!wants_contact(pair, states)) {
            if (contact.count > 0 && scale != 1) scale_impulses(contact, scale);
            return;
        }
        if (on_mesh(colliders, pair)) return;
        // A plane goes second: it is seen from the other shape, so that numbers stay small.
        const bool turned = colliders.shape[pair.a].kind == ShapeKind::plane;
        const std::uint32_t first = turned ? pair.b : pair.a, second = turned ? pair.a : pair.b;
        const Pose& placed = bounds.placed[first];
        const Pose seen =
            pose_seen_from_a(shapes, colliders.shape[second], placed, bounds.placed[second]);
        LocalManifold<Real> manifold;
        collide(shapes, colliders.shape[first], colliders.shape[second], rounded<Real>(seen),
                static_cast<Real>(pair.reach), contact.cache, manifold);
        if (manifold.count == 0) {
            contact.count = 0;
            return;
        }
        const Contact<Real> before = contact;
        const std::uint32_t body_1 = colliders.body[first], body_2 = colliders.body[second];
        make_contact(manifold, placed, anchor_origin(body_1, body_2, states, poses),
                     anchor_origin(body_2, body_1, states, poses), contact);
        note_round_sides(shapes, colliders.shape[first], colliders.shape[second], placed,
                         bounds.placed[second], contact);
        if (turned) turn_round(contact);
        if (before.count == 0) return;
        const auto meeting =
            surfaces.between(colliders.material[pair.a], colliders.material[pair.b]);
        carry_impulses(before, static_cast<Real>(meeting.friction), scale, contact);
    };
    for_each_block(pairs.keys.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) refresh(i);
    });
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void collide_convex<Real>(const Conditions&, const Pairs&, const Shapes&,             \
                                       const Surfaces&, const Colliders&, const Bounds&,           \
                                       const Poses&, const BodyStates&, ConvexContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
