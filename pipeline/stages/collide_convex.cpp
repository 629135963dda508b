// Collide convex: pairs of convex shapes into contacts.
//
// Pairs that sleep, or that nothing can push, keep what they have. Impulses carry over from the
// contact that the pair had before. Kinds of pairs that crowds are made of take a way of their own:
// boxes go side by side through the wide kernels, and two spheres need no frame. Hulls that touch
// and have hardly moved against one another since are not collided anew: most of a heap at rest.
#include "kernels/motion/travels.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solve/contact_rows.hpp"
#include "narrowphase/box_pairs.hpp"
#include "narrowphase/narrowphase.hpp"
#include "narrowphase/recycling.hpp"
#include "pipeline/stages/collide.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace throng {

namespace {

constexpr std::size_t kGrain = 512;        // pairs a block: some 20 microseconds of work
constexpr std::size_t kOrderGrain = 8192;  // pairs a block
constexpr std::size_t kStrays = 8;         // one contact in so many may be out of order

// A manifold is recycled until a point has moved by this share of the smaller shape's smallest half
// extent, a sixth of the reach of bodies at rest. A third more overlaps no deeper, but saves
// little.
constexpr double kRecycled = 12e-3;

constexpr double kRounding = 1e-7;  // of float, and more

// Whether a pair is worth it: its manifold costs far more than what it was found from.
bool is_recycled(ShapeKind a, ShapeKind b)
{
    using enum ShapeKind;
    return (a == hull && (b == hull || b == box)) || (a == box && b == hull);
}

// After the list of pairs has changed: what each pair knew, at its new place. Whoever is in the
// list no more gives its contact back.
template <class Real>
void follow_pairs(const Pairs& pairs, ConvexContacts<Real>& contacts)
{
    std::swap(contacts.of_pair, contacts.before);
    const std::size_t count = pairs.keys.size();
    contacts.of_pair.resize(count);
    const std::size_t blocks = block_count(count, kOrderGrain);
    contacts.parted.start(blocks + 1);
    const auto let_go = [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (std::size_t i = begin; i < end; ++i)
            if (contacts.before[i].contact != PairState::kApart)
                contacts.parted[block].push_back(contacts.before[i].contact);
    };
    // The first of the old pairs behind whatever pairs before this one knew.
    const auto behind = [&](std::size_t place) {
        while (place > 0 && pairs.from[place - 1] == Pairs::kNewPair) --place;
        return place > 0 ? pairs.from[place - 1] + std::size_t{1} : std::size_t{0};
    };
    for_each_block(count, kOrderGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        std::size_t next = behind(begin);
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t from = pairs.from[i];
            if (from == Pairs::kNewPair) {
                contacts.of_pair[i] = {};
                continue;
            }
            let_go(next, from, block);
            next = from + std::size_t{1};
            contacts.of_pair[i] = contacts.before[from];
        }
    });
    let_go(behind(count), contacts.before.size(), blocks);
    contacts.parted.append_to(contacts.free);
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
    Collision(const Conditions& conditions,
              const Pairs& pairs,
              const Shapes& shapes,
              const Colliders& colliders,
              const Bounds& bounds,
              const Poses& poses,
              const BodyStates& states,
              ConvexContacts<Real>& contacts)
        : pairs_(pairs), shapes_(shapes), colliders_(colliders), bounds_(bounds), poses_(poses),
          states_(states), contacts_(contacts), travels_(!shapes.hulls.empty()),
          scale_(static_cast<Real>(impulse_scale(conditions)))
    { }

    void look_at(std::size_t begin, std::size_t end, std::size_t block)
    {
        static thread_local BoxBatch boxes;  // keeps its room from block to block
        boxes.places.clear();
        boxes.pairs.clear();
        for (std::size_t i = begin; i < end; ++i) {
            const PairKey key = pairs_.keys[i];
            if (known_apart(key, contacts_.of_pair[i])) {
                part(i, block);
                continue;
            }
            const NearBox &near_a = bounds_.near[first_of(key)],
                          &near_b = bounds_.near[second_of(key)];
            if (!near_a.overlaps(near_b)) {
                if (travels_) note_apart(i, gap_between(near_a, near_b));
                part(i, block);
                continue;
            }
            const PairPlace pair = place_of(key, colliders_, bounds_);
            if (wants_contact(pair, states_))
                collide_one(i, pair, boxes, block);
            else if (const std::uint32_t place = contacts_.of_pair[i].contact;
                     place != PairState::kApart && scale_ != 1)
                scale_impulses(contacts_.contacts[place], scale_);
        }
        if (!boxes.pairs.empty()) collide_batch(boxes, block);
    }

