// Box3D, as its user has built it: its own defaults.
#include "apps/peers/adapters/adapter.hpp"

#include <algorithm>
#include <box3d/box3d.h>
#include <box3d/collision.h>
#include <memory>
#include <vector>

namespace throng::adapters {
namespace {

float number(double x) { return static_cast<float>(x); }
b3Vec3 vector_of(const double* v) { return {number(v[0]), number(v[1]), number(v[2])}; }
b3Quat turn_of(const double* q)
{
    b3Quat turn;
    turn.v = vector_of(q);
    turn.s = number(q[3]);
    return b3NormalizeQuat(turn);
}

float geometric_mean(float a, std::uint64_t, float b, std::uint64_t) { return std::sqrt(a * b); }

class Box3D final : public Engine {
public:
    Box3D(const Scene& scene, int threads) : scene_(scene)
    {
        b3WorldDef definition = b3DefaultWorldDef();
        definition.gravity = vector_of(scene.gravity);
        definition.workerCount = static_cast<std::uint32_t>(threads);
        definition.enableSleep = false;
        definition.frictionCallback = geometric_mean;
        definition.restitutionCallback = geometric_mean;
        world_ = b3CreateWorld(&definition);
        try {
            for (std::size_t i = 0; i < scene.hull_count; ++i)
                hulls_.push_back(hull_of(scene.hulls[i]));
            for (std::size_t i = 0; i < scene.mesh_count; ++i)
                meshes_.push_back(mesh_of(scene.meshes[i]));
            for (std::size_t i = 0; i < scene.body_count; ++i)
                bodies_.push_back(add(scene.bodies[i]));
        } catch (...) {
            clear();
            throw;
        }
    }
    ~Box3D() override { clear(); }
    Box3D(const Box3D&) = delete;
    Box3D& operator=(const Box3D&) = delete;

    void step(double dt) override
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const Body& stated = scene_.bodies[i];
            if (stated.is_driven()) drive(bodies_[i], stated);
            if (stated.is_pushed())
                b3Body_ApplyForceToCenter(bodies_[i], vector_of(stated.force), true);
        }
        b3World_Step(world_, number(dt), kSubsteps);
    }

    std::size_t contacts() const override
    {
        std::vector<b3ContactData> found;
        std::size_t twice = 0;  // what is between two dynamic bodies is seen from both
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            if (scene_.bodies[i].motion != Motion::dynamic) continue;
            const int most = b3Body_GetContactCapacity(bodies_[i]);
            if (most <= 0) continue;
            found.resize(static_cast<std::size_t>(most));
            const int count = b3Body_GetContactData(bodies_[i], found.data(), most);
            for (int k = 0; k < count; ++k) {
                const b3ContactData& contact = found[static_cast<std::size_t>(k)];
                std::size_t points = 0;
                for (int m = 0; m < contact.manifoldCount; ++m)
                    points += static_cast<std::size_t>(contact.manifolds[m].pointCount);
                const bool both = is_dynamic(contact.shapeIdA) && is_dynamic(contact.shapeIdB);
                twice += both ? points : 2 * points;
            }
        }
        return twice / 2;
    }

    void read(State* states) const override
    {
        for (const b3BodyId body : bodies_) {
            const auto at = b3Body_GetPosition(body);
            const b3Quat turn = b3Body_GetRotation(body);
            const b3Vec3 v = b3Body_GetLinearVelocity(body), w = b3Body_GetAngularVelocity(body);
            *states++ = {{{at.x, at.y, at.z}, {turn.v.x, turn.v.y, turn.v.z, turn.s}},
                         {v.x, v.y, v.z},
                         {w.x, w.y, w.z}};
        }
    }

    std::string settings() const override
    {
        return std::to_string(kSubsteps) + " substeps, single precision";
    }

