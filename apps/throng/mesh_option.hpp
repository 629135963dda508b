// Mesh option: `--mesh FILE`, a mesh in place of those that throng makes for a scene.
#pragma once

#include "apps/throng/options.hpp"
#include "throng/catalog.hpp"

namespace throng {

inline constexpr Option kMeshOption = {
    "--mesh", "FILE",
    "a mesh, OBJ or STL, in place of those that throng makes, brought to their size; of scenes of "
    "the catalogue that have some to replace"};

/// The mesh that was asked for, if any.
class MeshOption {
public:
    /// Reads it. Throws SceneError at a bad line and BadInput where there is nothing to be had.
    explicit MeshOption(const Options& options);

    bool asked_for() const { return !file_.empty(); }
    const std::string& file() const { return file_; }
    /// Throws BadInput when a mesh was asked for and the scene has none to replace.
    void check(const CatalogEntry& entry) const;
    /// The scene, with the mesh if one was asked for.
    Scene make(const CatalogEntry& entry, int size, std::uint64_t seed) const;

private:
    std::string file_;
    TriangleSoup mesh_;
};

}  // namespace throng