private:
    // Not even what they have come since they were last looked at brings them within reach.
    bool known_apart(PairKey key, const PairState& state) const
    {
        return travels_ && approach(key) < double{state.apart_until};
    }
    double approach(PairKey key) const
    {
        return contacts_.travels.approach[first_of(key)]
            + contacts_.travels.approach[second_of(key)];
    }

    // The two are further apart than their reach by so much.
    void note_apart(std::size_t i, double beyond_reach)
    {
        const double until = approach(pairs_.keys[i]) + beyond_reach;
        contacts_.of_pair[i].apart_until = static_cast<float>(until - kRounding * std::abs(until));
    }

    void part(std::size_t i, std::size_t block)
    {
        if (contacts_.of_pair[i].contact != PairState::kApart)
            contacts_.parted[block].push_back(static_cast<std::uint32_t>(i));
    }

    void collide_one(std::size_t i, const PairPlace& pair, BoxBatch& boxes, std::size_t block)
    {
        using enum ShapeKind;
        const ShapeKind a = colliders_.shape[pair.a].kind, b = colliders_.shape[pair.b].kind;
        if (a == mesh || b == mesh) return;
        if (a == sphere && b == sphere) return collide_spheres(i, pair, block);
        if constexpr (std::is_same_v<Real, float>)
            if (a == box && b == box) return put_aside(i, pair, boxes);
        if (is_recycled(a, b)) return collide_or_recycle(i, pair, block);
        collide_pair(i, pair, block);
    }

    void collide_spheres(std::size_t i, const PairPlace& pair, std::size_t block)
    {
        const Vec3& center_a = bounds_.placed[pair.a].position;
        const Vec3 between = bounds_.placed[pair.b].position - center_a;
        const double radius_a = shapes_.spheres[colliders_.shape[pair.a].index].radius;
        const double radius_b = shapes_.spheres[colliders_.shape[pair.b].index].radius;
        const double radii = radius_a + radius_b, distance = between.norm();
        if (distance - radii > pair.reach) return part(i, block);
        // One inside the other, centers and all: out by the top, as good a way as any.
        const Vec3 normal = distance > 0 ? Vec3(between / distance) : Vec3(Vec3::UnitZ());
        const Vec3& origin_a = anchor_origin(pair.body_a, pair.body_b, states_, poses_);
        const Vec3& origin_b = anchor_origin(pair.body_b, pair.body_a, states_, poses_);
        Contact<Real> contact;
        contact.normal = normal.cast<Real>();
        contact.between = (origin_a - origin_b).template cast<Real>();
        contact.count = 1;
        contact.points[0].from_a =
            (normal * radius_a + (center_a - origin_a)).template cast<Real>();
        contact.points[0].separation = static_cast<Real>(distance - radii);
        contact.round_a = static_cast<Real>(radius_a);
        contact.round_b = static_cast<Real>(radius_b);
        keep(i, contact, block);
    }

    // Turning, in float: only where b is has to be told in double.
    void put_aside(std::size_t i, const PairPlace& pair, BoxBatch& boxes)
    {
        const Pose &a = bounds_.placed[pair.a], &b = bounds_.placed[pair.b];
        const QuatT<float> back = a.orientation.cast<float>().conjugate();
        const Vec3T<float> offset = (b.position - a.position).cast<float>();
        const auto half = [&](std::uint32_t collider) -> Vec3T<float> {
            return shapes_.boxes[colliders_.shape[collider].index].half_extents.cast<float>();
        };
        boxes.places.push_back(static_cast<std::uint32_t>(i));
        boxes.pairs.push_back(
            box_pair({back * offset, QuatT<float>(back * b.orientation.cast<float>())},
                     half(pair.a), half(pair.b), static_cast<float>(pair.reach)));
    }

    void collide_batch(BoxBatch& boxes, std::size_t block)
    {
        if constexpr (std::is_same_v<Real, float>) {
            if (boxes.manifolds.size() < boxes.pairs.size())
                boxes.manifolds.resize(boxes.pairs.size());
            const auto manifolds = std::span(boxes.manifolds).first(boxes.pairs.size());
            collide_boxes(boxes.pairs, manifolds);
            for (std::size_t k = 0; k < manifolds.size(); ++k) {
                const std::size_t i = boxes.places[k];
                const PairPlace pair = place_of(pairs_.keys[i], colliders_, bounds_);
                take(i, pair, false, manifolds[k], block);
            }
        }
    }

    void collide_pair(std::size_t i, const PairPlace& pair, std::size_t block)
    {
        // A plane goes second: it is seen from the other shape, so that numbers stay small.
        const bool turned = colliders_.shape[pair.a].kind == ShapeKind::plane;
        const std::uint32_t first = turned ? pair.b : pair.a, second = turned ? pair.a : pair.b;
        const Pose seen = pose_seen_from_a(shapes_, colliders_.shape[second], bounds_.placed[first],
                                           bounds_.placed[second]);
        LocalManifold<Real> manifold;
        collide(shapes_, colliders_.shape[first], colliders_.shape[second], rounded<Real>(seen),
                static_cast<Real>(pair.reach), contacts_.of_pair[i].cache, manifold);
        take(i, pair, turned, manifold, block);
    }

    // The same for pairs without planes, but what was found is recycled as long as it will do.
    void collide_or_recycle(std::size_t i, const PairPlace& pair, std::size_t block)
    {
        const ShapeRef a = colliders_.shape[pair.a], b = colliders_.shape[pair.b];
        FoundManifold<Real> found;
        found.b_in_a = rounded<Real>(
            pose_seen_from_a(shapes_, b, bounds_.placed[pair.a], bounds_.placed[pair.b]));
        found.reach = static_cast<Real>(pair.reach);
        PairState& state = contacts_.of_pair[i];
        const bool touched = state.contact != PairState::kApart;
        if (touched
            && recycle(contacts_.found[state.contact], found.b_in_a, found.reach,
                       static_cast<Real>(colliders_.outer_radius[pair.b]), recycled_up_to(pair),
                       found.manifold))
            return take(i, pair, false, found.manifold, block);
        collide(shapes_, a, b, found.b_in_a, found.reach, state.cache, found.manifold);
        take(i, pair, false, found.manifold, block);
        if (found.manifold.count == 0) {
            note_apart(i, double{state.cache.apart} - pair.reach);
            return;
        }
        (touched ? contacts_.found[state.contact] : contacts_.made[block].back().found) = found;
    }

    Real recycled_up_to(const PairPlace& pair) const
    {
        const double least =
            std::min(colliders_.inner_extent[pair.a], colliders_.inner_extent[pair.b]);
        return static_cast<Real>(kRecycled * least);
    }

    void take(std::size_t i,
              const PairPlace& pair,
              bool turned,
              const LocalManifold<Real>& manifold,
              std::size_t block)
    {
        if (manifold.count == 0) return part(i, block);
        const std::uint32_t first = turned ? pair.b : pair.a, second = turned ? pair.a : pair.b;
        const std::uint32_t body_1 = colliders_.body[first], body_2 = colliders_.body[second];
        const Pose& placed = bounds_.placed[first];
        Contact<Real> contact;
        make_contact(manifold, placed, anchor_origin(body_1, body_2, states_, poses_),
                     anchor_origin(body_2, body_1, states_, poses_), contact);
        note_round_sides(shapes_, colliders_.shape[first], colliders_.shape[second], placed,
                         bounds_.placed[second], contact);
        if (turned) turn_round(contact);
        keep(i, contact, block);
    }

    // In the place of the contact that the pair had, with its impulses; or as a new one.
    void keep(std::size_t i, Contact<Real>& contact, std::size_t block)
    {
        const std::uint32_t place = contacts_.of_pair[i].contact;
        if (place == PairState::kApart) {
            contacts_.made[block].push_back({static_cast<std::uint32_t>(i), contact, {}});
            return;
        }
        carry_impulses(contacts_.contacts[place], scale_, contact);
        contacts_.contacts[place] = contact;
    }

    const Pairs& pairs_;
    const Shapes& shapes_;
    const Colliders& colliders_;
    const Bounds& bounds_;
    const Poses& poses_;
    const BodyStates& states_;
    ConvexContacts<Real>& contacts_;
    bool travels_;  // known how far they have come
    Real scale_;
};

