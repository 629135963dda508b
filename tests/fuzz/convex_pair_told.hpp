// Convex pair told: what is being asked of a pair, and what is told where a promise is broken.
#pragma once

#include "narrowphase/alternatives/convex_methods.hpp"
#include "throng/scene.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace throng {

/// What is being asked, told where a check fails.
struct Now {
    const ShapeDescription* shapes[2] = {};
    Pose pose;
    std::string_view method = "none";
    int start = 0;
    double speculative_margin = 0;
    MethodMemory memory;
};
inline Now now;

inline void tell(const Vec3& v)
{
    std::fprintf(stderr, "{%.17g, %.17g, %.17g}", v.x(), v.y(), v.z());
}

inline void tell_shape(const ShapeDescription& shape)
{
    if (const auto* hull = std::get_if<HullShape>(&shape.shape)) {
        std::fprintf(stderr, "hull");
        for (const Vec3& point : hull->points) {
            std::fprintf(stderr, " ");
            tell(point);
        }
    }
    if (const auto* box = std::get_if<BoxShape>(&shape.shape)) {
        std::fprintf(stderr, "box ");
        tell(box->half_extents);
    }
    const auto tell_round = [](const char* kind, double radius, double half_length) {
        std::fprintf(stderr, "%s %.17g %.17g", kind, radius, half_length);
    };
    if (const auto* s = std::get_if<SphereShape>(&shape.shape)) tell_round("sphere", s->radius, 0);
    if (const auto* s = std::get_if<CapsuleShape>(&shape.shape))
        tell_round("capsule", s->radius, s->half_length);
    if (const auto* s = std::get_if<CylinderShape>(&shape.shape))
        tell_round("cylinder", s->radius, s->half_length);
    std::fprintf(stderr, "\n");
}

[[noreturn]] inline void fail(const char* promise, double got, double wanted)
{
    std::fprintf(stderr, "broken: %s (%.17g, %.17g)\n", promise, got, wanted);
    for (const ShapeDescription* shape : now.shapes) tell_shape(*shape);
    std::fprintf(stderr, "at ");
    tell(now.pose.position);
    const Quat& q = now.pose.orientation;
    std::fprintf(stderr, " turned (%.17g, %.17g, %.17g, %.17g)\n", q.w(), q.x(), q.y(), q.z());
    std::fprintf(stderr, "%s, start %d, reach %.17g; remembered kind %u, count %u, axis ",
                 std::string(now.method).c_str(), now.start, now.speculative_margin,
                 now.memory.kind, now.memory.count);
    tell(now.memory.axis);
    for (int i = 0; i < 4; ++i) std::fprintf(stderr, " %u/%u", now.memory.a[i], now.memory.b[i]);
    std::fprintf(stderr, "\n");
    std::abort();
}

inline void expect(bool good, const char* promise, double got = 0, double wanted = 0)
{
    if (!good) fail(promise, got, wanted);
}

}  // namespace throng
