// Peers: the module's one door.
#include "perf/peers/peer.hpp"

#include <stdexcept>

namespace throng::perf {

bool PeerShape::is_centered() const
{
    // A hull's center of mass is found by sums that round: a billionth of a body is no offset.
    const double extent = size.cwiseAbs().maxCoeff() > 0 ? size.cwiseAbs().maxCoeff() : 1;
    return local.position.cwiseAbs().maxCoeff() <= 1e-9 * extent
        && local.orientation.vec().cwiseAbs().maxCoeff() <= 1e-12;
}

void refuse_shape(const char* engine, ShapeKind kind)
{
    constexpr const char* kNames[kShapeKinds] = {"a sphere", "a capsule", "a cylinder",
                                                 "a box",    "a hull",    "a plane",
                                                 "a mesh",   "a triangle"};
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
