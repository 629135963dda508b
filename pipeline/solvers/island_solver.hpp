// Island solver: the bodies and touching points of one island as they go through a step together,
// by the direct solver, by penalty forces or by kinematic pushes.
#pragma once

#include "kernels/solver/direct/impacts.hpp"
#include "kernels/solver/turning_arms.hpp"
#include "pipeline/forces/state_dependent_forces.hpp"
#include "pipeline/solvers/solve_island.hpp"
#include "pipeline/step/passes.hpp"

#include <memory>

namespace throng {

/// A body of the island, through the step.
///
///   moved, turned  since the step began
struct IslandBody {
    std::uint32_t body = kNoBody;
    bool dynamic = false, advances = false, precesses = false;
    Vec3 position = Vec3::Zero();         // as the step began
    Quat orientation = Quat::Identity();  // likewise
    Vec3 acceleration = Vec3::Zero(),
         angular_acceleration = Vec3::Zero();  // m/s2, rad/s2: what forces do
    Vec3 moved = Vec3::Zero();
    Quat turned = Quat::Identity();
};

/// Where two bodies of the island meet.
///
///   arms        m, as the step began, of what turns with the body
///   rounds      m, from there along the normal to the surface: round sides do not turn
///   separation  m, as the step began; below 0 where they overlap
struct IslandContact {
    std::uint32_t contact = 0, point = 0;  // place in Layout::contacts; of the contact
    std::int32_t a = -1, b = -1;           // places among the bodies
    Vec3 normal = Vec3::UnitZ();
    Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // m, without the radius of a round side
    double round_a = 0, round_b = 0;
    RollsFlat rolls_flat = RollsFlat::no;
    RoundRim rim;                       // of what rolls there
    Vec3 center_offset = Vec3::Zero();  // m, from b's center of mass to a's
    double separation = 0;
    double restitution = 0;
    double least_speed = 0;  // m/s: who comes in slower rests here
    double extent = 0;       // m, smallest half extent of the lesser shape
    double tolerance = 0;    // m, overlap that is let be
};

/// A touch of somebody driven: by what each side is, or null.
struct IslandWalk {
    std::size_t contact = 0;
    const PrescribedVelocity *by_a = nullptr, *by_b = nullptr;
};

/// J, that rounding may make of what the impulses of points did.
double rounding_of_work(std::span<const DirectPoint> points,
                        std::span<const DirectBody> before,
                        std::span<const DirectBody> after);

class IslandSolver {
public:
    template <class Real>
    IslandSolver(const IslandScene<Real>& scene, const Batch& batch);

    /// Takes the island through one substep.
    void substep(const StepContext& context);
    /// Gives poses, velocities and impulses back.
    template <class Real>
    void finish(const IslandScene<Real>& scene,
                const Batch& batch,
                ContactConstraints<Real>& constraints) const;

    /// The greatest of the solves that hold contacts and bounce them; pushes out of overlap, which
    /// cannot always be had, are none of them.
    double residual() const { return residual_; }
    /// The most parts that penalty forces cut a substep into.
    int cuts() const { return most_cuts_; }

    using IslandPass = Pass<IslandSolver, const StepContext&, double>;
    /// By a response; of impulses those of the direct solver. Each is given the length of the
    /// substep, or of the part of it, s.
    static std::span<const IslandPass> passes_of(Response response);

private:
    template <class Real>
    void take_bodies(const IslandScene<Real>& scene, const Slice& slice);
    template <class Real>
    void take_forces(const IslandScene<Real>& scene, const Slice& slice);
    void find_least_speeds(const StepContext& context);
    template <class Real>
    void take_contact(const IslandScene<Real>& scene, const Slice& slice, std::uint32_t place);
    template <class Real>
    void give_states(const IslandScene<Real>& scene,
                     const Slice& slice,
                     ContactConstraints<Real>& constraints) const;
    template <class Real>
    void give_impulses(std::size_t first, Contact<Real>& contact) const;
    std::int32_t
    index_of(const Layout& layout, const Slice& slice, std::int32_t solver_index) const;
    Vec3 arm_now(const Vec3& arm, std::int32_t index, const Vec3& round) const;
    void place_points(double ahead = 0);
    void place_contacts(const StepContext& context, double time);
    void carry_arms(double half, double dt);
    void find_walks();
    void turn_inertias();
    double separation_now(std::size_t at) const;
    Vec3 moved(std::int32_t index) const;
    bool place_rolling(const IslandContact& contact,
                       double ahead,
                       DirectPoint& point,
                       double& separation) const;
    Vec3
    turned_freely(std::size_t at, const Vec3& spin, const StepContext& context, double time) const;
    void move_freely(const StepContext& context, double time);
    double approach(std::size_t at, std::span<const DirectBody> bodies) const;
    // Forces that change as bodies go.
    void update_forced_bodies();
    void move_forced_bodies(std::vector<DirectBody>& bodies) const;
    void begin_state_forces(double time);
    bool end_state_forces();
    void hold_contacts(const StepContext& context, double time);
    void answer_late_forces(const StepContext& context, double time);
    // Energy of stiff springs: see island_energy.cpp.
    struct IslandMotion {
        double kinetic = 0;          // J
        Vec3 common = Vec3::Zero();  // m/s, of their center of mass; 0 where something holds them
        double among_them = 0;       // J, beside that
    };
    bool floats() const;
    IslandMotion motion() const;
    double energy_of_springs();
    double energy_of_springs_after(const std::vector<DirectBody>& going, double time);
    void leave_push_to_springs(const StepContext& context, double time);
    void open_energy_limiter(const StepContext& context, double time);
    void close_energy_limiter(const StepContext& context, double time);
    void solve(std::vector<DirectBody>& bodies, std::vector<DirectPoint>& points);
    double ask(std::vector<DirectBody>& bodies, std::vector<DirectPoint>& points);
    void take_back_energy(std::vector<DirectBody>& bodies, std::vector<DirectPoint>& points) const;
    // Impacts: see island_impacts.cpp.
    void apply_restitution(const StepContext& context, double time);
    bool list_touching(double time);
    void add_impact(std::size_t at, double least_speed);
    bool reflect(bool in_order, int most_passes, double least_speed);
    bool gains(double work) const;
    double closing_in(std::size_t at, double time) const;
    bool is_held() const;
    void hold_struck(double time);
    void add_to_struck(const StepContext& context, double time);
    void settle_after_impacts(const StepContext& context, double time, bool ended);

