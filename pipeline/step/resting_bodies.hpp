// Resting bodies: who came to rest by itself while others of its island go on, and what its
// contacts bore on it then. It stands as if it were static, until they bear something else.
//
// What is remembered is of the contacts that a step goes through. As a neighbor comes to rest, too,
// their pair leaves the lists, and what it bears leaves the sum; as the neighbor wakes, both come
// back. So a change of any contact is noticed, its end included, and small ones add up.
#pragma once

#include "kernels/data/contacts.hpp"

#include <vector>

namespace throng {

/// What contacts do to a body in the last substep: N s; N m s about its center. Each contact is
/// rounded to float: sums of few such numbers are exact, whatever their order.
struct BorneImpulse {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();

    void add(const BorneImpulse& other, double sign)
    {
        linear += sign * other.linear;
        angular += sign * other.angular;
    }
};

/// By a contact on its second body, or its first.
template <class Real>
BorneImpulse borne_impulse(const Contact<Real>& contact, bool on_b)
{
    Vec3 linear = Vec3::Zero(), middle = Vec3::Zero();
    Vec3 angular =
        (contact.rolling + contact.torsional_impulse * contact.normal).template cast<double>();
    const auto act = [&](const Vec3& impulse, const Vec3& arm) {
        linear += impulse;
        angular += arm.cross(impulse);
    };
    for (int k = 0; k < contact.count; ++k) {
        const auto& point = contact.points[static_cast<std::size_t>(k)];
        const Vec3 arm = (on_b ? contact.anchor_b(k) : point.anchor_a).template cast<double>();
        middle += arm / contact.count;
        act((point.impulse * contact.normal).template cast<double>(), arm);
    }
    act(contact.friction.template cast<double>(), middle);
    const auto rounded = [&](const Vec3& sum) -> Vec3 {
        return (on_b ? sum : Vec3(-sum)).cast<float>().cast<double>();
    };
    return {rounded(linear), rounded(angular)};
}

/// N s, of all points, whatever their direction.
template <class Real>
double load_of(const Contact<Real>& contact)
{
    Real sum = 0;
    for (int k = 0; k < contact.count; ++k)
        sum += contact.points[static_cast<std::size_t>(k)].impulse;
    return double{sum};
}

///   borne     [bodies] of who rests; of who may soon, as of the last step; may be shorter
///   border    who rests and was touched by what a step goes through, ascending
///   strained  who rests and needed more substeps, and how much: see OverloadedIslands::strain
///   waking    whom the last step's impulses wake, or an edit woke, with who rests within some
///             contacts of it
struct RestingBodies {
    struct Borne {
        BorneImpulse impulse;
        double load = -1;  // N s, of all contacts as it came to rest; below 0: nothing is known
    };
    static constexpr std::uint32_t kFarthest = 4;  // contacts that a great change is felt through
    struct Waking {
        std::uint32_t body = 0, contacts = 0;
    };
    std::vector<Borne> borne;
    std::vector<std::uint32_t> border;
    std::vector<Waking> waking;
    struct Strained {
        std::uint32_t body = 0;
        float strain = 0;
    };
    std::vector<Strained> strained;
    /// now      [bodies] what is borne in this step; nothing between stages
    /// may      [bodies] whether it may come to rest: with all of its island; no between stages
    /// touched  bodies that now has something of
    struct Scratch {
        enum class May : std::uint8_t { no, if_steady, yes };
        std::vector<Borne> now;
        std::vector<May> may;
        std::vector<std::uint32_t> touched, candidates;
    } scratch;

    /// A contact of two bodies comes back among those that a step goes through, or leaves them.
    template <class Real>
    void follow(const Contact<Real>& contact, std::uint32_t a, std::uint32_t b, double sign)
    {
        if (contact.count == 0) return;
        if (a < borne.size()) borne[a].impulse.add(borne_impulse(contact, false), sign);
        if (b < borne.size()) borne[b].impulse.add(borne_impulse(contact, true), sign);
    }
};

}  // namespace throng
