// Bullet, as Debian has it: one thread, single precision, its own defaults.
#ifdef THRONG_BULLET
#include "apps/peers/peer.hpp"

#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <btBulletDynamicsCommon.h>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace throng::perf {
namespace {

btScalar number(double x) { return static_cast<btScalar>(x); }
btVector3 vector_of(const Vec3& v) { return {number(v.x()), number(v.y()), number(v.z())}; }
Vec3 vector_of(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btTransform transform_of(const Pose& pose)
{
    const Quat& q = pose.orientation;
    return btTransform(
        btQuaternion(number(q.x()), number(q.y()), number(q.z()), number(q.w())).normalized(),
        vector_of(pose.position));
}

Pose pose_of(const btTransform& transform)
{
    const btQuaternion q = transform.getRotation();
    return {vector_of(transform.getOrigin()), Quat(q.w(), q.x(), q.y(), q.z())};
}

// Bodies of equal shape share one, as a program that minds its memory would have it.
class ShapeStore {
public:
    explicit ShapeStore(const PeerScene& scene) : scene_(scene) { }

    btCollisionShape* of_body(const PeerBody& body)
    {
        const PeerShape& first = scene_.shapes[body.first_shape];
        // A plane is none that a compound could have; its offset is its own.
        if (body.shapes == 1 && first.kind == ShapeKind::plane) return plane(first);
        if (body.shapes == 1 && first.is_centered()) return plain(first);
        auto& compound = *new btCompoundShape;
        kept_.emplace_back(&compound);
        for (std::uint32_t k = 0; k < body.shapes; ++k) {
            const PeerShape& part = scene_.shapes[body.first_shape + k];
            compound.addChildShape(transform_of(part.local), plain(part));
        }
        return &compound;
    }

private:
    using Key = std::tuple<ShapeKind, std::uint32_t, double, double, double>;

    btCollisionShape* plain(const PeerShape& shape)
    {
        const Key key(shape.kind, shape.index, shape.size.x(), shape.size.y(), shape.size.z());
        btCollisionShape*& known = known_[key];
        if (known == nullptr) {
            known = make(shape);
            kept_.emplace_back(known);
        }
        return known;
    }

    btCollisionShape* plane(const PeerShape& shape)
    {
        kept_.emplace_back(new btStaticPlaneShape(vector_of(shape.size),
                                                  number(shape.size.dot(shape.local.position))));
        return kept_.back().get();
    }

    btCollisionShape* make(const PeerShape& shape)
    {
        const btScalar radius = number(shape.size.x()), half_length = number(shape.size.y());
        switch (shape.kind) {
        case ShapeKind::sphere:
            return new btSphereShape(radius);
        case ShapeKind::capsule:
            return new btCapsuleShapeZ(radius, 2 * half_length);
        case ShapeKind::cylinder:
            return new btCylinderShapeZ(btVector3(radius, radius, half_length));
        case ShapeKind::box:
            return new btBoxShape(vector_of(shape.size));
        case ShapeKind::hull: {
            auto* hull = new btConvexHullShape;
            for (const Vec3& vertex : scene_.hulls[shape.index].vertices)
                hull->addPoint(vector_of(vertex), false);
            hull->recalcLocalAabb();
            return hull;
        }
        case ShapeKind::mesh:
            return new btBvhTriangleMeshShape(&triangles_of(shape.index), true);
        default:
            refuse_shape("bullet", shape.kind);
        }
    }

    // It refers to numbers of its own kind, and does not copy them.
    struct Triangles {
        std::vector<btScalar> numbers;
        std::vector<int> corners;
        btTriangleIndexVertexArray array;
    };
    btTriangleIndexVertexArray& triangles_of(std::uint32_t index)
    {
        const PeerTriangles& mesh = scene_.meshes[index];
        Triangles& made = *meshes_.emplace_back(std::make_unique<Triangles>());
        for (const Vec3& vertex : mesh.vertices)
            for (const double x : {vertex.x(), vertex.y(), vertex.z()})
                made.numbers.push_back(number(x));
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t corner : triangle)
                made.corners.push_back(static_cast<int>(corner));
        btIndexedMesh part;
        part.m_numTriangles = static_cast<int>(mesh.triangles.size());
        part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(made.corners.data());
        part.m_triangleIndexStride = 3 * sizeof(int);
        part.m_numVertices = static_cast<int>(mesh.vertices.size());
        part.m_vertexBase = reinterpret_cast<const unsigned char*>(made.numbers.data());
        part.m_vertexStride = 3 * sizeof(btScalar);
        part.m_vertexType = sizeof(btScalar) == sizeof(double) ? PHY_DOUBLE : PHY_FLOAT;
        made.array.addIndexedMesh(part, PHY_INTEGER);
        return made.array;
    }

    const PeerScene& scene_;
    std::vector<std::unique_ptr<Triangles>> meshes_;
    std::map<Key, btCollisionShape*> known_;
    std::vector<std::unique_ptr<btCollisionShape>> kept_;
};

class Bullet final : public Peer {
public:
    explicit Bullet(PeerScene scene) : scene_(std::move(scene)), shapes_(scene_)
    {
        world_.setGravity(vector_of(scene_.gravity));
        bodies_.reserve(scene_.bodies.size());
        for (const PeerBody& body : scene_.bodies) add(body);
    }
    ~Bullet() override
    {
        for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    }
    Bullet(const Bullet&) = delete;
    Bullet& operator=(const Bullet&) = delete;

