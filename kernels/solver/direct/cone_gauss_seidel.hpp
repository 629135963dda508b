// Cone Gauss-Seidel: an island's points one after another, again and again.
//
// Each point takes the impulse that the law asks of it while the others keep theirs. Hundreds of
// sweeps cost what one factorisation does; they come near to an answer where a path that goes for
// all at once loses its way, and tell who parts, sticks and slides.
#pragma once

#include "kernels/solver/direct/contact_cones.hpp"

namespace throng {

class ConeGaussSeidel {
public:
    explicit ConeGaussSeidel(ContactCones& island);

    /// Goes on from the cones' impulses, which are in the cones before and after, and puts in the
    /// speeds that they make.
    ///
    /// Source: projected Gauss-Seidel, normals first; Jourdan, Alart and Jean (1998).
    void run(int iterations);

private:
    // How a point answers to itself.
    struct Answer {
        double normal = 0, across = 0;  // impulse that a speed of 1 calls for
        ConeVector by_normal{};         // speed that a normal impulse of 1 makes
    };
    void solve_cone(std::size_t at);

    ContactCones& island_;
    std::vector<Answer> answers_;  // [cones]
    std::vector<BodySix> change_;  // [columns]
};

}  // namespace throng
