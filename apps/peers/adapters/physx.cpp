// PhysX, as its user has built it: its own defaults, on processors alone.
#include "apps/peers/adapters/adapter.hpp"

#include <PxPhysicsAPI.h>
#include <map>
#include <tuple>
#include <vector>

namespace throng::adapters {
namespace {

using namespace physx;

float number(double x) { return static_cast<float>(x); }
PxVec3 vector_of(const double* v) { return {number(v[0]), number(v[1]), number(v[2])}; }
PxTransform transform_of(const Pose& pose)
{
    const double* const q = pose.orientation;
    return {vector_of(pose.position),
            PxQuat(number(q[0]), number(q[1]), number(q[2]), number(q[3])).getNormalized()};
}

// Its capsules and planes lie along x: brings x to z.
PxQuat x_to_z() { return {-PxHalfPi, PxVec3(0, 1, 0)}; }

// Of all scenes of the process, as it will have it.
struct Library {
    PxDefaultAllocator allocator;
    PxDefaultErrorCallback errors;
    PxFoundation* foundation = PxCreateFoundation(PX_PHYSICS_VERSION, allocator, errors);
    PxPhysics* physics = foundation
        ? PxCreatePhysics(PX_PHYSICS_VERSION, *foundation, PxTolerancesScale())
        : nullptr;
};
PxPhysics& physics()
{
    static Library& library = *new Library;  // until the process ends
    if (library.physics == nullptr) throw std::invalid_argument("cannot be started");
    return *library.physics;
}

class PhysX final : public Engine {
public:
    PhysX(const Scene& scene, int threads) : scene_(scene)
    {
        PxSceneDesc description(physics().getTolerancesScale());
        description.gravity = vector_of(scene.gravity);
        // None of its own: the thread that steps does the work.
        dispatcher_ = PxDefaultCpuDispatcherCreate(threads == 1 ? 0 : static_cast<PxU32>(threads));
        description.cpuDispatcher = dispatcher_;
        description.filterShader = PxDefaultSimulationFilterShader;
        world_ = physics().createScene(description);
        if (world_ == nullptr) throw std::invalid_argument("cannot make a scene");
        for (std::size_t i = 0; i < scene.body_count; ++i) add(scene.bodies[i]);
    }
    ~PhysX() override
    {
        world_->release();
        for (PxRigidActor* actor : actors_) actor->release();
        for (const auto& known : known_) known.second->release();
        for (const auto& known : materials_) known.second->release();
        dispatcher_->release();
    }
    PhysX(const PhysX&) = delete;
    PhysX& operator=(const PhysX&) = delete;

    void step(double dt) override
    {
        for (std::size_t i = 0; i < actors_.size(); ++i) {
            const Body& stated = scene_.bodies[i];
            if (stated.motion == Motion::static_) continue;
            PxRigidDynamic& body = static_cast<PxRigidDynamic&>(*actors_[i]);
            if (stated.motion == Motion::kinematic) move(body, stated, dt);
            if (stated.is_driven()) drive(body, stated);
            if (stated.is_pushed()) body.addForce(vector_of(stated.force));
        }
        world_->simulate(number(dt));
        world_->fetchResults(true);
    }

    // It tells of pairs alone, and of points to those that ask while they are found.
    std::size_t contacts() const override { return 0; }

    void read(State* states) const override
    {
        for (std::size_t i = 0; i < actors_.size(); ++i) {
            const PxTransform at = actors_[i]->getGlobalPose();
            PxVec3 v(0), w(0);
            if (scene_.bodies[i].motion != Motion::static_) {
                const auto& body = static_cast<const PxRigidDynamic&>(*actors_[i]);
                v = body.getLinearVelocity(), w = body.getAngularVelocity();
            }
            *states++ = {{{at.p.x, at.p.y, at.p.z}, {at.q.x, at.q.y, at.q.z, at.q.w}},
                         {v.x, v.y, v.z},
                         {w.x, w.y, w.z}};
        }
    }

