#include "pipeline/step/step_table.hpp"

#include "pipeline/step/stages.hpp"

namespace throng {

namespace {

using enum Effect;

// clang-format off
template <class Real>
constexpr Stage<Real> kStep[] = {
    stage<Real, prescribe_velocities>        ("prescribe_velocities",  {drive}),
    stage<Real, update_bounds>               ("update_bounds",         {contact}),
    stage<Real, find_pairs>                  ("find_pairs",            {contact}),
    stage<Real, collide_convex<Real>>        ("collide_convex",        {contact}),
    stage<Real, collide_solids<Real>>        ("collide_solids",        kSolidContact),
    stage<Real, wake_islands<Real>>          ("wake_islands",          {sleeping}),
    stage<Real, collide_meshes<Real>>        ("collide_meshes",        {mesh_contact}),
    stage<Real, remove_ghost_contacts<Real>> ("remove_ghost_contacts", {seams}),
    stage<Real, gather_contacts<Real>>       ("gather_contacts",       {contact}),
    stage<Real, split_islands>               ("split_islands",         {contact}),
    stage<Real, escalate_islands>            ("escalate_islands",      {escalation}),
    stage<Real, color_constraints>           ("color_constraints",     {contact}),
    stage<Real, apply_forces>                ("apply_forces",          kForces),
    stage<Real, prepare_constraints<Real>>   ("prepare_constraints",   {contact}),
    stage<Real, solve_impulses<Real>>        ("solve_impulses",        {contact}),
    stage<Real, step_event_driven>           ("back_up",               {no_overlap}),
    stage<Real, step_event_driven>           ("subdivide",             {little_overlap}),
    stage<Real, integrate_poses>             ("integrate_poses",       {motion}),
    stage<Real, quarantine_bodies>           ("quarantine_bodies",     {motion}),
    stage<Real, continuous_collision<Real>>  ("continuous_collision",  {fast_motion}),
    stage<Real, sleep_islands>               ("sleep_islands",         {sleeping}),
};
// clang-format on

template <class Real, class... Kinds>
constexpr DataSet data_sets = (DataSet{} | ... | data_set<Real, Kinds>);

// Whatever a stage reads is kept from the last step or written by an earlier row.
template <class Real>
consteval bool reads_follow_writes()
{
    DataSet ready =
        data_sets<Real, StepContext, Shapes, Surfaces, PairFilter, PrescribedVelocities, Forces,
                  Poses, Velocities, Masses, BodyStates, Colliders, SleepEvents, OverloadedIslands>;
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
std::vector<Stage<Real>> stages_for(Set<Effect> effects)
{
    std::vector<Stage<Real>> rows;
    for (const Stage<Real>& row : kStep<Real>)
        if (row.called_for_by.meets(effects)) rows.push_back(row);
    return rows;
}

template std::span<const Stage<float>> step_table<float>();
template std::span<const Stage<double>> step_table<double>();
template std::vector<Stage<float>> stages_for<float>(Set<Effect>);
template std::vector<Stage<double>> stages_for<double>(Set<Effect>);

}  // namespace throng
