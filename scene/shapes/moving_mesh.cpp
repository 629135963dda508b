#include "scene/shapes/moving_mesh.hpp"

#include "kernels/math/hash.hpp"
#include "scene/shapes/answer_cache.hpp"

#include <limits>

namespace throng {
namespace {

// Kept together: about 100 B each.
constexpr std::size_t kMostTriangles = 1000000;

// The middle of a mesh that lies further from its origin than a few of its sides, else 0.
Vec3 far_center(const std::vector<Vec3>& vertices)
{
    constexpr double kFar = 4;
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const Vec3& vertex : vertices) {
        lower = lower.cwiseMin(vertex);
        upper = upper.cwiseMax(vertex);
    }
    const Vec3 middle = 0.5 * lower + 0.5 * upper;
    const bool far = middle.cwiseAbs().maxCoeff() > kFar * (upper - lower).maxCoeff();
    return far ? middle : Vec3(Vec3::Zero());
}

std::shared_ptr<const MovingMesh> make(const MeshShape& stated)
{
    auto made = std::make_shared<MovingMesh>();
    made->at = far_center(stated.vertices);
    std::vector<Vec3> vertices = stated.vertices;
    for (Vec3& vertex : vertices) vertex -= made->at;
    made->repaired = repair(vertices, stated.triangles);
    return made;
}

std::uint64_t key_of(const MeshShape& stated)
{
    Hash hash;
    hash.add(std::uint64_t{stated.vertices.size()});
    for (const Vec3& vertex : stated.vertices)
        for (const double x : vertex) hash.add(x);
    for (const auto& triangle : stated.triangles)
        for (const std::uint32_t corner : triangle) hash.add(std::uint64_t{corner});
    return hash.value();
}

AnswerCache<MovingMesh>& kept_meshes()
{
    static AnswerCache<MovingMesh> kept(kMostTriangles);
    return kept;
}

}  // namespace

std::shared_ptr<const MovingMesh> moving_mesh(const MeshShape& stated)
{
    return kept_meshes().get(key_of(stated), stated.triangles.size(), [&] { return make(stated); });
}

void forget_moving_mesh(const MeshShape& stated) { kept_meshes().forget(key_of(stated)); }

}  // namespace throng
