#include "cooking/decomposition/part_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace throng {
namespace {

// Points this near to a plane, against the longest side, are on it: some thousand times the
// rounding of a coordinate.
constexpr double kSlack = 1e-12;
// A cut that leaves less of a piece than this on one side is none.
constexpr double kLeast = 1e-5;
// Points of the surface that tell how hollow a piece is: of the mesh, and looked at for a cut.
constexpr int kSamples = 4000;
constexpr std::size_t kSamplesLooked = 150;
// And of its points where two cuts are looked for, which are tried where the best single one leaves
// a part reaching outside by this share of what it did, and its hulls that share of their volume.
constexpr std::size_t kPointsLooked = 300;
constexpr double kStalled = 0.9;
// Cuts that leave least are looked at again by how far they reach outside.
constexpr std::size_t kFinalists = 8;
// What is hollow against how far it reaches outside, each as a depth: cuts that leave some of both.
// With ten times as much, parts of round shapes reach further outside by a fifth and more.
constexpr double kHollow = 0.3;
// Points of a hull to look at: for a quick look, and to be sure.
constexpr std::size_t kLooks = 200, kSureLooks = 30000;

// How far it is from a point of the surface, the way its face looks, to where the hull ends.
double way_out(const HullMesh& hull, const SurfaceSample& sample)
{
    double way = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
        const double along = hull.normals[i].dot(sample.normal);
        if (!(along > 1e-9)) continue;
        way = std::min(way, (hull.offsets[i] - hull.normals[i].dot(sample.point)) / along);
    }
    return std::isfinite(way) ? std::max(0.0, way) : 0.0;
}

// A cut that was looked at.
struct Cut {
    Plane plane;
    Sides<HullMesh> hulls;
    double hollow = 0;  // m^3, see hollow_of(), and the volume of both
    double cost = 0;
    Sides<Overhang> over;

    double outside() const { return std::max(over[0].least, over[1].least); }
};

// What is between a surface and its hulls, counted for every face that looks into it. Unlike its
// plain volume it falls already with the first of the cuts that open a ring.
double
hollow_of(const Sides<HullMesh>& hulls, const Plane& plane, const std::vector<SurfaceSample>& all)
{
    const std::size_t stride = 1 + all.size() / kSamplesLooked;
    double hollow = 0;
    for (std::size_t i = 0; i < all.size(); i += stride) {
        const bool beyond = plane.normal.dot(all[i].point) > plane.offset;
        hollow += all[i].area * way_out(hulls[beyond ? 1 : 0], all[i]);
    }
    return hollow * static_cast<double>(stride);
}

Cut evaluate_cut(const PartSearch& search, const MeshPart& part, const Plane& plane)
{
    const auto sides = look_at_cut(search.mesh, part.piece, plane, search.slack());
    return {plane, {hull_mesh(sides[0]), hull_mesh(sides[1])}, 0, 0, {}};
}

bool leaves_both(const MeshPart& part, const Cut& cut)
{
    const double least = kLeast * part.hull.volume;
    return cut.hulls[0].volume > least && cut.hulls[1].volume > least;
}

// The cuts along some planes that leave a piece least hollow, the best first.
std::vector<Cut> least_hollow(const PartSearch& search,
                              const MeshPart& part,
                              const std::vector<Plane>& planes,
                              std::size_t most)
{
    std::vector<Cut> cuts;
    for (const Plane& plane : planes) {
        Cut cut = evaluate_cut(search, part, plane);
        if (!leaves_both(part, cut)) continue;
        cut.hollow =
            hollow_of(cut.hulls, plane, part.samples) + cut.hulls[0].volume + cut.hulls[1].volume;
        cuts.push_back(std::move(cut));
    }
    std::stable_sort(cuts.begin(), cuts.end(),
                     [](const Cut& a, const Cut& b) { return a.hollow < b.hollow; });
    if (cuts.size() > most) cuts.resize(most);
    return cuts;
}

// Cuts to choose from: the best of all, and of those through the point furthest outside.
std::vector<Cut> promising_cuts(const PartSearch& search, const MeshPart& part)
{
    std::vector<Cut> cuts =
        least_hollow(search, part, cutting_planes(part.piece, part.hull, search.edges), kFinalists);
    std::vector<Plane> through;
    for (const Vec3& way : cutting_directions()) through.push_back({way, way.dot(part.over.where)});
    for (Cut& cut : least_hollow(search, part, through, kFinalists / 2))
        cuts.push_back(std::move(cut));
    return cuts;
}

// How clear of a point two planes through it leave the hulls of the four pieces that they make;
// below 0 where the point is inside of one.
double clearance(std::span<const Vec3> points, const Vec3& at, const Vec3& one, const Vec3& two)
{
    std::array<std::vector<Vec3>, 4> pieces;
    for (const Vec3& point : points) {
        const Vec3 off = point - at;
        pieces[(one.dot(off) > 0 ? 1 : 0) + (two.dot(off) > 0 ? 2u : 0u)].push_back(point);
    }
    double least = std::numeric_limits<double>::infinity();
    for (const auto& piece : pieces) {
        const HullMesh hull = hull_mesh(piece);
        if (!hull.empty()) least = std::min(least, height_above(hull, at));
    }
    return least;
}

