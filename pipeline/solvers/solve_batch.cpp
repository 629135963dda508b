#include "pipeline/solvers/solve_batch.hpp"

#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/solver_bodies.hpp"
#include "kernels/solver/sweep.hpp"
#include "pipeline/forces/following_forces.hpp"
#include "pipeline/forces/spring_account.hpp"
#include "pipeline/solvers/parting.hpp"

#include <algorithm>
#include <atomic>
#include <optional>

namespace throng {

namespace {

constexpr std::size_t kBlocks = 16;   // of 16 contacts a task: some 3 microseconds
constexpr std::size_t kBodies = 512;  // a task

// Sweeps over the points of a contact in one visit. With two, contacts of four points bear half as
// much again before they stop coming to rest; to relax, one does as well.
constexpr int kPushSweeps = 2, kRelaxSweeps = 1;

constexpr int kInHeaps = 1, kInStructures = 2;  // see relax_visits()

// With finer substeps: contacts for each relaxing visit, and visits at most. With two visits
// columns of 50 to 100 boxes or balls that are dropped, each a little above the last, won up to 0.9
// of their energy of motion as they were escalated; with four, of 80 boxes still a tenth.
constexpr std::uint32_t kContactsARelax = 12, kMostRelaxes = 8;

// From where on a push is more than what a contact bears in a substep: friction that it made, left
// behind by a single visit, slows what rubs on its way down.
constexpr int kManySubsteps = 16;

// Where half of what springs and pivots do acts after bodies moved, it is for these visits alone to
// hold it up, through whatever a body lies on.
constexpr int kInLateForces = 6;

// Pushing visits a substep while bodies part. Each substep starts from nothing, and what is wedged
// in the middle of a crowd waits for those around it: by one visit a thousand boxes made at one
// point overlap by a seventh after 10 s. While each still lies in hundreds of others one visit is
// many pushes: so many a body will do.
constexpr std::size_t kPartingVisits = 12, kPartingPushes = 128;

// Rounds of impacts a substep at most. Each takes a blow on by one body at least, and mostly there
// are one or two; what still comes in after so many is stopped.
constexpr int kImpactRounds = 16;

// How often contacts and stiff springs take turns in a substep, at least: each sees what the other
// gave the time before.
constexpr int kSpringTurns = 4;

bool lies_on_faces(const Batch& batch) { return 2 * batch.on_faces > batch.contacts; }

// One pass over the contacts or the bodies of a slice.
struct Pass {
    enum class Kind : std::uint8_t {
        prepare,
        begin,
        warm_start,
        carry,
        push,
        advance,
        relax,
        bounce,
        store,
        keep,
        part,
        put_back
    } kind;
    bool first = false;     // of the step
    bool backward = false;  // from the last slice and color to the first
};

template <class Real>
class Task {
public:
    Task(const Conditions& conditions,
         const RigidFacts& facts,
         const Layout& layout,
         const Batch& batch,
         const RowMaker<Real>& maker,
         Rows<Real>& rows,
         Parting& parting)
        : conditions_(conditions), facts_(facts), layout_(layout), batch_(batch), maker_(maker),
          rows_(rows), parting_(parting), view_(RowsView<Real>::of(rows)),
          kernels_(solve_kernels<Real>()),
          warm_start_(conditions.grips_apart() ? kernels_.warm_start_grips : kernels_.warm_start),
          sweep_(conditions.grips_apart() ? kernels_.sweep_grips : kernels_.sweep),
          bounce_(conditions.grips_apart() ? kernels_.bounce_grips : kernels_.bounce),
          time_(static_cast<Real>(conditions.substep()))
    {
        visit_.inverse_substep = static_cast<Real>(1 / conditions.substep());
        visit_.push_limit = static_cast<Real>(conditions.settings.push_limit);
        visit_.turns = conditions.has(Effect::rotation) || conditions.grips_apart();
        visit_.rolls = conditions.has(Effect::rolling_friction);
        visit_.grips = conditions.has(Effect::friction) || visit_.rolls;
        visit_.at_points = conditions.settings.friction_at == FrictionAt::points;
        visit_.pyramid = conditions.settings.friction_cone == FrictionCone::pyramid;
        // Slower than what gravity gives in two steps is resting, not bouncing.
        const Settings& settings = conditions.settings;
        visit_.slow = static_cast<Real>(2 * conditions.gravity.norm() * settings.dt);
        for (int k = 0; k < 3; ++k)
            visit_.fall[k] = static_cast<Real>(conditions.gravity[k] * conditions.substep());
        on_faces_ = lies_on_faces(batch);
        find_following();
    }

