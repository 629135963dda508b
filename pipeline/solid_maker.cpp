#include "pipeline/solid_maker.hpp"

#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "kernels/geometry/surface_points.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "narrowphase/methods/convex_parts.hpp"
#include "pipeline/dials.hpp"

namespace throng {

namespace {

// Voxels along the longest side, and rays: details of a fortieth of the size are felt in contact.
constexpr int kVoxels = 40, kRays = 40;
constexpr double kBand = 3;  // voxels outside of the surface that have a distance

// What the shape asks for, or else the scene.
Settings own_settings(const MeshShape& mesh, Settings settings)
{
    if (!mesh.nonconvex.empty()) set_dial(settings, "nonconvex", mesh.nonconvex);
    if (mesh.voxel_size > 0) settings.voxel_size = mesh.voxel_size;
    if (mesh.image_resolution > 0) settings.image_resolution = mesh.image_resolution;
    if (mesh.sphere_levels > 0) settings.sphere_levels = mesh.sphere_levels;
    if (mesh.max_parts > 0) settings.max_parts = mesh.max_parts;
    return settings;
}

// One call of make_solid.
class SolidMaker {
public:
    SolidMaker(const Settings& settings, const std::string& cache_folder)
        : settings_(settings), cache_folder_(cache_folder)
    { }

    MadeSolid make(const MeshShape& stated)
    {
        MeshResult built = build_mesh(stated.vertices, stated.triangles);
        if (!built.trouble.empty()) return refused(built.trouble);
        find_vertex_normals(built.mesh);
        made_.mass = mass_of(built.mesh);
        const Mesh::Node& root = built.mesh.tree.front();
        size_ = (root.upper - root.lower).maxCoeff();
        switch (settings_.nonconvex) {
        case NonConvex::hull:
            return as_hull(built.mesh);
        case NonConvex::parts:
            return as_parts(built.mesh);
        case NonConvex::spheres:
            return as_spheres(std::move(built.mesh));
        case NonConvex::depth_image:
            return as_depth_image(std::move(built.mesh));
        case NonConvex::voxels:
            break;
        }
        return as_voxels(std::move(built.mesh));
    }

private:
    MadeSolid refused(std::string why)
    {
        made_.trouble = std::move(why);
        return std::move(made_);
    }

    MadeSolid as_voxels(Mesh mesh)
    {
        Solid solid;
        solid.way = SolidWay::voxels;
        const double voxel = settings_.voxel_size > 0 ? settings_.voxel_size : size_ / kVoxels;
        const Mesh::Node& root = mesh.tree.front();
        solid.field = bake_bricks({root.lower, root.upper}, voxel, kBand * voxel,
                                  [&](const Vec3& at) { return signed_distance(mesh, at); });
        solid.points = build_surface_points(mesh, voxel);
        solid.error = 0.5 * voxel;
        solid.mesh = std::move(mesh);
        made_.shape = std::move(solid);
        return std::move(made_);
    }

    MadeSolid as_spheres(Mesh mesh) { return as_voxels(std::move(mesh)); }
    MadeSolid as_depth_image(Mesh mesh)
    {
        Solid solid;
        solid.way = SolidWay::depth_image;
        solid.rays = settings_.image_resolution > 0 ? settings_.image_resolution : kRays;
        solid.error = size_ / solid.rays;
        solid.mesh = std::move(mesh);
        made_.shape = std::move(solid);
        return std::move(made_);
    }

    MadeSolid as_parts(const Mesh& mesh)
    {
        PartsWanted wanted;
        if (settings_.max_parts > 0) wanted.max_parts = settings_.max_parts;
        return as_hulls(split_into_parts(mesh, wanted));
    }

    MadeSolid as_hull(const Mesh& mesh) { return as_hulls(put_into_hull(mesh)); }

    MadeSolid as_hulls(ConvexParts parts)
    {
        if (!parts.trouble.empty()) return refused(parts.trouble);
        for (std::string& remark : parts.remarks) made_.summary += remark + "; ";
        made_.summary += std::to_string(parts.hulls.size()) + " convex parts";
        made_.shape = std::move(parts.hulls);
        return std::move(made_);
    }

    const Settings& settings_;
    const std::string& cache_folder_;
    double size_ = 0;  // m, the longest side of the mesh's box
    MadeSolid made_;
};

}  // namespace

MadeSolid
make_solid(const MeshShape& mesh, const Settings& settings, const std::string& cache_folder)
{
    const Settings own = own_settings(mesh, settings);
    return SolidMaker(own, cache_folder).make(mesh);
}

NonConvex way_of(const MeshShape& mesh, const Settings& settings)
{
    return own_settings(mesh, settings).nonconvex;
}

}  // namespace throng
