#include "narrowphase/methods/convex_parts.hpp"

#include "kernels/geometry/hull.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "narrowphase/solids/cutting_planes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace throng {
namespace {

// Where no error is wanted, against the longest side.
constexpr double kError = 0.025;
// Points this near to a plane, against the longest side, are on it: a hundred times the rounding of
// a plane through three of them.
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
// And what a joint hull fills, against a square of the longest side. Three times more or less of
// either changes the error by some tenths.
constexpr double kHollow = 0.3, kFilled = 10;
// Points of a hull to look at: in the search, and for the answer.
constexpr std::size_t kLooks = 200, kLastLooks = 30000;

// A point of the mesh's surface that stands for some of it.
struct Sample {
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    double area = 0;  // m^2
};

// A piece, the hull of it and how far that reaches outside.
struct Part {
    MeshPiece piece;
    std::vector<Sample> samples;
    LooseHull hull;
    Overhang over;
    bool sure = false;   // `over` is as good as it gets
    bool whole = false;  // no cut helps
};

struct Search {
    const Mesh& mesh;
    double extent, error;
    std::vector<InwardEdge> edges;

    double slack() const { return kSlack * extent; }
    Overhang overhang(const LooseHull& hull) const
    {
        return find_overhang(mesh, hull, error / 4, error / 2, kLooks);
    }
    // With looks enough to tell whether there is more than the error.
    Overhang sure_overhang(const LooseHull& hull) const
    {
        return find_overhang(mesh, hull, error / 4, error, kLastLooks);
    }
};

// Points on the mesh, each for as much of it. A triangle has as many as the area before it and its
// own call for, spread over it evenly by the golden ratio.
std::vector<Sample> sample_surface(const Mesh& mesh)
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
    std::vector<Sample> samples;
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

// How far it is from a point of the surface, the way its face looks, to where the hull ends.
double way_out(const LooseHull& hull, const Sample& sample)
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
    Sides<LooseHull> hulls;
    double hollow = 0;  // m^3, see hollow_of(), and the volume of both
    double cost = 0;
    Sides<Overhang> over;

    double outside() const { return std::max(over[0].least, over[1].least); }
};

// What is between a surface and its hulls, counted for every face that looks into it. Unlike its
// plain volume it falls already with the first of the cuts that open a ring.
double hollow_of(const Sides<LooseHull>& hulls, const Plane& plane, const std::vector<Sample>& all)
{
    const std::size_t stride = 1 + all.size() / kSamplesLooked;
    double hollow = 0;
    for (std::size_t i = 0; i < all.size(); i += stride) {
        const bool beyond = plane.normal.dot(all[i].point) > plane.offset;
        hollow += all[i].area * way_out(hulls[beyond ? 1 : 0], all[i]);
    }
    return hollow * static_cast<double>(stride);
}

Cut look_at(const Search& search, const Part& part, const Plane& plane)
{
    const auto sides = look_at_cut(search.mesh, part.piece, plane, search.slack());
    return {plane, {loose_hull(sides[0]), loose_hull(sides[1])}, 0, 0, {}};
}

bool leaves_both(const Part& part, const Cut& cut)
{
    const double least = kLeast * part.hull.volume;
    return cut.hulls[0].volume > least && cut.hulls[1].volume > least;
}

// The cuts along some planes that leave a piece least hollow, the best first.
std::vector<Cut> least_hollow(const Search& search,
                              const Part& part,
                              const std::vector<Plane>& planes,
                              std::size_t most)
{
    std::vector<Cut> cuts;
    for (const Plane& plane : planes) {
        Cut cut = look_at(search, part, plane);
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
std::vector<Cut> promising_cuts(const Search& search, const Part& part)
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
        const LooseHull hull = loose_hull(piece);
        if (!hull.empty()) least = std::min(least, height_above(hull, at));
    }
    return least;
}

