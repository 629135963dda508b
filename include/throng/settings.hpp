// Settings: every tunable of a step, with its default, unit and purpose.
//
// Those that trade accuracy for time are dials: dials.hpp gives each its name for scene files and
// the command line.
#pragma once

#include <cstdint>

namespace throng {

enum class Precision : std::uint8_t { float_, double_ };
/// auto_: splitting for what forces act on, something cheaper for what only falls.
enum class Integrator : std::uint8_t { auto_, semi_implicit, euler, midpoint, splitting, rk4 };
/// How an orientation is written down and turned on.
enum class Rotation : std::uint8_t {
    quaternion,
    rotation_vector,
    matrix,
    quaternion_euler,
    matrix_euler,
    matrix_euler_repaired
};
enum class Gyroscopic : std::uint8_t { implicit, explicit_, off };
enum class BroadPhase : std::uint8_t { auto_, embree, grid, sweep, all_pairs };
enum class NarrowPhase : std::uint8_t { auto_, gjk, sat, chung_wang, clip_volume, containment };
/// With how much of its speed a method of the narrow phase runs.
enum class MethodStart : std::uint8_t {
    cached,  // from what the pair remembers
    cold,    // as if it remembered nothing
    plain,   // without its accelerations: the answer sheet
};
enum class BoundsFilter : std::uint8_t { none, sphere, k_dop_14, k_dop_6, k_dop_18, k_dop_26 };
/// What the nodes of a static mesh's tree are bounded by.
enum class MeshTree : std::uint8_t { boxes, k_dop_14, k_dop_18, k_dop_26 };
enum class NonConvex : std::uint8_t { voxels, parts, spheres, depth_image, hull };
enum class Response : std::uint8_t { impulse, penalty, kinematic };
enum class Solver : std::uint8_t { soft_step, pgs, direct };
enum class Overlap : std::uint8_t { allow, back_up, subdivide };
/// How the time of impact is found.
enum class ToiMethod : std::uint8_t {
    newton,        // towards where the tangent meets the level
    bisection,     // by halves
    conservative,  // conservative advancement: as far as the greatest speed of approach allows
};
enum class ImpactLaw : std::uint8_t { sequential, simultaneous };
enum class FrictionAt : std::uint8_t { manifold, points };
enum class Escalation : std::uint8_t { auto_, off };
enum class EffectChoice : std::uint8_t { called, auto_ };
enum class FrictionCone : std::uint8_t { cone, pyramid };

struct Settings {
    double dt = 1.0 / 60;  // s, the step
    int substeps = 4;      // they divide dt
    int iterations = 0;    // solver iterations a substep; 0: the solver's own default

    // Relaxing iterations a substep of soft_step, after bodies have moved. 0: auto, see
    // relax_iterations().
    int relax_iterations = 0;

    // Stiffness of contacts. 0: auto, 0.25 of the substep's rate for manifolds of four points,
    // more for fewer, 0.5 for one (stiffer does not come to rest). contact_rate > 0: that factor
    // for all. contact_hertz > 0: a fixed rate in Hz, whatever the substep.
    double contact_rate = 0;
    double contact_hertz = 0;
    double push_limit = 3;  // m/s, fastest that overlap is pushed apart

    Precision precision = Precision::float_;
    Integrator integrator = Integrator::auto_;
    Rotation rotation = Rotation::quaternion;
    Gyroscopic gyroscopic = Gyroscopic::implicit;
    BroadPhase broadphase = BroadPhase::auto_;
    NarrowPhase narrowphase = NarrowPhase::auto_;
    MethodStart method_start = MethodStart::cached;
    BoundsFilter bounds_filter = BoundsFilter::none;
    MeshTree mesh_tree = MeshTree::boxes;  // of meshes made from then on
    // How moving shapes that are not convex are taken, where they do not say so themselves; 0: set
    // by the shape's size.
    NonConvex nonconvex = NonConvex::voxels;
    double voxel_size = 0;     // m
    int image_resolution = 0;  // rays along the longest side of the smaller of two shapes
    int sphere_levels = 0;     // of the sphere tree, from 1
    int max_parts = 0;         // convex parts of a shape
    Response response = Response::impulse;
    // Of each point of a contact; below 0: from mass and dt.
    double penalty_stiffness = -1;  // N/m
    double penalty_damping = -1;    // N s/m
    Solver solver = Solver::soft_step;
    int direct_limit = 500;  // contacts or bodies of the greatest island that is solved directly
    Escalation escalation = Escalation::auto_;  // of islands too stubborn for the solver
    ImpactLaw impact_law = ImpactLaw::sequential;
    FrictionAt friction_at = FrictionAt::manifold;
    FrictionCone friction_cone = FrictionCone::cone;
    Overlap overlap = Overlap::allow;
    int halvings = 0;  // of a substep at most, by overlap subdivide; 0: 12
    ToiMethod toi_method = ToiMethod::newton;
    double toi_tolerance = 1e-4;  // of the smallest half extent of the two shapes
    bool sleep = true;
    // Who is quiet rests by itself while others of its island go on, and stands as if it were
    // static until what its contacts bear on it changes by more than this share of it.
    bool partial_rest = false;
    double rest_force = 0.05;
    EffectChoice effects = EffectChoice::called;
    // auto: bodies end no further off than this share of their radius in 0.1 s, root of the mean
    // square, and turned by no more rad, than with all that is left out.
    double effects_error = 0.02;

    // Sleeping: an island rests once all of it stayed slower than this for this long.
    double sleep_speed = 0.02;  // m/s, of any point of the body
    double sleep_time = 0.5;    // s
};

}  // namespace throng
