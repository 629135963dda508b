// Body rules: what a body of a scene must be, on its own or as one of many instances.
#include "scene/names.hpp"
#include "scene/rules/scene_rules.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <set>

namespace throng {
namespace {

/// An inertia that some distribution of mass can have.
void check_inertia(const Sym3& inertia, const SceneChecker& checker)
{
    const Mat3 matrix = inertia.matrix();
    checker.need(matrix.cwiseAbs().maxCoeff() <= kGreatestMoment,
                 "wanted moments of a size that a step can hold");
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(matrix, Eigen::EigenvaluesOnly);
    const Vec3 moments = solver.eigenvalues();  // ascending
    checker.need(moments[0] > 0, "wanted three principal moments above 0 kg m2");
    checker.need(moments[0] >= kLeastMoment, "wanted moments of a size that a step can hold");
    // A plate reaches equality; printed numbers are rounded.
    checker.need(moments[0] + moments[1] >= moments[2] * (1 - 1e-6),
                 "wanted principal moments none of which is greater than the sum of the other two");
}

bool drives(const BodyDescription& body)
{
    return std::any_of(body.drive_velocity.begin(), body.drive_velocity.end(),
                       [](const std::optional<double>& speed) { return speed.value_or(0) != 0; });
}

/// Nothing is asked for that something else rules out.
void check_contradictions(const BodyDescription& body, const SceneChecker& checker)
{
    const bool dynamic = body.motion == Motion::dynamic;
    const char* const only_dynamic = "wanted a body of motion dynamic for this";
    checker.at("force").need(dynamic || body.force.isZero(0), only_dynamic);
    checker.at("torque").need(dynamic || body.torque.isZero(0), only_dynamic);
    checker.at("gravity_scale").need(dynamic || body.gravity_scale == 1, only_dynamic);
    checker.at("pivot").need(dynamic || !body.pivot, only_dynamic);
    checker.at("pivot").need(!body.pivot || !body.lock_position,
                             "wanted either pivot or lock_position, not both");
    checker.at("drive_velocity")
        .need(!drives(body) || !body.lock_position, "wanted no drive_velocity with lock_position");
    checker.at("drive_velocity")
        .need(!drives(body) || !body.pivot, "wanted no drive_velocity with pivot");
}

/// Velocities that the body can have. The keys name them.
bool may_move(const BodyDescription& body)
{
    return body.motion != Motion::static_ && !body.lock_position && !body.pivot;
}
bool may_turn(const BodyDescription& body)
{
    return body.motion != Motion::static_ && !body.lock_rotation;
}

/// Mass and moments of a dynamic body, from what is given and from its shape.
void check_mass(const BodyDescription& body,
                const MassProperties& shape,
                double density,
                const SceneChecker& checker)
{
    const double mass = body.mass.value_or(density * shape.volume);
    if (!(mass >= kLeastMass && mass <= kGreatestMass))
        checker.at("mass").refuse("wanted a mass that a step can hold; density and shape give "
                                  + number_text(mass) + " kg");
    if (body.inertia || body.lock_rotation) return;
    const double scale = mass / shape.volume;
    for (const double moment : {shape.inertia.xx, shape.inertia.yy, shape.inertia.zz})
        if (!(moment * scale >= kLeastMoment && moment * scale <= kGreatestMoment))
            checker.at("inertia").refuse("wanted moments that a step can hold; mass and shape give "
                                         + number_text(moment * scale) + " kg m2");
}

void check_shape_and_mass(const Scene& scene,
                          std::span<const MassProperties> masses,
                          const BodyDescription& body,
                          const SceneChecker& checker)
{
    checker.at("shape").need(body.shape == kNone || body.shape < scene.shapes.size(),
                             "wanted a shape of the scene");
    checker.at("material")
        .need(body.material == kNone || body.material < scene.materials.size(),
              "wanted a material of the scene");
    if (body.sensor) {
        const bool stands_for_something = body.shape != kNone
            && !std::holds_alternative<PlaneShape>(scene.shapes[body.shape].shape)
            && !std::holds_alternative<MeshShape>(scene.shapes[body.shape].shape)
            && !std::holds_alternative<VoxelsShape>(scene.shapes[body.shape].shape);
        checker.at("sensor").need(
            stands_for_something,
            "wanted a convex shape of finite size, or a compound of such, for "
            "a sensor");
    }
    checker.at("motion").need(static_cast<std::size_t>(body.motion) < std::size(kMotions),
                              "wanted static, kinematic or dynamic");
    if (body.inertia) check_inertia(*body.inertia, checker.at("inertia"));
    if (body.motion != Motion::dynamic) return;

    if (body.shape == kNone) {
        checker.at("mass").need(body.mass.has_value(), "wanted a mass for a body without a shape");
        checker.at("inertia").need(
            body.inertia || body.lock_rotation,
            "wanted an inertia (or lock_rotation) for a body without a shape");
        return;
    }
    const auto& shape = scene.shapes[body.shape].shape;
    checker.at("motion").need(!std::holds_alternative<PlaneShape>(shape),
                              "wanted static or kinematic for a plane");
    const double density =
        body.material == kNone ? Material{}.density : scene.materials[body.material].density;
    check_mass(body, masses[body.shape], density, checker);
}

void check_body(const Scene& scene,
                std::span<const MassProperties> masses,
                const BodyDescription& body,
                const SceneChecker& checker)
{
    checker.need_fields(body, kBodyFields);
    check_contradictions(body, checker);
    check_shape_and_mass(scene, masses, body, checker);
}

void check_motion(const BodyDescription& body, const SceneChecker& checker)
{
    checker.need_fields(body, kOwnBodyFields);
    checker.at("velocity")
        .need(may_move(body) || body.velocity.isZero(0),
              body.pivot ? "wanted [0, 0, 0] with a pivot: angular_velocity says how it swings"
                         : "wanted [0, 0, 0] for a body that never moves");
    checker.at("angular_velocity")
        .need(may_turn(body) || body.angular_velocity.isZero(0),
              "wanted [0, 0, 0] for a body that never turns");
}

/// What a record says, as a sentence about the file; empty when it is good.
class RecordChecker {
public:
    RecordChecker(const Scene& scene, const Instances& group) : scene_(scene), group_(group) { }

