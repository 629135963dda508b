#include "kernels/solver/direct/cone_gauss_seidel.hpp"

namespace throng {

ConeGaussSeidel::ConeGaussSeidel(ContactCones& island)
    : island_(island), answers_(island.cones.size())
{
    for (std::size_t i = 0; i < answers_.size(); ++i) {
        const ContactCone& cone = island.cones[i];
        Answer& answer = answers_[i];
        double greatest = 0;
        for (std::size_t k = 0; k < cone.rows; ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            answer.by_normal[k] =
                cone.of_a.row(row).dot(cone.of_a.row(0)) + cone.of_b.row(row).dot(cone.of_b.row(0));
            // The sum of all rows' own answers is above what any direction across them has.
            if (k > 0)
                greatest += cone.of_a.row(row).squaredNorm() + cone.of_b.row(row).squaredNorm();
        }
        answer.normal = 1 / answer.by_normal[0];
        answer.across = greatest > 0 ? 1 / greatest : 0;
    }
}

void ConeGaussSeidel::solve_cone(std::size_t at)
{
    ContactCone& cone = island_.cones[at];
    const Answer& answer = answers_[at];
    const ConeVector speed = sum(cone.free, island_.seen(cone, change_));
    ConeVector wanted = cone.impulse;
    wanted[0] = std::max(0.0, wanted[0] - speed[0] * answer.normal);
    const double pressed = wanted[0] - cone.impulse[0];
    for (std::size_t k = 1; k < cone.rows; ++k)
        wanted[k] -= (speed[k] + answer.by_normal[k] * pressed) * answer.across;
    const double across = width(wanted);
    if (across > wanted[0])
        for (std::size_t k = 1; k < cone.rows; ++k) wanted[k] *= wanted[0] / across;
    island_.apply_impulse(cone, sum(wanted, cone.impulse, -1), change_);
    cone.impulse = wanted;
}

void ConeGaussSeidel::run(int iterations)
{
    island_.push_all(change_);
    for (int i = 0; i < iterations; ++i)
        for (std::size_t at = 0; at < answers_.size(); ++at) solve_cone(at);
    island_.push_all(change_);
    for (ContactCone& cone : island_.cones) {
        cone.speed = sum(cone.free, island_.seen(cone, change_));
        cone.speed[0] += width(cone.speed);
    }
}

}  // namespace throng
