// Cone augmented Lagrangian: an island's contacts as springs, whose impulses so far are where they
// start from.
//
// However a problem is, with springs it has an answer that Newton's method finds in a few steps;
// taking what they then bear as where they start from, again and again and with ever stiffer ones,
// leads to the answer of rigid contacts. It needs neither a good guess nor rows that are
// independent: points that contradict one another slowly gain impulse, until one of them slides or
// parts.
//
// Source: Alart and Curnier, A mixed formulation for frictional contact problems prone to Newton
//         like solution methods (1991); sweeps in between after Silcowitz, Niebuhr and Erleben,
//         Projected Gauss-Seidel subspace minimization (2010).
#pragma once

#include "kernels/solver/direct/cone_gauss_seidel.hpp"

namespace throng {

class ConeAugmentedLagrangian {
public:
    ConeAugmentedLagrangian(ContactCones& island, BodyMatrix& matrix);

    /// Goes on from the cones' impulses, which are finite; leaves the best impulses met in them and
    /// gives their residual.
    ///
    ///   enough  residual at which it ends
    ///   good    residual with which it is content once it gains no more
    ///   most    factorisations at most; counted down
    double run(double enough, double good, int& most);

private:
    enum class Kind : std::uint8_t { parts, sticks, slides };
    struct State {
        Kind kind = Kind::parts;
        ConeVector start{};         // impulse of the spring at rest
        ConeVector wanted{}, is{};  // its impulse without the law, and by the law
        ConeVector best{};
    };
    // How a try to find where springs of a stiffness come to rest went.
    struct Try {
        bool rests = false;
        int steps = 0;
        double shortest = 1;  // of the steps, as shares of Newton's
    };
    double keep_if_best();
    double stretch(std::span<const BodySix> change);
    ConeWeight weight_of(const State& state, std::size_t rows) const;
    bool factorise();
    double shorten(double missing, double& length);
    Try find_rest(int& most);
    void choose_stiffness(const Try& last);

    ContactCones& island_;
    BodyMatrix& matrix_;
    ConeGaussSeidel gauss_seidel_;
    std::vector<State> states_;                               // [cones]
    std::vector<BodySix> change_, step_, further_, missing_;  // [columns]
    double stiffness_ = 1, best_ = 0;
    int many_ = 0;  // sweeps before a try
    int rested_ = 0,
        due_ = 0;  // tries that came to rest at this stiffness, and wanted for a greater
};

}  // namespace throng
