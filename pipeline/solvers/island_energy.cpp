// Energy that the stiff springs of an island and its contacts make of one another: taken from its
// motion, as energy_limiter.hpp has it, of the whole island at once.
#include "kernels/math/rotation.hpp"
#include "pipeline/forces/energy_limiter.hpp"
#include "pipeline/solvers/island_solver.hpp"

#include <algorithm>
#include <limits>

namespace throng {

namespace {

// Share of what bodies have among them that pushing them apart may draw their springs by, besides
// what gravity gives in a substep to all of them at rest.
constexpr double kAfforded = 0.01;

}  // namespace

// What nothing holds keeps its momentum.
bool IslandSolver::floats() const
{
    const auto stands = [](const IslandContact& at) { return at.a < 0 || at.b < 0; };
    if (std::any_of(contacts_.begin(), contacts_.end(), stands)) return false;
    for (std::size_t i = 0; i < state_forces_->joined().size(); ++i)
        if (state_forces_->springs_of(i).are_tied()) return false;
    return true;
}

IslandSolver::IslandMotion IslandSolver::motion() const
{
    IslandMotion motion;
    Vec3 momentum = Vec3::Zero();
    double mass = 0;
    bool common = floats();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (!bodies_[i].dynamic) continue;
        const DirectBody& body = after_[i];
        const Mat3 inertia =
            in_world_axes(inertia_[i], bodies_[i].turned * bodies_[i].orientation).matrix();
        motion.kinetic += body.spin.dot(inertia * body.spin) / 2;
        if (body.inverse_mass > 0) {
            motion.kinetic += body.velocity.squaredNorm() / (2 * body.inverse_mass);
            mass += 1 / body.inverse_mass;
            momentum += body.velocity / body.inverse_mass;
        } else {
            common = false;
        }
    }
    if (common) motion.common = momentum / mass;
    motion.among_them = motion.kinetic - mass * motion.common.squaredNorm() / 2;
    return motion;
}

double IslandSolver::energy_of_springs()
{
    update_forced_bodies();
    return state_forces_->energy_of_springs();
}

// J, once bodies have gone on for a time at these velocities.
double IslandSolver::energy_of_springs_after(const std::vector<DirectBody>& going, double time)
{
    update_forced_bodies();
    for (ForcedBody& forced : state_forces_->forced_bodies()) {
        forced.pose.position += going[forced.at].velocity * time;
        forced.pose.orientation =
            exponential(going[forced.at].spin * time) * forced.pose.orientation;
    }
    return state_forces_->energy_of_springs();
}

// What pushes bodies out of overlap draws stiff springs, too, by more than they may have to give
// for it: who flies so fast that contacts come late is deep in whom he is joined to. Those stay.
void IslandSolver::leave_push_to_springs(const StepContext& context, double time)
{
    if (!state_forces_ || !state_forces_->stiff()) return;
    const double work =
        energy_of_springs_after(going_, time) - energy_of_springs_after(after_, time);
    double afforded = kAfforded * motion().among_them;
    const Vec3 fall = time * context.gravity;
    for (const DirectBody& body : after_)
        if (body.inverse_mass > 0) afforded += fall.squaredNorm() / (2 * body.inverse_mass);
    if (work > afforded) going_ = after_;
}

void IslandSolver::open_energy_limiter(const StepContext&, double)
{
    if (state_forces_ && state_forces_->stiff())
        begun_with_ = motion().kinetic + energy_of_springs();
}

void IslandSolver::close_energy_limiter(const StepContext& context, double time)
{
    if (!state_forces_ || !state_forces_->stiff() || is_fed_) return;
    for (std::size_t i = 0; i < state_forces_->joined().size(); ++i)
        if (state_forces_->springs_of(i).are_drawn()) return;
    const IslandMotion now = motion();
    double gained = now.kinetic + energy_of_springs() - begun_with_;
    // What gravity gave: half of the velocity before, half after.
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (after_[i].inverse_mass > 0)
            gained -= time * context.gravity.dot(before_[i].velocity + after_[i].velocity)
                / (2 * after_[i].inverse_mass);
    const double share =
        share_kept(gained, now.among_them, now.kinetic * std::numeric_limits<double>::epsilon());
    if (!(share < 1)) return;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (!bodies_[i].dynamic) continue;
        after_[i].velocity = now.common + share * (after_[i].velocity - now.common);
        after_[i].spin *= share;
    }
}

}  // namespace throng
