// Gather contacts: all kinds into one order, each by pair: convex ones, those on meshes, those of
// solids.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <numeric>

namespace throng {

namespace {

constexpr std::size_t kGrain = 2048;  // pairs a block: some 10 microseconds of work

// What two materials do to one another. Most contacts of a scene are of the same two.
class PairMaterials {
public:
    explicit PairMaterials(const Surfaces& surfaces) : surfaces_(surfaces) { }

    const Surfaces::MaterialPair& of(std::uint32_t a, std::uint32_t b)
    {
        if (a != a_ || b != b_) last_ = surfaces_.between(a_ = a, b_ = b);
        return last_;
    }

private:
    const Surfaces& surfaces_;
    std::uint32_t a_ = kNoBody, b_ = kNoBody;
    Surfaces::MaterialPair last_;
};

// One call of the stage.
template <class Real>
class Gathering {
public:
    Gathering(const Pairs& pairs,
              const Colliders& colliders,
              const Surfaces& surfaces,
              const BodyStates& states,
              ActiveContacts& active)
        : pairs_(pairs), colliders_(colliders), surfaces_(surfaces), states_(states),
          active_(active)
    { }

    void gather(const ConvexContacts<Real>& convex)
    {
        make_places(convex.of_pair);
        for_each_block(convex.of_pair.size(), kGrain, [&](auto begin, auto end, auto block) {
            PairMaterials pair_materials(surfaces_);
            std::size_t at = active_.scratch.begin[block];
            Surfaces::MaterialPair materials;
            for (std::size_t i = begin; i < end; ++i)
                if (const Contact<Real>* contact = convex.at(i); contact && contact->count > 0)
                    at += take(i, *contact, convex.of_pair[i].contact, ContactList::convex,
                               pair_materials, active_.entries[at],
                               kInAllDigits ? active_.materials[at] : materials)
                        ? 1
                        : 0;
            active_.scratch.end[block] = at;
        });
        join_places();
    }

    void gather(const ManyContacts<Real>& contacts, ContactList list)
    {
        PairMaterials pair_materials(surfaces_);
        for (std::size_t i = 0; i < contacts.entries.size(); ++i) {
            const auto& [pair, part, contact] = contacts.entries[i];
            ActiveContacts::Entry entry;
            Surfaces::MaterialPair materials;
            if (contact.count == 0
                || !take(pair, contact, i, list, pair_materials, entry, materials))
                continue;
            active_.entries.push_back(entry);
            if (kInAllDigits) active_.materials.push_back(materials);
        }
    }

private:
    static constexpr bool kInAllDigits = sizeof(Real) == 8;

    // Each block of pairs gets places for all its contacts.
    void make_places(const std::vector<PairState>& of_pair)
    {
        const std::size_t blocks = block_count(of_pair.size(), kGrain);
        active_.scratch.begin.assign(blocks + 1, 0);
        active_.scratch.end.resize(blocks);
        for_each_block(of_pair.size(), kGrain, [&](auto begin, auto end, auto block) {
            std::size_t touching = 0;
            for (std::size_t i = begin; i < end; ++i)
                touching += of_pair[i].contact != PairState::kApart ? 1 : 0;
            active_.scratch.begin[block + 1] = touching;
        });
        std::partial_sum(active_.scratch.begin.begin(), active_.scratch.begin.end(),
                         active_.scratch.begin.begin());
        resize_closely(active_.entries, active_.scratch.begin.back());
        if (kInAllDigits) active_.materials.resize(active_.entries.size());
    }

    // Contacts of sleepers left some places free.
    void join_places()
    {
        const auto join = [&](auto& list, std::size_t begin, std::size_t end, std::size_t to) {
            const auto place = [&](std::size_t at) {
                return list.begin() + static_cast<std::ptrdiff_t>(at);
            };
            std::copy(place(begin), place(end), place(to));
        };
        std::size_t size = 0;
        for (std::size_t block = 0; block < active_.scratch.end.size(); ++block) {
            const std::size_t begin = active_.scratch.begin[block],
                              end = active_.scratch.end[block];
            if (begin != size) join(active_.entries, begin, end, size);
            if (kInAllDigits && begin != size) join(active_.materials, begin, end, size);
            size += end - begin;
        }
        active_.entries.resize(size);
        if (kInAllDigits) active_.materials.resize(size);
    }

    // False where nobody can be pushed.
    bool take(std::size_t pair,
              const Contact<Real>& contact,
              std::size_t list_index,
              ContactList list,
              PairMaterials& pair_materials,
              ActiveContacts::Entry& entry,
              Surfaces::MaterialPair& in_all_digits) const
    {
        const std::uint32_t a = first_of(pairs_.keys[pair]), b = second_of(pairs_.keys[pair]);
        const std::uint32_t body_a = colliders_.body[a], body_b = colliders_.body[b];
        if (!states_.movable(body_a) && !states_.movable(body_b)) return false;
        const auto& materials = pair_materials.of(colliders_.material[a], colliders_.material[b]);
        if (kInAllDigits) in_all_digits = materials;
        const double extent = std::min(colliders_.inner_extent[a], colliders_.inner_extent[b]);
        entry = {body_a,
                 body_b,
                 static_cast<std::uint32_t>(list_index),
                 list,
                 static_cast<std::uint8_t>(contact.count),
                 static_cast<float>(materials.friction),
                 static_cast<float>(materials.restitution),
                 static_cast<float>(materials.rolling_friction),
                 static_cast<float>(extent)};
        return true;
    }

    const Pairs& pairs_;
    const Colliders& colliders_;
    const Surfaces& surfaces_;
    const BodyStates& states_;
    ActiveContacts& active_;
};

}  // namespace

template <class Real>
void gather_contacts(const Pairs& pairs,
                     const Colliders& colliders,
                     const Surfaces& surfaces,
                     const BodyStates& states,
                     const ConvexContacts<Real>& convex,
                     const MeshContacts<Real>& meshes,
                     const SolidContacts<Real>& solids,
                     ActiveContacts& active)
{
    Gathering<Real> gathering(pairs, colliders, surfaces, states, active);
    gathering.gather(convex);
    gathering.gather(meshes, ContactList::mesh);
    gathering.gather(solids, ContactList::solid);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void gather_contacts<Real>(const Pairs&, const Colliders&, const Surfaces&,           \
                                        const BodyStates&, const ConvexContacts<Real>&,            \
                                        const MeshContacts<Real>&, const SolidContacts<Real>&,     \
                                        ActiveContacts&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
