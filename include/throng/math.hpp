// Types: throng's names for Eigen's small vectors, matrices and quaternions.
//
// Poses are double everywhere. Contact arithmetic is over Real (float or double), relative to the
// pair. None of these types asks for more alignment than its numbers do, so that plain arrays of
// them stay plain whatever instruction set a file is compiled for.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>

namespace throng {

template <class Real>
using Vec3T = Eigen::Matrix<Real, 3, 1>;
template <class Real>
using Mat3T = Eigen::Matrix<Real, 3, 3>;
template <class Real>
using QuatT = Eigen::Quaternion<Real, Eigen::DontAlign>;

using Vec3 = Vec3T<double>;
using Mat3 = Mat3T<double>;
using Quat = QuatT<double>;

/// Where a frame is and how it is turned: world = orientation * local + position.
template <class Real>
struct PoseT {
    Vec3T<Real> position = Vec3T<Real>::Zero();
    QuatT<Real> orientation = QuatT<Real>::Identity();

    Vec3T<Real> operator*(const Vec3T<Real>& local) const { return orientation * local + position; }
    PoseT operator*(const PoseT& inner) const
    {
        return {*this * inner.position, orientation * inner.orientation};
    }
    /// The point as seen from inside this frame.
    Vec3T<Real> to_local(const Vec3T<Real>& world) const
    {
        return orientation.conjugate() * (world - position);
    }
    /// This frame's world as seen from inside of it.
    PoseT inverse() const
    {
        const QuatT<Real> back = orientation.conjugate();
        return {-(back * position), back};
    }
};
using Pose = PoseT<double>;

/// A symmetric 3x3 matrix, as six numbers: xx, yy, zz, xy, xz, yz.
struct Sym3 {
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

    Mat3 matrix() const
    {
        Mat3 m;
        m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
        return m;
    }
    /// Whether its axes are not the principal ones.
    bool has_products() const { return xy != 0 || xz != 0 || yz != 0; }
    static Sym3 from(const Mat3& m)
    {
        return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
    }
    bool operator==(const Sym3&) const = default;
};

}  // namespace throng
