// Solid scenes: bodies that are not convex are what they are said to be, and apart at first.
#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "scene/catalog/noisy_balls.hpp"
#include "scene/catalog/threads.hpp"
#include "scene/shapes/level_set.hpp"
#include "tests/scene/catalog/mesh_crossings.hpp"
#include "tests/scene/catalog/scene_bodies.hpp"

#include <gtest/gtest.h>

#include <map>

namespace throng {
namespace {

constexpr std::string_view kSolidScenes[] = {"knots", "chain", "peg", "bolt", "terrain"};

/// A ball about the origin of a body's own frame that holds its mesh.
double extent_of(const Mesh& mesh)
{
    double greatest = 0;
    for (const Vec3& vertex : mesh.vertices) greatest = std::max(greatest, vertex.norm());
    return greatest;
}

/// The meshes of a scene, made ready once each.
class Solids {
public:
    explicit Solids(const Scene& scene) : scene_(scene)
    {
        for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
            if (const auto* voxels = std::get_if<VoxelsShape>(&scene.shapes[i].shape))
                meshes_.emplace(i, voxels->level_set->surface);
            const auto* shape = std::get_if<MeshShape>(&scene.shapes[i].shape);
            if (shape == nullptr) continue;
            MeshResult result = build_mesh(shape->vertices, shape->triangles);
            EXPECT_EQ(result.trouble, "") << scene.shapes[i].name;
            find_vertex_normals(result.mesh);
            meshes_.emplace(i, std::move(result.mesh));
        }
    }
    const Mesh* mesh_of(std::uint32_t shape) const
    {
        const auto found = meshes_.find(shape);
        return found == meshes_.end() ? nullptr : &found->second;
    }
    const std::map<std::uint32_t, Mesh>& all() const { return meshes_; }

    /// The least distance of the vertices and the middles of the triangles of b from a, both of
    /// them meshes: below 0 where they are inside. What is far from a is left out.
    double distance(std::size_t a, std::size_t b) const
    {
        const Body body_a = body_at(scene_, a), body_b = body_at(scene_, b);
        const Mesh& points = *mesh_of(body_b.shape);
        const Pose pose_a{body_a.position, body_a.orientation};
        const Pose pose_b{body_b.position, body_b.orientation};
        const Mesh& mesh = *mesh_of(body_a.shape);
        const double far = 1.5 * extent_of(mesh);
        double least = std::numeric_limits<double>::infinity();
        const auto look = [&](const Vec3& point) {
            const Vec3 at = pose_a.to_local(pose_b * point);
            if (at.norm() < far) least = std::min(least, signed_distance(mesh, at));
        };
        for (const Vec3& vertex : points.vertices) look(vertex);
        for (const auto& [i, j, k] : points.triangles)
            look((points.vertices[i] + points.vertices[j] + points.vertices[k]) / 3);
        return least;
    }

private:
    const Scene& scene_;
    std::map<std::uint32_t, Mesh> meshes_;
};

TEST(SolidScenes, MeshesAreClosedFaceOutwardAndDoNotCutThemselves)
{
    for (const std::string_view name : kSolidScenes) {
        const Scene scene = make_scene(name, 10, 3);
        const Solids solids(scene);
        EXPECT_FALSE(solids.all().empty()) << name;
        for (const auto& [shape, mesh] : solids.all()) {
            SCOPED_TRACE(std::string(name) + ' ' + scene.shapes[shape].name);
            EXPECT_TRUE(is_closed(mesh));
            EXPECT_GT(mass_of(mesh).volume, 0);
            EXPECT_EQ(count_crossings(mesh), 0u);
            // The dial says how they are taken.
            const auto* stated = std::get_if<MeshShape>(&scene.shapes[shape].shape);
            EXPECT_EQ(stated != nullptr ? stated->nonconvex : "", "");
        }
    }
}

// Neighbors by distance, both ways; all but knots have some that reach into one another.
TEST(SolidScenes, NothingOverlapsAtFirst)
{
    for (const std::string_view name : kSolidScenes) {
        const Scene scene = make_scene(name, 12, 2);
        const Solids solids(scene);
        for (std::size_t a = 0; a < scene.body_count(); ++a)
            for (std::size_t b = 0; b < scene.body_count(); ++b) {
                const Body body_a = body_at(scene, a), body_b = body_at(scene, b);
                const Mesh *mesh_a = solids.mesh_of(body_a.shape),
                           *mesh_b = solids.mesh_of(body_b.shape);
                if (a == b || mesh_a == nullptr || mesh_b == nullptr) continue;
                const double apart = (body_a.position - body_b.position).norm();
                if (apart > extent_of(*mesh_a) + extent_of(*mesh_b)) continue;
                EXPECT_GT(solids.distance(a, b), 0) << name << ' ' << a << ' ' << b;
            }
    }
}

TEST(SolidScenes, SolidsFitTheCellsTheyAreDroppedFrom)
{
    for (const std::string_view name : {"knots", "terrain"}) {
        const Scene scene = make_scene(name, 60, 5);
        const Solids solids(scene);
        std::vector<std::pair<Vec3, double>> balls;
        for (std::size_t id = 0; id < scene.body_count(); ++id) {
            const Body body = body_at(scene, id);
            const Mesh* mesh = solids.mesh_of(body.shape);
            if (mesh != nullptr && body.motion == Motion::dynamic)
                balls.emplace_back(body.position, extent_of(*mesh));
        }
        ASSERT_GE(balls.size(), 30u);
        for (std::size_t i = 0; i < balls.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                ASSERT_GT((balls[i].first - balls[k].first).norm(),
                          balls[i].second + balls[k].second)
                    << name;
    }
}

TEST(SolidScenes, ChainLinksGoThroughOneAnother)
{
    const Scene scene = make_scene("chain", 10);
    ASSERT_EQ(scene.body_count(), 12u);
    EXPECT_EQ(body_at(scene, 0).motion, Motion::static_);
    EXPECT_EQ(body_at(scene, 1).motion, Motion::static_);
    const Solids solids(scene);
    // Ids run from end to end, but for the last link, which is body 1.
    std::vector<std::size_t> order = {0};
    for (std::size_t id = 2; id < 12; ++id) order.push_back(id);
    order.push_back(1);
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
        const Body a = body_at(scene, order[i]), b = body_at(scene, order[i + 1]);
        EXPECT_NEAR((b.position - a.position).norm(), 0.55, 1e-12);
        // The middle line of b passes the plane of a once within a's ring and once beyond it.
        const Vec3 axis = a.orientation * Vec3::UnitZ();
        EXPECT_NEAR(axis.dot(b.orientation * Vec3::UnitZ()), 0, 1e-12);
        const double in = (b.position - 0.4 * Vec3::UnitX() - a.position).norm();
        EXPECT_LT(in, 0.4 - 0.2);
        // Hooked with 5 cm of play.
        EXPECT_NEAR(solids.distance(order[i], order[i + 1]), 0.05, 2e-3);
    }
}

TEST(SolidScenes, PegsFitTheHolesAboveThem)
{
    const Scene scene = make_scene("peg", 12);
    ASSERT_EQ(scene.body_count(), 1u + 3 + 12);
    for (std::size_t i = 0; i < 12; ++i) {
        const Body torus = body_at(scene, 4 + i), peg = body_at(scene, 1 + i / 5);
        EXPECT_EQ(peg.motion, Motion::static_);
        EXPECT_EQ(peg.size, Vec3(0.5, 1.5, 0));
        EXPECT_NEAR(peg.position.z() - peg.size.y(), 0, 1e-12) << "not on the floor";
        const Vec3 offset = torus.position - peg.position;
        const double off = std::hypot(offset.x(), offset.y());
        const double cosine = (torus.orientation * Vec3::UnitZ()).z();
        // The hole, 0.75 wide and seen askew, is round the peg already.
        EXPECT_LT(off + 0.5, 0.75 * cosine);
        // Above its end: the lowest point of a torus that leans.
        EXPECT_GT(offset.z() - 0.25 - std::sqrt(1 - cosine * cosine), peg.size.y());
    }
}

TEST(SolidScenes, BoltsAreOfSteelAndInStepWithTheirNuts)
{
    const Scene scene = make_scene("bolt", 4);
    ASSERT_EQ(scene.body_count(), 8u);
    EXPECT_EQ(scene.materials[0].density, 8050);
    const Solids solids(scene);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(body_at(scene, i).motion, Motion::static_);
        EXPECT_EQ(body_at(scene, 4 + i).motion, Motion::dynamic);
        const double free = solids.distance(i, 4 + i);
        EXPECT_GE(free, 0.00025);
        EXPECT_LT(free, 0.0005);
        // In the nut, and far above the end of its way.
        const double head = body_at(scene, 4 + i).position.z();
        EXPECT_GT(head, 0.016 + 0.02);
        EXPECT_LT(head - 0.05, 0);
    }
}

