// Event-driven group: bodies that may meet in this step, carried from touch to touch.
//
// They fly as their integrator has it until two touch: to the first moment of that, or to the end
// of a piece of the step that leaves none too deep. There impacts change velocities, those that
// rest on one another are held by a joint solve, and what is left of the step goes on.
// Contacts are rigid: those that rest do so at half the tolerance from one another.
#pragma once

#include "kernels/dynamics/rigid_motion.hpp"
#include "kernels/solver/direct/impacts.hpp"
#include "narrowphase/ccd/first_impact.hpp"
#include "narrowphase/convex/convex_pair.hpp"
#include "narrowphase/dispatch.hpp"
#include "pipeline/step/passes.hpp"
#include "pipeline/step/step_data.hpp"

#include <map>
#include <span>

namespace throng {

/// What groups are carried by. Each reads and writes its own bodies alone.
///
///   obstacles  colliders of bodies that nothing moves in this step, ascending
///   ways       [bodies] a box round all of a body's way through the step
struct GroupScene {
    const StepContext& context;
    const SolverParameters& parameters;
    const ImpactParameters& impacts;
    const Shapes& shapes;
    const Surfaces& surfaces;
    const PairFilter& filter;
    const Colliders& colliders;
    const BodyStates& states;
    const Masses& masses;
    const Forces& forces;
    const PrescribedVelocities& prescribed;
    Poses& poses;
    Velocities& velocities;
    Flights& flights;
    std::vector<std::uint32_t> obstacles;
    std::vector<Box3> ways;

    /// m, round a collider of a body that is there, and what stands for a solid's triangles.
    Box3 box_of(std::uint32_t collider, const Pose& body) const;
    /// m, how far what stands for a solid may reach out of its triangles.
    double beyond_mesh(std::uint32_t collider) const;
    /// m, within which of a collider another may be that touches it.
    double touching_margin(std::uint32_t collider) const;
};

/// What came of a group's step.
///
///   held                     the work came to its bound: the bodies wait where they last were
///                            apart
///   work                     spent on it: see EventDrivenGroup::spend()
///   short_of_work            it came to an end of what it was given
///   residual                 of the joint solves, the greatest: see DirectAnswer
///   deep_pieces              those that no halving was left for: see EventDrivenGroup::subdivide()
///   deepest                  m, by how much any two overlapped at the end of a piece
///   pushes                   N s of all contacts, by body, of the group and of what it met
///   pairs, touching, points  see EventDrivenContacts
struct GroupOutcome {
    bool held = false, short_of_work = false;
    std::uint64_t work = 0;
    double residual = 0;
    std::uint64_t deep_pieces = 0;
    double deepest = 0;
    std::map<std::uint32_t, Vec3> pushes;
    std::size_t pairs = 0, touching = 0, points = 0;
};

class EventDrivenGroup {
public:
    /// bodies     dynamic ones, ascending
    /// most_work  what its step may cost: see spend()
    EventDrivenGroup(GroupScene& scene,
                     std::span<const std::uint32_t> bodies,
                     std::uint64_t most_work);

    /// Takes the bodies through a step, cut at each first touch, and tells their ways.
    void back_up();

    /// The same by halves: a piece of the step at whose end two overlap by more than the tolerance
    /// is done again as two pieces, down to a bound on how often; there it is left as it is, and
    /// told. So none overlap by more than the tolerance and what they close in the shortest piece.
    void subdivide();

    /// Of the step that was taken.
    GroupOutcome outcome() const;

    /// What runs within the two.
    static std::vector<PassRow> passes_of_back_up();
    static std::vector<PassRow> passes_of_subdivide();

private:
    // Where a body is about to be.
    struct End {
        Pose pose;
        Vec3 velocity, spin;
        FlightMemory memory;
        bool flew = true;  // and was not held by a contact
    };
    // Where two bodies touch, or are about to.
    struct GroupContact {
        PairKey key = 0;
        std::uint32_t body_a = 0, body_b = 0;
        DirectPoint point;
        double separation = 0, rest_separation = 0, tolerance = 0;  // m
        double round_a = 0, round_b = 0;                            // m, of sides that do not turn
        double restitution = 0;
        double least_speed = 0;  // m/s, slower ones do not bounce
    };
    // Where two shapes meet: normals from the first to the second, in the first's frame.
    struct PairManifolds {
        std::uint32_t first = 0, second = 0;  // colliders
        Pose at_first;                        // of its shape
        std::vector<LocalManifold<double>> manifolds;
    };
    // What held a point of two that rest.
    struct Press {
        PairKey key = 0;
        Vec3 force, torque;
    };
    using Motions = std::vector<DirectBody>;

    // Work is counted, never timed, so that where it ends does not hang on the machine: one is
    // about what asking how far apart two convex shapes are takes, a microsecond.
    void spend(std::uint64_t work) { outcome_.work += work; }
    bool may_go_on();

