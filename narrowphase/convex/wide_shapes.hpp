// Wide shapes: boxes and hulls of the world as the hull kernels want them.
#pragma once

#include "kernels/data/shapes.hpp"

namespace throng {

/// A box or a hull as a wide polytope. Keep it while the view is in use.
class WideShape {
public:
    WideShape(const Shapes& shapes, ShapeRef shape);

    /// False where float will not do.
    bool suited() const { return suited_; }
    const WidePolytope& view() const { return view_; }
    const Vec3& center() const { return center_; }

private:
    void be_box(const Vec3& half_extents);

    bool suited_ = false;
    WidePolytope view_;
    Vec3 center_ = Vec3::Zero();
    alignas(64) float box_[WidePolytope::count_of_numbers(8, 6)];
};

}  // namespace throng
