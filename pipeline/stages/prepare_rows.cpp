// Prepare rows: contacts and bodies into what the solver walks, in the order in which it walks.
#include "kernels/math/rotation.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solve/contact_rows.hpp"
#include "pipeline/stages.hpp"

#include <algorithm>

namespace throng {

namespace {

constexpr std::size_t kBodies = 256;  // a block: some 20 microseconds of work
constexpr std::size_t kRows = 16;     // blocks of 16 rows

// Contacts are damped far beyond critical: they give way slowly and do not ring.
constexpr double kDampingRatio = 20;
// Stiffness as a share of the substep's rate, by the number of points: the most that comes to rest.
// Points share a body's mass among them, so the more there are the less each bears.
constexpr double kRate[4] = {0.5, 0.3, 0.25, 0.25};
// Overlap from which a contact stops giving way, as a share of the smaller body's half extent.
constexpr double kDeep = 0.005;
// Plain Gauss-Seidel: the share of the overlap taken away each substep.
constexpr double kBaumgarte = 0.2;

template <class Real>
void seat_body(std::uint32_t body,
               const Poses& poses,
               const Velocities& velocities,
               const Masses& masses,
               const BodyStates& states,
               SolverBody<Real>& seat)
{
    seat = {};
    seat.drift[7] = 1;
    if (body == kNobody) return;
    for (int k = 0; k < 3; ++k) {
        seat.motion[k] = static_cast<Real>(velocities.linear[body][k]);
        seat.motion[4 + k] = static_cast<Real>(velocities.angular[body][k]);
    }
    if (!states.dynamic(body)) return;
    const Sym3 six = in_world_axes(masses.inverse_inertia[body], poses.orientation[body]);
    const double numbers[7] = {
        masses.inverse_mass[body], six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
    for (int k = 0; k < 7; ++k) seat.inertia[k] = static_cast<Real>(numbers[k]);
}

template <class Real>
void seat_inertia(std::uint32_t body,
                  const Poses& poses,
                  const Masses& masses,
                  const BodyStates& states,
                  SpinInertia<Real>& seat)
{
    seat = {};
    if (body == kNobody || !states.dynamic(body) || masses.spins_unevenly[body] == 0) return;
    const Sym3 six = in_world_axes(masses.inertia[body], poses.orientation[body]);
    const double trace = six.xx + six.yy + six.zz;
    const double numbers[6] = {six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
    for (int k = 0; k < 6; ++k) seat.share[k] = static_cast<Real>(numbers[k] / trace);
    seat.share[6] = 1;
}

// The softness of contacts by their number of points, less one.
template <class Real>
std::array<Softness<Real>, 4> softness_of(const Conditions& conditions)
{
    const Settings& settings = conditions.settings;
    const double h = conditions.substep();
    std::array<Softness<Real>, 4> terms;
    for (std::size_t points = 0; points < terms.size(); ++points) {
        const double share = settings.contact_rate > 0 ? settings.contact_rate : kRate[points];
        const double rate = settings.contact_hertz > 0 ? settings.contact_hertz : share / h;
        terms[points] = settings.solver == Solver::pgs
            ? Softness<Real>{static_cast<Real>(kBaumgarte / h), Real(0)}
            : softness<Real>(rate, kDampingRatio, h);
    }
    return terms;
}

}  // namespace

template <class Real>
void prepare_rows(const Conditions& conditions,
                  const Layout& layout,
                  const ActiveContacts& active,
                  const ConvexContacts<Real>& convex,
                  const MeshContacts<Real>& meshes,
                  const Poses& poses,
                  const Velocities& velocities,
                  const Masses& masses,
                  const BodyStates& states,
                  Rows<Real>& rows)
{
    const bool gyroscopic = conditions.has(Effect::gyroscopic);
    rows.bodies.resize(layout.body_of_slot.size());
    rows.inertias.resize(gyroscopic ? rows.bodies.size() : 0);
    for_each_block(rows.bodies.size(), kBodies,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                       for (std::size_t i = begin; i < end; ++i) {
                           const std::uint32_t body = layout.body_of_slot[i];
                           seat_body(body, poses, velocities, masses, states, rows.bodies[i]);
                           if (gyroscopic)
                               seat_inertia(body, poses, masses, states, rows.inertias[i]);
                       }
                   });

    const std::size_t blocks = layout.points.size();
    rows.blocks.resize(blocks);
    std::uint32_t points = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
        rows.blocks[i].first_point = points;
        points += layout.points[i];
    }
    rows.points.resize(points);
    rows.bounces.resize(conditions.has(Effect::restitution) ? points : 0);
    rows.rollings.resize(conditions.has(Effect::rolling_friction) ? blocks : 0);
    const RowsView<Real> view = RowsView<Real>::of(rows);

    const std::array<Softness<Real>, 4> softness = softness_of<Real>(conditions);
    const SolveKernels<Real>& kernels = solve_kernels<Real>();
    const bool turns = conditions.has(Effect::rotation);
    const auto fill = [&](std::size_t at, LooseBlock<Real>& loose) {
        ContactBlock<Real>& block = rows.blocks[at];
        block.points = layout.points[at];
        block.writes_a = block.writes_b = 0;
        for (std::size_t lane = 0; lane < kBlock; ++lane) {
            const std::size_t place = at * kBlock + lane;
            const int lane_at = static_cast<int>(lane);
            block.a[lane] = layout.slot_a[place];
            block.b[lane] = layout.slot_b[place];
            const std::uint32_t entry = layout.lanes[place].entry;
            if (entry == LaneSource{}.entry) {
                loosen_nothing(block.points, lane_at, loose);
                continue;
            }
            const auto& source = active.entries[entry];
            const auto writes = [&](std::uint32_t body) {
                return states.dynamic(body) && states.moves(body) ? 1u << lane : 0u;
            };
            block.writes_a = static_cast<std::uint16_t>(block.writes_a | writes(source.body_a));
            block.writes_b = static_cast<std::uint16_t>(block.writes_b | writes(source.body_b));
            const Contact<Real>& contact =
                source.on_mesh ? meshes.entries[source.slot].contact : convex.contacts[source.slot];
            loosen(contact,
                   {Real(source.friction), Real(source.restitution), Real(source.rolling_friction),
                    softness[source.points - 1u], static_cast<Real>(kDeep * double{source.extent})},
                   block.points, lane_at, loose);
        }
        kernels.prepare(loose, at, view, turns);
    };
    for_each_block(blocks, kRows, [&](std::size_t begin, std::size_t end, std::size_t) {
        LooseBlock<Real> loose;
        for (std::size_t i = begin; i < end; ++i) fill(i, loose);
    });
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void prepare_rows<Real>(const Conditions&, const Layout&, const ActiveContacts&,      \
                                     const ConvexContacts<Real>&, const MeshContacts<Real>&,       \
                                     const Poses&, const Velocities&, const Masses&,               \
                                     const BodyStates&, Rows<Real>&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
