// Tour: a program that goes through all of the public door, in the folder that it is given.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <throng/throng.hpp>

namespace {

// How much did not hold.
int& failed()
{
    static int count = 0;
    return count;
}

void expect(bool holds, const char* what)
{
    if (holds) return;
    std::printf("does not hold: %s\n", what);
    ++failed();
}

// A scene by file, catalogue and hand comes to the same.
void read_and_write(const std::string& folder)
{
    throng::Scene scene = throng::make_scene("stacks", 12);
    expect(throng::find_scene("stacks") != nullptr, "the catalogue has stacks");
    expect(throng::check_scene(scene).empty(), "a scene of the catalogue is good");
    const std::string path = folder + "/stacks.json";
    throng::write_scene(scene, path);
    const throng::Scene again = throng::read_scene(path);
    expect(again.body_count() == scene.body_count(), "a written scene reads back");
    throng::World a(scene), b(again);
    a.step(20);
    b.step(20);
    expect(a.state_hash() == b.state_hash(), "and does the same");
    try {
        throng::read_scene_text("{\"shapes\": 3}", "bad.json", folder);
        expect(false, "a bad scene is refused");
    } catch (const throng::SceneError& error) {
        expect(std::string(error.what()).find("bad.json:1:") == 0,
               "a bad scene is told by its place");
    }
}

void set_dials()
{
    throng::Settings settings;
    expect(throng::set_dial(settings, "substeps", "8").empty() && settings.substeps == 8,
           "dials are set by name");
    expect(!throng::set_dial(settings, "substeps", "x").empty(), "a bad value is told");
    expect(throng::dial_value(settings, "substeps") == "8", "and read");
    expect(throng::find_dial("solver") != nullptr && !throng::dials().empty(), "dials are listed");
}

// A ball falls on a floor, watched: its energy, what it touches, what a ray meets.
void run_and_ask(const std::string& folder)
{
    throng::Scene scene;
    scene.shapes = {{"floor", throng::PlaneShape{}}, {"ball", throng::SphereShape{0.5}}};
    throng::BodyDescription body;
    body.shape = 0;
    body.motion = throng::Motion::static_;
    scene.bodies = {body};
    body.shape = 1;
    body.motion = throng::Motion::dynamic;
    body.position = throng::Vec3(0, 0, 1.5);
    scene.bodies.push_back(body);

    throng::World world(scene, 2);
    throng::EnergyLedger ledger;
    throng::RunFile file(folder + "/run.h5", scene, world, {"ball", throng::version(), 1, 10});
    for (int step = 0; step < 120; ++step) {
        ledger.before_step(world);
        world.step();
        ledger.after_step(world);
        if (step % 10 == 9) file.write_frame(world);
    }
    file.close();
    expect(file.whole_frames() == 12, "frames are written");
    expect(ledger.gained() < 1e-3 * ledger.greatest_kinetic(), "no energy is made");
    expect(world.effects().on.has(throng::Effect::contact), "contact is called for");
    expect(world.report().contacts == 1 || !world.awake(world.bodies()[1]), "the ball touches");

    throng::Queries queries(world);
    const throng::RayHit hit = queries.cast_ray({throng::Vec3(0, 0, 5), throng::Vec3(0, 0, -1)});
    expect(hit.hit && hit.body == world.bodies()[1], "a ray meets the ball");
    std::ofstream csv(folder + "/final.csv");
    throng::write_final_csv(world, csv);
    expect(csv.good(), "final states are written");
}

void ask_pairs()
{
    const throng::ShapeDescription ball{"", throng::SphereShape{1}};
    const throng::ShapeDescription box{"", throng::BoxShape{throng::Vec3(1, 1, 1)}};
    throng::ConvexQuery convex(ball, box);
    const throng::Pose apart{throng::Vec3(3, 0, 0), throng::Quat::Identity()};
    expect(convex.ask("gjk", apart).separation == 1, "the distance of a ball and a box");
    throng::ImpactQuery impact(ball, box);
    throng::ShapeMotion coming;
    coming.pose = apart;
    coming.velocity = throng::Vec3(-1, 0, 0);
    const throng::ImpactAnswer meeting = impact.ask({}, coming, 2);
    expect(meeting.meets && meeting.time > 0.99 && meeting.time <= 1, "when they meet");
    throng::VolumeQuery volume(box, box);
    for (const throng::VolumeWayDescription& way : throng::known_volume_ways()) {
        const throng::VolumeAnswer shared = volume.ask(way.name, throng::Pose{});
        expect(shared.trouble.empty() && std::abs(shared.volume - 8) < 0.1, "what two share");
    }
}

// Level sets need OpenVDB, which the package finds by itself.
void make_a_level_set()
{
    throng::MeshShape box;
    for (int corner = 0; corner < 8; ++corner)
        box.vertices.emplace_back(corner & 1, corner >> 1 & 1, corner >> 2);
    box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const throng::LevelSetResult made = throng::make_level_set(box.vertices, box.triangles, 0.1);
    expect(made.trouble.empty(), made.trouble.c_str());
    if (made.level_set) expect(throng::facts_of(*made.level_set).whole, "a closed mesh encloses");
}

}  // namespace

int main(int, char** arguments)
{
    const std::string folder = arguments[1];
    read_and_write(folder);
    set_dials();
    run_and_ask(folder);
    ask_pairs();
    make_a_level_set();
    std::printf("throng %s, %s: %d of what was promised does not hold\n", throng::version(),
                throng::lane_width(), failed());
    return failed() == 0 ? 0 : 1;
}
