// Voxel kernels: a distance in bricks, read at many points side by side.
//
// Free of Eigen and of containers: the wide kernel is compiled once for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace throng {

struct VoxelBricks;

/// VoxelBricks as plain numbers. At most 2^31 values.
struct BrickView {
    float origin[3];  // m
    float inverse;    // voxels a meter
    float band;       // m
    std::int32_t bricks[3];
    const std::int32_t* brick_of;
    const float* values;
};

/// Of bricks that are not empty and outlive it.
BrickView view_of(const VoxelBricks& bricks);

/// Where samples are taken and where they go; see sample_many().
struct SampleArrays {
    const float *x, *y, *z;
    float *distance, *gx, *gy, *gz;
};

using SampleKernel = void (*)(const BrickView& view, const SampleArrays& arrays, std::size_t count);

/// The kernel of the width that this run takes; see lane_width().
const SampleKernel& sample_kernel();
/// That of a width by name; null where this machine has not got it.
const SampleKernel* sample_kernel_of(const char* width);

}  // namespace throng
