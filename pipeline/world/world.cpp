#include "throng/world.hpp"

#include "broadphase/margins.hpp"
#include "kernels/dynamics/rigid_motion.hpp"
#include "kernels/solver/direct/direct.hpp"
#include "pipeline/solvers/escalation.hpp"
#include "pipeline/solvers/relax_iterations.hpp"
#include "pipeline/step/step_table.hpp"
#include "pipeline/world/contact_impulses.hpp"
#include "pipeline/world/force_builder.hpp"
#include "pipeline/world/world_state.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/rules/scene_check.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <stdexcept>

namespace throng {

namespace {

void check_settings(const Settings& settings, const char* caller)
{
    Scene scene;
    scene.settings = settings;
    if (const std::string trouble = check_scene(scene); !trouble.empty())
        throw std::invalid_argument(std::string(caller) + ": " + trouble);
}

int checked_threads(int threads)
{
    constexpr int kMost = 4096;
    if (threads < 0 || threads > kMost)
        throw std::invalid_argument("world: threads: wanted 1 to " + std::to_string(kMost)
                                    + ", or 0 for as many as there are cores, not "
                                    + std::to_string(threads));
    return threads;
}

}  // namespace

template <class Real>
Step<Real>::Step() = default;
template <class Real>
Step<Real>::~Step() = default;
template struct Step<float>;
template struct Step<double>;

WorldState::WorldState(const Settings& all, int thread_count) : pool(checked_threads(thread_count))
{
    check_settings(all, "world");
    // Throws here and not in a step where the environment asks for lanes that cannot be had.
    solve_kernels<float>();
    if (all.precision == Precision::double_) step.emplace<Step<double>>();
    set(all);
}

void WorldState::set(const Settings& all)
{
    settings = all;
    get<StepContext>().set(all);
    get<NarrowPhaseParameters>().set(all);
    get<ImpactParameters>().set(all);
    get<SolverParameters>().set(all);
    get<SleepParameters>().set(all);
    get<NeglectParameters>().set(all);
    get<Masses>().gyroscopic_kind = get<Masses>().inertia_kind;
    get<NeglectedEffects>() = {};
}

std::uint32_t WorldState::place_of(BodyId body, const char* caller) const
{
    door.need_no_step(caller);
    if (body.index < generation.size() && generation[body.index] == body.generation
        && get<BodyStates>().kind[body.index] != BodyKind::removed)
        return body.index;
    if (body == BodyId{})
        throw std::invalid_argument(std::string(caller)
                                    + ": this id names no body; give one that "
                                      "add() or bodies() gave");
    throw std::invalid_argument(std::string(caller) + ": body " + std::to_string(body.index)
                                + " was removed or never was; give one that is alive");
}

FinderKind WorldState::wanted_finder() const
{
    switch (settings.broadphase) {
    case BroadPhase::embree:
        return FinderKind::embree;
    case BroadPhase::grid:
        return FinderKind::grid;
    case BroadPhase::sweep:
        return FinderKind::sweep;
    case BroadPhase::all_pairs:
        return FinderKind::all_pairs;
    default:
        break;
    }
    const auto& colliders = get<Colliders>();
    const auto& states = get<BodyStates>();
    std::vector<Box3> boxes(colliders.size());
    std::vector<std::uint8_t> moving(colliders.size(), 0);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const std::uint32_t body = colliders.body[i];
        if (body == kNoBody) continue;
        const Vec3 middle = (get<Poses>().at(body) * colliders.local[i]).position;
        boxes[i] = {middle.array() - colliders.outer_radius[i],
                    middle.array() + colliders.outer_radius[i]};
        moving[i] = states.kind[body] != BodyKind::static_ ? 1 : 0;
    }
    return choose_finder(boxes, moving);
}

