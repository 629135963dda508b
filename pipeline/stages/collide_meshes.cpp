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
class MeshCollision : ManyCollision<Real, MeshContacts<Real>> {
    using Many = ManyCollision<Real, MeshContacts<Real>>;

public:
    using Many::Many;

    void run()
    {
        contacts_.scratch.followed_of_block.start(block_count(pairs_.on_mesh.size(), kGrain));
        this->refresh(
            pairs_.on_mesh, kGrain, [&](std::span<const PairOfBlock> block) { look(block); },
            [&](const PairOfBlock& at, ContactEntries<Real>& out) { process(at, out); });
        contacts_.followed.clear();
        contacts_.scratch.followed_of_block.append_to(contacts_.followed);
    }

private:
    using Many::bounds_, Many::colliders_, Many::contacts_, Many::pairs_;
    using typename Many::Entry, typename Many::Found, typename Many::PairOfBlock,
        typename Many::Sides;

    // A pair as it is collided.
    struct Look {
        Sides sides;
        PairSight sight;
        const Found* recycled = nullptr;
        std::size_t near = 0;  // or else its triangles among those that were sought
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
    void look(std::span<const PairOfBlock> block)
    {
        Looks& all = looks();
        all.near.clear();
        std::size_t sought = 0;
        for (const PairOfBlock& at : block) {
            Look& look = all.of_pair[at.in_block];
            look.sides = this->sides_of(at.place, ShapeKind::mesh);
            look.sight = this->sight_of(look.sides, margin_of(at));
            look.recycled = recycled_of(at, look);
            if (look.recycled) continue;
            look.near = sought++;
            all.near.add(this->input_of(look.sides, look.sight));
        }
        all.near.find();
    }

    // How far a pair is looked at, m: of who is fast, what it touched already further than others.
    double margin_of(const PairOfBlock& at) const
    {
        if (bounds_.fast.empty() || at.old.empty()) return at.place.speculative_margin;
        return kept_speculative_margin(at.place, bounds_);
    }

    const Found* recycled_of(const PairOfBlock& at, const Look& look) const
    {
        const std::uint32_t other = look.sides.other;
        if (!is_recycled(colliders_.shape[other].kind)) return nullptr;
        const Found* const kept = this->kept_of(at);
        const double most = kRecycled * colliders_.inner_extent[other];
        return kept && this->may_recycle(*kept, look.sight, most) ? kept : nullptr;
    }

    void process(const PairOfBlock& at, ContactEntries<Real>& out)
    {
        const Look& look = looks().of_pair[at.in_block];
        if (look.sight.speculative_margin > at.place.speculative_margin)
            contacts_.scratch.followed_of_block[at.block].push_back(at.pair);
        const auto take = [&](std::uint32_t triangle, const LocalManifold<double>& manifold) {
            Entry& entry = this->add(look.sides, triangle, manifold, out);
            for (const Entry& before : at.old)
                if (before.part == triangle)
                    carry_impulses(before.contact, this->scale_, entry.contact);
        };
        if (look.recycled)
            this->recycle(*look.recycled, look.sight, at, take);
        else
            find_anew(at, look, take);
    }

    void find_anew(const PairOfBlock& at, const Look& look, const auto& take)
    {
        auto& [of_pair, near, held] = looks();
        held.clear();
        for (const Entry& before : at.old) held.push_back(before.part);
        std::vector<PartManifold>& found = contacts_.scratch.manifolds_of_block[at.block];
        const std::size_t first = found.size();
        collide_mesh(this->input_of(look.sides, look.sight), held, near.of(look.near), found);
        for (std::size_t k = first; k < found.size(); ++k) take(found[k].part, found[k].manifold);
        const auto count = static_cast<std::uint32_t>(found.size() - first);
        if (is_recycled(colliders_.shape[look.sides.other].kind))
            contacts_.scratch.found_of_block[at.block].push_back(
                {at.pair, 0, count, look.sight.pose, look.sight.speculative_margin, 0, 0});
        else
            found.resize(first);
    }
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
