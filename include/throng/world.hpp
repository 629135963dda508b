// World: bodies, what holds between them, and the step.
//
// Bodies are added and removed in batches, between steps. A BodyId stays good until its body is
// removed; using one after that throws. One thread calls a world at a time: a call that comes while
// another is at work, from a second thread or from the program's own force field within a step,
// throws std::logic_error, naming both, and changes nothing. Between steps any number of threads
// may read states of bodies. The step itself runs on the world's own threads, and its result is the
// same bits for any number of them.
#pragma once

#include "throng/body_id.hpp"
#include "throng/body_state.hpp"
#include "throng/contact_events.hpp"
#include "throng/effects.hpp"
#include "throng/force_field.hpp"
#include "throng/report.hpp"
#include "throng/scene.hpp"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace throng {

class World {
public:
    /// An empty world. threads: 0 for as many as the machine has cores.
    explicit World(const Settings& settings = {}, int threads = 1);
    /// The world of a scene. Throws std::invalid_argument, naming the part that is refused and what
    /// was wanted, when the scene is impossible.
    explicit World(const Scene& scene, int threads = 1);
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Adds all that a scene holds to this world; its settings and gravity are not taken. Ids come
    /// in the scene's order: bodies, then instances.
    std::vector<BodyId> add(const Scene& scene);
    /// Springs go with either of their bodies, a scene's attractors and wind with the last of its
    /// bodies.
    void remove(std::span<const BodyId> bodies);

    /// Advances by `steps` times settings().dt.
    void step(int steps = 1);

    const Settings& settings() const;
    /// Takes effect with the next step. `precision` cannot change in a world that has bodies.
    void set_settings(const Settings& settings);
    Vec3 gravity() const;
    void set_gravity(const Vec3& gravity);
    /// A force and torque of the program's own on every dynamic body that is awake, at every
    /// evaluation of the integrator; none to take it away. Called from any of the world's threads.
    /// Bodies in a field do not sleep. What it throws ends the step, halfway: such a world may be
    /// read, and refuses to be changed or stepped.
    void set_force_field(ForceField field);

    std::size_t body_count() const;      // alive
    std::vector<BodyId> bodies() const;  // alive, by index
    bool alive(BodyId body) const;
    const std::string& name(BodyId body) const;
    Motion motion(BodyId body) const;
    bool awake(BodyId body) const;
    bool quarantined(BodyId body) const;
    double mass(BodyId body) const;  // kg; 0 when it is not dynamic

    /// Of the body's own frame, where its shape was placed.
    Pose pose(BodyId body) const;
    Vec3 center_of_mass(BodyId body) const;
    Vec3 velocity(BodyId body) const;          // of the center of mass
    Vec3 angular_velocity(BodyId body) const;  // world axes
    /// m: no point of its shapes is further from the center of mass; 0 without any, planes apart.
    double radius(BodyId body) const;

    /// The state of all bodies, as it is kept.
    StateSpans stored_state() const;
    /// That of some, in their order, where a program wants it; on the world's threads.
    void read_state(std::span<const BodyId> bodies, const StateColumns<double>& to) const;
    /// As set_pose() and set_velocity() of each; what is left out stays as it is. Nothing is
    /// written where anything is refused.
    void write_state(std::span<const BodyId> bodies, const StateColumns<const double>& from);

    /// These wake the body and what it rests with.
    void set_pose(BodyId body, const Pose& pose);
    void set_velocity(BodyId body, const Vec3& linear, const Vec3& angular);
    /// N s, at the center of mass: what turns about a pivot gets its torque. Of a dynamic body, as
    /// all impulses and forces.
    void add_impulse(BodyId body, const Vec3& impulse);
    void add_impulse(BodyId body, const Vec3& impulse, const Vec3& point);  // m, world
    void add_angular_impulse(BodyId body, const Vec3& impulse);             // N m s, world axes
    /// N and N m through the next step alone, world axes, besides the constant ones.
    void add_force(BodyId body, const Vec3& force);
    void add_force(BodyId body, const Vec3& force, const Vec3& point);  // m, world
    void add_torque(BodyId body, const Vec3& torque);
    /// Gives a kinematic body the velocities that take it to a pose in a time, s, from now.
    void move_to(BodyId body, const Pose& pose, double seconds);
    void wake(BodyId body);
    /// Puts a dynamic body to sleep as it is, in the air as well, with all that it touches and that
    /// touch those. Throws where nobody may sleep. By partial_rest it comes to rest once it is
    /// borne.
    void sleep(BodyId body);