    void run()
    {
        using enum Pass::Kind;
        const bool pgs = conditions_.settings.solver == Solver::pgs;
        // What is too great for the direct solver comes here, but the iterations are not meant for
        // it.
        const bool left = conditions_.settings.solver == Solver::direct;
        const int wanted = left ? 0 : conditions_.settings.iterations;
        const int pushes = wanted > 0 ? wanted : pgs ? 20 : 1;
        add_pass({prepare});
        const bool parts = parting_.some && find_parting();
        for (int step = 0; step < conditions_.settings.substeps; ++step) {
            // In towers and structures there in one substep and back in the next: who comes first
            // takes a little more of a load than its share, which would lean a whole wall to one
            // side. Heaps and crowds, which have no side, come to rest sooner in one order.
            const bool backward = on_faces_ && step % 2 == 1;
            const auto add = [&](Pass::Kind kind) { add_pass({kind, step == 0, backward}); };
            if (conditions_.has(Effect::restitution)) bounce_all();
            if (account_) open_account();
            add(begin);
            begin_following(step);
            if (step == 0) add(warm_start);
            if (account_) take_share();
            if (rows_.carry_turns) add(carry);
            const int relaxes = relax_visits(conditions_.settings, batch_);
            if (parts) {
                for (int i = 0; i < (pgs ? pushes : kInStructures); ++i) add(relax);
                add(keep);
                for (std::size_t i = 0; i < parting_visits(); ++i) add(part);
                note_spins();
                add(advance);
                add(put_back);
                end_following();
            } else {
                const bool turns = following_ && following_->stiff();
                for (int i = 0; i < (turns ? std::max(pushes, kSpringTurns) : pushes); ++i) {
                    add(push);
                    // The last word is theirs: what contacts say of a stiff one without its say
                    // would draw it out by more than anybody gave.
                    if (turns) turn_to_springs();
                }
                note_spins();
                add(advance);
                const bool late = end_following();
                const int visits = late ? std::max(relaxes, kInLateForces) : pgs ? 0 : relaxes;
                for (int i = 0; i < visits; ++i) add(relax);
                if (account_) close_account();
            }
            if (on_faces_ || !window_fits()) run_passes();
        }
        add_pass({store});
        run_passes();
    }

private:
    // Forces that change as the bodies of the batch go.
    void find_following()
    {
        const Forces& forces = facts_.forces;
        if (forces.springs.empty() && forces.hangs.empty() && forces.attractors.empty()
            && !forces.field)
            return;
        std::vector<std::uint32_t> bodies;
        for (std::uint32_t i = 0; i < batch_.slices; ++i) {
            const Slice& slice = layout_.slices[batch_.first_slice + i];
            for (std::uint32_t k = 0; k < slice.dynamic; ++k)
                bodies.push_back(layout_.body_of_slot[slice.first_body + k]);
        }
        following_.emplace(conditions_, facts_, bodies);
        if (following_->followers().empty()) following_.reset();
        if (following_ && following_->stiff())
            account_.emplace(layout_, batch_, facts_, *following_,
                             conditions_.gravity * conditions_.substep());
    }

    void open_account()
    {
        run_passes();
        account_->open(rows_);
    }

    void take_share()
    {
        run_passes();
        account_->take_share(rows_);
    }

