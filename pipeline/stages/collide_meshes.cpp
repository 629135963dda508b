// Collide meshes: convex shapes against static triangle meshes, a contact for each triangle
// touched.
#include "kernels/parallel/blocks.hpp"
#include "kernels/solve/contact_rows.hpp"
#include "narrowphase/narrowphase.hpp"
#include "pipeline/stages/collide.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kGrain = 16;  // pairs a block

template <class Real>
using Entries = std::vector<typename MeshContacts<Real>::Entry>;

// The contacts that a pair had in the last step.
template <class Real>
std::pair<std::size_t, std::size_t> range_of(const Entries<Real>& entries, std::uint32_t pair)
{
    const auto [first, last] =
        std::equal_range(entries.begin(), entries.end(), pair, [](const auto& x, const auto& y) {
            const auto number = [](const auto& value) {
                if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::uint32_t>)
                    return value;
                else
                    return value.pair;
            };
            return number(x) < number(y);
        });
    return {static_cast<std::size_t>(first - entries.begin()),
            static_cast<std::size_t>(last - entries.begin())};
}

}  // namespace

template <class Real>
void collide_meshes(const Conditions& conditions,
                    const Pairs& pairs,
                    const Shapes& shapes,
                    const Colliders& colliders,
                    const Bounds& bounds,
                    const Poses& poses,
                    const BodyStates& states,
                    MeshContacts<Real>& contacts)
{
    std::swap(contacts.entries, contacts.before);
    contacts.entries.clear();
    const Real scale = static_cast<Real>(impulse_scale(conditions));

    const auto refresh = [&](std::uint32_t i, Entries<Real>& out,
                             std::vector<TriangleManifold<Real>>& found) {
        const PairPlace pair = place_of(pairs.keys[i], colliders, bounds);
        const std::uint32_t old_place = pairs.changed ? pairs.from[i] : i;
        std::pair<std::size_t, std::size_t> old{0, 0};
        if (old_place != Pairs::kNewPair) old = range_of<Real>(contacts.before, old_place);
        if (!wants_contact(pair, states)) {
            for (std::size_t k = old.first; k < old.second; ++k) {
                out.push_back(contacts.before[k]);
                out.back().pair = i;
                scale_impulses(out.back().contact, scale);
            }
            return;
        }
        const bool mesh_first = colliders.shape[pair.a].kind == ShapeKind::mesh;
        const std::uint32_t mesh = mesh_first ? pair.a : pair.b;
        const std::uint32_t other = mesh_first ? pair.b : pair.a;
        found.clear();
        collide_mesh(shapes, colliders.shape[mesh], colliders.shape[other],
                     rounded<Real>(pose_seen_from_a(shapes, colliders.shape[other],
                                                    bounds.placed[mesh], bounds.placed[other])),
                     static_cast<Real>(pair.reach), found);
        for (const TriangleManifold<Real>& touch : found) {
            auto& entry = out.emplace_back();
            entry.pair = i;
            entry.triangle = touch.triangle;
            make_contact(touch.manifold, bounds.placed[mesh],
                         anchor_origin(colliders.body[mesh], colliders.body[other], states, poses),
                         anchor_origin(colliders.body[other], colliders.body[mesh], states, poses),
                         entry.contact);
            note_round_sides(shapes, colliders.shape[mesh], colliders.shape[other],
                             bounds.placed[mesh], bounds.placed[other], entry.contact);
            // The answer is in the mesh's frame, mesh first; the pair may have it second.
            if (!mesh_first) turn_round(entry.contact);
            for (std::size_t k = old.first; k < old.second; ++k)
                if (contacts.before[k].triangle == touch.triangle)
                    carry_impulses(contacts.before[k].contact, scale, entry.contact);
        }
    };

    std::vector<Entries<Real>> of_block(block_count(pairs.on_mesh.size(), kGrain));
    for_each_block(pairs.on_mesh.size(), kGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                       std::vector<TriangleManifold<Real>> found;
                       for (std::size_t k = begin; k < end; ++k)
                           refresh(pairs.on_mesh[k], of_block[block], found);
                   });
    for (const Entries<Real>& block : of_block)
        contacts.entries.insert(contacts.entries.end(), block.begin(), block.end());
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void collide_meshes<Real>(const Conditions&, const Pairs&, const Shapes&,             \
                                       const Colliders&, const Bounds&, const Poses&,              \
                                       const BodyStates&, MeshContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
