// Solve impulses: contacts into rows, rows into impulses, velocities and poses, substep by substep.
//
// A batch of small islands is one task that goes through all substeps while its rows stay in cache.
// A big island goes slice by slice, each pass a slice behind the one before it: what a pass has
// brought into cache serves the passes that follow, and threads work on slices that share no body.
// Either way the order within an island is that of its slices and their colors, which ids and
// positions alone decide.
#include "kernels/motion/solver_bodies.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solve/sweep.hpp"
#include "pipeline/stages.hpp"
#include "pipeline/stages/row_maker.hpp"

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
    {"make_rows", {Effect::contact}, "before the first substep"},
    {"add_gravity", {Effect::gravity}, "each substep"},
    {"turn_gyroscopic", {Effect::gyroscopic}, "each substep"},
    {"warm_start", {Effect::contact}, "in the first substep"},
    {"push_contacts", {Effect::contact}, "each visit"},
    {"hold_friction", {Effect::friction}, "each visit", true},
    {"resist_rolling", {Effect::rolling_friction}, "each visit", true},
    {"move_bodies", {Effect::motion}, "each substep"},
    {"turn_bodies", {Effect::rotation}, "each substep"},
    {"relax_contacts", {Effect::contact}, "each substep"},
    {"bounce", {Effect::restitution}, "after the last substep"},
};

// One pass over the contacts or the bodies of a slice.
struct Pass {
    enum class Kind : std::uint8_t {
        prepare,
        begin,
        warm_start,
        push,
        advance,
        relax,
        bounce,
        store
    } kind;
    bool first = false;     // of the step
    bool backward = false;  // from the last slice and color to the first
};

template <class Real>
class Task {
public:
    Task(const Conditions& conditions,
         const Layout& layout,
         const Batch& batch,
         const RowMaker<Real>& maker,
         Rows<Real>& rows)
        : conditions_(conditions), layout_(layout), batch_(batch), maker_(maker), rows_(rows),
          view_(RowsView<Real>::of(rows)), kernels_(solve_kernels<Real>()),
          time_(static_cast<Real>(conditions.substep()))
    {
        visit_.inverse_substep = static_cast<Real>(1 / conditions.substep());
        visit_.push_limit = static_cast<Real>(conditions.settings.push_limit);
        visit_.turns = conditions.has(Effect::rotation);
        visit_.rolls = conditions.has(Effect::rolling_friction);
        visit_.grips = conditions.has(Effect::friction) || visit_.rolls;
        visit_.normal_sweeps = kNormalSweeps;
        on_faces_ = 2 * batch.on_faces > batch.contacts;
    }

    void run()
    {
        using enum Pass::Kind;
        const bool pgs = conditions_.settings.solver == Solver::pgs;
        const int pushes = conditions_.settings.iterations > 0 ? conditions_.settings.iterations
            : pgs                                              ? 20
                                                               : 1;
        const int relaxes = pgs ? 0 : on_faces_ ? kInStructures : kInHeaps;
        add_pass({prepare});
        for (int step = 0; step < conditions_.settings.substeps; ++step) {
            // In towers and structures there in one substep and back in the next: who comes first
            // takes a little more of a load than its share, which would lean a whole wall to one
            // side. Heaps and crowds, which have no side, come to rest sooner in one order.
            const bool backward = on_faces_ && step % 2 == 1;
            const auto add = [&](Pass::Kind kind) { add_pass({kind, step == 0, backward}); };
            add(begin);
            if (step == 0) add(warm_start);
            for (int i = 0; i < pushes; ++i) add(push);
            add(advance);
            for (int i = 0; i < relaxes; ++i) add(relax);
            if (on_faces_ || !window_fits()) run_passes();
        }
        if (conditions_.has(Effect::restitution)) add_pass({bounce});
        add_pass({store});
        run_passes();
    }

private:
    // A single slice needs no waiting, so it has its passes at once.
    void add_pass(const Pass& pass)
    {
        if (batch_.slices > 1)
            passes_.push_back(pass);
        else
            run_pass(pass, layout_.slices[batch_.first_slice], batch_.wide);
    }

    void run_passes()
    {
        if (passes_.empty()) return;
        rows_.wave.run(passes_.size(), batch_.slices, [&](std::size_t pass, std::size_t place) {
            const std::size_t at = passes_[pass].backward ? batch_.slices - 1 - place : place;
            run_pass(passes_[pass], layout_.slices[batch_.first_slice + at], false);
        });
        passes_.clear();
    }

    // As many slices as there are passes are at work: their rows should fit into the cache.
    bool window_fits() const
    {
        constexpr std::size_t kWindow = 8 << 20, kContact = 300;  // bytes
        return passes_.size() * (batch_.contacts / batch_.slices) * kContact < kWindow;
    }

    void run_pass(const Pass& pass, const Slice& slice, bool shared)
    {
        switch (pass.kind) {
        case Pass::Kind::prepare:
            return for_blocks(slice, shared,
                              [&](std::size_t from, std::size_t end) { maker_.make(from, end); });
        case Pass::Kind::store:
            return for_blocks(slice, shared,
                              [&](std::size_t from, std::size_t end) { maker_.store(from, end); });
        case Pass::Kind::begin:
            return begin_substep(slice, shared, pass.first);
        case Pass::Kind::advance:
            return advance(slice, shared);
        case Pass::Kind::warm_start:
            return for_colors(slice, shared, pass.backward, [&](std::size_t from, std::size_t end) {
                kernels_.warm_start(view_, from, end, visit_);
            });
        case Pass::Kind::bounce:
            return bounce(slice, shared);
        default:
            Visit<Real> visit = visit_;
            visit.push = pass.kind == Pass::Kind::push;
            for_colors(slice, shared, pass.backward, [&](std::size_t from, std::size_t end) {
                kernels_.sweep(view_, from, end, visit);
            });
        }
    }

