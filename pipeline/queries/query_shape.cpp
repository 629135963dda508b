#include "pipeline/queries/query_shape.hpp"

#include "cooking/hulls/hull.hpp"
#include "scene/rules/scene_check.hpp"
#include "scene/rules/scene_rules.hpp"

#include <algorithm>

namespace throng {
namespace {

struct ShapeMaker {
    Shapes& shapes;

    template <class Shape>
    static ShapeRef append(std::vector<Shape>& kind, ShapeKind name, Shape shape)
    {
        kind.push_back(std::move(shape));
        return {name, static_cast<std::uint32_t>(kind.size() - 1)};
    }
    ShapeRef operator()(const SphereShape& s) const
    {
        return append(shapes.spheres, ShapeKind::sphere, Sphere{s.radius});
    }
    ShapeRef operator()(const CapsuleShape& s) const
    {
        return append(shapes.capsules, ShapeKind::capsule, Capsule{s.radius, s.half_length});
    }
    ShapeRef operator()(const CylinderShape& s) const
    {
        return append(shapes.cylinders, ShapeKind::cylinder, Cylinder{s.radius, s.half_length});
    }
    ShapeRef operator()(const BoxShape& s) const
    {
        return append(shapes.boxes, ShapeKind::box, Box{s.half_extents});
    }
    ShapeRef operator()(const HullShape& s) const
    {
        return append(shapes.hulls, ShapeKind::hull, build_hull(s.points).hull);
    }
    // Not asked for.
    ShapeRef operator()(const PlaneShape&) const { return {}; }
    ShapeRef operator()(const MeshShape&) const { return {}; }
    ShapeRef operator()(const CompoundShape&) const { return {}; }
    ShapeRef operator()(const VoxelsShape&) const { return {}; }
};

}  // namespace

std::string trouble_with(const ShapeDescription& shape)
{
    Scene scene;
    scene.shapes.push_back({"", shape.shape});
    try {
        check_shapes(scene);
    } catch (const SceneTrouble& trouble) {
        // The path leads through a scene that nobody but us has seen.
        const ScenePath inside(trouble.path.begin() + std::min<long>(2, std::ssize(trouble.path)),
                               trouble.path.end());
        return path_text(inside) + ": " + trouble.wanted;
    }
    return {};
}

std::string trouble_with(const Pose& pose)
{
    if (!pose.position.allFinite() || pose.position.cwiseAbs().maxCoeff() > kGreatestLength)
        return "position is not finite or too far; give a place in m";
    if (!is_unit(pose.orientation)) return std::string(kWantedUnitQuaternion);
    return {};
}

ShapeRef append_convex(Shapes& shapes, const ShapeDescription& shape)
{
    return std::visit(ShapeMaker{shapes}, shape.shape);
}

}  // namespace throng
