#include "kernels/geometry/depth_image.hpp"

#include "kernels/check.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/support.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Twice the area of (0, from, to), seen along the rays; minus that, to the last bit, for (to,
// from).
double area_of(const Vec3& from, const Vec3& to) { return from.x() * to.y() - from.y() * to.x(); }

// On which side of an edge the ray at the origin passes. A ray through the edge itself, or as near
// as makes no difference, passes on the side that the edge's direction says: the other one for the
// triangle beyond it, which runs through it the other way.
bool passes_left(const Vec3& from, const Vec3& to, double area)
{
    if (area != 0) return area > 0;
    return from.y() != to.y() ? from.y() < to.y() : from.x() > to.x();
}

// Where a row crosses a triangle, and a bit more: no ray of the row beyond that can meet it.
struct Span {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void add(double x)
    {
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

Span row_span(const std::array<Vec3, 3>& corners, double y, double pixel)
{
    Span span;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 &from = corners[i], &to = corners[i == 2 ? 0 : i + 1];
        if ((from.y() < y && to.y() < y) || (from.y() > y && to.y() > y)) continue;
        const double rise = to.y() - from.y();
        // So flat an edge crosses the row anywhere.
        if (!(std::abs(rise) > 1e-3 * pixel)) {
            span.add(from.x());
            span.add(to.x());
        } else {
            span.add(from.x() + (to.x() - from.x()) * ((y - from.y()) / rise));
        }
    }
    return span;
}

// So few rays are tried at once: where an edge crosses a row costs more to find.
constexpr std::int32_t kFew = 3;

}  // namespace

RayAxis::RayAxis(const RayGrid& grid, std::size_t axis)
    : per_pixel_(1 / grid.pixel), start_(grid.first[axis] + grid.shift[axis]),
      last_(grid.count[axis] - 1)
{ }

void DepthImage::draw(const Shapes& shapes,
                      ShapeRef shape,
                      const Pose& in_view,
                      const RayGrid& grid,
                      Layers layers,
                      double thickness)
{
    THRONG_CHECK(shape.kind != ShapeKind::triangle, "a triangle has no inside");
    begin(shapes, shape, in_view, grid);
    if (mesh_ == nullptr) {
        draw_convex();
        return;
    }
    draw_triangles();
    finish(layers, thickness);
}

void DepthImage::begin(const Shapes& shapes,
                       ShapeRef shape,
                       const Pose& in_view,
                       const RayGrid& grid)
{
    grid_ = grid;
    shapes_ = &shapes;
    shape_ = shape;
    mesh_ = mesh_of(shapes, shape);
    position_ = in_view.position;
    turn_ = in_view.orientation.toRotationMatrix();
    intervals_.clear();
    begin_.assign(1, 0);
    hits_.clear();
}

void DepthImage::begin_from(const Shapes& shapes,
                            ShapeRef shape,
                            const Pose& in_view,
                            const RayGrid& grid,
                            const RayLayers& drawn)
{
    begin(shapes, shape, in_view, grid);
    const RayGrid& from = drawn.grid;
    for (std::int32_t row = 0; row < grid.count[1]; ++row)
        for (std::int32_t i = 0; i < grid.count[0]; ++i) {
            const std::int32_t x = grid.first[0] - from.first[0] + i;
            const std::int32_t y = grid.first[1] - from.first[1] + row;
            if (x >= 0 && x < from.count[0] && y >= 0 && y < from.count[1]) {
                const auto ray = static_cast<std::size_t>(y * from.count[0] + x);
                for (std::uint32_t k = drawn.begin[ray]; k < drawn.begin[ray + 1]; ++k)
                    intervals_.push_back(drawn.intervals[k]);
            }
            begin_.push_back(static_cast<std::uint32_t>(intervals_.size()));
        }
}

void DepthImage::finish(Layers layers, double thickness)
{
    sort_hits();
    for (std::size_t ray = 0; ray < grid_.rays(); ++ray) {
        const auto hits = std::span<const Hit>(sorted_).subspan(
            hit_begin_[ray], hit_begin_[ray + 1] - hit_begin_[ray]);
        if (layers == Layers::all) join_layers(hits);
        if (layers == Layers::single) join_ends(hits);
        if (layers == Layers::sheet) join_sheets(hits, thickness);
        begin_.push_back(static_cast<std::uint32_t>(intervals_.size()));
    }
}

