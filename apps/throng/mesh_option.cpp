// Mesh option: `--mesh FILE`, a mesh in place of those that throng makes for a scene.
#include "apps/throng/mesh_option.hpp"

#include "scene/files/mesh_file.hpp"
#include "throng/scene_file.hpp"

#include <cmath>

namespace throng {
namespace {

// m: squares of what is within stay far from the ends of double's range.
constexpr double kLeastExtent = 1e-100, kGreatestExtent = 1e100;

/// Throws BadInput unless the triangles have a size by which others can be made of them.
void check_size(const std::string& file, const TriangleSoup& mesh)
{
    double greatest = 0, extent = 0;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) {
            const Vec3& vertex = mesh.vertices[corner];
            const Vec3& first = mesh.vertices[mesh.triangles.front()[0]];
            greatest = std::max(greatest, vertex.cwiseAbs().maxCoeff());
            extent = std::max(extent, (vertex - first).cwiseAbs().maxCoeff());
        }
    if (mesh.triangles.empty())
        throw BadInput("--mesh: " + file + ": has no faces; give an OBJ or STL file that has some");
    if (!(extent >= kLeastExtent && greatest <= kGreatestExtent))
        throw BadInput("--mesh: " + file + ": wanted a mesh of some size, within 1e100 m");
}

}  // namespace

MeshOption::MeshOption(const Options& options) : file_(options.text("--mesh"))
{
    if (!asked_for()) return;
    const FileContent content = read_file(file_, kGreatestMeshFile);
    if (!content.trouble.empty()) throw BadInput("--mesh: " + file_ + ": " + content.trouble);
    if (content.size > kGreatestMeshFile)
        throw BadInput("--mesh: " + file_ + ": wanted a mesh file of at most 4 GiB");
    MeshFile read = read_mesh_file(content.bytes, file_);
    mesh_ = {std::move(read.vertices), std::move(read.triangles)};
    check_size(file_, mesh_);
}

void MeshOption::check(const CatalogEntry& entry) const
{
    if (!asked_for() || entry.make_of != nullptr) return;
    std::string others;
    for (const CatalogEntry& other : catalog())
        if (other.make_of != nullptr)
            others += (others.empty() ? "" : ", ") + std::string(other.name);
    throw BadInput("--mesh: " + std::string(entry.name)
                   + " has no mesh that another could replace; these have: " + others);
}

Scene MeshOption::make(const CatalogEntry& entry, int size, std::uint64_t seed) const
{
    check(entry);
    return asked_for() ? entry.make_of(size, seed, mesh_) : entry.make(size, seed);
}

}  // namespace throng
