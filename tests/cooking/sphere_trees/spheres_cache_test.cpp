#include "cooking/sphere_trees/spheres_cache.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "tests/cooking/cache_folder.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

namespace fs = std::filesystem;

class SpheresCache : public test::CacheFolder {
protected:
    SpheresCache()
    {
        const TriangleSoup soup = torus_mesh(3, 1, 8, 5);
        mesh = build_mesh(soup.vertices, soup.triangles).mesh;
        find_vertex_normals(mesh);
    }

    fs::path file() const { return folder / (spheres_key(mesh, wanted) + ".spheres"); }

    Mesh mesh;
    SphereTreeLimits wanted{2, 8, 0, 2000};
};

void expect_same(const CachedSpheres& made, const SphereTree& wanted)
{
    EXPECT_EQ(made.warning, "");
    ASSERT_EQ(made.tree.levels.size(), wanted.levels.size());
    for (std::size_t i = 0; i < wanted.levels.size(); ++i) {
        const SphereTree::Level &a = made.tree.levels[i], &b = wanted.levels[i];
        EXPECT_EQ(a.error, b.error);
        ASSERT_EQ(a.nodes.size(), b.nodes.size());
        for (std::size_t k = 0; k < b.nodes.size(); ++k) {
            EXPECT_EQ(a.nodes[k].center, b.nodes[k].center);
            EXPECT_EQ(a.nodes[k].radius, b.nodes[k].radius);
            EXPECT_EQ(a.nodes[k].bound, b.nodes[k].bound);
            EXPECT_EQ(a.nodes[k].first, b.nodes[k].first);
            EXPECT_EQ(a.nodes[k].count, b.nodes[k].count);
        }
    }
}

TEST_F(SpheresCache, ColdAndKeptAreTheSame)
{
    const SphereTree plain = build_sphere_tree(mesh, wanted);
    ASSERT_EQ(plain.levels.size(), 2U);
    expect_same(cached_spheres(mesh, wanted, {}), plain);
    EXPECT_FALSE(fs::exists(folder));
    expect_same(cached_spheres(mesh, wanted, folder), plain);
    ASSERT_TRUE(fs::exists(file()));
    expect_same(cached_spheres(mesh, wanted, folder), plain);
}

TEST_F(SpheresCache, KeptSpheresAreRead)
{
    cached_spheres(mesh, wanted, folder);
    // A file of one level under this name, whose key is another's, is not believed; its own is.
    SphereTreeLimits other = wanted;
    other.levels = 1;
    const fs::path own = file();
    cached_spheres(mesh, other, folder);
    const fs::path others = folder / (spheres_key(mesh, other) + ".spheres");
    ASSERT_NE(own, others);
    fs::copy_file(others, own, fs::copy_options::overwrite_existing);
    EXPECT_EQ(cached_spheres(mesh, wanted, folder).tree.levels.size(), 2U);
    EXPECT_EQ(cached_spheres(mesh, other, folder).tree.levels.size(), 1U);
    // It was put right, and nothing else was left behind.
    EXPECT_NE(fs::file_size(own), fs::file_size(others));
    EXPECT_EQ(files(), 2);
}

// What a checksum cannot tell: written whole, by another hand.
TEST_F(SpheresCache, ChildrenThatAreNotThereAreNotBelieved)
{
    const SphereTree plain = cached_spheres(mesh, wanted, folder).tree;
    const std::string whole = bytes_of_file(file());
    std::string turned = whole.substr(0, whole.size() - kChecksumBytes);
    // The root's children: behind the key and its size, the count of levels, the error and count of
    // the first, and the root's five numbers.
    const std::size_t children = 8 + 16 + 8 + 16 + 40;
    ASSERT_EQ(turned[children], static_cast<char>(plain.levels[0].nodes[0].count));
    turned[children] = 100;
    test::overwrite(file(), turned);
    ASSERT_TRUE(append_checksum(file()));
    expect_same(cached_spheres(mesh, wanted, folder), plain);
    EXPECT_EQ(bytes_of_file(file()), whole);
}

TEST_F(SpheresCache, DamagedFilesAreMadeAnew)
{
    const SphereTree plain = cached_spheres(mesh, wanted, folder).tree;
    const std::string whole = bytes_of_file(file());
    for (const std::string& bytes : test::damaged(whole)) {
        test::overwrite(file(), bytes);
        expect_same(cached_spheres(mesh, wanted, folder), plain);
        EXPECT_EQ(bytes_of_file(file()), whole);
    }
}

TEST_F(SpheresCache, WhatIsNoFileIsPassedBy)
{
    const SphereTree plain = cached_spheres(mesh, wanted, folder).tree;
    for (int which = 0; which < test::kObstacles; ++which) {
        test::put_in_the_way(file(), which);
        CachedSpheres made = cached_spheres(mesh, wanted, folder);
        EXPECT_EQ(made.warning.empty(), which > 1) << made.warning;
        made.warning.clear();
        expect_same(made, plain);
    }
}

TEST_F(SpheresCache, FolderThatCannotBeWrittenIsRemarkedOn)
{
    // A file where the folder should be.
    std::ofstream(folder.string()) << "in the way";
    const CachedSpheres made = cached_spheres(mesh, wanted, folder);
    EXPECT_EQ(made.tree.levels.size(), 2U);
    EXPECT_EQ(made.warning.rfind("not kept for the next run: ", 0), 0u);
}

TEST_F(SpheresCache, KeyTellsMeshesAndWishesApart)
{
    const std::string key = spheres_key(mesh, wanted);
    EXPECT_NE(spheres_key(mesh, {3, 8, 0, 2000}), key);
    EXPECT_NE(spheres_key(mesh, {2, 9, 0, 2000}), key);
    EXPECT_NE(spheres_key(mesh, {2, 8, 0.1, 2000}), key);
    EXPECT_NE(spheres_key(mesh, {2, 8, 0, 2001}), key);
    Mesh other = mesh;
    other.vertices[0].x() += 1e-15;
    EXPECT_NE(spheres_key(other, wanted), key);
    other = mesh;
    std::swap(other.triangles[0], other.triangles[1]);
    EXPECT_NE(spheres_key(other, wanted), key);
}

}  // namespace
}  // namespace throng
