#include "scene/names.hpp"
#include "scene/rules/scene_rules.hpp"
#include "scene/shapes/moving_mesh.hpp"
#include "scene/shapes/solid_maker.hpp"
#include "throng/dials.hpp"

#include <algorithm>

namespace throng {
namespace {

// The dials of how a moving mesh is taken, with the way that asks for each.
struct MeshDial {
    std::string_view name;
    NonConvex way;
};
constexpr MeshDial kMeshDials[] = {{"voxel_size", NonConvex::voxels},
                                   {"image_resolution", NonConvex::depth_image},
                                   {"sphere_levels", NonConvex::spheres},
                                   {"max_parts", NonConvex::parts}};

bool states_its_own(const MeshShape& mesh, std::string_view dial)
{
    if (dial == "voxel_size") return mesh.voxel_size > 0;
    if (dial == "image_resolution") return mesh.image_resolution > 0;
    if (dial == "sphere_levels") return mesh.sphere_levels > 0;
    return mesh.max_parts > 0;
}

bool asks_for(const MeshShape& mesh, const Settings& settings, const MeshDial& dial)
{
    if (settings_of(mesh, settings).nonconvex == dial.way) return true;
    // What does not tell its inside is repaired by voxels, whatever its way.
    return dial.way == NonConvex::voxels && !moving_mesh(mesh)->repaired.health.sound();
}

std::vector<const MeshShape*> moving_meshes(const Scene& scene)
{
    std::vector<const MeshShape*> meshes;
    const std::vector<bool> moves = shape_uses(scene).dynamic;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (const auto* mesh = std::get_if<MeshShape>(&scene.shapes[i].shape); mesh && moves[i])
            meshes.push_back(mesh);
    return meshes;
}

/// Why the dial `mesh_tree` does nothing; empty where it does something, or another is asked for.
std::string why_still_meshes_leave(const Scene& scene, std::string_view name)
{
    if (name != "mesh_tree") return {};
    const std::vector<bool> stands = shape_uses(scene).other;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (std::holds_alternative<MeshShape>(scene.shapes[i].shape) && stands[i]) return {};
    return "no mesh stands still";
}

/// Why a dial of moving meshes does nothing; empty when it does something, or is no such dial.
std::string why_meshes_leave(const Scene& scene, std::string_view name)
{
    const auto* const dial = std::find_if(std::begin(kMeshDials), std::end(kMeshDials),
                                          [&](const MeshDial& one) { return one.name == name; });
    const bool is_way = name == "nonconvex";
    if (!is_way && dial == std::end(kMeshDials)) return {};
    const std::vector<const MeshShape*> meshes = moving_meshes(scene);
    if (meshes.empty()) return "no mesh moves";
    bool asked = is_way;
    for (const MeshShape* mesh : meshes) {
        if (is_way && mesh->nonconvex.empty()) return {};
        if (is_way || !asks_for(*mesh, scene.settings, *dial)) continue;
        if (!states_its_own(*mesh, name)) return {};
        asked = true;
    }
    if (asked) return "each mesh that asks for it states its own";
    Settings by_way;
    by_way.nonconvex = dial->way;
    return "no moving mesh goes by " + dial_value(by_way, "nonconvex");
}

/// Why bodies of the scene are not carried from touch to touch as the dial `overlap` asks; empty
/// where they are, or it does not. As effects.cpp has it.
std::string why_not_carried(const Scene& scene)
{
    if (scene.settings.overlap == Overlap::allow) return {};
    if (scene.settings.response != Response::impulse)
        return "response " + dial_value(scene.settings, "response") + " needs overlap";
    return {};
}

/// Why a dial of contacts does nothing where bodies are carried from touch to touch.
std::string why_carrying_leaves(const Scene& scene, std::string_view name)
{
    const std::string why = why_not_carried(scene), overlap = dial_value(scene.settings, "overlap");
    if (name == "overlap") return why;
    if (name == "halvings" && scene.settings.overlap != Overlap::subdivide)
        return "overlap " + overlap + " divides no step";
    if (name == "halvings") return why;
    if (scene.settings.overlap == Overlap::allow || !why.empty()) return {};
    for (const std::string_view unused :
         {"solver", "contact_rate", "relax_iterations", "direct_limit", "narrowphase",
          "method_start", "bounds_filter", "broadphase", "friction_cone", "friction_at", "sleep",
          "partial_rest", "rest_force", "escalation"})
        if (name == unused) return "overlap " + overlap + " solves contacts in its own way";
    return {};
}

/// Why a dial does nothing under these settings; empty when it does something.
std::string why_settings_leave(const Settings& settings, std::string_view name)
{
    const auto is_one_of = [&](std::initializer_list<std::string_view> names) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    const std::string solver = dial_value(settings, "solver");
    const std::string response = dial_value(settings, "response");

    if (settings.response != Response::impulse
        && is_one_of({"solver", "iterations", "relax_iterations", "contact_rate", "push_limit",
                      "direct_limit", "friction_cone", "friction_at", "impact_law", "escalation",
                      "partial_rest", "rest_force"}))
        return "response " + response + " solves no rows";
    if (settings.solver != Solver::soft_step
        && (name == "contact_rate" || name == "relax_iterations"))
        return "solver " + solver + " has no soft contacts";
    if (settings.effects == EffectChoice::called && name == "effects_error")
        return "effects called leaves nothing out";
    if (!settings.partial_rest && name == "rest_force")
        return "partial_rest off lets nobody rest by itself";
    if (settings.narrowphase == NarrowPhase::auto_ && name == "method_start")
        return "narrowphase auto always begins with what a pair remembers";
    if (settings.solver != Solver::direct && name == "direct_limit")
        return "solver " + solver + " takes islands of any size";
    if (name == "gyroscopic" && settings.gyroscopic == Gyroscopic::explicit_
        && settings.integrator != Integrator::semi_implicit
        && settings.integrator != Integrator::auto_)
        return "integrator " + dial_value(settings, "integrator")
            + " takes the torque as it does all others";
    if (settings.solver != Solver::direct && settings.overlap == Overlap::allow
        && name == "impact_law")
        return "solver " + solver + " passes an impact along one pair at a time";
    if (settings.solver == Solver::direct && name == "escalation")
        return "solver " + solver + " is what islands are escalated to";
    if (settings.solver == Solver::direct && name == "friction_at")
        return "solver " + solver + " has friction at every point";
    if (settings.solver == Solver::direct && name == "friction_cone")
        return "solver " + solver + " holds a round cone";
    if (settings.response != Response::penalty
        && is_one_of({"penalty_stiffness", "penalty_damping"}))
        return "response " + response + " has no penalty forces";
    return {};
}

}  // namespace

std::vector<std::string> unused_dials(const Scene& scene)
{
    std::vector<std::string> unused;
    for (const std::string& name : scene.dials_set) {
        std::string why = why_settings_leave(scene.settings, name);
        if (why.empty()) why = why_meshes_leave(scene, name);
        if (why.empty()) why = why_still_meshes_leave(scene, name);
        if (why.empty()) why = why_carrying_leaves(scene, name);
        if (!why.empty()) unused.push_back(name + ": unused, " + why);
    }
    return unused;
}

std::string clashing_dials(const Settings& settings)
{
    // The spacing of float next to 1: less a step that works in float cannot tell.
    constexpr double kLeastInFloat = 0x1p-23;
    if (settings.precision == Precision::double_ || settings.toi_tolerance >= kLeastInFloat)
        return {};
    return "toi_tolerance: wanted " + number_text(kLeastInFloat)
        + " or more, what float resolves, not " + number_text(settings.toi_tolerance)
        + "; precision=double takes less";
}

}  // namespace throng