    void commit();
    bool fly(double begin, double span);
    bool note_ends(const RigidMotion& law);
    void find_pairs(double begin, double span);
    void add_pair(std::uint32_t a, std::uint32_t b);
    FirstImpact look_ahead(std::span<const PairKey> asked, double begin, double span);
    Pose pose_at(std::uint32_t body, double time) const;
    Pose end_of(std::uint32_t body, double time) const;
    double tolerance_of(PairKey key) const;
    std::int32_t member_of(std::uint32_t body) const;

    // Where two are: see group_collide.cpp.
    void collide_pair(PairKey key, const Pose& a, const Pose& b, double speculative_margin);
    void thin_out(double tolerance);
    static void look_closer(const ConvexPair& pair,
                            double tolerance,
                            double speculative_margin,
                            LocalManifold<double>& found);
    double separation_of(PairKey key, const Pose& a, const Pose& b, double speculative_margin);
    double depth_error(PairKey key) const;

    // Spans up to a touch: see back_up.cpp.
    bool stays_apart(PairKey key, double time);
    bool stay_apart(double begin, double end);
    void foresee(PairKey key, double begin, double end);
    void add_foreseen();

    // Pieces of a step: see subdivide.cpp.
    bool advance_piece(double begin, double span, bool shortest);
    void go_along(PairKey key, double time);
    double time_to_touch(PairKey key, double time);
    bool may_go(std::uint32_t collider, std::map<std::uint32_t, int>& touches) const;
    bool go_to_touch(const std::map<PairKey, double>& touched, double time);
    double depth_of(PairKey key, double end);
    bool may_pass(PairKey key, double begin, double span) const;
    double least_piece(std::uint32_t collider) const;
    bool is_mesh(PairKey key) const;
    bool ends_well(double begin, double span, bool shortest);

    // Contacts: see group_contacts.cpp.
    void list_contacts(double time);
    void list_contacts_of(PairKey key, double time);
    GroupContact contact_of(PairKey key);
    void note_normal(const LocalManifold<double>& found, GroupContact& contact) const;
    Vec3 walk_at(const GroupContact& contact) const;
    void add_contacts(const LocalManifold<double>& found,
                      const Vec3& a,
                      const Vec3& b,
                      GroupContact contact);
    std::int32_t index_of(std::uint32_t body);
    Motions motions(bool ends) const;
    bool resolve_impacts();
    void settle_impacts();
    bool leave_as_reflected(std::vector<DirectPoint>& points, Motions& bodies);
    void apply_friction(Motions& bodies, bool ended);
    double restitution_of(const GroupContact& contact) const;
    static bool touches(const GroupContact& contact);
    bool bounces(const GroupContact& contact, double speed) const;
    void note_push(const GroupContact& contact, const Vec3& impulse);
    void guess(double span, std::vector<DirectPoint>& points) const;
    void carry(const GroupContact& contact,
               const Motions& bodies,
               double half,
               DirectPoint& point) const;
    bool may_rest(const GroupContact& contact,
                  const Motions& now,
                  const Motions& bodies,
                  double span) const;
    bool take_resting(const Motions& now, const Motions& bodies, double span);
    bool solve_resting(double span);
    void part(double span, const Motions& solved);
    void end_with(const Motions& speeds, const Motions& ways, double span);

    // What contacts are solved by: see group_solve.cpp.
    static void solve_point(DirectPoint& point, Motions& bodies);
    static double worst_miss(const Motions& bodies, const std::vector<DirectPoint>& points);
    static double fastest_at(const Motions& bodies, const std::vector<DirectPoint>& points);
    static void solve_points(Motions& bodies, std::vector<DirectPoint>& points);
    void solve(Motions& bodies, std::vector<DirectPoint>& points);

    GroupScene& scene_;
    std::span<const std::uint32_t> bodies_;
    std::uint64_t most_work_ = 0;
    RigidRule rule_;
    RigidMotion law_;
    IntegratorScratch scratch_;
    DirectSolver solver_;
    std::vector<End> ends_;  // [bodies]
    std::vector<std::uint32_t>
        members_;  // bodies: those carried, then others that move by themselves
    std::vector<std::pair<std::uint32_t, Box3>> boxes_;  // of colliders, of the way just ahead
    std::vector<PairKey> pairs_;                         // that may meet on it
    PairManifolds manifolds_;                            // by the last call of separation_of()
    std::vector<PartManifold> triangles_;                // scratch
    std::vector<GroupContact> contacts_;
    std::vector<GroupContact> foreseen_;        // of ways from here that ended too near
    std::vector<std::size_t> resting_;          // touches that may press, of this span
    std::vector<DirectPoint> pressed_;          // [resting_] with the impulses of this span
    std::vector<Press> pressing_;               // by pair, of the last span that held any
    Impacts impacts_;                           // of this moment
    std::vector<double> struck_;                // [touches] N s, of all impacts of this moment
    std::map<PairKey, double> separation_now_;  // m, of pairs that touch
    std::map<PairKey, int> impact_counts_;      // in this step
    std::map<PairKey, int> too_deep_;  // shortest pieces that they ended so, in this substep
    GroupOutcome outcome_;
};

}  // namespace throng
