// Field cache: the same bits cold and kept, and nothing believed that is damaged or another's.
#include "cooking/fields/field_cache.hpp"

#include "tests/cooking/cache_folder.hpp"
#include "tests/support/closed.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace throng {
namespace {

namespace fs = std::filesystem;

class FieldCache : public test::CacheFolder {
protected:
    FieldCache() { settings_.voxel = 0.12; }

    fs::path file() const { return folder / (field_key(mesh_, settings_) + ".vdb"); }
    void expect_same(const FieldResult& result) const
    {
        const FieldResult plain = build_field(mesh_, settings_);
        EXPECT_EQ(result.trouble, "");
        EXPECT_EQ(result.bricks.origin, plain.bricks.origin);
        EXPECT_EQ(result.bricks.voxel, plain.bricks.voxel);
        EXPECT_EQ(result.bricks.band, plain.bricks.band);
        EXPECT_EQ(result.bricks.bricks, plain.bricks.bricks);
        EXPECT_EQ(result.bricks.brick_of, plain.bricks.brick_of);
        EXPECT_EQ(result.bricks.values, plain.bricks.values);
        EXPECT_EQ(result.error, plain.error);
        EXPECT_EQ(result.warnings, plain.warnings);
    }

    // With a fin that is remarked on.
    Mesh mesh_ =
        closed(both(torus_mesh(1, 0.3, 24, 12), moved(box_mesh({0.5, 0.5, 0.02}), {0, 0, 1.3})));
    FieldSettings settings_;
};

TEST_F(FieldCache, GivesTheSameBitsColdAndKept)
{
    expect_same(cached_field(mesh_, settings_, folder));
    EXPECT_TRUE(fs::exists(file()));
    const auto written = fs::last_write_time(file());
    expect_same(cached_field(mesh_, settings_, folder));
    EXPECT_EQ(fs::last_write_time(file()), written);  // read, not made again
    // Nothing else is left lying about, and other tools can read what is.
    EXPECT_EQ(files(), 1);
    EXPECT_EQ(read_vdb(file(), VdbWants::bricks).trouble, "");
}

TEST_F(FieldCache, BelievesNothingThatIsDamaged)
{
    cached_field(mesh_, settings_, folder);
    const std::string good = bytes_of_file(file());
    ASSERT_GT(good.size(), 10000u);
    for (const std::string& bytes : test::damaged(good)) {
        test::overwrite(file(), bytes);
        expect_same(cached_field(mesh_, settings_, folder));
        // Made anew; but for what a .vdb draws by lot for its name.
        const std::string made = bytes_of_file(file());
        EXPECT_TRUE(made != bytes && made.size() == good.size());
    }
}

TEST_F(FieldCache, PassesByWhatIsNoFile)
{
    cached_field(mesh_, settings_, folder);
    for (const int which : {0, 2}) {
        test::put_in_the_way(file(), which);
        EXPECT_EQ(cached_field(mesh_, settings_, folder).trouble, "") << which;
        EXPECT_EQ(fs::is_regular_file(fs::symlink_status(file())), which > 1) << which;
    }
}

TEST_F(FieldCache, BelievesNoFileOfAnotherMesh)
{
    const Mesh other = closed(ball_mesh(1, 20, 10));
    cached_field(other, settings_, folder);
    fs::rename(folder / (field_key(other, settings_) + ".vdb"), file());
    expect_same(cached_field(mesh_, settings_, folder));
}

TEST_F(FieldCache, NamesFilesByAllThatTheyAreMadeFrom)
{
    const std::string key = field_key(mesh_, settings_);
    EXPECT_EQ(key.size(), 16u);
    Mesh other = mesh_;
    other.vertices[5].x() = std::nextafter(other.vertices[5].x(), 10.0);
    EXPECT_NE(field_key(other, settings_), key);
    other = mesh_;
    std::swap(other.triangles[3], other.triangles[4]);
    EXPECT_NE(field_key(other, settings_), key);
    FieldSettings changed = settings_;
    changed.voxel *= 1.5;
    EXPECT_NE(field_key(mesh_, changed), key);
    changed = settings_;
    changed.sign = FieldSign::flood;
    EXPECT_NE(field_key(mesh_, changed), key);
    // A size that was left to throng is the one it takes.
    changed = settings_;
    changed.voxel = 0;
    settings_.voxel = voxel_size_for(mesh_);
    EXPECT_EQ(field_key(mesh_, changed), field_key(mesh_, settings_));
    // How much may be taken does not change what is made.
    changed.most_bytes /= 2;
    EXPECT_EQ(field_key(mesh_, changed), field_key(mesh_, settings_));
}

TEST_F(FieldCache, MayBeFilledBySeveralAtOnce)
{
    std::vector<FieldResult> results(4);
    std::vector<std::thread> all;
    for (FieldResult& result : results)
        all.emplace_back([&] { result = cached_field(mesh_, settings_, folder); });
    for (std::thread& one : all) one.join();
    for (const FieldResult& result : results) expect_same(result);
    EXPECT_EQ(files(), 1);
}

TEST_F(FieldCache, DoesWithoutAFolderThatCannotBeWritten)
{
    std::ofstream(folder.string()) << "a file where the folder should be";
    const FieldResult result = cached_field(mesh_, settings_, folder);
    EXPECT_EQ(result.trouble, "");
    EXPECT_EQ(result.bricks.values, build_field(mesh_, settings_).bricks.values);
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_EQ(result.warnings.back().find("not kept for the next run: "), 0u);
    expect_same(cached_field(mesh_, settings_, {}));
}

}  // namespace
}  // namespace throng