    std::string settings() const override
    {
        return std::to_string(positions_) + " position and " + std::to_string(velocities_)
            + " velocity iterations, PGS, single precision";
    }

private:
    using Key = std::tuple<ShapeKind, std::uint32_t, double, double, double, const PxMaterial*>;

    void add(const Body& stated)
    {
        const PxTransform at = transform_of(stated.pose);
        PxRigidDynamic* moving = nullptr;
        if (stated.motion == Motion::static_)
            actors_.push_back(physics().createRigidStatic(at));
        else
            actors_.push_back(moving = physics().createRigidDynamic(at));
        PxRigidActor& actor = *actors_.back();
        for (std::uint32_t k = 0; k < stated.shapes; ++k)
            attach(actor, scene_.shapes[stated.first_shape + k],
                   material_of(stated.friction, stated.restitution));
        if (stated.motion == Motion::kinematic)
            moving->setRigidBodyFlag(PxRigidBodyFlag::eKINEMATIC, true);
        if (stated.motion == Motion::dynamic) set_dynamic(*moving, stated);
        world_->addActor(actor);
    }

    void set_dynamic(PxRigidDynamic& body, const Body& stated)
    {
        const double* const i = stated.inertia;
        const PxMat33 inertia(PxVec3(number(i[0]), number(i[3]), number(i[4])),
                              PxVec3(number(i[3]), number(i[1]), number(i[5])),
                              PxVec3(number(i[4]), number(i[5]), number(i[2])));
        PxQuat axes;
        const PxVec3 moments = PxMassProperties::getMassSpaceInertia(inertia, axes);
        body.setMass(number(stated.mass));
        body.setMassSpaceInertiaTensor(moments);
        body.setCMassLocalPose(PxTransform(PxVec3(0), axes));
        body.setLinearDamping(0);
        body.setAngularDamping(0);
        body.setLinearVelocity(vector_of(stated.velocity));
        body.setAngularVelocity(vector_of(stated.angular_velocity));
        body.setSleepThreshold(0);
        body.setWakeCounter(1e9F);
        body.getSolverIterationCounts(positions_, velocities_);
        if (stated.lock_rotation)
            body.setRigidDynamicLockFlags(PxRigidDynamicLockFlag::eLOCK_ANGULAR_X
                                          | PxRigidDynamicLockFlag::eLOCK_ANGULAR_Y
                                          | PxRigidDynamicLockFlag::eLOCK_ANGULAR_Z);
    }

    // Two bodies meet with the product of theirs.
    const PxMaterial& material_of(double friction, double restitution)
    {
        PxMaterial*& known = materials_[{friction, restitution}];
        if (known == nullptr) {
            const float root = number(std::sqrt(friction));
            known = physics().createMaterial(root, root, number(std::sqrt(restitution)));
            known->setFrictionCombineMode(PxCombineMode::eMULTIPLY);
            known->setRestitutionCombineMode(PxCombineMode::eMULTIPLY);
        }
        return *known;
    }

    // Bodies of equal shape share one, where it is not moved within its body.
    void attach(PxRigidActor& actor, const Shape& shape, const PxMaterial& material)
    {
        if (!shape.centered) {
            PxShape* const own = make(shape, material, true);
            actor.attachShape(*own);
            own->release();
            return;
        }
        const Key key(shape.kind, shape.index, shape.size[0], shape.size[1], shape.size[2],
                      &material);
        PxShape*& known = known_[key];
        if (known == nullptr) known = make(shape, material, false);
        actor.attachShape(*known);
    }

