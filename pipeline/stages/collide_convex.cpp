// Collide convex: pairs of convex shapes into contacts.
//
// Pairs that sleep, or that nothing can push, keep what they have. Impulses carry over from the
// contact that the pair had before. Kinds of pairs that crowds are made of take a way of their own:
// boxes go side by side through the wide kernels, and two spheres need no frame. Hulls that touch
// and have hardly moved against one another since are not collided anew: most of a heap at rest.
#include "kernels/dynamics/travels.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/contact_packing.hpp"
#include "narrowphase/convex/wide/box_pairs.hpp"
#include "narrowphase/dispatch.hpp"
#include "pipeline/contacts/chosen_method.hpp"
#include "pipeline/contacts/collide.hpp"
#include "pipeline/contacts/contact_places.hpp"
#include "pipeline/contacts/known_apart.hpp"
#include "pipeline/contacts/recycled_manifolds.hpp"
#include "pipeline/step/fast_bodies.hpp"

namespace throng {

namespace {

constexpr std::size_t kGrain = 512;         // pairs a block: some 20 microseconds of work
constexpr std::size_t kFar = 6, kNext = 4;  // pairs: how early memory is asked for

// m; single precision tells places that far from an origin apart by 8e-6 m.
constexpr double kFarInSingle = 128;

// What no later pose is near enough to.
template <class Real>
CachedManifold<Real> nothing_found()
{
    CachedManifold<Real> nothing;
    nothing.b_in_a.position.setConstant(std::numeric_limits<Real>::quiet_NaN());
    return nothing;
}

// The pairs of boxes of a block, until there are enough of them to be collided side by side.
struct BoxBatch {
    std::vector<std::uint32_t> places;  // among the pairs
    std::vector<BoxPair> pairs;
    std::vector<LocalManifold<float>> manifolds;
};

// One block of pairs: looks at each and keeps its contact, or notes that it has to change.
template <class Real>
class Collision {
public:
    Collision(const StepContext& context,
              const Pairs& pairs,
              const Shapes& shapes,
              const Colliders& colliders,
              const Bounds& bounds,
              const Poses& poses,
              const BodyStates& states,
              ChosenMethod& chosen,
              ConvexContacts<Real>& contacts)
        : pairs_(pairs), shapes_(shapes), colliders_(colliders), bounds_(bounds), poses_(poses),
          states_(states), chosen_(chosen), contacts_(contacts),
          scale_(static_cast<Real>(impulse_scale(context)))
    { }

    void process(std::size_t begin, std::size_t end, std::size_t block)
    {
        static thread_local BoxBatch boxes;  // keeps its room from block to block
        boxes.places.clear();
        boxes.pairs.clear();
        begun_.made.clear();
        begun_.found.clear();
        std::array<std::uint32_t, kGrain> near;
        const std::size_t count = find_near(pairs_, bounds_, begin, end, contacts_,
                                            contacts_.scratch.parted[block], near);
        for (std::size_t k = 0; k < count; ++k) {
            if (k + kFar < count) ask_for(pairs_.keys[near[k + kFar]]);
            const std::uint32_t i = near[k];
            PairPlace pair = place_of(pairs_.keys[i], colliders_, bounds_);
            if (!bounds_.fast.empty()) keep_touching(i, pair, block);
            if (wants_contact(pair, states_))
                collide_one(i, pair, boxes, block);
            else if (const std::uint32_t place = contacts_.of_pair[i].contact;
                     place != PairState::kApart && scale_ != 1)
                scale_impulses(contacts_.contacts[place], scale_);
        }
        if (!boxes.pairs.empty()) collide_batch(boxes, block);
        contacts_.scratch.begun[block].made.assign(begun_.made.begin(), begun_.made.end());
        contacts_.scratch.begun[block].found.assign(begun_.found.begin(), begun_.found.end());
    }

private:
    // The contacts that began in a block; on each thread, as the blocks of a world would keep room
    // for far more together than any step needs.
    static typename ConvexContacts<Real>::Begun& begun()
    {
        static thread_local typename ConvexContacts<Real>::Begun lists;
        return lists;
    }

