// Peers: the module's one door.
#include "apps/peers/peer.hpp"

#include <stdexcept>

namespace throng::perf {

void refuse_shape(const char* engine, ShapeKind kind)
{
    constexpr const char* kNames[kShapeKinds] = {"a sphere", "a capsule",  "a cylinder",
                                                 "a box",    "a hull",     "a plane",
                                                 "a mesh",   "a triangle", "a solid"};
    throw std::invalid_argument(std::string(engine) + ": is not given "
                                + kNames[static_cast<int>(kind)] + " here");
}

}  // namespace throng::perf

// The one name that leaves the module.
extern "C" __attribute__((visibility("default"))) const throng::perf::PeerEntry* throng_peers()
{
    using throng::perf::PeerEntry;
    static const PeerEntry kEntries[] = {
#ifdef THRONG_BULLET
        {"bullet", throng::perf::make_bullet},
#endif
#ifdef THRONG_ODE
        {"ode", throng::perf::make_ode},
#endif
        {nullptr, nullptr},
    };
    return kEntries;
}
