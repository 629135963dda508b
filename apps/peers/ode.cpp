// ODE, as Debian has it: the quick step, one thread, double precision, its own defaults.
#ifdef THRONG_ODE
#include "apps/peers/peer.hpp"

#include <cmath>
#include <ode/ode.h>

namespace throng::perf {
namespace {

// What a pair may have at most; as many as the other engines keep.
constexpr int kMostContacts = 4;

// A body that may not turn gets this, kg m2: it has no lock for a body's rotation.
constexpr double kUnturnable = 1e12;

Vec3 vector_of(const dReal* v) { return {v[0], v[1], v[2]}; }

struct DQuat {
    explicit DQuat(const Quat& q) : numbers{q.w(), q.x(), q.y(), q.z()} { }
    dQuaternion numbers;
};

/// A hull in the form that it reads; it keeps no copy.
struct ConvexData {
    std::vector<dReal> planes, points;
    std::vector<unsigned> polygons;

    explicit ConvexData(const PeerTriangles& hull)
    {
        for (const Vec3& vertex : hull.vertices)
            points.insert(points.end(), {vertex.x(), vertex.y(), vertex.z()});
        for (const auto& triangle : hull.triangles) {
            const Vec3 &a = hull.vertices[triangle[0]], &b = hull.vertices[triangle[1]],
                       &c = hull.vertices[triangle[2]];
            const Vec3 normal = (b - a).cross(c - a).normalized();
            planes.insert(planes.end(), {normal.x(), normal.y(), normal.z(), normal.dot(a)});
            polygons.insert(polygons.end(), {3u, triangle[0], triangle[1], triangle[2]});
        }
    }
};

// The library itself, for as long as the process lives.
void open_library()
{
    static const bool opened = [] {
        dInitODE2(0);
        dAllocateODEDataForThread(dAllocateMaskAll);
        return true;
    }();
    static_cast<void>(opened);
}

class Ode final : public Peer {
public:
    explicit Ode(const PeerScene& scene) : scene_(scene)
    {
        open_library();
        world_ = dWorldCreate();
        space_ = dHashSpaceCreate(nullptr);
        joints_ = dJointGroupCreate(0);
        // Cells from 1/4 to 8 m: bodies of 1 m, walls above.
        dHashSpaceSetLevels(space_, -2, 3);
        dWorldSetGravity(world_, scene.gravity.x(), scene.gravity.y(), scene.gravity.z());
        dWorldSetAutoDisableFlag(world_, 0);
        for (const PeerTriangles& hull : scene.hulls) hulls_.emplace_back(hull);
        bodies_.reserve(scene.bodies.size());
        for (const PeerBody& body : scene_.bodies) add(body);
    }
    ~Ode() override
    {
        dJointGroupDestroy(joints_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
    }
    Ode(const Ode&) = delete;
    Ode& operator=(const Ode&) = delete;

    void step(double dt) override
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const Vec3& force = scene_.bodies[i].force;
            if (!force.isZero(0)) dBodyAddForce(bodies_[i], force.x(), force.y(), force.z());
            const auto& wanted = scene_.bodies[i].drive;
            if (!wanted[0] && !wanted[1] && !wanted[2]) continue;
            const dReal* now = dBodyGetLinearVel(bodies_[i]);
            dBodySetLinearVel(bodies_[i], wanted[0].value_or(now[0]), wanted[1].value_or(now[1]),
                              wanted[2].value_or(now[2]));
        }
        points_ = 0;
        dSpaceCollide(space_, this, collide);
        dWorldQuickStep(world_, dt);
        dJointGroupEmpty(joints_);
    }

    std::size_t contacts() const override { return points_; }

    std::vector<PeerState> states() const override
    {
        std::vector<PeerState> all;
        all.reserve(bodies_.size());
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            dBodyID body = bodies_[i];
            if (body == nullptr) {
                all.push_back({scene_.bodies[i].pose});
                continue;
            }
            const dReal* q = dBodyGetQuaternion(body);
            all.push_back({{vector_of(dBodyGetPosition(body)), Quat(q[0], q[1], q[2], q[3])},
                           vector_of(dBodyGetLinearVel(body)),
                           vector_of(dBodyGetAngularVel(body))});
        }
        return all;
    }

    std::string settings() const override
    {
        return "quick step of " + std::to_string(dWorldGetQuickStepNumIterations(world_))
            + " iterations, at most " + std::to_string(kMostContacts)
            + " contacts a pair, one thread, double precision";
    }

private:
    static const PeerBody& stated_of(dGeomID geom)
    {
        return *static_cast<const PeerBody*>(dGeomGetData(geom));
    }