    void ask_for(PairKey key) const
    {
        const std::uint32_t b = second_of(key);
        __builtin_prefetch(&bounds_.placed[b]);
        __builtin_prefetch(&bounds_.placed[b].orientation.w());
        __builtin_prefetch(&bounds_.speculative_margin[b]);
        __builtin_prefetch(&colliders_.shape[b]);
        __builtin_prefetch(&colliders_.body[b]);
    }

    void keep_touching(std::size_t i, PairPlace& pair, std::size_t block) const
    {
        if (contacts_.of_pair[i].contact == PairState::kApart) return;
        const double kept = kept_speculative_margin(pair, bounds_);
        if (!(kept > pair.speculative_margin)) return;
        pair.speculative_margin = kept;
        contacts_.scratch.followed_of_block[block].push_back(static_cast<std::uint32_t>(i));
    }

    void part(std::size_t i, std::size_t block)
    {
        if (contacts_.of_pair[i].contact != PairState::kApart)
            contacts_.scratch.parted[block].push_back(static_cast<std::uint32_t>(i));
    }

    void collide_one(std::size_t i, const PairPlace& pair, BoxBatch& boxes, std::size_t block)
    {
        using enum ShapeKind;
        const ShapeKind a = colliders_.shape[pair.a].kind, b = colliders_.shape[pair.b].kind;
        if (a == mesh || b == mesh || a == solid || b == solid) return;
        if (chosen_.asks(a, b)) {
            // Those that touch are told by what was found earlier, to the square of what they moved
            // since: a filter, which is exact, might part what that still holds.
            if (contacts_.of_pair[i].contact == PairState::kApart && chosen_.parts(pair)) return;
            if (chosen_.has_method() && collide_chosen(i, pair, block)) return;
        }
        if (a == sphere && b == sphere) return collide_spheres(i, pair, block);
        if constexpr (std::is_same_v<Real, float>) {
            if (a != plane && b != plane && is_far(pair)) return collide_in_double(i, pair, block);
            if (a == box && b == box) return put_aside(i, pair, boxes);
        }
        if (contacts_.recycles && is_recycled(a, b)) return collide_or_recycle(i, pair, block);
        collide_pair<Real>(i, pair, block);
    }

    bool collide_chosen(std::size_t i, const PairPlace& pair, std::size_t block)
    {
        LocalManifold<double> exact;
        if (!chosen_.collide(i, pair, exact, block)) return false;
        take(i, pair, false, exact.cast<Real>(), block);
        return true;
    }

    void collide_spheres(std::size_t i, const PairPlace& pair, std::size_t block)
    {
        const Vec3& center_a = bounds_.placed[pair.a].position;
        const Vec3 between = between_centers(pair.a, pair.b, colliders_, bounds_);
        const double radius_a = shapes_.spheres[colliders_.shape[pair.a].index].radius;
        const double radius_b = shapes_.spheres[colliders_.shape[pair.b].index].radius;
        const double radii = radius_a + radius_b, distance = between.norm();
        if (distance - radii > pair.speculative_margin) return part(i, block);
        // One inside the other, centers and all: out by the top, as good a way as any.
        const Vec3 normal = distance > 0 ? Vec3(between / distance) : Vec3(Vec3::UnitZ());
        const Vec3& origin_a = anchor_origin(pair.body_a, pair.body_b, states_, poses_);
        const Vec3& origin_b = anchor_origin(pair.body_b, pair.body_a, states_, poses_);
        Contact<Real> contact;
        contact.normal = normal.cast<Real>();
        contact.center_offset = (origin_a - origin_b).template cast<Real>();
        contact.count = 1;
        contact.points[0].anchor_a =
            (normal * radius_a + (center_a - origin_a)).template cast<Real>();
        contact.points[0].separation = static_cast<Real>(distance - radii);
        contact.round_a = static_cast<Real>(radius_a);
        contact.round_b = static_cast<Real>(radius_b);
        keep(i, contact);
    }

    // Whether single precision tells places of the one no better apart than by 8e-6 m, seen from
    // the other: it is on a large floor, far from its middle.
    bool is_far(const PairPlace& pair) const
    {
        const Vec3& a = bounds_.placed[pair.a].position;
        return (bounds_.placed[pair.b].position - a).squaredNorm() > kFarInSingle * kFarInSingle;
    }

