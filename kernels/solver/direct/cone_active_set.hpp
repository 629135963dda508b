// Cone active set: who parts, who sticks and who slides taken as known, the rest is linear.
//
// Near the answer a path's steps come to the end of what numbers of 16 digits can tell; there the
// three kinds are plain, and solving for just them leaves nothing but rounding. From the impulses
// of the step before it is often all that is needed.
#pragma once

#include "kernels/solver/direct/contact_cones.hpp"

namespace throng {

class ConeActiveSet {
public:
    ConeActiveSet(ContactCones& island, BodyMatrix& matrix);

    /// Tells the kinds by the cones' speeds and impulses and works out impulses that hold them.
    /// Points that turn out to pull part, those that close are held, those that stick beyond their
    /// friction slide and those that would slide back stick. Leaves the best impulses met in the
    /// cones and gives their residual, greater than where it began if all fails.
    ///
    ///   most   factorisations at most; counted down
    double run(int& most);

private:
    enum class Kind : std::uint8_t { parts, sticks, slides };
    struct State {
        Kind kind = Kind::parts;
        ConeVector way{};      // of sliding, of length 1
        double stiffness = 0;  // impulse over speed across that way
        ConeVector pull{}, best{};
    };
    std::size_t held(std::size_t cone) const;
    ConeVector way_of(const ContactCone& cone) const;
    void tell_kinds();
    void look();
    void sort_out();
    ConeVector answer(std::size_t at, const ConeVector& change) const;
    bool factorise();
    void solve_once();

    ContactCones& island_;
    BodyMatrix& matrix_;
    std::vector<State> states_;           // [cones]
    std::vector<BodySix> change_, step_;  // [columns]
};

}  // namespace throng
