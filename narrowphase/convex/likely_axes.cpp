#include "narrowphase/convex/likely_axes.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Features must extend this many depths beyond the nearest points: a direction that leans by less
// than 150 degrees then separates no sooner.
constexpr double kMargin = 4;

// Of the size: by how much an axis between two caps may fall short.
constexpr double kNearEnough = 1e-6;

// A direction on trial; `inside` is by how much the nearest points lie within the two features.
struct Trial {
    ContactAxis axis;
    double inside = -1;
};

// The pair as seen by one of its cores: the other's frame in its own.
struct View {
    const ConvexCore<double>& self;
    const ConvexCore<double>& other;
    Mat3 turn;      // the other's axes in this frame
    Vec3 position;  // the other's origin in this frame

    Vec3 middle() const { return turn * other.middle + position; }

    /// The other's point furthest against a direction.
    Vec3 nearest(const Vec3& normal) const
    {
        const Vec3 local = turn.transpose() * -normal;
        return turn * support(other, local).position + position;
    }
};

View from_a(const ConvexCorePair& pair) { return {pair.a, pair.b, pair.b_turn, pair.b_position}; }

View from_b(const ConvexCorePair& pair)
{
    const Mat3 back = pair.b_turn.transpose();
    return {pair.b, pair.a, back, -(back * pair.b_position)};
}

// How far a cylinder or a capsule's core reaches along a direction of its own frame.
double extent_along(const ConvexCore<double>& core, const Vec3& local)
{
    const double across = std::sqrt(local.x() * local.x() + local.y() * local.y());
    return core.extents.x() * across + core.extents.z() * std::abs(local.z());
}

// The normal of a box's or hull's face, outward, and how far the face is from the origin.
struct Plate {
    Vec3 normal;
    double offset;
};

Plate best_plate(const View& view)
{
    const Vec3 axis = view.turn.col(2);
    Plate best = {Vec3::UnitZ(), 0};
    double most = -std::numeric_limits<double>::infinity();
    const auto consider = [&](const Vec3& normal, double offset) {
        const double separation = normal.dot(view.position) - offset
            - extent_along(view.other, view.turn.transpose() * normal);
        if (!(separation > most)) return;
        most = separation;
        best = {normal, offset};
    };
    if (view.self.kind == ShapeKind::box) {
        // A box sees the cylinder's axis by its coordinates, so the speculative margin needs no
        // turning.
        for (int i = 0; i < 3; ++i) {
            const double lean = axis[i];
            const double extent = view.other.extents.z() * std::abs(lean)
                + view.other.extents.x() * std::sqrt(std::max(0.0, 1 - lean * lean));
            const double separation = std::abs(view.position[i]) - view.self.extents[i] - extent;
            if (!(separation > most)) continue;
            most = separation;
            best.normal = Vec3::Unit(i) * (view.position[i] >= 0 ? 1 : -1);
            best.offset = view.self.extents[i];
        }
        return best;
    }
    for (std::size_t i = 0; i < view.self.hull->normals.size(); ++i) {
        consider(view.self.hull->normals[i], view.self.hull->offsets[i]);
    }
    return best;
}

// A cylinder or capsule against the face of a box or hull that it is furthest above.
Trial try_plate(const View& view)
{
    const Plate plate = best_plate(view);
    Trial trial;
    trial.axis.normal = plate.normal;
    trial.axis.on_b = view.nearest(plate.normal);
    trial.axis.separation = plate.normal.dot(trial.axis.on_b) - plate.offset;
    trial.axis.on_a = trial.axis.on_b - plate.normal * trial.axis.separation;

    trial.inside = std::numeric_limits<double>::infinity();
    const SupportFace<double> face = support_face(view.self, plate.normal);
    for (int i = 0; i < face.count; ++i) {
        const Vec3& from = face.corners[static_cast<std::size_t>(i)];
        const Vec3& to = face.corners[static_cast<std::size_t>((i + 1) % face.count)];
        const Vec3 inward = unit_or<double>(plate.normal.cross(to - from), Vec3::Zero());
        trial.inside = std::min(trial.inside, inward.dot(trial.axis.on_b - from));
    }
    return trial;
}

