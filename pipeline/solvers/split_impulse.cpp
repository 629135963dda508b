#include "pipeline/solvers/split_impulse.hpp"

#include "kernels/parallel/compact.hpp"
#include "pipeline/solvers/batch_bodies.hpp"
#include "pipeline/solvers/unlike_masses.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace throng {

namespace {

// Overlap in units of that from which a contact is rigid (half a hundredth of the smaller body's
// half extent): who is put deeper than four tenths of the half extent has to part, and is done at a
// twenty-thousandth, from where the usual push gives no speed to speak of.
constexpr double kDeep = 80, kFlat = 0.01;
// Of who is wedged: depth as a share of the half extent, and steps, which begin anew while it is as
// deep. The rest is left to the usual push.
constexpr double kWedged = 0.2;
constexpr std::uint16_t kWedgedSteps = 60;
// Pushes that begin anew in each substep do not lift who is so much heavier: in half of such spans
// of steps he is left to the usual push.
constexpr long kTurn = 2 * kWedgedSteps;

// Steps that a body has to part in: a tenth comes down to flat in some 60, whatever their length,
// and a crowd of a thousand takes ten times as many. While a step runs kGoesOn marks who does.
constexpr std::uint16_t kSteps = 1000, kGoesOn = 0x8000;

// Of all slices of a batch.
template <class AnyRows>
auto blocks_of(const Layout& layout, const Batch& batch, AnyRows& constraints)
{
    const auto slices = layout.slices_of(batch);
    const std::size_t begin = layout.blocks_of(slices.front()).begin;
    return std::span(constraints.blocks)
        .subspan(begin, layout.blocks_of(slices.back()).end - begin);
}

// Behind the last point of the blocks before `end`.
template <class Real>
std::size_t end_of_points(const ContactConstraints<Real>& constraints, std::size_t end)
{
    return constraints.first_point[end - 1]
        + static_cast<std::size_t>(constraints.blocks[end - 1].points);
}

// Of each lane, in the units above; 0 for one that is idle or apart.
template <class Real>
void deepen(const ContactConstraints<Real>& constraints,
            const ContactConstraintWide<Real>& block,
            Real (&depth)[kBlock])
{
    std::fill(std::begin(depth), std::end(depth), Real(0));
    for (int k = 0; k < block.points; ++k) {
        const ContactPointWide<Real>& point =
            constraints.points[block.first_point + static_cast<unsigned>(k)];
        for (int lane = 0; lane < kBlock; ++lane)
            depth[lane] = std::max(depth[lane], -point.separation.at[lane]);
    }
    for (int lane = 0; lane < kBlock; ++lane) depth[lane] *= block.inverse_deep.at[lane];
}

std::uint16_t left_of(std::uint16_t steps)
{
    return steps & static_cast<std::uint16_t>(~(kGoesOn | SplitImpulse::kPlaced));
}

// Lets the bodies of a contact that is not flat go on, and those that lean on them. Returns the
// most steps that one of them has left.
std::uint16_t go_on(bool deep, std::span<std::uint16_t* const> sides)
{
    std::uint16_t most = 0;
    for (const std::uint16_t* steps : sides) {
        const bool begins = deep && *steps == SplitImpulse::kPlaced;
        most = std::max(most, begins ? kSteps : left_of(*steps));
    }
    if (most == 0) return 0;
    for (std::uint16_t* steps : sides) {
        if (left_of(*steps) == 0) *steps |= most;
        *steps |= kGoesOn;
    }
    return most;
}

// The same for all contacts of a block.
template <class Real>
std::uint16_t go_on(const Layout& layout,
                    const ContactConstraints<Real>& constraints,
                    const ContactConstraintWide<Real>& block,
                    std::vector<std::uint16_t>& steps)
{
    Real depth[kBlock];
    deepen(constraints, block, depth);
    std::uint16_t found = 0;
    for (int lane = 0; lane < kBlock; ++lane) {
        if (!(depth[lane] > Real(kFlat))) continue;
        std::uint16_t* sides[2];
        std::size_t count = 0;
        for (const std::int32_t solver_index : {block.a[lane], block.b[lane]})
            if (layout.movable(solver_index))
                sides[count++] =
                    &steps[layout.body_of_solver_index[static_cast<std::size_t>(solver_index)]];
        found = std::max(found, go_on(depth[lane] > Real(kDeep), std::span(sides, count)));
    }
    return found;
}

}  // namespace

void start_split_impulse(const Layout& layout, SplitImpulse& split_impulse)
{
    split_impulse.steps.resize(layout.solver_index.size(), 0);
    split_impulse.scratch.batches.assign(layout.batches.size(), 0);
}

