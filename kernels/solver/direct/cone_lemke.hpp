// Cone Lemke: an island's contacts with round cones made many-sided, solved for certain.
//
// With friction of several sides the law is a linear complementarity problem. Lemke's method goes
// along the answers of problems that lead from one that is plain to the one asked for, and where
// that way turns back it turns with it; where no point is asked to part it always arrives. What
// goes for an answer by getting nearer, step by step, may be caught where there once was one. It
// takes a table of all rows by all rows, and so long that everything else is tried before.
//
// Source: Stewart and Trinkle, An implicit time-stepping scheme for rigid body dynamics with
//         inelastic collisions and Coulomb friction (1996); Anitescu and Potra (1997); Cottle, Pang
//         and Stone, The Linear Complementarity Problem (1992), section 4.4.
#pragma once

#include "kernels/solver/direct/contact_cones.hpp"

namespace throng {

class ConeLemke {
public:
    explicit ConeLemke(ContactCones& island);

    /// Puts into the cones impulses that lie in them and are off the law by what a side is wide.
    /// False, with the impulses as they were, where the island has too many points for it or
    /// rounding leads nowhere.
    ///
    ///   closer  0: sides of one width, one of them along the friction that the cones hold now;
    ///           above: by how much closer together they stand about there
    bool run(int closer);

private:
    // A row of the table: a point's load; its friction one way; what friction leaves of the load.
    enum class Kind : std::uint8_t { load, friction, rest };
    struct Row {
        std::size_t cone = 0;
        Kind kind = Kind::load;
        ConeVector way{};  // of an impulse of 1
    };
    bool choose_rows(int closer);
    void add_friction(std::size_t at, std::size_t sides, int closer);
    void fill_table();
    void fill_column(std::size_t column);
    bool start();
    std::size_t leaves_first(std::size_t column) const;
    void exchange(std::size_t row, std::size_t column);
    bool pivot();
    void give();
    double& at(std::size_t row, std::size_t column) { return table_[row * width_ + column]; }
    double at(std::size_t row, std::size_t column) const { return table_[row * width_ + column]; }

    ContactCones& island_;
    std::vector<Row> rows_;
    // What each row's basic variable is by those that are 0, the way there, and where all of these
    // are 0, which stands last.
    std::vector<double> table_;  // [rows][width_]
    std::size_t width_ = 0;
    // Variables by number: how far each row is from its bound, then the rows' impulses, then how
    // much of the way there is left.
    std::vector<std::size_t> basic_, zero_;  // [rows], [rows + 1]
    std::vector<BodySix> change_;            // [columns of the island]
    std::vector<ConeVector> speed_;          // [cones]
};

}  // namespace throng
