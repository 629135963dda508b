#include "cost/hard_cases/cases.hpp"

#include "cost/hard_cases/hard_cases.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace throng {

namespace {

constexpr HardCase kCases[] = {
    {"H1", "free tops turn as they should, by every integrator and rotation", case_free_top,
     Fault::spin},
    {"H2", "a top that flips keeps what should be kept for a hundred periods", case_long_flight,
     Fault::spin},
    {"H3", "a heavy top on a pivot nods in cusps", case_heavy_top, Fault::spin},
    {"H4", "a sleeping top stands or falls, either side of the limit", case_sleeping_top,
     Fault::spin},
    {"H5", "spinning fast: what one step turns by, and what many do", case_high_spin, Fault::spin},
    {"H6", "rotations stay rotations for millions of steps", case_rotation_drift, Fault::spin},
    {"H7", "boxes fly along their parabolas", case_ballistic, Fault::spin},
    {"H8", "a stack of equal boxes comes to rest and weighs what it weighs", case_stack,
     Fault::mass},
    {"H9", "heavy boxes rest on light ones", case_mass_ratio, Fault::mass},
    {"H10", "houses of cards stand, and tents either side of the limit", case_cards,
     Fault::friction},
    {"H11", "arches stand", case_arch, Fault::mass},
    {"H12", "a box slides to rest where Coulomb says, and straight", case_sliding, Fault::friction},
    {"H13", "a box on a slope sticks or slides, either side of the limit", case_slope_limit,
     Fault::friction},
    {"H14", "balls slip, then roll", case_rolling, Fault::friction},
    {"H15", "balls bounce as spin, friction and time have it", case_spin_bounce, Fault::friction},
    {"H16", "piles of balls: they overlap little, and keep their energy where they bounce",
     case_pile_of_balls, Fault::overlap},
    {"H17", "impacts pass through touching balls, by either law", case_cradle, Fault::mass},
    {"H18", "a billiard break is mirrored and loses nothing", case_break, Fault::mass},
    {"H19", "a coin rolls round on its rim, and one that is spun comes to lie", case_euler_disk,
     Fault::haste},
    {"H20", "a row of dominoes falls piece by piece, at one speed", case_dominoes, Fault::haste},
    {"H21",
     "rods slid where no law of motion holds, and rods whose ends strike in turn, come to rest",
     case_painleve, Fault::mass},
    {"H22", "logs and ladders stand or fall, either side of the limit", case_leaning,
     Fault::friction},
    {"H23", "a ball strikes a free rod, a block slides down a free wedge, and a rod tips",
     case_struck_rod, Fault::mass},
    {"H24", "a block on a turntable holds or slides, either side of the limit", case_turntable,
     Fault::friction},
    {"H25", "a tower of planks stands", case_planks, Fault::mass},
    {"H26", "a scene told in another way moves in the same way", case_invariance, Fault::unsteady},
    {"H28", "pairs that broke real libraries, at three scales and both ways round",
     case_broken_pairs, Fault::nudge, true},
    {"H29", "boxes a hair apart, touching and a hair overlapped", case_kissing, Fault::nudge, true},
    {"H30", "degenerate hulls are refused or answer as the clean one does", case_degenerate_hulls,
     Fault::nudge, true},
    {"H31", "needles and plates a million times longer than thick", case_slender, Fault::nudge,
     true},
    {"H32", "answers grow with the scale, and by nothing else", case_scaled, Fault::nudge, true},
    {"H33", "far from the origin a stack rests and pairs answer as they do at the origin",
     case_far_away, Fault::float_poses},
    {"H34", "boxes all but parallel: normals follow the tilt, contacts are whole",
     case_near_parallel, Fault::nudge},
    {"H35", "shapes about one center leave by the shortest way", case_concentric, Fault::nudge,
     true},
    {"H36", "the volume that two polytopes share", case_shared_volume, Fault::nudge, true},
    {"H37", "accelerations change the time and never the answer", case_same_answers, Fault::nudge},
    {"H38", "a bullet never comes through a plate, nor through a sheet", case_bullet_plate,
     Fault::late},
    {"H39", "a rod that turns by 150 degrees in a step meets the wall", case_spinning_rod,
     Fault::late},
    {"H40", "two fast bodies meet, graze or miss as they should", case_fast_pair, Fault::late},
    {"H41", "a ball strikes the next, and that the next, all in one step", case_backed_up,
     Fault::overlap},
    {"H42", "exact queries of public sets: no touch is missed", case_exact_paths, Fault::late,
     true},
    {"H43", "holes are gone through, chains hold and a bolt turns down its nut", case_through_hole,
     Fault::shrink},
    {"H44", "heaps of scans and lumps come to rest and hardly overlap", case_solid_heap,
     Fault::shrink},
    {"H45", "shared volumes and depths converge as they should", case_convergence, Fault::shrink,
     true},
    {"H46",
     "springs swing wider beyond the limit of who asked for it, which is told, and not within",
     case_spring_limit, Fault::stiffness},
    {"H47", "bodies made inside one another part slowly, and come to rest", case_recovery,
     Fault::haste},
    {"H48", "a tower stands without a touch, and what that costs", case_no_overlap, Fault::overlap},
    {"H71", "heaps of sticks, plates and slivers fall, and make no energy", case_sticks,
     Fault::haste},
    {"H74", "thin bodies that tip over win no energy", case_thin_falls, Fault::float_poses},
    {"H75", "slender bars that only turn are stopped by what they swing down on", case_slender_bars,
     Fault::float_poses},
    {"H80", "hulls with finely rounded rims come to rest, and sink into nothing", case_round_rims,
     Fault::float_poses},
    {"H81", "floors of tiles take no speed, and steps do", case_tiles, Fault::friction},
    {"H73", "what loses nothing in a closed room keeps its energy", case_closed_room,
     Fault::restitution},
    {"H77", "a ball that slides through its bounce is slowed by all that presses it",
     case_sliding_bounce, Fault::friction},
    {"H72", "springs on bodies in contact keep their swing and make no energy, however stiff",
     case_springs_in_contact, Fault::stiffness},
    {"H78", "springs on what turns fast, and pivots in contact, make no energy", case_fast_arms,
     Fault::haste},
    {"H82", "an open mesh holds from both sides, a closed one keeps out", case_both_sides,
     Fault::shrink},
    {"H83",
     "balls leave a hit as they touched, rough hits make no energy, heaps of balls lie still",
     case_hits_and_rest, Fault::restitution},
    {"H84", "plates that turn carry round what lies on them", case_carried_round, Fault::friction},
    {"H76", "heavy boxes on light ones, dice, cylinders and cards stand by the default dials",
     case_heavy_on_light, Fault::mass},
    {"H85", "walls of bricks stand, as high as soft contacts bear", case_tall_walls, Fault::skew},
    {"H86", "who is driven has the speed that it is driven at, whatever friction bears",
     case_walkers, Fault::haste},
    {"H87", "thin solids that a fall drives through one another are thrown by nothing",
     case_wedged_solids, Fault::haste},
    {"H88", "what falls on something light and bounces off nothing is thrown back by nothing",
     case_crushed, Fault::haste},
    {"H89", "who bounces wins nothing, whatever acts besides gravity", case_forced_bounces,
     Fault::haste},
    {"H90", "a column that falls on a floor and bounces off nothing stays there",
     case_landing_columns, Fault::haste},
    {"H91", "small bodies of unlike weight that fall as a column make no energy",
     case_small_columns, Fault::haste},
    {"H92", "stacks near attractors and on springs come to rest, and swings stay",
     case_rest_under_forces, Fault::haste},
    {"H93", "what is round rolls along at the same speed on a floor of any kind",
     case_rolling_along, Fault::haste},
    {"H94", "small hulls of many sides stay on a floor of any kind", case_pebbles, Fault::sink},
    {"H95", "who falls flat comes up flat, on however many shapes", case_flat_bounces,
     Fault::restitution},
    {"H96", "bodies that fall together to an attractor make no energy", case_attracted_heaps,
     Fault::haste},
    {"H97", "chains of links hold, hung and swung", case_link_chains, Fault::sink},
    {"H98", "what swings on a contact keeps its swing", case_swings, Fault::haste},
    {"H99", "what slides or rolls in a bent mesh loses what its edges take", case_bent_tracks,
     Fault::haste},
    {"H100", "heaps that land lie still by little more than usual work", case_landed_heaps,
     Fault::sink},
    {"H101", "what tumbles beside a wall keeps energy and momentum", case_near_walls, Fault::whirl},
    {"H102", "SimBenchmark's tasks, with no more error than any engine published there",
     case_simbenchmark, Fault::haste},
    {"H103", "what a step is told to be off by is what it is off by", case_step_errors,
     Fault::modesty},
    {"H104", "what is struck so hard that it spins far round in a step makes no energy",
     case_struck_heaps, Fault::haste},
    {"H105", "planks that lean edge against edge stand where friction is enough, and no longer",
     case_leaning_planks, Fault::friction},
    {"H106", "who is caught between what moves by itself and what stands still is not thrown",
     case_squeezed, Fault::haste},
    {"H107", "what air brakes makes no energy as it bounces, and rises as high as it can",
     case_dragged_bounces, Fault::haste},
    {"H108", "who is heavy and rolls off what is light makes no energy, on it and beside it",
     case_falls_off, Fault::haste},
    {"H109", "unlike bodies put on one another by hand come to rest", case_unlike_stacks,
     Fault::unsteady},
    {"pairs", "every two values of dials run together, on any number of threads", case_dial_pairs,
     Fault::float_poses},
};

}  // namespace

std::span<const HardCase> hard_cases() { return kCases; }

const HardCase* find_case(std::string_view name)
{
    const auto same = [](char a, char b) {
        return std::toupper(static_cast<unsigned char>(a))
            == std::toupper(static_cast<unsigned char>(b));
    };
    for (const HardCase& one : kCases)
        if (std::equal(name.begin(), name.end(), one.name.begin(), one.name.end(), same))
            return &one;
    return nullptr;
}

std::vector<CaseResult> run_case(const HardCase& which,
                                 Settings settings,
                                 Fault fault,
                                 int threads,
                                 Extent extent,
                                 CaseListener listener)
{
    return CaseBench(settings, fault, threads, extent, std::move(listener)).run(which);
}

}  // namespace throng
