// Measure strain: how much too great the loads of islands are for their contacts.
//
// The strain of an island is the greatest, over its bodies, of how far the load that one passes on
// presses his contacts in over where they turn rigid; times the height of the island, in bodies
// above what stands still.
// Loads are those that the contacts bear now, so that it does not matter how the island was solved.
// A strain has to last, with the island at rest, before that counts as stubborn: until then what is
// told is how far it is on the way, from 0 to 1. It is told below 0 where the next step should be
// exact: where an island has only become stubborn, or is pressed in further than finer substeps
// would hold it, which would throw it off; or where a blow drives somebody light in before somebody
// heavy, and while he is as deep. Of islands of more than a batch of contacts only structures are
// looked at, and those in which somebody bears somebody much heavier: a heap holds itself up
// sideways. Nor is who is squeezed escalated.
#include "kernels/math/numbers.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/solver/coloring.hpp"
#include "pipeline/solvers/constraint_builder.hpp"
#include "pipeline/solvers/escalation.hpp"
#include "pipeline/solvers/unlike_masses.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <cmath>

namespace throng {

namespace {

constexpr std::size_t kIslands = 8;  // a block
// How much of what a step shows counts: a strain of twice what is too great is believed after three
// steps, one of four times at once.
constexpr double kShare = 0.25;
// s, in which gravity makes what still counts as rest: no impact, no walk.
constexpr double kResting = 1.0 / 15;
// m/s: slower than any that is seen; and what a step of trembling adds, on the way from 0 to 1, so
// that it is believed after two seconds or so at 1/60 s.
constexpr double kTrembling = 2e-3, kPatience = 1.0 / 240;
// A strain is let go once it is this much less: loads that tremble, and an impact as something was
// set down, do not change from step to step how they are borne.
constexpr double kLasting = 3;
// Who is not solved exactly shows most as he lands, and may bear nothing for a moment, tossed by
// contacts that turn stiffer. He begins with the finest substeps: those that were stiffened later,
// as a load grew, would throw him. From there on what he was strained by fades, to what would not
// have made him stubborn.
constexpr double kFirst = 16, kFading = 0.95, kSettled = 0.85 * kStrained;
// Overlap from which an island is not left to finer substeps, as a share of what its load makes
// with the usual ones.
constexpr double kDeep = 0.5;
// A blow is too much where somebody so much lighter than who he touches is driven in by such a
// share of the extent in a step; and what is small enough to be solved exactly at once.
constexpr double kDriven = 0.1, kCrushed = 2 * kExactStrain;
constexpr std::size_t kCrushedContacts = 16;
// Strain of an island that overlaps in spite of finer substeps: solved exactly as long as it rests.
constexpr double kInVain = 4 * kExactStrain;
// Share of what an island has in motion that it may gain in a step besides what gravity gives; and
// for how many steps contacts are held to making nothing once it has gained more.
constexpr double kGained = 0.01;
constexpr std::uint8_t kLimited = 32;

// How easily a body gives way, 1/kg. Who cannot be moved, only turned, gives way by lever arms
// about as much as his mass would.
double inverse_mass_of(const Masses& masses, std::uint32_t body)
{
    const double inverse_mass = masses.inverse_mass[body], mass = masses.mass[body];
    return inverse_mass == 0 && mass > 0 ? 1 / mass : inverse_mass;
}

// N s, of all points, or as if all bore what the most loaded one does; and times the ease with
// which the lesser mass gives way: m/s.
template <class Real>
double speed_borne(const ActiveContacts::Entry& entry,
                   const Contact<Real>& contact,
                   const Masses& masses,
                   bool by_most_loaded)
{
    Real sum = 0, most = 0;
    for (std::size_t k = 0; k < entry.points; ++k) {
        sum += contact.points[k].impulse;
        most = std::max(most, contact.points[k].impulse);
    }
    const Real impulse = by_most_loaded ? most * Real(entry.points) : sum;
    return double{impulse}
    * (inverse_mass_of(masses, entry.body_a) + inverse_mass_of(masses, entry.body_b));
}

template <class Real>
class Gauge {
    using Settled = typename ContactConstraints<Real>::Settled;

public:
    Gauge(const StepContext& context,
          const SolverParameters& parameters,
          const Islands& islands,
          const Layout& layout,
          const ActiveContacts& active,
          const Masses& masses,
          const Poses& poses,
          const Velocities& velocities,
          const ConvexContacts<Real>& convex,
          const MeshContacts<Real>& meshes,
          const SolidContacts<Real>& solids,
          const JoinedContacts<Real>& joined,
          const ContactConstraints<Real>& constraints,
          OverloadedIslands& overloaded)
        : islands_(islands), layout_(layout), active_(active), masses_(masses), poses_(poses),
          velocities_(velocities), convex_(convex), meshes_(meshes), solids_(solids),
          joined_(joined), constraints_(constraints), overloaded_(overloaded),
          resting_(kResting * context.gravity.norm()), step_(context.dt), gravity_(context.gravity),
          falls_(context.gravity.norm() * context.dt)
    {
        for (int points = 1; points <= 4; ++points) {
            const double omega = contact_frequency(context, parameters, points);
            per_speed_[points - 1] =
                1 / (omega * omega * context.substep() * rigid_overlap(1, points));
        }
    }