// Once more where there are many more bodies than when it was chosen, or many fewer: what there is
// of them decides, and to look at all takes time.
void WorldState::choose_broad_phase()
{
    finder_chosen_for = alive;
    const FinderKind kind = wanted_finder();
    AnyPairFinder& finder = get<Finder>().finder;
    const bool any = !get<Pairs>().keys.empty() || get<SleepingPairs>().size() > 0;
    if (finder.index() == make_finder(kind).index() && any) return;
    finder = make_finder(kind);
    // A new finder has to be asked about everybody, and finds pairs of whoever sleeps, too.
    call_all_pairs();
    auto& bounds = get<Bounds>();
    bounds.touched.resize(get<Colliders>().size());
    std::iota(bounds.touched.begin(), bounds.touched.end(), 0u);
}

bool WorldState::nothing_to_do() const
{
    const auto& context = get<StepContext>();
    const bool edits = !changed.empty() || !woken.empty() || !edited.empty()
        || active_bodies_stopped || !get<Bounds>().touched.empty();
    return idle && !edits && !effects_stale && !census_stale && !active_bodies_stale
        && context.last_substep == context.substep();
}

void WorldState::hold_strain()
{
    auto& overloaded = get<OverloadedIslands>();
    auto& held = get<RestingBodies>().strained;
    for (const std::uint32_t body : get<SleepEvents>().fell_asleep)
        if (is_overloaded(overloaded.of(body))) held.push_back({body, overloaded.of(body)});
    std::erase_if(held, [&](const auto& one) { return !get<BodyStates>().rests(one.body); });
    for (const auto& [body, strain] : held) {
        if (overloaded.strain.size() <= body) overloaded.strain.resize(body + std::size_t{1}, 0);
        overloaded.strain[body] = strain;
        overloaded.strained.push_back(body);
    }
}

void WorldState::follow_stubborn()
{
    auto& overloaded = get<OverloadedIslands>();
    report.islands_escalated += overloaded.escalated;
    report.escalation_missed += overloaded.missed;
    report.escalation_work += overloaded.work;
    overloaded.escalated = overloaded.missed = overloaded.work = 0;
    if (rests_by_force(settings))
        hold_strain();
    else
        for (const std::uint32_t body : get<SleepEvents>().fell_asleep) overloaded.forget(body);
    std::uint32_t first = kNoBody;
    for (const std::uint32_t body : overloaded.strained)
        if (is_overloaded(overloaded.of(body))) first = std::min(first, body);
    for (const std::uint32_t body : overloaded.gainers)
        if (overloaded.limited_for(body) > 0) first = std::min(first, body);
    const bool any = first != kNoBody;
    if (any == effects.on.has(Effect::escalation) || left_out.has(Effect::escalation)) return;
    requests.first[static_cast<std::size_t>(Effect::escalation)].clear();
    if (any) requests.ask(Effect::escalation, called(first));
    effects_stale = true;
}

std::string WorldState::called(std::uint32_t body) const
{
    const bool named = body < names.size() && !names[body].empty();
    return "body " + std::to_string(body) + (named ? " " + names[body] : "");
}

void WorldState::follow_step()
{
    follow_stubborn();
    auto& diagnostics = get<StepDiagnostics>();
    auto& sleep_events = get<SleepEvents>();
    if (!diagnostics.quarantined.empty() || !sleep_events.woke.empty()
        || !sleep_events.fell_asleep.empty())
        update_active_bodies(sleep_events.woke, get<BodyStates>());
    for (const std::uint32_t body : sleep_events.fell_asleep) note_moved(body);
    const ActiveBodies& active_bodies = get<BodyStates>().active_bodies;
    get<Bounds>().stretch = stretch_for(get<Pairs>().keys.size() + get<SleepingPairs>().size(),
                                        active_bodies.dynamic.size());
    // A body that has become fast calls for what looks after it from the next step on.
    if (const auto& fast_candidates = get<Bounds>().fast_candidates; !fast_candidates.empty()
        && !effects.on.has(Effect::fast_motion) && !left_out.has(Effect::fast_motion)) {
        requests.ask(Effect::fast_motion, called(fast_candidates.front()));
        effects_stale = true;
    }
    if (diagnostics.quarantined.empty()) return;
    report.bodies_quarantined += diagnostics.quarantined.size();
    for (const std::uint32_t body : diagnostics.quarantined) {
        mark_changed(body);
        changed.push_back(body);
    }
    diagnostics.quarantined.clear();
}

