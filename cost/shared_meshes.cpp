#include "cost/shared_meshes.hpp"

#include "cooking/repair/mesh_health.hpp"
#include "cost/shared_data.hpp"
#include "scene/files/mesh_file.hpp"

#include <fstream>
#include <sstream>

namespace throng {

std::optional<TriangleSoup> shared_mesh(const std::string& file)
{
    const std::filesystem::path path = find_shared(std::filesystem::path("meshes") / file);
    if (path.empty()) return std::nullopt;
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    MeshFile read = read_mesh_file(text.str(), file);
    RepairedMesh repaired = repair(read.vertices, std::move(read.triangles));
    return TriangleSoup{std::move(repaired.mesh.vertices), std::move(repaired.mesh.triangles)};
}

}  // namespace throng
