// Set: some of the members of a small enumeration, as bits.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace throng {

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
    constexpr bool empty() const { return bits_ == 0; }
    constexpr bool operator==(const Set&) const = default;

private:
    static constexpr std::uint64_t bit(Member member)
    {
        return std::uint64_t{1} << static_cast<unsigned>(member);
    }
    std::uint64_t bits_ = 0;
};

}  // namespace throng
