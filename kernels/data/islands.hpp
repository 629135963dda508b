// Islands: what can move what. Bodies of different islands cannot touch one another in this step.
#pragma once

#include <cstdint>
#include <vector>

namespace throng {

/// Islands in order of their smallest body; contacts in their own order within each.
///
///   body_begin     [islands + 1]  into bodies: the movable bodies of each, ascending
///   contact_begin  [islands + 1]  into contacts: places in ActiveContacts, ascending
struct Islands {
    std::vector<std::uint32_t> body_begin, bodies;
    std::vector<std::uint32_t> contact_begin, contacts;
    std::vector<std::uint32_t> lone;  // awake dynamic bodies that touch nothing

    std::size_t size() const { return body_begin.empty() ? 0 : body_begin.size() - 1; }
};

}  // namespace throng
