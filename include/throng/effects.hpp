// Effects: what a step may have to simulate, and what of it a scene calls for.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace throng {

/// Some of the members of a small enumeration, as bits.
template <class Member>
class Set {
public:
    constexpr Set() = default;
    constexpr Set(std::initializer_list<Member> members)
    {
        for (const Member member : members) add(member);
    }
    constexpr void add(Member member) { bits_ |= bit(member); }
    constexpr void remove(Member member) { bits_ &= ~bit(member); }
    constexpr bool has(Member member) const { return (bits_ & bit(member)) != 0; }
    constexpr bool meets(Set other) const { return (bits_ & other.bits_) != 0; }
    constexpr Set operator|(Set other) const { return Set(bits_ | other.bits_); }
    constexpr Set operator&(Set other) const { return Set(bits_ & other.bits_); }
    constexpr Set without(Set other) const { return Set(bits_ & ~other.bits_); }
    constexpr bool empty() const { return bits_ == 0; }
    constexpr bool operator==(const Set&) const = default;

private:
    explicit constexpr Set(std::uint64_t bits) : bits_(bits) { }
    static constexpr std::uint64_t bit(Member member)
    {
        return std::uint64_t{1} << static_cast<unsigned>(member);
    }
    std::uint64_t bits_ = 0;
};

enum class Effect : std::uint8_t {
    motion,  // some body can move at all
    gravity,
    forces,
    drive,
    rotation,
    gyroscopic,
    contact,
    no_overlap,
    little_overlap,
    friction,
    rolling_friction,
    restitution,
    fast_motion,
    mesh_contact,
    voxel_contact,
    sphere_contact,
    image_contact,
    seams,  // between colliders that do not move against one another
    springs,
    attractors,
    wind,
    drag,
    pivot,
    sleeping,
    escalation,
    events,   // a program listens
    sensors,  // and somebody is one
};
/// What calls for contacts of solids, each by its way.
inline constexpr Set<Effect> kSolidContact = {Effect::voxel_contact, Effect::sphere_contact,
                                              Effect::image_contact};
/// Bodies carried from touch to touch, in place of contact.
inline constexpr Set<Effect> kEventDriven = {Effect::no_overlap, Effect::little_overlap};
/// What acts on bodies besides gravity and contacts.
inline constexpr Set<Effect> kForces = {Effect::forces, Effect::springs, Effect::attractors,
                                        Effect::wind,   Effect::drag,    Effect::pivot};
/// Of those, what changes as bodies go through a step.
inline constexpr Set<Effect> kFollowBodies = {Effect::forces, Effect::springs, Effect::attractors,
                                              Effect::drag, Effect::pivot};
/// What each island calls for by itself, or does not: see IslandCalls.
inline constexpr Set<Effect> kOfIslands =
    kForces | Set<Effect>{Effect::drive,    Effect::rotation,         Effect::gyroscopic,
                          Effect::friction, Effect::rolling_friction, Effect::restitution};
/// What a world can leave out while its bodies call for it: see World::leave_out().
inline constexpr Set<Effect> kLeftOutByWorld =
    kSolidContact | Set<Effect>{Effect::gyroscopic, Effect::fast_motion, Effect::mesh_contact,
                                Effect::seams,      Effect::sleeping,    Effect::escalation};
inline constexpr int kEffects = static_cast<int>(Effect::sensors) + 1;

std::string_view name_of(Effect effect);

/// The effects of a scene, each with the first that calls for it.
struct Effects {
    Set<Effect> on;
    std::array<std::string, kEffects> cause;

    const std::string& cause_of(Effect effect) const
    {
        return cause[static_cast<std::size_t>(effect)];
    }
};

}  // namespace throng
