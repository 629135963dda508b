#include "scene/shapes/solid_maker.hpp"

#include "cooking/decomposition/parts_cache.hpp"
#include "cooking/fields/field_cache.hpp"
#include "cooking/fields/surface_points.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "cooking/short_text.hpp"
#include "cooking/sphere_trees/solid_cores.hpp"
#include "cooking/sphere_trees/spheres_cache.hpp"
#include "kernels/geometry/image_views.hpp"
#include "kernels/geometry/mesh.hpp"
#include "scene/shapes/level_set.hpp"
#include "scene/shapes/moving_mesh.hpp"
#include "throng/dials.hpp"

namespace throng {

namespace {

// Without its mesh.
Solid voxel_solid(const Mesh& surface, VoxelBricks field)
{
    Solid solid;
    solid.representation = SolidRepresentation::voxels;
    solid.points = build_surface_points(surface, field.voxel);
    solid.cores = build_solid_cores(surface, solid.points);
    solid.field = std::move(field);
    solid.error = 0.5 * solid.field.voxel;
    return solid;
}

std::string summary_of(const Solid& solid)
{
    const auto bricks = solid.field.values.size() / VoxelBricks::kValues;
    return "voxels of " + short_text(solid.field.voxel) + " m, " + std::to_string(bricks)
        + " bricks of 8 x 8 x 8 ("
        + short_text(static_cast<double>(solid.field.values.size()) * 4e-6) + " MB), "
        + std::to_string(solid.points.size()) + " surface points";
}

// Along the longest side, where points are wanted for cores alone.
constexpr double kPointsAlong = 32;

// Share of the longest side or of the volume by which a mesh may be off and nobody is warned: what
// the ways are off by unasked, half a voxel of 48 along the side, a pixel of 32, parts of 2.5 %, is
// less.
constexpr double kNotable = 0.05;

std::string percent(double share) { return short_text(100 * share) + " %"; }

std::string error_text(const Solid& solid)
{
    return ", depths within " + short_text(solid.error) + " m";
}

// What would be nearer to a mesh than what it was taken by.
std::string_view nearer_than(NonConvex way)
{
    switch (way) {
    case NonConvex::voxels:
        return "a smaller voxel_size is nearer";
    case NonConvex::parts:
        return "more max_parts are nearer, or nonconvex=voxels";
    case NonConvex::spheres:
        return "more sphere_levels are nearer, or nonconvex=voxels";
    case NonConvex::depth_image:
        return "a greater image_resolution is nearer";
    case NonConvex::hull:
        break;
    }
    return "nonconvex=voxels or parts keep them";
}

// One call of make_solid for a mesh.
class SolidMaker {
public:
    SolidMaker(const Settings& settings, const std::string& cache_folder)
        : settings_(settings), cache_folder_(cache_folder)
    { }

    MadeSolid make(const MeshShape& stated)
    {
        if (std::string trouble = take_mesh(stated); !trouble.empty())
            return refused(std::move(trouble));
        if (!sound_ && !take_level_set()) return refused(made_.trouble);
        made_.mass = mass_of(mesh_);
        made_.mass.center += made_.at;
        switch (settings_.nonconvex) {
        case NonConvex::voxels:
            return as_voxels();
        case NonConvex::spheres:
            return as_spheres();
        case NonConvex::depth_image:
            return as_depth_image();
        case NonConvex::parts:
            return as_parts();
        case NonConvex::hull:
            break;
        }
        return as_hulls(put_into_hull(mesh_));
    }

private:
    // Answers what is wrong with it.
    std::string take_mesh(const MeshShape& stated)
    {
        const std::shared_ptr<const MovingMesh> moving = moving_mesh(stated);
        // Its way into the world ends here.
        forget_moving_mesh(stated);
        const RepairedMesh& repaired = moving->repaired;
        if (!repaired.trouble.empty()) return repaired.trouble;
        made_.at = moving->at;
        mesh_ = repaired.mesh;
        made_.warnings = repaired.warnings;
        sound_ = repaired.health.sound();
        return {};
    }

    // With what was found before: it is mostly the cause.
    MadeSolid refused(std::string why)
    {
        for (std::size_t i = 0; i < made_.warnings.size(); ++i)
            why += (i == 0 ? ". Found: " : "; ") + made_.warnings[i];
        made_.trouble = std::move(why);
        return std::move(made_);
    }

    bool make_field(FieldSign sign)
    {
        FieldSettings wanted;
        wanted.voxel = settings_.voxel_size;
        wanted.sign = sign;
        field_ = cached_field(mesh_, wanted, cache_folder_);
        made_.warnings.insert(made_.warnings.end(), field_.warnings.begin(), field_.warnings.end());
        made_.trouble = field_.trouble;
        return field_.trouble.empty();
    }

    // A mesh that does not tell its inside from its outside is taken as the surface of what a flood
    // from outside does not reach; where that is nothing, as a sheet.
    bool take_level_set()
    {
        if (!make_field(FieldSign::flood) && !(field_.hollow && take_sheet())) return false;
        MeshResult surface = field_surface(field_.bricks);
        made_.trouble = surface.trouble;
        if (!surface.trouble.empty()) return false;
        const double stated = std::abs(mass_as_if_closed(mesh_).volume);
        mesh_ = std::move(surface.mesh);
        made_.warnings.push_back("taken as the surface of its level set, with voxels of "
                                 + short_text(field_.bricks.voxel) + " m"
                                 + volume_text(mass_of(mesh_).volume / stated - 1));
        return true;
    }