    // Other responses: see penalty_forces.cpp and kinematic_pushes.cpp.
    struct Give;
    void cut_substep(const StepContext& context, double time);
    bool presses(std::size_t at, const StepContext& context, double ahead) const;
    void count_touching(const StepContext& context, double ahead);
    Give give_of(std::size_t at, const SolverParameters& parameters, double time) const;
    void find_unearned(const StepContext& context);
    void throw_back(const StepContext& context, double time);
    void bounce_off(const SolverParameters& parameters, double time);
    void apply_penalty_forces(const StepContext& context, double time);
    void find_held(double time);
    void resist_sliding(std::size_t at, double normal_force, double time, std::uint32_t share);
    void damp_turning(DirectPoint& point, double normal_force, std::uint32_t share);
    void stop_approaches(const StepContext& context, double time);
    void stop_late_approaches(const StepContext& context, double time);
    void push_out(const StepContext& context, double time);
    void stop_approach(std::size_t at);
    void push_out_of(std::size_t at, double most);
    std::pair<double, double> shares_of(const DirectPoint& point) const;
    double mass_of(const DirectPoint& point) const;

    void push_out_of_overlap(const StepContext& context, double time);
    void push_as_far_as_goes();
    void advance_bodies(const StepContext& context, double time);

    std::vector<IslandBody> bodies_;  // those that can be moved, then those that move by themselves
    std::vector<IslandContact> contacts_;
    std::vector<IslandWalk> walks_;
    std::vector<DirectBody> before_, free_, after_, going_;  // [bodies]; going_: how places change
    std::vector<DirectBody> asked_;                          // [bodies] before the last solve
    std::vector<DirectPoint> points_, others_;               // [touches]
    std::vector<double> separations_;                        // [touches] m, now
    std::vector<DirectBody> struck_;                         // [bodies] after impacts
    Impacts impacts_;                                        // of touches that may be struck
    std::vector<DirectPoint> struck_points_;                 // [touches]
    std::vector<double> struck_impulse_;                     // [touches] N s, of all impacts
    std::vector<Sym3> inertia_, inverse_inertia_;            // [bodies] body axes
    std::vector<std::uint32_t> pressed_;                     // [bodies] touches that overlap
    std::vector<double> unearned_;                           // [touches] m, overlap without a push
    std::vector<Vec3> held_;                                 // [touches] N, by friction's springs
    std::unique_ptr<StateDependentForces> state_forces_;     // none: empty
    bool is_fed_ = false;               // may be given energy by more than springs and gravity
    double begun_with_ = 0;             // J, of motion and springs, as the substep began
    double restitution_threshold_ = 0;  // m/s
    Vec3 up_ = Vec3::Zero();            // see driven_contacts.hpp
    bool spins_ = true;                 // contacts see how bodies spin
    double elapsed_ = 0;                // s, since the step began
    DirectSolver solver_;
    SolverParameters parameters_;
    DirectEffort effort_;
    int left_ = 0;                  // steps, of all solves
    int cuts_ = 1, most_cuts_ = 1;  // parts of this substep, of any
    double residual_ = 0;
};

}  // namespace throng