    // Whether what is below is asked of it. Who lies on what stands still, by one contact, has
    // nobody to wait for.
    bool is_looked_at(std::size_t island) const
    {
        const auto contacts = islands_.contacts_of(island);
        if (contacts.size() <= kBatchContacts) return contacts.size() >= 2;
        if (contacts.size() > kMostEscalated) return false;
        const auto on_faces =
            std::count_if(contacts.begin(), contacts.end(),
                          [&](std::uint32_t place) { return active_.entries[place].points >= 3; });
        return 2 * static_cast<std::size_t>(on_faces) > contacts.size()
            || any_unlike(masses_, active_, contacts);
    }

    // 0 for an island that is not stubborn; below 0 for one to be solved exactly in the next step.
    double strain_of(std::size_t island) const
    {
        const double strain = strain_if_free(island);
        return strain != 0 && is_squeezed(island) ? 0 : strain;
    }

    // For how many steps contacts of the island are still to be held to making no energy.
    std::uint8_t limited(std::size_t island) const
    {
        if (gains(island)) return kLimited;
        std::uint8_t before = 0;
        if (!overloaded_.gainers.empty())
            for (const std::uint32_t body : islands_.bodies_of(island))
                before = std::max(before, overloaded_.limited_for(body));
        return before > 0 ? static_cast<std::uint8_t>(before - 1) : before;
    }

private:
    double strain_if_free(std::size_t island) const
    {
        const std::size_t bodies = islands_.body_begin[island + 1] - islands_.body_begin[island];
        const auto contacts = islands_.contacts_of(island);
        const bool exactly = may_be_exact(bodies, contacts.size());
        const double before = strain_before(island);
        // A load that stands at a corner of who bears it has a quarter of him to be held by. In a
        // heap the points of a contact change what they bear from step to step.
        const double greatest = find_gives(island, is_column(bodies, contacts.size()));
        // What is loaded by so little that no height makes it too much is most of what there is.
        if (before == 0 && !(greatest * double(bodies) > kRelieved)) return 0;
        const double most = most_borne(island);
        // Pushed apart otherwise, what was driven in is thrown.
        if (before >= kCrushed && exactly && overlaps(contacts, kDriven)) return -kCrushed;
        if (!(std::max(most * double(bodies), before) > kRelieved)) return 0;
        const double strain = most * height_of(island);
        const double square = mean_square_speed(island);
        const bool rests = square < resting_ * resting_;
        if (touches_resting(island))
            return before > 1 ? std::copysign(before, is_solved_exactly(island) ? -1 : 1) : 0;
        if (!(before > 1)) {
            if (!rests) return is_crushed(island) ? -kCrushed : 0;
            return begun(strain, before, exactly, square > kTrembling * kTrembling);
        }
        return exactly ? lasting(island, strain, most, before, rests) : fading(strain, before);
    }