    /// What a scene states of a body, changed. These wake the body and what it rests with, too, and
    /// throw std::invalid_argument for what a scene could not have.
    ///
    /// A body that becomes dynamic has the mass and inertia that it had when it last was, or was
    /// given by set_mass(), or else those of its shape and material; it has to have a volume, and
    /// must not be a plane, or a mesh, of which what stands still has triangles alone. What is no
    /// longer dynamic turns about its own frame. Bodies on a pivot stay as they are.
    void set_motion(BodyId body, Motion motion);
    /// kg, and kg m2 about the center of mass, body axes; without, the inertia goes with the mass.
    void set_mass(BodyId body, double mass, const std::optional<Sym3>& inertia = {});
    Sym3 inertia(BodyId body) const;  // about the center of mass; 0 when it is not dynamic
    void set_locks(BodyId body, bool position, bool rotation);
    /// Two bodies may touch when each one's group has a bit in the other's mask.
    void set_filter(BodyId body, std::uint32_t group, std::uint32_t mask);
    std::uint32_t group(BodyId body) const;  // 0 for a body without a shape
    std::uint32_t mask(BodyId body) const;
    /// m/s, set before every step where they are given; of a static body those of its surface.
    void set_drive_velocity(BodyId body, const std::array<std::optional<double>, 3>& velocity);
    void set_fast(BodyId body, bool fast);
    /// A sensor touches nobody; see Listening. Its shapes have to be convex and of finite size.
    void set_sensor(BodyId body, bool sensor);
    bool sensor(BodyId body) const;
    /// N and N m, constant, world axes.
    void set_force(BodyId body, const Vec3& force, const Vec3& torque);
    /// Gravity on the body is this many times that of the world.
    void set_gravity_scale(BodyId body, double scale);
    double gravity_scale(BodyId body) const;

    /// Whatever a program wants to remember of a body; 0 until it is set.
    void set_user_data(BodyId body, std::uint64_t data);
    std::uint64_t user_data(BodyId body) const;

    /// What turns body axes into world axes as the `rotation` that is chosen holds it: with the
    /// textbook's forms no rotation after a while.
    Mat3 rotation_matrix(BodyId body) const;

    /// Force of the contacts on a body over the last substep, N, friction included, and all impacts
    /// of the step as if they had been in it; by overlap back_up and subdivide the mean over the
    /// last step, impacts included.
    Vec3 contact_force(BodyId body) const;

    /// The contacts of the last step, those of sleepers as they were left, in order of bodies and
    /// parts. Made when it is asked for; good until it is asked for again. Impacts are left out
    /// once something was changed since the step. Empty where a step is cut at touches (overlap
    /// back_up and subdivide), which keeps no list of contacts.
    std::span<const ContactReport> contacts() const;
    /// Says what events are wanted; nothing is made of others. Whoever touches as it begins is told
    /// of in the next step, sleepers as they wake. None are known where a step is cut at touches.
    void listen(const Listening& to);
    const Events& events() const;
    /// The bodies that overlap a sensor, as of the last step, by index. Throws where nobody listens
    /// to sensors.
    std::vector<BodyId> sensed(BodyId body) const;

    const StepReport& report() const;
    /// What was found wrong with shapes that were added and what was done about it, a sentence
    /// each.
    const std::vector<std::string>& warnings() const;
    /// How each moving mesh and level set that was added is taken, and how exactly, a line each.
    const std::vector<std::string>& solids() const;
    std::vector<StageReport> stages() const;
    /// Measured afresh on each call; takes about as long as a step.
    Measures measure() const;
    /// Fingerprint of poses, velocities, cached impulses and sleep state in order of id: 16 hex
    /// digits.
    std::string state_hash() const;

    const Effects& effects();
    /// Effects of kLeftOutByWorld that are not simulated from the next step on, whoever calls for
    /// them: their stages are not in it. Throws std::invalid_argument for any other.
    void leave_out(Set<Effect> effects);
    /// What runs within a stage, and how often.
    struct PassInfo {
        std::string_view name, when;
    };
    /// The stages of this world's step, what each waits for, and what of it this scene calls for,
    /// in order.
    struct StageInfo {
        std::string_view name;
        std::vector<std::size_t> waits_for;
        std::vector<PassInfo> passes;
    };
    std::vector<StageInfo> step_stages();

    int threads() const;
    int threads_met() const;   // that really run
    int threads_used() const;  // that had a share in any step so far
    std::size_t memory_bytes() const;

    /// Runs the stages top to bottom on the calling thread from now on: the reference for the
    /// graph.
    void run_in_order(bool in_order);

private:
    friend struct WorldAccess;
    std::unique_ptr<struct WorldState> state_;
};

}  // namespace throng
