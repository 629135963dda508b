#include "cooking/decomposition/convex_parts.hpp"

#include "cooking/decomposition/bare_surface.hpp"
#include "cooking/decomposition/convex_cover.hpp"
#include "cooking/hulls/hull.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Where no error is wanted, against the longest side.
constexpr double kError = 0.025;
// What a joint hull fills, over the square of the longest side, against how far it reaches outside.
// With a tenth of it parts that reach far anyway are joined whatever else that fills.
constexpr double kFilled = 10;
// Where no number is wanted: pieces of a cut shape, and hulls that overlap where these are nearly
// exact. With twice as many of either a shape takes twice as long in every step.
constexpr std::size_t kCutParts = 16, kCoverParts = 64;
// Hulls that overlap are looked for with that much less of an error where none is wanted.
constexpr double kFiner = 16;
// The most points of a hull to look at for the answer.
constexpr std::size_t kLastLooks = 30000;

// The part that reaches furthest outside, of those that a cut may help; as many as there are where
// none reaches too far.
std::size_t worst_of(const std::vector<MeshPart>& parts, double error)
{
    std::size_t worst = parts.size();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].whole || parts[i].over.least <= error) continue;
        if (worst == parts.size() || parts[i].over.least > parts[worst].over.least) worst = i;
    }
    return worst;
}

// Looks closer at the parts that seem to be good enough.
void make_sure(const PartSearch& search, std::vector<MeshPart>& parts)
{
    for (MeshPart& part : parts) {
        if (!part.sure) part.over = search.sure_overhang(part.hull);
        part.sure = true;
    }
}

void cut_worst(const PartSearch& search, std::size_t most, std::vector<MeshPart>& parts)
{
    while (parts.size() < most) {
        std::size_t worst = worst_of(parts, search.error);
        if (worst == parts.size()) {
            make_sure(search, parts);
            worst = worst_of(parts, search.error);
        }
        if (worst == parts.size()) return;
        if (!split(search, worst, parts)) parts[worst].whole = true;
    }
}

// Two parts as one. Until `known` its cost is the least that it may have.
struct Joint {
    std::size_t a = 0, b = 0;
    HullMesh hull;
    double outside = 0, cost = 0;
    bool known = false;
};

Joint join(const PartSearch& search,
           const std::vector<MeshPart>& parts,
           std::size_t a,
           std::size_t b)
{
    Joint joint{a, b, {}, 0, 0, false};
    std::vector<Vec3> points = parts[a].hull.vertices;
    points.insert(points.end(), parts[b].hull.vertices.begin(), parts[b].hull.vertices.end());
    joint.hull = hull_mesh(points);
    const double filled = joint.hull.volume - parts[a].hull.volume - parts[b].hull.volume;
    joint.cost = kFilled * filled / (search.extent * search.extent);
    return joint;
}

// The joint of least cost. How far it reaches outside takes long to find, so that it is looked for
// only where the rest does not decide.
Joint& best_joint(const PartSearch& search, std::vector<Joint>& joints)
{
    while (true) {
        Joint& best =
            *std::min_element(joints.begin(), joints.end(),
                              [](const Joint& a, const Joint& b) { return a.cost < b.cost; });
        if (best.known) return best;
        best.known = true;
        best.outside = search.overhang(best.hull).least;
        best.cost += best.outside;
    }
}

