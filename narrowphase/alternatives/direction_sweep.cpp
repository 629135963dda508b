#include "narrowphase/alternatives/direction_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace throng {
namespace {

struct Tried {
    double separation;
    Vec3 direction;
};

// Numbers in [-1, 1) that are the same on every run.
class Dice {
public:
    double roll()
    {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) / 4503599627370496.0 - 1;
    }

private:
    std::uint64_t state_ = 88172645463325252u;
};

using Separation = std::function<double(const Vec3&)>;

// The best place along one line of directions, by golden section. `direction` is not of unit
// length: it lies in the plane that touches the sphere of directions where the search began, in
// which the ridges of a polyhedron's separation are straight.
Tried search_line(const Tried& from, const Vec3& along, double step, const Separation& separation)
{
    constexpr double kGolden = 0.6180339887498949;
    const auto at = [&](double t) {
        const Vec3 direction = from.direction + t * along;
        return Tried{separation(direction.normalized()), direction};
    };
    double low = -step, high = step;
    double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    Tried at_left = at(left), at_right = at(right);
    for (int i = 0; i < 75; ++i) {
        if (at_left.separation > at_right.separation) {
            high = right;
            right = left;
            at_right = at_left;
            left = high - kGolden * (high - low);
            at_left = at(left);
        } else {
            low = left;
            left = right;
            at_left = at_right;
            right = low + kGolden * (high - low);
            at_right = at(right);
        }
    }
    return at_left.separation > at_right.separation ? at_left : at_right;
}

// Climbs: to a ridge, to the same ridge from a place beside it, then along the line through both;
// from further away after a success and nearer after a failure.
Tried refine(Tried best, double step, const Separation& separation)
{
    Dice dice;
    const Vec3 center = best.direction;
    const auto tangent = [&] {
        const Vec3 any(dice.roll(), dice.roll(), dice.roll());
        return Vec3(any - center * any.dot(center));
    };
    for (int i = 0; i < 60 && step > 1e-14; ++i) {
        const double before = best.separation;
        const auto keep = [&](const Tried& found) {
            if (found.separation > best.separation) best = found;
        };
        keep(search_line(best, tangent(), step, separation));
        const Tried beside{0, best.direction + step * tangent()};
        const Tried found = search_line(beside, tangent(), 2 * step, separation);
        const Vec3 ridge = found.direction - best.direction;
        keep(found);
        keep(search_line(best, ridge, 4, separation));
        step *= best.separation > before ? 1.2 : 0.4;
    }
    best.direction.normalize();
    return best;
}

}  // namespace

double sweep_directions(const Extent& a, const Extent& b, int grid, Vec3* normal)
{
    const auto separation = [&](const Vec3& direction) { return -b(-direction) - a(direction); };
    std::vector<Tried> tried;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < grid * grid * 2; ++i) {
            Vec3 direction;
            direction[axis] = i % 2 ? 1 : -1;
            direction[(axis + 1) % 3] = (2.0 * (i / 2 % grid) + 1) / grid - 1;
            direction[(axis + 2) % 3] = (2.0 * (i / 2 / grid) + 1) / grid - 1;
            direction.normalize();
            tried.push_back({separation(direction), direction});
        }
    }
    // There may be many hills: climb from the best few places.
    const std::size_t starts = std::min<std::size_t>(12, tried.size());
    std::partial_sort(tried.begin(), tried.begin() + static_cast<std::ptrdiff_t>(starts),
                      tried.end(),
                      [](const Tried& x, const Tried& y) { return x.separation > y.separation; });
    Tried best = tried[0];
    for (std::size_t i = 0; i < starts; ++i) {
        const Tried found = refine(tried[i], 2.0 / grid, separation);
        if (found.separation > best.separation) best = found;
    }
    if (normal) *normal = best.direction;
    return best.separation;
}

}  // namespace throng