    void close_account()
    {
        run_passes();
        account_->close(rows_);
    }

    // Followers as they are now, less what contacts gave in this substep if that is asked.
    void look_at_followers(bool without_contacts)
    {
        run_passes();
        for (Follower& follower : following_->followers()) {
            const SolverBody<Real>& seat = rows_.bodies[layout_.slot[follower.body]];
            const Real* const motion = without_contacts ? seat.free : seat.motion;
            const auto at = [](const Real* v) {
                return Vec3(double{v[0]}, double{v[1]}, double{v[2]});
            };
            follower.pose = {facts_.poses.position[follower.body] + at(seat.drift),
                             turn_of(seat) * facts_.poses.orientation[follower.body]};
            follower.velocity = at(motion);
            follower.spin = spin_axes(seat) * at(motion + 4);
            find_turn(seat, follower);
        }
    }

    // The axis of what is symmetric goes straight on, however fast it spins about that.
    void find_turn(const SolverBody<Real>& seat, Follower& follower) const
    {
        const auto at = static_cast<std::size_t>(&seat - rows_.bodies.data());
        const SpinInertia<Real>* const inertia = inertias_at(at);
        if (inertia == nullptr || !(inertia->share[6] > 0) || !(inertia->axis[3] > 0)) return;
        const Real* const axis = inertia->axis;
        follower.axis = spin_axes(seat) * Vec3(double{axis[0]}, double{axis[1]}, double{axis[2]});
        follower.carries = 0;
    }

    // Forces move a body with contacts and without, so that what contacts gave stays what it was.
    void move_followers()
    {
        for (const Follower& follower : following_->followers()) {
            SolverBody<Real>& seat = rows_.bodies[layout_.slot[follower.body]];
            const Vec3 spin = spin_axes(seat).conjugate() * follower.gained_spin;
            for (int k = 0; k < 3; ++k)
                for (Real* const motion : {seat.motion, seat.free}) {
                    motion[k] += static_cast<Real>(follower.gained[k]);
                    motion[4 + k] += static_cast<Real>(spin[k]);
                }
        }
    }

    void begin_following(int step)
    {
        if (!following_) return;
        look_at_followers(true);
        following_->begin(step * conditions_.substep(), conditions_.substep());
        move_followers();
    }

    void turn_to_springs()
    {
        look_at_followers(false);
        following_->again();
        move_followers();
    }

    // The axes that spins are in are told by where the axis of a body has come to since the step
    // began. Carried by its own turn in a substep, a spin comes out a little beside that, which
    // springs that gave half of what they give before it would not know of.
    void note_spins()
    {
        if (!following_ || !following_->stiff()) return;
        look_at_followers(false);
        for (Follower& follower : following_->followers())
            follower.carried_spin =
                BodyTurn(follower.spin, follower.axis, follower.carries, conditions_.substep())
                    .carried()
                * follower.spin;
    }

    void carry_spins()
    {
        for (const Follower& follower : following_->followers()) {
            if (!follower.stiff || follower.carries == 1) continue;
            SolverBody<Real>& seat = rows_.bodies[layout_.slot[follower.body]];
            const Vec3 spin = spin_axes(seat).conjugate() * follower.carried_spin;
            for (int k = 0; k < 3; ++k) {
                const Real change = static_cast<Real>(spin[k]) - seat.motion[4 + k];
                seat.motion[4 + k] += change;
                seat.free[4 + k] += change;
            }
        }
    }

    // Whether anything acts after bodies moved.
    bool end_following()
    {
        if (!following_ || !following_->late()) return false;
        run_passes();
        if (following_->stiff()) carry_spins();
        look_at_followers(false);
        following_->end();
        move_followers();
        return true;
    }

    // Slices are prepared as late as can be, to be solved while they are in cache: but here all
    // are looked at before anything else is done.
    bool find_parting()
    {
        run_passes();
        if (!note_parting(layout_, batch_, rows_, parting_)) return false;
        put_aside_ = PutAside<Real>(layout_, batch_, rows_);
        stiffen(layout_, batch_, rows_);
        return true;
    }

