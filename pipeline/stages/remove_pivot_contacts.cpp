// Remove pivot contacts: what a body stands on next to its pivot is borne by the pivot.
//
// There it neither gives way nor comes nearer, however it turns: no impulse parts the two, and what
// separation is told is rounding. Asked to part all the same, a top on its tip is spun without end.
#include "kernels/parallel/blocks.hpp"
#include "pipeline/step/stages.hpp"

#include <cmath>
#include <limits>

namespace throng {

namespace {

// Least lever arm about a pivot by which a body gives way, as a share of its radius of gyration: a
// hundred times what places are rounded to, and a point of the body to the eye.
constexpr double kLeastOfSize = 1e-3;
constexpr std::size_t kGrain = 2048;  // pairs a block: some 10 microseconds of work

// One call of the stage.
template <class Real>
class Removal {
public:
    Removal(const Pairs& pairs,
            const Colliders& colliders,
            const Forces& forces,
            const Masses& masses)
        : pairs_(pairs), colliders_(colliders), forces_(forces), masses_(masses)
    { }

    void visit(std::size_t pair, Contact<Real>& contact) const
    {
        const std::uint32_t a = colliders_.body[first_of(pairs_.keys[pair])],
                            b = colliders_.body[second_of(pairs_.keys[pair])];
        if (!forces_.on_pivot(a) && !forces_.on_pivot(b)) return;
        if (masses_.inverse_mass[a] > 0 || masses_.inverse_mass[b] > 0) return;
        const double least_a = least_lever_arm(a), least_b = least_lever_arm(b);
        const Vec3 normal = contact.normal.template cast<double>();
        const auto is_short = [&](const Vec3T<Real>& arm, double least) {
            return arm.template cast<double>().cross(normal).squaredNorm() < least * least;
        };
        int kept = 0;
        for (int k = 0; k < contact.count; ++k) {
            const auto& point = contact.points[static_cast<std::size_t>(k)];
            if (is_short(point.anchor_a, least_a) && is_short(contact.anchor_b(k), least_b))
                continue;
            contact.points[static_cast<std::size_t>(kept++)] = point;
        }
        contact.count = kept;
    }

private:
    // m; of who does not turn, any lever arm is short.
    double least_lever_arm(std::uint32_t body) const
    {
        const Sym3& inverse = masses_.inverse_inertia[body];
        if (inverse == Sym3{}) return std::numeric_limits<double>::infinity();
        if (!forces_.on_pivot(body)) return 0;
        const Sym3& inertia = masses_.inertia[body];
        return kLeastOfSize
            * std::sqrt((inertia.xx + inertia.yy + inertia.zz) / (2 * masses_.mass[body]));
    }

    const Pairs& pairs_;
    const Colliders& colliders_;
    const Forces& forces_;
    const Masses& masses_;
};

}  // namespace

template <class Real>
void remove_pivot_contacts(const Pairs& pairs,
                           const Colliders& colliders,
                           const Forces& forces,
                           const Masses& masses,
                           ConvexContacts<Real>& convex,
                           MeshContacts<Real>& meshes,
                           SolidContacts<Real>& solids)
{
    const Removal<Real> removal(pairs, colliders, forces, masses);
    for_each_block(convex.of_pair.size(), kGrain, [&](auto begin, auto end, auto) {
        for (std::size_t i = begin; i < end; ++i)
            if (const std::uint32_t place = convex.of_pair[i].contact; place != PairState::kApart)
                removal.visit(i, convex.contacts[place]);
    });
    for (auto& entry : meshes.entries) removal.visit(entry.pair, entry.contact);
    for (auto& entry : solids.entries) removal.visit(entry.pair, entry.contact);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void remove_pivot_contacts<Real>(const Pairs&, const Colliders&, const Forces&,       \
                                              const Masses&, ConvexContacts<Real>&,                \
                                              MeshContacts<Real>&, SolidContacts<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
