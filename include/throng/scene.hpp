// Scene: what the user states, before it becomes a world.
//
// Plain values, SI units, radians. The scene file is one way to fill this in, the catalogue
// another, a program a third; World takes it from there and refuses what is impossible.
#pragma once

#include "throng/math.hpp"
#include "throng/settings.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace throng {

enum class Motion : std::uint8_t { static_, kinematic, dynamic };

/// What a surface is made of. Two materials meet with the geometric mean of their frictions and the
/// greater restitution, unless a MaterialPairDescription says otherwise.
struct Material {
    std::string name;
    double density = 1000;        // kg/m3
    double friction = 0.5;        // Coulomb's coefficient
    double restitution = 0;       // 0 stays, 1 bounces for ever
    double rolling_friction = 0;  // m, lever of the resisting torque
    bool operator==(const Material&) const = default;
};

/// Overrides the combination of two materials, named by place in Scene::materials.
struct MaterialPairDescription {
    std::uint32_t a = 0, b = 0;
    std::optional<double> friction, restitution;
};

struct SphereShape {
    double radius = 0;
};
struct CapsuleShape {  // axis z; half_length is of the segment, without the round ends
    double radius = 0, half_length = 0;
};
struct CylinderShape {  // axis z
    double radius = 0, half_length = 0;
};
struct BoxShape {
    Vec3 half_extents = Vec3::Zero();
};
struct HullShape {
    std::vector<Vec3> points;
};
struct PlaneShape {  // solid where normal . x < offset
    Vec3 normal = Vec3::UnitZ();
    double offset = 0;
};
/// Triangles by the places of their vertices, counter-clockwise seen from outside.
struct TriangleSoup {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct MeshShape {
    std::string file;  // as written in the scene; empty when made by a program
    double scale = 1;
    std::string nonconvex;  // how a moving one is taken: the dial's value, empty for the dial's own
    std::vector<Vec3> vertices;  // already scaled
    std::vector<std::array<std::uint32_t, 3>> triangles;
    // The dials of that way, for this shape alone; 0 for the scene's own.
    double voxel_size = 0;  // m
    int image_resolution = 0, sphere_levels = 0, max_parts = 0;
};
struct CompoundShape {
    struct Part {
        std::uint32_t shape = 0;  // place in Scene::shapes
        Pose pose;
    };
    std::vector<Part> parts;
};

struct LevelSet;
struct VoxelsShape {
    std::string file;  // as written in the scene; empty when made by a program
    std::shared_ptr<const LevelSet> level_set;  // see level_set.hpp
};

struct ShapeDescription {
    std::string name;
    std::variant<SphereShape,
                 CapsuleShape,
                 CylinderShape,
                 BoxShape,
                 HullShape,
                 PlaneShape,
                 MeshShape,
                 CompoundShape,
                 VoxelsShape>
        shape;
};

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// One body as its user states it. Pose is of the body's own frame (where the shape was placed);
/// velocity is of the center of mass.
struct BodyDescription {
    std::string name;
    std::uint32_t shape = kNone;     // place in Scene::shapes; kNone: no collision
    std::uint32_t material = kNone;  // place in Scene::materials; kNone: a default Material
    Motion motion = Motion::dynamic;
    Vec3 position = Vec3::Zero();
    Quat orientation = Quat::Identity();
    Vec3 velocity = Vec3::Zero();
    Vec3 angular_velocity = Vec3::Zero();
    std::optional<double> mass;   // kg; else from density and volume
    std::optional<Sym3> inertia;  // kg m2 about the center, body axes; else from the shape
    std::optional<Vec3> center;   // of mass, body axes; else from the shape
    Vec3 force = Vec3::Zero();    // N, world axes, constant
    Vec3 torque = Vec3::Zero();   // N m
    double linear_drag = 0;       // kg/s
    double angular_drag = 0;      // kg m2/s
    std::optional<Vec3> pivot;    // this point of the body stays where it is
    std::array<std::optional<double>, 3> drive_velocity;  // m/s, set before every step
    std::uint32_t group = 1;
    std::uint32_t mask = 0xffffffffu;
    bool lock_rotation = false;
    bool lock_position = false;
    bool fast = false;
    double gravity_scale = 1;     // gravity on it, of that of the scene
    bool sensor = false;          // reports who overlaps it, and touches nothing
    std::uint64_t user_data = 0;  // a program's own; at most 2^53 in a file
};

/// Many bodies that share all but pose, velocity and perhaps size.
struct Instances {
    BodyDescription common;  // shape: the kind they share (its size when sizes are not given)
    bool own_sizes = false;  // records carry three more numbers
    std::string file;        // as written in the scene; empty when made by a program
    /// 13 numbers a body: position, orientation (w, x, y, z), velocity, angular velocity; with
    /// own_sizes 16: half extents of a box; radius of a sphere; radius and half length.
    std::vector<double> records;

    std::size_t stride() const { return own_sizes ? 16 : 13; }
    std::size_t count() const { return records.size() / stride(); }
};

struct Spring {
    std::uint32_t a = kNone, b = kNone;  // bodies in file order; kNone is the world
    Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();
    double stiffness = 0, damping = 0, length = 0;
};

struct Attractor {
    Vec3 position = Vec3::Zero();
    double strength = 0;
};

struct Scene {
    std::string name;
    Vec3 gravity = Vec3(0, 0, -9.81);
    Settings settings;
    std::vector<std::string> dials_set;  // those the scene asks for by name, in its order
    std::vector<Material> materials;
    std::vector<MaterialPairDescription> pairs;
    std::vector<ShapeDescription> shapes;
    std::vector<BodyDescription> bodies;  // ids 0, 1, ...
    std::vector<Instances> instances;     // ids go on from there
    std::vector<Spring> springs;
    std::vector<Attractor> attractors;
    Vec3 wind = Vec3::Zero();
    std::string cache_folder;  // keeps what takes long to make of shapes; empty: nothing is kept

    std::size_t body_count() const
    {
        std::size_t count = bodies.size();
        for (const Instances& group : instances) count += group.count();
        return count;
    }
};

/// What is wrong with a scene, in the order shapes, materials, bodies, instances, the rest:
/// `bodies[3].mass: wanted ...`; empty when it can become a world.
std::string check_scene(const Scene& scene);

}  // namespace throng