void merge(const PartSearch& search, std::size_t most, std::vector<MeshPart>& parts)
{
    std::vector<Joint> joints;
    for (std::size_t a = 0; a < parts.size(); ++a)
        for (std::size_t b = a + 1; b < parts.size(); ++b)
            joints.push_back(join(search, parts, a, b));
    std::vector<bool> gone(parts.size(), false);
    std::size_t count = parts.size();
    while (count > 1) {
        Joint& best = best_joint(search, joints);
        if (count <= most) {
            // Only where it is sure to do no harm.
            if (best.outside <= search.error) best.outside = search.sure_overhang(best.hull).least;
            if (best.outside > search.error) break;
        }
        const std::size_t a = best.a, b = best.b;
        parts[a].hull = std::move(best.hull);
        gone[b] = true;
        --count;
        std::erase_if(joints, [&](const Joint& joint) {
            return joint.a == a || joint.b == a || joint.a == b || joint.b == b;
        });
        for (std::size_t other = 0; other < parts.size(); ++other)
            if (other != a && !gone[other])
                joints.push_back(join(search, parts, std::min(a, other), std::max(a, other)));
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (!gone[i]) {
            if (kept != i) parts[kept] = std::move(parts[i]);
            ++kept;
        }
    parts.resize(kept);
}

// Why a mesh has no parts.
std::string trouble_with(const Mesh& mesh)
{
    if (mesh.triangles.empty()) return "has no triangles; give a closed mesh";
    std::size_t rims = 0;
    for (const auto& adjacent : mesh.adjacent)
        rims += static_cast<std::size_t>(std::count(adjacent.begin(), adjacent.end(), -1));
    if (rims > 0)
        return "has " + std::to_string(rims)
            + " edges that are not shared by two triangles; give a closed mesh";
    if (!(mass_of(mesh).volume > 0)) return "is inside out; give triangles that turn outward";
    return {};
}

std::string percent(double share)
{
    // Whole percents say enough; tenths where there is less than one.
    const double tenths = std::round(1000 * share);
    const auto whole = static_cast<long long>(tenths / 10);
    if (std::abs(tenths) >= 100) return std::to_string(std::llround(tenths / 10)) + " %";
    const auto rest = std::llround(std::abs(tenths)) % 10;
    return (tenths < 0 && whole == 0 ? "-" : "") + std::to_string(whole) + "."
        + std::to_string(rest) + " %";
}

// How far a piece is outside of the hull that covers it best: distance from what is convex is
// greatest at a corner. Of several hulls together that would not hold.
double left_out(const HullMesh& piece, const std::vector<HullMesh>& hulls)
{
    double least = std::numeric_limits<double>::infinity();
    for (const HullMesh& hull : hulls) {
        double most = 0;
        for (std::size_t i = 0; i < piece.vertices.size() && most < least; ++i)
            most = std::max(most, distance_outside(hull, piece.vertices[i]));
        least = std::min(least, most);
    }
    return least;
}

// Hulls as contact takes them, and how far they reach outside. Answers them again.
std::vector<HullMesh> take_hulls(const PartSearch& search,
                                 const std::vector<HullMesh>& pieces,
                                 std::size_t most_vertices,
                                 double slack,
                                 FacetCut cut,
                                 ConvexParts& made)
{
    std::vector<HullMesh> hulls;
    double volume = 0;
    for (const HullMesh& piece : pieces) {
        std::vector<Vec3> points = simplified(piece, most_vertices, search.error / 8).vertices;
        HullResult built = build_hull(points);
        if (!built.trouble.empty()) continue;
        hulls.push_back(hull_mesh(built.hull.vertices));
        volume += mass_of(built.hull).volume;
        made.hulls.push_back(std::move(built.hull));
        made.points.push_back(std::move(points));
        const Overhang over =
            find_overhang(search.mesh, hulls.back(), slack, slack, kLastLooks, cut);
        made.outside = std::max(made.outside, over.least);
        made.error = std::max(made.error, over.bound);
    }
    made.volume_error = volume / mass_of(search.mesh).volume - 1;
    if (hulls.empty()) made.trouble = "encloses no volume; give a mesh that does";
    return hulls;
}

// Pieces as hulls, and what of the pieces these leave out.
ConvexParts
finished(const PartSearch& search, const std::vector<HullMesh>& pieces, std::size_t most_vertices)
{
    ConvexParts made;
    const std::vector<HullMesh> hulls =
        take_hulls(search, pieces, most_vertices, search.error / 8, FacetCut::in_four, made);
    if (hulls.empty()) return made;
    for (const HullMesh& piece : pieces)
        made.uncovered = std::max(made.uncovered, left_out(piece, hulls));
    made.error = std::max(made.error, made.uncovered);
    return made;
}

PartSearch search_of(const Mesh& mesh, double error)
{
    const double extent = longest_side(mesh);
    return {mesh, extent, error > 0 ? error : kError * extent, inward_edges(mesh)};
}

// Pieces between planes, and what of these fills little when put together.
ConvexParts by_cuts(const PartSearch& search, std::size_t most)
{
    std::vector<MeshPart> parts(1);
    parts[0].piece = whole_piece(search.mesh);
    parts[0].hull = hull_mesh(search.mesh.vertices);
    parts[0].samples = sample_surface(search.mesh);
    parts[0].over = search.overhang(parts[0].hull);
    // Half as many again than wanted: what the last cuts show lets the first be repaired.
    cut_worst(search, most == 1 ? 1 : most + most / 2, parts);
    merge(search, most, parts);
    std::vector<HullMesh> pieces;
    pieces.reserve(parts.size());
    for (MeshPart& part : parts) pieces.push_back(std::move(part.hull));
    return finished(search, pieces, kMostPartVertices);
}

// Hulls that overlap. Trouble where there are none.
ConvexParts by_cover(const PartSearch& search, std::size_t grown, std::size_t most)
{
    ConvexParts made;
    std::vector<MeshPart> parts;
    for (HullMesh& hull : cover_by_hulls(search, grown))
        parts.emplace_back().hull = std::move(hull);
    made.trouble = "is not a few convex shapes put together";
    if (parts.empty()) return made;
    merge(search, most, parts);
    std::vector<HullMesh> hulls;
    hulls.reserve(parts.size());
    for (MeshPart& part : parts) hulls.push_back(std::move(part.hull));
    made.trouble.clear();
    hulls = take_hulls(search, hulls, kMostPartVertices, search.error, FacetCut::in_two, made);
    if (hulls.empty()) return made;
    // Nothing but a look at the surface tells what overlapping hulls leave out.
    made.uncovered = find_bare_surface(search.mesh, hulls, search.error).bound;
    made.error = std::max(made.error, made.uncovered);
    return made;
}

// Puts hulls that overlap in the place of pieces that are off by more than is wanted, where they
// are nearer to the mesh.
void mend_by_cover(const PartSearch& search, const PartsWanted& wanted, ConvexParts& made)
{
    if (made.error <= search.error || wanted.max_parts == 1) return;
    PartSearch fine = search;
    if (!(wanted.error > 0)) fine.error /= kFiner;
    const std::size_t most =
        wanted.max_parts > 0 ? static_cast<std::size_t>(wanted.max_parts) : kCoverParts;
    ConvexParts cover = by_cover(fine, std::max(most, kCoverParts), most);
    if (!cover.trouble.empty()) return;
    // Round shapes cut into twice as many pieces are off by a quarter: more is to be gained.
    const double times = std::max(
        1.0, static_cast<double>(cover.hulls.size()) / static_cast<double>(made.hulls.size()));
    if (times * times * cover.error < made.error) made = std::move(cover);
}

}  // namespace