void WorldState::report_state()
{
    report.pairs = get<Pairs>().keys.size() + get<SleepingPairs>().size();
    const auto& active = get<ActiveContacts>().entries;
    report.manifolds = active.size();
    report.contacts = 0;
    for (const auto& entry : active) report.contacts += entry.points;
    report.islands = get<Islands>().size();
    report.colors = 0;
    for (const Slice& slice : get<Layout>().slices)
        report.colors = std::max<std::size_t>(report.colors, slice.colors);
    const bool relaxes =
        settings.solver == Solver::soft_step && settings.response == Response::impulse;
    report.relax_iterations = relaxes
        ? mean_relax_iterations(get<SolverParameters>(), settings.substeps, get<Layout>())
        : 0;
    report.bodies_awake = get<BodyStates>().active_bodies.dynamic.size();
    if (!effects.on.meets(kEventDriven)) return;
    const auto& carried = get<EventDrivenContacts>();
    report.pairs = carried.pairs;
    report.manifolds = carried.touching;
    report.contacts = carried.points;
    report.islands = carried.groups;
}

void WorldState::refresh()
{
    settle();
    refresh_effects();
    if (active_bodies_stale) {
        list_active_bodies(get<BodyStates>());
    } else if (!woken.empty() || active_bodies_stopped) {
        std::sort(woken.begin(), woken.end());
        update_active_bodies(woken, get<BodyStates>());
    }
    active_bodies_stale = active_bodies_stopped = false;
    woken.clear();
}

void WorldState::warn_of_cuts(int cuts)
{
    if (cuts <= most_cuts) return;
    most_cuts = cuts;
    warnings.push_back(
        "penalty_stiffness: " + dial_value(settings, "penalty_stiffness")
        + " N/m swings wider at a substep of " + number_text(settings.dt / settings.substeps)
        + " s, so each is cut in " + std::to_string(cuts)
        + (cuts >= kMostPenaltyCuts ? ", and contacts give way as far as that bears" : "")
        + "; take substeps=" + std::to_string(settings.substeps * cuts) + ", or auto");
}

double WorldState::velocity_lag(std::uint32_t body) const
{
    const auto& context = get<StepContext>();
    if (context.effects.meets(kEventDriven)) return 0;
    const bool kicked = context.integrator == Integrator::semi_implicit
        || (context.integrator == Integrator::auto_ && !get<Forces>().act_on(body));
    const int times = get<Flights>().lags_of(body);
    return kicked || times > 0 ? context.substep() / (2 * std::max(times, 1)) : 0;
}

Vec3 WorldState::arm(std::uint32_t body) const
{
    const auto& pivot_to_center = get<Forces>().pivot_to_center;
    return body < pivot_to_center.size()
        ? Vec3(get<Poses>().orientation[body] * pivot_to_center[body])
        : Vec3(Vec3::Zero());
}

Vec3 WorldState::center_of_mass(std::uint32_t body) const
{
    return get<Poses>().position[body] + arm(body);
}

Vec3 WorldState::velocity(std::uint32_t body) const
{
    const auto& velocities = get<Velocities>();
    return velocities.linear[body] + velocities.angular[body].cross(arm(body));
}

void WorldState::warn_of_substeps()
{
    std::vector<std::string> found = unstable_springs(get<Forces>(), get<Masses>(), settings);
    // What weight adds in one has few digits left beside a speed of some m/s.
    constexpr double kShortest = 1e-5;
    if (settings.precision == Precision::float_ && settings.dt / settings.substeps < kShortest)
        found.push_back("a substep of " + number_text(settings.dt / settings.substeps)
                        + " s is too short for float, which takes 1e-05 s and more: what weight"
                          " adds in it is lost in the digits of a speed; take"
                          " precision=double");
    for (std::string& warning : found)
        if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
            warnings.push_back(std::move(warning));
}

EffectFacts WorldState::effect_facts() const
{
    return {{settings, get<StepContext>().gravity, get<BodyStates>(), get<Velocities>(),
             get<Masses>(), get<Forces>(), get<Shapes>(), get<Colliders>(), get<PairFilter>()},
            get<PrescribedVelocities>(),
            get<Surfaces>(),
            requests,
            names,
            material_names,
            left_out};
}

