#include "throng/volume_query.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "narrowphase/alternatives/clip_volume.hpp"
#include "narrowphase/alternatives/exact_volume.hpp"
#include "narrowphase/alternatives/shared_volume.hpp"
#include "pipeline/queries/query_shape.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <span>

namespace throng {
namespace {

// A million rays, and some 200 MB for each of the bodies' layers at that.
constexpr int kMostResolution = 1024;
// Pairs of triangles, at a nanosecond for those apart and a microsecond for the others: seconds.
constexpr double kMostExact = 2e7;

bool has_flat_faces(ShapeRef shape)
{
    return shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull
        || shape.kind == ShapeKind::mesh;
}

SharedVolume by_images(const VolumePair& pair, int rays) { return shared_by_images(pair, rays); }

SharedVolume by_single_layer(const VolumePair& pair, int rays)
{
    return shared_by_images(pair, rays, Layers::single);
}

SharedVolume by_voxels(const VolumePair& pair, int cells) { return shared_by_voxels(pair, cells); }

SharedVolume by_exact(const VolumePair& pair, int)
{
    if (pair.a.kind == ShapeKind::mesh || pair.b.kind == ShapeKind::mesh)
        return shared_exactly(pair);
    const ConvexPair convex(pair.shapes, pair.a, pair.b, pair.b_in_a);
    MethodMemory memory;
    const MethodAnswer told = query_clip_volume(convex, 0, MethodStart::cold, memory);
    if (!(told.volume > 0)) return {};
    return {told.volume, told.center, Vec3::Zero(), 0};
}

struct VolumeWay {
    VolumeWayDescription description;
    SharedVolume (*ask)(const VolumePair& pair, int resolution);
};

// clang-format off
constexpr VolumeWay kWays[] = {
    {{"exact", "cuts parts of the one by parts of the other", false, false, true}, by_exact},
    {{"voxels", "counts the centers of cells inside both", false, true, false}, by_voxels},
    {{"depth_image", "adds up what rays share, layer by layer", true, true, false}, by_images},
    {{"single_layer", "the same from first way in to last way out: fills holes", true, true, false}, by_single_layer},
};
// clang-format on

// Empty, or why a mesh encloses nothing that could be shared.
std::string trouble_with_mesh(const MeshShape& shape, Mesh& mesh)
{
    MeshResult built = build_mesh(shape.vertices, shape.triangles);
    if (!built.trouble.empty()) return built.trouble;
    mesh = std::move(built.mesh);
    if (!is_closed(mesh)) {
        std::ptrdiff_t rims = 0;
        for (const auto& beyond : mesh.adjacent)
            rims += std::count(beyond.begin(), beyond.end(), -1);
        return "mesh: open, " + std::to_string(rims)
            + " edges of triangles have no other one beyond; wanted a closed mesh";
    }
    if (!(mass_of(mesh).volume > 0))
        return "mesh: turned inside out; wanted triangles counter-clockwise seen from outside";
    return {};
}

// Makes the shape, or says what is wrong with it.
std::string make(const ShapeDescription& shape, Shapes& shapes, ShapeRef& made)
{
    if (std::holds_alternative<PlaneShape>(shape.shape)
        || std::holds_alternative<CompoundShape>(shape.shape)
        || std::holds_alternative<VoxelsShape>(shape.shape))
        return "wanted a sphere, capsule, cylinder, box, hull or closed mesh";
    if (std::string trouble = trouble_with(shape); !trouble.empty()) return trouble;
    const auto* const mesh = std::get_if<MeshShape>(&shape.shape);
    if (mesh == nullptr) {
        made = append_convex(shapes, shape);
        return {};
    }
    made = {ShapeKind::mesh, static_cast<std::uint32_t>(shapes.meshes.size())};
    shapes.meshes.emplace_back();
    return trouble_with_mesh(*mesh, shapes.meshes.back());
}

std::string trouble_with(const VolumeWayDescription& way, const VolumePair& pair, int resolution)
{
    if (way.converges && !(resolution >= 1 && resolution <= kMostResolution))
        return "resolution is " + std::to_string(resolution) + "; give 1 to "
            + std::to_string(kMostResolution);
    if (!way.flat_only) return {};
    if (!has_flat_faces(pair.a) || !has_flat_faces(pair.b))
        return "way " + in_quotes(way.name) + " serves boxes, hulls and meshes alone";
    if (exact_cost(pair) > kMostExact)
        return "way " + in_quotes(way.name) + " would take "
            + std::to_string(static_cast<long>(exact_cost(pair))) + " pairs of triangles; "
            + std::to_string(static_cast<long>(kMostExact)) + " are the limit";
    return {};
}

VolumeAnswer refusal(std::string trouble)
{
    VolumeAnswer answer;
    answer.trouble = std::move(trouble);
    return answer;
}

std::string unknown_way(std::string_view way)
{
    std::vector<std::string_view> names;
    for (const VolumeWay& one : kWays) names.push_back(one.description.name);
    return "there is no way " + in_quotes(way) + "; there are: " + either_of(names);
}

}  // namespace

struct VolumeQuery::Inside {
    std::string trouble;
    Shapes shapes;
    ShapeRef a, b;
};

std::vector<VolumeWayDescription> known_volume_ways()
{
    std::vector<VolumeWayDescription> known;
    for (const VolumeWay& way : kWays) known.push_back(way.description);
    return known;
}

VolumeQuery::VolumeQuery(const ShapeDescription& a, const ShapeDescription& b)
    : inside_(std::make_unique<Inside>())
{
    std::string trouble = make(a, inside_->shapes, inside_->a);
    if (!trouble.empty()) {
        inside_->trouble = "shape a: " + trouble;
        return;
    }
    trouble = make(b, inside_->shapes, inside_->b);
    if (!trouble.empty()) inside_->trouble = "shape b: " + trouble;
}

VolumeQuery::~VolumeQuery() = default;
VolumeQuery::VolumeQuery(VolumeQuery&&) noexcept = default;
VolumeQuery& VolumeQuery::operator=(VolumeQuery&&) noexcept = default;

const std::string& VolumeQuery::trouble() const { return inside_->trouble; }

VolumeAnswer VolumeQuery::ask(std::string_view way, const Pose& b_in_a, int resolution)
{
    if (!inside_->trouble.empty()) return refusal(inside_->trouble);
    const auto* const found =
        std::find_if(std::begin(kWays), std::end(kWays),
                     [&](const auto& one) { return one.description.name == way; });
    if (found == std::end(kWays)) return refusal(unknown_way(way));
    if (std::string trouble = throng::trouble_with(b_in_a); !trouble.empty())
        return refusal(std::move(trouble));
    const VolumePair pair{inside_->shapes,
                          inside_->a,
                          inside_->b,
                          {b_in_a.position, b_in_a.orientation.normalized()}};
    if (std::string trouble = trouble_with(found->description, pair, resolution); !trouble.empty())
        return refusal(std::move(trouble));
    const SharedVolume shared = found->ask(pair, resolution);
    return {{}, shared.volume, shared.center, shared.normal, shared.depth};
}

}  // namespace throng
