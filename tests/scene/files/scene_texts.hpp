// Scene texts: scene files that are nowhere but in a test, and what becomes of reading one.
#pragma once

#include "tests/support/vdb_files.hpp"
#include "throng/scene_file.hpp"

#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace throng::given {

/// Files that are nowhere but in the test.
struct GivenFiles {
    std::map<std::string, std::string> content;

    FileContent operator()(const std::string& path, std::uint64_t limit) const
    {
        const auto found = content.find(path);
        if (found == content.end()) return {{}, 0, "no such file"};
        return {found->second.substr(0, limit), found->second.size(), {}};
    }
};

inline std::string double_bytes(const std::vector<double>& numbers)
{
    std::string bytes(numbers.size() * sizeof(double), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

/// A record that is good, save for one number.
inline std::string
record_bytes(std::size_t count, std::size_t bad, std::size_t place, double number)
{
    std::vector<double> all;
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<double> one(13, 0.0);
        one[3] = 1;
        if (i == bad) one[place] = number;
        all.insert(all.end(), one.begin(), one.end());
    }
    return double_bytes(all);
}

inline std::string sized_record(double x, double y, double z)
{
    return double_bytes({0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, x, y, z});
}

inline GivenFiles given_files()
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    static const std::string hill = open_ground_vdb();
    return {{{"in/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
             {"in/empty.obj", "v 0 0 0\n"},
             {"in/hill.vdb", hill},
             {"in/torn.vdb", hill.substr(0, hill.size() / 2)},
             {"in/bad.obj", "v 0 0 0\nf 1 1 2\n"},
             {"in/huge.obj", "v 1e300 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
             {"in/ten.bin", record_bytes(10, 10, 0, 0)},
             {"in/nan.bin", record_bytes(10, 7, 2, nan)},
             {"in/turn.bin", record_bytes(10, 3, 3, 1.1)},
             {"in/fast.bin", record_bytes(10, 9, 8, 1)},
             {"in/spin.bin", record_bytes(10, 9, 12, 1)},
             {"in/short.bin", record_bytes(10, 10, 0, 0).substr(1)},
             {"in/long.bin", record_bytes(10, 10, 0, 0) + "x"},
             {"in/box.bin", sized_record(1, 2, 3)},
             {"in/flat.bin", sized_record(1, 2, 0)},
             {"in/ball.bin", sized_record(0.5, 0, 0)},
             {"in/ball2.bin", sized_record(0.5, 0.5, 0)},
             {"in/pill.bin", sized_record(0.5, 0.5, 0)},
             {"in/pill2.bin", sized_record(0.5, -0.5, 0)},
             {"in/giant.bin", sized_record(1e14, 1e14, 1e14)}}};
}

inline Scene read_given(const std::string& text)
{
    return read_scene_text(text, "s.json", "in", given_files());
}

inline std::string refusal_of(const std::string& text)
{
    try {
        read_given(text);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace throng::given