    // Calls body(first, count) for what moves: dynamic and kinematic bodies.
    template <class Body>
    void for_bodies(const Slice& slice, bool shared, Body body)
    {
        if (shared)
            for_each_block(slice.dynamic, kBodies,
                           [&](std::size_t begin, std::size_t end, std::size_t) {
                               body(slice.first_body + begin, end - begin);
                           });
        else
            body(slice.first_body, slice.dynamic);
        if (slice.kinematic > 0) body(slice.first_visitor, slice.kinematic);
    }

    // Calls body(begin, end) for all blocks.
    template <class Body>
    void for_blocks(const Slice& slice, bool shared, Body body)
    {
        const Color& last = layout_.colors[slice.first_color + slice.colors - 1];
        const std::size_t first = layout_.colors[slice.first_color].first;
        const std::size_t count = last.first + last.count - first;
        if (shared)
            for_each_block(count, kBlocks, [&](std::size_t begin, std::size_t end, std::size_t) {
                body(first + begin, first + end);
            });
        else
            body(first, first + count);
    }

    // Calls body(begin, end) for the blocks of one color after another.
    template <class Body>
    void for_colors(const Slice& slice, bool shared, bool backward, Body body)
    {
        for (std::uint32_t i = 0; i < slice.colors; ++i) {
            const std::uint32_t place = backward ? slice.colors - 1 - i : i;
            const Color& color = layout_.colors[slice.first_color + place];
            if (!shared || color.serial || color.count <= 2 * kBlocks) {
                body(color.first, color.first + color.count);
                continue;
            }
            for_each_block(color.count, kBlocks,
                           [&](std::size_t begin, std::size_t end, std::size_t) {
                               body(color.first + begin, color.first + end);
                           });
        }
    }

    void begin_substep(const Slice& slice, bool shared, bool first)
    {
        Substep<Real> substep;
        substep.time = time_;
        substep.first = first;
        if (conditions_.has(Effect::gravity)) {
            const Vec3 change = conditions_.gravity * conditions_.substep();
            for (int k = 0; k < 3; ++k) substep.gravity[k] = static_cast<Real>(change[k]);
        }
        if (conditions_.has(Effect::gyroscopic))
            substep.gyroscopic = conditions_.settings.gyroscopic == Gyroscopic::implicit
                ? Substep<Real>::Gyroscopic::implicit
                : Substep<Real>::Gyroscopic::direct;
        for_bodies(slice, shared, [&](std::size_t at, std::size_t count) {
            kernels_.begin_substep(rows_.bodies.data() + at,
                                   rows_.inertias.empty() ? nullptr : rows_.inertias.data() + at,
                                   count, substep);
        });
    }

    void advance(const Slice& slice, bool shared)
    {
        for_bodies(slice, shared, [&](std::size_t at, std::size_t count) {
            const auto bodies = std::span(rows_.bodies).subspan(at, count);
            if (kernels_.advance(bodies.data(), count, time_, visit_.turns) > 0)
                turn_fast(bodies, time_);
        });
    }

    // Slower than what gravity gives in two steps is resting, not bouncing.
    void bounce(const Slice& slice, bool shared)
    {
        const auto threshold =
            static_cast<Real>(2 * conditions_.gravity.norm() * conditions_.settings.dt);
        for_colors(slice, shared, false, [&](std::size_t begin, std::size_t end) {
            kernels_.restitute(view_, begin, end, threshold, visit_);
        });
    }

    const Conditions& conditions_;
    const Layout& layout_;
    const Batch& batch_;
    const RowMaker<Real>& maker_;
    Rows<Real>& rows_;
    RowsView<Real> view_;
    const SolveKernels<Real>& kernels_;
    Real time_;  // s, of a substep
    Visit<Real> visit_;
    bool on_faces_ = false;
    std::vector<Pass> passes_;  // that wait to be run
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
                    const BodyStates& states,
                    Rows<Real>& rows,
                    ConvexContacts<Real>& convex,
                    MeshContacts<Real>& meshes,
                    Poses& poses,
                    Velocities& velocities,
                    Trouble& trouble)
{
    trouble.quarantined.clear();
    const RowMaker<Real> maker(conditions, layout, active, states, convex, meshes, rows);
    const auto solve = [&](const Batch& batch) {
        Task<Real>(conditions, layout, batch, maker, rows).run();
    };
    // Big islands use all threads themselves, so they go one after another.
    for (const Batch& batch : layout.batches)
        if (batch.wide) solve(batch);
    for_each_block(layout.batches.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (!layout.batches[i].wide) solve(layout.batches[i]);
    });

    // In order of bodies, of which many arrays are written.
    const std::size_t bodies = layout.slot.size();
    trouble.of_block.start(block_count(bodies, kBodies));
    for_each_block(bodies, kBodies, [&](std::size_t begin, std::size_t end, std::size_t block) {
        for (auto body = static_cast<std::uint32_t>(begin); body < end; ++body) {
            const std::uint32_t slot = layout.slot[body];
            if (slot == Layout::kNoSlot) continue;
            if (!take_back(rows.bodies[slot], body, poses, velocities))
                trouble.of_block[block].push_back(body);
        }
    });
    trouble.of_block.append_to(trouble.quarantined);
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_impulses<Real>(const Conditions&, const Layout&, const ActiveContacts&,    \
                                       const BodyStates&, Rows<Real>&, ConvexContacts<Real>&,      \
                                       MeshContacts<Real>&, Poses&, Velocities&, Trouble&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
