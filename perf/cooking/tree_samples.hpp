// Tree samples: a level set sampled where OpenVDB keeps it, to tell what bricks are worth.
#pragma once

#include "kernels/data/solids.hpp"
#include "kernels/geometry/voxel_kernels.hpp"

#include <memory>

namespace throng::perf {

/// A level set in OpenVDB's tree: the values of bricks, written to a file and read back.
class FieldTree {
public:
    explicit FieldTree(const VoxelBricks& bricks);
    ~FieldTree();

    /// Distance and gradient at some points, both of the eight values round each, which an accessor
    /// looks up: the quickest way that the tree offers. m.
    void sample(const SampleArrays& arrays, std::size_t count) const;

private:
    struct Grid;
    std::unique_ptr<Grid> grid_;
};

}  // namespace throng::perf
