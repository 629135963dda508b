#include "pipeline/moving_mesh.hpp"

#include "kernels/math/hash.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <mutex>

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
    made->mended = mend(std::move(vertices), stated.triangles);
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

// What is kept, the oldest first.
class KeptMeshes {
public:
    std::shared_ptr<const MovingMesh> find(std::uint64_t key)
    {
        const std::lock_guard lock(guard_);
        const auto at = place_of(key);
        return at == kept_.end() ? nullptr : at->mesh;
    }

    void keep(std::uint64_t key, std::size_t triangles, std::shared_ptr<const MovingMesh> mesh)
    {
        const std::lock_guard lock(guard_);
        if (triangles > kMostTriangles || place_of(key) != kept_.end()) return;
        kept_.push_back({key, triangles, std::move(mesh)});
        triangles_ += triangles;
        while (triangles_ > kMostTriangles) erase(kept_.begin());
    }

    void forget(std::uint64_t key)
    {
        const std::lock_guard lock(guard_);
        if (const auto at = place_of(key); at != kept_.end()) erase(at);
    }

private:
    struct Kept {
        std::uint64_t key;
        std::size_t triangles;
        std::shared_ptr<const MovingMesh> mesh;
    };

    std::deque<Kept>::iterator place_of(std::uint64_t key)
    {
        return std::find_if(kept_.begin(), kept_.end(),
                            [&](const Kept& one) { return one.key == key; });
    }
    void erase(std::deque<Kept>::iterator at)
    {
        triangles_ -= at->triangles;
        kept_.erase(at);
    }

    std::mutex guard_;
    std::deque<Kept> kept_;
    std::size_t triangles_ = 0;
};

KeptMeshes& kept_meshes()
{
    static KeptMeshes kept;
    return kept;
}

}  // namespace

std::shared_ptr<const MovingMesh> moving_mesh(const MeshShape& stated)
{
    const std::uint64_t key = key_of(stated);
    if (auto known = kept_meshes().find(key)) return known;
    std::shared_ptr<const MovingMesh> made = make(stated);
    kept_meshes().keep(key, stated.triangles.size(), made);
    return made;
}

void forget_moving_mesh(const MeshShape& stated) { kept_meshes().forget(key_of(stated)); }

}  // namespace throng
