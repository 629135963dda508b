// Convex pairs: any two convex shapes, by their cores.
//
// What has no closed form comes here: cylinders against all but spheres, and capsules that meet a
// hull elsewhere than with an end over a face. In double whatever the number type: the search wants
// it, and it costs the same.
#include "narrowphase/convex/contact_axis.hpp"
#include "narrowphase/convex/pair_functions.hpp"
#include "narrowphase/convex/support_contacts.hpp"

namespace throng {

template <class Real>
void convex_convex(const PairInput<Real>& in, PairCache&, LocalManifold<Real>& out)
{
    const auto& [shapes, a, b, b_in_a, speculative_margin] = in;
    out.count = 0;
    const Pose pose = {b_in_a.position.template cast<double>(),
                       b_in_a.orientation.template cast<double>().normalized()};
    const ConvexCorePair pair(shapes, a, b, pose);
    const double limit =
        static_cast<double>(speculative_margin) + pair.a.convex_radius + pair.b.convex_radius;
    ContactAxis axis;
    if (!contact_axis(pair, limit, axis) || axis.separation > limit) return;
    LocalManifold<double> exact;
    fill_points(pair, axis, static_cast<double>(speculative_margin), exact);

    out = exact.cast<Real>();
}

THRONG_PAIR_INSTANCES(convex_convex)

}  // namespace throng
