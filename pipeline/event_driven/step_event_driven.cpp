// Carry groups: bodies that may meet in this step, found as they are carried through it.
//
// Bodies that touch as the step begins are a group, each other one is a group of its own, and is
// carried through the step with what nothing moves (event_driven_group.hpp). Groups whose ways
// cross may have met: they are put back to where the step began, joined, and carried as one; and
// again, until no ways of different groups cross. So contacts that exist only because of an earlier
// one are found as any other, and bodies far off pay nothing for them. The outcome is that of each
// group alone: the same on any number of threads.
//
// Source: Mirtich, Timewarp Rigid Body Simulation (2000), for going back alone with those
// concerned.
#include "broadphase/broadphase.hpp"
#include "kernels/parallel/blocks.hpp"
#include "kernels/parallel/disjoint_sets.hpp"
#include "pipeline/event_driven/event_driven_group.hpp"
#include "pipeline/step/stages.hpp"

#include <algorithm>
#include <map>

namespace throng {

namespace {

// What a step may cost for each body in it, see EventDrivenGroup::spend(): four times what heaps
// that fall on one another take, and twice what two meshes do that lie face on face. Groups that
// are joined are carried again on what is left of it, and on no less than so much for a body as
// takes it through a quiet step.
constexpr std::uint64_t kWork = 50000, kLeastWork = 200;

// One of EventDrivenGroup's two ways through a step.
using AdvanceGroup = void (EventDrivenGroup::*)();

class Carriage {
public:
    Carriage(GroupScene& scene, AdvanceGroup way)
        : scene_(scene), way_(way), poses_(scene.poses), velocities_(scene.velocities)
    {
        for (const std::uint32_t body : scene.states.active_bodies.dynamic)
            if (scene.states.movable(body)) bodies_.push_back(body);
        const std::size_t count = scene.states.kind.size();
        scene.flights.memory.resize(count);
        scene.ways.resize(count);
        work_left_ = kWork * bodies_.size();
        sets_.reset(count);
        for (const std::uint32_t body : bodies_) sets_.add(body);
        for (std::uint32_t i = 0; i < scene.colliders.size(); ++i) {
            const std::uint32_t body = scene.colliders.body[i];
            if (body != kNoBody && !scene.states.movable(body)) scene.obstacles.push_back(i);
        }
        for (const auto& group : scene.forces.groups)
            for (const std::uint32_t body : group)
                if (sets_.holds(body) && sets_.holds(group.front()))
                    sets_.join(group.front(), body);
    }

    void run(EventDrivenContacts& contacts, StepDiagnostics& diagnostics)
    {
        join_touching();
        // Each round but the last leaves fewer groups.
        for (std::size_t round = 0; round <= bodies_.size(); ++round) {
            list_groups();
            advance_groups();
            if (!join_crossing()) break;
        }
        for (const auto& [first, group] : groups_) {
            const GroupOutcome& outcome = group.outcome;
            diagnostics.held_groups += outcome.held || outcome.short_of_work ? 1 : 0;
            diagnostics.deep_pieces += outcome.deep_pieces;
            diagnostics.deepest = std::max(diagnostics.deepest, outcome.deepest);
            diagnostics.direct_residual = std::max(diagnostics.direct_residual, outcome.residual);
            add_contacts(outcome, contacts);
        }
    }

private:
    struct Group {
        std::vector<std::uint32_t> bodies;  // ascending
        GroupOutcome outcome;
    };

    void add_contacts(const GroupOutcome& outcome, EventDrivenContacts& contacts) const
    {
        const double dt = scene_.context.dt;
        for (const auto& [body, impulse] : outcome.pushes) contacts.force[body] += impulse / dt;
        contacts.pairs += outcome.pairs;
        contacts.touching += outcome.touching;
        contacts.points += outcome.points;
        contacts.groups += outcome.touching > 0 ? 1 : 0;
    }

    // Those that are as they were keep what was found of them.
    void list_groups()
    {
        std::map<std::uint32_t, std::vector<std::uint32_t>> members;
        for (const std::uint32_t body : bodies_) members[sets_.find(body)].push_back(body);
        std::erase_if(groups_, [&](const auto& entry) { return !members.contains(entry.first); });
        changed_.clear();
        for (auto& [first, bodies] : members) {
            Group& group = groups_[first];
            if (group.bodies.size() == bodies.size()) continue;
            group = {std::move(bodies), {}};
            changed_.push_back(&group);
        }
    }