    // Whether the bodies of an island move faster by more than gravity gives. What spins may give
    // some to what moves on, and rightly so: then there is nothing for the limiter to take.
    bool gains(std::size_t island) const
    {
        const IslandCalls& calls = islands_.calls[island];
        const Set<Effect> pushed = kForces | Set<Effect>{Effect::drive};
        if (calls.effects.meets(pushed) || !moves(island)) return false;
        double mass = 0, twice_energy = 0, twice_gained = 0;
        for (std::uint32_t k = islands_.body_begin[island]; k < islands_.body_begin[island + 1];
             ++k) {
            const SolverBody<Real>& solver_body = constraints_.bodies[k + 1];
            const std::uint32_t body = layout_.body_of_solver_index[k + 1];
            if (!constraints_.settled.empty() && constraints_.settled[k + 1] != Settled::no)
                return false;
            const double square = vector_at(solver_body.motion).squaredNorm();
            const double of_body = masses_.inverse_mass[body] > 0 ? masses_.mass[body] : 0;
            mass += of_body;
            twice_energy += of_body * square;
            twice_gained += of_body
                * (square - velocities_.linear[body].squaredNorm()
                   - 2 * gravity_.dot(vector_at(solver_body.delta_pose)));
        }
        return twice_gained > kGained * twice_energy && twice_energy > mass * falls_ * falls_
            && !is_driven(island);
    }

    // Whether it touches one of those that no contact moves of which that is so.
    template <class Is>
    bool touches_unmoved(std::size_t island, const Is& is_so) const
    {
        const auto asked = [&](std::uint32_t body) {
            return layout_.solver_index[body] == Layout::kNoSolverIndex && is_so(body);
        };
        const auto contacts = islands_.contacts_of(island);
        return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t place) {
            const ActiveContacts::Entry& entry = active_.entries[place];
            return asked(entry.body_a) || asked(entry.body_b);
        });
    }

    // Whether it touches somebody who rests by himself, and so is a part of something greater,
    // which was borne as it is: it would be thrown by a change to more substeps.
    bool touches_resting(std::size_t island) const
    {
        return touches_unmoved(island,
                               [&](std::uint32_t body) { return masses_.inverse_mass[body] > 0; });
    }

    // Whether it touches what moves by itself, which may give it any energy.
    bool is_driven(std::size_t island) const
    {
        return touches_unmoved(island, [&](std::uint32_t body) {
            return !(velocities_.linear[body].isZero(0) && velocities_.angular[body].isZero(0));
        });
    }

    // Whether it touches two that no contact moves, and that move against one another: then there
    // may be no way out, and the more exactly it is solved the greater are the impulses, which
    // cancel one another until the next step has turned them.
    bool is_squeezed(std::size_t island) const
    {
        std::uint32_t first = kNoBody;
        return touches_unmoved(island, [&](std::uint32_t body) {
            if (first == kNoBody) first = body;
            return velocities_.linear[body] != velocities_.linear[first]
                || velocities_.angular[body] != velocities_.angular[first];
        });
    }

    // Whether any body does faster than it falls in a step.
    bool moves(std::size_t island) const
    {
        const auto bodies = std::span(constraints_.bodies)
                                .subspan(islands_.body_begin[island] + std::size_t{1},
                                         islands_.bodies_of(island).size());
        const Real falls = static_cast<Real>(falls_ * falls_);
        return std::any_of(bodies.begin(), bodies.end(), [&](const SolverBody<Real>& body) {
            // Four numbers, of which the last is 0.
            return Eigen::Map<const Eigen::Array<Real, 4, 1>>(body.motion).square().sum() > falls;
        });
    }

    static double fading(double strain, double before)
    {
        const double faded = std::max(strain, kFading * before);
        return faded > kSettled ? faded : 0;
    }

    double lasting(std::size_t island, double strain, double most, double before, bool rests) const
    {
        if (!(strain > kRelieved)) return 0;
        const double lasted = std::max(strain, std::min({before, kLasting * strain, kExactStrain}));
        if (!rests) return lasted;
        // By turns it would be pushed out and sink in again.
        if (before >= kInVain) return kInVain;
        if (islands_.contacts_of(island).size() > kCrushedContacts && is_solved_exactly(island))
            return lasted;
        return is_deep(island, most) ? -kInVain : lasted;
    }

