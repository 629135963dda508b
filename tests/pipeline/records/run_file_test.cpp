// Run file: what a reader of HDF5 finds in it.
#include "throng/run_file.hpp"

#include "throng/catalog.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <hdf5.h>
#include <sys/resource.h>
#include <unistd.h>

namespace throng {
namespace {

/// A file of one test, gone in the end.
class RunFileTest : public testing::Test {
public:
    RunFileTest()
        : path_((std::filesystem::temp_directory_path()
                 / ("throng_run_file_" + std::to_string(::getpid()) + ".h5"))
                    .string())
    { }
    ~RunFileTest() override { std::filesystem::remove(path_); }

protected:
    std::string path_;
};

template <class Number>
struct Array {
    std::vector<hsize_t> size;
    std::vector<Number> values;
};

template <class Number>
Array<Number> read_array(const std::string& path, const char* name, hid_t type)
{
    Array<Number> array;
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(set);
    array.size.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, array.size.data(), nullptr);
    std::size_t count = 1;
    for (const hsize_t side : array.size) count *= side;
    array.values.resize(count);
    EXPECT_GE(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()), 0) << name;
    H5Sclose(space);
    H5Dclose(set);
    H5Fclose(file);
    return array;
}

std::string read_text(const std::string& path, const char* owner, const char* name)
{
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t attribute = H5Aopen_by_name(file, owner, name, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute);
    char* letters = nullptr;
    EXPECT_GE(H5Aread(attribute, type, &letters), 0) << name;
    std::string text = letters == nullptr ? "" : letters;
    H5free_memory(letters);
    H5Tclose(type);
    H5Aclose(attribute);
    H5Fclose(file);
    return text;
}

using Sizes = std::vector<hsize_t>;

TEST_F(RunFileTest, TellsWhatTheRunCalledFor)
{
    const Scene scene = make_scene("pile", 20);
    World world(scene);
    RunFile file(path_, scene, world, {"pile:20", "1.2.3", 1, 1});
    world.step(30);
    file.write_frame(world);
    const std::vector<EffectEntry> effects = effect_ledger(world, world.stages());
    file.write_effects(effects);
    file.close();
    EXPECT_THROW(file.write_effects(effects), RunFileError);
    const auto on = read_array<std::uint8_t>(path_, "effects/on", H5T_NATIVE_UINT8);
    const auto rows = read_array<std::uint64_t>(path_, "effects/rows", H5T_NATIVE_UINT64);
    const auto ms = read_array<double>(path_, "effects/ms", H5T_NATIVE_DOUBLE);
    ASSERT_EQ(on.values.size(), static_cast<std::size_t>(kEffects));
    for (std::size_t i = 0; i < effects.size(); ++i) {
        EXPECT_EQ(on.values[i] != 0, effects[i].on);
        EXPECT_EQ(rows.values[i], effects[i].rows);
        EXPECT_EQ(ms.values[i], effects[i].ms);
    }
    EXPECT_EQ(on.values[static_cast<std::size_t>(Effect::contact)], 1);
    EXPECT_GT(rows.values[static_cast<std::size_t>(Effect::contact)], 0u);
}

TEST_F(RunFileTest, HoldsEveryFrame)
{
    // Enough frames for two chunks and a part.
    constexpr std::size_t kFrames = 150;
    const Scene scene = make_scene("pile", 20);
    World world(scene);
    RunFile file(path_, scene, world, {"pile:20", "1.2.3", 1, 1});
    std::vector<double> positions;
    std::vector<float> turns;
    const auto add = [&] {
        const double error = 1e-3 * static_cast<double>(world.report().step);
        file.write_frame(world, {world.report().step, error, 2 * error, world.bodies()[7]});
        for (const BodyId body : world.bodies()) {
            const Pose pose = world.pose(body);
            positions.insert(positions.end(), pose.position.data(), pose.position.data() + 3);
            turns.push_back(static_cast<float>(pose.orientation.w()));
        }
    };
    add();
    for (std::size_t i = 1; i < kFrames; ++i) {
        world.step();
        add();
    }
    file.close();

    const hsize_t bodies = world.body_count();
    const auto position = read_array<double>(path_, "/frames/position", H5T_NATIVE_DOUBLE);
    EXPECT_EQ(position.size, (Sizes{kFrames, bodies, 3}));
    EXPECT_EQ(position.values, positions);
    const auto turn = read_array<float>(path_, "/frames/orientation", H5T_NATIVE_FLOAT);
    EXPECT_EQ(turn.size, (Sizes{kFrames, bodies, 4}));
    for (std::size_t i = 0; i < turns.size(); ++i) ASSERT_EQ(turn.values[4 * i], turns[i]);
    EXPECT_EQ(read_array<float>(path_, "/frames/velocity", H5T_NATIVE_FLOAT).size,
              (Sizes{kFrames, bodies, 3}));
    EXPECT_EQ(read_array<float>(path_, "/frames/angular_velocity", H5T_NATIVE_FLOAT).size,
              (Sizes{kFrames, bodies, 3}));
    const auto time = read_array<double>(path_, "/frames/time", H5T_NATIVE_DOUBLE);
    EXPECT_EQ(time.size, Sizes{kFrames});
    EXPECT_EQ(time.values.back(), (kFrames - 1) * world.settings().dt);
    EXPECT_EQ(read_array<std::uint64_t>(path_, "/frames/step", H5T_NATIVE_UINT64).values.back(),
              kFrames - 1);
    const double last = 1e-3 * static_cast<double>(kFrames - 1);
    EXPECT_EQ(read_array<double>(path_, "/frames/error", H5T_NATIVE_DOUBLE).values.back(), last);
    EXPECT_EQ(read_array<double>(path_, "/frames/greatest_error", H5T_NATIVE_DOUBLE).values.back(),
              2 * last);
    EXPECT_EQ(read_array<std::uint32_t>(path_, "/frames/worst_body", H5T_NATIVE_UINT32).values,
              std::vector<std::uint32_t>(kFrames, 7));

    EXPECT_EQ(read_text(path_, "/", "throng"), "1.2.3");
    EXPECT_EQ(read_text(path_, "/", "scene"), "pile:20");
    EXPECT_EQ(read_text(path_, "/dials", "substeps"), "4");
    EXPECT_EQ(read_text(path_, "/frames/velocity", "unit"), "m/s");
    const auto mass = read_array<double>(path_, "/bodies/mass", H5T_NATIVE_DOUBLE);
    const auto size = read_array<double>(path_, "/bodies/size", H5T_NATIVE_DOUBLE);
    const auto kind = read_array<std::uint8_t>(path_, "/bodies/shape_kind", H5T_NATIVE_UINT8);
    const auto ids = world.bodies();
    for (std::size_t i = 0; i < ids.size(); ++i) {
        EXPECT_EQ(mass.values[i], world.mass(ids[i]));
        EXPECT_EQ(kind.values[i], 4) << "a pile is all boxes";
        EXPECT_GT(size.values[3 * i + 2], 0);
    }
}

