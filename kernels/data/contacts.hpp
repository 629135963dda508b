// Contacts: manifolds as they are kept from step to step, impulses included.
//
// Anchors are relative to the centers of mass and in world axes, so they are small numbers however
// far the scene is from the origin, and float holds them well.
#pragma once

#include "kernels/data/bodies.hpp"
#include "kernels/data/manifolds.hpp"
#include "kernels/data/pairs.hpp"
#include "kernels/data/travels.hpp"
#include "kernels/parallel/compact.hpp"

#include <algorithm>
#include <compare>
#include <vector>

namespace throng {

template <class Real>
struct Contact {
    struct Point {
        Vec3T<Real> anchor_a =
            Vec3T<Real>::Zero();  // m, on the surface of a, from its center of mass
        Real separation = 0;      // m, along the normal to the surface of b
        Real impulse = 0;         // N s along the normal, total over the last substep
        std::uint32_t feature = 0;
    };
    Vec3T<Real> normal = Vec3T<Real>::UnitZ();        // from a to b
    Vec3T<Real> center_offset = Vec3T<Real>::Zero();  // m, from b's center of mass to a's
    Vec3T<Real> friction = Vec3T<Real>::Zero();       // N s on b, at the middle of the points
    Vec3T<Real> rolling = Vec3T<Real>::Zero();        // N m s on b
    Real round_a = 0,
         round_b = 0;  // m, radius about the normal: round sides do not turn with the body
    Real torsional_impulse = 0;  // N m s on b about the normal
    int count = 0;               // of points; next to what is always read, as most have one or two
    std::array<Point, 4> points;

    /// m, of the deepest among the first points; 0 where all are apart.
    Real overlap(std::size_t among) const
    {
        Real deepest = 0;
        for (std::size_t k = 0; k < among; ++k) deepest = std::max(deepest, -points[k].separation);
        return deepest;
    }
    /// The same point on the surface of b, from its center of mass.
    Vec3T<Real> anchor_b(int point) const
    {
        const Point& at = points[static_cast<std::size_t>(point)];
        return at.anchor_a + normal * at.separation + center_offset;
    }
    /// The other without what lies behind its points, which need not be brought into the cache.
    void take(const Contact& other)
    {
        normal = other.normal;
        center_offset = other.center_offset;
        friction = other.friction;
        rolling = other.rolling;
        round_a = other.round_a;
        round_b = other.round_b;
        torsional_impulse = other.torsional_impulse;
        count = other.count;
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
            points[k] = other.points[k];
    }
};

/// What a pair remembers, in four bytes as there are many. `apart` and what does not fit are lost.
class PackedCache {
public:
    PackedCache() = default;
    PackedCache(const PairCache& cache)  // NOLINT(google-explicit-constructor): the same, smaller
    {
        if ((cache.feature_a | cache.feature_b) >= kFeatures || cache.kind >= kKinds) return;
        bits_ = (cache.kind * kFeatures + cache.feature_a) * kFeatures + cache.feature_b;
    }
    operator PairCache() const  // NOLINT(google-explicit-constructor): the same, larger
    {
        return {bits_ / kFeatures % kFeatures, bits_ % kFeatures, bits_ / kFeatures / kFeatures};
    }

private:
    static constexpr std::uint32_t kFeatures = 1u << 15, kKinds = 1u << 2;
    std::uint32_t bits_ = 0;
};

/// What is kept of a pair of convex colliders, touching or not.
struct PairState {
    static constexpr std::uint32_t kApart = 0xffffffffu;
    PackedCache cache;
    std::uint32_t contact = kApart;  // place among the contacts
};

/// The contacts of pairs of convex colliders. A contact keeps its place as long as its pair
/// touches; a place that falls free is taken again.
template <class Real>
struct ConvexContacts {
    struct Made {
        std::uint32_t pair = 0;
        Contact<Real> contact;
    };
    struct Found {
        std::uint32_t pair = 0;
        CachedManifold<Real> found;
    };
    /// Contacts that began, and of those whose pair is recycled, what was found.
    struct Begun {
        std::vector<Made> made;
        std::vector<Found> found;
    };
    /// gathered, found_gathered  contacts and what was found of them, while they are put in order
    /// order                     places that contacts come from
    /// begun, parted             in this step; parted: pairs whose contacts ended
    struct Scratch {
        std::vector<Contact<Real>> gathered;
        std::vector<CachedManifold<Real>> found_gathered;
        std::vector<std::uint32_t> order;
        std::vector<Begun> begun;
        BlockLists<std::uint32_t> parted;
        BlockLists<std::uint32_t> followed_of_block;
    };
    std::vector<PairState> of_pair;  // in the order of the pairs
    std::vector<Contact<Real>> contacts;
    std::vector<std::uint32_t> free;   // places
    std::size_t strayed = 0;           // contacts that began since all were last put in order
    std::vector<std::uint8_t> astray;  // [contacts] 1 for those

