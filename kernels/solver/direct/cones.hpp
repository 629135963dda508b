// Cones: the algebra of the second-order cone, in which friction is exact.
//
// A vector of up to six numbers, the first its height and the rest its width, lies in the cone when
// the height is at least the length of the rest. Of one number alone the cone is the half line.
//
// Source: Alizadeh and Goldfarb, Second-order cone programming (2003); scaling after Nesterov and
//         Todd (1997).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace throng {

/// Greatest number of rows of a cone: a normal, two of sliding and three of turning.
inline constexpr std::size_t kConeRows = 6;

/// Rows of a cone; those beyond its own are 0, and stay so through all that follows.
using ConeVector = std::array<double, kConeRows>;

inline double dot(const ConeVector& a, const ConeVector& b)
{
    double sum = 0;
    for (std::size_t k = 0; k < kConeRows; ++k) sum += a[k] * b[k];
    return sum;
}

/// Length of all but the first.
inline double width(const ConeVector& a)
{
    double sum = 0;
    for (std::size_t k = 1; k < kConeRows; ++k) sum += a[k] * a[k];
    return std::sqrt(sum);
}

/// a + b * scale.
inline ConeVector sum(const ConeVector& a, const ConeVector& b, double scale = 1)
{
    ConeVector c;
    for (std::size_t k = 0; k < kConeRows; ++k) c[k] = a[k] + b[k] * scale;
    return c;
}

/// Height squared less width squared: above 0 inside. In two factors, as near the boundary the
/// squares would cancel.
inline double inside(const ConeVector& a)
{
    const double w = width(a);
    return (a[0] - w) * (a[0] + w);
}

/// The product under which the cone is the set of squares.
inline ConeVector product(const ConeVector& a, const ConeVector& b)
{
    ConeVector c;
    c[0] = dot(a, b);
    for (std::size_t k = 1; k < kConeRows; ++k) c[k] = a[0] * b[k] + b[0] * a[k];
    return c;
}

/// What times `a` (inside the cone) is `b`.
inline ConeVector quotient(const ConeVector& b, const ConeVector& a)
{
    double along = 0;
    for (std::size_t k = 1; k < kConeRows; ++k) along += a[k] * b[k];
    ConeVector c;
    c[0] = (a[0] * b[0] - along) / inside(a);
    for (std::size_t k = 1; k < kConeRows; ++k) c[k] = (b[k] - c[0] * a[k]) / a[0];
    return c;
}

/// How far one may go from a point inside along a step without leaving the cone, at most 1.
inline double longest_step(const ConeVector& from, const ConeVector& step)
{
    const double level = step[0] < 0 ? -from[0] / step[0] : 1;
    if (width(from) + width(step) == 0) return std::min(level, 1.0);
    // Along the way, height squared less width squared is c + 2 b t + a t^2; its least root above 0
    // is where the cone is left.
    const double a = (step[0] - width(step)) * (step[0] + width(step));
    double b = from[0] * step[0];
    for (std::size_t k = 1; k < kConeRows; ++k) b -= from[k] * step[k];
    const double c = inside(from);
    double root = 2;
    const double below = b * b - a * c;
    if (below >= 0) {
        // 1/t solves c s^2 + 2 b s + a = 0; of its roots the greatest above 0 is the least t.
        const double s = (-b + std::sqrt(below)) / c;
        if (s > 0) root = 1 / s;
    }
    return std::min({root, level, 1.0});
}

/// The nearest point of the cone.
inline ConeVector projected(const ConeVector& a)
{
    const double w = width(a);
    if (w <= a[0]) return a;
    if (w <= -a[0]) return {};
    const double half = (a[0] + w) / 2;
    ConeVector c;
    c[0] = half;
    for (std::size_t k = 1; k < kConeRows; ++k) c[k] = a[k] * (half / w);
    return c;
}

/// The symmetric map that takes an impulse and undoes a speed to one and the same point:
/// map(impulse) = inverse(speed). Both lie inside the cone.
struct ConeScaling {
    double size = 1;
    ConeVector axis{1};  // height squared less width squared is 1

    ConeScaling() = default;
    ConeScaling(const ConeVector& speed, const ConeVector& impulse)
    {
        const double of_speed = std::sqrt(inside(speed)), of_impulse = std::sqrt(inside(impulse));
        const double cosine = dot(speed, impulse) / (of_speed * of_impulse);
        const double scale = 1 / std::sqrt(2 * (1 + cosine));
        axis[0] = (speed[0] / of_speed + impulse[0] / of_impulse) * scale;
        for (std::size_t k = 1; k < kConeRows; ++k)
            axis[k] = (speed[k] / of_speed - impulse[k] / of_impulse) * scale;
        size = std::sqrt(of_speed / of_impulse);
    }
    ConeVector map(const ConeVector& a) const { return reflected(a, 1, size); }
    ConeVector inverse(const ConeVector& a) const { return reflected(a, -1, 1 / size); }

    /// A row of the inverse of the map, squared.
    ConeVector inverse_squared(std::size_t row, std::size_t rows) const
    {
        const double scale = 1 / (size * size);
        const auto side = [&](std::size_t k) { return k == 0 ? axis[0] : -axis[k]; };
        ConeVector c{};
        for (std::size_t k = 0; k < rows; ++k) c[k] = 2 * side(row) * side(k) * scale;
        c[row] += row == 0 ? -scale : scale;
        return c;
    }

private:
    // Times 2 v v' - J, with v halfway between the axis and the height, or with its width reversed.
    ConeVector reflected(const ConeVector& a, double sense, double scale) const
    {
        double along = 0;
        for (std::size_t k = 1; k < kConeRows; ++k) along += axis[k] * a[k];
        along *= sense;
        ConeVector c;
        c[0] = (axis[0] * a[0] + along) * scale;
        const double share = a[0] + along / (1 + axis[0]);
        for (std::size_t k = 1; k < kConeRows; ++k) c[k] = (a[k] + sense * axis[k] * share) * scale;
        return c;
    }
};

}  // namespace throng
