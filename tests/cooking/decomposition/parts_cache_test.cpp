#include "cooking/decomposition/parts_cache.hpp"

#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"
#include "scene/catalog/closed_meshes.hpp"
#include "tests/cooking/cache_folder.hpp"

#include <gtest/gtest.h>

namespace throng {
namespace {

namespace fs = std::filesystem;

class PartsCache : public test::CacheFolder {
protected:
    PartsCache()
    {
        const TriangleSoup soup = torus_mesh(3, 1, 8, 5);
        mesh = build_mesh(soup.vertices, soup.triangles).mesh;
        find_vertex_normals(mesh);
    }

    fs::path file() const { return folder / (parts_key(mesh, wanted) + ".parts"); }

    Mesh mesh;
    PartsWanted wanted{4, 0};
};

void expect_same(const ConvexParts& a, const ConvexParts& b)
{
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.warnings, b.warnings);
    EXPECT_EQ(a.error, b.error);
    EXPECT_EQ(a.outside, b.outside);
    EXPECT_EQ(a.uncovered, b.uncovered);
    EXPECT_EQ(a.volume_error, b.volume_error);
    ASSERT_EQ(a.hulls.size(), b.hulls.size());
    for (std::size_t i = 0; i < a.hulls.size(); ++i) {
        EXPECT_EQ(a.hulls[i].vertices, b.hulls[i].vertices);
        EXPECT_EQ(a.hulls[i].normals, b.hulls[i].normals);
        EXPECT_EQ(a.hulls[i].offsets, b.hulls[i].offsets);
        EXPECT_EQ(a.hulls[i].face_vertices, b.hulls[i].face_vertices);
    }
}

TEST_F(PartsCache, ColdAndKeptAreTheSame)
{
    const ConvexParts plain = split_into_parts(mesh, wanted);
    expect_same(cached_parts(mesh, wanted, {}), plain);
    EXPECT_FALSE(fs::exists(folder));
    expect_same(cached_parts(mesh, wanted, folder), plain);
    ASSERT_TRUE(fs::exists(file()));
    expect_same(cached_parts(mesh, wanted, folder), plain);
}

TEST_F(PartsCache, KeptPartsAreRead)
{
    cached_parts(mesh, wanted, folder);
    // A file of one part under this name, whose key is another's, is not believed; its own is.
    const PartsWanted other{1, 0};
    const fs::path own = file();
    cached_parts(mesh, other, folder);
    const fs::path others = folder / (parts_key(mesh, other) + ".parts");
    ASSERT_NE(own, others);
    fs::copy_file(others, own, fs::copy_options::overwrite_existing);
    EXPECT_EQ(cached_parts(mesh, wanted, folder).hulls.size(), 4u);
    EXPECT_EQ(cached_parts(mesh, other, folder).hulls.size(), 1u);
    // It was put right, and nothing else was left behind.
    EXPECT_NE(fs::file_size(own), fs::file_size(others));
    EXPECT_EQ(files(), 2);
}

TEST_F(PartsCache, DamagedFilesAreMadeAnew)
{
    const ConvexParts plain = cached_parts(mesh, wanted, folder);
    const std::string whole = bytes_of_file(file());
    for (const std::string& bytes : test::damaged(whole)) {
        test::overwrite(file(), bytes);
        expect_same(cached_parts(mesh, wanted, folder), plain);
        EXPECT_EQ(bytes_of_file(file()), whole);
    }
}

TEST_F(PartsCache, WhatIsNoFileIsPassedBy)
{
    const ConvexParts plain = cached_parts(mesh, wanted, folder);
    for (const int which : {0, 2}) {
        test::put_in_the_way(file(), which);
        ConvexParts parts = cached_parts(mesh, wanted, folder);
        // A folder cannot be replaced, which is told; all else is.
        if (which <= 1) {
            EXPECT_EQ(parts.warnings.back().rfind("not kept for the next run: ", 0), 0u) << which;
            parts.warnings.pop_back();
        } else {
            EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(file()))) << which;
        }
        expect_same(parts, plain);
        EXPECT_EQ(files(), 1) << which;
    }
}

TEST_F(PartsCache, FolderThatCannotBeWrittenIsRemarkedOn)
{
    // A file where the folder should be.
    std::ofstream(folder.string()) << "in the way";
    const ConvexParts parts = cached_parts(mesh, wanted, folder);
    EXPECT_TRUE(parts.trouble.empty());
    ASSERT_FALSE(parts.warnings.empty());
    EXPECT_EQ(parts.warnings.back().rfind("not kept for the next run: ", 0), 0u);
}

TEST_F(PartsCache, KeyTellsMeshesAndWishesApart)
{
    const std::string key = parts_key(mesh, wanted);
    EXPECT_NE(parts_key(mesh, {5, 0}), key);
    EXPECT_NE(parts_key(mesh, {4, 0.1}), key);
    Mesh other = mesh;
    other.vertices[0].x() += 1e-15;
    EXPECT_NE(parts_key(other, wanted), key);
    other = mesh;
    std::swap(other.triangles[0], other.triangles[1]);
    EXPECT_NE(parts_key(other, wanted), key);
}

}  // namespace
}  // namespace throng
