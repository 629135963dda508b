// Collide meshes: convex shapes against static triangle meshes, a contact for each triangle
// touched.
//
// What was found of a box or a hull is told from where its points are now for as long as it has
// hardly moved. What is round is found anew: it rolls, and its points do not go with it. Large
// meshes are far from the processor: the triangles near all pairs of a block are sought side by
// side.
#include "narrowphase/mesh/mesh_sides.hpp"
#include "narrowphase/mesh/near_triangles.hpp"
#include "pipeline/contacts/many_contacts.hpp"

#include <array>

namespace throng {

namespace {

constexpr std::size_t kGrain = 16;  // pairs a block

bool is_recycled(ShapeKind on_mesh)
{
    return on_mesh == ShapeKind::box || on_mesh == ShapeKind::hull;
}

// One call of the stage.
template <class Real>
class MeshCollision {
public:
    using Contacts = MeshContacts<Real>;
    using Entry = typename Contacts::Entry;
    using Found = typename Contacts::Found;

    MeshCollision(const StepContext& context,
                  const Pairs& pairs,
                  const Shapes& shapes,
                  const Colliders& colliders,
                  const Bounds& bounds,
                  const Poses& poses,
                  const BodyStates& states,
                  Contacts& contacts)
        : context_(context), pairs_(pairs), shapes_(shapes), colliders_(colliders), bounds_(bounds),
          poses_(poses), states_(states), contacts_(contacts),
          scale_(static_cast<Real>(impulse_scale(context)))
    { }

    void run()
    {
        contacts_.scratch.followed_of_block.start(block_count(pairs_.on_mesh.size(), kGrain));
        refresh_contacts<Real>(
            context_, pairs_, pairs_.on_mesh, colliders_, bounds_, states_, kGrain, contacts_,
            [&](std::span<const PairOfBlock<Real>> block) { look(block); },
            [&](auto&&... all) { process(all...); });
        contacts_.followed.clear();
        contacts_.scratch.followed_of_block.append_to(contacts_.followed);
    }

private:
    // A pair as it is collided, the mesh first.
    struct Look {
        std::uint32_t mesh = 0, other = 0;
        PairSight sight;
        const Found* kept = nullptr;  // what is recycled
        std::size_t near = 0;         // or else its triangles among those that were sought
    };
    struct Looks {
        std::array<Look, kGrain> of_pair;
        NearTriangles near;
        std::vector<std::uint32_t> held;
    };

    // Of the block that this thread is at.
    static Looks& looks()
    {
        static thread_local Looks all;
        return all;
    }

    // Tells pairs that are recycled from those whose triangles have to be found, and finds them.
    void look(std::span<const PairOfBlock<Real>> block)
    {
        Looks& all = looks();
        all.near.clear();
        std::size_t sought = 0;
        for (const PairOfBlock<Real>& at : block) {
            Look& look = all.of_pair[at.in_block];
            const bool mesh_first = colliders_.shape[at.place.a].kind == ShapeKind::mesh;
            look.mesh = mesh_first ? at.place.a : at.place.b;
            look.other = mesh_first ? at.place.b : at.place.a;
            look.sight = {pose_seen_from_a(shapes_, colliders_.shape[look.other],
                                           bounds_.placed[look.mesh], bounds_.placed[look.other]),
                          colliders_.outer_radius[look.mesh], colliders_.outer_radius[look.other],
                          margin_of(at)};
            look.kept = recycled_of(at, look);
            if (look.kept) continue;
            look.near = sought++;
            all.near.add(input_of(look));
        }
        all.near.find();
    }

    // How far a pair is looked at, m: of who is fast, what it touched already further than others.
    double margin_of(const PairOfBlock<Real>& at) const
    {
        if (bounds_.fast.empty() || at.old.empty()) return at.place.speculative_margin;
        return kept_speculative_margin(at.place, bounds_);
    }

    const Found* recycled_of(const PairOfBlock<Real>& at, const Look& look) const
    {
        if (!is_recycled(colliders_.shape[look.other].kind)) return nullptr;
        const std::span kept = items_of(contacts_.found_before.pairs, old_place(pairs_, at.pair));
        const double most = kRecycled * colliders_.inner_extent[look.other];
        if (kept.empty() || !may_recycle(kept.front(), look.sight, most)) return nullptr;
        return &kept.front();
    }

    PairInput<double> input_of(const Look& look) const
    {
        return {shapes_, colliders_.shape[look.mesh], colliders_.shape[look.other], look.sight.pose,
                look.sight.speculative_margin};
    }

    void process(const PairOfBlock<Real>& at, ContactEntries<Real>& out)
    {
        const Look& look = looks().of_pair[at.in_block];
        if (look.sight.speculative_margin > at.place.speculative_margin)
            contacts_.scratch.followed_of_block[at.block].push_back(at.pair);
        const auto take = [&](std::uint32_t triangle, const LocalManifold<double>& manifold) {
            add(at, look, triangle, manifold, out);
        };
        if (look.kept)
            recycle_finds(contacts_, *look.kept, look.sight, at, take);
        else
            find_anew(at, look, take);
    }

    void find_anew(const PairOfBlock<Real>& at, const Look& look, const auto& take)
    {
        auto& [of_pair, near, held] = looks();
        held.clear();
        for (const Entry& before : at.old) held.push_back(before.part);
        std::vector<PartManifold>& found = contacts_.scratch.manifolds_of_block[at.block];
        const std::size_t first = found.size();
        collide_mesh(input_of(look), held, near.of(look.near), found);
        for (std::size_t k = first; k < found.size(); ++k) take(found[k].part, found[k].manifold);
        const auto count = static_cast<std::uint32_t>(found.size() - first);
        if (is_recycled(colliders_.shape[look.other].kind))
            contacts_.scratch.found_of_block[at.block].push_back(
                {at.pair, 0, count, look.sight.pose, look.sight.speculative_margin, 0, 0});
        else
            found.resize(first);
    }

    void add(const PairOfBlock<Real>& at,
             const Look& look,
             std::uint32_t triangle,
             const LocalManifold<double>& manifold,
             ContactEntries<Real>& out) const
    {
        const std::uint32_t mesh = colliders_.body[look.mesh];
        const std::uint32_t other = colliders_.body[look.other];
        Entry& entry = out.emplace_back();
        entry.part = triangle;
        make_contact(manifold, bounds_.placed[look.mesh],
                     anchor_origin(mesh, other, states_, poses_),
                     anchor_origin(other, mesh, states_, poses_), entry.contact);
        note_round_sides(shapes_, colliders_.shape[look.mesh], colliders_.shape[look.other],
                         bounds_.placed[look.mesh], bounds_.placed[look.other], entry.contact);
        // The answer is in the mesh's frame, mesh first; the pair may have it second.
        if (look.mesh != at.place.a) turn_round(entry.contact);
        for (const Entry& before : at.old)
            if (before.part == triangle) carry_impulses(before.contact, scale_, entry.contact);
    }

    const StepContext& context_;
    const Pairs& pairs_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    const Bounds& bounds_;
    const Poses& poses_;
    const BodyStates& states_;
    Contacts& contacts_;
    Real scale_;
};

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
    MeshCollision<Real>(context, pairs, shapes, colliders, bounds, poses, states, contacts).run();
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void collide_meshes<Real>(const StepContext&, const Pairs&, const Shapes&,            \
                                       const Colliders&, const Bounds&, const Poses&,              \
                                       const BodyStates&, MeshContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
