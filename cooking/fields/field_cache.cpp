#include "cooking/fields/field_cache.hpp"

#include "cooking/cache/disk_cache.hpp"

#include <optional>

namespace throng {
namespace {

namespace fs = std::filesystem;

// A change of what is computed or written is another version.
constexpr std::uint64_t kVersion = 1;

std::optional<FieldResult> kept_field(const fs::path& path, const std::string& key)
{
    if (read_cached(path).empty()) return std::nullopt;
    VdbFile file = read_vdb(path, VdbWants::bricks);
    if (!file.trouble.empty() || file.notes.key != key || file.bricks.empty()) return std::nullopt;
    return FieldResult{
        std::move(file.bricks), file.notes.error, std::move(file.notes.warnings), {}};
}

}  // namespace

std::string field_key(const Mesh& mesh, const FieldSettings& settings)
{
    Hash hash;
    hash.add(kVersion);
    hash.add(settings.voxel != 0 ? settings.voxel : voxel_size_for(mesh));
    hash.add(settings.band);
    hash.add(static_cast<std::uint64_t>(settings.sign));
    add_mesh(mesh, hash);
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
    const std::string trouble = write_cached(path, [&](const fs::path& part) {
        return write_vdb(part, result.bricks, {key, result.error, result.warnings});
    });
    if (!trouble.empty()) result.warnings.push_back("not kept for the next run: " + trouble);
    return result;
}

}  // namespace throng
