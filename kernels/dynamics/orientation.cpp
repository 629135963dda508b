#include "kernels/dynamics/orientation.hpp"

#include "kernels/math/numbers.hpp"
#include "kernels/math/rotation.hpp"

#include <cmath>

namespace throng {

namespace {

Quat quaternion_at(const double* numbers)
{
    return {numbers[3], numbers[0], numbers[1], numbers[2]};
}
Mat3 matrix_at(const double* numbers)
{
    Mat3 m;
    m << vector_at(numbers), vector_at(numbers + 3), vector_at(numbers + 6);
    return m;
}

Quat unit(const Quat& q)
{
    const double length = std::sqrt(q.squaredNorm());
    return Quat(q.coeffs() / length);
}

// The vector of a unit quaternion, of at most half a turn. The angle comes by halving: the tangent
// of half an angle is that of the whole over 1 plus its secant, and what is left is a short series.
Vec3 vector_of(const Quat& orientation)
{
    const double sign = orientation.w() < 0 ? -1 : 1;
    const Vec3 axis = sign * orientation.vec();
    const double sine = std::sqrt(axis.squaredNorm());
    if (sine == 0) return Vec3::Zero();
    double tangent = sine / (1 + sign * orientation.w());  // of a quarter of the angle
    constexpr int kHalvings = 4;
    for (int k = 0; k < kHalvings; ++k) tangent /= 1 + std::sqrt(1 + tangent * tangent);
    const double square = tangent * tangent;
    double series = 0;
    for (int k = 19; k >= 1; k -= 2) series = 1.0 / k - square * series;
    const double angle = 4 * (1 << kHalvings) * tangent * series;
    return axis * (angle / sine);
}

// Column by column: for what is too far gone to have an inverse.
Mat3 orthonormal(const Mat3& m)
{
    const Vec3 x = m.col(0) / std::sqrt(m.col(0).squaredNorm());
    const Vec3 along = m.col(1) - x * x.dot(m.col(1));
    const Vec3 y = along / std::sqrt(along.squaredNorm());
    Mat3 result;
    result << x, y, x.cross(y);
    return result;
}

// The rotation next to a matrix, by Newton's iteration on its polar decomposition, scaled so that
// it takes a dozen steps however far the matrix has strayed.
//
// Source: Higham, Computing the polar decomposition (1986).
Mat3 nearest_rotation(const Mat3& strayed)
{
    Mat3 m = strayed;
    constexpr int kMostSteps = 24;
    constexpr double kScaleUntil = 0.01;
    for (int step = 0; step < kMostSteps; ++step) {
        const Mat3 back = m.inverse().transpose();
        const double change = std::sqrt((m - back).squaredNorm());
        if (!(change > 1e-15)) break;
        const double scale =
            change > kScaleUntil ? std::sqrt(std::sqrt(back.squaredNorm() / m.squaredNorm())) : 1;
        m = 0.5 * (scale * m + back / scale);
    }
    return std::abs(m.squaredNorm() - 3) < 1e-6 ? m : orthonormal(strayed);
}

}  // namespace

int numbers_of(Rotation rotation)
{
    switch (rotation) {
    case Rotation::quaternion:
    case Rotation::quaternion_euler:
        return 4;
    case Rotation::rotation_vector:
        return 3;
    default:
        return 9;
    }
}

bool adds_rates(Rotation rotation) { return rotation >= Rotation::quaternion_euler; }

OrientationNumbers write_orientation(Rotation rotation, const Quat& orientation)
{
    OrientationNumbers numbers = {};
    if (numbers_of(rotation) == 4)
        put(orientation.coeffs(), numbers.data());
    else if (numbers_of(rotation) == 3)
        put(vector_of(orientation), numbers.data());
    else
        put(orientation.toRotationMatrix(), numbers.data());
    return numbers;
}

Quat read_orientation(Rotation rotation, const double* numbers)
{
    if (numbers_of(rotation) == 4) return unit(quaternion_at(numbers));
    if (numbers_of(rotation) == 3) return unit(exponential(vector_at(numbers)));
    return unit(Quat(nearest_rotation(matrix_at(numbers))));
}

Mat3 matrix_of(Rotation rotation, const double* numbers)
{
    if (numbers_of(rotation) == 9) return matrix_at(numbers);
    return read_orientation(rotation, numbers).toRotationMatrix();
}

void turn_on(Rotation rotation, const Vec3& turn, double* numbers)
{
    const Quat change = exponential(turn);
    if (numbers_of(rotation) == 4) {
        put(unit(quaternion_at(numbers) * change).coeffs(), numbers);
    } else if (numbers_of(rotation) == 3) {
        const Quat before = exponential(vector_at(numbers));
        put(vector_of(unit(before * change)), numbers);
    } else {
        // Rounding alone has made it stray: one Newton step towards the nearest rotation will do.
        const Mat3 m = matrix_at(numbers) * change.toRotationMatrix();
        const Mat3 excess = Mat3(m.transpose() * m) - Mat3(Mat3::Identity());
        put(Mat3(m - 0.5 * Mat3(m * excess)), numbers);
    }
}

void rates_of(Rotation rotation, const double* numbers, const Vec3& velocity, double* rates)
{
    if (numbers_of(rotation) == 4) {
        const Quat w(0, velocity.x(), velocity.y(), velocity.z());
        put(Eigen::Matrix<double, 4, 1>(0.5 * (quaternion_at(numbers) * w).coeffs()), rates);
        return;
    }
    const Mat3 m = matrix_at(numbers);
    Mat3 change;
    change << m.col(1) * velocity.z() - m.col(2) * velocity.y(),
        m.col(2) * velocity.x() - m.col(0) * velocity.z(),
        m.col(0) * velocity.y() - m.col(1) * velocity.x();
    put(change, rates);
}

void repair(Rotation rotation, double* numbers)
{
    if (rotation == Rotation::quaternion_euler)
        put(unit(quaternion_at(numbers)).coeffs(), numbers);
    else if (rotation == Rotation::matrix_euler_repaired)
        put(nearest_rotation(matrix_at(numbers)), numbers);
}

Vec3 rate_of_turn(const Vec3& turn, const Vec3& velocity)
{
    const Vec3 across = turn.cross(velocity);
    return velocity + 0.5 * across + turn.cross(across) / 12;
}

}  // namespace throng
