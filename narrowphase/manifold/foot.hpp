// Foot: which of a body's points bear it on a flat face.
//
// What leans on its lowest points is held there; points a hair above them, or that a step may bring
// down, would else take turns in bearing it.
#pragma once

#include "kernels/math/numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace throng {

/// Picks up to four of a body's points that bear it on a face.
///
///   Points   size(); at(i), a place of any frame; height(i), m, of the place above the face
template <class Real, class Points>
class Foot {
public:
    static constexpr std::size_t kNone = ~std::size_t{0};
    /// rad; of a ball, 1e-5 of its radius is within this of its lowest point.
    static constexpr Real kLevelTilt = Real(5e-3);

    /// into     unit, from the body into the face
    /// margin   m, points higher than this bear nothing
    Foot(const Points& points, const Vec3T<Real>& into, Real margin)
        : points_(points), into_(into), margin_(margin),
          lowest_(std::numeric_limits<Real>::infinity())
    {
        for (std::size_t i = 0; i < points.size(); ++i)
            lowest_ = std::min(lowest_, points.height(i));
    }

    bool within_margin() const { return lowest_ <= margin_; }

    Real lowest() const { return lowest_; }

    /// Of the points that tilting by an angle, rad, may bring down to a height, m, four that span
    /// the most area: the lowest, the one furthest from it, and the furthest to either side of the
    /// line between them. Which is lowest does not matter within a ten-thousandth of the size, m.
    void spread(Real size, Real tilt, Real down)
    {
        const Real slack = std::min(Real(1e-4) * size, std::max(margin_ - lowest_, Real(0)));
        tilt_ = tilt;
        down_ = std::max(lowest_, down);
        first_ = lowest_within(slack);
        left_ = right_ = kNone;
        const Vec3T<Real> from = points_.at(first_);
        const auto flat_from = [&](const Vec3T<Real>& place) -> Vec3T<Real> {
            const Vec3T<Real> offset = place - from;
            return offset - into_ * offset.dot(into_);
        };
        second_ = first_down([&](const auto& place) { return flat_from(place).norm(); });
        if (second_ == kNone) return;
        const Vec3T<Real> along = flat_from(points_.at(second_));
        const Real length = along.norm();
        const Vec3T<Real> left = into_.cross(along) / length;
        // Within a millionth of the line's own length, what is beside it is noise.
        const auto beside = [&](Real sign) {
            return first_down([&](const auto& place) {
                return sign * left.dot(place - from) - Real(1e-6) * length;
            });
        };
        left_ = beside(Real(1));
        right_ = beside(Real(-1));
    }

    /// Of what has sunk in and what tilting may bring down to the face, four on which a body
    /// stands, by the least tilt that gives such, each twice the one before; by `most` where none
    /// does. Points that are farther out would brake what rolls over those between.
    void spread_to_stand(Real size, Real most, const Vec3T<Real>& middle)
    {
        for (Real tilt = kLevelTilt; tilt < most; tilt *= 2) {
            spread(size, tilt, Real(0));
            if (stands(middle)) return;
        }
        spread(size, most, Real(0));
    }

    /// Whether a body would stand on these, its middle above what they span.
    bool stands(const Vec3T<Real>& middle) const
    {
        if (second_ == kNone) return false;
        const std::array<std::size_t, 4> round = {first_, right_, second_, left_};
        Vec3T<Real> from = points_.at(left_ == kNone ? second_ : left_);
        for (const std::size_t i : round) {
            if (i == kNone) continue;
            const Vec3T<Real> to = points_.at(i);
            if (!(into_.cross(to - from).dot(middle - from) > 0)) return false;
            from = to;
        }
        return true;
    }

    /// The lowest, the furthest, and those to the sides; kNone where there is none.
    std::array<std::size_t, 4> chosen() const { return {first_, second_, left_, right_}; }

private:
    std::size_t lowest_within(Real slack) const
    {
        std::size_t i = 0;
        while (!(points_.height(i) <= lowest_ + slack)) ++i;
        return i;
    }

    // The one that the tilt would take furthest down, where distance(place) tells how far it is
    // from the axis of tilting; none where all would stay above the lowest. Among near equals the
    // first wins, so that noise in the pose does not swap points from step to step: a hundredth of
    // what a level tilt does, and less by wider ones.
    template <class Distance>
    std::size_t first_down(const Distance& distance) const
    {
        const Real alike = tilt_ > kLevelTilt ? Real(1.001) : Real(1.01);
        std::size_t best = kNone;
        Real most = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const Real height = points_.height(i);
            if (!(height <= margin_)) continue;
            const Real below = tilt_ * distance(points_.at(i)) - (std::max(height, down_) - down_);
            if (!(below > most * alike)) continue;
            most = below;
            best = i;
        }
        return best;
    }

    const Points& points_;
    Vec3T<Real> into_;
    Real margin_, lowest_;
    Real tilt_ = 0;  // rad
    Real down_ = 0;  // m
    std::size_t first_ = kNone, second_ = kNone, left_ = kNone, right_ = kNone;
};

}  // namespace throng
