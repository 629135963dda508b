// World state: what a world keeps, for the parts of the pipeline that work on it.
#pragma once

#include "kernels/geometry/mass.hpp"
#include "kernels/parallel/blocks.hpp"
#include "pipeline/step/step_graph.hpp"
#include "pipeline/world/door.hpp"
#include "pipeline/world/scene_fields.hpp"
#include "throng/world.hpp"

#include <map>
#include <unordered_map>
#include <variant>

namespace throng {

/// A step over one kind of number. What makes and destroys its data is long: one file
/// compiles it, and no other asks whether it could be copied.
template <class Real>
struct Step {
    using Number = Real;
    Step();
    ~Step();
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

    StepData<Real> data;
    std::unique_ptr<StepGraph<Real>> graph;
};
extern template struct Step<float>;
extern template struct Step<double>;

/// Where the parts of a stated shape went.
struct PlacedShape {
    std::vector<ShapeRef> parts;
    std::vector<Pose> poses;  // in the frame of the shape
    MassProperties mass;      // of unit density
};

class QueryScene;

/// Whose a collider is, and which part of it.
struct ColliderOwner {
    BodyId body;
    std::uint32_t part = 0;
};

/// What a body weighs that is not dynamic, for when it is: about its center, body axes.
struct KeptMass {
    double mass = 0;
    Sym3 inertia;
    Vec3 center = Vec3::Zero();
    bool lock_position = false, lock_rotation = false;
};

/// What the constant force and torque of a body come to, where that is more than was stated.
///
///   force, torque  N, N m, as stated
///   gravity_scale  gravity on it, of that of the world
///   pushed_by, turned_by  N, N m, besides, through the next step
///   pushed         they are not nothing; it is among WorldState::pushed
struct AppliedForces {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double gravity_scale = 1;
    Vec3 pushed_by = Vec3::Zero(), turned_by = Vec3::Zero();
    bool pushed = false;
};

/// Who a body may touch. To the pair filter a sensor has neither, and so touches nobody.
struct BodyFilter {
    std::uint32_t group = 1, mask = ~0u;
};

/// Looks after sensors round each step; there while a program listens to any.
class SensorWatch {
public:
    virtual ~SensorWatch() = default;
    virtual void before_step() = 0;
    /// Tells who came and who left.
    virtual void after_step() = 0;
    /// Who overlaps a sensor, as of the last step; ascending, each once.
    virtual std::vector<BodyId> inside(BodyId sensor) const = 0;
};

/// Colliders that may be elsewhere than when questions were asked last; kept for that alone.
struct MovedColliders {
    bool all = false;
    std::vector<std::uint32_t> some;
};

struct WorldState {
    explicit WorldState(const Settings& all, int thread_count);

    /// Those of the world, and what of them the stages have to do with.
    void set(const Settings& all);

    mutable Door door;
    Settings settings;
    ThreadPool pool;
    WorkCount work;  // of all steps
    std::variant<Step<float>, Step<double>> step;
    Effects effects;
    Requests requests;
    Set<Effect> left_out;                // see World::leave_out()
    bool effects_stale = true;           // something besides bodies changed
    bool census_stale = true;            // that all bodies depend on
    bool causes_stale = true;            // of effects
    bool graph_stale = true;             // other settings choose other stages
    std::vector<std::uint32_t> changed;  // bodies that may call for something else, in order
    std::size_t finder_chosen_for = 0;   // bodies
    bool active_bodies_stale = true;     // all have to be asked
    bool active_bodies_stopped = false;  // somebody went or stopped between steps
    std::vector<std::uint32_t> woken;    // dynamic bodies that awoke or came between steps
    bool idle = false;                   // the last step found nobody awake and left all as it was
    bool in_order = false;
    StepWatch* watch = nullptr;  // sees the stages run; null for nobody
    StepReport report;

    // By body.
    std::vector<std::uint32_t> generation;
    std::vector<std::string> names;  // may be shorter: the rest have none
    std::vector<Vec3> center;        // of mass, in the body's own frame
    std::vector<Motion> motion;
    std::vector<std::uint64_t> user_data;                     // may be shorter: the rest have 0
    std::unordered_map<std::uint32_t, KeptMass> kept_masses;  // of who is not dynamic
    std::unordered_map<std::uint32_t, AppliedForces> applied_forces;
    std::vector<std::uint32_t> pushed;       // for the next step
    std::vector<std::uint32_t> free_bodies;  // a heap, so the least goes first
    std::map<std::uint32_t, std::vector<std::uint32_t>> free_colliders;  // by how many in a row
    std::size_t alive = 0;

