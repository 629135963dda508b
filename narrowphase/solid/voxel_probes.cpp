#include "narrowphase/solid/voxel_probes.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/polytope.hpp"
#include "narrowphase/solid/surface_walk.hpp"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

// Around a rim: enough that a small cylinder does not fall through, and no more than these.
constexpr std::size_t kLeastRim = 16, kMostRim = 256;
// Along an edge or an axis. Those of more voxels than this are probed less closely.
constexpr double kMostParts = 4096;
// Of a cell, in voxels.
constexpr double kDiagonal = 1.7321;

struct Probe {
    Vec3 place = Vec3::Zero();   // in the other's frame
    double radius = 0;           // of a ball about it
    Vec3 normal = Vec3::Zero();  // outward; 0 where every push will do
    double cone = -1;            // as in SurfacePoints
    std::uint32_t feature = 0;
};

class Prober {
public:
    Prober(const Solid& a,
           const Pose& pose,
           double speculative_margin,
           std::vector<ContactCandidate>& out)
        : bricks_(a.field), furthest_(a.field.band - kDiagonal * a.field.voxel),
          box_(FieldSide(a).box()), turn_(pose.orientation.toRotationMatrix()),
          position_(pose.position), speculative_margin_(speculative_margin), out_(out)
    { }

    double voxel() const { return bricks_.voxel; }

    void probe(const Probe& probe) const
    {
        const Vec3 place = turn_ * probe.place + position_;
        const double wide = speculative_margin_ + probe.radius;
        if (((place - box_.upper).array() > wide).any()
            || ((box_.lower - place).array() > wide).any())
            return;
        const FieldSample<double> here = sample_bricks<double>(bricks_, place);
        const double separation = here.distance - probe.radius;
        if (!(separation <= speculative_margin_) || !(here.distance < furthest_)) return;
        const Vec3 own = turn_ * probe.normal;
        const double steep = here.gradient.norm();
        Vec3 normal = here.gradient;
        if (steep >= kNoGradient) {
            normal /= steep;
            if (!(-own.dot(normal) >= probe.cone)) return;
        } else {
            normal = way_out(own, place);
        }
        const Vec3 between = place - normal * ((here.distance + probe.radius) / 2);
        out_.push_back({between, normal, separation, probe.feature});
    }

    /// The part of a segment of the other's frame that is where a is, as parts of its length from
    /// `from`; none where the second is less than the first.
    std::array<double, 2> within_box(const Vec3& from, const Vec3& to, double radius) const
    {
        const Vec3 start = turn_ * from + position_, way = turn_ * (to - from);
        double first = 0, last = 1;
        for (Eigen::Index k = 0; k < 3; ++k) {
            const double low = box_.lower[k] - speculative_margin_ - radius - start[k];
            const double high = box_.upper[k] + speculative_margin_ + radius - start[k];
            if (std::abs(way[k]) * 1e9 < high - low) {  // level: as good as at its start
                if (low > 0 || high < 0) return {1, 0};
                continue;
            }
            first = std::max(first, std::min(low / way[k], high / way[k]));
            last = std::min(last, std::max(low / way[k], high / way[k]));
        }
        return {first, last};
    }

private:
    // Where the field tells no way: against what the probe looks at, or from the middle of a.
    Vec3 way_out(const Vec3& own, const Vec3& place) const
    {
        if (own.squaredNorm() > 0) return -own;
        const Vec3 away = place - 0.5 * (box_.lower + box_.upper);
        const double length = away.norm();
        return length > 0 ? Vec3(away / length) : Vec3::UnitZ();
    }

    const VoxelBricks& bricks_;
    double furthest_;  // from here on corners of a cell may be cut off at the band
    Box3 box_;
    Mat3 turn_;
    Vec3 position_;
    double speculative_margin_;
    std::vector<ContactCandidate>& out_;
};

