// Cache folder: a folder of a test's own for files that are kept, and ways to damage these.
#pragma once

#include "cooking/cache/file_checksum.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sys/stat.h>

namespace throng::test {

/// Empty before the test and gone after.
class CacheFolder : public testing::Test {
protected:
    void SetUp() override { std::filesystem::remove_all(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }

    std::ptrdiff_t files() const
    {
        return std::distance(std::filesystem::directory_iterator(folder), {});
    }

    const std::filesystem::path folder = [] {
        const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
        return std::filesystem::path(testing::TempDir())
            / (std::string("throng_") + test->test_suite_name() + '_' + test->name());
    }();
};

inline void overwrite(const std::filesystem::path& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

/// Puts something else in the place of a file, one for each number below kObstacles: a folder, a
/// full folder, a pipe that nobody writes to, links that lead nowhere and in a circle, a file that
/// may not be read.
inline constexpr int kObstacles = 6;
inline void put_in_the_way(const std::filesystem::path& file, int which)
{
    namespace fs = std::filesystem;
    fs::remove_all(file);
    if (which <= 1) fs::create_directory(file);
    if (which == 1) std::ofstream(file / "within") << "something";
    if (which == 2) {
        ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    }
    if (which == 3) fs::create_symlink("nowhere", file);
    if (which == 4) fs::create_symlink(file.filename(), file);
    if (which == 5) {
        std::ofstream(file) << "locked";
        fs::permissions(file, fs::perms::none);
    }
}

/// A file of some length cut short, with more behind it, without its checksum, and with a bit
/// turned here and there.
inline std::vector<std::string> damaged(const std::string& whole)
{
    const std::size_t size = whole.size();
    std::vector<std::string> all{"x", whole + "x"};
    for (const std::size_t cut :
         {std::size_t{0}, std::size_t{7}, size / 2, size - kChecksumBytes, size - 1})
        all.push_back(whole.substr(0, cut));
    for (const std::size_t at : {std::size_t{3}, size / 3, size - 20, size - 3}) {
        all.push_back(whole);
        all.back()[at] = static_cast<char>(all.back()[at] ^ 4);
    }
    return all;
}

}  // namespace throng::test