    void collide_in_double(std::size_t i, const PairPlace& pair, std::size_t block)
    {
        if (collide_pair<double>(i, pair, block) && contacts_.recycles)
            keep_found(i, nothing_found<Real>());
    }

    void keep_found(std::size_t i, const CachedManifold<Real>& found)
    {
        const std::uint32_t contact = contacts_.of_pair[i].contact;
        if (contact != PairState::kApart)
            contacts_.found[contact] = found;
        else
            begun_.found.push_back({static_cast<std::uint32_t>(i), found});
    }

    // Turning, in float: only where b is has to be told in double.
    void put_aside(std::size_t i, const PairPlace& pair, BoxBatch& boxes)
    {
        const Pose &a = bounds_.placed[pair.a], &b = bounds_.placed[pair.b];
        const QuatT<float> back = a.orientation.cast<float>().conjugate();
        const Vec3T<float> offset =
            between_centers(pair.a, pair.b, colliders_, bounds_).cast<float>();
        const auto half = [&](std::uint32_t collider) -> Vec3T<float> {
            return shapes_.boxes[colliders_.shape[collider].index].half_extents.cast<float>();
        };
        boxes.places.push_back(static_cast<std::uint32_t>(i));
        boxes.pairs.push_back(
            box_pair({back * offset, QuatT<float>(back * b.orientation.cast<float>())},
                     half(pair.a), half(pair.b), static_cast<float>(pair.speculative_margin)));
    }

    void collide_batch(BoxBatch& boxes, std::size_t block)
    {
        if constexpr (std::is_same_v<Real, float>) {
            if (boxes.manifolds.size() < boxes.pairs.size())
                boxes.manifolds.resize(boxes.pairs.size());
            const auto manifolds = std::span(boxes.manifolds).first(boxes.pairs.size());
            collide_boxes(boxes.pairs, manifolds);
            for (std::size_t k = 0; k < manifolds.size(); ++k) {
                if (k + kNext < manifolds.size()) ask_for_contact(boxes.places[k + kNext]);
                const std::size_t i = boxes.places[k];
                const PairPlace pair = place_of(pairs_.keys[i], colliders_, bounds_);
                take(i, pair, false, manifolds[k], block);
            }
        }
    }

    void ask_for_contact(std::size_t i) const
    {
        const std::uint32_t place = contacts_.of_pair[i].contact;
        if (place == PairState::kApart) return;
        const auto* const contact = reinterpret_cast<const char*>(&contacts_.contacts[place]);
        for (std::size_t byte = 0; byte < sizeof(Contact<Real>); byte += 64)
            __builtin_prefetch(contact + byte, 1);
    }

    // Whether they touch.
    template <class From>
    bool collide_pair(std::size_t i, const PairPlace& pair, std::size_t block)
    {
        // A plane goes second: it is seen from the other shape, so that numbers stay small.
        const bool turned = colliders_.shape[pair.a].kind == ShapeKind::plane;
        const std::uint32_t first = turned ? pair.b : pair.a, second = turned ? pair.a : pair.b;
        const Pose seen = seen_from_first(first, second, shapes_, colliders_, bounds_);
        LocalManifold<From> manifold;
        PairCache cache = contacts_.of_pair[i].cache;
        collide({shapes_, colliders_.shape[first], colliders_.shape[second], rounded<From>(seen),
                 static_cast<From>(pair.speculative_margin)},
                cache, manifold);
        contacts_.of_pair[i].cache = cache;
        chosen_.note_fallback(cache, block);
        take(i, pair, turned, manifold, block);
        return manifold.count > 0;
    }

    void collide_or_recycle(std::size_t i, const PairPlace& pair, std::size_t block)
    {
        PairState& state = contacts_.of_pair[i];
        const bool touched = state.contact != PairState::kApart;
        PairCache cache = state.cache;
        CachedManifold<Real> found;
        const bool anew =
            find_or_recycle(shapes_, colliders_, bounds_, pair,
                            touched ? &contacts_.found[state.contact] : nullptr, cache, found);
        state.cache = cache;
        take(i, pair, false, found.manifold, block);
        if (!anew) return;
        chosen_.note_fallback(cache, block);
        if (found.manifold.count == 0)
            note_apart(pairs_.keys[i], double{cache.apart} - pair.speculative_margin,
                       contacts_.travels, contacts_.apart_until[i]);
        else
            keep_found(i, found);
    }

