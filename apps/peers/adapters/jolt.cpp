// Jolt Physics, as its user has built it: its own defaults.
// Its own before all others of it:
// clang-format off
#include <Jolt/Jolt.h>
// clang-format on

#include "apps/peers/adapters/adapter.hpp"

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemThreadPool.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/CylinderShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/PlaneShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Collision/Shape/StaticCompoundShape.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>
#include <map>
#include <mutex>
#include <tuple>
#include <vector>

namespace throng::adapters {
namespace {

enum : JPH::ObjectLayer { kStill, kMoving };

class Layers final : public JPH::BroadPhaseLayerInterface {
public:
    JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
    JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override
    {
        return JPH::BroadPhaseLayer(static_cast<JPH::BroadPhaseLayer::Type>(layer));
    }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
    const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "layer"; }
#endif
};

class MeetsLayer final : public JPH::ObjectVsBroadPhaseLayerFilter {
public:
    bool ShouldCollide(JPH::ObjectLayer a, JPH::BroadPhaseLayer b) const override
    {
        return a == kMoving || b == JPH::BroadPhaseLayer(kMoving);
    }
};

class MeetsObject final : public JPH::ObjectLayerPairFilter {
public:
    bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override
    {
        return a == kMoving || b == kMoving;
    }
};

float number(double x) { return static_cast<float>(x); }
JPH::Vec3 vector_of(const double* v) { return {number(v[0]), number(v[1]), number(v[2])}; }
JPH::Quat turn_of(const double* q)
{
    return JPH::Quat(number(q[0]), number(q[1]), number(q[2]), number(q[3])).Normalized();
}

// Its capsules and cylinders lie along y: brings y to z.
JPH::Quat y_to_z() { return JPH::Quat::sRotation(JPH::Vec3::sAxisX(), JPH::JPH_PI / 2); }
bool lies_along_y(ShapeKind kind)
{
    return kind == ShapeKind::capsule || kind == ShapeKind::cylinder;
}

void begin_once()
{
    static std::once_flag once;
    std::call_once(once, [] {
        JPH::RegisterDefaultAllocator();
        JPH::Factory::sInstance = new JPH::Factory;
        JPH::RegisterTypes();
    });
}

template <class Settings>
JPH::Ref<JPH::Shape> made(const Settings& settings)
{
    const JPH::ShapeSettings::ShapeResult result = settings.Create();
    if (result.HasError()) throw std::invalid_argument(result.GetError().c_str());
    return result.Get();
}

class Jolt final : public Engine {
public:
    Jolt(const Scene& scene, int threads)
        : scene_(scene), scratch_((64u << 20) + static_cast<JPH::uint>(scene.body_count) * 24576),
          jobs_(JPH::cMaxPhysicsJobs, JPH::cMaxPhysicsBarriers, threads - 1)
    {
        const auto count = static_cast<JPH::uint>(scene.body_count);
        system_.Init(count + 64, 0, count * 24 + 65536, count * 12 + 20480, layers_, meets_layer_,
                     meets_object_);
        system_.SetGravity(vector_of(scene.gravity));
        system_.SetCombineRestitution([](const JPH::Body& a, const JPH::SubShapeID&,
                                         const JPH::Body& b, const JPH::SubShapeID&) {
            return std::sqrt(a.GetRestitution() * b.GetRestitution());
        });
        JPH::BodyIDVector ids;
        for (std::size_t i = 0; i < scene.body_count; ++i) {
            bodies_.push_back(add(scene.bodies[i]));
            ids.push_back(bodies_.back()->GetID());
        }
        if (ids.empty()) return;
        JPH::BodyInterface& bodies = system_.GetBodyInterfaceNoLock();
        const auto all = static_cast<int>(ids.size());
        const JPH::BodyInterface::AddState state = bodies.AddBodiesPrepare(ids.data(), all);
        bodies.AddBodiesFinalize(ids.data(), all, state, JPH::EActivation::Activate);
        system_.OptimizeBroadPhase();
    }