// Places along a line, a voxel apart or less, counted from its start whatever part of it is near.
void probe_line(
    const Prober& prober, const Vec3& from, const Vec3& to, Probe probe, std::uint32_t line)
{
    const double parts =
        std::clamp(std::ceil((to - from).norm() / prober.voxel()), 1.0, kMostParts);
    const auto [first, last] = prober.within_box(from, to, probe.radius);
    if (!(first <= last)) return;
    for (double i = std::ceil(first * parts); i <= last * parts; ++i) {
        probe.place = from + (to - from) * (i / parts);
        probe.feature =
            candidate_feature(CandidateSide::edge, line * 4097 + static_cast<std::size_t>(i));
        prober.probe(probe);
    }
}

// Cosine of the angle between two unit vectors' mean and either of them, and 20 degrees more.
double cone_of(const Vec3& mean, const Vec3& face)
{
    const double least = std::min(1.0, mean.dot(face));
    return least * 0.94 - std::sqrt(std::max(0.0, 1 - least * least)) * 0.342;
}

void probe_polytope(const Prober& prober, const PolytopeView& shape)
{
    for (std::size_t v = 0; v < shape.vertices.size(); ++v)
        prober.probe(
            {shape.vertices[v], 0, Vec3::Zero(), -1, candidate_feature(CandidateSide::probe, v)});
    for (std::size_t e = 0; e < shape.edges.size(); ++e) {
        const Hull::Edge& edge = shape.edges[e];
        const Vec3 normal = (shape.normals[edge.left] + shape.normals[edge.right]).normalized();
        probe_line(prober, shape.vertices[edge.from], shape.vertices[edge.to],
                   {Vec3::Zero(), 0, normal, cone_of(normal, shape.normals[edge.left]), 0},
                   static_cast<std::uint32_t>(e));
    }
}

// Directions round a circle, by halving angles: the same bits on every machine.
const std::array<Eigen::Vector2d, kMostRim>& circle()
{
    static const auto points = [] {
        std::array<Eigen::Vector2d, kMostRim> all;
        all[0] = {1, 0};
        all[kMostRim / 4] = {0, 1};
        for (std::size_t step = kMostRim / 4; step > 1; step /= 2)
            for (std::size_t i = 0; i < kMostRim / 4; i += step)
                all[i + step / 2] = (all[i] + all[i + step]).normalized();
        for (std::size_t i = kMostRim / 4; i < kMostRim; ++i)
            all[i] = {-all[i - kMostRim / 4].y(), all[i - kMostRim / 4].x()};
        return all;
    }();
    return points;
}

// The greatest balls along the axis fill the side; the rims stick out.
void probe_cylinder(const Prober& prober, const Cylinder& cylinder)
{
    const double radius = std::min(cylinder.radius, cylinder.half_length);
    const Vec3 end(0, 0, cylinder.half_length - radius);
    probe_line(prober, -end, end, {Vec3::Zero(), radius, Vec3::Zero(), -1, 0}, 0);

    std::size_t count = kLeastRim;
    while (count < kMostRim && 6.3 * cylinder.radius > static_cast<double>(count) * prober.voxel())
        count *= 2;
    constexpr double kSlant = 0.7071067811865476;
    for (const double side : {-1.0, 1.0})
        for (std::size_t i = 0; i < kMostRim; i += kMostRim / count) {
            const Eigen::Vector2d& out = circle()[i];
            const Vec3 place(cylinder.radius * out.x(), cylinder.radius * out.y(),
                             side * cylinder.half_length);
            const Vec3 normal = kSlant * Vec3(out.x(), out.y(), side);
            prober.probe({place, 0, normal, cone_of(normal, Vec3(0, 0, side)),
                          candidate_feature(CandidateSide::probe, side < 0 ? i : i + kMostRim)});
        }
}

// What is seen of the corners of a mesh by the triangles that are near: enough, as those of a
// corner near the solid are.
struct MeshCorner {
    std::uint32_t vertex, triangle;
};

}  // namespace