TEST(SolidScenes, TerrainIsABlockUnderAllOfThem)
{
    const Scene scene = make_scene("terrain", 30);
    const Solids solids(scene);
    const Mesh& block = *solids.mesh_of(body_at(scene, 0).shape);
    EXPECT_EQ(body_at(scene, 0).motion, Motion::static_);
    Box3 box;
    for (const Vec3& vertex : block.vertices) {
        box.lower = box.lower.cwiseMin(vertex);
        box.upper = box.upper.cwiseMax(vertex);
    }
    // Its corners are as round as voxels of 0.25 m make them, its faces are where they were.
    EXPECT_NEAR(box.lower.z(), -2, 1e-3);
    for (std::size_t id = 1; id < scene.body_count(); ++id) {
        const Vec3 at = body_at(scene, id).position;
        EXPECT_GT(signed_distance(block, at), 0.3) << id;
        EXPECT_LT(signed_distance(block, {at.x(), at.y(), -1}), 0) << id;
    }
}

// Whatever its place and size in its file, another mesh takes the place of those that are made.
TEST(SolidScenes, AnotherMeshIsBroughtToTheirSize)
{
    TriangleSoup lump = noisy_ball(30, 0.5, 320, 4);
    for (Vec3& vertex : lump.vertices) vertex += Vec3(100, -50, 7);
    for (const auto& [name, extent] : {std::pair{"knots", 0.5}, std::pair{"terrain", 0.6}}) {
        const CatalogEntry& entry = *find_scene(name);
        const Scene plain = entry.make(20, 3), scene = entry.make_of(20, 3, lump);
        EXPECT_EQ(scene.name, plain.name);
        EXPECT_EQ(scene.body_count(), plain.body_count());
        int solids = 0;
        for (const ShapeDescription& shape : scene.shapes) {
            const auto* mesh = std::get_if<MeshShape>(&shape.shape);
            if (mesh == nullptr || shape.name == "terrain") continue;
            ++solids;
            EXPECT_EQ(mesh->triangles, lump.triangles);
            double greatest = 0;
            Box3 box;
            for (const Vec3& vertex : mesh->vertices) {
                greatest = std::max(greatest, vertex.norm());
                box.lower = box.lower.cwiseMin(vertex);
                box.upper = box.upper.cwiseMax(vertex);
            }
            EXPECT_NEAR(greatest, extent, 1e-12);
            EXPECT_LT((box.upper + box.lower).norm(), 1e-12);
        }
        EXPECT_EQ(solids, 1);
    }
}

}  // namespace
}  // namespace throng
