#include "kernels/geometry/epa.hpp"

#include "kernels/geometry/hill_climbing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

constexpr double kTolerance = 1e-14;    // of the size
constexpr std::size_t kCapacity = 128;  // corners
constexpr std::size_t kMuchRoom = 512;

// Of the block that a tetrahedron's edges span: flatter ones make noisy faces.
constexpr double kVolume = 1e-4;

struct Face {
    std::array<std::uint16_t, 3> corners;  // counter-clockwise seen from outside
    std::array<std::uint16_t, 3> beyond;   // face over the edge from corner i to the next
    Vec3 normal;
    double offset;  // of its plane from 0, below 0 where 0 is outside
    bool alive;
};

// An edge of the hole that a new corner tears, and the face left standing beyond it.
struct RimEdge {
    std::uint16_t from, to, beyond;
};

// Of so many corners at most.
template <std::size_t kMaxCorners>
class Polytope {
public:
    static constexpr std::size_t kMaxFaces = 2 * kMaxCorners;  // a closed one has 2 corners - 4
    static constexpr std::size_t kMaxRim = kMaxCorners;

    explicit Polytope(double tolerance) : tolerance_(tolerance) { }

    void start(const std::array<MinkowskiVertex, 4>& corners);
    /// The living face nearest to 0 that can still grow; -1 when there is none.
    int nearest_face() const;
    /// Tears the faces that the corner sees and closes the hole with it; false if that cannot be.
    bool grow(int seen, const MinkowskiVertex& corner);

    bool full() const { return corner_count_ >= kMaxCorners; }
    const Face& face(int i) const { return faces_[static_cast<std::size_t>(i)]; }
    const MinkowskiVertex& corner(std::uint16_t i) const { return corners_[i]; }

private:
    bool make_face(std::size_t face_index, std::uint16_t a, std::uint16_t b, std::uint16_t c);
    bool collect_rim(std::uint16_t seen, const Vec3& point);
    bool order_rim();

    double tolerance_;
    std::array<MinkowskiVertex, kMaxCorners> corners_;
    std::array<Face, kMaxFaces> faces_;
    std::array<RimEdge, kMaxRim> rim_;
    std::array<std::uint16_t, kMaxFaces> torn_;
    std::size_t corner_count_ = 0, face_count_ = 0, rim_count_ = 0, torn_count_ = 0;
};

template <std::size_t kMaxCorners>
bool Polytope<kMaxCorners>::make_face(std::size_t face_index,
                                      std::uint16_t a,
                                      std::uint16_t b,
                                      std::uint16_t c)
{
    const Vec3& pa = corners_[a].point;
    const Vec3& pb = corners_[b].point;
    const Vec3& pc = corners_[c].point;
    Face& face = faces_[face_index];
    face.corners = {a, b, c};
    face.alive = true;
    // From the corner between the two shortest sides the cross product loses least.
    const double ab = (pb - pa).squaredNorm();
    const double bc = (pc - pb).squaredNorm();
    const double ca = (pa - pc).squaredNorm();
    Vec3 across = (pb - pa).cross(pc - pa);
    if (ca >= ab && ca >= bc) across = (pc - pb).cross(pa - pb);
    if (ab >= bc && ab >= ca) across = (pa - pc).cross(pb - pc);
    const double length = across.norm();
    if (!(length > 0)) return false;
    face.normal = across / length;
    face.offset = face.normal.dot((pa + pb + pc) / 3);
    return true;
}

template <std::size_t kMaxCorners>
void Polytope<kMaxCorners>::start(const std::array<MinkowskiVertex, 4>& corners)
{
    std::copy(corners.begin(), corners.end(), corners_.begin());
    corner_count_ = 4;
    face_count_ = 4;
    const Vec3 base =
        (corners_[1].point - corners_[0].point).cross(corners_[2].point - corners_[0].point);
    if (base.dot(corners_[3].point - corners_[0].point) > 0) std::swap(corners_[0], corners_[1]);
    make_face(0, 0, 1, 2);
    make_face(1, 0, 3, 1);
    make_face(2, 1, 3, 2);
    make_face(3, 2, 3, 0);
    faces_[0].beyond = {1, 2, 3};
    faces_[1].beyond = {3, 2, 0};
    faces_[2].beyond = {1, 3, 0};
    faces_[3].beyond = {2, 1, 0};
}

template <std::size_t kMaxCorners>
int Polytope<kMaxCorners>::nearest_face() const
{
    int best = -1;
    for (std::size_t i = 0; i < face_count_; ++i) {
        if (!faces_[i].alive) continue;
        if (best < 0 || faces_[i].offset < face(best).offset) best = static_cast<int>(i);
    }
    return best;
}

