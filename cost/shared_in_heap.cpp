#include "cost/shared_in_heap.hpp"

#include "cooking/repair/mesh_health.hpp"
#include "kernels/geometry/mass.hpp"
#include "throng/convex_query.hpp"
#include "throng/volume_query.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <map>

namespace throng {

namespace {

// The shape of each body, in order of id.
std::vector<std::uint32_t> shapes_of_bodies(const Scene& scene)
{
    std::vector<std::uint32_t> shapes;
    for (const BodyDescription& body : scene.bodies) shapes.push_back(body.shape);
    for (const Instances& group : scene.instances)
        shapes.insert(shapes.end(), group.count(), group.common.shape);
    return shapes;
}

// A scene's shape, a mesh repaired as a world mends it.
struct HeapShape {
    ShapeDescription shape;
    bool is_mesh = false;
    double volume = 0;        // m3, of a mesh
    double outer_radius = 0;  // m, of a mesh from its origin
};

HeapShape heap_shape(const ShapeDescription& stated)
{
    HeapShape made{stated};
    auto* const mesh = std::get_if<MeshShape>(&made.shape.shape);
    if (mesh == nullptr) return made;
    const Mesh repaired = repair(mesh->vertices, mesh->triangles).mesh;
    mesh->vertices = repaired.vertices;
    mesh->triangles = repaired.triangles;
    made.is_mesh = true;
    made.volume = mass_as_if_closed(repaired).volume;
    for (const Vec3& vertex : repaired.vertices)
        made.outer_radius = std::max(made.outer_radius, vertex.norm());
    return made;
}

bool can_be_asked(const ShapeDescription& shape)
{
    return !std::holds_alternative<PlaneShape>(shape.shape)
        && !std::holds_alternative<CompoundShape>(shape.shape)
        && !std::holds_alternative<VoxelsShape>(shape.shape);
}

// One question for each two shapes that meet, asked of all bodies with them.
class HeapQueries {
public:
    explicit HeapQueries(const std::vector<HeapShape>& shapes) : shapes_(shapes) { }

    VolumeAnswer ask(std::uint32_t a, std::uint32_t b, const Pose& b_in_a, int rays)
    {
        auto found = queries_.find({a, b});
        if (found == queries_.end())
            found =
                queries_.emplace(std::pair(a, b), VolumeQuery(shapes_[a].shape, shapes_[b].shape))
                    .first;
        return found->second.ask("depth_image", b_in_a, rays);
    }

private:
    const std::vector<HeapShape>& shapes_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, VolumeQuery> queries_;
};

}  // namespace

SharedInHeap shared_in_heap(const Scene& scene, const World& world, int rays)
{
    std::vector<HeapShape> shapes;
    for (const ShapeDescription& stated : scene.shapes) shapes.push_back(heap_shape(stated));
    HeapQueries queries(shapes);

    SharedInHeap shared;
    const std::vector<std::uint32_t> shape_of = shapes_of_bodies(scene);
    const std::vector<BodyId> bodies = world.bodies();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const HeapShape& a = shapes[shape_of[i]];
        if (!a.is_mesh) continue;
        shared.body += a.volume;
        for (std::size_t j = 0; j < bodies.size(); ++j) {
            const HeapShape& b = shapes[shape_of[j]];
            if (b.is_mesh ? j <= i : !can_be_asked(b.shape)) continue;
            const Pose b_in_a = seen_from(world.pose(bodies[i]), world.pose(bodies[j]));
            if (b.is_mesh && b_in_a.position.norm() > a.outer_radius + b.outer_radius) continue;
            const VolumeAnswer answer = queries.ask(shape_of[i], shape_of[j], b_in_a, rays);
            if (!answer.trouble.empty()) shared.trouble = answer.trouble;
            shared.volume += answer.volume;
            shared.pairs += answer.volume > 0 ? 1 : 0;
        }
    }
    return shared;
}

}  // namespace throng
