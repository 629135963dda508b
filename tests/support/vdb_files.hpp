// Vdb files: level sets of a formula, as the bytes of a file.
#pragma once

#include "cooking/cache/file_checksum.hpp"
#include "cooking/fields/voxel_field.hpp"
#include "kernels/geometry/voxel_bricks.hpp"

#include <filesystem>
#include <random>
#include <stdexcept>

namespace throng {

/// By way of a passing file of the test's own.
inline std::string vdb_bytes(const VoxelBricks& bricks)
{
    const std::filesystem::path path = std::filesystem::temp_directory_path()
        / ("throng_" + std::to_string(std::random_device{}()) + ".vdb");
    const std::string trouble = write_vdb(path, bricks, {});
    if (!trouble.empty()) throw std::runtime_error(trouble);
    std::string bytes = bytes_of_file(path);
    std::filesystem::remove(path);
    return bytes;
}

/// A ball about the origin, with voxels of a tenth of its radius.
inline std::string ball_vdb(double radius)
{
    const Box3 box{Vec3::Constant(-radius), Vec3::Constant(radius)};
    return vdb_bytes(bake_bricks(box, 0.1 * radius, 0.4 * radius,
                                 [&](const Vec3& at) { return at.norm() - radius; }));
}

/// Ground that leans along x by a tenth, 2 m on a side: its values end and its surface does not.
inline std::string open_ground_vdb()
{
    const Box3 box{{-1, -1, -0.4}, {1, 1, 0.4}};
    return vdb_bytes(bake_bricks(
        box, 0.1, 0.3, [](const Vec3& at) { return (at.z() - 0.1 * at.x()) / std::sqrt(1.01); }));
}

}  // namespace throng