    const Contact<Real>& contact_of(const ActiveContacts::Entry& entry) const
    {
        return throng::contact_of(convex_, meshes_, solids_, joined_, entry);
    }

    // A heap that settles trembles, so only who goes on trembling under a load that is nearly too
    // much is stubborn by that.
    static double begun(double strain, double before, bool exactly, bool trembles)
    {
        const bool goes_on = trembles && strain > kRelieved;
        const double now = std::max(before + kShare * (strain / kStrained - before),
                                    goes_on ? before + kPatience : 0);
        if (!(now >= 1 && (goes_on || strain > kStrained))) return std::min(now, 1.0);
        return exactly ? -strain : kFirst * strain;
    }

    // How far its load presses a contact in, over where it turns rigid. The lesser of the two
    // masses is what its points have to hold it by.
    double give_of(std::uint32_t place, bool by_most_loaded) const
    {
        const ActiveContacts::Entry& entry = active_.entries[place];
        if (!(entry.extent > 0)) return 0;
        return speed_borne(entry, contact_of(entry), masses_, by_most_loaded)
            * per_speed_[entry.points - 1u] / double{entry.extent};
    }

    // Of all bodies the most that one passes on: the second of his gives, as what presses him goes
    // on through the others. Where it goes on by many ways, as in a heap, none of them is a column.
    // Who has but two neighbours, or hangs on a pivot, shows it by the first. What stands still is
    // one neighbour, of however many parts.
    double most_borne(std::size_t island) const
    {
        auto& gives = overloaded_.scratch.gives;
        const auto index = [&](std::uint32_t body) { return layout_.solver_index[body]; };
        for (const std::uint32_t body : islands_.bodies_of(island)) gives[index(body)] = {};
        for (std::uint32_t k = islands_.contact_begin[island];
             k < islands_.contact_begin[island + 1]; ++k) {
            const ActiveContacts::Entry& entry = active_.entries[islands_.contacts[k]];
            const float give = overloaded_.scratch.contact_gives[k];
            const std::uint32_t a = index(entry.body_a), b = index(entry.body_b);
            if (a == Layout::kNoSolverIndex)
                gives[b].ground += give;
            else if (b == Layout::kNoSolverIndex)
                gives[a].ground += give;
            else {
                gives[a].add(give);
                gives[b].add(give);
            }
        }
        float most = 0;
        for (const std::uint32_t body : islands_.bodies_of(island)) {
            auto& of = gives[index(body)];
            if (of.ground > 0) of.add(of.ground);
            most = std::max(most, of.count > 2 ? of.second : of.first);
        }
        return double{most};
    }

    // Of all contacts of an island; returns the greatest.
    double find_gives(std::size_t island, bool by_most_loaded) const
    {
        float greatest = 0;
        for (std::uint32_t k = islands_.contact_begin[island];
             k < islands_.contact_begin[island + 1]; ++k) {
            const auto give = static_cast<float>(give_of(islands_.contacts[k], by_most_loaded));
            overloaded_.scratch.contact_gives[k] = give;
            greatest = std::max(greatest, give);
        }
        return double{greatest};
    }

    // Of those that no contact moves and that it touches the first, or none: what it stands on.
    std::uint32_t ground_of(std::size_t island) const
    {
        std::uint32_t ground = kNoBody;
        touches_unmoved(island, [&](std::uint32_t body) {
            ground = body;
            return true;
        });
        return ground;
    }

    // m2/s2, seen from what it stands on, by mass, as a light body between heavy ones may tremble.
    double mean_square_speed(std::size_t island) const
    {
        const std::uint32_t ground = ground_of(island);
        const auto with_ground = [&](std::uint32_t body) -> Vec3 {
            if (ground == kNoBody) return Vec3::Zero();
            const Vec3 arm = poses_.position[body] - poses_.position[ground];
            return velocities_.linear[ground] + velocities_.angular[ground].cross(arm);
        };
        double mass = 0, twice_energy = 0;
        for (const std::uint32_t body : islands_.bodies_of(island)) {
            mass += masses_.mass[body];
            twice_energy +=
                masses_.mass[body] * (velocities_.linear[body] - with_ground(body)).squaredNorm();
        }
        return twice_energy / mass;
    }