    static void collide(void* self, dGeomID a, dGeomID b)
    {
        auto& ode = *static_cast<Ode*>(self);
        const PeerBody &of_a = stated_of(a), &of_b = stated_of(b);
        if (&of_a == &of_b) return;
        if (of_a.motion != Motion::dynamic && of_b.motion != Motion::dynamic) return;
        dContact contacts[kMostContacts];
        const int count = dCollide(a, b, kMostContacts, &contacts[0].geom, sizeof(dContact));
        for (int i = 0; i < count; ++i) {
            dSurfaceParameters& surface = contacts[i].surface;
            surface = {};
            surface.mode = dContactApprox1;
            surface.mu = std::sqrt(of_a.friction * of_b.friction);
            const double bounce = std::max(of_a.restitution, of_b.restitution);
            if (bounce > 0) {
                surface.mode |= dContactBounce;
                surface.bounce = bounce;
                surface.bounce_vel = 0;  // however slow it comes
            }
            dJointID joint = dJointCreateContact(ode.world_, ode.joints_, &contacts[i]);
            dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
        }
        ode.points_ += static_cast<std::size_t>(count);
    }

    void add(const PeerBody& stated)
    {
        dBodyID body = stated.motion == Motion::static_ ? nullptr : add_moving(stated);
        bodies_.push_back(body);
        for (std::uint32_t k = 0; k < stated.shapes; ++k) {
            const PeerShape& shape = scene_.shapes[stated.first_shape + k];
            const bool is_plane = shape.kind == ShapeKind::plane && body == nullptr;
            dGeomID geom = is_plane ? make_plane(stated, shape) : make(shape);
            dGeomSetData(geom, const_cast<PeerBody*>(&stated));
            if (is_plane) continue;
            if (body == nullptr) {
                const Pose placed = stated.pose * shape.local;
                dGeomSetPosition(geom, placed.position.x(), placed.position.y(),
                                 placed.position.z());
                dGeomSetQuaternion(geom, DQuat(placed.orientation).numbers);
                continue;
            }
            dGeomSetBody(geom, body);
            if (shape.is_centered()) continue;
            const Vec3& at = shape.local.position;
            dGeomSetOffsetPosition(geom, at.x(), at.y(), at.z());
            dGeomSetOffsetQuaternion(geom, DQuat(shape.local.orientation).numbers);
        }
    }

    dBodyID add_moving(const PeerBody& stated)
    {
        dBodyID body = dBodyCreate(world_);
        const Vec3 &at = stated.pose.position, &v = stated.velocity, &w = stated.angular_velocity;
        dBodySetPosition(body, at.x(), at.y(), at.z());
        dBodySetQuaternion(body, DQuat(stated.pose.orientation).numbers);
        dBodySetLinearVel(body, v.x(), v.y(), v.z());
        dBodySetAngularVel(body, w.x(), w.y(), w.z());
        if (stated.motion == Motion::kinematic) {
            dBodySetKinematic(body);
            return body;
        }
        const Sym3 turn =
            stated.lock_rotation ? Sym3{kUnturnable, kUnturnable, kUnturnable} : stated.inertia;
        dMass mass;
        dMassSetParameters(&mass, stated.mass, 0, 0, 0, turn.xx, turn.yy, turn.zz, turn.xy, turn.xz,
                           turn.yz);
        dBodySetMass(body, &mass);
        return body;
    }

    // It is where it is in the world, and cannot be put elsewhere.
    dGeomID make_plane(const PeerBody& stated, const PeerShape& shape)
    {
        const Vec3 normal = stated.pose.orientation * (shape.local.orientation * shape.size);
        const Vec3 point = (stated.pose * shape.local).position;
        return dCreatePlane(space_, normal.x(), normal.y(), normal.z(), normal.dot(point));
    }

    dGeomID make(const PeerShape& shape)
    {
        const double radius = shape.size.x(), length = 2 * shape.size.y();
        switch (shape.kind) {
        case ShapeKind::sphere:
            return dCreateSphere(space_, radius);
        case ShapeKind::capsule:
            return dCreateCapsule(space_, radius, length);
        case ShapeKind::cylinder:
            return dCreateCylinder(space_, radius, length);
        case ShapeKind::box:
            return dCreateBox(space_, 2 * shape.size.x(), 2 * shape.size.y(), 2 * shape.size.z());
        case ShapeKind::hull: {
            ConvexData& hull = hulls_[shape.index];
            return dCreateConvex(space_, hull.planes.data(),
                                 static_cast<unsigned>(hull.planes.size() / 4), hull.points.data(),
                                 static_cast<unsigned>(hull.points.size() / 3),
                                 hull.polygons.data());
        }
        default:
            refuse_shape("ode", shape.kind);
        }
    }

    PeerScene scene_;
    std::vector<ConvexData> hulls_;
    std::vector<dBodyID> bodies_;  // null: static
    dWorldID world_ = nullptr;
    dSpaceID space_ = nullptr;
    dJointGroupID joints_ = nullptr;
    std::size_t points_ = 0;
};

}  // namespace

std::unique_ptr<Peer> make_ode(const PeerScene& scene) { return std::make_unique<Ode>(scene); }

}  // namespace throng::perf
#endif
