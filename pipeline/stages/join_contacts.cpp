// Join contacts: who falls flat on many triangles, on his own many shapes or on tiles side by side
// meets one plane.
//
// Bouncing is one event for all that meets there at once. Contact by contact it is none: the first
// throws the body back at its own side alone, and what was flat spins. Resting is one as well: of
// the many points of bodies of several parts each bears the load by turns, and a stack of them
// goes on swaying. So contacts of one normal are solved as one, of four of their points, and
// impulses are given back to where they are kept from step to step.
#include "narrowphase/manifold/contact_points.hpp"
#include "pipeline/contacts/contact_lists.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace throng {

namespace {

// Cosine beyond which two normals are one: a hundredth of a radian, as for what lies flush.
constexpr double kAlike = 0.99995;
// How far points of one plane may be from it: as much of their way from one another, as two sides
// may lean, or of the lesser body's half extent.
constexpr double kLevel = 0.01;
constexpr std::uint64_t kAlone = std::numeric_limits<std::uint64_t>::max();

template <class Real>
class Joining {
public:
    Joining(const BodyStates& states,
            const Colliders& colliders,
            const ConvexContacts<Real>& convex,
            const MeshContacts<Real>& meshes,
            const SolidContacts<Real>& solids,
            ActiveContacts& active,
            JoinedContacts<Real>& joined)
        : states_(states), colliders_(colliders), convex_(convex), meshes_(meshes), solids_(solids),
          active_(active), joined_(joined)
    { }

    void run()
    {
        list_candidates();
        joined_.scratch.joined.assign(active_.entries.size(), 0);
        const std::span<const Candidate> all(joined_.scratch.candidates);
        for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
            while (end < all.size() && all[end].pair == all[begin].pair) ++end;
            if (end - begin > 1) join_alike(all.subspan(begin, end - begin));
        }
        if (!joined_.contacts.empty()) drop_sources();
    }

private:
    using Entry = ActiveContacts::Entry;
    using Candidate = typename JoinedContacts<Real>::Candidate;

    const Contact<Real>& contact_of(const Entry& entry) const
    {
        return throng::contact_of(convex_, meshes_, solids_, std::as_const(joined_), entry);
    }

    bool stands(std::uint32_t body) const { return states_.kind[body] == BodyKind::static_; }

    // Whose contacts may be one: two bodies, or one and all that stands still, seen from one side.
    std::uint64_t pair_of(const Entry& entry) const
    {
        constexpr std::uint32_t kStanding = 0xffffffffu;
        if (entry.list == ContactList::solid) return kAlone;
        // On a mesh whose triangles are all but level what rests keeps the normal of each.
        const bool rests_by_parts = entry.list == ContactList::convex && has_parts(entry);
        if (!(entry.restitution > 0) && !rests_by_parts) return kAlone;
        const std::uint32_t a = stands(entry.body_a) ? kStanding : entry.body_a,
                            b = stands(entry.body_b) ? kStanding : entry.body_b;
        return std::uint64_t{a} << 32 | b;
    }

    bool has_parts(const Entry& entry) const
    {
        return colliders_.count[entry.body_a] > 1 || colliders_.count[entry.body_b] > 1;
    }
    // Two of one shape each meet once.
    bool may_meet_twice(const Entry& entry) const
    {
        return entry.list != ContactList::convex || has_parts(entry);
    }

    // Who of the two is on what stands still, or none.
    std::uint32_t standing_on(const Entry& entry) const
    {
        return stands(entry.body_a) ? entry.body_b : stands(entry.body_b) ? entry.body_a : kNoBody;
    }

    void list_candidates()
    {
        std::vector<Candidate>& candidates = joined_.scratch.candidates;
        std::vector<std::uint8_t>& touches = joined_.scratch.touches;
        candidates.clear();
        touches.resize(colliders_.count.size(), 0);
        const auto for_each_entry = [&](const auto& visit) {
            for (std::uint32_t i = 0; i < active_.entries.size(); ++i)
                if (const std::uint64_t pair = pair_of(active_.entries[i]); pair != kAlone)
                    visit(Candidate{pair, i}, standing_on(active_.entries[i]));
        };
        for_each_entry([&](const Candidate&, std::uint32_t body) {
            if (body != kNoBody && touches[body] < 2) ++touches[body];
        });
        for_each_entry([&](const Candidate& candidate, std::uint32_t body) {
            const bool twice = body != kNoBody ? touches[body] > 1
                                               : may_meet_twice(active_.entries[candidate.entry]);
            if (twice) candidates.push_back(candidate);
        });
        for_each_entry([&](const Candidate&, std::uint32_t body) {
            if (body != kNoBody) touches[body] = 0;
        });
        std::sort(candidates.begin(), candidates.end());
    }

    bool alike(const Entry& x, const Entry& y) const
    {
        if (x.friction != y.friction || x.restitution != y.restitution
            || x.rolling_friction != y.rolling_friction)
            return false;
        const Contact<Real>&one = contact_of(x), &other = contact_of(y);
        return one.round_a == other.round_a && one.round_b == other.round_b
            && double{one.normal.dot(other.normal)} > kAlike
            && level(one, other, static_cast<Real>(std::min(x.extent, y.extent)));
    }

