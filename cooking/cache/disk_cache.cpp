#include "cooking/cache/disk_cache.hpp"

#include "cooking/cache/file_checksum.hpp"

#include <cstdlib>
#include <random>

namespace throng {
namespace {

namespace fs = std::filesystem;

}  // namespace

fs::path default_cache_folder()
{
    // Nothing here changes the environment.
    const char* const cache = std::getenv("XDG_CACHE_HOME");  // NOLINT(concurrency-mt-unsafe)
    // A relative one is to be passed over, as its specification has it.
    if (cache != nullptr && fs::path(cache).is_absolute()) return fs::path(cache) / "throng";
    const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
    if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".cache/throng";
    return {};
}

void add_mesh(const Mesh& mesh, Hash& hash)
{
    hash.add(std::uint64_t{mesh.vertices.size()});
    for (const Vec3& vertex : mesh.vertices)
        for (const double x : vertex) hash.add(x);
    for (const auto& [a, b, c] : mesh.triangles) {
        hash.add(std::uint64_t{a} << 32 | b);
        hash.add(std::uint64_t{c});
    }
}

std::string read_cached(const fs::path& path)
{
    std::string bytes = bytes_of_file(path);
    if (check_checksum(bytes) != ChecksumState::good) return {};
    bytes.resize(bytes.size() - kChecksumBytes);
    return bytes;
}

// Under a name of its own first.
std::string write_cached(const fs::path& path,
                         const std::function<std::string(const fs::path&)>& write)
{
    std::error_code failed;
    fs::create_directories(path.parent_path(), failed);
    // Any number will do that no other program draws at the same time.
    std::random_device draw;
    Hash name;
    for (int k = 0; k < 2; ++k) name.add(std::uint64_t{draw()});
    fs::path part = path;
    part.replace_extension("." + name.text() + ".part");
    std::string trouble = write(part);
    if (trouble.empty() && !append_checksum(part)) trouble = part.string() + ": cannot be written";
    if (trouble.empty()) {
        fs::rename(part, path, failed);
        if (failed) trouble = path.string() + ": cannot be written: " + failed.message();
    }
    if (!trouble.empty()) fs::remove(part, failed);
    return trouble;
}

}  // namespace throng