// The first of two cuts that together clear the point furthest outside, where no single one does:
// a ring must be cut twice before its hole is open. False where there are none.
bool opening_cut(const PartSearch& search, const MeshPart& part, Plane& plane)
{
    std::vector<Vec3> points;
    const std::size_t stride = 1 + part.piece.points.size() / kPointsLooked;
    for (std::size_t i = 0; i < part.piece.points.size(); i += stride)
        points.push_back(part.piece.points[i]);
    points.insert(points.end(), part.piece.corners.begin(), part.piece.corners.end());
    const std::vector<Vec3> ways = cutting_directions();
    double best = search.error;
    bool found = false;
    for (std::size_t i = 0; i < ways.size(); ++i)
        for (std::size_t k = i + 1; k < ways.size(); ++k) {
            const double clear = clearance(points, part.over.where, ways[i], ways[k]);
            if (!(clear > best) || clear > search.extent) continue;
            best = clear;
            plane = {ways[i], ways[i].dot(part.over.where)};
            found = true;
        }
    return found;
}

// Cuts a part in two; its upper half goes to the end.
void apply(const PartSearch& search,
           const Cut& cut,
           std::size_t which,
           std::vector<MeshPart>& parts)
{
    auto pieces = cut_piece(search.mesh, parts[which].piece, cut.plane, search.slack());
    Sides<MeshPart> made;
    for (std::size_t side = 0; side < 2; ++side) {
        made[side].piece = std::move(pieces[side]);
        made[side].hull = cut.hulls[side];
        made[side].over = cut.over[side];
    }
    for (const SurfaceSample& sample : parts[which].samples)
        made[cut.plane.normal.dot(sample.point) > cut.plane.offset ? 1 : 0].samples.push_back(
            sample);
    parts[which] = std::move(made[0]);
    parts.push_back(std::move(made[1]));
}

// Of promising cuts the best, by how far it leaves the hulls outside and how hollow.
Cut best_cut(const PartSearch& search, const MeshPart& part, std::vector<Cut>& cuts)
{
    // What is hollow, spread over the piece's surface, is a depth.
    double area = search.slack() * search.extent;
    for (const SurfaceSample& sample : part.samples) area += sample.area;
    for (Cut& cut : cuts) {
        for (std::size_t side = 0; side < 2; ++side)
            cut.over[side] = search.overhang(cut.hulls[side]);
        cut.cost = cut.outside() + kHollow * cut.hollow / area;
    }
    return std::move(*std::min_element(cuts.begin(), cuts.end(),
                                       [](const Cut& a, const Cut& b) { return a.cost < b.cost; }));
}

}  // namespace

double PartSearch::slack() const { return kSlack * extent; }

Overhang PartSearch::overhang(const HullMesh& hull) const
{
    return find_overhang(mesh, hull, error / 4, error / 2, kLooks);
}

Overhang PartSearch::sure_overhang(const HullMesh& hull) const
{
    return find_overhang(mesh, hull, error / 4, error, kSureLooks);
}

// Points on the mesh, each for as much of it. A triangle has as many as the area before it and its
// own call for, spread over it evenly by the golden ratio.
std::vector<SurfaceSample> sample_surface(const Mesh& mesh)
{
    std::vector<double> areas;
    double total = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 across =
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
        areas.push_back(across.norm() / 2);
        total += areas.back();
    }
    const double each = total / kSamples;
    std::vector<SurfaceSample> samples;
    double owed = 0.5;
    for (std::size_t t = 0; t < areas.size(); ++t) {
        owed += areas[t] / each;
        const auto& [a, b, c] = mesh.triangles[t];
        const int count = static_cast<int>(owed);
        for (int i = 0; i < count; ++i) {
            // A point of the unit square, folded into the triangle below its diagonal.
            double u = (i + 0.5) / count, v = 0.5 + 0.6180339887498949 * i;
            v -= std::floor(v);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            samples.push_back(
                {(1 - u - v) * mesh.vertices[a] + u * mesh.vertices[b] + v * mesh.vertices[c],
                 mesh.normals[t], each});
        }
        owed -= count;
    }
    return samples;
}

bool split(const PartSearch& search, std::size_t which, std::vector<MeshPart>& parts)
{
    std::vector<Cut> cuts = promising_cuts(search, parts[which]);
    if (cuts.empty()) return false;
    Cut best = best_cut(search, parts[which], cuts);
    Plane plane;
    const double volume = best.hulls[0].volume + best.hulls[1].volume;
    if (best.outside() > kStalled * parts[which].over.least
        && volume > kStalled * parts[which].hull.volume
        && opening_cut(search, parts[which], plane)) {
        Cut cut = evaluate_cut(search, parts[which], plane);
        for (std::size_t side = 0; side < 2; ++side)
            cut.over[side] = search.overhang(cut.hulls[side]);
        if (leaves_both(parts[which], cut)) best = std::move(cut);
    }
    apply(search, best, which, parts);
    return true;
}

}  // namespace throng