// Walks from face to face over what the point sees, faces in its plane included, so that no sliver
// is left between them and it.
template <std::size_t kMaxCorners>
bool Polytope<kMaxCorners>::collect_rim(std::uint16_t seen, const Vec3& point)
{
    rim_count_ = 0;
    torn_count_ = 0;
    faces_[seen].alive = false;
    torn_[torn_count_++] = seen;
    for (std::size_t next = 0; next < torn_count_; ++next) {
        const Face& face = faces_[torn_[next]];
        for (std::size_t i = 0; i < 3; ++i) {
            Face& beyond = faces_[face.beyond[i]];
            if (!beyond.alive) continue;
            if (beyond.normal.dot(point) - beyond.offset > -tolerance_) {
                beyond.alive = false;
                torn_[torn_count_++] = face.beyond[i];
            }
        }
    }
    for (std::size_t next = 0; next < torn_count_; ++next) {
        const Face& face = faces_[torn_[next]];
        for (std::size_t i = 0; i < 3; ++i) {
            if (!faces_[face.beyond[i]].alive) continue;
            if (rim_count_ == kMaxRim) return false;
            rim_[rim_count_++] = {face.corners[i], face.corners[(i + 1) % 3], face.beyond[i]};
        }
    }
    return rim_count_ >= 3;
}

// Puts the rim's edges head to tail; false unless they make one loop.
template <std::size_t kMaxCorners>
bool Polytope<kMaxCorners>::order_rim()
{
    for (std::size_t i = 0; i + 1 < rim_count_; ++i) {
        std::size_t next = i + 1;
        while (next < rim_count_ && rim_[next].from != rim_[i].to) ++next;
        if (next == rim_count_) return false;
        std::swap(rim_[i + 1], rim_[next]);
    }
    return rim_[rim_count_ - 1].to == rim_[0].from;
}

template <std::size_t kMaxCorners>
bool Polytope<kMaxCorners>::grow(int seen, const MinkowskiVertex& corner)
{
    const bool whole = collect_rim(static_cast<std::uint16_t>(seen), corner.point) && order_rim();
    if (!whole) return false;
    const auto apex = static_cast<std::uint16_t>(corner_count_);
    corners_[corner_count_++] = corner;

    // The torn faces' places are taken first.
    std::array<std::uint16_t, kMaxRim> face_indices;
    for (std::size_t i = 0; i < rim_count_; ++i) {
        if (i < torn_count_) {
            face_indices[i] = torn_[i];
        } else {
            if (face_count_ == kMaxFaces) return false;
            face_indices[i] = static_cast<std::uint16_t>(face_count_++);
        }
    }
    for (std::size_t i = 0; i < rim_count_; ++i) {
        const RimEdge& edge = rim_[i];
        if (!make_face(face_indices[i], edge.from, edge.to, apex)) return false;
        faces_[face_indices[i]].beyond = {edge.beyond, face_indices[(i + 1) % rim_count_],
                                          face_indices[(i + rim_count_ - 1) % rim_count_]};
        Face& beyond = faces_[edge.beyond];
        for (std::size_t k = 0; k < 3; ++k) {
            if (beyond.corners[k] == edge.to && beyond.corners[(k + 1) % 3] == edge.from) {
                beyond.beyond[k] = face_indices[i];
            }
        }
    }
    return true;
}

double distance_from_line(const Vec3& point, const Vec3& from, const Vec3& along)
{
    return (point - from).cross(along).norm();
}

// Four differences that span as much as the main directions show; false when they lie in a plane,
// whose normal is then the answer.
template <class Furthest>
bool spread_start(Furthest& furthest,
                  double tolerance,
                  std::array<MinkowskiVertex, 4>& start,
                  Vec3& flat_normal)
{
    std::array<MinkowskiVertex, 10> tried;
    int widest = 0;
    double width = -1;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(2 * i);
        tried[at] = furthest(Vec3::Unit(i));
        tried[at + 1] = furthest(-Vec3::Unit(i));
        const double now = (tried[at].point - tried[at + 1].point).squaredNorm();
        if (now > width) {
            width = now;
            widest = i;
        }
    }
    start[0] = tried[static_cast<std::size_t>(2 * widest)];
    start[1] = tried[static_cast<std::size_t>(2 * widest + 1)];
    const Vec3 line = unit_or<double>(start[1].point - start[0].point, Vec3::UnitX());
    const Vec3 side = any_perpendicular(line);
    const Vec3 other = line.cross(side);
    tried[6] = furthest(side);
    tried[7] = furthest(-side);
    tried[8] = furthest(other);
    tried[9] = furthest(-other);

    start[2] = tried[0];
    double most = -1;
    for (const MinkowskiVertex& one : tried) {
        const double now = distance_from_line(one.point, start[0].point, line);
        if (!(now > most)) continue;
        most = now;
        start[2] = one;
    }
    // Taken from what lies across the line, and square to the line however little that is.
    const Vec3 off = start[2].point - start[0].point;
    const Vec3 across = unit_or<double>(off - line * line.dot(off), other);
    flat_normal = unit_or<double>(line.cross(across), side);
    if (!(most > tolerance)) flat_normal = side;

    start[3] = furthest(flat_normal);
    const MinkowskiVertex below = furthest(-flat_normal);
    const double above = flat_normal.dot(start[3].point - start[0].point);
    const double under = flat_normal.dot(start[0].point - below.point);
    if (under > above) start[3] = below;
    return most > tolerance && std::max(above, under) > tolerance;
}

