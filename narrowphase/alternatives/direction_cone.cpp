#include "narrowphase/alternatives/direction_cone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {
namespace {

// Sine of an angle that is nothing but rounding, some fifty times double's spacing.
constexpr double kFlat = 1e-14;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

bool DirectionCone::add(const Vec3& difference)
{
    if (count_ == kCapacity) return true;
    differences_[at(count_++)] = difference;
    if (count_ == 1) return true;
    return sides_count_ == 0 ? open(difference) : cut(difference);
}

// Two half-spaces leave a slice of the sphere, from pole to pole; the corners between the poles are
// there so that no side is as long as half a circle.
bool DirectionCone::open(const Vec3& difference)
{
    const Vec3& first = differences_[0];
    Vec3 pole = first.cross(difference);
    const double sine = std::sqrt(pole.squaredNorm());
    if (!(sine > kFlat)) return first.dot(difference) > 0;
    pole /= sine;
    // A slice may be a billionth wide, and the product is only as good as the sine is large.
    pole -= difference * pole.dot(difference);
    pole /= std::sqrt(pole.squaredNorm());
    Vec3 on_last = pole.cross(difference), on_first = pole.cross(first);
    if (on_last.dot(first) < 0) on_last = -on_last;
    if (on_first.dot(difference) < 0) on_first = -on_first;
    const int last = count_ - 1;
    corners_[0] = pole;
    corners_[1] = on_last;
    corners_[2] = -pole;
    corners_[3] = on_first;
    sides_[0] = sides_[1] = last;
    sides_[2] = sides_[3] = 0;
    sides_count_ = 4;
    return true;
}

bool DirectionCone::cut(const Vec3& difference)
{
    std::array<double, kCorners> inside;
    double most = -1, least = 1;
    for (int i = 0; i < sides_count_; ++i) {
        inside[at(i)] = difference.dot(corners_[at(i)]);
        most = std::max(most, inside[at(i)]);
        least = std::min(least, inside[at(i)]);
    }
    if (!(most > kFlat)) return false;
    if (least > kFlat) return true;

    std::array<Vec3, kCorners> corners;
    std::array<int, kCorners> sides;
    const int count = sides_count_;
    std::copy_n(corners_.begin(), count, corners.begin());
    std::copy_n(sides_.begin(), count, sides.begin());
    sides_count_ = 0;
    const auto put = [&](const Vec3& corner, int side) {
        if (sides_count_ == kCorners) return;
        corners_[at(sides_count_)] = corner;
        sides_[at(sides_count_++)] = side;
    };
    // On the plane of the cut, between a corner inside and one that is not.
    const auto crossing = [&](int from, int to) -> Vec3 {
        const Vec3 mix = corners[at(from)] * std::abs(inside[at(to)])
            + corners[at(to)] * std::abs(inside[at(from)]);
        return mix / std::sqrt(mix.squaredNorm());
    };
    int leaves = 0;
    for (int i = 0; i < count; ++i) {
        const int next = i + 1 == count ? 0 : i + 1;
        const bool here = inside[at(i)] > kFlat, there = inside[at(next)] > kFlat;
        if (here) put(corners[at(i)], sides[at(i)]);
        if (here == there) continue;
        if (here) leaves = sides_count_;
        put(crossing(i, next), here ? count_ - 1 : sides[at(i)]);
    }
    // Differences in one plane leave a slice: the new side then goes from pole to pole as well.
    const int enters = leaves + 1 == sides_count_ ? 0 : leaves + 1;
    const Vec3 across = corners_[at(leaves)] - corners_[at(enters)];
    if (across.squaredNorm() > 2 && sides_count_ < kCorners) {
        insert(leaves + 1, count_ - 1, across.cross(difference).normalized());
    }
    return true;
}

// One of two opposite corners: that which the differences so far leave.
void DirectionCone::insert(int index, int side, const Vec3& corner)
{
    double least = 0, most = 0;
    for (int i = 0; i < count_; ++i) {
        const double along = corner.dot(differences_[at(i)]);
        least = std::min(least, along);
        most = std::max(most, along);
    }
    const auto shift = [&](auto& items) {
        const auto from = items.begin() + index, to = items.begin() + sides_count_;
        std::copy_backward(from, to, to + 1);
    };
    shift(corners_);
    shift(sides_);
    corners_[at(index)] = most < -least ? Vec3(-corner) : corner;
    sides_[at(index)] = side;
    ++sides_count_;
}

bool DirectionCone::holds(const Vec3& direction) const
{
    for (int i = count_; i-- > 0;) {
        if (!(direction.dot(differences_[at(i)]) > 0)) return false;
    }
    return true;
}

Vec3 DirectionCone::middle() const
{
    if (sides_count_ == 0) return differences_[0];
    // Corners crowd where many differences agree; sides weigh by their length.
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < sides_count_; ++i) {
        const Vec3& from = corners_[at(i)];
        const Vec3& to = corners_[at(i + 1 == sides_count_ ? 0 : i + 1)];
        sum += (from + to) * std::sqrt((to - from).squaredNorm());
    }
    const double length = std::sqrt(sum.squaredNorm());
    return length > 0 ? Vec3(sum / length) : corners_[0];
}

// The last difference is against all directions that were left: it lies opposite a mix of those
// that bound them, and three of these are enough.
DirectionCone::Witness DirectionCone::witness() const
{
    const int last = count_ - 1;
    if (sides_count_ == 0) return {{0, last}, 2};
    std::array<int, kCorners> bounds;
    int bound_count = 0;
    for (int i = 0; i < sides_count_; ++i) {
        const int side = sides_[at(i)];
        const bool again = bound_count > 0
            && (bounds[at(bound_count - 1)] == side
                || (i + 1 == sides_count_ && bounds[0] == side));
        if (!again) bounds[at(bound_count++)] = side;
    }
    if (bound_count < 3) return {{bounds[0], bounds[1], last}, bound_count + 1};

    const Vec3 against = -differences_[at(last)];
    Witness best;
    double most = -std::numeric_limits<double>::infinity();
    const Vec3& a = differences_[at(bounds[0])];
    for (int i = 1; i + 1 < bound_count; ++i) {
        const Vec3& b = differences_[at(bounds[at(i)])];
        const Vec3& c = differences_[at(bounds[at(i + 1)])];
        const double volume = a.dot(b.cross(c));
        const double sign = volume < 0 ? -1 : 1;
        const double least = sign
            * std::min({against.dot(b.cross(c)), against.dot(c.cross(a)), against.dot(a.cross(b))});
        if (least > most) {
            most = least;
            best = {{bounds[0], bounds[at(i)], bounds[at(i + 1)], last}, 4};
        }
    }
    return best;
}

}  // namespace throng