void probe_convex(const Shapes& shapes,
                  const Solid& a,
                  ShapeRef other,
                  const Pose& other_in_a,
                  double speculative_margin,
                  std::vector<ContactCandidate>& out)
{
    const Prober prober(a, other_in_a, speculative_margin, out);
    const Probe round{Vec3::Zero(), 0, Vec3::Zero(), -1,
                      candidate_feature(CandidateSide::probe, 0)};
    switch (other.kind) {
    case ShapeKind::sphere: {
        Probe ball = round;
        ball.radius = shapes.spheres[other.index].radius;
        prober.probe(ball);
        return;
    }
    case ShapeKind::capsule: {
        const Capsule& capsule = shapes.capsules[other.index];
        const Vec3 half(0, 0, capsule.half_length);
        Probe ball = round;
        ball.radius = capsule.radius;
        probe_line(prober, -half, half, ball, 0);
        return;
    }
    case ShapeKind::cylinder:
        probe_cylinder(prober, shapes.cylinders[other.index]);
        return;
    case ShapeKind::box:
    case ShapeKind::hull:
        probe_polytope(prober, PolytopeShape(shapes, other).view());
        return;
    default:
        return;
    }
}

void probe_mesh(const Solid& a,
                const Mesh& mesh,
                const Pose& mesh_in_a,
                double speculative_margin,
                std::vector<ContactCandidate>& out)
{
    // The solid's box as the mesh sees it.
    const Box3 box = FieldSide(a).box();
    const Mat3 turn = mesh_in_a.orientation.toRotationMatrix();
    const Vec3 middle = turn.transpose() * (0.5 * (box.lower + box.upper) - mesh_in_a.position);
    const Vec3 half = turn.transpose().cwiseAbs() * (0.5 * (box.upper - box.lower))
        + Vec3::Constant(speculative_margin);
    thread_local std::vector<std::uint32_t> near;
    thread_local std::vector<MeshCorner> corners;
    near.clear();
    corners.clear();
    find_triangles(mesh, {middle - half, middle + half}, near);

    const Prober prober(a, mesh_in_a, speculative_margin, out);
    for (const std::uint32_t t : near)
        for (std::uint32_t e = 0; e < 3; ++e) {
            const std::uint32_t from = mesh.triangles[t][e], to = mesh.triangles[t][(e + 1) % 3];
            corners.push_back({from, t});
            const std::int32_t beyond = mesh.adjacent[t][e];
            const bool own = beyond < static_cast<std::int32_t>(t);
            if (!own || (mesh.convex_edges[t] >> e & 1) == 0) continue;
            Vec3 normal = mesh.normals[t];
            if (beyond >= 0) normal += mesh.normals[static_cast<std::size_t>(beyond)];
            if (!(normal.squaredNorm() > 1e-12)) normal = mesh.normals[t];  // folded flat
            normal.normalize();
            probe_line(prober, mesh.vertices[from], mesh.vertices[to],
                       {Vec3::Zero(), 0, normal, cone_of(normal, mesh.normals[t]), 0}, 3 * t + e);
        }
    std::sort(corners.begin(), corners.end(), [](const MeshCorner& p, const MeshCorner& q) {
        return p.vertex != q.vertex ? p.vertex < q.vertex : p.triangle < q.triangle;
    });
    for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
        Vec3 sum = Vec3::Zero();
        for (; end < corners.size() && corners[end].vertex == corners[begin].vertex; ++end)
            sum += mesh.normals[corners[end].triangle];
        const Vec3& first = mesh.normals[corners[begin].triangle];
        const Vec3 normal = sum.squaredNorm() > 1e-12 ? Vec3(sum.normalized()) : first;
        double cone = 1;
        for (std::size_t i = begin; i < end; ++i)
            cone = std::min(cone, cone_of(normal, mesh.normals[corners[i].triangle]));
        const std::uint32_t vertex = corners[begin].vertex;
        prober.probe({mesh.vertices[vertex], 0, normal, cone,
                      candidate_feature(CandidateSide::probe, vertex)});
    }
}

}  // namespace throng