    std::size_t parting_visits() const
    {
        const std::size_t visits = kPartingPushes * put_aside_.bodies() / batch_.contacts;
        return std::clamp<std::size_t>(visits, 1, kPartingVisits);
    }

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
        constexpr std::size_t kWindow = 8 << 20, kContact = 75 * sizeof(Real);  // bytes
        return passes_.size() * (batch_.contacts / batch_.slices) * kContact < kWindow;
    }

    void run_pass(const Pass& pass, const Slice& slice, bool shared)
    {
        switch (pass.kind) {
        case Pass::Kind::prepare:
            return for_blocks(slice, shared,
                              [&](std::size_t from, std::size_t end) { maker_.make(from, end); });
        case Pass::Kind::keep:
            return for_blocks(slice, false, [&](std::size_t from, std::size_t end) {
                put_aside_.keep(slice, from, end, rows_);
            });
        case Pass::Kind::put_back:
            return for_blocks(slice, false, [&](std::size_t from, std::size_t end) {
                put_aside_.put_back(slice, from, end, rows_);
            });
        case Pass::Kind::store:
            return store(slice, shared);
        case Pass::Kind::begin:
            return begin_substep(slice, shared, pass.first);
        case Pass::Kind::advance:
            return advance(slice, shared);
        case Pass::Kind::warm_start:
            return for_colors(slice, shared, pass.backward, [&](std::size_t from, std::size_t end) {
                warm_start_(view_, from, end, visit_);
            });
        case Pass::Kind::carry:
            return for_blocks(slice, shared, [&](std::size_t from, std::size_t end) {
                kernels_.carry(view_, from, end, time_ * Real(0.5));
            });
        case Pass::Kind::bounce:
            return bounce(slice, shared, pass.backward);
        default:
            return sweep(pass, slice, shared);
        }
    }

    void sweep(const Pass& pass, const Slice& slice, bool shared)
    {
        Visit<Real> visit = visit_;
        const bool parts = pass.kind == Pass::Kind::part;
        visit.push = parts || pass.kind == Pass::Kind::push;
        visit.normal_sweeps = visit.push ? kPushSweeps : kRelaxSweeps;
        // Nothing slides while bodies part: their velocities are solved already.
        if (parts) visit.grips = visit.rolls = false;
        const auto sweep = parts ? kernels_.sweep : sweep_;
        for_colors(slice, shared, pass.backward,
                   [&](std::size_t from, std::size_t end) { sweep(view_, from, end, visit); });
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
        const auto [first, last] = layout_.blocks_of(slice);
        if (!shared) return body(first, last);
        for_each_block(last - first, kBlocks,
                       [&, first = first](std::size_t begin, std::size_t end, std::size_t) {
                           body(first + begin, first + end);
                       });
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

    void store(const Slice& slice, bool shared)
    {
        const std::size_t first = slice.first_contact;
        if (!shared) return maker_.store(first, first + slice.contacts);
        for_each_block(slice.contacts, kBlocks * kBlock,
                       [&](std::size_t begin, std::size_t end, std::size_t) {
                           maker_.store(first + begin, first + end);
                       });
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
            kernels_.begin_substep(rows_.bodies.data() + at, inertias_at(at), count, substep);
            if (!rows_.pulls.empty()) pull(at, count);
        });
    }

    const SpinInertia<Real>* inertias_at(std::size_t at) const
    {
        return rows_.inertias.empty() ? nullptr : rows_.inertias.data() + at;
    }

    // The axes that a body's spin is in, by now.
    Quat spin_axes(const SolverBody<Real>& body) const
    {
        return spin_frame(body, inertias_at(static_cast<std::size_t>(&body - rows_.bodies.data())));
    }