// From the shape's own height on.
RayPassage DepthImage::passage_of(std::int32_t column, std::int32_t row) const
{
    const Vec3 from(grid_.at(0, column) - position_.x(), grid_.at(1, row) - position_.y(), 0);
    return pass_through(*shapes_, shape_, {turn_.transpose() * from, turn_.row(2).transpose()});
}

// A face of a convex shape is twice its ray, and one more where the ray leaves.
Vec3 DepthImage::normal(std::uint32_t face) const
{
    if (mesh_ != nullptr) return turn_ * mesh_->normals[face];
    const auto ray = static_cast<std::int32_t>(face / 2);
    const RayPassage part = passage_of(ray % grid_.count[0], ray / grid_.count[0]);
    const bool leaves = face % 2 == 1;
    return unit_or(Vec3(turn_ * (leaves ? part.leave_normal : part.enter_normal)),
                   Vec3(0, 0, leaves ? 1 : -1));
}

void DepthImage::draw_convex()
{
    std::uint32_t face = 0;
    for (std::int32_t row = 0; row < grid_.count[1]; ++row)
        for (std::int32_t column = 0; column < grid_.count[0]; ++column, face += 2) {
            const RayPassage part = passage_of(column, row);
            if (!part.empty())
                intervals_.push_back(
                    {position_.z() + part.enter, position_.z() + part.leave,
                     part.enter_normal.isZero(0) ? RayInterval::kNoFace : face,
                     part.leave_normal.isZero(0) ? RayInterval::kNoFace : face + 1});
            begin_.push_back(static_cast<std::uint32_t>(intervals_.size()));
        }
}

// All triangles that the column of rays can meet, above and below whatever is looked at as well:
// whether a ray is inside hangs on all that it has met before.
void DepthImage::draw_triangles()
{
    if (grid_.rays() == 0) return;
    const RayAxis across(grid_, 0), upward(grid_, 1);
    // The column and a pixel more, so that rounding leaves nothing out.
    const Vec3 low(grid_.at(0, -1), grid_.at(1, -1), 0);
    const Vec3 high(grid_.at(0, grid_.count[0]), grid_.at(1, grid_.count[1]), 0);
    const Vec3 center = 0.5 * (low + high) - position_, half = 0.5 * (high - low);
    const Mat3 extents = turn_.cwiseAbs();
    const auto in_column = [&](const Mesh::Node& node) {
        const Vec3 apart = (turn_ * (0.5 * (node.lower + node.upper)) - center).cwiseAbs();
        const Vec3 near = extents * (0.5 * (node.upper - node.lower)) + half;
        return apart.x() <= near.x() && apart.y() <= near.y();
    };
    visit_nodes(*mesh_, in_column, [&](std::uint32_t triangle) {
        std::array<Vec3, 3> corners;
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = turn_ * mesh_->vertices[mesh_->triangles[triangle][i]] + position_;
        const auto [left, right] = std::minmax({corners[0].x(), corners[1].x(), corners[2].x()});
        const auto [lower, upper] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
        add(triangle, corners, {across.between(left, right), upward.between(lower, upper)});
    });
}

void DepthImage::add(std::uint32_t triangle,
                     const std::array<Vec3, 3>& corners,
                     const RayWindow& rays)
{
    if (rays.columns.empty()) return;
    for (std::int32_t row = rays.rows.first; row <= rays.rows.last; ++row)
        draw_row(triangle, corners, row, rays.columns);
}

