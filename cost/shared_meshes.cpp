#include "cost/shared_meshes.hpp"

#include "kernels/geometry/mesh_health.hpp"
#include "scenes/mesh_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace throng {

namespace {

namespace fs = std::filesystem;

fs::path find_mesh(const std::string& file)
{
    const fs::path name = fs::path("meshes") / file;
    // Cases change no environment.
    const char* named = std::getenv("THRONG_DATA");  // NOLINT(concurrency-mt-unsafe)
    if (named != nullptr && fs::exists(fs::path(named) / name)) return fs::path(named) / name;
    const fs::path source = fs::absolute(__FILE__);
    for (auto folder = source.parent_path(); folder != folder.root_path();
         folder = folder.parent_path())
        if (fs::exists(folder / "shared/data" / name)) return folder / "shared/data" / name;
    return {};
}

}  // namespace

std::optional<TriangleSoup> shared_mesh(const std::string& file)
{
    const fs::path path = find_mesh(file);
    if (path.empty()) return std::nullopt;
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    MeshFile read = read_mesh_text(text.str(), file);
    MendedMesh mended = mend(std::move(read.vertices), std::move(read.triangles));
    return TriangleSoup{std::move(mended.mesh.vertices), std::move(mended.mesh.triangles)};
}

}  // namespace throng
