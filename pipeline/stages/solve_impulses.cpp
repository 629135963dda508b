// Solve impulses: rows into impulses, velocities and poses, substep by substep.
//
// A batch of small islands is one task that goes through all substeps while its rows stay in cache.
// A big island goes phase by phase, the blocks of each color shared among the threads. Either way
// the order within an island is that of its colors, which ids alone decide.
#include "kernels/math/rotation.hpp"
#include "kernels/motion/solver_bodies.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solve/contact_rows.hpp"
#include "kernels/solve/sweep.hpp"
#include "pipeline/stages.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kBlocks = 16;   // of 16 contacts a task: some 10 microseconds
constexpr std::size_t kBodies = 512;  // a task

// Sweeps over the points of a contact in one visit: with two, contacts of four points bear half as
// much again before they stop coming to rest.
constexpr int kNormalSweeps = 2;

// Relaxing visits a substep. What pushing leaves behind shakes tall piles: a second visit takes a
// tenth of the step's time and leaves a pyramid of 10,000 with a twentieth of the energy.
constexpr int kRelaxVisits = 2;

constexpr InnerRow kSolveTable[] = {
    {"add_gravity", {Effect::gravity}, "each substep"},
    {"turn_gyroscopic", {Effect::gyroscopic}, "each substep"},
    {"warm_start", {Effect::contact}, "each substep"},
    {"push_contacts", {Effect::contact}, "each visit"},
    {"hold_friction", {Effect::friction}, "each visit", true},
    {"resist_rolling", {Effect::rolling_friction}, "each visit", true},
    {"move_bodies", {Effect::motion}, "each substep"},
    {"turn_bodies", {Effect::rotation}, "each substep"},
    {"relax_contacts", {Effect::contact}, "each substep"},
    {"bounce", {Effect::restitution}, "after the last substep"},
};

template <class Real>
class Task {
public:
    Task(const Conditions& conditions,
         const Layout& layout,
         const Masses& masses,
         const Poses& poses,
         const Batch& batch,
         Rows<Real>& rows)
        : conditions_(conditions), layout_(layout), masses_(masses), poses_(poses), batch_(batch),
          rows_(rows), kernels_(solve_kernels<Real>()), substep_(conditions.substep())
    {
        visit_.inverse_substep = static_cast<Real>(1 / substep_);
        visit_.push_limit = static_cast<Real>(conditions.settings.push_limit);
        visit_.turns = conditions.has(Effect::rotation);
        visit_.rolls = conditions.has(Effect::rolling_friction);
        visit_.grips = conditions.has(Effect::friction) || visit_.rolls;
        visit_.normal_sweeps = kNormalSweeps;
    }

    void run()
    {
        const bool pgs = conditions_.settings.solver == Solver::pgs;
        const int visits = conditions_.settings.iterations > 0 ? conditions_.settings.iterations
            : pgs                                              ? 20
                                                               : 1;
        for (int step = 0; step < conditions_.settings.substeps; ++step) {
            if (conditions_.has(Effect::gravity)) add_gravity();
            if (conditions_.has(Effect::gyroscopic)) turn_gyroscopic();
            for_bodies([](auto bodies, std::size_t) { stop_runaways(bodies); });
            warm_start();
            for (int visit = 0; visit < visits; ++visit) sweep(true);
            move();
            if (conditions_.has(Effect::rotation)) turn();
            if (pgs) continue;
            for (int visit = 0; visit < kRelaxVisits; ++visit) sweep(false);
        }
        if (conditions_.has(Effect::restitution)) bounce();
    }

private:
    template <class Body>
    void for_bodies(Body body)
    {
        const auto all = std::span(rows_.bodies)
                             .subspan(batch_.first_body + 1, batch_.dynamic + batch_.kinematic);
        if (!batch_.wide) {
            body(all, std::size_t{batch_.first_body} + 1);
            return;
        }
        for_each_block(all.size(), kBodies, [&](std::size_t begin, std::size_t end, std::size_t) {
            body(all.subspan(begin, end - begin), batch_.first_body + 1 + begin);
        });
    }

    template <class Body>
    void for_colors(Body body)
    {
        for (std::uint32_t i = 0; i < batch_.colors; ++i) {
            const Color& color = layout_.colors[batch_.first_color + i];
            ContactBlock<Real>* const first = rows_.blocks.data() + color.first;
            if (!batch_.wide || color.serial || color.count <= 2 * kBlocks) {
                body(first, color.count);
                continue;
            }
            for_each_block(color.count, kBlocks,
                           [&](std::size_t begin, std::size_t end, std::size_t) {
                               body(first + begin, end - begin);
                           });
        }
    }

    void add_gravity()
    {
        const Vec3 change = conditions_.gravity * substep_;
        for_bodies([&](auto bodies, std::size_t) { add_velocity(bodies, change); });
    }

