#include "kernels/solver/direct/cone_interior_point.hpp"

namespace throng {

namespace {

constexpr double kToBoundary = 0.99;  // of the way that leads out of the cones
constexpr double kShortest = 1e-10;   // a step below which it stands still

}  // namespace

// All impulses alike, and speeds that no contact minds.
ConeInteriorPoint::ConeInteriorPoint(ContactCones& island, BodyMatrix& matrix)
    : island_(island), matrix_(matrix), places_(island.cones.size()),
      change_(island.columns(), BodySix::Zero())
{
    for (std::size_t i = 0; i < places_.size(); ++i) {
        Place& place = places_[i];
        place.speed = island.cones[i].free;
        place.lift = width(place.speed);
        place.speed[0] = std::max(place.speed[0], 0.0) + place.lift + 1;
        place.impulse = {1};
    }
}

void ConeInteriorPoint::show() const
{
    for (std::size_t i = 0; i < places_.size(); ++i) {
        island_.cones[i].speed = places_[i].speed;
        island_.cones[i].impulse = places_[i].impulse;
    }
}

// How far velocities and speeds are from what the impulses make of them.
void ConeInteriorPoint::measure()
{
    missing_.assign(change_.size(), BodySix::Zero());
    for (std::size_t i = 0; i < places_.size(); ++i) {
        Place& place = places_[i];
        const ContactCone& cone = island_.cones[i];
        island_.apply_impulse(cone, place.impulse, missing_);
        place.missing = sum(sum(place.speed, cone.free, -1), island_.seen(cone, change_), -1);
        place.missing[0] -= place.lift;
        place.scaling = ConeScaling(place.speed, place.impulse);
        place.middle = place.scaling.map(place.impulse);
        place.aim = place.middle;
        const double sliding = place.lift > 0 ? 1 / place.lift : 0;
        for (std::size_t k = 1; k < kConeRows; ++k) place.way[k] = place.speed[k] * sliding;
    }
    for (std::size_t i = 0; i < change_.size(); ++i) missing_[i] -= change_[i];
}

// What a change of speed becomes where the height takes part in sliding.
ConeVector ConeInteriorPoint::lifted(const Place& place, ConeVector change)
{
    change[0] += dot(place.way, change);
    return change;
}

bool ConeInteriorPoint::factorise()
{
    matrix_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const ContactCone& cone = island_.cones[i];
        const auto rows = static_cast<Eigen::Index>(cone.rows);
        ConeWeight weight(rows, rows);
        for (std::size_t k = 0; k < cone.rows; ++k) {
            const ConeVector row = places_[i].scaling.inverse_squared(k, cone.rows);
            for (std::size_t j = 0; j < cone.rows; ++j)
                weight(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) =
                    row[j] + row[0] * places_[i].way[j];
        }
        matrix_.add(i, cone.of_a, cone.of_b, weight);
    }
    return matrix_.factorise();
}

// The Newton step after which all that is missing is there and the product is what the aim says.
void ConeInteriorPoint::look_ahead()
{
    step_ = missing_;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const Place& place = places_[i];
        const ConeScaling& scaling = place.scaling;
        const ConeVector missing = lifted(place, place.missing);
        island_.apply_impulse(island_.cones[i],
                              scaling.inverse(sum(scaling.inverse(missing), place.aim, -1)), step_);
    }
    matrix_.solve(step_);
    for (std::size_t i = 0; i < places_.size(); ++i) {
        Place& place = places_[i];
        const ConeScaling& scaling = place.scaling;
        place.step_speed =
            lifted(place, sum(island_.seen(island_.cones[i], step_), place.missing, -1));
        place.step_impulse = scaling.inverse(sum(scaling.inverse(place.step_speed), place.aim));
        for (double& number : place.step_impulse) number = -number;
    }
}

// 0 where a speed or impulse came so near the boundary that rounding left nothing to divide by.
double ConeInteriorPoint::furthest_step() const
{
    double longest = 1;
    for (const Place& place : places_) {
        const double squares =
            dot(place.step_speed, place.step_speed) + dot(place.step_impulse, place.step_impulse);
        if (!std::isfinite(squares)) return 0;
        longest = std::min(longest, longest_step(place.speed, place.step_speed));
        longest = std::min(longest, longest_step(place.impulse, place.step_impulse));
    }
    return longest;
}

double ConeInteriorPoint::product_after(double length) const
{
    double all = 0;
    for (const Place& place : places_)
        all += dot(sum(place.speed, place.step_speed, length),
                   sum(place.impulse, place.step_impulse, length));
    return all / static_cast<double>(places_.size());
}

// From how much the plain step would shrink the product follows how much of it to leave; what the
// step leaves out to second order is put in.
void ConeInteriorPoint::aim_at_center()
{
    const double now = product_after(0);
    const double share = std::clamp(product_after(furthest_step()) / now, 0.0, 1.0);
    const double center = share * share * share * now;
    for (Place& place : places_) {
        const ConeVector second =
            product(place.scaling.inverse(place.step_speed), place.scaling.map(place.step_impulse));
        ConeVector left = sum(product(place.middle, place.middle), second);
        left[0] -= center;
        place.aim = quotient(left, place.middle);
    }
}

bool ConeInteriorPoint::go(double length)
{
    if (!(length > kShortest)) return false;
    for (std::size_t i = 0; i < change_.size(); ++i) change_[i] += step_[i] * length;
    bool sound = true;
    for (Place& place : places_) {
        place.speed = sum(place.speed, place.step_speed, length);
        place.impulse = sum(place.impulse, place.step_impulse, length);
        place.lift = width(place.speed);
        sound = sound && inside(place.speed) > 0 && inside(place.impulse) > 0;
    }
    return sound;
}

bool ConeInteriorPoint::step()
{
    measure();
    if (!factorise()) return false;
    look_ahead();
    aim_at_center();
    look_ahead();
    return go(std::min(1.0, kToBoundary * furthest_step()));
}

}  // namespace throng
