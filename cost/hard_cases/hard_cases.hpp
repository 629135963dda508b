// Hard cases: the list, and the few shapes they are built from.
#pragma once

#include "cost/hard_cases/cases.hpp"

namespace throng {

// Motion without contact.
void case_free_top(CaseBench& bench);        // H1, free_top.cpp
void case_long_flight(CaseBench& bench);     // H2, free_top.cpp
void case_heavy_top(CaseBench& bench);       // H3, heavy_top.cpp
void case_sleeping_top(CaseBench& bench);    // H4, heavy_top.cpp
void case_high_spin(CaseBench& bench);       // H5, free_top.cpp
void case_rotation_drift(CaseBench& bench);  // H6, free_top.cpp
void case_ballistic(CaseBench& bench);       // H7, ballistic.cpp
void case_spring_limit(CaseBench& bench);    // H46, spring_limit.cpp, and penalty_limit.cpp
void penalty_limit(CaseBench& bench);
void case_springs_in_contact(CaseBench& bench);  // H72, springs_in_contact.cpp
void case_fast_arms(CaseBench& bench);           // H78, fast_arms.cpp

// Every dial beside every other.
void case_dial_pairs(CaseBench& bench);  // pairs, dial_pairs.cpp

void case_stack(CaseBench& bench);        // H8, stack.cpp
void case_mass_ratio(CaseBench& bench);   // H9, mass_ratio.cpp
void case_cards(CaseBench& bench);        // H10, cards_and_arches.cpp
void case_arch(CaseBench& bench);         // H11, cards_and_arches.cpp
void case_sliding(CaseBench& bench);      // H12, sliding.cpp
void case_slope_limit(CaseBench& bench);  // H13, slope_limit.cpp
void case_rolling(CaseBench& bench);      // H14, rolling.cpp
void case_spin_bounce(CaseBench& bench);  // H15, impacts.cpp, and bounces()
void case_cradle(CaseBench& bench);       // H17, impacts.cpp
void case_break(CaseBench& bench);        // H18, impacts.cpp
void case_euler_disk(CaseBench& bench);   // H19, euler_disk.cpp
void case_dominoes(CaseBench& bench);     // H20, dominoes.cpp
void case_painleve(CaseBench& bench);     // H21, slid_rods.cpp
void case_leaning(CaseBench& bench);      // H22, leaning.cpp
void case_struck_rod(CaseBench& bench);   // H23, impacts.cpp, and without_friction.cpp
void motion_without_friction(CaseBench& bench);
void case_turntable(CaseBench& bench);   // H24, turntable.cpp
void case_planks(CaseBench& bench);      // H25, turntable.cpp
void case_invariance(CaseBench& bench);  // H26, invariance.cpp

void case_recovery(CaseBench& bench);  // H47, recovery.cpp
void case_heavy_on_light(CaseBench& bench);
void case_tall_walls(CaseBench& bench);  // H85, tall_walls.cpp

void case_sticks(CaseBench& bench);  // H71, sticks.cpp
// What bounces, by default and by every solver.
void case_closed_room(CaseBench& bench);     // H73, closed_room.cpp
void case_sliding_bounce(CaseBench& bench);  // H77, sliding_bounce.cpp
void case_hits_and_rest(CaseBench& bench);   // H83, hits_and_rest.cpp

// Bodies that are never to overlap: no_overlap.cpp.
void bounces(CaseBench& bench);             // H15 (a), (b)
void case_pile_of_balls(CaseBench& bench);  // H16
void case_backed_up(CaseBench& bench);      // H41
void case_no_overlap(CaseBench& bench);     // H48

// Bodies that go far in a step: fast_bodies.cpp, and the sets of exact_paths.cpp.
void case_bullet_plate(CaseBench& bench);  // H38
void case_spinning_rod(CaseBench& bench);  // H39
void case_fast_pair(CaseBench& bench);     // H40
void case_exact_paths(CaseBench& bench);   // H42

// What convex methods say of two shapes.
void case_broken_pairs(CaseBench& bench);      // H28, convex_pairs.cpp
void case_kissing(CaseBench& bench);           // H29, kissing.cpp
void case_degenerate_hulls(CaseBench& bench);  // H30, degenerate_hulls.cpp
void case_slender(CaseBench& bench);           // H31, slender.cpp
void case_scaled(CaseBench& bench);            // H32, convex_pairs.cpp
void case_far_away(CaseBench& bench);          // H33, stack.cpp, and pairs of convex_pairs.cpp
void far_away_pairs(CaseBench& bench);
void case_near_parallel(CaseBench& bench);  // H34, near_parallel.cpp
void case_concentric(CaseBench& bench);     // H35, concentric.cpp
void case_shared_volume(CaseBench& bench);  // H36, shared_volume.cpp
void case_same_answers(CaseBench& bench);   // H37, same_answers.cpp, and pair_finders.cpp
void compare_pair_finders(CaseBench& bench);

// Shapes that are not convex.
// H43: through_hole.cpp, spikes_and_wedges.cpp and edges_and_cracks.cpp.
void case_through_hole(CaseBench& bench);
void spikes_and_wedges(CaseBench& bench);
void edges_and_cracks(CaseBench& bench);
void case_solid_heap(CaseBench& bench);   // H44, solid_heap.cpp
void case_convergence(CaseBench& bench);  // H45, convergence.cpp

// Scenes a step beside those above: docs/accuracy.md.
void case_thin_falls(CaseBench& bench);     // H74, thin_falls.cpp
void case_slender_bars(CaseBench& bench);   // H75, slender_bars.cpp
void case_round_rims(CaseBench& bench);     // H80, round_rims.cpp
void case_carried_round(CaseBench& bench);  // H84, carried_round.cpp
void case_walkers(CaseBench& bench);        // H86, walkers.cpp
// Bodies on floors of many pieces, and on meshes from either side.
void case_tiles(CaseBench& bench);              // H81, tiles.cpp
void case_both_sides(CaseBench& bench);         // H82, both_sides.cpp
void case_wedged_solids(CaseBench& bench);      // H87, wedged_solids.cpp
void case_crushed(CaseBench& bench);            // H88, crushed.cpp
void case_forced_bounces(CaseBench& bench);     // H89, forced_bounces.cpp
void case_landing_columns(CaseBench& bench);    // H90, landing_columns.cpp
void case_small_columns(CaseBench& bench);      // H91, small_columns.cpp
void case_rest_under_forces(CaseBench& bench);  // H92, rest_under_forces.cpp
void case_rolling_along(CaseBench& bench);      // H93, rolling_along.cpp
void case_pebbles(CaseBench& bench);            // H94, pebbles.cpp
void case_flat_bounces(CaseBench& bench);       // H95, flat_bounces.cpp
void case_attracted_heaps(CaseBench& bench);    // H96, attracted_heaps.cpp
void case_link_chains(CaseBench& bench);        // H97, link_chains.cpp
void case_swings(CaseBench& bench);             // H98, swings.cpp
void case_bent_tracks(CaseBench& bench);        // H99, bent_tracks.cpp
void case_landed_heaps(CaseBench& bench);       // H100, landed_heaps.cpp
void case_near_walls(CaseBench& bench);         // H101, near_walls.cpp
void case_simbenchmark(CaseBench& bench);       // H102, simbenchmark.cpp
void case_step_errors(CaseBench& bench);        // H103, step_errors.cpp
void case_struck_heaps(CaseBench& bench);       // H104, struck_heaps.cpp
void case_leaning_planks(CaseBench& bench);     // H105, leaning_planks.cpp
void case_squeezed(CaseBench& bench);           // H106, squeezed.cpp
void case_dragged_bounces(CaseBench& bench);    // H107, dragged_bounces.cpp
void case_falls_off(CaseBench& bench);          // H108, falls_off.cpp
void case_unlike_stacks(CaseBench& bench);      // H109, unlike_stacks.cpp
void case_pressed_through(CaseBench& bench);    // H110, pressed_through.cpp
void case_thrown_rods(CaseBench& bench);        // H111, thrown_rods.cpp
void case_pressed_balls(CaseBench& bench);      // H112, pressed_balls.cpp
void case_lain_down(CaseBench& bench);          // H113, lain_down.cpp
void case_stacked_parts(CaseBench& bench);      // H114, stacked_parts.cpp
void case_on_a_tip(CaseBench& bench);           // H115, on_a_tip.cpp
void case_thrown_rings(CaseBench& bench);       // H116, thrown_rings.cpp
void case_under_pivots(CaseBench& bench);       // H117, under_pivots.cpp
void case_closing_in(CaseBench& bench);         // H118, closing_in.cpp
void case_wobbling(CaseBench& bench);           // H119, wobbling.cpp
void case_on_ridges(CaseBench& bench);          // H120, on_ridges.cpp
void case_leaning_discs(CaseBench& bench);      // H121, leaning_discs.cpp
void case_piles_of_coins(CaseBench& bench);     // H122, piles_of_coins.cpp
void case_small_structures(CaseBench& bench);   // H123, small_structures.cpp
void case_heavy_on_crowd(CaseBench& bench);     // H124, heavy_on_crowd.cpp
void case_linked_in_flight(CaseBench& bench);   // H125, linked_in_flight.cpp
void case_orders(CaseBench& bench);             // H126, orders.cpp
void case_partial_rest(CaseBench& bench);       // H127, partial_rest.cpp
void case_far_on_ground(CaseBench& bench);      // H128, far_on_ground.cpp
void case_gone_loads(CaseBench& bench);         // H129, gone_loads.cpp

/// Runs a scene: energy that nobody gave, as a share of the greatest in motion; without end where a
/// body was quarantined.
///
///   watch  is shown the world after every step, and how many s have passed
double energy_made(
    CaseBench& bench,
    const Scene& scene,
    double seconds,
    const std::function<void(World&, double)>& watch = [](World&, double) {});

/// How what was built stands in the last tenth of a second that a scene is run for: m/s, of the
/// fastest body; m, of who is furthest from where it was built; m, the deepest overlap.
struct Stands {
    double speed = 0, moved = 0, deep = 0;
};
Stands stand_for(CaseBench& bench, const Scene& scene, double seconds);

/// The settings for exact answers: solver direct, double precision, one substep.
void ask_exactly(Settings& settings);

/// A house of cards: level by level, tents and the flat cards between them. The ground comes first.
Scene card_house(const CaseBench& bench, int levels, double friction);

/// A scene under construction: shapes, materials and bodies by value, ids in order.
class SceneParts {
public:
    explicit SceneParts(Scene scene) : scene_(std::move(scene)) { }