// The first of two cuts that together clear the point furthest outside, where no single one does:
// a ring must be cut twice before its hole is open. False where there are none.
bool opening_cut(const Search& search, const Part& part, Plane& plane)
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
void apply(const Search& search, const Cut& cut, std::size_t which, std::vector<Part>& parts)
{
    auto pieces = cut_piece(search.mesh, parts[which].piece, cut.plane, search.slack());
    Sides<Part> made;
    for (std::size_t side = 0; side < 2; ++side) {
        made[side].piece = std::move(pieces[side]);
        made[side].hull = cut.hulls[side];
        made[side].over = cut.over[side];
    }
    for (const Sample& sample : parts[which].samples)
        made[cut.plane.normal.dot(sample.point) > cut.plane.offset ? 1 : 0].samples.push_back(
            sample);
    parts[which] = std::move(made[0]);
    parts.push_back(std::move(made[1]));
}

// Of promising cuts the best, by how far it leaves the hulls outside and how hollow.
Cut best_cut(const Search& search, const Part& part, std::vector<Cut>& cuts)
{
    // What is hollow, spread over the piece's surface, is a depth.
    double area = search.slack() * search.extent;
    for (const Sample& sample : part.samples) area += sample.area;
    for (Cut& cut : cuts) {
        for (std::size_t side = 0; side < 2; ++side)
            cut.over[side] = search.overhang(cut.hulls[side]);
        cut.cost = cut.outside() + kHollow * cut.hollow / area;
    }
    return std::move(*std::min_element(cuts.begin(), cuts.end(),
                                       [](const Cut& a, const Cut& b) { return a.cost < b.cost; }));
}

bool split(const Search& search, std::size_t which, std::vector<Part>& parts)
{
    std::vector<Cut> cuts = promising_cuts(search, parts[which]);
    if (cuts.empty()) return false;
    Cut best = best_cut(search, parts[which], cuts);
    Plane plane;
    const double volume = best.hulls[0].volume + best.hulls[1].volume;
    if (best.outside() > kStalled * parts[which].over.least
        && volume > kStalled * parts[which].hull.volume
        && opening_cut(search, parts[which], plane)) {
        Cut cut = look_at(search, parts[which], plane);
        for (std::size_t side = 0; side < 2; ++side)
            cut.over[side] = search.overhang(cut.hulls[side]);
        if (leaves_both(parts[which], cut)) best = std::move(cut);
    }
    apply(search, best, which, parts);
    return true;
}

// The part that reaches furthest outside, of those that a cut may help; as many as there are where
// none reaches too far.
std::size_t worst_of(const std::vector<Part>& parts, double error)
{
    std::size_t worst = parts.size();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].whole || parts[i].over.least <= error) continue;
        if (worst == parts.size() || parts[i].over.least > parts[worst].over.least) worst = i;
    }
    return worst;
}

// Looks closer at the parts that seem to be good enough.
void make_sure(const Search& search, std::vector<Part>& parts)
{
    for (Part& part : parts) {
        if (!part.sure) part.over = search.sure_overhang(part.hull);
        part.sure = true;
    }
}

void cut_worst(const Search& search, std::size_t most, std::vector<Part>& parts)
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
    LooseHull hull;
    double outside = 0, cost = 0;
    bool known = false;
};

Joint join(const Search& search, const std::vector<Part>& parts, std::size_t a, std::size_t b)
{
    Joint joint{a, b, {}, 0, 0, false};
    std::vector<Vec3> points = parts[a].hull.vertices;
    points.insert(points.end(), parts[b].hull.vertices.begin(), parts[b].hull.vertices.end());
    joint.hull = loose_hull(points);
    const double filled = joint.hull.volume - parts[a].hull.volume - parts[b].hull.volume;
    joint.cost = kFilled * filled / (search.extent * search.extent);
    return joint;
}

// The joint of least cost. How far it reaches outside takes long to find, so that it is looked for
// only where the rest does not decide.
Joint& best_joint(const Search& search, std::vector<Joint>& joints)
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

void merge(const Search& search, std::size_t most, std::vector<Part>& parts)
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

double extent_of(const Mesh& mesh)
{
    Vec3 lower = mesh.vertices[0], upper = lower;
    for (const Vec3& vertex : mesh.vertices) {
        lower = lower.cwiseMin(vertex);
        upper = upper.cwiseMax(vertex);
    }
    return (upper - lower).maxCoeff();
}

