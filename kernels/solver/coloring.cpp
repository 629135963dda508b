#include "kernels/solver/coloring.hpp"

#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/compact.hpp"

#include <algorithm>
#include <bit>

namespace throng {

namespace {

// How many contacts ahead one is asked for: those of a slice are not side by side in memory.
constexpr std::size_t kAhead = 16;

constexpr std::size_t kGrain = 4096;  // bodies or contacts a block

template <class Body>
void for_slices(const Layout& layout, Body body)
{
    for_each_block(layout.slices.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

// Most contacts in a row touch the same one.
void add(std::uint32_t body, std::vector<std::uint32_t>& bodies)
{
    if (bodies.empty() || bodies.back() != body) bodies.push_back(body);
}

// Those behind the contacts of a color; or behind each, where they are to go one after another.
void clear_idle_lanes(const Color& color, std::size_t held, Layout& layout)
{
    const std::size_t begin = std::size_t{color.first} * kBlock;
    const std::size_t end = begin + std::size_t{color.count} * kBlock;
    for (std::size_t lane = color.serial ? begin : begin + held; lane < end; ++lane) {
        if (color.serial && lane % kBlock == 0) continue;
        layout.lanes[lane] = {};
        layout.solver_index_a[lane] = layout.solver_index_b[lane] = 0;
    }
}

// Who stands still and is more than that to what touches it: its surface moves, or contacts give
// way by its mass as they did before it came to rest.
bool has_standing_copy(std::uint32_t body, const BodyStates& states)
{
    return states.carries(body) || states.rests(body);
}

// Where a body is in an ascending list, or its length.
std::size_t place_in(const std::vector<std::uint32_t>& bodies, std::uint32_t body)
{
    const auto at = std::lower_bound(bodies.begin(), bodies.end(), body);
    return at != bodies.end() && *at == body ? static_cast<std::size_t>(at - bodies.begin())
                                             : bodies.size();
}

}  // namespace

// Bodies and contacts of all slices, in order.
void ConstraintGraph::gather_slices(const Islands& islands,
                                    const ActiveContacts& active,
                                    const BodyStates& states,
                                    std::span<const Vec3> positions,
                                    Layout& layout)
{
    layout.contacts = islands.contacts;
    layout.body_of_solver_index.assign(1, kNoBody);
    layout.body_of_solver_index.insert(layout.body_of_solver_index.end(), islands.bodies.begin(),
                                       islands.bodies.end());
    const auto is_direct = [&](std::size_t island) {
        return islands.contact_begin[island + 1] - islands.contact_begin[island] <= direct_limit
            && islands.body_begin[island + 1] - islands.body_begin[island] <= direct_limit;
    };
    const auto effort_of = [&](std::size_t island) {
        return efforts.empty() ? Effort{} : efforts[island];
    };
    const auto calls_of = [&](std::size_t island) {
        return islands.calls.empty() ? IslandCalls{} : islands.calls[island];
    };
    layout.island_begin.clear();
    for (const std::uint32_t begin : islands.body_begin) layout.island_begin.push_back(begin + 1);
    for (std::size_t first = 0, last = 0; first < islands.size(); first = last) {
        const std::uint32_t begin = islands.contact_begin[first];
        const auto contacts_until = [&](std::size_t island) {
            return islands.contact_begin[island] - begin;
        };
        Batch batch;
        const Effort effort = effort_of(first);
        batch.direct = effort.direct || is_direct(first);
        batch.times = effort.times;
        batch.limited = effort.limited;
        batch.calls = calls_of(first);
        const bool alone = effort.direct || direct_limit > 0 || batch.calls.alone;
        for (last = first + 1; !alone && last < islands.size(); ++last)
            if (contacts_until(last + 1) > kBatchContacts || effort_of(last) != effort
                || calls_of(last) != batch.calls)
                break;

        batch.first_island = static_cast<std::uint32_t>(first);
        batch.islands = static_cast<std::uint32_t>(last - first);
        batch.first_slice = static_cast<std::uint32_t>(layout.slices.size());
        batch.contacts = contacts_until(last);
        batch.wide = batch.contacts > kBatchContacts && !batch.direct;
        Slice slice;
        slice.first_body = islands.body_begin[first] + 1;
        slice.dynamic = islands.body_begin[last] - islands.body_begin[first];
        slice.first_contact = begin;
        slice.contacts = batch.contacts;
        if (batch.wide)
            splitter_.split(
                {std::span(layout.body_of_solver_index).subspan(slice.first_body, slice.dynamic),
                 std::span(layout.contacts).subspan(begin, batch.contacts), slice},
                active, states, positions, split_rule, layout.slices);
        else
            layout.slices.push_back(slice);
        batch.slices = static_cast<std::uint32_t>(layout.slices.size()) - batch.first_slice;
        layout.batches.push_back(batch);
    }
}

void ConstraintGraph::number_solver_bodies(const Slice& slice, Layout& layout)
{
    for_each_block(slice.dynamic, kGrain, [&](std::size_t from, std::size_t to, std::size_t) {
        for (std::size_t k = from; k < to; ++k) {
            const auto solver_index = static_cast<std::uint32_t>(slice.first_body + k);
            const std::uint32_t body = layout.body_of_solver_index[solver_index];
            layout.solver_index[body] = solver_index;
            used_[body] = before_[body] = 0;
        }
    });
}

// Colors the contacts of a slice and counts them; lists whom else they touch.
void ConstraintGraph::color_contacts(const ActiveContacts& active,
                                     const BodyStates& states,
                                     const Layout& layout,
                                     const Slice& slice,
                                     Plan& plan)
{
    plan.size.fill(0);
    plan.kinematic.clear();
    plan.standing.clear();
    std::uint64_t nobody = 0;
    const auto used_by = [&](std::uint32_t body) -> std::uint64_t& {
        const std::uint32_t solver_index = layout.solver_index[body];
        if (solver_index == Layout::kNoSolverIndex) return nobody;
        return solver_index - slice.first_body < slice.dynamic ? used_[body] : before_[body];
    };
    const std::size_t end = slice.first_contact + slice.contacts;
    for (std::size_t i = slice.first_contact; i < end; ++i) {
        if (i + kAhead < end) __builtin_prefetch(&active.entries[layout.contacts[i + kAhead]]);
        const auto& contact = active.entries[layout.contacts[i]];
        std::uint64_t& by_a = used_by(contact.body_a);
        std::uint64_t& by_b = used_by(contact.body_b);
        nobody = 0;
        const int color = std::min(std::countr_one(by_a | by_b), kColors);
        const std::uint32_t bin =
            kPoints * static_cast<std::uint32_t>(color) + (kPoints - contact.points);
        bin_[i] = static_cast<std::uint8_t>(bin);
        rank_[i] = plan.size[bin]++;
        if (color < kColors) {
            by_a |= std::uint64_t{1} << color;
            by_b |= std::uint64_t{1} << color;
        }
        for (const std::uint32_t body : {contact.body_a, contact.body_b}) {
            if (layout.solver_index[body] != Layout::kNoSolverIndex) continue;
            if (states.kind[body] == BodyKind::kinematic) add(body, plan.kinematic);
            if (has_standing_copy(body, states)) add(body, plan.standing);
        }
    }
    keep_each_once(plan.kinematic);
    keep_each_once(plan.standing);
    count_blocks(plan);
}

void ConstraintGraph::count_blocks(Plan& plan)
{
    plan.blocks = plan.colors = 0;
    for (std::uint32_t color = 0; color <= kColors; ++color) {
        std::uint32_t held = 0;
        for (std::uint32_t kind = 0; kind < kPoints; ++kind)
            held += plan.size[kPoints * color + kind];
        plan.blocks += color == kColors ? held : (held + kBlock - 1) / kBlock;
        plan.colors += held > 0 ? 1 : 0;
    }
}

// Gives every slice its solver bodies, colors and blocks.
void ConstraintGraph::lay_out_colors(Layout& layout)
{
    std::uint32_t blocks = 0, colors = 0;
    for (std::size_t i = 0; i < layout.slices.size(); ++i) {
        Slice& slice = layout.slices[i];
        Plan& plan = plans_[i];
        auto& sources = layout.body_of_solver_index;
        // Each slice has its own copy of a body that moves by itself: slices are not at the same
        // time of the step. Others have a velocity, or a mass, and go nowhere.
        slice.first_kinematic_copy = static_cast<std::uint32_t>(sources.size());
        slice.kinematic = static_cast<std::uint32_t>(plan.kinematic.size());
        sources.insert(sources.end(), plan.kinematic.begin(), plan.kinematic.end());
        sources.insert(sources.end(), plan.standing.begin(), plan.standing.end());
        slice.first_color = colors;
        slice.colors = plan.colors;
        plan.first_block = blocks;
        colors += plan.colors;
        blocks += plan.blocks;
    }
    layout.colors.resize(colors);
    layout.points.resize(blocks);
    layout.lanes.resize(std::size_t{blocks} * kBlock);
    layout.solver_index_a.resize(layout.lanes.size());
    layout.solver_index_b.resize(layout.lanes.size());
}

// Counting sort by color, and by number of points within a color: the fewer points a block has at
// most, the less there is to do for it.
void ConstraintGraph::place(const ActiveContacts& active,
                            const BodyStates& states,
                            const Plan& plan,
                            const Slice& slice,
                            Layout& layout)
{
    std::array<std::uint32_t, kBins> first_lane;
    std::uint32_t block = plan.first_block, color_at = slice.first_color;
    for (std::uint32_t color = 0; color <= kColors; ++color) {
        const std::uint32_t first = block, per_block = color == kColors ? 1 : kBlock;
        std::uint32_t held = 0;
        for (std::uint32_t kind = 0; kind < kPoints; ++kind) {
            first_lane[kPoints * color + kind] = first * kBlock + held * (kBlock / per_block);
            held += plan.size[kPoints * color + kind];
        }
        if (held == 0) continue;
        block += (held + per_block - 1) / per_block;
        layout.colors[color_at] = {first, block - first, color == kColors};
        clear_idle_lanes(layout.colors[color_at++], held, layout);
    }

    const auto solver_index_of = [&](std::uint32_t body) {
        if (layout.solver_index[body] != Layout::kNoSolverIndex)
            return static_cast<std::int32_t>(layout.solver_index[body]);
        std::size_t place = 0;
        if (states.kind[body] == BodyKind::kinematic)
            place = place_in(plan.kinematic, body);
        else if (has_standing_copy(body, states))
            place = plan.kinematic.size() + place_in(plan.standing, body);
        else
            return 0;
        return static_cast<std::int32_t>(slice.first_kinematic_copy + place);
    };
    for_each_block(slice.contacts, kGrain, [&](std::size_t from, std::size_t to, std::size_t) {
        for (std::size_t i = slice.first_contact + from; i < slice.first_contact + to; ++i) {
            if (i + kAhead < slice.first_contact + to)
                __builtin_prefetch(&active.entries[layout.contacts[i + kAhead]]);
            const auto& contact = active.entries[layout.contacts[i]];
            const bool serial = bin_[i] >= kPoints * kColors;
            const std::size_t lane = first_lane[bin_[i]] + rank_[i] * (serial ? kBlock : 1u);
            layout.lanes[lane].entry = layout.contacts[i];
            layout.lane[i] = static_cast<std::uint32_t>(lane);
            layout.solver_index_a[lane] = solver_index_of(contact.body_a);
            layout.solver_index_b[lane] = solver_index_of(contact.body_b);
            if (lane % kBlock == 0)
                layout.points[lane / kBlock] = std::max(contact.points, plan.least_points);
        }
    });
}

void ConstraintGraph::lay_out(const Islands& islands,
                              const ActiveContacts& active,
                              const BodyStates& states,
                              std::span<const Vec3> positions,
                              Layout& layout)
{
    // Whoever had a solver body in the last step may have none in this one.
    for_each_block(layout.dynamic, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t solver_index = begin + 1; solver_index <= end; ++solver_index)
            layout.solver_index[layout.body_of_solver_index[solver_index]] = Layout::kNoSolverIndex;
    });
    layout.batches.clear();
    layout.slices.clear();
    gather_slices(islands, active, states, positions, layout);