    PxShape* make(const Shape& shape, const PxMaterial& material, bool exclusive)
    {
        const float radius = number(shape.size[0]), half_length = number(shape.size[1]);
        PxTransform local = transform_of(shape.local);
        PxShape* made = nullptr;
        switch (shape.kind) {
        case ShapeKind::sphere:
            made = physics().createShape(PxSphereGeometry(radius), material, exclusive);
            break;
        case ShapeKind::capsule:
            made =
                physics().createShape(PxCapsuleGeometry(radius, half_length), material, exclusive);
            local.q = local.q * x_to_z();
            break;
        case ShapeKind::box:
            made = physics().createShape(PxBoxGeometry(vector_of(shape.size)), material, exclusive);
            break;
        case ShapeKind::hull:
            made =
                physics().createShape(PxConvexMeshGeometry(hull(shape.index)), material, exclusive);
            break;
        case ShapeKind::plane: {
            const PxTransform plane =
                PxTransformFromPlaneEquation(PxPlane(vector_of(shape.size), 0));
            made = physics().createShape(PxPlaneGeometry(), material, exclusive);
            local = local * plane;
            break;
        }
        case ShapeKind::mesh:
            made = physics().createShape(PxTriangleMeshGeometry(mesh(shape.index)), material,
                                         exclusive);
            break;
        case ShapeKind::cylinder:
            break;
        }
        if (made == nullptr) refuse_shape(shape.kind);
        made->setLocalPose(local);
        return made;
    }

    static std::vector<PxVec3> points_of(const Triangles& stated)
    {
        std::vector<PxVec3> points;
        for (std::size_t i = 0; i < stated.vertex_count; ++i)
            points.push_back(vector_of(stated.vertices + 3 * i));
        return points;
    }

    PxConvexMesh* hull(std::uint32_t index)
    {
        PxConvexMesh*& known = hulls_[index];
        if (known != nullptr) return known;
        const std::vector<PxVec3> points = points_of(scene_.hulls[index]);
        PxConvexMeshDesc description;
        description.points.count = static_cast<PxU32>(points.size());
        description.points.stride = sizeof(PxVec3);
        description.points.data = points.data();
        description.flags = PxConvexFlag::eCOMPUTE_CONVEX;
        known = PxCreateConvexMesh(PxCookingParams(physics().getTolerancesScale()), description);
        if (known == nullptr) throw std::invalid_argument("does not take one of its hulls");
        return known;
    }

    PxTriangleMesh* mesh(std::uint32_t index)
    {
        PxTriangleMesh*& known = meshes_[index];
        if (known != nullptr) return known;
        const Triangles& stated = scene_.meshes[index];
        const std::vector<PxVec3> points = points_of(stated);
        PxTriangleMeshDesc description;
        description.points.count = static_cast<PxU32>(points.size());
        description.points.stride = sizeof(PxVec3);
        description.points.data = points.data();
        description.triangles.count = static_cast<PxU32>(stated.triangle_count);
        description.triangles.stride = 3 * sizeof(std::uint32_t);
        description.triangles.data = stated.corners;
        known = PxCreateTriangleMesh(PxCookingParams(physics().getTolerancesScale()), description);
        if (known == nullptr) throw std::invalid_argument("does not take one of its meshes");
        return known;
    }

    // A kinematic body is told where to be.
    static void move(PxRigidDynamic& body, const Body& stated, double dt)
    {
        PxTransform at = body.getGlobalPose();
        const PxVec3 turning = vector_of(stated.angular_velocity);
        const float speed = turning.magnitude();
        at.p += vector_of(stated.velocity) * number(dt);
        if (speed > 0) at.q = (PxQuat(speed * number(dt), turning / speed) * at.q).getNormalized();
        body.setKinematicTarget(at);
    }

    static void drive(PxRigidDynamic& body, const Body& stated)
    {
        PxVec3 velocity = body.getLinearVelocity();
        for (PxU32 k = 0; k < 3; ++k)
            if (!std::isnan(stated.drive[k])) velocity[k] = number(stated.drive[k]);
        body.setLinearVelocity(velocity);
    }

    const Scene& scene_;
    PxDefaultCpuDispatcher* dispatcher_ = nullptr;
    PxScene* world_ = nullptr;
    std::map<std::pair<double, double>, PxMaterial*> materials_;
    std::map<Key, PxShape*> known_;
    std::map<std::uint32_t, PxConvexMesh*> hulls_;
    std::map<std::uint32_t, PxTriangleMesh*> meshes_;
    std::vector<PxRigidActor*> actors_;
    PxU32 positions_ = 4, velocities_ = 1;
};

}  // namespace

Engine* make_engine(const Scene& scene, int threads) { return new PhysX(scene, threads); }

}  // namespace throng::adapters
