#include "cooking/sphere_trees/sphere_error.hpp"

#include "kernels/data/bounds.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// A cell is halved no more often than this.
constexpr int kRounds = 40;

using Ids = std::vector<std::uint32_t>;

// What is known of the worst place: a value that was met, and what none is above. `sure` was met
// as well and is exact but for rounding, where others only hold a distance from above.
struct Worst {
    double met = 0, sure = 0, bound = 0;
    double slack = 0;

    void add(double exact)
    {
        met = std::max(met, exact);
        sure = std::max(sure, exact);
    }

    // Whether values to `most` may be left at that; if so the bound knows of them.
    bool settles(double most)
    {
        if (most > std::max(bound, met * (1 + slack))) return false;
        bound = std::max(bound, most);
        return true;
    }
};

// The balls that have to do with a cell, in one array for all cells of a round.
struct Near {
    std::size_t begin = 0, end = 0;
};

double
least_separation(std::span<const Ball> balls, std::span<const std::uint32_t> ids, const Vec3& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : ids) least = std::min(least, distance_to(balls[i], point));
    return least;
}

// Keeps those of the balls that are within `limit` of the point.
Near keep_near(std::span<const Ball> balls,
               std::span<const std::uint32_t> ids,
               const Vec3& point,
               double limit,
               Ids& kept)
{
    const std::size_t begin = kept.size();
    for (const std::uint32_t i : ids)
        if (distance_to(balls[i], point) <= limit) kept.push_back(i);
    return {begin, kept.size()};
}

// How far along a ray the balls are left, at most; each of them is left but once.
double exit_along(std::span<const Ball> balls,
                  std::span<const std::uint32_t> ids,
                  const Vec3& from,
                  const Vec3& along)
{
    double at = 0;
    for (std::size_t round = 0; round <= ids.size(); ++round) {
        double further = at;
        for (const std::uint32_t i : ids) {
            const Vec3 offset = balls[i].center - from;
            const double middle = offset.dot(along);
            const double half2 = balls[i].radius * balls[i].radius
                - std::max(0.0, offset.squaredNorm() - middle * middle);
            if (half2 <= 0) continue;
            const double half = std::sqrt(half2);
            if (middle - half <= at) further = std::max(further, middle + half);
        }
        if (further <= at) break;
        at = further;
    }
    return at;
}

// A way out found by pushing the point out of the ball it is deepest in, over and over: between the
// walls of a valley, where straight ways run on inside the balls of the next wall.
Vec3 exit_by_pushing(std::span<const Ball> balls,
                     std::span<const std::uint32_t> ids,
                     const Vec3& from,
                     const Vec3& otherwise)
{
    Vec3 at = from;
    for (int round = 0; round < 64; ++round) {
        const Ball* deepest = nullptr;
        double least = 0;
        for (const std::uint32_t i : ids)
            if (const double here = distance_to(balls[i], at); here < least) {
                least = here;
                deepest = &balls[i];
            }
        if (deepest == nullptr) {
            const Vec3 way = at - from;
            return way.squaredNorm() < otherwise.squaredNorm() ? way : otherwise;
        }
        const Vec3 away = at - deepest->center;
        const double length = away.norm();
        if (!(length > 0)) return otherwise;
        at = deepest->center + away * (deepest->radius * (1 + 1e-6) / length);
    }
    return otherwise;
}

class Measure {
public:
    Measure(const Mesh& mesh,
            std::span<const Ball> balls,
            double slack,
            std::size_t looks,
            double enough)
        : mesh_(mesh), balls_(balls), looks_(looks), enough_(enough)
    {
        worst_.slack = slack;
        for (std::uint32_t i = 0; i < balls.size(); ++i) all_.push_back(i);
    }

    double answer()
    {
        // Beyond the mesh no ball goes further than where it is deepest in it allows.
        for (const Ball& ball : balls_)
            out_ = std::max(out_, ball.radius + signed_distance(mesh_, ball.center));
        worst_.met = out_;
        worst_.bound = out_;
        look_at_surface();
        look_inside();
        return is_enough() ? std::max(worst_.bound, worst_.sure) : worst_.bound;
    }

private:
    struct Patch {
        std::array<Vec3, 3> corners;
        std::uint32_t triangle;
        Near near;
    };
    struct Cell {
        Vec3 middle;
        double half;
        Near near;
        double within = std::numeric_limits<double>::infinity();  // so near to middle is the mesh
    };