// Why a mesh has no parts.
std::string trouble_with(const Mesh& mesh)
{
    if (mesh.triangles.empty()) return "has no triangles; give a closed mesh";
    std::size_t rims = 0;
    for (const auto& beyond : mesh.beyond)
        rims += static_cast<std::size_t>(std::count(beyond.begin(), beyond.end(), -1));
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

// How far a piece's hull is outside of those that stand for the mesh: distance from what is convex
// is greatest at a corner.
double left_out(const LooseHull& piece, const std::vector<LooseHull>& hulls, std::size_t own)
{
    double most = 0;
    for (const Vec3& vertex : piece.vertices) {
        double least = std::numeric_limits<double>::infinity();
        if (own < hulls.size()) least = distance_outside(hulls[own], vertex);
        for (std::size_t i = 0; i < hulls.size() && least > most; ++i)
            least = std::min(least, distance_outside(hulls[i], vertex));
        most = std::max(most, least);
    }
    return most;
}

// Hulls as contact takes them, how far they reach outside and what of the pieces they leave out.
void finish(const Search& search,
            const std::vector<LooseHull>& pieces,
            std::size_t most_vertices,
            ConvexParts& made)
{
    std::vector<LooseHull> hulls;
    std::vector<std::size_t> own;
    double volume = 0;
    for (const LooseHull& piece : pieces) {
        std::vector<Vec3> points = simplified(piece, most_vertices, search.error / 8).vertices;
        HullResult built = build_hull(points);
        own.push_back(hulls.size());
        if (!built.trouble.empty()) continue;
        hulls.push_back(loose_hull(built.hull.vertices));
        volume += mass_of(built.hull).volume;
        made.hulls.push_back(std::move(built.hull));
        made.points.push_back(std::move(points));
        const double fine = search.error / 8;
        const Overhang over = find_overhang(search.mesh, hulls.back(), fine, fine, kLastLooks);
        made.outside = std::max(made.outside, over.least);
        made.error = std::max(made.error, over.bound);
    }
    if (made.hulls.empty()) {
        made.trouble = "encloses no volume; give a mesh that does";
        return;
    }
    for (std::size_t i = 0; i < pieces.size(); ++i)
        made.uncovered = std::max(made.uncovered, left_out(pieces[i], hulls, own[i]));
    made.error = std::max(made.error, made.uncovered);
    made.volume_error = volume / mass_of(search.mesh).volume - 1;
}

Search search_of(const Mesh& mesh, double error)
{
    const double extent = extent_of(mesh);
    return {mesh, extent, error > 0 ? error : kError * extent, inward_edges(mesh)};
}

}  // namespace

ConvexParts split_into_parts(const Mesh& mesh, const PartsWanted& wanted)
{
    ConvexParts made;
    made.trouble = trouble_with(mesh);
    if (!made.trouble.empty()) return made;
    const Search search = search_of(mesh, wanted.error);
    std::vector<Part> parts(1);
    parts[0].piece = whole_piece(mesh);
    parts[0].hull = loose_hull(mesh.vertices);
    parts[0].samples = sample_surface(mesh);
    parts[0].over = search.overhang(parts[0].hull);

    const auto most = static_cast<std::size_t>(std::max(1, wanted.max_parts));
    // Half as many again than wanted: what the last cuts show lets the first be mended.
    cut_worst(search, most == 1 ? 1 : most + most / 2, parts);
    merge(search, most, parts);
    std::vector<LooseHull> pieces;
    for (Part& part : parts) pieces.push_back(std::move(part.hull));
    finish(search, pieces, kMostPartVertices, made);
    if (made.error > search.error)
        made.remarks.push_back("the error is " + percent(made.error / search.extent)
                               + " of the longest side, with " + std::to_string(made.hulls.size())
                               + " parts");
    return made;
}

ConvexParts put_into_hull(const Mesh& mesh)
{
    ConvexParts made;
    made.trouble = trouble_with(mesh);
    if (!made.trouble.empty()) return made;
    const Search search = search_of(mesh, 0);
    const LooseHull hull = loose_hull(mesh.vertices);
    finish(search, {hull}, hull.vertices.size(), made);
    made.remarks.push_back("the hull fills " + percent(made.volume_error) + " more than the mesh");
    return made;
}

}  // namespace throng