    // Empty in scenes where no kind of pair asks for it.
    bool recycles = false;                    // some kind does
    std::vector<CachedManifold<Real>> found;  // [contacts] of pairs of such a kind
    std::vector<float> apart_until;  // [pairs] m, no contact before their approaches come to this
    Travels travels;

    // Pairs that were looked at further than fast bodies are, as they touched already; ascending.
    std::vector<std::uint32_t> followed;

    Scratch scratch;

    /// The contact of a pair, or none.
    const Contact<Real>* at(std::size_t pair) const
    {
        const std::uint32_t place = of_pair[pair].contact;
        return place == PairState::kApart ? nullptr : &contacts[place];
    }
};

/// Contacts of pairs that may have any number of them, in order of pair and part; and what was
/// found of those pairs that are recycled (as CachedManifold).
///
///   part  tells the contacts of a pair apart, from step to step
template <class Real>
struct ManyContacts {
    struct Entry {
        std::uint32_t pair = 0;
        std::uint32_t part = 0;
        Contact<Real> contact;
    };
    /// What was found of a pair, and where its two were then.
    struct Found {
        std::uint32_t pair = 0;
        std::uint32_t first = 0, count = 0;  // among the manifolds
        Pose b_in_a;                         // of the other in the mesh's or solid's frame
        double speculative_margin = 0;       // m
        double apart = 0;                    // m, where nothing was found: see SolidAnswer
        std::size_t left_out = 0;            // touches found in this step that no manifold holds
    };
    struct Finds {
        std::vector<Found> pairs;  // ascending
        std::vector<PartManifold> manifolds;
    };
    struct Scratch {
        BlockLists<Entry> of_block;
        BlockLists<Found> found_of_block;
        BlockLists<PartManifold> manifolds_of_block;
        BlockLists<std::uint32_t> followed_of_block;
    };
    std::vector<Entry> entries, before;
    Finds found, found_before;
    Scratch scratch;
};

/// Contacts of convex colliders with meshes; a part is a triangle.
template <class Real>
struct MeshContacts : ManyContacts<Real> {
    // As of ConvexContacts.
    std::vector<std::uint32_t> followed;
};

/// Contacts of solids with whatever there is; a part is a patch of the two surfaces.
template <class Real>
struct SolidContacts : ManyContacts<Real> {
    std::uint64_t left_out = 0;  // of all pairs
};

/// Which list a contact is kept in.
enum class ContactList : std::uint8_t { convex, mesh, solid, joined };

/// The contacts that this step solves: at least one point, at least one body that can move.
struct ActiveContacts {
    struct Entry {
        std::uint32_t body_a = 0, body_b = 0;
        std::uint32_t list_index = 0;  // in the list
        ContactList list = ContactList::convex;
        std::uint8_t points = 0;
        float friction = 0, restitution = 0, rolling_friction = 0;
        float extent = 0;  // m, the lesser of the smallest half extents of the two shapes
    };
    std::vector<Entry> entries;
    std::vector<Surfaces::MaterialPair> materials;  // [entries] in all digits; empty in float
    /// Of the entries of each block of pairs.
    struct Scratch {
        std::vector<std::size_t> begin, end;
    } scratch;
};

/// Contacts that are solved as one, for this step: see join_contacts. Each keeps what it is made
/// of, which impulses are given back to.
template <class Real>
struct JoinedContacts {
    /// Where a point comes from: which of the sources, and which point of it.
    struct PointSource {
        std::uint32_t source = 0, point = 0;
    };
    struct Joined {
        Contact<Real> contact;
        std::uint32_t first = 0, count = 0;  // of the sources
        std::array<PointSource, 4> points;
    };
    std::vector<Joined> contacts;
    std::vector<ActiveContacts::Entry> sources;
    /// An entry that may be joined, and whose it is: those of one pair may be one.
    struct Candidate {
        std::uint64_t pair = 0;
        std::uint32_t entry = 0;
        // NOLINTNEXTLINE(modernize-use-nullptr): has none
        auto operator<=>(const Candidate&) const = default;
    };
    struct Scratch {
        std::vector<Candidate> candidates;  // ascending
        std::vector<std::uint8_t> joined;   // [entries] 1: it is part of a joined one
        std::vector<std::uint8_t> touches;  // [bodies] of it with what stands, up to two; else 0
    } scratch;
};

}  // namespace throng
