// Group collide: where and how near two shapes of a group are, whatever their kinds.
#include "narrowphase/convex/query_gjk.hpp"
#include "narrowphase/dispatch.hpp"
#include "narrowphase/manifold/places_between.hpp"
#include "narrowphase/solid/sphere_separations.hpp"
#include "narrowphase/solid/surface_separations.hpp"
#include "pipeline/event_driven/event_driven_group.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// The most points that hold a face: those of a mesh are told triangle by triangle, each corner by
// all that meet there, and a joint solve pays for each.
constexpr std::size_t kMostOfFace = 8;
// Pairs of triangles that take as long as two convex shapes do.
constexpr std::size_t kTrianglePairs = 2;
// Sine of the angle between normals of one face; and what of a tolerance two points of it are
// apart.
constexpr double kOneFace = 1e-6, kSame = 1e-3;

bool has_spheres(const Shapes& shapes, ShapeRef shape)
{
    return shape.kind == ShapeKind::solid && !shapes.solids[shape.index].spheres.levels.empty();
}

// Who of two is told from: a solid before a mesh, before what is convex, before a plane.
int stands_first(const Shapes& shapes, ShapeRef shape)
{
    switch (shape.kind) {
    case ShapeKind::solid:
        return has_spheres(shapes, shape) ? 4 : 3;
    case ShapeKind::mesh:
        return 2;
    case ShapeKind::plane:
        return 0;
    default:
        return 1;
    }
}

}  // namespace

// Where two touch with their bodies at these poses, out to `speculative_margin`: meshes and solids
// have many places.
void EventDrivenGroup::collide_pair(PairKey key,
                                    const Pose& a,
                                    const Pose& b,
                                    double speculative_margin)
{
    const Colliders& colliders = scene_.colliders;
    const Shapes& shapes = scene_.shapes;
    std::uint32_t first = first_of(key), second = second_of(key);
    Pose pose_a = a * colliders.local[first], pose_b = b * colliders.local[second];
    if (stands_first(shapes, colliders.shape[second])
        > stands_first(shapes, colliders.shape[first])) {
        std::swap(first, second);
        std::swap(pose_a, pose_b);
    }
    manifolds_ = {first, second, pose_a, {}};
    const ShapeRef shape_a = colliders.shape[first], shape_b = colliders.shape[second];
    const Pose seen = pose_seen_from_a(shapes, shape_b, pose_a, pose_b);
    if (has_spheres(shapes, shape_a)) {
        find_sphere_separations({shapes, shape_a, shape_b, seen, speculative_margin},
                                manifolds_.manifolds);
        return;
    }
    const bool flat = shape_b.kind == ShapeKind::plane;
    if (mesh_of(shapes, shape_a) && (flat || mesh_of(shapes, shape_b))) {
        spend(find_surface_separations({shapes, shape_a, shape_b, seen, speculative_margin},
                                       manifolds_.manifolds)
              / kTrianglePairs);
        return;
    }
    if (mesh_of(shapes, shape_a)) {
        triangles_.clear();
        collide_mesh({shapes, shape_a, shape_b, seen, speculative_margin}, triangles_);
        for (const auto& touched : triangles_) manifolds_.manifolds.push_back(touched.manifold);
        return;
    }
    PairCache cache;
    LocalManifold<double> found;
    collide<double>({shapes, shape_a, shape_b, seen, speculative_margin}, cache, found);
    const auto is_simple = [](ShapeRef shape) {
        return shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::plane;
    };
    if (found.count > 0 && !is_simple(shape_a) && !is_simple(shape_b))
        look_closer(ConvexPair(shapes, shape_a, shape_b, seen), tolerance_of(key),
                    speculative_margin, found);
    if (found.count > 0) manifolds_.manifolds.push_back(found);
}

// Of the points of one face those that span it, the deepest among them.
void EventDrivenGroup::thin_out(double tolerance)
{
    std::vector<LocalManifold<double>>& all = manifolds_.manifolds;
    if (all.size() < 2) return;
    std::vector<LocalManifold<double>> left;
    std::vector<std::uint8_t> done(all.size(), 0);
    std::vector<LocalManifold<double>::Point> points;
    std::vector<std::size_t> taken;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (done[i] || all[i].count == 0) continue;
        points.clear();
        for (std::size_t k = i; k < all.size(); ++k) {
            if (done[k] || !((all[k].normal - all[i].normal).norm() <= kOneFace)) continue;
            done[k] = 1;
            points.insert(points.end(), all[k].points.begin(),
                          all[k].points.begin() + all[k].count);
        }
        taken.clear();
        take_between(points, kSame * tolerance, 0, kMostOfFace, taken);
        for (const std::size_t at : taken) {
            left.emplace_back().normal = all[i].normal;
            left.back().add(points[at].position, points[at].separation, points[at].feature);
        }
    }
    all = std::move(left);
}

// Manifolds favour faces over edges: by more than the tolerance in how far apart two are, and where
// they meet at one point, by the normal, along which they then slide into one another. The nearest
// points tell.
void EventDrivenGroup::look_closer(const ConvexPair& pair,
                                   double tolerance,
                                   double speculative_margin,
                                   LocalManifold<double>& found)
{
    double least = found.points[0].separation;
    for (int k = 1; k < found.count; ++k)
        least = std::min(least, found.points[static_cast<std::size_t>(k)].separation);
    MethodMemory memory;
    const MethodAnswer nearest = query_gjk(pair, speculative_margin, MethodStart::cold, memory);
    if (nearest.overlap == throng::OverlapState::undecided || nearest.cut_short) return;
    if (found.count > 1 && std::abs(nearest.separation - least) < tolerance / 4) return;
    found = {};
    if (nearest.separation > speculative_margin) return;
    found.normal = nearest.normal;
    found.count = 1;
    found.points[0].position = (nearest.on_a + nearest.on_b) / 2;
    found.points[0].separation = nearest.separation;
}

// m, by how much the depth of two that overlap may be told wrong: see find_surface_separations().
double EventDrivenGroup::depth_error(PairKey key) const
{
    double error = 0;
    for (const std::uint32_t at : {first_of(key), second_of(key)}) {
        const ShapeRef shape = scene_.colliders.shape[at];
        if (shape.kind == ShapeKind::solid && !has_spheres(scene_.shapes, shape))
            error += scene_.shapes.solids[shape.index].error;
    }
    return error;
}

// m, of bodies at these poses; `speculative_margin` where it is more.
double EventDrivenGroup::separation_of(PairKey key,
                                       const Pose& a,
                                       const Pose& b,
                                       double speculative_margin)
{
    collide_pair(key, a, b, speculative_margin);
    thin_out(tolerance_of(key));
    spend(1 + manifolds_.manifolds.size());
    double separation = speculative_margin;
    for (const LocalManifold<double>& found : manifolds_.manifolds)
        for (int k = 0; k < found.count; ++k)
            separation = std::min(separation, found.points[static_cast<std::size_t>(k)].separation);
    return separation;
}

}  // namespace throng