    void step(double dt) override
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const Body& stated = scene_.bodies[i];
            if (stated.is_driven()) drive(*bodies_[i], stated);
            if (stated.is_pushed()) bodies_[i]->AddForce(vector_of(stated.force));
        }
        system_.Update(number(dt), 1, &scratch_, &jobs_);
    }

    // It tells of contacts while they are found alone, which would slow it down.
    std::size_t contacts() const override { return 0; }

    void read(State* states) const override
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const JPH::Body& body = *bodies_[i];
            const JPH::RVec3 at = body.GetPosition();
            const JPH::Quat turn =
                turned_[i] ? body.GetRotation() * y_to_z().Conjugated() : body.GetRotation();
            const bool still = body.IsStatic();
            const JPH::Vec3 v = still ? JPH::Vec3::sZero() : body.GetLinearVelocity();
            const JPH::Vec3 w = still ? JPH::Vec3::sZero() : body.GetAngularVelocity();
            *states++ = {{{at.GetX(), at.GetY(), at.GetZ()},
                          {turn.GetX(), turn.GetY(), turn.GetZ(), turn.GetW()}},
                         {v.GetX(), v.GetY(), v.GetZ()},
                         {w.GetX(), w.GetY(), w.GetZ()}};
        }
    }

    std::string settings() const override
    {
        const JPH::PhysicsSettings& settings = system_.GetPhysicsSettings();
        return std::to_string(settings.mNumVelocitySteps) + " velocity steps, "
            + std::to_string(settings.mNumPositionSteps) + " position steps, "
            + (sizeof(JPH::Real) == 8 ? "double" : "single") + " precision";
    }

