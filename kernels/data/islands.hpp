// Islands: what can move what. Bodies of different islands cannot touch one another in this step.
#pragma once

#include "throng/effects.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace throng {

/// What an island calls for of its solve. Those that share a batch call for the same, so that
/// nobody is put through anything for what others do.
///
///   effects    of kOfIslands
///   carries    somebody turns who takes along what lies on him (see carried_points.hpp)
///   axes_turn  an axis that somebody is symmetric about turns (see axis_turns())
///   swings     contacts may go with their bodies within the step (see turning_arms.hpp)
///   rolls      some rim does, or would if it were held at fewer places
///   on_faces   most contacts have three points or more; told of those that may share a batch
///   on_points  each contact has one point; told of the same
///   driven     it touches what moves by itself
///   alone      it shares its batch with nobody: a pivot or stiff springs tell how all of it is
///              solved, or somebody lies so deep in another that the two may have to part
struct IslandCalls {
    Set<Effect> effects;
    bool carries = false, axes_turn = false, swings = false, rolls = false, on_faces = false,
         on_points = false, driven = false, alone = false;  // to be compared as two numbers

    bool operator==(const IslandCalls& other) const
    {
        using Numbers = std::array<std::uint64_t, 2>;
        return std::bit_cast<Numbers>(*this) == std::bit_cast<Numbers>(other);
    }
    /// Whether sliding sees surfaces that go: see SurfaceVelocityWide.
    bool surfaces_go() const { return carries || axes_turn || effects.has(Effect::drive); }
};

/// Islands in order of their smallest body; or first of what they call for, once that is known.
/// Contacts in their own order within each.
///
///   body_begin     [islands + 1]  into bodies: the movable bodies of each, ascending
///   contact_begin  [islands + 1]  into contacts: places in ActiveContacts, ascending
///   calls          [islands]
///   rolling        bodies whose rims are followed as they roll, and how many contacts each has
struct Islands {
    struct Rolling {
        std::uint32_t body = 0, contacts = 0;
    };
    std::vector<std::uint32_t> body_begin, bodies;
    std::vector<std::uint32_t> contact_begin, contacts;
    std::vector<std::uint32_t> lone;  // awake dynamic bodies that touch nothing
    std::vector<IslandCalls> calls;
    std::vector<Rolling> rolling;
    struct Scratch {
        std::vector<std::uint32_t> body_begin, bodies, contact_begin, contacts;
        std::vector<IslandCalls> calls;
    } scratch;

    std::size_t size() const { return body_begin.empty() ? 0 : body_begin.size() - 1; }
    std::span<const std::uint32_t> bodies_of(std::size_t island) const
    {
        return std::span(bodies).subspan(body_begin[island],
                                         body_begin[island + 1] - body_begin[island]);
    }
    std::span<const std::uint32_t> contacts_of(std::size_t island) const
    {
        return std::span(contacts).subspan(contact_begin[island],
                                           contact_begin[island + 1] - contact_begin[island]);
    }
};

}  // namespace throng