ConvexParts split_into_parts(const Mesh& mesh, const PartsWanted& wanted)
{
    ConvexParts made;
    made.trouble = trouble_with(mesh);
    if (!made.trouble.empty()) return made;
    const PartSearch search = search_of(mesh, wanted.error);
    made = by_cuts(search,
                   wanted.max_parts > 0 ? static_cast<std::size_t>(wanted.max_parts) : kCutParts);
    if (made.trouble.empty()) mend_by_cover(search, wanted, made);
    const std::string error = percent(made.error / search.extent);
    const std::string asked = percent(search.error / search.extent);
    if (made.error > search.error && error != asked)
        made.warnings.push_back("the error is " + error + " of the longest side, more than the "
                                + asked + " wanted");
    return made;
}

ConvexParts put_into_hull(const Mesh& mesh)
{
    ConvexParts made;
    made.trouble = trouble_with(mesh);
    if (!made.trouble.empty()) return made;
    const PartSearch search = search_of(mesh, 0);
    const HullMesh hull = hull_mesh(mesh.vertices);
    made = finished(search, {hull}, hull.vertices.size());
    if (!made.trouble.empty()) return made;
    made.warnings.push_back("holes and hollows are filled, " + percent(made.volume_error)
                            + " more than the mesh");
    return made;
}

}  // namespace throng
