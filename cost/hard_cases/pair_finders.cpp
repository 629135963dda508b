// Pair finders: H37, whatever finds the pairs, they are the same.
//
// Answer: that of all pairs, which asks every box about every other. Boxes of all sizes fly through
// one another, so that pairs come and go; states that are the same to the last bit have had the
// same contacts all along.
#include "cost/hard_cases/hard_cases.hpp"
#include "scene/catalog/random.hpp"
#include "throng/world.hpp"

#include <cmath>

namespace throng {

namespace {

constexpr int kBoxes = 600;
constexpr double kTime = 0.25;  // s
// m; a thousand to one from the largest to the least.
constexpr double kLargest = 2, kRoom = 6;

Scene mixed_boxes(const CaseBench& bench, std::uint64_t seed)
{
    Random random(seed);
    const auto vector = [&](double half_size) {
        Vec3 made = Vec3::Zero();
        for (double& x : made) x = random.uniform(-half_size, half_size);
        return made;
    };
    SceneParts parts(bench.scene());
    parts.scene().gravity = Vec3::Zero();
    const std::uint32_t material = parts.material(0.5);
    for (int i = 0; i < kBoxes; ++i) {
        const double size = std::ldexp(kLargest, -static_cast<int>(random.below(11)));
        Vec3 half = Vec3::Zero();
        for (double& x : half) x = size * random.uniform(0.1, 0.5);
        const Vec3 axis = vector(1);
        const Quat turn = Quat(1.1, axis.x(), axis.y(), axis.z()).normalized();
        // Small ones lie close, so that they too meet.
        const Vec3 place = vector(i % 2 == 0 ? kRoom : kRoom / 8);
        BodyDescription& body = parts.body(parts.box(material, 1, half, {place, turn}));
        body.velocity = vector(4);
        body.angular_velocity = vector(2);
    }
    return parts.scene();
}

struct Flight {
    std::string hash;
    std::vector<std::size_t> contacts;  // of each step
    std::size_t pairs = 0;              // that are held at the end
};

Flight fly(CaseBench& bench, Scene scene, BroadPhase finder)
{
    scene.settings.broadphase = finder;
    Flight flight;
    bench.run(scene, kTime, [&](World& world, double) {
        flight.contacts.push_back(world.report().contacts);
        flight.pairs = world.report().pairs;
        flight.hash = world.state_hash();
        return true;
    });
    return flight;
}

}  // namespace

void compare_pair_finders(CaseBench& bench)
{
    constexpr std::uint64_t kScenes = 4;
    for (const auto& [name, finder] :
         {std::pair("embree", BroadPhase::embree), std::pair("grid", BroadPhase::grid),
          std::pair("sweep", BroadPhase::sweep)}) {
        double other_pairs = 0, other_contacts = 0, other_states = 0;
        for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
            const Scene scene = mixed_boxes(bench, seed);
            const Flight plain = fly(bench, scene, BroadPhase::all_pairs);
            const Flight found = fly(bench, scene, finder);
            other_pairs += found.pairs == plain.pairs ? 0 : 1;
            other_states += found.hash == plain.hash ? 0 : 1;
            for (std::size_t i = 0; i < plain.contacts.size(); ++i)
                other_contacts += found.contacts[i] == plain.contacts[i] ? 0 : 1;
        }
        const std::string setting = std::string(name) + ", 600 boxes of 2 mm to 2 m";
        bench.report(setting, "scenes with other pairs than all_pairs", other_pairs, 0, "1");
        bench.report(setting, "steps with other contacts", other_contacts, 0, "1");
        bench.report(setting, "scenes that end in other bits", other_states, 0, "1");
    }
}

}  // namespace throng