    layout.dynamic = static_cast<std::uint32_t>(islands.bodies.size());
    layout.solver_index.resize(states.kind.size(), Layout::kNoSolverIndex);
    used_.resize(states.kind.size());
    before_.resize(states.kind.size());
    layout.lane.resize(layout.contacts.size());
    bin_.resize(layout.contacts.size());
    rank_.resize(layout.contacts.size());
    if (plans_.size() < layout.slices.size()) plans_.resize(layout.slices.size());
    for (const Batch& batch : layout.batches)
        for (std::uint32_t i = batch.first_slice; i < batch.first_slice + batch.slices; ++i)
            plans_[i].least_points = batch.wide || batch.calls.on_points ? 1 : 2;
    for_slices(layout, [&](std::size_t i) { number_solver_bodies(layout.slices[i], layout); });
    for_slices(layout, [&](std::size_t i) {
        color_contacts(active, states, layout, layout.slices[i], plans_[i]);
    });
    lay_out_colors(layout);
    for_slices(layout,
               [&](std::size_t i) { place(active, states, plans_[i], layout.slices[i], layout); });

    for (Batch& batch : layout.batches) {
        batch.on_faces = 0;
        for (std::uint32_t i = batch.first_slice; i < batch.first_slice + batch.slices; ++i)
            for (std::size_t k = 0; k < plans_[i].size.size(); ++k)
                if (kPoints - k % kPoints >= 3) batch.on_faces += plans_[i].size[k];
    }
}

}  // namespace throng
