#include "throng/impact_query.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "narrowphase/ccd/linear_paths.hpp"
#include "pipeline/queries/query_shape.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"

#include <cmath>

namespace throng {
namespace {

std::string trouble_with_asked(const ShapeDescription& shape)
{
    if (std::holds_alternative<CompoundShape>(shape.shape)
        || std::holds_alternative<VoxelsShape>(shape.shape))
        return "wanted a sphere, capsule, cylinder, box, hull, plane or mesh";
    return trouble_with(shape);
}

ShapeRef append(Shapes& shapes, const ShapeDescription& shape)
{
    if (const auto* plane = std::get_if<PlaneShape>(&shape.shape)) {
        shapes.planes.push_back({plane->normal.normalized(), plane->offset});
        return {ShapeKind::plane, static_cast<std::uint32_t>(shapes.planes.size() - 1)};
    }
    if (const auto* mesh = std::get_if<MeshShape>(&shape.shape)) {
        shapes.meshes.push_back(build_mesh(mesh->vertices, mesh->triangles).mesh);
        return {ShapeKind::mesh, static_cast<std::uint32_t>(shapes.meshes.size() - 1)};
    }
    return append_convex(shapes, shape);
}

ImpactAnswer answer_of(const Impact& impact, double duration)
{
    return {{},
            impact.state != ToiState::separated,
            impact.state == ToiState::touching_at_start,
            impact.time * duration,
            impact.distance,
            impact.normal,
            impact.evaluations,
            impact.cut_short};
}

ImpactAnswer refusal(std::string trouble)
{
    ImpactAnswer answer;
    answer.trouble = std::move(trouble);
    return answer;
}

std::string trouble_with(const ShapeMotion& motion)
{
    if (std::string trouble = trouble_with(motion.pose); !trouble.empty()) return trouble;
    if (!motion.velocity.allFinite() || !motion.angular_velocity.allFinite())
        return "a velocity is not finite; give m/s and rad/s";
    return {};
}

RigidTrajectory trajectory_of(const ShapeMotion& motion, double duration)
{
    return {{motion.pose.position, motion.pose.orientation.normalized()},
            motion.velocity * duration,
            motion.angular_velocity * duration};
}

}  // namespace

struct ImpactQuery::Inside {
    std::string trouble;
    Shapes shapes;
    ShapeRef a, b;
};

ImpactQuery::ImpactQuery(const ShapeDescription& a, const ShapeDescription& b)
    : inside_(std::make_unique<Inside>())
{
    for (const auto& [name, shape] : {std::pair("a", &a), std::pair("b", &b)}) {
        const std::string trouble = trouble_with_asked(*shape);
        if (trouble.empty()) continue;
        inside_->trouble = std::string("shape ") + name + ": " + trouble;
        return;
    }
    const bool planes =
        std::holds_alternative<PlaneShape>(a.shape) && std::holds_alternative<PlaneShape>(b.shape);
    const bool meshes =
        std::holds_alternative<MeshShape>(a.shape) && std::holds_alternative<MeshShape>(b.shape);
    if (planes || meshes) {
        inside_->trouble = "shape b: wanted another kind than a's, not two planes or two meshes";
        return;
    }
    inside_->a = append(inside_->shapes, a);
    inside_->b = append(inside_->shapes, b);
}

ImpactQuery::~ImpactQuery() = default;
ImpactQuery::ImpactQuery(ImpactQuery&&) noexcept = default;
ImpactQuery& ImpactQuery::operator=(ImpactQuery&&) noexcept = default;

const std::string& ImpactQuery::trouble() const { return inside_->trouble; }

double ImpactQuery::size() const
{
    return inside_->trouble.empty() ? impact_size(inside_->shapes, inside_->a, inside_->b) : 0;
}

ImpactAnswer ImpactQuery::ask(const ShapeMotion& a,
                              const ShapeMotion& b,
                              double duration,
                              ToiMethod method,
                              double tolerance) const
{
    if (!inside_->trouble.empty()) return refusal(inside_->trouble);
    for (const ShapeMotion* motion : {&a, &b})
        if (std::string trouble = trouble_with(*motion); !trouble.empty())
            return refusal(std::move(trouble));
    if (!(duration > 0 && std::isfinite(duration)))
        return refusal("duration is not above 0; give a time in s");
    Settings settings;
    if (std::string trouble = set_dial(settings, "toi_tolerance", number_text(tolerance));
        !trouble.empty())
        return refusal(std::move(trouble));

    const ImpactRule rule = impact_rule(method, tolerance * size());
    const MovingShape moving_a{inside_->a, trajectory_of(a, duration), Pose{}};
    const MovingShape moving_b{inside_->b, trajectory_of(b, duration), Pose{}};
    return answer_of(time_of_impact(inside_->shapes, moving_a, moving_b, 0, 1, rule), duration);
}

ImpactAnswer ask_linear_paths(const LinearQuestion& question, ToiMethod method, double tolerance)
{
    for (const auto* points : {&question.from, &question.to})
        for (const Vec3& point : *points)
            if (!point.allFinite()) return refusal("a point is not finite; give places in m");
    if (!(tolerance >= 0)) return refusal("tolerance is below 0 or no number; give a length in m");
    const LinearPaths paths{question.edges ? PathKind::edge_edge : PathKind::vertex_face,
                            question.from, question.to};
    return answer_of(time_of_impact(paths, method, tolerance), 1);
}

}  // namespace throng
