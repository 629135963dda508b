#include "cost/hard_cases/solid_parts.hpp"

#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "pipeline/dials.hpp"
#include "pipeline/world.hpp"

#include <algorithm>
#include <map>
#include <memory>

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

bool is_mesh(const ShapeDescription& shape)
{
    return std::holds_alternative<MeshShape>(shape.shape);
}

double volume_of(const ShapeDescription& shape)
{
    const auto& mesh = std::get<MeshShape>(shape.shape);
    return mass_as_if_closed(build_mesh(mesh.vertices, mesh.triangles).mesh).volume;
}

// One question for each two shapes that meet, asked of all bodies with them.
class HeapQueries {
public:
    explicit HeapQueries(const Scene& scene) : scene_(scene) { }

    VolumeAnswer ask(std::uint32_t shape_a, std::uint32_t shape_b, const Pose& b_in_a, int rays)
    {
        const auto key = std::pair(shape_a, shape_b);
        auto found = queries_.find(key);
        if (found == queries_.end())
            found =
                queries_.emplace(key, VolumeQuery(scene_.shapes[shape_a], scene_.shapes[shape_b]))
                    .first;
        return found->second.ask("depth_image", b_in_a, rays);
    }

private:
    const Scene& scene_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, VolumeQuery> queries_;
};

}  // namespace

Scene taken(const CaseBench& bench, Scene scene, const SolidWayName& way)
{
    scene.settings = bench.settings();
    set_dial(scene.settings, "nonconvex", way.name);
    return scene;
}

double greatest_speed(const World& world)
{
    double speed = 0;
    for (const BodyId body : world.bodies())
        if (world.motion(body) == Motion::dynamic)
            speed = std::max(speed, world.velocity(body).norm());
    return speed;
}

SharedInHeap shared_in_heap(const Scene& scene, const World& world, double reach, int rays)
{
    SharedInHeap shared;
    const std::vector<std::uint32_t> shapes = shapes_of_bodies(scene);
    const std::vector<BodyId> bodies = world.bodies();
    HeapQueries queries(scene);
    std::map<std::uint32_t, double> volumes;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        if (!is_mesh(scene.shapes[shapes[a]])) continue;
        if (!volumes.contains(shapes[a])) volumes[shapes[a]] = volume_of(scene.shapes[shapes[a]]);
        shared.body += volumes[shapes[a]];
        const Pose pose = world.pose(bodies[a]);
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const bool mesh = is_mesh(scene.shapes[shapes[b]]);
            if (mesh && b <= a) continue;
            const Pose b_in_a = seen_from(pose, world.pose(bodies[b]));
            if (mesh && b_in_a.position.norm() > 2 * reach) continue;
            const VolumeAnswer answer = queries.ask(shapes[a], shapes[b], b_in_a, rays);
            if (!answer.trouble.empty()) shared.trouble = answer.trouble;
            shared.volume += answer.volume;
            shared.pairs += answer.volume > 0 ? 1 : 0;
        }
    }
    return shared;
}

}  // namespace throng