    // Forces move a body with contacts and without, so that what contacts gave stays what it was.
    void pull(std::size_t at, std::size_t count)
    {
        for (std::size_t i = at; i < at + count; ++i) {
            SolverBody<Real>& body = rows_.bodies[i];
            const Real* const rate = rows_.pulls[i].rate;
            Vec3 spin(double{rate[4]}, double{rate[5]}, double{rate[6]});
            if (!spin.isZero(0)) spin = spin_axes(body).conjugate() * spin;
            for (int k = 0; k < 3; ++k)
                for (Real* const motion : {body.motion, body.free}) {
                    motion[k] += rate[k] * time_;
                    motion[4 + k] += static_cast<Real>(spin[k]) * time_;
                }
        }
    }

    void advance(const Slice& slice, bool shared)
    {
        for_bodies(slice, shared, [&](std::size_t at, std::size_t count) {
            const auto bodies = std::span(rows_.bodies).subspan(at, count);
            const SpinInertia<Real>* const inertias = inertias_at(at);
            if (kernels_.advance(bodies.data(), inertias, count, time_, visit_.turns) > 0)
                turn_fast(bodies, inertias, time_);
        });
    }

    // Impacts, one contact after another, round after round, forth and back: each takes both bodies
    // as the ones before have left them.
    void bounce_all()
    {
        for (int round = 0; round < kImpactRounds; ++round) {
            struck_ = false;
            add_pass({Pass::Kind::bounce, false, round % 2 == 1});
            run_passes();
            if (!struck_) return;
        }
    }

    void bounce(const Slice& slice, bool shared, bool backward)
    {
        for_colors(slice, shared, backward, [&](std::size_t begin, std::size_t end) {
            if (bounce_(view_, begin, end, visit_)) struck_ = true;
        });
    }

    const Conditions& conditions_;
    const RigidFacts& facts_;
    const Layout& layout_;
    const Batch& batch_;
    const RowMaker<Real>& maker_;
    Rows<Real>& rows_;
    Parting& parting_;
    RowsView<Real> view_;
    const SolveKernels<Real>& kernels_;
    // With friction of the kind that is asked for.
    decltype(SolveKernels<Real>::sweep) warm_start_, sweep_;
    decltype(SolveKernels<Real>::bounce) bounce_;
    std::atomic<bool> struck_ = false;  // in the last round of impacts
    Real time_;                         // s, of a substep
    Visit<Real> visit_;
    bool on_faces_ = false;
    PutAside<Real> put_aside_;  // while bodies of the batch part
    std::optional<FollowingForces> following_;
    std::optional<SpringAccount<Real>> account_;  // where some of them are stiff
    std::vector<Pass> passes_;                    // that wait to be run
};

}  // namespace

int relax_visits(const Settings& settings, const Batch& batch)
{
    if (settings.relax_iterations > 0) return settings.relax_iterations;
    return lies_on_faces(batch) || settings.substeps > kManySubsteps ? kInStructures : kInHeaps;
}

int finer_relax_visits(const Settings& settings, const Batch& batch)
{
    const int usual = relax_visits(settings, batch);
    if (settings.relax_iterations > 0) return usual;
    return std::max(usual,
                    static_cast<int>(std::min(kMostRelaxes, batch.contacts / kContactsARelax)));
}

double mean_relax_visits(const Settings& settings, const Layout& layout)
{
    double visits = 0, contacts = 0;
    for (const Batch& batch : layout.batches) {
        visits += double(batch.contacts) * relax_visits(settings, batch);
        contacts += batch.contacts;
    }
    return contacts > 0 ? visits / contacts : 0;
}

template <class Real>
void solve_batch(const Conditions& conditions,
                 const RigidFacts& facts,
                 const Layout& layout,
                 const Batch& batch,
                 const RowMaker<Real>& maker,
                 Rows<Real>& rows,
                 Parting& parting)
{
    Task<Real>(conditions, facts, layout, batch, maker, rows, parting).run();
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void solve_batch<Real>(const Conditions&, const RigidFacts&, const Layout&,           \
                                    const Batch&, const RowMaker<Real>&, Rows<Real>&, Parting&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