    // Of edits, until they are settled.
    static constexpr std::uint8_t kDisturbed = 1, kGone = 2;
    std::vector<std::uint8_t> edits;    // [colliders] may be shorter
    std::vector<std::uint32_t> edited;  // colliders

    // For a program that listens.
    Listening listening;
    Events events;
    std::unordered_map<std::uint32_t, ColliderOwner> gone;  // of colliders, until settled
    std::vector<TouchingParts> ended_with_gone;             // since the last step
    std::map<std::uint32_t, BodyFilter> sensors;            // by body
    std::unique_ptr<SensorWatch> sensing;
    std::vector<ContactReport> contacts;  // as they were asked for last
    bool contacts_as_stepped = true;      // nothing has changed their lists since the last step

    std::shared_ptr<QueryScene> queries;  // once any were asked
    MovedColliders moved;

    SceneFields fields;

    std::vector<std::string> material_names;
    std::vector<double> material_density;       // kg/m3
    std::vector<std::string> warnings, solids;  // see World
    int most_cuts = 1;                          // that were remarked on

    template <class Data>
    Data& get()
    {
        return std::visit([](auto& s) -> Data& { return std::get<Data>(s.data); }, step);
    }
    template <class Data>
    const Data& get() const
    {
        return std::visit([](const auto& s) -> const Data& { return std::get<Data>(s.data); },
                          step);
    }

    /// The body's index. Throws std::invalid_argument for one that is gone.
    std::uint32_t place_of(BodyId body, const char* caller) const;
    /// Where the center of mass is of a body that may hang from a pivot, m, and how fast, m/s.
    Vec3 center_of_mass(std::uint32_t body) const;
    Vec3 velocity(std::uint32_t body) const;
    Vec3 arm(std::uint32_t body) const;  // from its position there, world axes
    /// s, by which its velocity is behind its place. Kicked, then moved, a body has in each place
    /// the velocity of half a substep before: beside the height of that time its energy stays what
    /// it is, beside that of now it is less on the way down than on the way up, and whoever bounces
    /// would seem to win by it. So has who touches something, see velocity_lag.hpp.
    double velocity_lag(std::uint32_t body) const;

    /// A body by its number and name, for what is told of it.
    std::string called(std::uint32_t body) const;