    // What a look at a cell has told.
    struct Look {
        double most = -1;
        Near near;
        double distance = 0;  // of the middle from the mesh
    };

    // Whether the answer cannot be less than that.
    bool is_enough() const
    {
        constexpr double kSlack = 1 - 1e-9;
        return std::max(worst_.bound, worst_.sure * kSlack) >= enough_;
    }

    // Those that may hold the worst place, split; or, where that would take too many looks, none.
    template <class Part>
    void split_on(std::vector<Part>& open, const std::vector<Look>& found, std::vector<Part>& next)
    {
        next.clear();
        for (std::size_t i = 0; i < open.size(); ++i)
            if (!worst_.settles(found[i].most)) split(open[i], found[i], next);
        spent_ += next.size();
        if (spent_ > looks_ || ++rounds_ > kRounds) {
            for (const Look& look : found) worst_.bound = std::max(worst_.bound, look.most);
            next.clear();
        }
        open.swap(next);
    }

    // How far a point of the surface that the balls hold is from theirs, at most, along its normal
    // or by pushing.
    Vec3 way_out(const Patch& patch, const Vec3& at, std::span<const std::uint32_t> ids) const
    {
        const Vec3& normal = mesh_.normals[patch.triangle];
        Vec3 way = normal * exit_along(balls_, ids, at, normal);
        if (way.norm() > 1.01 * out_) way = exit_by_pushing(balls_, ids, at, way);
        // The ids are of balls within twice `out_`: what is further out was not looked at.
        if (!(way.norm() > 2 * out_)) return way;
        way = normal * exit_along(balls_, all_, at, normal);
        if (way.norm() > 2 * out_) way = exit_by_pushing(balls_, all_, at, way);
        for (int i = 0; i < 27 && way.norm() > 2 * out_; ++i) {
            if (i == 13) continue;
            const Vec3 along = Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1).normalized();
            const double far = exit_along(balls_, all_, at, along);
            if (far < way.norm()) way = along * far;
        }
        return way;
    }

    // So far along the patch's normal every place of it has left the balls: none that reaches over
    // the patch by then is higher. Infinite where that is more than the ids tell of.
    double
    height_over(const Patch& patch, const Vec3& middle, std::span<const std::uint32_t> ids) const
    {
        const Vec3& normal = mesh_.normals[patch.triangle];
        double radius = 0, height = 0, last = -1;
        for (const Vec3& corner : patch.corners)
            radius = std::max(radius, (corner - middle).norm());
        while (height > last && height <= 2 * out_) {
            last = height;
            for (const std::uint32_t i : ids) {
                if (distance_to(balls_[i], middle) > radius + last) continue;
                height =
                    std::max(height, (balls_[i].center - middle).dot(normal) + balls_[i].radius);
            }
        }
        return height <= 2 * out_ ? height : std::numeric_limits<double>::infinity();
    }

    // No point of the patch is further from the balls' surface than this. Of the distance from one
    // ball, or from a place outside of all, a corner has most.
    double most_of(const Patch& patch,
                   const Vec3& middle,
                   double outside,
                   std::span<const std::uint32_t> ids)
    {
        const auto& corners = patch.corners;
        const auto furthest = [&](const Vec3& from) {
            return std::max({(corners[0] - from).norm(), (corners[1] - from).norm(),
                             (corners[2] - from).norm()});
        };
        double most = outside + furthest(middle);
        for (const std::uint32_t i : ids)
            most = std::min(most, furthest(balls_[i].center) - balls_[i].radius);
        const Vec3 way = outside < 0 ? way_out(patch, middle, ids) : Vec3(Vec3::Zero());
        worst_.add(outside);
        worst_.met = std::max(worst_.met, way.norm());
        const double least = std::min(furthest(middle + way), height_over(patch, middle, ids));
        return std::max(most, least);
    }

    void look_at_surface()
    {
        std::vector<Patch> open, next;
        Ids ids = all_, kept;
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            const auto& [a, b, c] = mesh_.triangles[t];
            open.push_back(
                {{mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]}, t, {0, all_.size()}});
        }
        while (!open.empty() && !is_enough()) {
            std::vector<Look> found;
            kept.clear();
            for (const Patch& patch : open) {
                const Vec3 middle = (patch.corners[0] + patch.corners[1] + patch.corners[2]) / 3;
                double radius = 0;
                for (const Vec3& corner : patch.corners)
                    radius = std::max(radius, (corner - middle).norm());
                const auto of = of_cell(ids, patch.near);
                const double outside = least_separation(balls_, of, middle);
                const double limit = std::max(outside, 2 * out_) + 2 * radius;
                const Near near = keep_near(balls_, of, middle, limit, kept);
                found.push_back({most_of(patch, middle, outside, of_cell(kept, near)), near, 0});
            }
            split_on(open, found, next);
            ids.swap(kept);
        }
    }

    static void split(const Patch& patch, const Look& look, std::vector<Patch>& into)
    {
        const Near near = look.near;
        const auto& [a, b, c] = patch.corners;
        const Vec3 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
        into.push_back({{a, ab, ca}, patch.triangle, near});
        into.push_back({{ab, b, bc}, patch.triangle, near});
        into.push_back({{ca, bc, c}, patch.triangle, near});
        into.push_back({{ab, bc, ca}, patch.triangle, near});
    }

    // Places inside the mesh that no ball holds.
    void look_inside()
    {
        Box3 box;
        for (const Vec3& vertex : mesh_.vertices) {
            box.lower = box.lower.cwiseMin(vertex);
            box.upper = box.upper.cwiseMax(vertex);
        }
        std::vector<Cell> open = {{(box.lower + box.upper) / 2,
                                   (box.upper - box.lower).maxCoeff() / 2,
                                   {0, all_.size()}}};
        std::vector<Cell> next;
        Ids ids = all_, kept;
        spent_ = 0;
        rounds_ = 0;
        while (!open.empty() && !is_enough()) {
            std::vector<Look> found;
            kept.clear();
            for (const Cell& cell : open) {
                const double radius = cell.half * 1.7320508075688774;
                const auto of = of_cell(ids, cell.near);
                const double outside = least_separation(balls_, of, cell.middle);
                found.emplace_back();
                if (outside < -radius) continue;
                const double furthest = furthest_separation(cell, of);
                if (furthest < 0) continue;
                const MeshPoint nearest = nearest_on_mesh(mesh_, cell.middle, cell.within);
                const double side = signed_distance(mesh_, cell.middle, nearest);
                if (side > radius) continue;
                if (outside >= 0 && side <= 0) worst_.add(std::max(outside, -side));
                const double deepest = far_corner(cell, nearest.point);
                found.back() = {std::max(std::min(furthest, outside + radius), deepest),
                                keep_near(balls_, of, cell.middle, outside + 2 * radius, kept),
                                nearest.distance};
            }
            split_on(open, found, next);
            ids.swap(kept);
        }
    }

    // How far the furthest point of a cell is from another.
    static double far_corner(const Cell& cell, const Vec3& from)
    {
        return ((cell.middle - from).cwiseAbs() + Vec3::Constant(cell.half)).norm();
    }

    // The same from the ball that it is least for.
    double furthest_separation(const Cell& cell, std::span<const std::uint32_t> ids) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t i : ids)
            least = std::min(least, far_corner(cell, balls_[i].center) - balls_[i].radius);
        return least;
    }

    static void split(const Cell& cell, const Look& look, std::vector<Cell>& into)
    {
        const double half = cell.half / 2;
        // And a bit more than rounding takes.
        const double within = look.distance + 1.75 * half;
        for (int i = 0; i < 8; ++i) {
            const Vec3 side((i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half,
                            (i & 4) != 0 ? half : -half);
            into.push_back({cell.middle + side, half, look.near, within});
        }
    }

    static std::span<const std::uint32_t> of_cell(const Ids& ids, Near near)
    {
        return {ids.data() + near.begin, near.end - near.begin};
    }

    const Mesh& mesh_;
    std::span<const Ball> balls_;
    std::size_t looks_, spent_ = 0;
    double enough_;
    int rounds_ = 0;
    Ids all_;
    Worst worst_;
    double out_ = 0;
};

}  // namespace

double distance_to_balls(std::span<const Ball> balls, const Vec3& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Ball& ball : balls) least = std::min(least, distance_to(ball, point));
    return least;
}

double sphere_error(
    const Mesh& mesh, std::span<const Ball> balls, double slack, std::size_t looks, double enough)
{
    if (mesh.tree.empty() || balls.empty()) return std::numeric_limits<double>::infinity();
    return Measure(mesh, balls, slack, looks, enough).answer();
}

}  // namespace throng
