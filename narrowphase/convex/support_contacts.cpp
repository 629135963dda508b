#include "narrowphase/convex/support_contacts.hpp"

#include "kernels/geometry/clip.hpp"
#include "narrowphase/manifold/contact_points.hpp"
#include "narrowphase/manifold/foot.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

using Face = SupportFace<double>;
using Point = LocalManifold<double>::Point;

constexpr double kFacing = 0.995;  // cosine: a face that leans more is an edge or a corner
constexpr double kSlack = 1e-6;    // of the size, by which a corner may stand beside a face
constexpr double kLeaning = 0.01;  // of the size, between the lowest point of a rim and the highest
constexpr std::uint32_t kWitness = 0x80000000u;
constexpr std::uint32_t kByB = 0x40000000u;

// What both shapes show along the axis, in a's frame.
struct Facing {
    const ConvexCorePair& pair;
    const ContactAxis& axis;
    double speculative_margin;
    Face a, b;
    std::array<Point, kMaxCorners + 1> points;
    std::size_t count = 0;

    double convex_radius() const { return pair.a.convex_radius + pair.b.convex_radius; }

    // Takes a point of each core, in line along the axis.
    void add(const Vec3& on_a, double separation, std::uint32_t feature)
    {
        const double between = separation - convex_radius();
        if (!(between <= speculative_margin) || count == points.size()) return;
        const Vec3 middle = on_a + axis.normal * (pair.a.convex_radius + between / 2);
        points[count++] = {middle, between, feature};
    }
};

Face moved(Face face, const ConvexCorePair& pair)
{
    for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i) {
        face.corners[i] = pair.b_turn * face.corners[i] + pair.b_position;
    }
    face.normal = pair.b_turn * face.normal;
    return face;
}

// Where a point of the other shape meets a face's plane, going along the axis: how far that is.
double height_over(const Face& face, const Vec3& point, const Vec3& normal)
{
    return (point - face.corners[0]).dot(face.normal) / normal.dot(face.normal);
}

void add_over_face(
    Facing& facing, const Face& face, bool face_is_b, const Vec3& point, std::uint32_t feature)
{
    const Vec3& normal = facing.axis.normal;
    const double height = height_over(face, point, normal);
    if (face_is_b) {
        facing.add(point, -height, feature | kByB);
    } else {
        facing.add(point - normal * height, height, feature);
    }
}

// The plane through edge i of a face, along the axis; the face is on its inner side.
void side_plane(const Face& face, int i, const Vec3& normal, Vec3& out, double& offset)
{
    const Vec3& from = face.corners[static_cast<std::size_t>(i)];
    const Vec3& to = face.corners[static_cast<std::size_t>((i + 1) % face.count)];
    const Vec3 along_face = normal.dot(face.normal) > 0 ? normal : Vec3(-normal);
    out = unit_or<double>((to - from).cross(along_face), Vec3::Zero());
    offset = out.dot(from);
}

void clip_polygon(Facing& facing, const Face& face, bool face_is_b, const Face& other, double slack)
{
    Polygon<double> polygon;
    for (std::size_t i = 0; i < static_cast<std::size_t>(other.count); ++i) {
        polygon.add(other.corners[i], static_cast<std::uint16_t>(other.features[i] & 0x7ff));
    }
    for (int i = 0; i < face.count && polygon.count > 0; ++i) {
        Vec3 out = Vec3::Zero();
        double offset = 0;
        side_plane(face, i, facing.axis.normal, out, offset);
        cut(polygon, out, offset, slack, static_cast<std::uint16_t>(0x800 + i));
    }
    for (int i = 0; i < polygon.count; ++i) {
        add_over_face(facing, face, face_is_b, polygon.corners[static_cast<std::size_t>(i)],
                      polygon.corner_id(i));
    }
}

void clip_segment(Facing& facing, const Face& face, bool face_is_b, const Face& line, double slack)
{
    const Vec3 along = line.corners[1] - line.corners[0];
    double from = 0;
    double to = 1;
    std::uint32_t from_name = line.features[0];
    std::uint32_t to_name = line.features[1];
    for (int i = 0; i < face.count; ++i) {
        Vec3 out = Vec3::Zero();
        double offset = 0;
        side_plane(face, i, facing.axis.normal, out, offset);
        const double at_from = out.dot(line.corners[0]) - offset;
        const double at_to = out.dot(line.corners[1]) - offset;
        if (at_from > slack && at_to > slack) return;
        if (at_from <= slack && at_to <= slack) continue;
        const double crossing = std::clamp(at_from / (at_from - at_to), 0.0, 1.0);
        const auto name = static_cast<std::uint32_t>(0x800 + i);
        if (at_from > slack && crossing > from) {
            from = crossing;
            from_name = name;
        }
        if (at_to > slack && crossing < to) {
            to = crossing;
            to_name = name;
        }
    }
    if (!(from < to)) return;
    add_over_face(facing, face, face_is_b, line.corners[0] + along * from, from_name);
    add_over_face(facing, face, face_is_b, line.corners[0] + along * to, to_name + 0x1000);
}