    /// Puts a body where it is to be, which wakes it.
    void place(std::uint32_t body, const Pose& pose);
    /// Wakes a body with all that sleeps with it.
    void wake(std::uint32_t body);
    /// The same of one beside which something was changed; who rests near him wakes in the next
    /// step.
    void wake_beside(std::uint32_t body);
    void wake_all();
    /// The broad phase has to look at a body's colliders again, and it may lie deep in others.
    void mark_changed(std::uint32_t body);
    /// Whoever is in a pair with a body wakes, by settle() at the latest; where it goes away, its
    /// pairs are dropped then with all they remember.
    void disturb(std::uint32_t body, bool goes);
    /// Whoever asks about a body's shapes has to look at them again.
    void note_moved(std::uint32_t body);
    /// What edits call for among the pairs, for all of them at once.
    void settle();
    /// Puts pairs back whose islands woke, or all.
    void wake_pairs();
    void call_all_pairs();
    /// Drops the pairs of colliders that are gone with all they remember.
    void forget_pairs();
    /// Whose a collider was when pairs were settled last.
    ColliderOwner owner_of(std::uint32_t collider) const;
    TouchingParts parts_of(std::uint32_t collider_a, std::uint32_t collider_b) const;
    TouchingParts parts_of(PairKey key) const { return parts_of(first_of(key), second_of(key)); }
    bool listens() const;
    /// Who is gone touches nobody any more.
    void end_touches_of_gone();
    /// What the last step found.
    void follow_touching_pairs();
    /// Takes a body out of all contact, to be a sensor.
    void make_sensor(std::uint32_t body);
    void set_filter(std::uint32_t body, const BodyFilter& to);
    /// Whether sensors are called for, as bodies or listeners come and go.
    void call_sensors();
    /// Something is about to change that the census knows of a body; who rests with it wakes.
    void begin_change(std::uint32_t body);
    /// What follows from where the shapes of a body are about its center of mass.
    void measure_colliders(std::uint32_t body);
    /// Has the constant force of a body follow its mass, gravity and what it is pushed by.
    void sum_forces(std::uint32_t body);
    /// Has a body go at velocities before every step, or its surface, where it is static.
    void drive(std::uint32_t body, const std::array<std::optional<double>, 3>& velocity);
    /// What is static and driven is a conveyor.
    void drive_surface(std::uint32_t body);
    /// Takes what a body had for one step away again.
    void end_pushes();
    /// Sets velocities as far as the body is free to have them, and wakes it. Beyond what a step
    /// can hold it is quarantined.
    void set_velocities(std::uint32_t body, const Vec3& linear, const Vec3& angular);
    void quarantine(std::uint32_t body);
    /// Effects, graph and the list of active bodies, brought up to date.
    void refresh();
    void refresh_effects();
    void name_causes();
    EffectFacts effect_facts() const;
    /// Puts who changed into the census.
    void follow_changes();
    void remake_graph();
    /// True where a step would change nothing: nobody is awake, and nothing was touched.
    bool nothing_to_do() const;
    /// After a step: who fell asleep, who awoke, who was quarantined.
    void follow_step();
    /// Whether anybody awake is stubborn, and so calls for escalation.
    void follow_stubborn();
    /// Who rests by himself stays as stubborn as he was: he wakes to be solved as before.
    void hold_strain();
    /// The report on the state that the last step left.
    void report_state();
    /// Empties what no stage writes any more, and wakes all where nobody may sleep.
    void empty_unused();
    void choose_broad_phase();
    FinderKind wanted_finder() const;
    /// Remarks on substeps that are too long for springs or too short for float, and on penalty
    /// forces that had a substep cut.
    void warn_of_substeps();
    void warn_of_cuts(int cuts);
};

/// What a world keeps, for the parts of the pipeline that need more than the public door shows. Who
/// only reads sees what edits call for done.
struct WorldAccess {
    static WorldState& state_of(World& world) { return *world.state_; }
    static const WorldState& state_of(const World& world)
    {
        world.state_->settle();
        return *world.state_;
    }
};
inline WorldState& state_of(World& world) { return WorldAccess::state_of(world); }
inline const WorldState& state_of(const World& world) { return WorldAccess::state_of(world); }

struct MadeSolid;  // solid_maker.hpp

/// Adds the shapes, materials and bodies of a scene.
class SceneBuilder {
public:
    explicit SceneBuilder(WorldState& state) : state_(state) { }
    std::vector<BodyId> add(const Scene& scene);

private:
    void grow_lists(std::size_t bodies);
    void make_room_for(ShapeKind kind, std::size_t count);
    void add_materials(const Scene& scene);
    PlacedShape add_shape(const Scene& scene, const ShapeDescription& description);
    PlacedShape add_solid(const Scene& scene, const std::string& name, const MeshShape& mesh);
    PlacedShape add_solid(const std::string& name, const VoxelsShape& voxels);
    PlacedShape add_made(const std::string& name, MadeSolid made);
    ShapeRef sized(ShapeKind kind, const double* sizes);
    BodyId add_body(const BodyDescription& stated, const PlacedShape* shape);
    std::uint32_t take_body();
    std::uint32_t take_colliders(std::uint32_t count);
    void
    place_colliders(std::uint32_t body, const BodyDescription& stated, const PlacedShape* shape);
    void weigh(std::uint32_t body, const BodyDescription& stated, const PlacedShape* shape);
    void add_forces(const Scene& scene, std::span<const BodyId> ids);
    void note_requests(std::uint32_t body, const BodyDescription& stated);

    WorldState& state_;
    std::uint32_t first_material_ = 0;
    std::uint32_t default_material_ = kNone;
    std::vector<double> density_;
    std::vector<PlacedShape> shapes_;  // as what stands still has them
    std::vector<PlacedShape> moving_;  // as what moves has them, where that is something else
};

}  // namespace throng