// Whatever stands on the cap of a cylinder.
Trial try_cap(const View& view)
{
    Trial trial;
    const double side = view.middle().z() >= 0 ? 1 : -1;
    trial.axis.normal = Vec3(0, 0, side);
    trial.axis.on_b = view.nearest(trial.axis.normal);
    trial.axis.separation = side * trial.axis.on_b.z() - view.self.extents.z();
    trial.axis.on_a = trial.axis.on_b - trial.axis.normal * trial.axis.separation;
    const Vec3& at = trial.axis.on_b;
    trial.inside = view.self.extents.x() - std::sqrt(at.x() * at.x() + at.y() * at.y());
    // A cap on a cap of its size always has its lowest point beside the other's rim. The true axis
    // lies between the two caps' normals, so it separates further by no more than this.
    const Vec3 along = view.turn.col(2);
    const double lean = std::sqrt(along.x() * along.x() + along.y() * along.y());
    const bool capped = view.other.kind == ShapeKind::cylinder && trial.inside < 0;
    if (capped && -trial.inside * lean < kNearEnough * view.self.size
        && -trial.inside < view.self.extents.x() / 2) {
        trial.inside = view.self.extents.x() / 2;
    }
    return trial;
}

// The other cylinder beside this one's side. Seen along this axis the other's axis is a short
// segment; its nearest point to the middle gives the direction, corrected where that is an end,
// whose rim is then seen as an ellipse.
Trial try_side(const View& view)
{
    const Vec3 along = view.turn.col(2);
    const double half = view.other.extents.z();
    const double radius = view.other.extents.x();
    const double lean = along.x() * along.x() + along.y() * along.y();
    double at = 0;
    if (lean > 0) {
        at = -(along.x() * view.position.x() + along.y() * view.position.y()) / lean;
        at = std::clamp(at, -half, half);
    }
    Trial trial;
    const Vec3 center = view.position + along * at;
    const Vec3 flat(center.x(), center.y(), 0);
    const double together = view.self.extents.x() + radius;
    if (!(flat.squaredNorm() > together * together / 4)) return trial;

    Vec3 normal = unit_or<double>(flat, Vec3::UnitX());
    const bool at_end = std::abs(at) == half;
    if (at_end && lean > 0.01) return trial;
    for (int i = 0; at_end && i < 8; ++i) {
        const double slope = along.dot(normal);
        const Vec3 corrected =
            center + along * (radius * slope / std::sqrt(std::max(0.5, 1 - slope * slope)));
        const Vec3 before = normal;
        normal = unit_or<double>(Vec3(corrected.x(), corrected.y(), 0), normal);
        if ((normal - before).squaredNorm() < 1e-30) break;
    }
    trial.axis.normal = normal;
    trial.axis.on_b = view.nearest(normal);
    trial.axis.separation = normal.dot(trial.axis.on_b) - view.self.extents.x();
    // Where axes are parallel to rounding, any place that both have will do.
    double low = center.z();
    double high = center.z();
    if (lean < 1e-24) {
        low = view.position.z() - half;
        high = view.position.z() + half;
    }
    const double extent = view.self.extents.z();
    trial.inside = std::min(extent - low, high + extent);
    const double middle =
        std::clamp((std::max(low, -extent) + std::min(high, extent)) / 2, -extent, extent);
    trial.axis.on_a = normal * view.self.extents.x() + Vec3(0, 0, middle);
    trial.axis.on_b = trial.axis.on_a + normal * trial.axis.separation;
    return trial;
}

void keep(Trial& best, const Trial& trial)
{
    if (trial.inside == -1 && trial.axis.separation == 0) return;
    if (trial.axis.separation > best.axis.separation) best = trial;
}

// The trial of b's view in a's frame: sides changed over.
Trial turned(const ConvexCorePair& pair, const Trial& trial)
{
    Trial result = trial;
    result.axis.normal = -(pair.b_turn * trial.axis.normal);
    result.axis.on_a = pair.b_turn * trial.axis.on_b + pair.b_position;
    result.axis.on_b = pair.b_turn * trial.axis.on_a + pair.b_position;
    return result;
}

bool is_polytope(ShapeKind kind) { return kind == ShapeKind::box || kind == ShapeKind::hull; }
bool is_rod(ShapeKind kind) { return kind == ShapeKind::cylinder || kind == ShapeKind::capsule; }

Trial best_trial(const View& view)
{
    Trial best;
    best.axis.separation = -std::numeric_limits<double>::infinity();
    const ShapeKind self = view.self.kind;
    const ShapeKind other = view.other.kind;
    if (is_polytope(self) && is_rod(other)) keep(best, try_plate(view));
    if (self == ShapeKind::cylinder) {
        keep(best, try_cap(view));
        if (other == ShapeKind::cylinder) keep(best, try_side(view));
    }
    return best;
}

}  // namespace

Likely likely_axis(const ConvexCorePair& pair, double limit, ContactAxis& axis)
{
    Trial best = best_trial(from_a(pair));
    keep(best, turned(pair, best_trial(from_b(pair))));
    axis = best.axis;
    if (best.axis.separation > limit) return Likely::beyond;
    const double wanted = std::max(0.0, -kMargin * best.axis.separation);
    return best.inside >= wanted ? Likely::found : Likely::unknown;
}

}  // namespace throng