template <class Real>
void split_wedged(const StepContext& context,
                  const ActiveContacts& active,
                  const Colliders& colliders,
                  const Masses& masses,
                  const ConstraintBuilder<Real>& builder,
                  SplitImpulse& split_impulse)
{
    const bool lifts = std::lround(context.time / context.dt) / kTurn % 2 != 0;
    const auto many = [&](std::uint32_t body) { return colliders.count[body] > 1; };
    for (const ActiveContacts::Entry& entry : active.entries) {
        const bool wedges =
            entry.list == ContactList::solid || (many(entry.body_a) && many(entry.body_b));
        if (!wedges) continue;
        const double depth{builder.contact_of(entry).overlap(entry.points)};
        if (!(depth > kWedged * double{entry.extent})
            || (lifts && are_unlike(masses, entry.body_a, entry.body_b)))
            continue;
        for (const std::uint32_t body : {entry.body_a, entry.body_b}) {
            if (split_impulse.steps[body] == 0) split_impulse.bodies.push_back(body);
            split_impulse.steps[body] = std::max(split_impulse.steps[body], kWedgedSteps);
        }
        split_impulse.some = true;
    }
}

bool uses_split_impulse(const Layout& layout, const Batch& batch, const SplitImpulse& split_impulse)
{
    return any_body_of(layout, batch,
                       [&](std::uint32_t body) { return split_impulse.parts(body); });
}

template <class Real>
bool note_split_impulse(const Layout& layout,
                        const Batch& batch,
                        const ContactConstraints<Real>& constraints,
                        SplitImpulse& split_impulse)
{
    std::uint16_t most = 0;
    for (const ContactConstraintWide<Real>& block : blocks_of(layout, batch, constraints))
        most = std::max(most, go_on(layout, constraints, block, split_impulse.steps));
    split_impulse.scratch.batches[static_cast<std::size_t>(&batch - layout.batches.data())] =
        most > 0;
    return most > 0;
}

template <class Real>
void stiffen(const Layout& layout, const Batch& batch, ContactConstraints<Real>& constraints)
{
    for (ContactConstraintWide<Real>& block : blocks_of(layout, batch, constraints))
        block.impulse_scale = {};
}

void update_split_impulse(const Layout& layout, SplitImpulse& split_impulse)
{
    if (!split_impulse.some) return;
    std::vector<std::uint32_t>& bodies = split_impulse.bodies;
    for (std::size_t batch = 0; batch < layout.batches.size(); ++batch)
        if (split_impulse.scratch.batches[batch] != 0) {
            const auto its = layout.bodies_of(layout.batches[batch]);
            bodies.insert(bodies.end(), its.begin(), its.end());
        }
    keep_each_once(bodies);
    std::erase_if(bodies, [&](std::uint32_t body) {
        std::uint16_t& steps = split_impulse.steps[body];
        steps = (steps & kGoesOn) != 0 ? static_cast<std::uint16_t>(left_of(steps) - 1) : 0;
        return steps == 0;
    });
    split_impulse.some = !bodies.empty();
}

template <class Real>
SavedMotion<Real>::SavedMotion(const Layout& layout,
                               const Batch& batch,
                               const ContactConstraints<Real>& constraints)
{
    const Slice& first = layout.slices[batch.first_slice];
    const Slice& last = layout.slices[batch.first_slice + batch.slices - 1];
    first_body_ = first.first_body;
    motions_.resize(last.first_body + last.dynamic - first_body_);
    first_point_ = constraints.first_point[layout.blocks_of(first).begin];
    impulses_.resize(end_of_points(constraints, layout.blocks_of(last).end) - first_point_);
}

template <class Real>
void SavedMotion<Real>::save(const Slice& slice,
                             std::size_t begin,
                             std::size_t end,
                             const ContactConstraints<Real>& constraints)
{
    for (std::size_t i = slice.first_body; i < slice.first_body + slice.dynamic; ++i)
        motions_[i - first_body_] = std::to_array(constraints.bodies[i].motion);
    for (std::size_t i = constraints.first_point[begin]; i < end_of_points(constraints, end); ++i)
        impulses_[i - first_point_] = constraints.points[i].impulse;
}

template <class Real>
void SavedMotion<Real>::restore(const Slice& slice,
                                std::size_t begin,
                                std::size_t end,
                                ContactConstraints<Real>& constraints) const
{
    for (std::size_t i = slice.first_body; i < slice.first_body + slice.dynamic; ++i)
        std::ranges::copy(motions_[i - first_body_], constraints.bodies[i].motion);
    for (std::size_t i = constraints.first_point[begin]; i < end_of_points(constraints, end); ++i)
        constraints.points[i].impulse = impulses_[i - first_point_];
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template bool note_split_impulse<Real>(const Layout&, const Batch&,                            \
                                           const ContactConstraints<Real>&, SplitImpulse&);        \
    template void stiffen<Real>(const Layout&, const Batch&, ContactConstraints<Real>&);           \
    template void split_wedged<Real>(const StepContext&, const ActiveContacts&, const Colliders&,  \
                                     const Masses&, const ConstraintBuilder<Real>&,                \
                                     SplitImpulse&);                                               \
    template class SavedMotion<Real>;
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