    std::string trouble(std::span<const double> record)
    {
        const auto below = [](double limit) {
            return [limit](double number) { return std::abs(number) <= limit; };
        };
        if (!std::all_of(record.begin(), record.end(), below(kGreatestLength)))
            return "wanted finite numbers of a size that a step can hold";
        const Quat orientation(record[3], record[4], record[5], record[6]);
        if (!is_unit(orientation)) return std::string(kWantedUnitQuaternion);
        const auto zero = [&](std::size_t from) {
            return record[from] == 0 && record[from + 1] == 0 && record[from + 2] == 0;
        };
        if (!may_move(group_.common) && !zero(7))
            return "wanted velocity 0 for a body that never moves";
        if (!may_turn(group_.common) && !zero(10))
            return "wanted angular velocity 0 for a body that never turns";
        return group_.own_sizes ? size_trouble(record[13], record[14], record[15]) : "";
    }

private:
    std::string size_trouble(double x, double y, double z)
    {
        const auto& shape = scene_.shapes[group_.common.shape].shape;
        const bool sphere = std::holds_alternative<SphereShape>(shape);
        const bool box = std::holds_alternative<BoxShape>(shape);
        const bool second_good = sphere ? y == 0 : y >= kLeastLength;
        const bool third_good = box ? z >= kLeastLength : z == 0;
        if (x < kLeastLength || !second_good || !third_good)
            return sphere ? "wanted a size of radius above 0, 0, 0"
                : box     ? "wanted a size of three half extents above 0"
                          : "wanted a size of radius and half length above 0, 0";
        if (group_.common.motion != Motion::dynamic) return {};
        return mass_trouble(shape, x, y, z);
    }

    std::string
    mass_trouble(const decltype(ShapeDescription::shape)& shape, double x, double y, double z)
    {
        scratch_.spheres = {{x}};
        scratch_.capsules = {{x, y}};
        scratch_.cylinders = {{x, y}};
        scratch_.boxes = {{Vec3(x, y, z)}};
        const ShapeKind kind = std::holds_alternative<SphereShape>(shape) ? ShapeKind::sphere
            : std::holds_alternative<CapsuleShape>(shape)                 ? ShapeKind::capsule
            : std::holds_alternative<CylinderShape>(shape)                ? ShapeKind::cylinder
                                                                          : ShapeKind::box;
        const std::uint32_t material = group_.common.material;
        const double density =
            material == kNone ? Material{}.density : scene_.materials[material].density;
        try {
            check_mass(group_.common, mass_of(scratch_, {kind, 0}), density, SceneChecker());
        } catch (const SceneTrouble& trouble) {
            return trouble.wanted;
        }
        return {};
    }

    const Scene& scene_;
    const Instances& group_;
    Shapes scratch_;
};

void check_instances(const Scene& scene,
                     std::span<const MassProperties> masses,
                     const Instances& group,
                     const SceneChecker& checker)
{
    check_body(scene, masses, group.common, checker);
    if (group.own_sizes) {
        const auto* shape =
            group.common.shape == kNone ? nullptr : &scene.shapes[group.common.shape].shape;
        const bool sized = shape
            && (std::holds_alternative<SphereShape>(*shape)
                || std::holds_alternative<CapsuleShape>(*shape)
                || std::holds_alternative<CylinderShape>(*shape)
                || std::holds_alternative<BoxShape>(*shape));
        checker.at("sizes").need(sized, "wanted a sphere, capsule, cylinder or box to size");
    }
    const SceneChecker file = checker.at("file");
    const std::string name = group.file.empty() ? "records" : group.file;
    file.need(group.records.size() % group.stride() == 0,
              "wanted " + std::to_string(group.stride()) + " numbers a record");
    RecordChecker record_checker(scene, group);
    for (std::size_t i = 0; i < group.count(); ++i) {
        const auto record = std::span(group.records).subspan(i * group.stride(), group.stride());
        const std::string trouble = record_checker.trouble(record);
        if (!trouble.empty()) file.refuse(name + ": record " + std::to_string(i) + ": " + trouble);
    }
}

}  // namespace

void check_bodies(const Scene& scene, std::span<const MassProperties> masses)
{
    std::set<std::string_view> names;
    const SceneChecker whole, bodies = whole.at("bodies"), instances = whole.at("instances");
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        const SceneChecker checker = bodies.at(i);
        if (!body.name.empty() && !names.insert(body.name).second)
            checker.at("name").refuse("wanted a name of its own, not " + in_quotes(body.name)
                                      + " again");
        check_body(scene, masses, body, checker);
        check_motion(body, checker);
    }
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        check_instances(scene, masses, scene.instances[i], instances.at(i));
}

}  // namespace throng