// Takes back the places of contacts that ended, then gives places to new ones, in order of pairs.
template <class Real>
void move_in_and_out(std::size_t blocks, bool finds, ConvexContacts<Real>& contacts)
{
    for (std::size_t block = 0; block < blocks; ++block)
        for (const std::uint32_t pair : contacts.parted[block]) {
            contacts.free.push_back(contacts.of_pair[pair].contact);
            contacts.of_pair[pair].contact = PairState::kApart;
        }
    for (std::size_t block = 0; block < blocks; ++block)
        for (const auto& made : contacts.made[block]) {
            ++contacts.strayed;
            std::uint32_t& place = contacts.of_pair[made.pair].contact;
            if (contacts.free.empty()) {
                place = static_cast<std::uint32_t>(contacts.contacts.size());
                contacts.contacts.push_back(made.contact);
                if (finds) contacts.found.push_back(made.found);
                continue;
            }
            place = contacts.free.back();
            contacts.free.pop_back();
            contacts.contacts[place] = made.contact;
            if (finds) contacts.found[place] = made.found;
        }
}

// Contacts into the order of their pairs, once many have taken places anywhere: whoever goes
// through them does so in that order, and would wait for memory at each.
template <class Real>
void put_in_order(ConvexContacts<Real>& contacts)
{
    const std::size_t used = contacts.contacts.size() - contacts.free.size();
    if (contacts.strayed * kStrays <= used) return;
    contacts.strayed = 0;
    auto& states = contacts.of_pair;
    const std::size_t blocks = block_count(states.size(), kOrderGrain);
    std::vector<std::uint32_t>& begin = contacts.begin;
    begin.assign(blocks + 1, 0);
    for_each_block(states.size(), kOrderGrain,
                   [&](std::size_t first, std::size_t end, std::size_t block) {
                       for (std::size_t i = first; i < end; ++i)
                           begin[block + 1] += states[i].contact != PairState::kApart ? 1 : 0;
                   });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    const bool finds = !contacts.found.empty();
    contacts.moved.resize(used);
    contacts.found_moved.resize(finds ? used : 0);
    for_each_block(states.size(), kOrderGrain,
                   [&](std::size_t first, std::size_t end, std::size_t block) {
                       std::uint32_t next = begin[block];
                       for (std::size_t i = first; i < end; ++i) {
                           if (states[i].contact == PairState::kApart) continue;
                           contacts.moved[next] = contacts.contacts[states[i].contact];
                           if (finds)
                               contacts.found_moved[next] = contacts.found[states[i].contact];
                           states[i].contact = next++;
                       }
                   });
    std::swap(contacts.contacts, contacts.moved);
    std::swap(contacts.found, contacts.found_moved);
    contacts.free.clear();
}

}  // namespace

template <class Real>
void collide_convex(const Conditions& conditions,
                    const Pairs& pairs,
                    const Shapes& shapes,
                    const Colliders& colliders,
                    const Bounds& bounds,
                    const Poses& poses,
                    const BodyStates& states,
                    ConvexContacts<Real>& contacts)
{
    if (pairs.changed) follow_pairs(pairs, contacts);
    const std::size_t blocks = block_count(pairs.keys.size(), kGrain);
    contacts.made.start(blocks);
    contacts.parted.start(blocks);
    // Scenes without hulls have nothing to recycle.
    const bool finds = !shapes.hulls.empty();
    contacts.found.resize(finds ? contacts.contacts.size() : 0);
    if (finds)
        follow_colliders(bounds.placed, colliders.outer_radius, bounds.reach, contacts.travels);
    for_each_block(
        pairs.keys.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
            Collision<Real>(conditions, pairs, shapes, colliders, bounds, poses, states, contacts)
                .look_at(begin, end, block);
        });
    move_in_and_out(blocks, finds, contacts);
    put_in_order(contacts);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void collide_convex<Real>(const Conditions&, const Pairs&, const Shapes&,             \
                                       const Colliders&, const Bounds&, const Poses&,              \
                                       const BodyStates&, ConvexContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
