// Shape rules: what a shape of a scene must be, and what it then weighs.
#include "kernels/geometry/mesh.hpp"
#include "scene/names.hpp"
#include "scene/rules/scene_rules.hpp"
#include "scene/shapes/level_set.hpp"
#include "scene/shapes/moving_mesh.hpp"
#include "scene/shapes/stated_hull.hpp"
#include "throng/dials.hpp"

#include <cmath>
#include <set>

namespace throng {
namespace {

// Of the volume of its box, the least that a mesh which moves must enclose.
constexpr double kThinnest = 1e-9;

MassProperties turned_inside_out(const MassProperties& mass)
{
    const Sym3& of = mass.inertia;
    return {-mass.volume, mass.center, {-of.xx, -of.yy, -of.zz, -of.xy, -of.xz, -of.yz}};
}

/// Checks one shape; a compound's parts are checked as shapes of their own.
struct ShapeChecker {
    const Scene& scene;
    const SceneChecker& checker;
    bool moves;        // a body with it is dynamic
    Shapes scratch{};  // for mass_of()

    template <class Shape>
    MassProperties weigh(std::vector<Shape>& kind, ShapeKind name, Shape shape)
    {
        kind.push_back(std::move(shape));
        return mass_of(scratch, {name, 0});
    }

    MassProperties operator()(const SphereShape& sphere)
    {
        return weigh(scratch.spheres, ShapeKind::sphere, {sphere.radius});
    }
    MassProperties operator()(const CapsuleShape& capsule)
    {
        return weigh(scratch.capsules, ShapeKind::capsule, {capsule.radius, capsule.half_length});
    }
    MassProperties operator()(const CylinderShape& cylinder)
    {
        return weigh(scratch.cylinders, ShapeKind::cylinder,
                     {cylinder.radius, cylinder.half_length});
    }
    MassProperties operator()(const BoxShape& box)
    {
        return weigh(scratch.boxes, ShapeKind::box, {box.half_extents});
    }
    MassProperties operator()(const HullShape& hull)
    {
        const SceneChecker here = checker.at("hull"), points = here.at("points");
        const std::shared_ptr<const HullResult> built = stated_hull(hull);
        points.need(built->trouble.empty(), "wanted a hull; " + built->trouble);
        return mass_of(built->hull);
    }
    MassProperties operator()(const PlaneShape& plane)
    {
        const SceneChecker here = checker.at("plane");
        here.at("normal").need(std::abs(plane.normal.norm() - 1) <= kUnitTolerance,
                               "wanted a direction of unit length");
        return {};
    }
    MassProperties operator()(const MeshShape& mesh)
    {
        const SceneChecker here = checker.at("mesh");
        const SceneChecker file = here.at("file");
        file.need(!mesh.triangles.empty(), "wanted a mesh with triangles, not an empty one");
        for (const Vec3& vertex : mesh.vertices)
            file.need((vertex.cwiseAbs().array() <= kGreatestLength).all(),
                      "wanted vertices of a size that a step can hold, once scaled");
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t corner : triangle)
                file.need(corner < mesh.vertices.size(), "wanted triangles between vertices");
        if (!moves) return {};
        const std::shared_ptr<const MovingMesh> moving = moving_mesh(mesh);
        const RepairedMesh& repaired = moving->repaired;
        file.need(repaired.trouble.empty(), "wanted a mesh that can move; it " + repaired.trouble);
        MassProperties mass = mass_as_if_closed(repaired.mesh);
        if (mass.volume < 0) mass = turned_inside_out(mass);
        mass.center += moving->at;
        const Box3 box = box_of(repaired.mesh);
        file.need(mass.volume > kThinnest * (box.upper - box.lower).prod(),
                  "wanted a mesh that encloses a volume, for a body that moves");
        return mass;
    }
    MassProperties operator()(const VoxelsShape& voxels)
    {
        const SceneChecker here = checker.at("voxels"), file = here.at("file");
        file.need(voxels.level_set != nullptr && !voxels.level_set->field.empty()
                      && !voxels.level_set->surface.tree.empty(),
                  "wanted a level set with a surface, not an empty one");
        const LevelSet& level_set = *voxels.level_set;
        file.need_range(level_set.field.voxel, {kLeastLength, kGreatestLength, "voxels above 0 m"});
        const Box3 box = box_of(level_set.surface);
        file.need_range(box.lower, kPlaces);
        file.need_range(box.upper, kPlaces);
        if (!moves) return {};
        file.need(level_set.whole,
                  "wanted a level set whose surface is closed, for a body that moves; this one is "
                  "cut off where its values end");
        const MassProperties mass = mass_of(level_set.surface);
        file.need(mass.volume > kThinnest * (box.upper - box.lower).prod(),
                  "wanted a level set that encloses a volume, for a body that moves");
        return mass;
    }
    MassProperties operator()(const CompoundShape& compound)
    {
        const SceneChecker parts = checker.at("compound");
        parts.need(!compound.parts.empty(), "wanted at least one part");
        for (std::size_t i = 0; i < compound.parts.size(); ++i) {
            const CompoundShape::Part& part = compound.parts[i];
            const SceneChecker here = parts.at(i);
            here.need_fields(part.pose, kPoseFields);
            here.at("shape").need(part.shape < scene.shapes.size(), "wanted a shape of the scene");
            const auto& shape = scene.shapes[part.shape].shape;
            const bool good = !std::holds_alternative<CompoundShape>(shape)
                && !std::holds_alternative<PlaneShape>(shape)
                && !std::holds_alternative<MeshShape>(shape)
                && !std::holds_alternative<VoxelsShape>(shape);
            here.at("shape").need(
                good, "wanted a sphere, capsule, cylinder, box or hull as part of a compound");
        }
        return {};
    }
};

}  // namespace

ShapeUses shape_uses(const Scene& scene)
{
    const std::vector<bool> none(scene.shapes.size(), false);
    ShapeUses uses{none, none};
    const auto note = [&](const BodyDescription& body) {
        if (body.shape >= scene.shapes.size()) return;
        (body.motion == Motion::dynamic ? uses.dynamic : uses.other)[body.shape] = true;
    };
    for (const BodyDescription& body : scene.bodies) note(body);
    for (const Instances& group : scene.instances) note(group.common);
    return uses;
}

std::vector<MassProperties> check_shapes(const Scene& scene)
{
    std::vector<MassProperties> masses;
    const SceneChecker whole, shapes = whole.at("shapes");
    std::set<std::string_view> names;
    const std::vector<bool> moving = shape_uses(scene).dynamic;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const ShapeDescription& shape = scene.shapes[i];
        const SceneChecker checker = shapes.at(shape.name, i);
        checker.need(shape.name.empty() || names.insert(shape.name).second,
                     "wanted a name of its own for each shape");
        const SceneChecker kind = checker.at(kShapeNames[shape.shape.index()].name);
        std::visit([&](const auto& stated) { kind.need_fields(stated, fields_of(stated)); },
                   shape.shape);
        masses.push_back(std::visit(ShapeChecker{scene, checker, moving[i]}, shape.shape));
    }

    // Compounds last: their parts may be named before or after them.
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const auto* compound = std::get_if<CompoundShape>(&scene.shapes[i].shape);
        if (!compound) continue;
        std::vector<PlacedMass> parts;
        for (const CompoundShape::Part& part : compound->parts)
            parts.push_back({masses[part.shape], part.pose});
        masses[i] = combine(parts);
    }
    return masses;
}

}  // namespace throng
