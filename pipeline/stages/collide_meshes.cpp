// Collide meshes: convex shapes against static triangle meshes, a contact for each triangle
// touched.
#include "narrowphase/mesh/mesh_sides.hpp"
#include "pipeline/contacts/many_contacts.hpp"

namespace throng {

namespace {

constexpr std::size_t kGrain = 16;  // pairs a block

}  // namespace

template <class Real>
void collide_meshes(const StepContext& context,
                    const Pairs& pairs,
                    const Shapes& shapes,
                    const Colliders& colliders,
                    const Bounds& bounds,
                    const Poses& poses,
                    const BodyStates& states,
                    MeshContacts<Real>& contacts)
{
    const Real scale = static_cast<Real>(impulse_scale(context));
    contacts.scratch.followed_of_block.start(block_count(pairs.on_mesh.size(), kGrain));
    const auto find = [&](std::uint32_t i, const PairPlace& pair, const auto& old,
                          std::size_t block, ContactEntries<Real>& out) {
        static thread_local std::vector<TriangleManifold<Real>> found;
        const bool mesh_first = colliders.shape[pair.a].kind == ShapeKind::mesh;
        const std::uint32_t mesh = mesh_first ? pair.a : pair.b;
        const std::uint32_t other = mesh_first ? pair.b : pair.a;
        static thread_local std::vector<std::uint32_t> held;
        found.clear();
        double speculative_margin = pair.speculative_margin;
        if (!bounds.fast.empty() && !old.empty()) {
            speculative_margin = kept_speculative_margin(pair, bounds);
            if (speculative_margin > pair.speculative_margin)
                contacts.scratch.followed_of_block[block].push_back(i);
        }
        held.clear();
        for (const auto& before : old) held.push_back(before.part);
        collide_mesh({shapes, colliders.shape[mesh], colliders.shape[other],
                      rounded<Real>(pose_seen_from_a(shapes, colliders.shape[other],
                                                     bounds.placed[mesh], bounds.placed[other])),
                      static_cast<Real>(speculative_margin)},
                     held, found);
        for (const TriangleManifold<Real>& on_triangle : found) {
            auto& entry = out.emplace_back();
            entry.part = on_triangle.triangle;
            make_contact(on_triangle.manifold, bounds.placed[mesh],
                         anchor_origin(colliders.body[mesh], colliders.body[other], states, poses),
                         anchor_origin(colliders.body[other], colliders.body[mesh], states, poses),
                         entry.contact);
            note_round_sides(shapes, colliders.shape[mesh], colliders.shape[other],
                             bounds.placed[mesh], bounds.placed[other], entry.contact);
            // The answer is in the mesh's frame, mesh first; the pair may have it second.
            if (!mesh_first) turn_round(entry.contact);
            for (const auto& before : old)
                if (before.part == on_triangle.triangle)
                    carry_impulses(before.contact, scale, entry.contact);
        }
    };
    refresh_contacts<Real>(context, pairs, pairs.on_mesh, colliders, bounds, states, kGrain,
                           contacts, find);
    contacts.followed.clear();
    contacts.scratch.followed_of_block.append_to(contacts.followed);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void collide_meshes<Real>(const StepContext&, const Pairs&, const Shapes&,            \
                                       const Colliders&, const Bounds&, const Poses&,              \
                                       const BodyStates&, MeshContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
