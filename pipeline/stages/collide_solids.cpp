// Collide solids: shapes that need not be convex, against whatever there is; a contact for each
// patch of the two surfaces.
//
// What was found of a pair is told from where its points are now for as long as the two have hardly
// moved against one another: most of a heap at rest.
#include "narrowphase/dispatch.hpp"
#include "narrowphase/solid/solid_pairs.hpp"
#include "pipeline/contacts/many_contacts.hpp"

namespace throng {

namespace {

constexpr std::size_t kGrain = 4;  // pairs a block: each costs microseconds at least

// One call of the stage.
template <class Real>
class SolidCollision : ManyCollision<Real, SolidContacts<Real>> {
    using Many = ManyCollision<Real, SolidContacts<Real>>;

public:
    using Many::Many;

    void run()
    {
        this->refresh(
            pairs_.on_solid, kGrain, [](std::span<const PairOfBlock>) {},
            [&](const PairOfBlock& at, ContactEntries<Real>& out) { process(at, out); });
        contacts_.left_out = 0;
        for (const Found& found : contacts_.found.pairs) contacts_.left_out += found.left_out;
    }

private:
    using Many::bounds_, Many::colliders_, Many::contacts_, Many::pairs_, Many::shapes_;
    using typename Many::Entry, typename Many::Found, typename Many::PairOfBlock,
        typename Many::Sides;

    void process(const PairOfBlock& at, ContactEntries<Real>& out)
    {
        const Sides sides = this->sides_of(at.place, ShapeKind::solid);
        const PairSight sight = this->sight_of(sides, margin_of(at.place));
        const Found* const kept = this->kept_of(at);
        const std::size_t first = out.size();
        const auto take = [&](std::uint32_t part, const LocalManifold<double>& manifold) {
            this->add(sides, part, manifold, out);
        };
        if (kept && this->may_recycle(*kept, sight, most_moved(*kept, sides)))
            this->recycle(*kept, sight, at, take);
        else
            find_anew(sides, sight, pressed_in(kept, sides, sight.pose), at, take);
        for (std::size_t n = first; n < out.size(); ++n)
            carry_over(at.old, out[n].contact, out[n].part);
    }

    // How far a pair is looked at, m. Who is fast has been held where his triangles met something,
    // and what stands for them may be off by its error: he would fall in. No further than that, as
    // of many points the outermost count, and those that touch would not.
    double margin_of(const PairPlace& pair) const
    {
        if (bounds_.fast.empty() || !(bounds_.kept[pair.a] > 0 || bounds_.kept[pair.b] > 0))
            return pair.speculative_margin;
        const double error = shape_error(shapes_, colliders_.shape[pair.a])
            + shape_error(shapes_, colliders_.shape[pair.b]);
        return std::max(pair.speculative_margin, error);
    }

    void find_anew(const Sides& sides,
                   const PairSight& sight,
                   double pressed_in,
                   const PairOfBlock& at,
                   const auto& take)
    {
        std::vector<PartManifold>& patches = contacts_.scratch.manifolds_of_block[at.block];
        const std::size_t first = patches.size();
        const SolidAnswer answer = collide_solid(this->input_of(sides, sight), patches, pressed_in);
        for (std::size_t k = first; k < patches.size(); ++k)
            take(patches[k].part, patches[k].manifold);
        contacts_.scratch.found_of_block[at.block].push_back(
            {at.pair, 0, static_cast<std::uint32_t>(patches.size() - first), sight.pose,
             sight.speculative_margin, answer.apart, answer.left_out});
    }

    // How deep what was found before is by now, m.
    double pressed_in(const Found* kept, const Sides& sides, const Pose& pose) const
    {
        if (!kept || colliders_.shape[sides.other].kind != ShapeKind::mesh) return 0;
        double least = 0;
        LocalManifold<double> now;
        for (const PartManifold& patch : this->manifolds_of(*kept)) {
            move_manifold({patch.manifold, kept->b_in_a, kept->speculative_margin}, pose, 0.0, now);
            for (int i = 0; i < now.count; ++i)
                least = std::min(least, now.points[static_cast<std::size_t>(i)].separation);
        }
        return -least;
    }

    // How far the two may move before they are looked at anew, m.
    double most_moved(const Found& kept, const Sides& sides) const
    {
        const double most = kRecycled * least_extent(sides);
        if (kept.count > 0) return most;
        return std::max(most, kept.apart - kept.speculative_margin);
    }

    // A mesh is as thick as whatever lies behind it.
    double least_extent(const Sides& sides) const
    {
        const double own = colliders_.inner_extent[sides.first];
        if (colliders_.shape[sides.other].kind == ShapeKind::mesh) return own;
        return std::min(own, colliders_.inner_extent[sides.other]);
    }

    // From the contact of the same patch, or else from that which shares the most points.
    void carry_over(std::span<const Entry> old, Contact<Real>& contact, std::uint32_t part) const
    {
        const Entry* best = nullptr;
        int most = 0;
        for (const Entry& before : old) {
            const int shared =
                2 * shared_points(before.contact, contact) + (before.part == part ? 1 : 0);
            if (shared > most) {
                most = shared;
                best = &before;
            }
        }
        if (best != nullptr) carry_impulses(best->contact, this->scale_, contact);
    }

    static int shared_points(const Contact<Real>& x, const Contact<Real>& y)
    {
        int shared = 0;
        for (int i = 0; i < x.count; ++i)
            for (int k = 0; k < y.count; ++k)
                shared += x.points[static_cast<std::size_t>(i)].feature
                        == y.points[static_cast<std::size_t>(k)].feature
                    ? 1
                    : 0;
        return shared;
    }
};

}  // namespace

template <class Real>
void collide_solids(const StepContext& context,
                    const Pairs& pairs,
                    const Shapes& shapes,
                    const Colliders& colliders,
                    const Bounds& bounds,
                    const Poses& poses,
                    const BodyStates& states,
                    SolidContacts<Real>& contacts)
{
    SolidCollision<Real>(context, pairs, shapes, colliders, bounds, poses, states, contacts).run();
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void collide_solids<Real>(const StepContext&, const Pairs&, const Shapes&,            \
                                       const Colliders&, const Bounds&, const Poses&,              \
                                       const BodyStates&, SolidContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