    // Overlaps are of the step's start, when it had not been helped yet.
    bool is_solved_exactly(std::size_t island) const
    {
        const auto bodies = islands_.bodies_of(island);
        return std::any_of(bodies.begin(), bodies.end(),
                           [&](std::uint32_t body) { return overloaded_.of(body) < 0; });
    }

    // Whether a contact still overlaps about as the most loaded one did before it was escalated:
    // who bears next to nothing may well overlap by more than his own load makes.
    bool is_deep(std::size_t island, double most) const
    {
        const auto contacts = islands_.contacts_of(island);
        return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t place) {
            const ActiveContacts::Entry& entry = active_.entries[place];
            const double overlap{contact_of(entry).overlap(entry.points)};
            return overlap > kDeep * most * rigid_overlap(double{entry.extent}, entry.points);
        });
    }

    // Whether somebody light who touches somebody heavy is still driven in after the step.
    bool is_crushed(std::size_t island) const
    {
        const auto contacts = islands_.contacts_of(island);
        if (contacts.size() > kCrushedContacts) return false;
        const auto entry = [&](std::uint32_t place) -> const ActiveContacts::Entry& {
            return active_.entries[place];
        };
        return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t place) {
            if (!(approach(entry(place)) * step_ > kDriven * double{entry(place).extent}))
                return false;
            const std::uint32_t light = lighter(entry(place));
            return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t other) {
                const std::uint32_t a = entry(other).body_a, b = entry(other).body_b;
                return (a == light && is_heavy_for(masses_, b, light))
                    || (b == light && is_heavy_for(masses_, a, light));
            });
        });
    }

    std::uint32_t lighter(const ActiveContacts::Entry& entry) const
    {
        const auto& inverse_mass = masses_.inverse_mass;
        return inverse_mass[entry.body_a] > inverse_mass[entry.body_b] ? entry.body_a
                                                                       : entry.body_b;
    }

    // m/s, of the middles of two bodies.
    double approach(const ActiveContacts::Entry& entry) const
    {
        const Vec3T<Real>& normal = contact_of(entry).normal;
        return (velocities_.linear[entry.body_a] - velocities_.linear[entry.body_b])
            .dot(normal.template cast<double>());
    }

    // Whether a contact overlaps by more than a share of the extent.
    bool overlaps(std::span<const std::uint32_t> contacts, double share) const
    {
        return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t place) {
            const ActiveContacts::Entry& entry = active_.entries[place];
            const double overlap{contact_of(entry).overlap(entry.points)};
            return overlap > share * double{entry.extent};
        });
    }

    // Bodies on the shortest way down to what stands still, of the one furthest from it.
    int height_of(std::size_t island) const
    {
        constexpr int kUnreached = 0xffff;
        const auto height = [&](std::uint32_t body) -> int {
            const std::uint32_t solver_index = layout_.solver_index[body];
            return solver_index == Layout::kNoSolverIndex
                ? 0
                : overloaded_.scratch.height[solver_index];
        };
        const auto lower = [&](std::uint32_t body, int below) {
            if (height(body) <= below + 1) return false;
            overloaded_.scratch.height[layout_.solver_index[body]] =
                static_cast<std::uint16_t>(below + 1);
            return true;
        };
        for (const std::uint32_t body : islands_.bodies_of(island))
            overloaded_.scratch.height[layout_.solver_index[body]] = kUnreached;
        // Forth and back by turns: a column is done in two, whichever way its contacts go.
        const auto contacts = islands_.contacts_of(island);
        const auto lower_by = [&](std::uint32_t contact) {
            const ActiveContacts::Entry& entry = active_.entries[contact];
            const bool a = lower(entry.body_a, height(entry.body_b));
            return lower(entry.body_b, height(entry.body_a)) || a;
        };
        bool lowered = true;
        for (bool forth = true; lowered; forth = !forth) {
            lowered = false;
            for (std::size_t k = 0; k < contacts.size(); ++k)
                lowered = lower_by(contacts[forth ? k : contacts.size() - 1 - k]) || lowered;
        }
        int highest = 1;
        for (const std::uint32_t body : islands_.bodies_of(island))
            if (height(body) != kUnreached) highest = std::max(highest, height(body));
        return highest;
    }

    double strain_before(std::size_t island) const
    {
        if (overloaded_.strained.empty()) return 0;
        double most = 0;
        for (const std::uint32_t body : islands_.bodies_of(island))
            most = std::max(most, std::abs(double{overloaded_.of(body)}));
        return most;
    }

    const Islands& islands_;
    const Layout& layout_;
    const ActiveContacts& active_;
    const Masses& masses_;
    const Poses& poses_;
    const Velocities& velocities_;
    const ConvexContacts<Real>& convex_;
    const MeshContacts<Real>& meshes_;
    const SolidContacts<Real>& solids_;
    const JoinedContacts<Real>& joined_;
    const ContactConstraints<Real>& constraints_;
    OverloadedIslands& overloaded_;
    double resting_;       // m/s
    double step_;          // s
    Vec3 gravity_;         // m/s2
    double falls_;         // m/s, in a step
    double per_speed_[4];  // s, by points, less one: overlap over the rigid share of the extent
};

}  // namespace