    void step(double dt) override
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const PeerBody& stated = scene_.bodies[i];
            if (stated.motion == Motion::kinematic) move(*bodies_[i], stated, dt);
            if (stated.drive[0] || stated.drive[1] || stated.drive[2])
                drive(*bodies_[i], stated.drive);
            bodies_[i]->applyCentralForce(vector_of(stated.force));
        }
        world_.stepSimulation(number(dt), 0);
    }

    std::size_t contacts() const override
    {
        int points = 0;
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
            points += const_cast<btCollisionDispatcher&>(dispatcher_)
                          .getManifoldByIndexInternal(i)
                          ->getNumContacts();
        return static_cast<std::size_t>(points);
    }

    std::vector<PeerState> states() const override
    {
        std::vector<PeerState> all;
        all.reserve(bodies_.size());
        for (const auto& body : bodies_)
            all.push_back({pose_of(body->getWorldTransform()), vector_of(body->getLinearVelocity()),
                           vector_of(body->getAngularVelocity())});
        return all;
    }

    std::string settings() const override
    {
        return std::to_string(world_.getSolverInfo().m_numIterations)
            + " iterations, one thread, single precision";
    }

private:
    void add(const PeerBody& stated)
    {
        btVector3 inertia(0, 0, 0);
        // It takes the three moments alone; a hull's products of inertia are left out.
        if (stated.motion == Motion::dynamic)
            inertia = {number(stated.inertia.xx), number(stated.inertia.yy),
                       number(stated.inertia.zz)};
        btRigidBody::btRigidBodyConstructionInfo info(number(stated.mass), nullptr,
                                                      shapes_.of_body(stated), inertia);
        info.m_startWorldTransform = transform_of(stated.pose);
        // Two bodies meet with the product of theirs.
        info.m_friction = number(std::sqrt(stated.friction));
        info.m_restitution = number(std::sqrt(stated.restitution));

        bodies_.push_back(std::make_unique<btRigidBody>(info));
        btRigidBody& body = *bodies_.back();
        if (stated.motion == Motion::kinematic)
            body.setCollisionFlags(body.getCollisionFlags()
                                   | btCollisionObject::CF_KINEMATIC_OBJECT);
        body.setLinearVelocity(vector_of(stated.velocity));
        body.setAngularVelocity(vector_of(stated.angular_velocity));
        if (stated.lock_rotation) body.setAngularFactor(0);
        if (stated.motion != Motion::static_) body.setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(&body);
    }

    // A kinematic body is put where it goes, and its velocity is read off the way.
    static void move(btRigidBody& body, const PeerBody& stated, double dt)
    {
        const btVector3 velocity = vector_of(stated.velocity);
        const btVector3 angular_velocity = vector_of(stated.angular_velocity);
        btTransform next;
        btTransformUtil::integrateTransform(body.getWorldTransform(), velocity, angular_velocity,
                                            number(dt), next);
        body.setInterpolationWorldTransform(body.getWorldTransform());
        body.setWorldTransform(next);
        body.setLinearVelocity(velocity);
        body.setAngularVelocity(angular_velocity);
    }

    static void drive(btRigidBody& body, const std::array<std::optional<double>, 3>& wanted)
    {
        btVector3 velocity = body.getLinearVelocity();
        for (int k = 0; k < 3; ++k)
            if (const auto& component = wanted[static_cast<std::size_t>(k)])
                velocity[k] = number(*component);
        body.setLinearVelocity(velocity);
    }

    PeerScene scene_;
    ShapeStore shapes_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    mutable btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

std::unique_ptr<Peer> make_bullet(const PeerScene& scene)
{
    return std::make_unique<Bullet>(scene);
}

}  // namespace throng::perf
#endif
