// Effect census: how many bodies call for what, kept up to date as they come, change and go, so
// that nobody has to go through all of them for what a program did to one.
#pragma once

#include "broadphase/pair_filter.hpp"
#include "kernels/data/bodies.hpp"
#include "kernels/data/forces.hpp"
#include "throng/settings.hpp"

#include <array>
#include <map>
#include <vector>

namespace throng {

/// What a body may call for by itself.
///
///   turns          it spins, or forces turn it
///   turns_touched  whatever touches it does
///   turns_rubbed   whatever touches it does by friction
///   uneven, ...    the same of who has principal moments that differ
enum class Call : std::uint8_t {
    dynamic,
    motion,
    falls,
    fast,
    forces,
    drag,
    pivot,
    mesh_contact,
    voxel_contact,
    sphere_contact,
    image_contact,
    rimmed_seam,
    turns,
    turns_touched,
    turns_rubbed,
    uneven_turns,
    uneven_turns_touched,
    uneven_turns_rubbed
};
inline constexpr std::size_t kCalls = static_cast<std::size_t>(Call::uneven_turns_rubbed) + 1;

/// Everything that decides about the calls of bodies.
struct BodyFacts {
    const Settings& settings;
    const Vec3& gravity;
    const BodyStates& states;
    const Velocities& velocities;
    const Masses& masses;
    const Forces& forces;
    const Shapes& shapes;
    const Colliders& colliders;
    const PairFilter& filter;
};

class EffectCensus {
public:
    /// Filters know groups and masks: bodies of one group and mask are alike.
    using KindKey = std::pair<std::uint32_t, std::uint32_t>;
    struct Kind {
        std::size_t bodies = 0, dynamic = 0;
    };
    struct Material {
        std::size_t colliders = 0, on_dynamic = 0;
    };

    /// A body is new or has changed; or it is removed, and its colliders are as they were.
    void recount(std::uint32_t body, const BodyFacts& facts);
    void count_all(const BodyFacts& facts);
    /// A body is about to be another one; to be recounted once it is.
    void forget(std::uint32_t body, const BodyFacts& facts);

    /// Those of a body, as bits.
    std::uint32_t calls_of(std::uint32_t body) const { return calls_[body]; }
    static constexpr std::uint32_t bit(Call call) { return 1u << static_cast<unsigned>(call); }

    bool any(Call call) const { return counts_[static_cast<std::size_t>(call)] > 0; }
    std::size_t count(Call call) const { return counts_[static_cast<std::size_t>(call)]; }
    /// Bodies that make one of some calls, or several.
    std::size_t count_any(std::initializer_list<Call> calls) const;
    /// The first that calls; kNoBody where nobody does.
    std::uint32_t first(Call call) const;

    const std::map<KindKey, Kind>& kinds() const { return kinds_; }
    /// Whether a body is of a kind.
    static bool is_of(const KindKey& key, std::uint32_t body, const BodyFacts& facts);
    const std::map<std::uint32_t, Material>& materials() const { return materials_; }
    /// Goes up as something comes to be called for, or no longer is.
    std::size_t changes() const { return changes_; }
    /// Two colliders that are not pushed, which may lie flush, or two of one body.
    bool has_seams() const { return unpushed_ > 1; }

private:
    void count(std::uint32_t body, bool in, const BodyFacts& facts);

    std::vector<std::uint32_t> calls_;  // [bodies] bits by Call, and whether it was counted
    std::array<std::size_t, kCalls> counts_ = {};
    std::map<KindKey, Kind> kinds_;
    std::map<std::uint32_t, Material> materials_;
    std::size_t unpushed_ = 0, changes_ = 0;
};

}  // namespace throng
