#include "perf/cooking/tree_samples.hpp"

#include "cooking/fields/voxel_field.hpp"

#include <openvdb/openvdb.h>

#include <stdexcept>

namespace throng::perf {

struct FieldTree::Grid {
    openvdb::FloatGrid::Ptr grid;
};

FieldTree::FieldTree(const VoxelBricks& bricks) : grid_(std::make_unique<Grid>())
{
    const auto path = std::filesystem::temp_directory_path() / "throng_tree_samples.vdb";
    if (const std::string trouble = write_vdb(path, bricks, {}); !trouble.empty())
        throw std::runtime_error("the level set cannot be written: " + trouble);
    openvdb::initialize();
    openvdb::io::File file(path.string());
    file.open(false);
    grid_->grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("distance"));
    file.close();
    std::filesystem::remove(path);
}

FieldTree::~FieldTree() = default;

void FieldTree::sample(const SampleArrays& arrays, std::size_t count) const
{
    const openvdb::FloatGrid& grid = *grid_->grid;
    const openvdb::math::Transform& transform = grid.transform();
    const auto inverse = static_cast<float>(1 / transform.voxelSize().x());
    auto accessor = grid.getConstAccessor();
    for (std::size_t i = 0; i < count; ++i) {
        const openvdb::Vec3d at =
            transform.worldToIndex(openvdb::Vec3d(arrays.x[i], arrays.y[i], arrays.z[i]));
        const openvdb::Coord base = openvdb::Coord::floor(at);
        const openvdb::Vec3s in(at - base.asVec3d());
        const auto value = [&](int x, int y, int z) {
            return accessor.getValue(base.offsetBy(x, y, z));
        };
        const float a = value(0, 0, 0), b = value(1, 0, 0), c = value(0, 1, 0), d = value(1, 1, 0);
        const float e = value(0, 0, 1), f = value(1, 0, 1), g = value(0, 1, 1), h = value(1, 1, 1);
        const float ab = a + (b - a) * in.x(), cd = c + (d - c) * in.x();
        const float ef = e + (f - e) * in.x(), gh = g + (h - g) * in.x();
        const float low = ab + (cd - ab) * in.y(), high = ef + (gh - ef) * in.y();
        const float x_low = b - a + (d - c - b + a) * in.y();
        const float x_high = f - e + (h - g - f + e) * in.y();
        arrays.distance[i] = low + (high - low) * in.z();
        arrays.gx[i] = (x_low + (x_high - x_low) * in.z()) * inverse;
        arrays.gy[i] = (cd - ab + (gh - ef - cd + ab) * in.z()) * inverse;
        arrays.gz[i] = (high - low) * inverse;
    }
}

}  // namespace throng::perf
