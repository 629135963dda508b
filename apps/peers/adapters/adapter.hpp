// Adapter: an engine that its user has built, behind plain numbers.
//
// Adapters are compiled against that engine when `bench --peer-at` asks for it, and know nothing
// of throng but this file. Lengths are m, masses kg, times s; a body's frame is that of its center
// of mass.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace throng::adapters {

enum class ShapeKind : std::int32_t { sphere, capsule, cylinder, box, hull, plane, mesh };
enum class Motion : std::int32_t { static_, kinematic, dynamic };

struct Pose {
    double position[3];
    double orientation[4];  // unit quaternion, x y z w
};

/// Capsules and cylinders lie along z.
struct Shape {
    ShapeKind kind;
    std::uint32_t index;  // of a hull among the hulls, of a mesh among the meshes
    double size[3];       // half extents of a box, normal of a plane; else radius, half length
    Pose local;
    bool centered;  // it is where its body is, turned as its body is
};

struct Triangles {
    const double* vertices;  // [vertex_count][3]
    std::size_t vertex_count;
    const std::uint32_t* corners;  // [triangle_count][3], counter-clockwise seen from outside
    std::size_t triangle_count;
};

struct Body {
    Motion motion;
    double mass;        // 0 unless dynamic
    double inertia[6];  // kg m2, body axes: xx yy zz xy xz yz
    Pose pose;
    double velocity[3], angular_velocity[3];
    double friction, restitution;  // two bodies meet with the geometric mean of theirs
    bool lock_rotation;
    double force[3];  // N, world axes, constant
    double drive[3];  // m/s, set before every step; NaN where it is not
    std::uint32_t first_shape, shapes;

    bool is_driven() const
    {
        return !(std::isnan(drive[0]) && std::isnan(drive[1]) && std::isnan(drive[2]));
    }
    bool is_pushed() const { return force[0] != 0 || force[1] != 0 || force[2] != 0; }
};

/// It lives as long as its engine.
struct Scene {
    double gravity[3];
    const Triangles *hulls, *meshes;
    const Shape* shapes;
    const Body* bodies;
    std::size_t hull_count, mesh_count, shape_count, body_count;
};

struct State {
    Pose pose;
    double velocity[3], angular_velocity[3];
};

/// An engine with a scene in it. Nobody sleeps, nothing is damped; all else is as the engine has
/// it.
class Engine {
public:
    virtual ~Engine() = default;
    /// Sets what is driven, and advances.
    virtual void step(double dt) = 0;
    /// Points of contact in the last step; 0 where the engine does not tell.
    virtual std::size_t contacts() const = 0;
    /// Of every body, in the scene's order.
    virtual void read(State* states) const = 0;
    /// What it was set to, in words.
    virtual std::string settings() const = 0;
};

/// Makes an engine; throws std::invalid_argument for what it is not given here.
Engine* make_engine(const Scene& scene, int threads);

/// What leaves the module.
struct Door {
    /// Null where the engine does not take the scene; why is then written, as much as has room.
    Engine* (*make)(const Scene* scene, int threads, char* why, std::size_t room);
    void (*destroy)(Engine* engine);
    void (*step)(Engine* engine, double dt);
    std::size_t (*contacts)(const Engine* engine);
    void (*read)(const Engine* engine, State* states);
    void (*settings)(const Engine* engine, char* text, std::size_t room);
};

/// The name under which a module offers its door: `const Door* throng_adapter()`.
inline constexpr const char* kAdapterSymbol = "throng_adapter";
using AdapterFunction = const Door* (*)();

[[noreturn]] inline void refuse_shape(ShapeKind kind)
{
    constexpr const char* kNames[] = {"a sphere", "a capsule", "a cylinder", "a box",
                                      "a hull",   "a plane",   "a mesh"};
    throw std::invalid_argument(std::string("is not given ") + kNames[static_cast<int>(kind)]
                                + " here");
}

}  // namespace throng::adapters
