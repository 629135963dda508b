#include "scene/catalog/threads.hpp"

#include "kernels/check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace throng {
namespace {

constexpr double kPi = std::numbers::pi;

// Parts of the pitch at which the profile bends: crest, root, root, crest.
constexpr double kBends[] = {1.0 / 16, 6.0 / 16, 10.0 / 16, 15.0 / 16};
constexpr int kRows = 4;  // as many a pitch
constexpr double kFlank = kBends[1] - kBends[0];

// How far below the crest the profile is, of its depth, at a part of the pitch.
double sunk_at(double part)
{
    const double from_root = std::abs(part - std::floor(part) - 0.5);
    return std::clamp((kBends[3] - 0.5 - from_root) / kFlank, 0.0, 1.0);
}

/// Rings of vertices about z, all with the same columns, joined from one to the next.
class Lathe {
public:
    explicit Lathe(std::uint32_t around) : around_(around) { }

    using Ring = std::uint32_t;                            // place of its first vertex
    using Radius = std::function<double(double, double)>;  // of the part of a turn and z

    Ring add_ring(double z, const Radius& radius)
    {
        const auto first = static_cast<Ring>(mesh_.vertices.size());
        for (std::uint32_t i = 0; i < around_; ++i) add(i, z, radius);
        return first;
    }

    /// Six corners; `apothem` is from the axis to the middle of a side.
    Ring add_hexagon(double z, double apothem)
    {
        return add_ring(z, [&](double turn, double) {
            const double from_middle = (6 * turn - std::floor(6 * turn + 1e-9) - 0.5) / 6;
            return apothem / std::cos(2 * kPi * from_middle);
        });
    }

    /// Outward is to the right of the way from a to b, seen with the axis on the left.
    void join(Ring a, Ring b)
    {
        for (std::uint32_t i = 0; i < around_; ++i) {
            const std::uint32_t next = (i + 1) % around_;
            quad(a + i, a + next, b + next, b + i);
        }
    }

    /// A flat disc; the surface comes from or goes to its middle.
    void close(Ring ring, bool below)
    {
        const double z = mesh_.vertices[ring].z();
        const auto middle = static_cast<std::uint32_t>(mesh_.vertices.size());
        mesh_.vertices.emplace_back(0, 0, z);
        for (std::uint32_t i = 0; i < around_; ++i) {
            const std::uint32_t a = ring + i, b = ring + (i + 1) % around_;
            mesh_.triangles.push_back(below ? Triangle{middle, b, a} : Triangle{middle, a, b});
        }
    }

    /// Joins two rings by a surface whose rows follow the thread, so that its edges are the
    /// thread's. Rows that lie beyond a ring fall together with it.
    void join_threaded(Ring low, Ring high, double pitch, const Radius& radius, bool outward)
    {
        const double bottom = mesh_.vertices[low].z(), top = mesh_.vertices[high].z();
        const int first = kRows * (static_cast<int>(std::floor(bottom / pitch)) - 2);
        const int last = kRows * (static_cast<int>(std::ceil(top / pitch)) + 1);
        std::vector<std::vector<std::uint32_t>> columns(around_);
        for (std::uint32_t i = 0; i < around_; ++i)
            for (int row = first; row <= last; ++row) {
                const double z = pitch * (row_height(row) + static_cast<double>(i) / around_);
                const double snap = 1e-6 * pitch;  // far above rounding, far below a flank
                columns[i].push_back(z <= bottom + snap    ? low + i
                                         : z >= top - snap ? high + i
                                                           : add(i, z, radius));
            }
        for (std::uint32_t i = 0; i < around_; ++i)
            for (int row = 0; row < last - first; ++row) {
                // Once round, the rows have risen by a pitch.
                const auto vertex = [&](std::uint32_t column, int at) {
                    at += column == around_ ? kRows : 0;
                    return columns[column % around_]
                                  [static_cast<std::size_t>(std::min(at, last - first))];
                };
                if (outward)
                    quad(vertex(i, row), vertex(i + 1, row), vertex(i + 1, row + 1),
                         vertex(i, row + 1));
                else
                    quad(vertex(i + 1, row), vertex(i, row), vertex(i, row + 1),
                         vertex(i + 1, row + 1));
            }
    }

