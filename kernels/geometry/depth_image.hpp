// Depth image: where parallel rays are inside a body, as intervals of depth, after the Z buffer.
//
// All layers of a body are kept, so that what passes through a hole is seen to. Triangles are found
// by the mesh's own tree and drawn into the grid of rays by our own arithmetic, rather than shot at
// through a ray tracer: bits are then the same on every machine, a ray through a shared edge
// meets exactly one of the two triangles, so that closed meshes give no odd counts, and no second
// tree is kept. Convex shapes have their intervals in closed form.
//
// Source: Heidelberger, Teschner, Gross, Detection of collisions and self-collisions using
//         image-space techniques (2004); Woop, Benthin, Wald, Watertight Ray/Triangle Intersection
//         (2013), for the sign of an edge.
#pragma once

#include "kernels/data/ray_layers.hpp"
#include "kernels/geometry/ray_passage.hpp"

#include <span>

namespace throng {

/// The rays of an axis from low to high, and those that only rounding leaves out.
struct RayRange {
    std::int32_t first = 0, last = -1;

    bool empty() const { return first > last; }
};

/// Finds them for an axis of a grid.
class RayAxis {
public:
    RayAxis(const RayGrid& grid, std::size_t axis);
    RayRange between(double low, double high) const
    {
        // In pixels: more than rounding moves a place, or where a row crosses an edge.
        constexpr double kSlack = 1.0 / 64;
        const double from = low * per_pixel_ - start_ - kSlack;
        const double to = high * per_pixel_ - start_ + kSlack;
        if (!(to >= 0 && from <= last_)) return {};
        // Below the count now, so that they fit.
        std::int32_t first = from > 0 ? static_cast<std::int32_t>(from) : 0;
        if (first < from) ++first;
        return {first, static_cast<std::int32_t>(to < last_ ? to : last_)};
    }

private:
    double per_pixel_, start_, last_;
};

/// Of a grid.
struct RayWindow {
    RayRange columns, rows;
};

/// What of a body counts as its inside.
///
///   all     what its surface encloses, each layer for itself. Hits need not pair up: a way in is
///           taken with the nearest way out that no later way in has taken, and what is left over
///           is left out. So bodies that cut themselves are whole, and where a triangle is missing
///           the rays through it lose the layer, and no more
///   single  from the first way in to the last way out. Half the work, and wrong wherever a ray
///           passes through a body more than once: holes and hollows are filled
///   sheet   of an open mesh: what lies behind a front face, as far as its next face, and some
///           thickness at most; twice that where the next one is a back face. What hangs that close
///           below another front face counts as inside it
enum class Layers : std::uint8_t { all, single, sheet };

/// The intervals of a body along the rays of a grid, x fastest. Intervals of a ray do not overlap,
/// and ascend. Keeps its room from one drawing to the next.
class DepthImage {
public:
    /// Draws a shape of any kind but a lone triangle. Never throws but for want of memory.
    ///
    ///   in_view    the shape's pose in the frame of the rays
    ///   thickness  m, of a sheet; of others not looked at
    ///
    /// Keep the shapes while the image is in use.
    void draw(const Shapes& shapes,
              ShapeRef shape,
              const Pose& in_view,
              const RayGrid& grid,
              Layers layers,
              double thickness = 0);

    /// The same of a mesh or a solid, triangle by triangle, for one who draws several images of it
    /// at once: begin, add all that any ray may meet, finish.
    void begin(const Shapes& shapes, ShapeRef shape, const Pose& in_view, const RayGrid& grid);
    /// Corners in the frame of the rays, the same bits wherever triangles share one; and the rays
    /// that may meet it.
    void add(std::uint32_t triangle, const std::array<Vec3, 3>& corners, const RayWindow& rays);
    void finish(Layers layers, double thickness = 0);

    /// The same by intervals that were drawn before, along the rays of a grid that differs in
    /// `first` and `count` alone: rays beyond it meet nothing.
    void begin_from(const Shapes& shapes,
                    ShapeRef shape,
                    const Pose& in_view,
                    const RayGrid& grid,
                    const RayLayers& drawn);
    /// What was drawn.
    RayLayers layers() const { return {grid_, begin_, intervals_}; }

    std::span<const RayInterval> on(std::size_t ray) const
    {
        return std::span(intervals_).subspan(begin_[ray], begin_[ray + 1] - begin_[ray]);
    }
    /// Unit, out of the body, in the frame of the rays. Of a convex shape it is worked out anew.
    Vec3 normal(std::uint32_t face) const;

private:
    struct Hit {
        double depth;
        std::uint32_t ray, triangle;
        bool enters;
    };

    RayPassage passage_of(std::int32_t column, std::int32_t row) const;
    void draw_convex();
    void draw_triangles();
    void draw_row(std::uint32_t triangle,
                  const std::array<Vec3, 3>& corners,
                  std::int32_t row,
                  const RayRange& columns);
    void sort_hits();
    void join_layers(std::span<const Hit> hits);
    void join_ends(std::span<const Hit> hits);
    void join_sheets(std::span<const Hit> hits, double thickness);
    void append(const RayInterval& interval, std::size_t first);

    RayGrid grid_;
    const Shapes* shapes_ = nullptr;
    const Mesh* mesh_ = nullptr;
    ShapeRef shape_;
    Vec3 position_ = Vec3::Zero();
    Mat3 turn_ = Mat3::Identity();
    std::vector<std::uint32_t> begin_;  // [rays + 1] into intervals_
    std::vector<RayInterval> intervals_;

    // Room for work.
    std::vector<Hit> hits_, sorted_;
    std::vector<std::uint32_t> hit_begin_, open_;
};

}  // namespace throng