    std::uint32_t material(double friction, double restitution = 0);
    void pair_materials(std::uint32_t a, std::uint32_t b, double friction);
    /// Solid where normal . x < offset.
    std::uint32_t plane(std::uint32_t material, const Vec3& normal, double offset);
    /// A plane through a place, turned as that is, with gravity straight down upon it.
    std::uint32_t level_ground(std::uint32_t material, const Pose& place);
    /// Dynamic bodies of a mass; inertia from the shape.
    std::uint32_t
    box(std::uint32_t material, double mass, const Vec3& half_extents, const Pose& pose);
    std::uint32_t ball(std::uint32_t material, double mass, double radius, const Vec3& at);
    std::uint32_t cylinder(
        std::uint32_t material, double mass, double radius, double half_length, const Pose& pose);
    std::uint32_t hull(std::uint32_t material, double mass, HullShape shape, const Pose& pose);
    /// Any body with a shape of its own.
    std::uint32_t add(decltype(ShapeDescription::shape) shape, BodyDescription body);
    BodyDescription& body(std::uint32_t id) { return scene_.bodies[id]; }
    /// Lets nothing move it, or nothing but its own velocity.
    void hold(std::uint32_t id, Motion motion = Motion::static_);
    Scene& scene() { return scene_; }

private:
    Scene scene_;
};

}  // namespace throng