    // By how much the volume, and with it the mass, is another than that of the triangles.
    static std::string volume_text(double grown)
    {
        if (!(std::abs(grown) > kNotable)) return {};
        return ": its volume, and so its mass, is " + percent(std::abs(grown))
            + (grown > 0 ? " more" : " less")
            + " than that of its triangles, closed over their rims";
    }

    bool take_sheet()
    {
        if (!make_field(FieldSign::sheet)) return false;
        made_.warnings.push_back("nothing tells its inside from its outside: taken as a sheet "
                                 + short_text(2 * field_.bricks.voxel)
                                 + " m thick; for a solid give a closed mesh, or a voxel_size that "
                                   "is wider than its holes");
        return true;
    }

    MadeSolid as_voxels()
    {
        if (sound_ && !make_field(FieldSign::normals)) return refused(made_.trouble);
        Solid solid = voxel_solid(mesh_, std::move(field_.bricks));
        made_.summary = summary_of(solid);
        return finished(std::move(solid));
    }

    MadeSolid as_spheres()
    {
        SphereTreeLimits limits;
        if (settings_.sphere_levels > 0) limits.levels = settings_.sphere_levels;
        Solid solid;
        solid.representation = SolidRepresentation::spheres;
        CachedSpheres made = cached_spheres(mesh_, limits, cache_folder_);
        if (!made.warning.empty()) made_.warnings.push_back(made.warning);
        solid.spheres = std::move(made.tree);
        if (solid.spheres.levels.empty()) return refused("has no inside that spheres could fill");
        const SphereTree::Level& last = solid.spheres.levels.back();
        solid.error = last.error;
        made_.summary = "spheres in " + std::to_string(solid.spheres.levels.size()) + " levels, "
            + std::to_string(last.nodes.size()) + " on the last";
        return finished(std::move(solid));
    }

    MadeSolid as_depth_image()
    {
        Solid solid;
        solid.representation = SolidRepresentation::depth_image;
        solid.rays = settings_.image_resolution > 0 ? settings_.image_resolution : kAutoRays;
        solid.error = longest_side(mesh_) / solid.rays;
        made_.summary = "depth images, " + std::to_string(solid.rays)
            + " rays along the smaller shape's longest side";
        return finished(std::move(solid));
    }

    MadeSolid finished(Solid solid)
    {
        made_.summary += error_text(solid);
        warn_of_loss(solid.error);
        if (solid.points.size() == 0)
            solid.cores = build_solid_cores(
                mesh_, build_surface_points(mesh_, longest_side(mesh_) / kPointsAlong));
        solid.mesh = std::move(mesh_);
        if (solid.representation == SolidRepresentation::depth_image)
            solid.layers = layers_of(solid);
        made_.shape = std::move(solid);
        return std::move(made_);
    }

    void warn_of_loss(double error)
    {
        const double share = error / longest_side(mesh_);
        if (share > kNotable)
            made_.warnings.push_back("off by " + short_text(error) + " m somewhere, "
                                     + percent(share) + " of its longest side; "
                                     + std::string(nearer_than(settings_.nonconvex)));
    }

    MadeSolid as_parts()
    {
        PartsWanted wanted;
        if (settings_.max_parts > 0) wanted.max_parts = settings_.max_parts;
        return as_hulls(cached_parts(mesh_, wanted, cache_folder_));
    }

    MadeSolid as_hulls(ConvexParts parts)
    {
        if (!parts.trouble.empty()) return refused(parts.trouble);
        const bool one = parts.hulls.size() == 1;
        made_.summary = one ? "one hull" : std::to_string(parts.hulls.size()) + " convex parts";
        made_.summary += ", within " + short_text(parts.error) + " m of the mesh";
        for (const std::string& warning : parts.warnings) made_.summary += "; " + warning;
        if (settings_.nonconvex == NonConvex::parts)
            warn_of_loss(parts.error);
        else if (parts.volume_error > kNotable)
            made_.warnings.push_back("taken as one hull: holes and hollows are filled, "
                                     + percent(parts.volume_error) + " more than the mesh; "
                                     + std::string(nearer_than(settings_.nonconvex)));
        made_.shape = std::move(parts.hulls);
        return std::move(made_);
    }

    const Settings& settings_;
    const std::string& cache_folder_;
    Mesh mesh_;
    bool sound_ = true;
    FieldResult field_;
    MadeSolid made_;
};

}  // namespace

Settings settings_of(const MeshShape& mesh, Settings scene)
{
    if (!mesh.nonconvex.empty()) set_dial(scene, "nonconvex", mesh.nonconvex);
    if (mesh.voxel_size > 0) scene.voxel_size = mesh.voxel_size;
    if (mesh.image_resolution > 0) scene.image_resolution = mesh.image_resolution;
    if (mesh.sphere_levels > 0) scene.sphere_levels = mesh.sphere_levels;
    if (mesh.max_parts > 0) scene.max_parts = mesh.max_parts;
    return scene;
}

MadeSolid
make_solid(const MeshShape& mesh, const Settings& settings, const std::string& cache_folder)
{
    const Settings own = settings_of(mesh, settings);
    return SolidMaker(own, cache_folder).make(mesh);
}

MadeSolid make_solid(const LevelSet& level_set)
{
    MadeSolid made;
    Solid solid = voxel_solid(level_set.surface, level_set.field);
    solid.mesh = level_set.surface;
    if (level_set.whole) made.mass = mass_of(level_set.surface);
    made.summary = summary_of(solid) + error_text(solid);
    made.shape = std::move(solid);
    return made;
}

}  // namespace throng
