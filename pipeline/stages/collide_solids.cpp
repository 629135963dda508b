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
class SolidCollision {
public:
    using Contacts = SolidContacts<Real>;
    using Found = typename Contacts::Found;
    using Entry = typename Contacts::Entry;

    SolidCollision(const StepContext& context,
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
        refresh_contacts<Real>(
            context_, pairs_, pairs_.on_solid, colliders_, bounds_, states_, kGrain, contacts_,
            [](std::span<const PairOfBlock<Real>>) {}, [&](auto&&... all) { process(all...); });
        contacts_.left_out = 0;
        for (const Found& found : contacts_.found.pairs) contacts_.left_out += found.left_out;
    }

private:
    // The two of a pair as they are collided: the solid first.
    struct Sides {
        std::uint32_t solid = 0, other = 0;
        bool swapped = false;
    };

    Sides sides_of(const PairPlace& pair) const
    {
        if (colliders_.shape[pair.a].kind == ShapeKind::solid) return {pair.a, pair.b, false};
        return {pair.b, pair.a, true};
    }

    void process(const PairOfBlock<Real>& at, ContactEntries<Real>& out)
    {
        const Sides sides = sides_of(at.place);
        const PairSight sight{pose_seen_from_a(shapes_, colliders_.shape[sides.other],
                                               bounds_.placed[sides.solid],
                                               bounds_.placed[sides.other]),
                              colliders_.outer_radius[sides.solid],
                              colliders_.outer_radius[sides.other], margin_of(at.place)};
        const std::span kept = items_of(contacts_.found_before.pairs, old_place(pairs_, at.pair));
        const std::size_t first = out.size();
        const auto take = [&](std::uint32_t part, const LocalManifold<double>& manifold) {
            add(sides, part, manifold, out);
        };
        if (!kept.empty() && may_recycle(kept.front(), sight, most_moved(kept.front(), sides)))
            recycle_finds(contacts_, kept.front(), sight, at, take);
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
                   const PairOfBlock<Real>& at,
                   const auto& take)
    {
        std::vector<PartManifold>& patches = contacts_.scratch.manifolds_of_block[at.block];
        const std::size_t first = patches.size();
        const SolidAnswer answer =
            collide_solid({shapes_, colliders_.shape[sides.solid], colliders_.shape[sides.other],
                           sight.pose, sight.speculative_margin},
                          patches, pressed_in);
        for (std::size_t k = first; k < patches.size(); ++k)
            take(patches[k].part, patches[k].manifold);
        contacts_.scratch.found_of_block[at.block].push_back(
            {at.pair, 0, static_cast<std::uint32_t>(patches.size() - first), sight.pose,
             sight.speculative_margin, answer.apart, answer.left_out});
    }

    // How deep what was found before is by now, m.
    double pressed_in(std::span<const Found> kept, const Sides& sides, const Pose& pose) const
    {
        if (kept.empty() || colliders_.shape[sides.other].kind != ShapeKind::mesh) return 0;
        const Found& then = kept.front();
        double least = 0;
        LocalManifold<double> now;
        for (const PartManifold& patch : manifolds_of(contacts_, then)) {
            move_manifold({patch.manifold, then.b_in_a, then.speculative_margin}, pose, 0.0, now);
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
        const double own = colliders_.inner_extent[sides.solid];
        if (colliders_.shape[sides.other].kind == ShapeKind::mesh) return own;
        return std::min(own, colliders_.inner_extent[sides.other]);
    }

    void add(const Sides& sides,
             std::uint32_t part,
             const LocalManifold<double>& manifold,
             ContactEntries<Real>& out) const
    {
        const std::uint32_t solid = colliders_.body[sides.solid];
        const std::uint32_t other = colliders_.body[sides.other];
        Entry& entry = out.emplace_back();
        entry.part = part;
        make_contact(manifold, bounds_.placed[sides.solid],
                     anchor_origin(solid, other, states_, poses_),
                     anchor_origin(other, solid, states_, poses_), entry.contact);
        note_round_sides(shapes_, colliders_.shape[sides.solid], colliders_.shape[sides.other],
                         bounds_.placed[sides.solid], bounds_.placed[sides.other], entry.contact);
        // The answer is in the solid's frame, solid first; the pair may have it second.
        if (sides.swapped) turn_round(entry.contact);
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
        if (best != nullptr) carry_impulses(best->contact, scale_, contact);
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