    void turn_gyroscopic()
    {
        const Gyroscopic how = conditions_.settings.gyroscopic;
        for_bodies([&](std::span<SolverBody<Real>> bodies, std::size_t first) {
            for (std::size_t i = 0; i < bodies.size(); ++i) {
                const std::uint32_t body = layout_.body_of_slot[first + i];
                if (masses_.spins_unevenly[body] == 0) continue;
                Real* const w = bodies[i].motion + 4;
                const Vec3 before(double{w[0]}, double{w[1]}, double{w[2]});
                const Quat orientation = turn_of(bodies[i]) * poses_.orientation[body];
                const Vec3 after = how == Gyroscopic::implicit
                    ? after_gyroscopic_torque(before, masses_.inertia[body], orientation, substep_)
                    : after_explicit_gyroscopic_torque(before, masses_.inertia[body], orientation,
                                                       substep_);
                for (int k = 0; k < 3; ++k) w[k] = static_cast<Real>(after[k]);
            }
        });
    }

    void warm_start()
    {
        for_colors([&](ContactBlock<Real>* blocks, std::size_t count) {
            kernels_.warm_start(blocks, count, rows_.bodies.data(), visit_);
        });
    }

    void sweep(bool push)
    {
        Visit<Real> visit = visit_;
        visit.push = push;
        for_colors([&](ContactBlock<Real>* blocks, std::size_t count) {
            kernels_.sweep(blocks, count, rows_.bodies.data(), visit);
        });
    }

    void move()
    {
        for_bodies(
            [&](auto bodies, std::size_t) { move_bodies(bodies, static_cast<Real>(substep_)); });
    }

    void turn()
    {
        for_bodies(
            [&](auto bodies, std::size_t) { turn_bodies(bodies, static_cast<Real>(substep_)); });
    }

    // Slower than what gravity gives in two steps is resting, not bouncing.
    void bounce()
    {
        const auto threshold =
            static_cast<Real>(2 * conditions_.gravity.norm() * conditions_.settings.dt);
        for_colors([&](ContactBlock<Real>* blocks, std::size_t count) {
            kernels_.restitute(blocks, count, rows_.bodies.data(), threshold, visit_);
        });
    }

    const Conditions& conditions_;
    const Layout& layout_;
    const Masses& masses_;
    const Poses& poses_;
    const Batch& batch_;
    Rows<Real>& rows_;
    const SolveKernels<Real>& kernels_;
    double substep_;
    Visit<Real> visit_;
};

// Gives one body its new state. False, and the body as it was, when that is not sound.
template <class Real>
bool take_back(const SolverBody<Real>& seat,
               std::uint32_t body,
               Poses& poses,
               Velocities& velocities)
{
    const Vec3 moved(double{seat.drift[0]}, double{seat.drift[1]}, double{seat.drift[2]});
    const Vec3 v(double{seat.motion[0]}, double{seat.motion[1]}, double{seat.motion[2]});
    const Vec3 w(double{seat.motion[4]}, double{seat.motion[5]}, double{seat.motion[6]});
    const Vec3 position = poses.position[body] + moved;
    Quat orientation = turn_of(seat) * poses.orientation[body];
    const double length = std::sqrt(orientation.squaredNorm());
    orientation.coeffs() /= length;
    if (ran_away(seat) || !holdable(position) || !orientation.coeffs().allFinite() || !holdable(v)
        || !holdable(w))
        return false;
    poses.position[body] = position;
    poses.orientation[body] = orientation;
    velocities.linear[body] = v;
    velocities.angular[body] = w;
    return true;
}

}  // namespace

std::span<const InnerRow> solve_table() { return kSolveTable; }

template <class Real>
void solve_impulses(const Conditions& conditions,
                    const Layout& layout,
                    const ActiveContacts& active,
                    const Masses& masses,
                    Rows<Real>& rows,
                    ConvexContacts<Real>& convex,
                    MeshContacts<Real>& meshes,
                    Poses& poses,
                    Velocities& velocities,
                    Trouble& trouble)
{
    trouble.quarantined.clear();
    trouble.of_block.resize(layout.batches.size());
    const auto solve = [&](const Batch& batch) {
        Task<Real>(conditions, layout, masses, poses, batch, rows).run();
    };
    // Big islands use all threads themselves, so they go one after another.
    for (const Batch& batch : layout.batches)
        if (batch.wide) solve(batch);
    for_each_block(layout.batches.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (!layout.batches[i].wide) solve(layout.batches[i]);
    });

    for_each_block(layout.batches.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            trouble.of_block[i].clear();
            const Batch& batch = layout.batches[i];
            for (std::size_t k = 1; k <= batch.dynamic; ++k) {
                const std::size_t slot = batch.first_body + k;
                const std::uint32_t body = layout.body_of_slot[slot];
                if (!take_back(rows.bodies[slot], body, poses, velocities))
                    trouble.of_block[i].push_back(body);
            }
        }
    });
    for (const auto& found : trouble.of_block)
        trouble.quarantined.insert(trouble.quarantined.end(), found.begin(), found.end());

    for_each_block(layout.lanes.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            if (layout.lanes[i].entry == LaneSource{}.entry) continue;
            const auto& source = active.entries[layout.lanes[i].entry];
            Contact<Real>& contact =
                source.on_mesh ? meshes.entries[source.slot].contact : convex.of_pair[source.slot];
            store_impulses(rows.blocks[i / kBlock], static_cast<int>(i % kBlock), contact);
        }
    });
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_impulses<Real>(const Conditions&, const Layout&, const ActiveContacts&,    \
                                       const Masses&, Rows<Real>&, ConvexContacts<Real>&,          \
                                       MeshContacts<Real>&, Poses&, Velocities&, Trouble&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