void WorldState::name_causes()
{
    refresh();
    if (causes_stale) effects = find_effects(effect_facts(), get<EffectCensus>());
    causes_stale = false;
}

void WorldState::follow_changes()
{
    if (!census_stale && changed.empty()) return;
    const EffectFacts facts = effect_facts();
    auto& census = get<EffectCensus>();
    const std::size_t changes = census.changes();
    if (census_stale)
        census.count_all(facts.bodies);
    else
        for (const std::uint32_t body : changed) census.recount(body, facts.bodies);
    effects_stale = effects_stale || census.changes() != changes;
    causes_stale = true;
    census_stale = false;
    changed.clear();
}

void WorldState::refresh_effects()
{
    follow_changes();
    bool anew = graph_stale;
    if (anew) finder_chosen_for = 0;
    if (effects_stale) {
        effects_stale = false;
        causes_stale = true;
        auto& context = get<StepContext>();
        effects.on = effects_called_for(effect_facts(), get<EffectCensus>());
        anew = anew || effects.on != context.effects;
        context.effects = effects.on;
    }
    if (anew) remake_graph();
    if (!effects.on.has(Effect::contact)) finder_chosen_for = 0;
    const std::size_t more =
        alive > finder_chosen_for ? alive - finder_chosen_for : finder_chosen_for - alive;
    if (effects.on.has(Effect::contact) && 4 * more > finder_chosen_for) choose_broad_phase();
}

// With what no stage writes any more emptied.
void WorldState::remake_graph()
{
    graph_stale = false;
    empty_unused();
    std::visit(
        [&](auto& chosen) {
            using Graph = typename std::remove_reference_t<decltype(chosen.graph)>::element_type;
            using Real = std::conditional_t<std::is_same_v<Graph, StepGraph<float>>, float, double>;
            std::vector<Stage<Real>> stages = stages_for<Real>(effects.on, settings);
            const auto same = [](const Stage<Real>& a, const Stage<Real>& b) {
                return a.name == b.name;
            };
            if (chosen.graph && std::ranges::equal(chosen.graph->stages(), stages, same)) return;
            pool.run([&](std::size_t, std::size_t, std::size_t) {
                chosen.graph = std::make_unique<Graph>(std::move(stages), chosen.data);
            });
        },
        step);
}

static_assert(kMissedResidual == kDirectResidual);

World::World(const Settings& settings, int threads)
    : state_(std::make_unique<WorldState>(settings, threads))
{ }