    TriangleSoup take() { return std::move(mesh_); }

private:
    using Triangle = std::array<std::uint32_t, 3>;

    static double row_height(int row)
    {
        const int turn = static_cast<int>(std::floor(static_cast<double>(row) / kRows));
        return turn + kBends[row - turn * kRows];
    }

    std::uint32_t add(std::uint32_t column, double z, const Radius& radius)
    {
        const double turn = static_cast<double>(column) / around_;
        const double r = radius(turn, z);
        mesh_.vertices.emplace_back(r * std::cos(2 * kPi * turn), r * std::sin(2 * kPi * turn), z);
        return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
    }

    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)
    {
        for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, d}})
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh_.triangles.push_back(t);
    }

    std::uint32_t around_;
    TriangleSoup mesh_;
};

double thread_depth(const Thread& thread) { return thread.radius - thread.root_radius(); }

double bolt_radius(const Thread& thread, double turn, double z)
{
    return thread.radius - thread_depth(thread) * sunk_at(z / thread.pitch - turn);
}

// An end is cut at 45 degrees, from this much beyond the root of a bolt or the crest of a nut: the
// last row of triangles, which does not follow the thread, is then out of the other's reach.
double end_cut(const Thread& thread) { return thread.pitch / 8; }

void check([[maybe_unused]] const Thread& thread, [[maybe_unused]] std::uint32_t around)
{
    THRONG_CHECK(around >= 6 && around % 6 == 0, "a hexagon needs a multiple of 6 columns");
    THRONG_CHECK(thread.root_radius() > 2 * end_cut(thread), "a thread needs a core");
}

}  // namespace

double Thread::root_radius() const { return radius - pitch * kFlank * std::numbers::sqrt3; }

double Thread::section() const
{
    const double a = radius, b = root_radius();
    return kPi * (a * a / 8 + b * b / 4 + (a * a + a * b + b * b) / 3 * (2 * kFlank));
}

double Thread::nut_offset() const
{
    // A flank leans by its slope along z and by that of the helix, steepest at the root.
    const double lead = pitch / (2 * kPi * root_radius());
    return clearance * std::sqrt(1 + 3 * (1 + lead * lead));
}

double wrench_radius(const Thread& thread) { return 1.6 * thread.radius; }
double head_height(const Thread& thread) { return 1.3 * thread.radius; }

TriangleSoup bolt_mesh(const Thread& thread, double shaft, std::uint32_t around)
{
    check(thread, around);
    const auto radius = [&](double turn, double z) {
        const double taper = thread.root_radius() - end_cut(thread) + (z + shaft);
        return std::min(bolt_radius(thread, turn, z), taper);
    };
    Lathe lathe(around);
    const Lathe::Ring tip = lathe.add_ring(-shaft, radius), neck = lathe.add_ring(0, radius);
    const Lathe::Ring low = lathe.add_hexagon(0, wrench_radius(thread));
    const Lathe::Ring high = lathe.add_hexagon(head_height(thread), wrench_radius(thread));
    lathe.close(tip, true);
    lathe.join_threaded(tip, neck, thread.pitch, radius, true);
    lathe.join(neck, low);
    lathe.join(low, high);
    lathe.close(high, false);
    return lathe.take();
}

TriangleSoup nut_mesh(const Thread& thread, double height, std::uint32_t around)
{
    check(thread, around);
    const double crest = thread.radius + thread.nut_offset();
    const auto radius = [&](double turn, double z) {
        const double to_end = std::min(z, height - z);
        const double threaded = bolt_radius(thread, turn, z) + thread.nut_offset();
        return std::max(threaded, crest + end_cut(thread) - to_end) / std::cos(kPi / around);
    };
    Lathe lathe(around);
    const Lathe::Ring low = lathe.add_hexagon(0, wrench_radius(thread));
    const Lathe::Ring high = lathe.add_hexagon(height, wrench_radius(thread));
    const Lathe::Ring top = lathe.add_ring(height, radius), bottom = lathe.add_ring(0, radius);
    lathe.join(low, high);
    lathe.join(high, top);
    lathe.join_threaded(bottom, top, thread.pitch, radius, false);
    lathe.join(bottom, low);
    return lathe.take();
}

}  // namespace throng
