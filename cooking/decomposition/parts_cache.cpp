#include "cooking/decomposition/parts_cache.hpp"

#include "cooking/cache/cache_words.hpp"
#include "cooking/cache/disk_cache.hpp"
#include "cooking/hulls/hull.hpp"

#include <optional>

namespace throng {
namespace {

namespace fs = std::filesystem;

// A change of what is computed or written is another version.
constexpr std::uint64_t kVersion = 3;

WordWriter words_of(const ConvexParts& parts, const std::string& key)
{
    WordWriter out;
    out.text(key);
    for (const double value : {parts.error, parts.outside, parts.uncovered, parts.volume_error})
        out.number(value);
    out.word(parts.warnings.size());
    for (const std::string& warning : parts.warnings) out.text(warning);
    out.word(parts.points.size());
    for (const auto& points : parts.points) {
        out.word(points.size());
        for (const Vec3& point : points)
            for (const double x : point) out.number(x);
    }
    return out;
}

std::optional<ConvexParts> from_bytes(std::string_view bytes, const std::string& key)
{
    WordReader in(bytes);
    if (in.text() != key) return std::nullopt;
    ConvexParts parts;
    for (double* value : {&parts.error, &parts.outside, &parts.uncovered, &parts.volume_error})
        *value = in.number();
    parts.warnings.resize(in.count(8));
    for (std::string& warning : parts.warnings) warning = in.text();
    parts.points.resize(in.count(8));
    for (auto& points : parts.points) {
        points.resize(in.count(24));
        for (Vec3& point : points)
            for (double& x : point) x = in.number();
        HullResult built = build_hull(points);
        if (!built.trouble.empty()) return std::nullopt;
        parts.hulls.push_back(std::move(built.hull));
    }
    if (!in.at_end() || parts.hulls.empty()) return std::nullopt;
    return parts;
}

}  // namespace

std::string parts_key(const Mesh& mesh, const PartsWanted& wanted)
{
    Hash hash;
    hash.add(kVersion);
    hash.add(static_cast<std::uint64_t>(wanted.max_parts));
    hash.add(wanted.error);
    add_mesh(mesh, hash);
    return hash.text();
}

ConvexParts cached_parts(const Mesh& mesh, const PartsWanted& wanted, const fs::path& folder)
{
    if (folder.empty()) return split_into_parts(mesh, wanted);
    const std::string key = parts_key(mesh, wanted);
    const fs::path path = folder / (key + ".parts");
    if (std::optional<ConvexParts> kept = from_bytes(read_cached(path), key))
        return std::move(*kept);
    ConvexParts parts = split_into_parts(mesh, wanted);
    if (!parts.trouble.empty()) return parts;
    const std::string trouble = write_cached_words(path, words_of(parts, key));
    if (!trouble.empty()) parts.warnings.push_back("not kept for the next run: " + trouble);
    return parts;
}

}  // namespace throng