    // Legs may end within the board that they bear, and of a table that lies on its board they are
    // in no plane with it: of points on both levels the four chosen may bear nothing.
    static bool level(const Contact<Real>& one, const Contact<Real>& other, Real extent)
    {
        for (const bool of_b : {false, true}) {
            const auto on_surface = [&](const Contact<Real>& contact, int k) -> Vec3T<Real> {
                const auto& point = contact.points[static_cast<std::size_t>(k)];
                return of_b ? Vec3T<Real>(point.anchor_a + one.normal * point.separation)
                            : point.anchor_a;
            };
            const Vec3T<Real> first = on_surface(one, 0);
            for (int k = 0; k < other.count; ++k) {
                const Vec3T<Real> way = on_surface(other, k) - first;
                if (std::abs(way.dot(one.normal))
                    > static_cast<Real>(kLevel) * std::max(way.norm(), extent))
                    return false;
            }
        }
        return true;
    }

    // Those of one pair, by the first of each plane.
    void join_alike(std::span<const Candidate> of_pair)
    {
        std::vector<std::uint8_t>& taken = joined_.scratch.joined;
        for (std::size_t i = 0; i < of_pair.size(); ++i) {
            if (taken[of_pair[i].entry] != 0) continue;
            Entry& one = active_.entries[of_pair[i].entry];
            const auto first = static_cast<std::uint32_t>(joined_.sources.size());
            joined_.sources.push_back(one);
            for (std::size_t k = i + 1; k < of_pair.size(); ++k) {
                const std::uint32_t at = of_pair[k].entry;
                const Entry& other = active_.entries[at];
                if (taken[at] != 0 || !alike(one, other)) continue;
                taken[at] = 1;
                joined_.sources.push_back(other);
            }
            const auto count = static_cast<std::uint32_t>(joined_.sources.size()) - first;
            if (count > 1)
                make(first, count, one);
            else
                joined_.sources.pop_back();
        }
    }

    // One of sources, in place of the first of them.
    void make(std::uint32_t first, std::uint32_t count, Entry& entry)
    {
        using Point = typename LocalManifold<Real>::Point;
        auto& joined = joined_.contacts.emplace_back();
        joined.first = first;
        joined.count = count;
        Contact<Real>& contact = joined.contact;
        candidates_.clear();
        for (std::uint32_t i = 0; i < count; ++i) {
            const Contact<Real>& source = contact_of(joined_.sources[first + i]);
            if (i == 0) contact.take(source);
            for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(source.count); ++k) {
                const auto& point = source.points[k];
                candidates_.push_back({point.anchor_a + source.normal * (point.separation / 2),
                                       point.separation, i << 2 | k});
            }
            if (i == 0) continue;
            contact.friction += source.friction;
            contact.rolling += source.rolling;
            contact.torsional_impulse += source.torsional_impulse;
            entry.extent = std::min(entry.extent, joined_.sources[first + i].extent);
        }
        LocalManifold<Real> manifold;
        manifold.normal = contact.normal;
        reduce_to_four<Real>(std::span<const Point>(candidates_), manifold);
        contact.count = manifold.count;
        for (std::size_t k = 0; k < static_cast<std::size_t>(manifold.count); ++k) {
            const std::uint32_t feature = manifold.points[k].feature;
            joined.points[k] = {feature >> 2, feature & 3u};
            auto& point = contact.points[k];
            point = contact_of(joined_.sources[first + (feature >> 2)]).points[feature & 3u];
            // It may be drawn to one that is deeper and was left out.
            point.separation = manifold.points[k].separation;
            point.anchor_a = manifold.points[k].position - contact.normal * (point.separation / 2);
        }
        entry.list = ContactList::joined;
        entry.list_index = static_cast<std::uint32_t>(joined_.contacts.size()) - 1;
        entry.points = static_cast<std::uint8_t>(contact.count);
    }

    void drop_sources()
    {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < active_.entries.size(); ++i) {
            if (joined_.scratch.joined[i] != 0) continue;
            if (!active_.materials.empty()) active_.materials[kept] = active_.materials[i];
            active_.entries[kept++] = active_.entries[i];
        }
        active_.entries.resize(kept);
        if (!active_.materials.empty()) active_.materials.resize(kept);
    }

    const BodyStates& states_;
    const Colliders& colliders_;
    const ConvexContacts<Real>& convex_;
    const MeshContacts<Real>& meshes_;
    const SolidContacts<Real>& solids_;
    ActiveContacts& active_;
    JoinedContacts<Real>& joined_;
    std::vector<typename LocalManifold<Real>::Point> candidates_;
};

}  // namespace

template <class Real>
void join_contacts(const StepContext& context,
                   const BodyStates& states,
                   const Colliders& colliders,
                   const ConvexContacts<Real>& convex,
                   const MeshContacts<Real>& meshes,
                   const SolidContacts<Real>& solids,
                   ActiveContacts& active,
                   JoinedContacts<Real>& joined)
{
    joined.contacts.clear();
    joined.sources.clear();
    // Where nothing has a rim, and nobody has several shapes, no two meet twice.
    if (!context.has(Effect::seams) && !context.has(Effect::mesh_contact)) return;
    if (!context.has(Effect::restitution) && !colliders.compounds) return;
    Joining<Real>(states, colliders, convex, meshes, solids, active, joined).run();
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void join_contacts<Real>(const StepContext&, const BodyStates&, const Colliders&,     \
                                      const ConvexContacts<Real>&, const MeshContacts<Real>&,      \
                                      const SolidContacts<Real>&, ActiveContacts&,                 \
                                      JoinedContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