private:
    static constexpr int kSubsteps = 4;  // what its samples and its documentation use

    void clear()
    {
        b3DestroyWorld(world_);
        for (b3HullData* hull : hulls_) b3DestroyHull(hull);
        for (b3MeshData* mesh : meshes_) b3DestroyMesh(mesh);
    }

    static bool is_dynamic(b3ShapeId shape)
    {
        return b3Body_GetType(b3Shape_GetBody(shape)) == b3_dynamicBody;
    }

    static b3HullData* hull_of(const Triangles& stated)
    {
        std::vector<b3Vec3> points(stated.vertex_count);
        for (std::size_t i = 0; i < points.size(); ++i)
            points[i] = vector_of(stated.vertices + 3 * i);
        b3HullData* const hull =
            b3CreateHull(points.data(), static_cast<int>(points.size()), B3_MAX_HULL_VERTICES);
        if (hull == nullptr) throw std::invalid_argument("does not take one of its hulls");
        return hull;
    }

    static b3MeshData* mesh_of(const Triangles& stated)
    {
        std::vector<b3Vec3> vertices(stated.vertex_count);
        for (std::size_t i = 0; i < vertices.size(); ++i)
            vertices[i] = vector_of(stated.vertices + 3 * i);
        std::vector<std::int32_t> corners(stated.corners,
                                          stated.corners + 3 * stated.triangle_count);
        std::vector<std::uint8_t> materials(stated.triangle_count, 0);
        b3MeshDef definition = {};
        definition.vertices = vertices.data();
        definition.indices = corners.data();
        definition.materialIndices = materials.data();
        definition.vertexCount = static_cast<int>(vertices.size());
        definition.triangleCount = static_cast<int>(stated.triangle_count);
        definition.identifyEdges = true;
        b3MeshData* const mesh = b3CreateMesh(&definition, nullptr, 0);
        if (mesh == nullptr) throw std::invalid_argument("does not take one of its meshes");
        return mesh;
    }

    b3BodyId add(const Body& stated)
    {
        b3BodyDef definition = b3DefaultBodyDef();
        definition.type = stated.motion == Motion::static_ ? b3_staticBody
            : stated.motion == Motion::kinematic           ? b3_kinematicBody
                                                           : b3_dynamicBody;
        const double* const at = stated.pose.position;
        using Number = decltype(definition.position.x);  // of its own precision
        definition.position = {static_cast<Number>(at[0]), static_cast<Number>(at[1]),
                               static_cast<Number>(at[2])};
        definition.rotation = turn_of(stated.pose.orientation);
        definition.linearVelocity = vector_of(stated.velocity);
        definition.angularVelocity = vector_of(stated.angular_velocity);
        definition.enableSleep = false;
        if (stated.lock_rotation)
            definition.motionLocks.angularX = definition.motionLocks.angularY =
                definition.motionLocks.angularZ = true;
        const b3BodyId body = b3CreateBody(world_, &definition);

        b3ShapeDef material = b3DefaultShapeDef();
        material.baseMaterial.friction = number(stated.friction);
        material.baseMaterial.restitution = number(stated.restitution);
        material.updateBodyMass = false;
        for (std::uint32_t k = 0; k < stated.shapes; ++k)
            add_shape(body, material, scene_.shapes[stated.first_shape + k]);
        if (stated.motion == Motion::dynamic) {
            const double* const i = stated.inertia;
            b3MassData mass = {};
            mass.mass = number(stated.mass);
            mass.inertia.cx = {number(i[0]), number(i[3]), number(i[4])};
            mass.inertia.cy = {number(i[3]), number(i[1]), number(i[5])};
            mass.inertia.cz = {number(i[4]), number(i[5]), number(i[2])};
            b3Body_SetMassData(body, mass);
        }
        return body;
    }

    void add_shape(b3BodyId body, const b3ShapeDef& material, const Shape& shape)
    {
        const b3Transform local{vector_of(shape.local.position), turn_of(shape.local.orientation)};
        const float radius = number(shape.size[0]), half_length = number(shape.size[1]);
        switch (shape.kind) {
        case ShapeKind::sphere: {
            const b3Sphere sphere{local.p, radius};
            b3CreateSphereShape(body, &material, &sphere);
            return;
        }
        case ShapeKind::capsule: {
            const b3Vec3 along = b3RotateVector(local.q, {0, 0, half_length});
            const b3Capsule capsule{b3Sub(local.p, along), b3Add(local.p, along), radius};
            b3CreateCapsuleShape(body, &material, &capsule);
            return;
        }
        case ShapeKind::box: {
            const b3BoxHull box = b3MakeTransformedBoxHull(
                number(shape.size[0]), number(shape.size[1]), number(shape.size[2]), local);
            b3CreateHullShape(body, &material, &box.base);
            return;
        }
        case ShapeKind::hull:
            if (shape.centered)
                b3CreateHullShape(body, &material, hulls_[shape.index]);
            else
                b3CreateTransformedHullShape(body, &material, hulls_[shape.index], local,
                                             {1, 1, 1});
            return;
        case ShapeKind::mesh:
            if (!shape.centered) refuse_shape(shape.kind);
            b3CreateMeshShape(body, &material, meshes_[shape.index], {1, 1, 1});
            return;
        case ShapeKind::cylinder:
        case ShapeKind::plane:
            break;
        }
        refuse_shape(shape.kind);
    }

    static void drive(b3BodyId body, const Body& stated)
    {
        b3Vec3 velocity = b3Body_GetLinearVelocity(body);
        float* const components[] = {&velocity.x, &velocity.y, &velocity.z};
        for (int k = 0; k < 3; ++k)
            if (!std::isnan(stated.drive[k])) *components[k] = number(stated.drive[k]);
        b3Body_SetLinearVelocity(body, velocity);
    }

    const Scene& scene_;
    b3WorldId world_ = {};
    std::vector<b3HullData*> hulls_;
    std::vector<b3MeshData*> meshes_;
    std::vector<b3BodyId> bodies_;
};

}  // namespace

Engine* make_engine(const Scene& scene, int threads) { return new Box3D(scene, threads); }

}  // namespace throng::adapters
