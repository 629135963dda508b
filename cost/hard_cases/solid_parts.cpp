#include "cost/hard_cases/solid_parts.hpp"

#include "throng/dials.hpp"
#include "throng/world.hpp"

#include <algorithm>

namespace throng {

Scene taken(const CaseBench& bench, Scene scene, const SolidRepresentationName& way)
{
    scene.settings = bench.settings();
    set_dial(scene.settings, "nonconvex", way.name);
    return scene;
}

double greatest_speed(const World& world)
{
    double speed = 0;
    for (const BodyId body : world.bodies())
        if (world.motion(body) == Motion::dynamic)
            speed = std::max(speed, world.velocity(body).norm());
    return speed;
}

}  // namespace throng
