// Effect prices: what a body takes that calls for an effect, beside others that do not.
//
//     effect_prices EFFECT CALLERS [EVERY]     so many of 10,000 bodies call, side by side, or
//                                              one in so many
//
// Prints the time of a step, ns. Under callgrind, begun with --collect-atstart=no, the instructions
// of kSteps steps are counted and nothing else; perf/effects/prices.py makes the table of both.
#include "scene/catalog/closed_meshes.hpp"
#include "throng/throng.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#define THRONG_COUNT CALLGRIND_TOGGLE_COLLECT
#else
#define THRONG_COUNT
#endif

namespace throng::perf {
namespace {

constexpr int kBodies = 10'000, kSide = 100, kWarm = 12, kSteps = 2;
constexpr double kApart = 2, kHalf = 0.25;  // m

// A scene that is made body by body: cubes that lie apart on a floor, but where an effect is asked
// of others.
class Bodies {
public:
    explicit Bodies(std::string effect) : effect_(std::move(effect))
    {
        scene_.materials = {
            {"floor", 1000, 0.5, 0, 0}, {"plain", 1000, 0.5, 0, 0}, {"calls", 1000, 0.5, 0, 0}};
        scene_.shapes = {{"floor", PlaneShape{}},
                         {"cube", BoxShape{Vec3(kHalf, kHalf, kHalf)}},
                         {"ball", SphereShape{kHalf}},
                         {"slab", BoxShape{Vec3(kHalf, kHalf, kHalf / 2)}},
                         {"tile", BoxShape{Vec3(0.4, 0.4, 0.1)}},
                         {"tile of triangles", tile()},
                         {"ring", ring()}};
        if (is("friction")) scene_.materials[1].friction = 0;
        if (is("rolling_friction")) scene_.materials[2].rolling_friction = 0.02;
        if (is("restitution")) scene_.materials[2].restitution = 0.3;
        if (is("sphere_contact")) scene_.settings.nonconvex = NonConvex::spheres;
        if (is("image_contact")) scene_.settings.nonconvex = NonConvex::depth_image;
        if (is("fast_motion")) scene_.gravity = Vec3::Zero();
        BodyDescription& floor = add(0, Vec3::Zero());
        floor.motion = Motion::static_;
        floor.material = 0;
    }

    void add(int i, bool calls)
    {
        const Vec3 at(kApart * (i % kSide), kApart * (i / kSide), 0);
        const bool on_tiles = is("mesh_contact") || is("seams");
        const double height = kHalf + (on_tiles && (calls || is("mesh_contact")) ? 0.2 : 0);
        if (on_tiles) add_tiles(at, calls);
        BodyDescription& body = add(is("rolling_friction") ? 2 : 1, at + Vec3(0, 0, height));
        body.material = calls ? 2 : 1;
        if (is("rotation")) body.lock_rotation = !calls;
        if (is("fast_motion")) body.position.z() += 5, body.velocity.z() = 0.3;
        if (is("contact") && !calls) body.position.z() += 50;
        if (calls) call(body, static_cast<std::uint32_t>(scene_.bodies.size()) - 1);
    }

    const Scene& scene() const { return scene_; }

private:
    bool is(const char* effect) const { return effect_ == effect; }

    void call(BodyDescription& body, std::uint32_t at)
    {
        if (is("forces")) body.force = Vec3(0.1, 0, 0);
        if (is("drive")) body.drive_velocity[0] = 0.1;
        if (is("gyroscopic")) body.shape = 3, body.position.z() = kHalf / 2;
        if (is("fast_motion")) body.velocity.z() = 40;
        if (is("drag")) body.linear_drag = body.angular_drag = 0.1;
        if (is("pivot")) body.pivot = Vec3(0, 0, kHalf);
        if (is("voxel_contact") || is("sphere_contact") || is("image_contact"))
            body.shape = 6, body.position.z() = 0.09;
        if (!is("springs")) return;
        Spring spring;
        spring.a = at;
        spring.at_b = body.position + Vec3(0, 0, 1);
        spring.stiffness = 100;
        spring.length = 0.9;
        scene_.springs.push_back(spring);
    }

    // One of triangles or one that is a box; or none, or two side by side.
    void add_tiles(const Vec3& at, bool calls)
    {
        const auto tile = [&](std::uint32_t shape, double x) {
            BodyDescription& body = add(shape, at + Vec3(x, 0, 0.1));
            body.motion = Motion::static_;
            body.material = 0;
        };
        if (is("mesh_contact")) return tile(calls ? 5 : 4, 0);
        if (!calls) return;
        tile(4, -0.4);
        tile(4, 0.4);
    }

    BodyDescription& add(std::uint32_t shape, const Vec3& position)
    {
        BodyDescription body;
        body.shape = shape;
        body.position = position;
        scene_.bodies.push_back(body);
        return scene_.bodies.back();
    }

    static MeshShape of(const TriangleSoup& soup)
    {
        MeshShape mesh;
        mesh.vertices = soup.vertices;
        mesh.triangles = soup.triangles;
        return mesh;
    }
    static MeshShape tile()
    {
        MeshShape mesh;
        mesh.vertices = {Vec3(-0.4, -0.4, 0.1), Vec3(0.4, -0.4, 0.1), Vec3(0.4, 0.4, 0.1),
                         Vec3(-0.4, 0.4, 0.1)};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        return mesh;
    }
    static MeshShape ring() { return of(torus_mesh(0.25, 0.09, 16, 8)); }

    std::string effect_;
    Scene scene_;
};

int run(const std::string& effect, int callers, int every)
{
    Bodies bodies(effect);
    for (int i = 0; i < kBodies; ++i) bodies.add(i, i % every == 0 && i / every < callers);
    World world(bodies.scene(), 1);
    world.step(kWarm);
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    THRONG_COUNT;
    world.step(kSteps);
    THRONG_COUNT;
    const std::chrono::duration<double, std::nano> taken = Clock::now() - begin;
    std::printf("%.0f %zu\n", taken.count() / kSteps, world.report().bodies_awake);
    return 0;
}

}  // namespace
}  // namespace throng::perf

int main(int argc, char** argv)
{
    if (argc == 3 || argc == 4)
        return throng::perf::run(argv[1], std::atoi(argv[2]), argc == 4 ? std::atoi(argv[3]) : 1);
    std::fprintf(stderr, "usage: effect_prices EFFECT CALLERS [EVERY]\n");
    return 2;
}
