#include "cooking/sphere_trees/spheres_cache.hpp"

#include "cooking/cache/cache_words.hpp"
#include "cooking/cache/disk_cache.hpp"

#include <optional>

namespace throng {
namespace {

namespace fs = std::filesystem;

// A change of what is computed or written is another version.
constexpr std::uint64_t kVersion = 1;

WordWriter words_of(const SphereTree& tree, const std::string& key)
{
    WordWriter out;
    out.text(key);
    out.word(tree.levels.size());
    for (const SphereTree::Level& level : tree.levels) {
        out.number(level.error);
        out.word(level.nodes.size());
        for (const SphereTree::Node& node : level.nodes) {
            for (const float x : node.center) out.number(double{x});
            out.number(double{node.radius});
            out.number(double{node.bound});
            out.word(std::uint64_t{node.first} << 32 | node.count);
        }
    }
    return out;
}

SphereTree::Node read_node(WordReader& in)
{
    SphereTree::Node node;
    for (float& x : node.center) x = static_cast<float>(in.number());
    node.radius = static_cast<float>(in.number());
    node.bound = static_cast<float>(in.number());
    const std::uint64_t children = in.word();
    node.first = static_cast<std::uint32_t>(children >> 32);
    node.count = static_cast<std::uint32_t>(children);
    return node;
}

// Whether every node names children that are there.
bool hangs_together(const SphereTree& tree)
{
    for (std::size_t i = 0; i < tree.levels.size(); ++i) {
        const bool last = i + 1 == tree.levels.size();
        const std::size_t below = last ? 0 : tree.levels[i + 1].nodes.size();
        for (const SphereTree::Node& node : tree.levels[i].nodes)
            if (node.count > 0 && std::uint64_t{node.first} + node.count > below) return false;
    }
    return true;
}

std::optional<SphereTree> from_bytes(std::string_view bytes, const std::string& key)
{
    WordReader in(bytes);
    if (in.text() != key) return std::nullopt;
    SphereTree tree;
    tree.levels.resize(in.count(16));
    for (SphereTree::Level& level : tree.levels) {
        level.error = in.number();
        level.nodes.resize(in.count(48));
        for (SphereTree::Node& node : level.nodes) node = read_node(in);
    }
    if (!in.at_end() || tree.levels.empty() || !hangs_together(tree)) return std::nullopt;
    return tree;
}

}  // namespace

std::string spheres_key(const Mesh& mesh, const SphereTreeLimits& limits)
{
    Hash hash;
    hash.add(kVersion);
    hash.add(static_cast<std::uint64_t>(limits.levels));
    hash.add(std::uint64_t{limits.spheres});
    hash.add(limits.error);
    hash.add(std::uint64_t{limits.looks});
    add_mesh(mesh, hash);
    return hash.text();
}

CachedSpheres
cached_spheres(const Mesh& mesh, const SphereTreeLimits& limits, const fs::path& folder)
{
    if (folder.empty()) return {build_sphere_tree(mesh, limits), {}};
    const std::string key = spheres_key(mesh, limits);
    const fs::path path = folder / (key + ".spheres");
    if (std::optional<SphereTree> kept = from_bytes(read_cached(path), key))
        return {std::move(*kept), {}};
    CachedSpheres made{build_sphere_tree(mesh, limits), {}};
    if (made.tree.levels.empty()) return made;
    const std::string trouble = write_cached_words(path, words_of(made.tree, key));
    if (!trouble.empty()) made.warning = "not kept for the next run: " + trouble;
    return made;
}

}  // namespace throng