    void advance_groups()
    {
        std::size_t bodies = 0;
        for (const Group* group : changed_) bodies += group->bodies.size();
        work_of_body_ = std::max(kLeastWork, work_left_ / std::max<std::size_t>(bodies, 1));
        for_each_block(changed_.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) carry(*changed_[i]);
        });
        for (const Group* group : changed_) work_left_ -= std::min(work_left_, group->outcome.work);
    }

    void carry(Group& group)
    {
        for (const std::uint32_t body : group.bodies) {
            scene_.poses.position[body] = poses_.position[body];
            scene_.poses.orientation[body] = poses_.orientation[body];
            scene_.velocities.linear[body] = velocities_.linear[body];
            scene_.velocities.angular[body] = velocities_.angular[body];
            scene_.ways[body] = {};
        }
        EventDrivenGroup event_group(scene_, group.bodies, group.bodies.size() * work_of_body_);
        (event_group.*way_)();
        group.outcome = event_group.outcome();
    }

    bool may_meet(std::uint32_t a, std::uint32_t b) const
    {
        const Colliders& colliders = scene_.colliders;
        for (std::uint32_t i = 0; i < colliders.count[a]; ++i)
            for (std::uint32_t k = 0; k < colliders.count[b]; ++k)
                if (scene_.filter.allows(colliders.begin[a] + i, colliders.begin[b] + k))
                    return true;
        return false;
    }

    // Those that are within reach of one another from the start would be joined after they have
    // been carried in vain.
    void join_touching()
    {
        const Colliders& colliders = scene_.colliders;
        for (const std::uint32_t body : bodies_) {
            scene_.ways[body] = {};
            for (std::uint32_t i = 0; i < colliders.count[body]; ++i) {
                const std::uint32_t at = colliders.begin[body] + i;
                Box3 box = scene_.box_of(at, poses_.at(body));
                box.lower.array() -= scene_.touching_margin(at);
                box.upper.array() += scene_.touching_margin(at);
                scene_.ways[body] = joined(scene_.ways[body], box);
            }
        }
        join_crossing();
    }

    // False if no ways of different groups cross.
    bool join_crossing()
    {
        const std::vector<std::uint8_t> moving(scene_.ways.size(), 1);
        AnyPairFinder finder = make_finder(choose_finder(scene_.ways, moving));
        std::vector<PairKey> pairs;
        find_overlaps({scene_.ways, moving, bodies_, true, nullptr}, finder, pairs);
        bool any = false;
        for (const PairKey key : pairs) {
            const std::uint32_t a = first_of(key), b = second_of(key);
            if (sets_.find(a) == sets_.find(b) || !may_meet(a, b)) continue;
            sets_.join(a, b);
            any = true;
        }
        return any;
    }

    GroupScene& scene_;
    AdvanceGroup way_;
    Poses poses_;  // as the step began
    Velocities velocities_;
    std::vector<std::uint32_t> bodies_;  // ascending
    DisjointSets sets_;
    std::map<std::uint32_t, Group> groups_;  // by their first bodies
    std::vector<Group*> changed_;
    std::uint64_t work_left_ = 0, work_of_body_ = 0;
};

void advance_all(const EventDrivenStep& step, AdvanceGroup way)
{
    auto& diagnostics = step.get<StepDiagnostics>();
    diagnostics.quarantined.clear();
    diagnostics.direct_left = diagnostics.held_groups = diagnostics.deep_pieces = 0;
    diagnostics.direct_residual = diagnostics.deepest = 0;
    step.get<Islands>().lone.clear();  // none is left to fly alone
    auto& contacts = step.get<EventDrivenContacts>();
    const auto& states = step.get<const BodyStates>();
    contacts = {};
    contacts.force.assign(states.kind.size(), Vec3::Zero());
    GroupScene scene{step.get<const StepContext>(),
                     step.get<const SolverParameters>(),
                     step.get<const ImpactParameters>(),
                     step.get<const Shapes>(),
                     step.get<const Surfaces>(),
                     step.get<const PairFilter>(),
                     step.get<const Colliders>(),
                     states,
                     step.get<const Masses>(),
                     step.get<const Forces>(),
                     step.get<const PrescribedVelocities>(),
                     step.get<Poses>(),
                     step.get<Velocities>(),
                     step.get<Flights>(),
                     {},
                     {}};
    Carriage(scene, way).run(contacts, diagnostics);
}

}  // namespace

std::vector<PassRow> back_up_passes() { return EventDrivenGroup::passes_of_back_up(); }
std::vector<PassRow> subdivide_passes() { return EventDrivenGroup::passes_of_subdivide(); }

void back_up(const EventDrivenStep& step) { advance_all(step, &EventDrivenGroup::back_up); }

void subdivide(const EventDrivenStep& step) { advance_all(step, &EventDrivenGroup::subdivide); }

}  // namespace throng