    template <class From>
    void take(std::size_t i,
              const PairPlace& pair,
              bool turned,
              const LocalManifold<From>& manifold,
              std::size_t block)
    {
        if (manifold.count == 0) return part(i, block);
        const std::uint32_t first = turned ? pair.b : pair.a, second = turned ? pair.a : pair.b;
        const std::uint32_t body_1 = colliders_.body[first], body_2 = colliders_.body[second];
        Contact<Real> contact;
        make_contact(manifold, frame_of(first, second, colliders_, bounds_),
                     anchor_origin(body_1, body_2, states_, poses_),
                     anchor_origin(body_2, body_1, states_, poses_), contact);
        note_round_sides(shapes_, colliders_.shape[first], colliders_.shape[second],
                         bounds_.placed[first], bounds_.placed[second], contact);
        if (turned) turn_round(contact);
        keep(i, contact);
    }

    // In the place of the contact that the pair had, with its impulses; or as a new one.
    void keep(std::size_t i, Contact<Real>& contact)
    {
        const std::uint32_t place = contacts_.of_pair[i].contact;
        if (place == PairState::kApart) {
            begun_.made.push_back({static_cast<std::uint32_t>(i), contact});
            return;
        }
        carry_impulses(contacts_.contacts[place], scale_, contact);
        contacts_.contacts[place].take(contact);
    }

    const Pairs& pairs_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    const Bounds& bounds_;
    const Poses& poses_;
    const BodyStates& states_;
    ChosenMethod& chosen_;
    ConvexContacts<Real>& contacts_;
    Real scale_;
    typename ConvexContacts<Real>::Begun& begun_ = begun();
};

// Nobody has followed what was found while a method of choice answered.
template <class Real>
void forget_found(ConvexContacts<Real>& contacts)
{
    contacts.found.assign(contacts.contacts.size(), nothing_found<Real>());
    contacts.apart_until.assign(contacts.apart_until.size(), 0.0F);
}

}  // namespace

template <class Real>
void collide_convex(const StepContext& context,
                    const NarrowPhaseParameters& parameters,
                    const Pairs& pairs,
                    const Shapes& shapes,
                    const Colliders& colliders,
                    const Bounds& bounds,
                    const Poses& poses,
                    const BodyStates& states,
                    ConvexContacts<Real>& contacts,
                    MethodPairs& method_pairs)
{
    if (pairs.changed) follow_pairs(pairs, contacts);
    const std::size_t blocks = block_count(pairs.keys.size(), kGrain);
    contacts.scratch.begun.resize(blocks);
    contacts.scratch.parted.start(blocks);
    contacts.scratch.followed_of_block.start(bounds.fast.empty() ? 0 : blocks);
    ChosenMethod chosen(parameters, pairs, shapes, colliders, bounds, blocks, method_pairs);
    const bool recycles = !shapes.hulls.empty() && !chosen.has_method();
    if (recycles && !contacts.recycles) forget_found(contacts);
    contacts.recycles = recycles;
    if (contacts.recycles) {
        resize_closely(contacts.apart_until, pairs.keys.size());
        follow_colliders(bounds.placed_anew, bounds.placed, colliders.outer_radius,
                         bounds.speculative_margin, contacts.travels);
    }
    for_each_block(pairs.keys.size(), kGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                       Collision<Real>(context, pairs, shapes, colliders, bounds, poses, states,
                                       chosen, contacts)
                           .process(begin, end, block);
                   });
    contacts.followed.clear();
    contacts.scratch.followed_of_block.append_to(contacts.followed);
    chosen.count_fallbacks();
    move_in_and_out(contacts);
    put_in_order(contacts);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void collide_convex<Real>(const StepContext&, const NarrowPhaseParameters&,           \
                                       const Pairs&, const Shapes&, const Colliders&,              \
                                       const Bounds&, const Poses&, const BodyStates&,             \
                                       ConvexContacts<Real>&, MethodPairs&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
