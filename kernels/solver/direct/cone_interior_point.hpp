// Cone interior point: interior point steps towards the impulses of an island.
//
// Every cone's speed and impulse stay inside it and their product shrinks evenly, along a path
// through the middle of all answers. To the normal speed the length of the sliding speed is added,
// without which a cone program would lift what slides: a step follows how that changes, which
// nearly always leads there in few.
#pragma once

#include "kernels/solver/direct/contact_cones.hpp"

namespace throng {

class ConeInteriorPoint {
public:
    ConeInteriorPoint(ContactCones& island, BodyMatrix& matrix);

    /// One step: Mehrotra's, of which the first half looks how far it could go. False where
    /// rounding lets it go no further.
    bool step();
    /// Puts the speeds and impulses reached into the cones.
    void show() const;

private:
    struct Place {
        ConeVector speed{}, impulse{};
        double lift = 0;       // the sliding speed, by which the height is above the normal speed
        ConeVector way{};      // of sliding, of length 1
        ConeVector missing{};  // speed less what the bodies' velocities make of it
        ConeScaling scaling;
        ConeVector middle{};  // speed and impulse, scaled to one and the same
        ConeVector aim{};     // what is left of their product, over the middle
        ConeVector step_speed{}, step_impulse{};
    };
    static ConeVector lifted(const Place& place, ConeVector change);
    void measure();
    bool factorise();
    void look_ahead();
    void aim_at_center();
    double furthest_step() const;
    double product_after(double length) const;
    bool go(double length);

    ContactCones& island_;
    BodyMatrix& matrix_;
    std::vector<Place> places_;                     // [cones]
    std::vector<BodySix> change_, missing_, step_;  // [columns]
};

}  // namespace throng