void DepthImage::draw_row(std::uint32_t triangle,
                          const std::array<Vec3, 3>& corners,
                          std::int32_t row,
                          const RayRange& columns)
{
    const double y = grid_.at(1, row);
    RayRange range = columns;
    if (columns.last - columns.first >= kFew) {
        const Span span = row_span(corners, y, grid_.pixel);
        if (!(span.low <= span.high)) return;
        range = RayAxis(grid_, 0).between(span.low, span.high);
    }
    for (std::int32_t i = range.first; i <= range.last; ++i) {
        const Vec3 start(grid_.at(0, i), y, 0);
        const Vec3 a = corners[0] - start, b = corners[1] - start, c = corners[2] - start;
        const double u = area_of(b, c), v = area_of(c, a), w = area_of(a, b);
        const bool left = passes_left(a, b, w);
        if (passes_left(b, c, u) != left || passes_left(c, a, v) != left) continue;
        const double sum = u + v + w;
        const double depth =
            sum != 0 ? (u / sum) * a.z() + (v / sum) * b.z() + (w / sum) * c.z() : a.z();
        hits_.push_back(
            {depth, static_cast<std::uint32_t>(row * grid_.count[0] + i), triangle, !left});
    }
}

// By ray, then by depth; ways in before ways out, so that solids that merely touch are one.
void DepthImage::sort_hits()
{
    hit_begin_.assign(grid_.rays() + 2, 0);
    for (const Hit& hit : hits_) ++hit_begin_[hit.ray + 2];
    for (std::size_t i = 2; i < hit_begin_.size(); ++i) hit_begin_[i] += hit_begin_[i - 1];
    sorted_.resize(hits_.size());
    for (const Hit& hit : hits_) sorted_[hit_begin_[hit.ray + 1]++] = hit;
    const auto before = [](const Hit& a, const Hit& b) {
        if (a.depth != b.depth) return a.depth < b.depth;
        if (a.enters != b.enters) return a.enters;
        return a.triangle < b.triangle;
    };
    for (std::size_t ray = 0; ray < grid_.rays(); ++ray)
        std::sort(sorted_.begin() + hit_begin_[ray], sorted_.begin() + hit_begin_[ray + 1], before);
}

// What ends later takes in whatever of the ray it covers.
void DepthImage::append(const RayInterval& interval, std::size_t first)
{
    RayInterval whole = interval;
    while (intervals_.size() > first && intervals_.back().leave >= whole.enter) {
        const RayInterval& last = intervals_.back();
        if (last.enter < whole.enter) {
            whole.enter = last.enter;
            whole.enter_face = last.enter_face;
        }
        if (last.leave > whole.leave) {
            whole.leave = last.leave;
            whole.leave_face = last.leave_face;
        }
        intervals_.pop_back();
    }
    intervals_.push_back(whole);
}

void DepthImage::join_layers(std::span<const Hit> hits)
{
    const std::size_t first = intervals_.size();
    open_.clear();
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
        if (hits[i].enters) {
            open_.push_back(i);
        } else if (!open_.empty()) {
            const Hit& in = hits[open_.back()];
            open_.pop_back();
            append({in.depth, hits[i].depth, in.triangle, hits[i].triangle}, first);
        }
    }
}

void DepthImage::join_ends(std::span<const Hit> hits)
{
    std::size_t in = 0, out = hits.size();
    while (in < hits.size() && !hits[in].enters) ++in;
    while (out > in && hits[out - 1].enters) --out;
    if (in >= out) return;
    const Hit &enter = hits[in], &leave = hits[out - 1];
    intervals_.push_back({enter.depth, leave.depth, enter.triangle, leave.triangle});
}

void DepthImage::join_sheets(std::span<const Hit> hits, double thickness)
{
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit& hit = hits[i];
        if (hit.enters) {
            RayInterval layer{hit.depth, hit.depth + thickness, hit.triangle, RayInterval::kNoFace};
            if (i + 1 < hits.size()) {
                const Hit& next = hits[i + 1];
                // So near a back face closes the layer, and is done with.
                if (!next.enters && next.depth <= hit.depth + 2 * thickness) {
                    layer.leave = next.depth;
                    layer.leave_face = next.triangle;
                    ++i;
                }
                layer.leave = std::min(layer.leave, next.depth);
            }
            intervals_.push_back(layer);
        } else {
            const double behind = hit.depth - thickness;
            const double before = i > 0 ? std::max(behind, hits[i - 1].depth) : behind;
            intervals_.push_back({before, hit.depth, RayInterval::kNoFace, hit.triangle});
        }
    }
}

}  // namespace throng