TEST_F(RunFileTest, AWorldWithoutBodiesHasFramesToo)
{
    const Scene scene;
    World world(scene);
    RunFile file(path_, scene, world, {"nothing", "1.2.3", 1, 1});
    file.write_frame(world);
    file.close();
    EXPECT_EQ(read_array<double>(path_, "/frames/position", H5T_NATIVE_DOUBLE).size,
              (Sizes{1, 0, 3}));
    EXPECT_EQ(read_array<double>(path_, "/frames/time", H5T_NATIVE_DOUBLE).size, Sizes{1});
}

TEST_F(RunFileTest, WhatCannotBeWrittenIsSaid)
{
    const Scene scene = make_scene("pile", 20);
    const World world(scene);
    try {
        const RunFile file(path_ + "/no/file.h5", scene, world, {"pile:20", "1.2.3", 1, 1});
        FAIL() << "a file in no folder was written";
    } catch (const RunFileError& error) {
        EXPECT_NE(std::string(error.what()).find("cannot write the file"), std::string::npos)
            << error.what();
    }
}

TEST_F(RunFileTest, AFullDiskIsSaidAndNothingHangs)
{
    const Scene scene = make_scene("pile", 2000);
    World world(scene);
    world.step(3);
    struct rlimit before = {};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const struct rlimit small = {200'000, before.rlim_max};
    std::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &small);
    std::string said;
    try {
        RunFile file(path_, scene, world, {"pile:2000", "1.2.3", 1, 1});
        for (int i = 0; i < 30; ++i) file.write_frame(world);
        file.close();
    } catch (const RunFileError& error) {
        said = error.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(said.find("File too large"), std::string::npos) << said;
}

// What room was kept for is told by a limit that is lifted once a frame has failed.
TEST_F(RunFileTest, WhatWasWrittenBeforeTheDiskWasFullCanBeRead)
{
    const Scene scene = make_scene("pile", 2000);
    World world(scene);
    struct rlimit before = {};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const struct rlimit small = {6'000'000, before.rlim_max};
    std::signal(SIGXFSZ, SIG_IGN);
    RunFile file(path_, scene, world, {"pile:2000", "1.2.3", 1, 1});
    ::setrlimit(RLIMIT_FSIZE, &small);
    std::size_t frames = 0;
    EXPECT_THROW(
        while (frames < 1000) {
            world.step();
            file.write_frame(world);
            ++frames;
        },
        RunFileError);
    ::setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_THROW(file.write_frame(world), RunFileError);
    file.close();
    EXPECT_TRUE(file.closed());

    const std::size_t whole = file.whole_frames();
    EXPECT_GE(whole, 8u);
    EXPECT_LE(whole, frames);
    const auto time = read_array<double>(path_, "/frames/time", H5T_NATIVE_DOUBLE);
    ASSERT_EQ(time.size, Sizes{whole});
    const auto places = read_array<double>(path_, "/frames/position", H5T_NATIVE_DOUBLE);
    ASSERT_GE(places.size[0], whole);
    World again(scene);
    again.step(static_cast<int>(whole));
    const std::vector<BodyId> bodies = again.bodies();
    for (std::size_t i = 0; i < bodies.size(); ++i)
        ASSERT_EQ(places.values[((whole - 1) * bodies.size() + i) * 3 + 2],
                  again.pose(bodies[i]).position.z());
}

}  // namespace
}  // namespace throng