template <class Real>
void measure_strain(const StepContext& context,
                    const SolverParameters& parameters,
                    const Islands& islands,
                    const Layout& layout,
                    const ActiveContacts& active,
                    const Masses& masses,
                    const Poses& poses,
                    const Velocities& velocities,
                    const ConvexContacts<Real>& convex,
                    const MeshContacts<Real>& meshes,
                    const SolidContacts<Real>& solids,
                    const JoinedContacts<Real>& joined,
                    const ContactConstraints<Real>& constraints,
                    OverloadedIslands& overloaded)
{
    const std::size_t count = islands.size();
    overloaded.scratch.of_island.resize(count);
    overloaded.scratch.limited.resize(count);
    overloaded.scratch.height.resize(layout.body_of_solver_index.size());
    overloaded.scratch.gives.resize(layout.body_of_solver_index.size());
    overloaded.scratch.contact_gives.resize(islands.contacts.size());
    const Gauge<Real> gauge(context, parameters, islands, layout, active, masses, poses, velocities,
                            convex, meshes, solids, joined, constraints, overloaded);
    for_each_block(count, kIslands, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const bool looked_at = gauge.is_looked_at(i);
            overloaded.scratch.of_island[i] = looked_at ? float(gauge.strain_of(i)) : 0;
            overloaded.scratch.limited[i] = looked_at ? gauge.limited(i) : 0;
        }
    });

    overloaded.forget_all();
    const auto note = [&](std::size_t island, auto of_island, auto& of_bodies, auto& bodies) {
        if (of_island == 0) return;
        of_bodies.resize(layout.solver_index.size(), 0);
        for (std::uint32_t k = islands.body_begin[island]; k < islands.body_begin[island + 1];
             ++k) {
            of_bodies[islands.bodies[k]] = of_island;
            bodies.push_back(islands.bodies[k]);
        }
    };
    for (std::size_t i = 0; i < count; ++i) {
        note(i, overloaded.scratch.of_island[i], overloaded.strain, overloaded.strained);
        note(i, overloaded.scratch.limited[i], overloaded.limited, overloaded.gainers);
    }
}

#define THRONG_INSTANTIATE(Real)                                                                   \
    template void measure_strain<Real>(                                                            \
        const StepContext&, const SolverParameters&, const Islands&, const Layout&,                \
        const ActiveContacts&, const Masses&, const Poses&, const Velocities&,                     \
        const ConvexContacts<Real>&, const MeshContacts<Real>&, const SolidContacts<Real>&,        \
        const JoinedContacts<Real>&, const ContactConstraints<Real>&, OverloadedIslands&);
THRONG_INSTANTIATE(float)
THRONG_INSTANTIATE(double)
#undef THRONG_INSTANTIATE

}  // namespace throng
