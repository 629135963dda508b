// Solve impulses: rows into impulses, velocities and poses, substep by substep.
//
// A batch of small islands is one task that goes through all substeps while its rows stay in cache.
// A big island goes phase by phase, the blocks of each color shared among the threads. Either way
// the order within an island is that of its colors, which ids alone decide.
#include "kernels/motion/solver_bodies.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solve/contact_rows.hpp"
#include "kernels/solve/sweep.hpp"
#include "pipeline/stages.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kBlocks = 16;   // of 16 contacts a task: some 3 microseconds
constexpr std::size_t kBodies = 512;  // a task

// Sweeps over the points of a contact in one visit: with two, contacts of four points bear half as
// much again before they stop coming to rest.
constexpr int kNormalSweeps = 2;

// Relaxing visits a substep, by what there is to hold up. One quietens a heap. Where most bodies
// lie on one another by their faces, as in towers and walls, a second one leaves a hundredth of the
// energy.
constexpr int kInHeaps = 1, kInStructures = 2;

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
    Task(const Conditions& conditions, const Layout& layout, const Batch& batch, Rows<Real>& rows)
        : conditions_(conditions), layout_(layout), batch_(batch), rows_(rows),
          view_(RowsView<Real>::of(rows)), kernels_(solve_kernels<Real>()),
          substep_(conditions.substep())
    {
        visit_.inverse_substep = static_cast<Real>(1 / substep_);
        visit_.push_limit = static_cast<Real>(conditions.settings.push_limit);
        visit_.turns = conditions.has(Effect::rotation);
        visit_.rolls = conditions.has(Effect::rolling_friction);
        visit_.grips = conditions.has(Effect::friction) || visit_.rolls;
        visit_.normal_sweeps = kNormalSweeps;
        if (2 * batch.on_faces > batch.contacts) relax_visits_ = kInStructures;
    }

    void run()
    {
        const bool pgs = conditions_.settings.solver == Solver::pgs;
        const int visits = conditions_.settings.iterations > 0 ? conditions_.settings.iterations
            : pgs                                              ? 20
                                                               : 1;
        for (int step = 0; step < conditions_.settings.substeps; ++step) {
            backward_ = relax_visits_ > kInHeaps && step % 2 == 1;
            begin_substep(step == 0);
            if (step == 0) warm_start();
            for (int visit = 0; visit < visits; ++visit) sweep(true);
            advance();
            if (pgs) continue;
            for (int visit = 0; visit < relax_visits_; ++visit) sweep(false);
        }
        if (conditions_.has(Effect::restitution)) bounce();
    }

private:
    // Calls body(first, count) for what moves: dynamic and kinematic bodies.
    template <class Body>
    void for_bodies(Body body)
    {
        const std::size_t first = batch_.first_body + 1u, count = batch_.dynamic + batch_.kinematic;
        if (!batch_.wide) {
            body(first, count);
            return;
        }
        for_each_block(count, kBodies, [&](std::size_t begin, std::size_t end, std::size_t) {
            body(first + begin, end - begin);
        });
    }

    // Calls body(begin, end) for the blocks of one color after another. In towers and structures
    // there in one substep and back in the next: who comes first takes a little more of a load than
    // its share, which would lean a whole wall to one side. Heaps and crowds, which have no side,
    // come to rest sooner in one order.
    template <class Body>
    void for_colors(Body body)
    {
        for (std::uint32_t i = 0; i < batch_.colors; ++i) {
            const std::uint32_t place = backward_ ? batch_.colors - 1 - i : i;
            const Color& color = layout_.colors[batch_.first_color + place];
            if (!batch_.wide || color.serial || color.count <= 2 * kBlocks) {
                body(color.first, color.first + color.count);
                continue;
            }
            for_each_block(color.count, kBlocks,
                           [&](std::size_t begin, std::size_t end, std::size_t) {
                               body(color.first + begin, color.first + end);
                           });
        }
    }

    void begin_substep(bool first)
    {
        Substep<Real> substep;
        substep.time = static_cast<Real>(substep_);
        substep.first = first;
        if (conditions_.has(Effect::gravity)) {
            const Vec3 change = conditions_.gravity * substep_;
            for (int k = 0; k < 3; ++k) substep.gravity[k] = static_cast<Real>(change[k]);
        }
        if (conditions_.has(Effect::gyroscopic))
            substep.gyroscopic = conditions_.settings.gyroscopic == Gyroscopic::implicit
                ? Substep<Real>::Gyroscopic::implicit
                : Substep<Real>::Gyroscopic::direct;
        for_bodies([&](std::size_t at, std::size_t count) {
            kernels_.begin_substep(rows_.bodies.data() + at,
                                   rows_.inertias.empty() ? nullptr : rows_.inertias.data() + at,
                                   count, substep);
        });
    }

    void warm_start()
    {
        for_colors([&](std::size_t begin, std::size_t end) {
            kernels_.warm_start(view_, begin, end, visit_);
        });
    }

    void sweep(bool push)
    {
        Visit<Real> visit = visit_;
        visit.push = push;
        for_colors(
            [&](std::size_t begin, std::size_t end) { kernels_.sweep(view_, begin, end, visit); });
    }

    void advance()
    {
        const auto time = static_cast<Real>(substep_);
        for_bodies([&](std::size_t at, std::size_t count) {
            const auto bodies = std::span(rows_.bodies).subspan(at, count);
            if (kernels_.advance(bodies.data(), count, time, visit_.turns) > 0)
                turn_fast(bodies, time);
        });
    }

    // Slower than what gravity gives in two steps is resting, not bouncing.
    void bounce()
    {
        const auto threshold =
            static_cast<Real>(2 * conditions_.gravity.norm() * conditions_.settings.dt);
        for_colors([&](std::size_t begin, std::size_t end) {
            kernels_.restitute(view_, begin, end, threshold, visit_);
        });
    }

    const Conditions& conditions_;
    const Layout& layout_;
    const Batch& batch_;
    Rows<Real>& rows_;
    RowsView<Real> view_;
    const SolveKernels<Real>& kernels_;
    double substep_;
    Visit<Real> visit_;
    int relax_visits_ = kInHeaps;
    bool backward_ = false;
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
        Task<Real>(conditions, layout, batch, rows).run();
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

    const RowsView<Real> view = RowsView<Real>::of(rows);
    for_each_block(layout.lanes.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            if (layout.lanes[i].entry == LaneSource{}.entry) continue;
            const auto& source = active.entries[layout.lanes[i].entry];
            Contact<Real>& contact =
                source.on_mesh ? meshes.entries[source.slot].contact : convex.contacts[source.slot];
            store_impulses(view, i / kBlock, static_cast<int>(i % kBlock), contact);
        }
    });
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_impulses<Real>(const Conditions&, const Layout&, const ActiveContacts&,    \
                                       Rows<Real>&, ConvexContacts<Real>&, MeshContacts<Real>&,    \
                                       Poses&, Velocities&, Trouble&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
