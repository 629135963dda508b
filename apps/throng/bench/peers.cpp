// Peers: other engines, from the module beside the command.
#include "apps/throng/bench/peers.hpp"

#include "apps/throng/bench/peer_quality.hpp"
#include "apps/throng/options.hpp"

#include <dlfcn.h>
#include <filesystem>
#include <iostream>
#include <string_view>

namespace throng::bench {
namespace {

class PeerEngine final : public Engine {
public:
    PeerEngine(const MakePeer& make, int threads, const Scene& scene)
        : scene_(scene), threads_(threads)
    {
        const Scene taken = scene_of_peers(scene);
        const World world(taken);
        dt_ = world.settings().dt;
        try {
            peer_ = make(peer_scene(world, taken));
        } catch (const std::invalid_argument& why) {
            throw EngineRefuses(why.what());
        }
    }
    void step() override { peer_->step(dt_); }
    std::size_t contacts() const override { return peer_->contacts(); }
    Quality judge() override { return quality_of(scene_, peer_->states()); }
    std::vector<PeerState> states() const override { return peer_->states(); }
    int threads_met() const override { return threads_; }
    std::string settings() const override { return peer_->settings(); }

private:
    const Scene& scene_;
    int threads_;
    double dt_ = 0;
    std::unique_ptr<perf::Peer> peer_;
};

// What the module offers; null where there is none. It stays loaded for as long as the process.
const perf::PeerEntry* load_peers()
{
    std::error_code trouble;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", trouble);
    if (trouble) return nullptr;
    const std::string path = (self.parent_path() / "throng_peers.so").string();
    void* const module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) return nullptr;
    void* const door = ::dlsym(module, perf::kPeersSymbol);
    return door == nullptr ? nullptr : reinterpret_cast<perf::PeersFunction>(door)();
}

}  // namespace

EngineKind peer_kind(const std::string& name, int threads, const MakePeer& make)
{
    return {name, "", threads, [make, threads](const Scene& scene) {
                return std::make_unique<PeerEngine>(make, threads, scene);
            }};
}

std::vector<EngineKind> peer_engines(const std::vector<std::string>& names, bool asked_for)
{
    std::vector<EngineKind> kinds;
    if (names.empty()) return kinds;
    const perf::PeerEntry* const offered = load_peers();
    for (const std::string& name : names) {
        const perf::PeerEntry* entry = offered;
        while (entry != nullptr && entry->name != nullptr && entry->name != name) ++entry;
        if (entry == nullptr || entry->name == nullptr) {
            if (!asked_for) {
                std::cerr << "note: no " << name << " to compare with: lib" << name
                          << "-dev was not there when throng was built\n";
                continue;
            }
            throw BadInput("--peers: this build has no " + name
                           + ", whose Debian package was not there; install it and build throng "
                             "again, or leave it out");
        }
        kinds.push_back(peer_kind(name, 1, entry->make));
    }
    return kinds;
}

}  // namespace throng::bench
