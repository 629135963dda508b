// Events option: `--events FILE`, who began and who ceased to touch in a run, and who hit whom.
#include "apps/throng/events_option.hpp"

#include "scene/names.hpp"

#include <cmath>

namespace throng {
namespace {

// Numbers have the fewest digits that read back to the same bits.
std::string columns(const Vec3& v)
{
    std::string text;
    for (const double number : {v.x(), v.y(), v.z()}) text += ',' + number_text(number);
    return text;
}

std::string line_of(const char* what, const TouchEvent& event)
{
    return std::to_string(event.step) + ',' + what + ',' + std::to_string(event.a.index) + ','
        + std::to_string(event.b.index) + ',' + std::to_string(event.part_a) + ','
        + std::to_string(event.part_b);
}

}  // namespace

EventsOption::EventsOption(const Options& options) : file_("--events", options.text("--events"))
{
    if (options.has("--hit-speed")) {
        if (!file_.asked_for())
            throw BadInput("--hit-speed: says what --events calls a hit; give --events as well");
        hit_speed_ = parse_number(options.text("--hit-speed"));
        if (!(hit_speed_ > 0) || std::isinf(hit_speed_))
            throw BadInput("--hit-speed: wanted a speed above 0, m/s");
    }
    if (file_.asked_for())
        file_.stream() << "step,event,a,b,part_a,part_b,speed,px,py,pz,nx,ny,nz\n";
}

void EventsOption::listen(World& world)
{
    if (asked_for()) world.listen({.touches = true, .hit_speed = hit_speed_, .sensors = true});
}

void EventsOption::after_step(const World& world)
{
    if (!asked_for()) return;
    const Events& events = world.events();
    std::ostream& out = file_.stream();
    for (const TouchEvent& event : events.begun) out << line_of("begin", event) << ",,,,,,,\n";
    for (const TouchEvent& event : events.ended) out << line_of("end", event) << ",,,,,,,\n";
    for (const TouchEvent& event : events.sensed) out << line_of("sense", event) << ",,,,,,,\n";
    for (const TouchEvent& event : events.left) out << line_of("leave", event) << ",,,,,,,\n";
    for (const HitEvent& hit : events.hits)
        out << line_of("hit", hit) << ',' << number_text(hit.speed) << columns(hit.point)
            << columns(hit.normal) << '\n';
}

}  // namespace throng