// The edge of a leaning face that comes nearest along a direction; false where one corner does.
bool leading_edge(const Face& face, const Vec3& direction, Face& edge)
{
    if (face.count == 2) {
        edge = face;
        return true;
    }
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i) {
        const std::size_t next = (i + 1) % static_cast<std::size_t>(face.count);
        const double along = direction.dot(face.corners[i] + face.corners[next]);
        if (!(along > most)) continue;
        most = along;
        edge.count = 0;
        edge.add(face.corners[i], face.features[i]);
        edge.add(face.corners[next], face.features[next]);
    }
    const Vec3 along = edge.corners[1] - edge.corners[0];
    return face.count > 2 && std::abs(along.dot(direction)) < 0.1 * along.norm();
}

double curvature_radius(const ConvexCore<double>& core)
{
    return core.convex_radius + (core.kind == ShapeKind::cylinder ? core.extents.x() : 0);
}

void pair_lines(Facing& facing, const Face& a, const Face& b)
{
    const double round = curvature_radius(facing.pair.a) + curvature_radius(facing.pair.b);
    std::array<SharedEnd, 2> ends;
    if (!share_line({a.corners[0], a.corners[1]}, {b.corners[0], b.corners[1]}, facing.axis.normal,
                    round, ends)) {
        return;
    }
    for (const SharedEnd& end : ends) facing.add(end.on_a, end.separation, end.feature);
}

void clip_over(Facing& facing, bool face_is_b, double slack)
{
    const Face& face = face_is_b ? facing.b : facing.a;
    const Face& other = face_is_b ? facing.a : facing.b;
    if (other.count == 2) {
        clip_segment(facing, face, face_is_b, other, slack);
        return;
    }
    const ConvexCore<double>& core = face_is_b ? facing.pair.a : facing.pair.b;
    if (core.kind == ShapeKind::cylinder) {
        // Every second corner of a cap will do as long as none of them is cut off.
        Face four = other;
        four.count = 0;
        for (std::size_t i = 0; i < 8; i += 2) four.add(other.corners[i], other.features[i]);
        clip_polygon(facing, face, face_is_b, four, slack);
        const auto end = facing.points.begin() + static_cast<std::ptrdiff_t>(facing.count);
        const bool cut_off = std::any_of(facing.points.begin(), end, [](const Point& point) {
            return (point.feature & 0x800800u) != 0;
        });
        if (!cut_off && facing.count > 0) return;
        facing.count = 0;
    }
    clip_polygon(facing, face, face_is_b, other, slack);
}

// The points found, as places that bear who leans.
struct RimPlaces {
    std::span<const Point> points;

    std::size_t size() const { return points.size(); }
    const Vec3& at(std::size_t i) const { return points[i].position; }
    double height(std::size_t i) const { return points[i].separation; }
};

// A rim that leans on a face touches it in one place, which runs along the rim as the body tilts
// sideways: by so far that points apart, each by itself, would take turns in bearing it. Those that
// the step may bring down keep it where it is.
bool keep_leaning_rim(const Facing& facing, double size, LocalManifold<double>& out)
{
    const RimPlaces found{std::span<const Point>(facing.points.data(), facing.count)};
    if (found.size() <= 4) return false;
    Foot<double, RimPlaces> foot(found, facing.axis.normal, facing.speculative_margin);
    double highest = foot.lowest();
    for (const Point& point : found.points) highest = std::max(highest, point.separation);
    if (!(highest - foot.lowest() > kLeaning * size)) return false;
    // The lowest is told as the lowest: it is a corner that is where it is, and no rounding.
    constexpr double kAsLow = 1e-3;
    foot.spread(kAsLow * size, (facing.speculative_margin - foot.lowest()) / size, foot.lowest());
    for (const std::size_t i : foot.chosen()) {
        if (i == foot.kNone) continue;
        const Point& point = found.points[i];
        out.add(point.position, point.separation, point.feature);
    }
    return true;
}

