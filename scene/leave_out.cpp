#include "throng/leave_out.hpp"

#include <stdexcept>

namespace throng {

namespace {

void for_bodies(Scene& scene, const auto& change)
{
    for (BodyDescription& body : scene.bodies) change(body);
    for (Instances& group : scene.instances) change(group.common);
}

// Records carry spins of their own.
void stop_turning(Scene& scene)
{
    constexpr std::size_t kSpin = 10, kNumbers = 3;
    for_bodies(scene, [](BodyDescription& body) {
        body.lock_rotation = body.lock_rotation || body.motion == Motion::dynamic;
        body.angular_velocity = Vec3::Zero();
    });
    for (Instances& group : scene.instances)
        for (std::size_t at = 0; at < group.records.size(); at += group.stride())
            for (std::size_t k = 0; k < kNumbers; ++k) group.records[at + kSpin + k] = 0;
}

void set_materials(Scene& scene,
                   double Material::*of_one,
                   std::optional<double> MaterialPairDescription::*of_pair)
{
    // Who states none has a default one.
    if (scene.materials.empty() || of_one == &Material::friction) {
        for_bodies(scene, [&](BodyDescription& body) {
            if (body.material == kNone)
                body.material = static_cast<std::uint32_t>(scene.materials.size());
        });
        scene.materials.push_back({});
    }
    for (Material& material : scene.materials) material.*of_one = 0;
    if (of_pair == nullptr) return;
    for (MaterialPairDescription& pair : scene.pairs)
        if (pair.*of_pair) pair.*of_pair = 0;
}

}  // namespace

Scene leave_out(const Scene& scene, Effect effect)
{
    Scene changed = scene;
    switch (effect) {
    case Effect::motion:
        throw std::invalid_argument("motion cannot be left out: wanted an effect beside it, as "
                                    "`throng explain` lists them");
    case Effect::gravity:
        changed.gravity = Vec3::Zero();
        break;
    case Effect::forces:
        for_bodies(changed, [](BodyDescription& body) { body.force = body.torque = Vec3::Zero(); });
        break;
    case Effect::drive:
        for_bodies(changed, [](BodyDescription& body) { body.drive_velocity = {}; });
        break;
    case Effect::rotation:
        stop_turning(changed);
        break;
    case Effect::contact:
        for_bodies(changed, [](BodyDescription& body) { body.mask = 0; });
        break;
    case Effect::no_overlap:
    case Effect::little_overlap:
        changed.settings.overlap = Overlap::allow;
        break;
    case Effect::friction:
        set_materials(changed, &Material::friction, &MaterialPairDescription::friction);
        break;
    case Effect::rolling_friction:
        set_materials(changed, &Material::rolling_friction, nullptr);
        break;
    case Effect::restitution:
        set_materials(changed, &Material::restitution, &MaterialPairDescription::restitution);
        break;
    case Effect::springs:
        changed.springs.clear();
        break;
    case Effect::attractors:
        changed.attractors.clear();
        break;
    case Effect::wind:
        changed.wind = Vec3::Zero();
        break;
    case Effect::drag:
        for_bodies(changed,
                   [](BodyDescription& body) { body.linear_drag = body.angular_drag = 0; });
        break;
    case Effect::pivot:
        for_bodies(changed, [](BodyDescription& body) { body.pivot.reset(); });
        break;
    default:
        break;
    }
    return changed;
}

}  // namespace throng
