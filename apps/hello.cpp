// Hello: boxes fall on the ground, and come to rest.
#include <cstdio>
#include <throng/throng.hpp>

int main()
{
    throng::Scene scene;
    scene.shapes = {{"floor", throng::PlaneShape{}},
                    {"crate", throng::BoxShape{throng::Vec3(0.5, 0.5, 0.5)}}};
    throng::BodyDescription ground;
    ground.shape = 0;
    ground.motion = throng::Motion::static_;
    scene.bodies.push_back(ground);

    // A pillar of ten, each a little above the one below.
    for (int level = 0; level < 10; ++level) {
        throng::BodyDescription crate;
        crate.shape = 1;
        crate.position = throng::Vec3(0, 0, 0.6 + 1.1 * level);
        scene.bodies.push_back(crate);
    }

    throng::World world(scene);
    world.step(300);  // five seconds
    const throng::Vec3 top = world.pose(world.bodies().back()).position;
    std::printf("the topmost crate rests at %.2f m\n", top.z());
}