private:
    using Key = std::tuple<ShapeKind, std::uint32_t, double, double, double>;

    JPH::Body* add(const Body& stated)
    {
        // A body that is one capsule is turned as a whole.
        const Shape& first = scene_.shapes[stated.first_shape];
        const bool alone = stated.shapes == 1 && first.centered;
        const bool turned = alone && lies_along_y(first.kind);
        turned_.push_back(turned);
        JPH::Quat turn = turn_of(stated.pose.orientation);
        if (turned) turn = turn * y_to_z();

        const double* const at = stated.pose.position;
        using Number = JPH::Real;
        JPH::BodyCreationSettings settings(
            first.kind == ShapeKind::plane ? plane(first)
                : alone                    ? plain(first)
                                           : compound(stated),
            {static_cast<Number>(at[0]), static_cast<Number>(at[1]), static_cast<Number>(at[2])},
            turn, motion_of(stated.motion),
            stated.motion == Motion::static_ ? JPH::ObjectLayer(kStill)
                                             : JPH::ObjectLayer(kMoving));
        settings.mFriction = number(stated.friction);
        settings.mRestitution = number(stated.restitution);
        settings.mLinearDamping = settings.mAngularDamping = 0;
        settings.mAllowSleeping = false;
        settings.mLinearVelocity = vector_of(stated.velocity);
        settings.mAngularVelocity = vector_of(stated.angular_velocity);
        if (stated.motion == Motion::dynamic) {
            settings.mOverrideMassProperties = JPH::EOverrideMassProperties::MassAndInertiaProvided;
            settings.mMassPropertiesOverride.mMass = number(stated.mass);
            settings.mMassPropertiesOverride.mInertia = inertia_of(stated, turned);
        }
        if (stated.lock_rotation)
            settings.mAllowedDOFs = JPH::EAllowedDOFs::TranslationX
                | JPH::EAllowedDOFs::TranslationY | JPH::EAllowedDOFs::TranslationZ;
        JPH::Body* const body = system_.GetBodyInterfaceNoLock().CreateBody(settings);
        if (body == nullptr) throw std::invalid_argument("has no room for as many bodies");
        return body;
    }

    static JPH::EMotionType motion_of(Motion motion)
    {
        return motion == Motion::static_  ? JPH::EMotionType::Static
            : motion == Motion::kinematic ? JPH::EMotionType::Kinematic
                                          : JPH::EMotionType::Dynamic;
    }

    // In the axes of its body, whose y is z here where it was turned.
    static JPH::Mat44 inertia_of(const Body& stated, bool turned)
    {
        const double* const i = stated.inertia;
        const JPH::Mat44 here(JPH::Vec4(number(i[0]), number(i[3]), number(i[4]), 0),
                              JPH::Vec4(number(i[3]), number(i[1]), number(i[5]), 0),
                              JPH::Vec4(number(i[4]), number(i[5]), number(i[2]), 0),
                              JPH::Vec4(0, 0, 0, 1));
        if (!turned) return here;
        const JPH::Mat44 turn = JPH::Mat44::sRotation(y_to_z());
        return turn.Transposed3x3() * here * turn;
    }

    // Bodies of equal shape share one.
    JPH::Ref<JPH::Shape> plain(const Shape& shape)
    {
        const Key key(shape.kind, shape.index, shape.size[0], shape.size[1], shape.size[2]);
        JPH::Ref<JPH::Shape>& known = known_[key];
        if (known == nullptr) known = make(shape);
        return known;
    }

    JPH::Ref<JPH::Shape> compound(const Body& stated)
    {
        JPH::StaticCompoundShapeSettings settings;
        for (std::uint32_t k = 0; k < stated.shapes; ++k) {
            const Shape& shape = scene_.shapes[stated.first_shape + k];
            JPH::Quat turn = turn_of(shape.local.orientation);
            if (lies_along_y(shape.kind)) turn = turn * y_to_z();
            settings.AddShape(vector_of(shape.local.position), turn, plain(shape));
        }
        return made(settings);
    }

    JPH::Ref<JPH::Shape> make(const Shape& shape)
    {
        const float radius = number(shape.size[0]), half_length = number(shape.size[1]);
        switch (shape.kind) {
        case ShapeKind::sphere:
            return made(JPH::SphereShapeSettings(radius));
        case ShapeKind::capsule:
            return made(JPH::CapsuleShapeSettings(half_length, radius));
        case ShapeKind::cylinder:
            return made(JPH::CylinderShapeSettings(half_length, radius));
        case ShapeKind::box:
            return made(JPH::BoxShapeSettings(vector_of(shape.size)));
        case ShapeKind::hull: {
            const Triangles& stated = scene_.hulls[shape.index];
            JPH::Array<JPH::Vec3> points;
            for (std::size_t i = 0; i < stated.vertex_count; ++i)
                points.push_back(vector_of(stated.vertices + 3 * i));
            return made(JPH::ConvexHullShapeSettings(points));
        }
        case ShapeKind::mesh: {
            const Triangles& stated = scene_.meshes[shape.index];
            JPH::VertexList vertices;
            JPH::IndexedTriangleList triangles;
            for (std::size_t i = 0; i < stated.vertex_count; ++i) {
                const double* const at = stated.vertices + 3 * i;
                vertices.push_back({number(at[0]), number(at[1]), number(at[2])});
            }
            for (std::size_t i = 0; i < stated.triangle_count; ++i) {
                const std::uint32_t* const corner = stated.corners + 3 * i;
                triangles.push_back(JPH::IndexedTriangle(corner[0], corner[1], corner[2], 0));
            }
            return made(JPH::MeshShapeSettings(vertices, triangles));
        }
        case ShapeKind::plane:
            break;
        }
        refuse_shape(shape.kind);
    }

    // None that a compound could have; its offset is its own.
    static JPH::Ref<JPH::Shape> plane(const Shape& shape)
    {
        const JPH::Vec3 normal = vector_of(shape.size);
        return made(JPH::PlaneShapeSettings(
            JPH::Plane::sFromPointAndNormal(vector_of(shape.local.position), normal)));
    }

    static void drive(JPH::Body& body, const Body& stated)
    {
        JPH::Vec3 velocity = body.GetLinearVelocity();
        for (JPH::uint k = 0; k < 3; ++k)
            if (!std::isnan(stated.drive[k])) velocity.SetComponent(k, number(stated.drive[k]));
        body.SetLinearVelocity(velocity);
    }

    const Scene& scene_;
    Layers layers_;
    MeetsLayer meets_layer_;
    MeetsObject meets_object_;
    JPH::TempAllocatorImpl scratch_;
    JPH::JobSystemThreadPool jobs_;
    std::map<Key, JPH::Ref<JPH::Shape>> known_;
    JPH::PhysicsSystem system_;
    std::vector<JPH::Body*> bodies_;
    std::vector<bool> turned_;
};

}  // namespace

Engine* make_engine(const Scene& scene, int threads)
{
    begin_once();
    return new Jolt(scene, threads);
}

}  // namespace throng::adapters
