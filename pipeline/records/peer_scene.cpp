#include "pipeline/records/peer_scene.hpp"

#include "pipeline/world/world_state.hpp"

namespace throng {
namespace {

// Its polygons as fans of triangles.
PeerTriangles peer_hull(const Hull& hull)
{
    PeerTriangles made{hull.vertices, {}};
    for (std::size_t face = 0; face + 1 < hull.face_begin.size(); ++face) {
        const std::uint32_t begin = hull.face_begin[face], end = hull.face_begin[face + 1];
        for (std::uint32_t i = begin + 1; i + 1 < end; ++i)
            made.triangles.push_back(
                {hull.face_vertices[begin], hull.face_vertices[i], hull.face_vertices[i + 1]});
    }
    return made;
}

PeerShape peer_shape(const Shapes& shapes, ShapeRef shape, const Pose& local)
{
    PeerShape made{shape.kind, Vec3::Zero(), 0, local};
    switch (shape.kind) {
    case ShapeKind::sphere:
        made.size.x() = shapes.spheres[shape.index].radius;
        break;
    case ShapeKind::capsule:
        made.size.x() = shapes.capsules[shape.index].radius;
        made.size.y() = shapes.capsules[shape.index].half_length;
        break;
    case ShapeKind::cylinder:
        made.size.x() = shapes.cylinders[shape.index].radius;
        made.size.y() = shapes.cylinders[shape.index].half_length;
        break;
    case ShapeKind::box:
        made.size = shapes.boxes[shape.index].half_extents;
        break;
    case ShapeKind::hull:
    case ShapeKind::mesh:
        made.index = shape.index;
        break;
    case ShapeKind::plane:
        made.size = shapes.planes[shape.index].normal;
        break;
    default:
        break;  // the engine says that it cannot
    }
    return made;
}

// The description behind each body, in the order of ids.
template <class Visitor>
void for_each_stated(const Scene& scene, const Visitor& visit)
{
    for (const BodyDescription& body : scene.bodies) visit(body);
    for (const Instances& group : scene.instances)
        for (std::size_t i = 0; i < group.count(); ++i) visit(group.common);
}

}  // namespace

PeerScene peer_scene(const World& world, const Scene& scene)
{
    const WorldState& state = state_of(world);
    const auto& masses = state.get<Masses>();
    const auto& colliders = state.get<Colliders>();
    const auto& surfaces = state.get<Surfaces>();
    const auto& shapes = state.get<Shapes>();

    PeerScene made;
    made.gravity = world.gravity();
    for (const Hull& hull : shapes.hulls) made.hulls.push_back(peer_hull(hull));
    for (const Mesh& mesh : shapes.meshes) made.meshes.push_back({mesh.vertices, mesh.triangles});
    for (const BodyId id : world.bodies()) {
        const std::uint32_t at = state.place_of(id, "peer_scene");
        PeerBody& body = made.bodies.emplace_back();
        body.motion = world.motion(id);
        body.mass = world.mass(id);
        body.inertia = masses.inertia[at];
        body.pose = {world.center_of_mass(id), world.pose(id).orientation};
        body.velocity = world.velocity(id);
        body.angular_velocity = world.angular_velocity(id);
        body.first_shape = static_cast<std::uint32_t>(made.shapes.size());
        body.shapes = world.sensor(id) ? 0 : colliders.count[at];  // which touches nobody
        for (std::uint32_t k = 0; k < body.shapes; ++k) {
            const std::uint32_t collider = colliders.begin[at] + k;
            made.shapes.push_back(
                peer_shape(shapes, colliders.shape[collider], colliders.local[collider]));
            body.friction = surfaces.friction[colliders.material[collider]];
            body.restitution = surfaces.restitution[colliders.material[collider]];
        }
    }
    std::size_t at = 0;
    for_each_stated(scene, [&](const BodyDescription& stated) {
        PeerBody& body = made.bodies[at++];
        body.lock_rotation = stated.lock_rotation;
        body.force = stated.force + (stated.gravity_scale - 1) * body.mass * made.gravity;
        body.drive = stated.drive_velocity;
    });
    return made;
}

std::vector<PeerState> peer_states(const World& world)
{
    std::vector<PeerState> states;
    for (const BodyId body : world.bodies())
        states.push_back({{world.center_of_mass(body), world.pose(body).orientation},
                          world.velocity(body),
                          world.angular_velocity(body)});
    return states;
}

}  // namespace throng