World::World(const Scene& scene, int threads) : World(scene.settings, threads)
{
    set_gravity(scene.gravity);
    add(scene);
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

std::vector<BodyId> World::add(const Scene& scene)
{
    const Door::Entry entry(state_->door, "add");
    if (std::optional<SceneTrouble> trouble = find_trouble(scene))
        throw SceneRefused(std::move(*trouble));
    return SceneBuilder(*state_).add(scene);
}

void World::step(int steps)
{
    if (steps < 0) throw std::invalid_argument("step: give a number of steps from 0");
    WorldState& state = *state_;
    Door::Step at_work(state.door);
    using Clock = std::chrono::steady_clock;
    state.events = {};
    for (int i = 0; i < steps; ++i) {
        const auto begin = Clock::now();
        if (state.nothing_to_do()) {
            std::visit([](auto& chosen) { chosen.graph->rest(); }, state.step);
        } else {
            state.refresh();
            state.idle = state.get<BodyStates>().active_bodies.none()
                && state.get<Bounds>().touched.empty() && state.get<RestingBodies>().waking.empty();
            if (state.sensing != nullptr) state.sensing->before_step();
            state.pool.run([&](std::size_t, std::size_t, std::size_t) {
                std::visit(
                    [&](auto& chosen) {
                        chosen.graph->watch(state.watch);
                        chosen.graph->count(&state.work);
                        if (state.in_order)
                            chosen.graph->run_in_order();
                        else
                            chosen.graph->run();
                    },
                    state.step);
            });
            auto& context = state.get<StepContext>();
            context.last_substep = context.substep();
            state.contacts_as_stepped = true;
            state.report.contacts_dropped += std::visit(
                [](const auto& chosen) {
                    using Real = typename std::decay_t<decltype(chosen)>::Number;
                    return std::get<SolidContacts<Real>>(chosen.data).left_out;
                },
                state.step);
            state.report.fallbacks += state.get<MethodPairs>().fell_back;
            const auto& diagnostics = state.get<StepDiagnostics>();
            state.report.fallbacks +=
                diagnostics.direct_left + diagnostics.held_groups + diagnostics.deep_pieces;
            state.report.deepest = std::max(state.report.deepest, diagnostics.deepest);
            state.warn_of_cuts(diagnostics.penalty_cuts);
            state.report.direct_residual =
                std::max(state.report.direct_residual, diagnostics.direct_residual);
            state.end_pushes();
            state.follow_step();
            state.follow_touching_pairs();
            if (state.sensing != nullptr) state.sensing->after_step();
        }
        state.get<StepContext>().time += settings().dt;
        ++state.report.step;
        state.report.time_ms =
            std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    }
    state.report_state();
    at_work.end();
}

const Settings& World::settings() const { return state_->settings; }

void World::set_settings(const Settings& settings)
{
    const Door::Entry entry(state_->door, "set_settings");
    if (settings.precision != this->settings().precision)
        throw std::invalid_argument(
            "set_settings: precision cannot change in a world; make another");
    check_settings(settings, "set_settings");
    state_->get<Flights>() = {};  // numbers of another rotation, or of another law
    // Who rests by itself does so by impulses that others may bear by now, each alone.
    if (rests_by_force(this->settings()) || rests_by_force(settings)) state_->wake_all();
    state_->call_all_pairs();  // which may remember what another method found
    state_->set(settings);
    state_->effects_stale = state_->census_stale = state_->graph_stale = true;
    state_->warn_of_substeps();
}

Vec3 World::gravity() const { return state_->get<StepContext>().gravity; }

void World::set_gravity(const Vec3& gravity)
{
    const Door::Entry entry(state_->door, "set_gravity");
    if (!(gravity.array().abs() <= kGreatestLength).all())
        throw std::invalid_argument("set_gravity: wanted an acceleration in m/s2, of 1e15 at most");
    state_->get<StepContext>().gravity = gravity;
    for (const auto& [body, applied] : state_->applied_forces) state_->sum_forces(body);
    state_->effects_stale = state_->census_stale = true;
    state_->wake_all();
}

std::size_t World::body_count() const { return state_->alive; }

std::vector<BodyId> World::bodies() const
{
    state_->door.need_no_step("bodies");
    std::vector<BodyId> ids;
    ids.reserve(state_->alive);
    const auto& states = state_->get<BodyStates>();
    for (std::uint32_t body = 0; body < states.kind.size(); ++body)
        if (states.kind[body] != BodyKind::removed) ids.push_back({body, state_->generation[body]});
    return ids;
}

bool World::alive(BodyId body) const
{
    return body.index < state_->generation.size()
        && state_->generation[body.index] == body.generation
        && state_->get<BodyStates>().kind[body.index] != BodyKind::removed;
}

const std::string& World::name(BodyId body) const
{
    static const std::string kUnnamed;
    const std::uint32_t at = state_->place_of(body, "name");
    return at < state_->names.size() ? state_->names[at] : kUnnamed;
}

Motion World::motion(BodyId body) const { return state_->motion[state_->place_of(body, "motion")]; }

bool World::awake(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "awake");
    state_->settle();
    return state_->get<BodyStates>().awake[at] != 0;
}

bool World::quarantined(BodyId body) const
{
    return state_->get<BodyStates>().quarantined[state_->place_of(body, "quarantined")] != 0;
}

double World::mass(BodyId body) const
{
    return state_->get<Masses>().mass[state_->place_of(body, "mass")];
}

Pose World::pose(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "pose");
    const Pose center = state_->get<Poses>().at(at);
    return {center * Vec3(-state_->center[at]), center.orientation};
}

