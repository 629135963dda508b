#include "kernels/solver/direct/impacts.hpp"

namespace throng {

// Gives those that close among the points from `begin` to before `end` back their share of what
// stops them. False if none does.
bool Impacts::reflect(std::size_t begin,
                      std::size_t end,
                      std::vector<DirectBody>& bodies,
                      const Solve& solve)
{
    hits_.clear();
    struck_.clear();
    speeds_.clear();
    shares_.clear();
    for (std::size_t i = begin; i < end; ++i) {
        const double speed = relative_normal_velocity(points[i].point, bodies);
        if (!(speed < -points[i].least_speed)) continue;
        DirectPoint point = points[i].point;
        point.friction = point.rolling = point.least = 0;
        point.impulse = point.torque = Vec3::Zero();
        hits_.push_back(i);
        struck_.push_back(point);
        speeds_.push_back(-speed);
        shares_.push_back(points[i].restitution);
    }
    if (hits_.empty()) return false;
    if (hits_.size() == 1 && bounce_one(bodies)) return true;
    stopped_ = bodies;
    solve(stopped_, struck_);
    const double twice = 1 + shared_restitution(struck_, speeds_, shares_);
    mirror(stopped_, twice, bodies);
    for (std::size_t k = 0; k < hits_.size(); ++k)
        points[hits_[k]].impulse += struck_[k].normal.dot(struck_[k].impulse) * twice;
    return true;
}

// One that closes alone takes no solve. False where it cannot be moved along its normal.
bool Impacts::bounce_one(std::vector<DirectBody>& bodies)
{
    const DirectPoint& point = struck_.front();
    const double inverse_mass = inverse_mass_along(point, point.normal, bodies);
    if (!(inverse_mass > 0)) return false;
    const double impulse = (1 + shares_.front()) * speeds_.front() / inverse_mass;
    apply_impulse(point, point.normal * impulse, bodies);
    points[hits_.front()].impulse += impulse;
    return true;
}

bool Impacts::pass(bool in_order, std::vector<DirectBody>& bodies, const Solve& solve)
{
    if (!in_order) return reflect(0, points.size(), bodies, solve);
    bool any = false;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        while (end < points.size() && points[end].pair == points[begin].pair) ++end;
        any = reflect(begin, end, bodies, solve) || any;
    }
    return any;
}

}  // namespace throng
