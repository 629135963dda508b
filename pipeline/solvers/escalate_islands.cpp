// Escalate islands: stubborn ones get what they need, as far as a step's budget goes.
#include "kernels/solver/coloring.hpp"
#include "pipeline/solvers/escalation.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

// Strain that half the substep brings down to kStrained, and a quarter; a sixteenth does up to
// kExactStrain. Finer ones are lost in the digits of float: what is yet more stubborn is solved
// exactly, where that is small.
constexpr double kByTwo = 4 * kStrained, kByFour = 16 * kStrained;
constexpr double kFinestSubstep = 5e-5;  // s

// Contacts are those of the step's beginning: of bodies that go by many times their size in it, as
// they do round an attractor, finer substeps hold on to what is no longer so, and give energy.
constexpr int kMostSubsteps = 64;  // in a step

// Contacts times substeps that all stubborn islands of a step may cost beyond the usual: some 32 ms
// of one core. An exact solve is counted as so many substeps.
constexpr std::size_t kBudget = 1 << 17, kExactCost = 256;

// The most for who is greater than so many contacts: he holds himself up sideways as well.
constexpr std::uint8_t kMostOfGreat = 4;
constexpr std::size_t kGreat = 2 * kBatchContacts;

// Neighbours of a body of the mean from which on contacts go one by one, as there are no colors
// left, and not a block at a time.
constexpr std::size_t kTangled = 48;

// The greatest strain of an island, whether any body of it is known to need an exact solve, and
// whether contacts gave any of it energy of late.
struct IslandStrain {
    double greatest = 0;
    bool exactly = false, gained = false;
};

IslandStrain
strain_of(const Islands& islands, std::size_t island, const OverloadedIslands& overloaded)
{
    IslandStrain strain;
    for (std::uint32_t k = islands.body_begin[island]; k < islands.body_begin[island + 1]; ++k) {
        const double of_body = overloaded.of(islands.bodies[k]);
        strain.gained = strain.gained || overloaded.limited_for(islands.bodies[k]) > 0;
        if (!is_overloaded(of_body)) continue;
        strain.greatest = std::max(strain.greatest, std::abs(of_body));
        strain.exactly = strain.exactly || of_body < 0;
    }
    return strain;
}

// 16, 4, 2, 1 times the substeps.
std::uint8_t fewer(std::uint8_t times)
{
    return static_cast<std::uint8_t>(times > 4 ? 4 : times / 2);
}

Effort at_most(Effort effort, std::uint8_t times)
{
    if (!effort.direct) effort.times = std::min(effort.times, times);
    return effort;
}

// The most of a wish that a budget has room for, and that steps may be cut for.
template <class Cost>
Effort that_fits(Effort effort, std::size_t left, const StepContext& context, const Cost& cost)
{
    while (effort.times > 1
           && (cost(effort) > left
               || (!effort.direct
                   && (context.substep() / effort.times < kFinestSubstep
                       || (context.has(Effect::attractors)
                           && context.substeps * effort.times > kMostSubsteps))))) {
        effort.times = fewer(effort.times);
        effort.direct = false;
    }
    return effort;
}

}  // namespace

Effort effort_for(double strain, bool exact)
{
    if (!(strain > 0)) return {};
    if (strain <= kByTwo && !exact) return {2};
    if (strain <= kByFour) return {4};
    return {16, strain > kExactStrain};
}

void escalate_islands(const StepContext& context,
                      const Islands& islands,
                      OverloadedIslands& overloaded)
{
    overloaded.efforts.assign(islands.size(), {});
    overloaded.escalated = overloaded.missed = overloaded.work = 0;
    const auto substeps = static_cast<std::size_t>(context.substeps);
    const auto contacts_of = [&](std::size_t island) -> std::size_t {
        return islands.contact_begin[island + 1] - islands.contact_begin[island];
    };
    const auto bodies_of = [&](std::size_t island) -> std::size_t {
        return islands.body_begin[island + 1] - islands.body_begin[island];
    };
    const auto cost = [&](std::size_t island, const Effort& effort) {
        const std::size_t contacts = contacts_of(island);
        if (effort.direct) return contacts * kExactCost;
        const std::size_t finer = contacts * substeps * (effort.times - 1u);
        return 2 * contacts > kTangled * bodies_of(island) ? finer * kBlock : finer;
    };

    auto& wishes = overloaded.scratch.wishes;
    wishes.clear();
    for (std::size_t island = 0; island < islands.size(); ++island) {
        const IslandStrain strain = strain_of(islands, island, overloaded);
        overloaded.efforts[island].limited = strain.gained;
        if (!(strain.greatest > 0)) continue;
        const bool exact = may_be_exact(bodies_of(island), contacts_of(island));
        const Effort wanted = effort_for(strain.greatest, exact);
        const bool direct = exact && (wanted.direct || strain.exactly);
        const bool great = contacts_of(island) > kGreat;
        wishes.push_back(
            {static_cast<std::uint32_t>(island),
             {great ? std::min(wanted.times, kMostOfGreat) : wanted.times, direct, true},
             wanted.direct && !direct});
    }

    // Where they wish for more than there is, all have some before any has most.
    const auto all_fit = [&](std::uint8_t most) {
        std::size_t all = 0;
        for (const auto& wish : wishes) all += cost(wish.island, at_most(wish.effort, most));
        return all <= kBudget;
    };
    std::uint8_t most = 16;
    while (most > 2 && !all_fit(most)) most = fewer(most);
    std::size_t left = kBudget;
    for (const auto& wish : wishes) {
        const Effort effort =
            that_fits(at_most(wish.effort, most), left, context,
                      [&](const Effort& some) { return cost(wish.island, some); });
        left -= cost(wish.island, effort);
        overloaded.work += cost(wish.island, effort);
        overloaded.efforts[wish.island] = effort;
        overloaded.escalated += effort.times > 1 ? 1 : 0;
        overloaded.missed += wish.too_great || effort.times < wish.effort.times ? 1 : 0;
    }
}

}  // namespace throng
