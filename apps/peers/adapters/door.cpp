// Door: what an adapter's module offers, in plain functions.
#include "apps/peers/adapters/adapter.hpp"

#include <algorithm>
#include <exception>

namespace throng::adapters {
namespace {

void copy(const std::string& text, char* to, std::size_t room)
{
    if (room == 0) return;
    const std::size_t length = std::min(text.size(), room - 1);
    std::copy_n(text.begin(), length, to);
    to[length] = '\0';
}

Engine* make(const Scene* scene, int threads, char* why, std::size_t room)
{
    try {
        return make_engine(*scene, threads);
    } catch (const std::exception& trouble) {
        copy(trouble.what(), why, room);
        return nullptr;
    }
}

void destroy(Engine* engine) { delete engine; }
void step(Engine* engine, double dt) { engine->step(dt); }
std::size_t contacts(const Engine* engine) { return engine->contacts(); }
void read(const Engine* engine, State* states) { engine->read(states); }
void settings(const Engine* engine, char* text, std::size_t room)
{
    copy(engine->settings(), text, room);
}

}  // namespace
}  // namespace throng::adapters

extern "C" __attribute__((visibility("default"))) const throng::adapters::Door* throng_adapter()
{
    using namespace throng::adapters;
    static const Door kDoor = {make, destroy, step, contacts, read, settings};
    return &kDoor;
}
