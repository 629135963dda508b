// Group flight: bodies that may meet in this step, carried from touch to touch.
//
// They fly as their integrator has it until two first touch. There impacts change velocities, those
// that rest on one another are held by a joint solve, and what is left of the step goes on.
// Contacts are rigid: those that rest do so at half the tolerance from one another.
#pragma once

#include "kernels/motion/rigid_motion.hpp"
#include "kernels/solve/direct_points.hpp"
#include "narrowphase/impact/first_impact.hpp"
#include "pipeline/step_data.hpp"

#include <map>
#include <span>

namespace throng {

/// What groups are carried by. Each reads and writes its own bodies alone.
///
///   obstacles  colliders of bodies that nothing moves in this step, ascending
///   ways       [bodies] a box round all of a body's way through the step
struct GroupScene {
    const Conditions& conditions;
    const Shapes& shapes;
    const Surfaces& surfaces;
    const PairFilter& filter;
    const Colliders& colliders;
    const BodyStates& states;
    const Masses& masses;
    const Forces& forces;
    Poses& poses;
    Velocities& velocities;
    Flights& flights;
    std::vector<std::uint32_t> obstacles;
    std::vector<Box3> ways;
};

class GroupFlight {
public:
    /// bodies: dynamic ones, ascending
    GroupFlight(GroupScene& scene, std::span<const std::uint32_t> bodies);

    /// Takes the bodies through a step, and tells their ways.
    void run();

    /// Whether the work came to its bound: the bodies wait where they last were apart.
    bool held() const { return held_; }
    /// Of the joint solves, the greatest: see DirectAnswer.
    double residual() const { return residual_; }

private:
    // Where a body is about to be.
    struct End {
        Pose pose;
        Vec3 velocity, spin;
        FlightMemory memory;
        bool flew = true;  // and was not held by a contact
    };
    // Where two bodies touch, or are about to.
    struct Touch {
        PairKey key = 0;
        DirectPoint point;
        double gap = 0, rest_gap = 0, tolerance = 0;  // m
        double restitution = 0;
        double least_speed = 0;  // m/s, slower ones do not bounce
    };
    using Motions = std::vector<DirectBody>;

    void carry(double begin, double span);
    void commit();
    bool fly(double begin, double span);
    void find_pairs(double begin, double span);
    void add_pair(std::uint32_t a, std::uint32_t b);
    FirstImpact look_ahead(double begin, double span);
    bool stay_apart(double time);
    Pose pose_at(std::uint32_t body, double time) const;
    Pose end_of(std::uint32_t body, double time) const;
    double gap_of(PairKey key, const Pose& a, const Pose& b, double reach) const;
    double tolerance_of(PairKey key) const;
    std::int32_t member_of(std::uint32_t body) const;
    Box3 box_of(std::uint32_t collider, const Pose& body) const;

    // Contacts: see group_contacts.cpp.
    void list_touches(double time);
    void list_touches_of(PairKey key, double time);
    std::int32_t seat_of(std::uint32_t body);
    Motions motions(bool ends) const;
    bool strike();
    bool reflect(std::size_t begin, std::size_t end, Motions& bodies);
    bool reflect_in_order(Motions& bodies);
    void grip(Motions& bodies);
    double restitution_of(const Touch& touch) const;
    bool rest(double span);
    void part(double span, const Motions& solved);
    void end_with(const Motions& speeds, const Motions& ways, double span);

    // What contacts are solved by: see group_solve.cpp.
    static void push(DirectPoint& point, Motions& bodies);
    void solve(Motions& bodies, std::vector<DirectPoint>& points);

    GroupScene& scene_;
    std::span<const std::uint32_t> bodies_;
    RigidRule rule_;
    RigidMotion law_;
    IntegratorRoom room_;
    DirectSolver solver_;
    std::vector<End> ends_;  // [bodies]
    std::vector<std::uint32_t>
        seats_;  // bodies: those carried, then others that move by themselves
    std::vector<std::pair<std::uint32_t, Box3>> boxes_;  // of colliders, of the way just ahead
    std::vector<PairKey> pairs_;                         // that may meet on it
    std::vector<Touch> touches_;
    std::vector<std::size_t> resting_;   // touches that may press, of this span
    std::vector<double> struck_;         // [touches] N s, of all impacts of this moment
    std::map<PairKey, double> gap_now_;  // m, of pairs that touch
    std::map<PairKey, int> strikes_;     // in this step
    double residual_ = 0;
    bool held_ = false;
};

}  // namespace throng
