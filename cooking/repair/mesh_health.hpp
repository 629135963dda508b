// Mesh health: what is wrong with triangles before they become a solid, and what can be repaired.
#pragma once

#include "kernels/data/mesh.hpp"

#include <string>

namespace throng {

/// What was found; edges and triangles as they came, but for those of no area and identical
/// vertices, which every mesh loses, and for holes that were closed.
struct MeshHealth {
    std::size_t duplicates = 0;     // triangles of the same corners as one before: dropped
    std::size_t holes = 0;          // closed, as close_holes() says
    std::size_t longest_hole = 0;   // edges round the longest of those
    std::size_t open_edges = 0;     // of one triangle alone, round holes that were left
    std::size_t crowded_edges = 0;  // shared by more than two
    std::size_t turned = 0;         // triangles wound against their neighbors: turned over
    std::size_t one_sided = 0;      // pieces that have no outside, as a Moebius strip: left alone
    std::size_t pieces = 0;         // that no shared edge joins
    std::size_t inside_out = 0;     // closed pieces turned inward that are no hollow: turned over
    std::size_t hollows = 0;        // closed pieces turned inward within another: kept
    std::size_t buried = 0;         // closed pieces turned outward within another
    std::size_t cuts = 0;           // pairs of triangles that cross
    bool cuts_cut_short = false;    // not all pairs were looked at

    /// Whether the normals of the repaired mesh tell inside from outside.
    bool sound() const
    {
        return open_edges + crowded_edges + one_sided + buried + cuts == 0 && !cuts_cut_short;
    }
};

/// A mesh as good as it can be made, vertex normals included.
///
///   warnings  one for everything that was found, in plain words, and what was done about it
///   trouble   as in MeshResult
struct RepairedMesh {
    Mesh mesh;
    MeshHealth health;
    std::vector<std::string> warnings;
    std::string trouble;
};

/// Drops duplicates, makes the windings of every piece agree, closes holes that are small against
/// the piece that they are in, and turns over what is inside out. Wider holes stay holes.
RepairedMesh repair(const std::vector<Vec3>& vertices,
                    std::vector<std::array<std::uint32_t, 3>> triangles);

/// The same of a mesh that is not to move, which may well be open: holes stay as they are, and no
/// vertex normals. What is closed is solid, turned over where it is inside out but for hollows;
/// what is open has two sides. A mesh with nothing wrong comes back as build_mesh() makes it.
RepairedMesh mend_still(const std::vector<Vec3>& vertices,
                        std::vector<std::array<std::uint32_t, 3>> triangles);

/// How many pairs of triangles that share no corner cross one another; those that lie in one plane
/// do not count. Looks at no more than `most_pairs` of those whose boxes overlap, and says so.
std::size_t count_cuts(const Mesh& mesh, std::size_t most_pairs, bool& cut_short);

}  // namespace throng
