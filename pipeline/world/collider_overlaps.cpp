#include "pipeline/world/collider_overlaps.hpp"

#include "kernels/geometry/shape_bounds.hpp"
#include "narrowphase/dispatch.hpp"
#include "narrowphase/solid/solid_pairs.hpp"

#include <algorithm>

namespace throng {

namespace {

// Solids before meshes before all that is convex, and planes last.
int comes_first(ShapeKind kind)
{
    return kind == ShapeKind::solid ? 3
        : kind == ShapeKind::mesh   ? 2
        : kind == ShapeKind::plane  ? 0
                                    : 1;
}

double mesh_depth(const Shapes& shapes, ShapeRef mesh, ShapeRef other, const Pose& other_in_mesh)
{
    std::vector<PartManifold> found;
    collide_mesh({shapes, mesh, other, other_in_mesh, 0.0}, found);
    double depth = 0;
    for (const auto& on_triangle : found)
        for (int k = 0; k < on_triangle.manifold.count; ++k)
            depth = std::max(depth,
                             -on_triangle.manifold.points[static_cast<std::size_t>(k)].separation);
    return depth;
}

double solid_depth(const Shapes& shapes, ShapeRef solid, ShapeRef other, const Pose& other_in_solid)
{
    std::vector<PartManifold> found;
    collide_solid({shapes, solid, other, other_in_solid, 0.0}, found);
    double depth = 0;
    for (const PartManifold& patch : found)
        for (int k = 0; k < patch.manifold.count; ++k)
            depth = std::max(depth, -patch.manifold.points[static_cast<std::size_t>(k)].separation);
    return depth;
}

std::vector<ColliderOverlap> overlaps_of(const WorldState& state)
{
    const auto& colliders = state.get<Colliders>();
    const auto& shapes = state.get<Shapes>();
    const auto& states = state.get<BodyStates>();
    const std::size_t count = colliders.size();
    std::vector<Pose> placed(count);
    std::vector<Box3> boxes(count);
    std::vector<std::uint8_t> moving(count, 0);
    std::vector<std::uint32_t> asked;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t body = colliders.body[i];
        if (body == kNoBody) continue;
        placed[i] = state.get<Poses>().at(body) * colliders.local[i];
        boxes[i] = shape_bounds(shapes, colliders.shape[i], placed[i]);
        moving[i] = states.dynamic(body) ? 1 : 0;
        asked.push_back(i);
    }
    std::vector<PairKey> pairs;
    AnyPairFinder finder = make_finder(choose_finder(boxes, moving));
    find_overlaps({boxes, moving, asked, true, &state.get<PairFilter>()}, finder, pairs);

    std::vector<double> depth(pairs.size(), 0);
    for_each_block(pairs.size(), 64, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            std::uint32_t a = first_of(pairs[i]), b = second_of(pairs[i]);
            if (comes_first(colliders.shape[b].kind) > comes_first(colliders.shape[a].kind))
                std::swap(a, b);
            const ShapeRef shape_a = colliders.shape[a], shape_b = colliders.shape[b];
            const Pose b_in_a = pose_seen_from_a(shapes, shape_b, placed[a], placed[b]);
            depth[i] = shape_a.kind == ShapeKind::solid
                ? solid_depth(shapes, shape_a, shape_b, b_in_a)
                : shape_a.kind == ShapeKind::mesh
                ? mesh_depth(shapes, shape_a, shape_b, b_in_a)
                : penetration_depth(shapes, shape_a, shape_b, b_in_a);
        }
    });
    std::vector<ColliderOverlap> overlaps;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (depth[i] > 0) overlaps.push_back({first_of(pairs[i]), second_of(pairs[i]), depth[i]});
    return overlaps;
}

}  // namespace

std::vector<ColliderOverlap> find_collider_overlaps(const WorldState& state)
{
    std::vector<ColliderOverlap> overlaps;
    // Measuring changes nothing that a step would notice, so it may use the world's own threads.
    auto& pool = const_cast<WorldState&>(state).pool;  // NOLINT: threads are no part of the state
    pool.run([&](std::size_t, std::size_t, std::size_t) { overlaps = overlaps_of(state); });
    return overlaps;
}

}  // namespace throng
