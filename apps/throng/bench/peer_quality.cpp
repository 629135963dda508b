// Peer quality: what another engine's state is worth.
#include "apps/throng/bench/peer_quality.hpp"

#include <cmath>
#include <limits>

namespace throng::bench {
namespace {

// Into a record of Instances.
void write_pose(double* record, const Pose& pose, const PeerState& state)
{
    const Quat& q = pose.orientation;
    const double numbers[] = {
        pose.position.x(), pose.position.y(), pose.position.z(), q.w(), q.x(), q.y(), q.z()};
    std::copy(std::begin(numbers), std::end(numbers), record);
    for (int k = 0; k < 3; ++k) {
        record[7 + k] = state.velocity[k];
        record[10 + k] = state.angular_velocity[k];
    }
}

bool is_finite(const PeerState& state)
{
    return state.pose.position.allFinite() && state.pose.orientation.coeffs().allFinite()
        && state.velocity.allFinite() && state.angular_velocity.allFinite();
}

}  // namespace

Scene scene_of_peers(Scene scene)
{
    if (scene.settings.nonconvex != NonConvex::hull) scene.settings.nonconvex = NonConvex::parts;
    for (ShapeDescription& shape : scene.shapes)
        if (auto* const mesh = std::get_if<MeshShape>(&shape.shape))
            if (mesh->nonconvex != "hull") mesh->nonconvex.clear();
    return scene;
}

Quality quality_of(const Scene& scene, const std::vector<PeerState>& states)
{
    for (const PeerState& state : states) {
        constexpr double kBad = std::numeric_limits<double>::infinity();
        if (!is_finite(state)) return {kBad, kBad, 0, kBad, 0};
    }
    // Where each center of mass is within its body follows from the scene as it was stated.
    const World stated(scene);
    std::vector<Pose> poses;
    for (const BodyId id : stated.bodies()) {
        const PeerState& state = states[poses.size()];
        const Pose was = stated.pose(id);
        const Vec3 center = was.to_local(stated.center_of_mass(id));
        const Quat turned = state.pose.orientation.normalized();
        poses.push_back({state.pose.position - turned * center, turned});
    }
    Scene now = scene;
    std::size_t at = 0;
    for (BodyDescription& body : now.bodies) {
        body.position = poses[at].position;
        body.orientation = poses[at].orientation;
        body.velocity = states[at].velocity;
        // An engine without locks may turn what is locked by a hair.
        if (!body.lock_rotation) body.angular_velocity = states[at].angular_velocity;
        ++at;
    }
    for (Instances& group : now.instances)
        for (std::size_t i = 0; i < group.count(); ++i, ++at) {
            PeerState state = states[at];
            if (group.common.lock_rotation) state.angular_velocity.setZero();
            write_pose(&group.records[i * group.stride()], poses[at], state);
        }
    return quality_of(now, World(now));
}

}  // namespace throng::bench
