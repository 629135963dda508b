#include "narrowphase/solids/field_cache.hpp"

#include "kernels/math/hash.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>

namespace throng {
namespace {

namespace fs = std::filesystem;

// A change of what is computed or written is another version.
constexpr std::uint64_t kVersion = 1;
// Behind the .vdb, which other tools read without it: a word of ours and the checksum.
constexpr std::uint64_t kMark = 0x31646c6669676874;
constexpr std::size_t kTrailer = 16;

// Four chains side by side: one alone would take longer than reading the file.
std::uint64_t checksum(const char* bytes, std::size_t size)
{
    std::array<Hash, 4> chains;
    std::size_t at = 0;
    for (; at + 32 <= size; at += 32) {
        std::array<std::uint64_t, 4> words;
        std::memcpy(words.data(), bytes + at, 32);
        for (std::size_t k = 0; k < 4; ++k) chains[k].add(words[k]);
    }
    Hash all;
    for (const Hash& chain : chains) all.add(chain.value());
    for (; at < size; ++at) all.add(std::uint64_t{static_cast<unsigned char>(bytes[at])});
    all.add(std::uint64_t{size});
    return all.value();
}

std::string bytes_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) return {};
    const std::streamoff size = file.tellg();
    if (size <= 0) return {};
    std::string bytes(static_cast<std::size_t>(size), '\0');
    file.seekg(0);
    file.read(bytes.data(), size);
    return file ? bytes : std::string();
}

bool sealed(const fs::path& path)
{
    const std::string bytes = bytes_of(path);
    if (bytes.size() <= kTrailer) return false;
    std::array<std::uint64_t, 2> trailer;
    const std::size_t size = bytes.size() - kTrailer;
    std::memcpy(trailer.data(), bytes.data() + size, kTrailer);
    return trailer[0] == kMark && trailer[1] == checksum(bytes.data(), size);
}

bool seal(const fs::path& path)
{
    const std::string bytes = bytes_of(path);
    if (bytes.empty()) return false;
    const std::array<std::uint64_t, 2> trailer{kMark, checksum(bytes.data(), bytes.size())};
    std::array<char, kTrailer> written;
    std::memcpy(written.data(), trailer.data(), kTrailer);
    std::ofstream file(path, std::ios::binary | std::ios::app);
    file.write(written.data(), kTrailer);
    file.close();
    return !file.fail();
}

std::optional<FieldResult> kept_field(const fs::path& path, const std::string& key)
{
    if (!sealed(path)) return std::nullopt;
    VdbFile file = read_vdb(path, VdbWants::bricks);
    if (!file.trouble.empty() || file.notes.key != key || file.bricks.empty()) return std::nullopt;
    return FieldResult{std::move(file.bricks), file.notes.error, std::move(file.notes.remarks), {}};
}

// Under a name of its own first, so that no program ever reads half a file.
std::string keep(const fs::path& path, const std::string& key, const FieldResult& result)
{
    std::error_code failed;
    fs::create_directories(path.parent_path(), failed);
    // Any number will do that no other program draws at the same time.
    std::random_device draw;
    Hash name;
    for (int k = 0; k < 2; ++k) name.add(std::uint64_t{draw()});
    fs::path part = path;
    part.replace_extension("." + name.text() + ".part");
    std::string trouble = write_vdb(part, result.bricks, {key, result.error, result.remarks});
    if (trouble.empty() && !seal(part)) trouble = part.string() + ": cannot be written";
    if (trouble.empty()) {
        fs::rename(part, path, failed);
        if (failed) trouble = path.string() + ": cannot be written: " + failed.message();
    }
    if (!trouble.empty()) fs::remove(part, failed);
    return trouble;
}

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

std::string field_key(const Mesh& mesh, const FieldSettings& settings)
{
    Hash hash;
    hash.add(kVersion);
    hash.add(settings.voxel != 0 ? settings.voxel : voxel_size_for(mesh));
    hash.add(kBandVoxels);
    hash.add(static_cast<std::uint64_t>(settings.sign));
    hash.add(std::uint64_t{mesh.vertices.size()});
    for (const Vec3& vertex : mesh.vertices)
        for (const double part : vertex) hash.add(part);
    for (const auto& [a, b, c] : mesh.triangles) {
        hash.add(std::uint64_t{a} << 32 | b);
        hash.add(std::uint64_t{c});
    }
    return hash.text();
}

FieldResult cached_field(const Mesh& mesh, const FieldSettings& settings, const fs::path& folder)
{
    if (folder.empty()) return build_field(mesh, settings);
    const std::string key = field_key(mesh, settings);
    const fs::path path = folder / (key + ".vdb");
    if (std::optional<FieldResult> kept = kept_field(path, key)) return std::move(*kept);
    FieldResult result = build_field(mesh, settings);
    if (!result.trouble.empty()) return result;
    const std::string trouble = keep(path, key, result);
    if (!trouble.empty()) result.remarks.push_back("not kept for the next run: " + trouble);
    return result;
}

}  // namespace throng