Vec3 World::center_of_mass(BodyId body) const
{
    return state_->center_of_mass(state_->place_of(body, "center_of_mass"));
}

Vec3 World::velocity(BodyId body) const
{
    return state_->velocity(state_->place_of(body, "velocity"));
}

Vec3 World::angular_velocity(BodyId body) const
{
    return state_->get<Velocities>().angular[state_->place_of(body, "angular_velocity")];
}

double World::radius(BodyId body) const
{
    return state_->get<BodyStates>().radius[state_->place_of(body, "radius")];
}

Mat3 World::rotation_matrix(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "rotation_matrix");
    const Quat& orientation = state_->get<Poses>().orientation[at];
    const auto& memory = state_->get<Flights>().memory;
    const bool held =
        at < memory.size() && memory[at].shown_orientation.coeffs() == orientation.coeffs();
    return held ? matrix_of(settings().rotation, memory[at].orientation.data())
                : orientation.toRotationMatrix();
}

Vec3 World::contact_force(BodyId body) const
{
    const std::uint32_t at = state_->place_of(body, "contact_force");
    const double substep = state_->get<StepContext>().last_substep;
    if (substep <= 0) return Vec3::Zero();
    if (state_->effects.on.meets(kEventDriven)) {
        const std::vector<Vec3>& force = state_->get<EventDrivenContacts>().force;
        return at < force.size() ? force[at] : Vec3(Vec3::Zero());
    }
    state_->settle();
    Vec3 impulse = Vec3::Zero();
    for_each_contact_impulse(*state_, [&](std::uint32_t a, std::uint32_t b, const auto& on_b) {
        if (b == at)
            impulse += on_b();
        else if (a == at)
            impulse -= on_b();
    });
    return impulse / substep;
}

const StepReport& World::report() const { return state_->report; }

const std::vector<std::string>& World::warnings() const { return state_->warnings; }

const std::vector<std::string>& World::solids() const { return state_->solids; }

std::vector<StageReport> World::stages() const
{
    std::vector<StageReport> reports;
    std::visit(
        [&](const auto& chosen) {
            if (!chosen.graph) return;
            for (std::size_t i = 0; i < chosen.graph->stages().size(); ++i)
                reports.push_back({chosen.graph->stages()[i].name, chosen.graph->times()[i]});
        },
        state_->step);
    return reports;
}

const Effects& World::effects()
{
    const Door::Entry entry(state_->door, "effects");
    state_->name_causes();
    return state_->effects;
}

void World::leave_out(Set<Effect> effects)
{
    const Door::Entry entry(state_->door, "leave_out");
    for (int i = 0; i < kEffects; ++i)
        if (const auto effect = static_cast<Effect>(i);
            effects.has(effect) && !kLeftOutByWorld.has(effect))
            throw std::invalid_argument(
                std::string(name_of(effect))
                + ": a world cannot leave it out; take what calls for it out of the scene, as "
                  "throng::leave_out() does");
    state_->left_out = effects;
    state_->effects_stale = true;
}

std::vector<World::StageInfo> World::step_stages()
{
    const Door::Entry entry(state_->door, "step_stages");
    state_->refresh();
    std::vector<StageInfo> infos;
    std::visit(
        [&](const auto& chosen) {
            for (const auto& stage : chosen.graph->stages()) {
                infos.push_back({stage.name, {}, {}});
                if (stage.passes == nullptr) continue;
                for (const PassRow& row : stage.passes())
                    if (row.called_for_by.meets(state_->effects.on))
                        infos.back().passes.push_back({row.name, row.when});
            }
            for (const auto& [earlier, later] : waits(chosen.graph->stages()))
                infos[later].waits_for.push_back(earlier);
        },
        state_->step);
    for (StageInfo& info : infos) std::sort(info.waits_for.begin(), info.waits_for.end());
    return infos;
}

int World::threads() const { return state_->pool.threads(); }
int World::threads_met() const { return state_->pool.threads_met(); }
int World::threads_used() const { return state_->work.threads(); }
void World::run_in_order(bool in_order)
{
    const Door::Entry entry(state_->door, "run_in_order");
    state_->in_order = in_order;
}

}  // namespace throng