// Whether these are four corners, none of them near the plane of the others.
bool encloses_volume(const Simplex& simplex)
{
    if (simplex.count < 4) return false;
    const Vec3 x = simplex.corners[1].point - simplex.corners[0].point;
    const Vec3 y = simplex.corners[2].point - simplex.corners[0].point;
    const Vec3 z = simplex.corners[3].point - simplex.corners[0].point;
    return std::abs(x.cross(y).dot(z)) > kVolume * x.norm() * y.norm() * z.norm();
}

// The corners of a face, and the points of both surfaces below 0's shadow on it.
template <class Grown>
void place_witness(const Grown& polytope, const Face& face, PenetrationDepth& result)
{
    result.has_face = true;
    for (std::size_t i = 0; i < 3; ++i) result.face[i] = polytope.corner(face.corners[i]);
    const MinkowskiVertex& a = polytope.corner(face.corners[0]);
    const MinkowskiVertex& b = polytope.corner(face.corners[1]);
    const MinkowskiVertex& c = polytope.corner(face.corners[2]);
    const Vec3 shadow = face.normal * face.offset;
    const auto area = [&](const Vec3& p, const Vec3& q) {
        return std::max(0.0, face.normal.dot((p - shadow).cross(q - shadow)));
    };
    const double of_a = area(b.point, c.point);
    const double of_b = area(c.point, a.point);
    const double of_c = area(a.point, b.point);
    const double sum = of_a + of_b + of_c;
    if (!(sum > 0)) return;
    result.on_a = (a.on_a * of_a + b.on_a * of_b + c.on_a * of_c) / sum;
    result.on_b = (a.on_b * of_a + b.on_b * of_b + c.on_b * of_c) / sum;
}

template <class Grown>
bool is_corner_of(const Grown& polytope, const Face& face, const Vec3& point)
{
    return std::any_of(face.corners.begin(), face.corners.end(), [&](std::uint16_t corner) {
        return polytope.corner(corner).point == point;
    });
}

template <std::size_t kMaxCorners, class Furthest>
PenetrationDepth search(const ConvexCorePair& pair, Furthest& furthest, const Simplex& beginning)
{
    const double tolerance = kTolerance * (pair.size + pair.b_position.norm());
    PenetrationDepth result;
    result.depth = std::numeric_limits<double>::infinity();
    const auto keep = [&](const Vec3& normal, const MinkowskiVertex& further) {
        const double depth = normal.dot(further.point);
        if (!(depth < result.depth)) return false;
        result.depth = depth;
        result.normal = normal;
        result.on_a = further.on_a;
        result.on_b = further.on_b;
        return true;
    };

    std::array<MinkowskiVertex, 4> start = beginning.corners;
    Vec3 flat_normal = Vec3::Zero();
    const auto keep_flat = [&] {
        for (const Vec3& normal : {flat_normal, Vec3(-flat_normal)})
            if (keep(normal, furthest(normal))) result.has_face = false;
    };
    if (!encloses_volume(beginning) && !spread_start(furthest, tolerance, start, flat_normal)) {
        keep_flat();
        return result;
    }
    bool least = false;
    Polytope<kMaxCorners> polytope(tolerance);
    polytope.start(start);
    while (true) {
        ++result.iterations;
        const int nearest = polytope.nearest_face();
        if (nearest < 0) break;
        const Face face = polytope.face(nearest);
        const MinkowskiVertex further = furthest(face.normal);
        if (keep(face.normal, further)) place_witness(polytope, face, result);
        // No direction parts the cores by less than the nearest face's offset.
        least = result.depth - face.offset <= tolerance
            || face.normal.dot(further.point) - face.offset <= tolerance;
        if (least) break;
        if (is_corner_of(polytope, face, further.point)) break;
        result.cut_short = polytope.full();
        if (result.cut_short || !polytope.grow(nearest, further)) break;
    }
    // All but flat, and the normals of slivers are wide of the mark.
    if (!least && !flat_normal.isZero(0)) keep_flat();
    return result;
}

}  // namespace

PenetrationDepth epa(const ConvexCorePair& pair)
{
    const auto furthest = [&](const Vec3& direction) { return minkowski_support(pair, direction); };
    return search<kCapacity>(pair, furthest, Simplex{});
}

PenetrationDepth
epa(const ConvexCorePair& pair, HillClimbingSupports& supports, const Simplex& beginning)
{
    return search<kMuchRoom>(pair, supports, beginning);
}

}  // namespace throng