// How squarely a shape's face looks along the axis; 0 where it has no true face there.
double squareness(const Face& face, const Vec3& normal)
{
    return face.flat && face.count >= 3 ? std::abs(face.normal.dot(normal)) : 0;
}

}  // namespace

bool share_line(const Segment<double>& a,
                const Segment<double>& b,
                const Vec3& normal,
                double round,
                std::array<SharedEnd, 2>& ends)
{
    const Vec3 span = a.to - a.from;
    const Vec3 b_span = b.to - b.from;
    const double length = span.norm();
    if (!(length > 0)) return false;
    const Vec3 along = span / length;
    const double b_from = along.dot(b.from - a.from);
    const double b_along = along.dot(b_span);
    if (!(std::abs(b_along) > 0.9 * b_span.norm())) return false;

    const double low = std::max(0.0, std::min(b_from, b_from + b_along));
    const double high = std::min(length, std::max(b_from, b_from + b_along));
    if (!(high - low > kSlack * length)) return false;
    // At a twentieth of the radius the round sides have parted by a thousandth of it.
    const double widest = round > 0 ? 0.05 * round : 1e-3 * (high - low);
    const Vec3 beside = normal.cross(along);
    for (std::size_t i = 0; i < 2; ++i) {
        const double at = i == 0 ? low : high;
        const Vec3 on_a = a.from + along * at;
        const Vec3 between = b.from + b_span * ((at - b_from) / b_along) - on_a;
        const double aside = beside.dot(between);
        if (std::abs(aside) > widest) return false;
        const bool end_of_a = i == 0 ? low == 0.0 : high == length;
        ends[i] = {on_a, normal.dot(between),
                   static_cast<std::uint32_t>(0x2000 + 2 * i + (end_of_a ? 0 : 1))};
    }
    return true;
}

void fill_points(const ConvexCorePair& pair,
                 const ContactAxis& axis,
                 double speculative_margin,
                 LocalManifold<double>& out)
{
    out.count = 0;
    out.normal = axis.normal;
    const Vec3 into_b = pair.b_turn.transpose() * -axis.normal;
    Facing facing = {pair,
                     axis,
                     speculative_margin,
                     support_face(pair.a, axis.normal),
                     moved(support_face(pair.b, into_b), pair),
                     {},
                     0};
    const double square_a = squareness(facing.a, axis.normal);
    const double square_b = squareness(facing.b, axis.normal);
    const double slack = kSlack * std::min(pair.a.size, pair.b.size);
    // A face of a rather than one of b, unless b's is clearly squarer: names should not swap. A cap
    // had rather be clipped than clip, as its corners stand for a round rim.
    const auto handicap = [](const ConvexCore<double>& core) {
        return core.kind == ShapeKind::cylinder ? 1e-3 : 0;
    };
    const bool by_b = square_b - handicap(pair.b) > square_a - handicap(pair.a) + 1e-4;
    const double square = by_b ? square_b : square_a;
    Face edge_a;
    Face edge_b;
    bool by_lines = false;
    if (facing.a.count >= 2 && facing.b.count >= 2) {
        if (square > kFacing) {
            clip_over(facing, by_b, slack);
        } else if (leading_edge(facing.a, axis.normal, edge_a)
                   && leading_edge(facing.b, -axis.normal, edge_b)) {
            pair_lines(facing, edge_a, edge_b);
            by_lines = facing.count > 0;
        }
    }

    // Corners on a rim stand for the whole of it, so they may miss the nearest point by a little.
    double deepest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < facing.count; ++i) {
        deepest = std::min(deepest, facing.points[i].separation);
    }
    const bool rim = pair.a.kind == ShapeKind::cylinder || pair.b.kind == ShapeKind::cylinder;
    const double missed =
        (rim && square > 1 - 1e-9 ? 1e-5 : 1e-10) * std::min(pair.a.size, pair.b.size);
    if (!by_lines && deepest - (axis.separation - facing.convex_radius()) > missed) {
        const Vec3 middle = (axis.on_a + axis.on_b) / 2;
        facing.add(middle - axis.normal * (axis.separation / 2), axis.separation, kWitness);
    }
    if (rim && square > kFacing
        && keep_leaning_rim(facing, std::min(pair.a.size, pair.b.size), out))
        return;
    reduce_to_four<double>(std::span<const Point>(facing.points.data(), facing.count), out);
}

}  // namespace throng
