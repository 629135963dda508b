#include "pipeline/step/step_table.hpp"

#include "pipeline/step/stages.hpp"

namespace throng {

namespace {

using enum Effect;

bool by_soft_step(const Settings& settings)
{
    return settings.response == Response::impulse && settings.solver == Solver::soft_step;
}
bool by_pgs(const Settings& settings)
{
    return settings.response == Response::impulse && settings.solver == Solver::pgs;
}
bool by_direct(const Settings& settings)
{
    return settings.response == Response::impulse && settings.solver == Solver::direct;
}
bool by_penalty(const Settings& settings) { return settings.response == Response::penalty; }
bool by_auto(const Settings& settings) { return settings.effects == EffectChoice::auto_; }
bool by_islands(const Settings& settings) { return !rests_by_force(settings); }
bool by_kinematic(const Settings& settings) { return settings.response == Response::kinematic; }

// clang-format off
template <class Real>
constexpr Stage<Real> kStep[] = {
    stage<Real, sleep_pairs<Real>>           ({sleeping}),
    stage<Real, prescribe_velocities>        ({drive}),
    stage<Real, update_bounds>               ({contact}),
    stage<Real, find_pairs>                  ({contact}),
    stage<Real, collide_convex<Real>>        ({contact}),
    stage<Real, collide_solids<Real>>        (kSolidContact),
    stage<Real, wake_islands<Real>>          ({sleeping}, by_islands),
    stage<Real, wake_bodies<Real>>           ({sleeping}, rests_by_force),
    stage<Real, collide_meshes<Real>>        ({mesh_contact}),
    stage<Real, neglect_effects>             ({gyroscopic}, by_auto),
    stage<Real, remove_ghost_contacts<Real>> ({seams}),
    stage<Real, remove_pivot_contacts<Real>> ({pivot}),
    stage<Real, measure_approaches<Real>>    ({events}),
    stage<Real, gather_contacts<Real>>       ({contact}),
    stage<Real, join_contacts<Real>>         ({restitution, seams}),
    stage<Real, split_islands>               ({contact}),
    stage<Real, sort_islands<Real>>          ({contact}),
    stage<Real, escalate_islands>            ({escalation}),
    stage<Real, color_constraints>           ({contact}),
    stage<Real, apply_forces>                (kForces),
    stage<Real, prepare_constraints<Real>>   ({contact}),
    stage<Real, solve_soft_step<Real>>       ({contact}, by_soft_step, soft_step_passes),
    stage<Real, solve_pgs<Real>>             ({contact}, by_pgs,       pgs_passes),
    stage<Real, solve_direct<Real>>          ({contact}, by_direct,    direct_passes),
    stage<Real, solve_penalty<Real>>         ({contact}, by_penalty,   penalty_passes),
    stage<Real, solve_kinematic<Real>>       ({contact}, by_kinematic, kinematic_passes),
    stage<Real, measure_strain<Real>>        ({contact}, may_escalate),
    stage<Real, store_solution<Real>>        ({contact}),
    stage<Real, back_up>                     ({no_overlap},     nullptr, back_up_passes),
    stage<Real, subdivide>                   ({little_overlap}, nullptr, subdivide_passes),
    stage<Real, integrate_poses>             ({motion}),
    stage<Real, quarantine_bodies>           ({motion}),
    stage<Real, continuous_collision<Real>>  ({fast_motion}),
    stage<Real, sleep_islands>               ({sleeping}, by_islands),
    stage<Real, rest_bodies<Real>>           ({sleeping}, rests_by_force),
    stage<Real, find_touching_pairs<Real>>   ({events}),
};
// clang-format on

template <class Real, class... Kinds>
constexpr DataSet data_sets = (DataSet{} | ... | data_set<Real, Kinds>);

// Whatever a stage reads is kept from the last step or written by an earlier row.
template <class Real>
consteval bool reads_follow_writes()
{
    DataSet ready =
        data_sets<Real, StepContext, NarrowPhaseParameters, ImpactParameters, SolverParameters,
                  SleepParameters, NeglectParameters, Shapes, Surfaces, PairFilter,
                  PrescribedVelocities, Forces, EffectCensus, Poses, Velocities, Masses, BodyStates,
                  Colliders, SleepEvents, OverloadedIslands, SplitImpulse>;
    for (const Stage<Real>& row : kStep<Real>) {
        // A row may read what it writes itself: it keeps that from the last step.
        if (!(ready | row.writes).covers(row.reads)) return false;
        ready = ready | row.writes;
        // What is read of scenes that may have neither meshes nor solids is then empty.
        if (row.name == "collide_convex")
            ready =
                ready | data_set<Real, MeshContacts<Real>> | data_set<Real, SolidContacts<Real>>;
    }
    return true;
}
static_assert(reads_follow_writes<float>() && reads_follow_writes<double>());

}  // namespace

template <class Real>
std::span<const Stage<Real>> step_table()
{
    return kStep<Real>;
}

template <class Real>
std::vector<Stage<Real>> stages_for(Set<Effect> effects, const Settings& settings)
{
    std::vector<Stage<Real>> rows;
    for (const Stage<Real>& row : kStep<Real>)
        if (row.called_for_by.meets(effects)
            && (row.chosen_by == nullptr || row.chosen_by(settings)))
            rows.push_back(row);
    return rows;
}

template std::span<const Stage<float>> step_table<float>();
template std::span<const Stage<double>> step_table<double>();
template std::vector<Stage<float>> stages_for<float>(Set<Effect>, const Settings&);
template std::vector<Stage<double>> stages_for<double>(Set<Effect>, const Settings&);

}  // namespace throng
