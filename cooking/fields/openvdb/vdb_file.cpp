// VDB file: bricks as a tree of OpenVDB's, its surface, and the files that other tools read.
#include "cooking/fields/field_values.hpp"
#include "cooking/fields/openvdb/vdb.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/mesh_distance.hpp"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace throng::vdb {
namespace {

using openvdb::FloatGrid;
using openvdb::FloatTree;
constexpr int kCells = VoxelBricks::kCells, kSide = VoxelBricks::kSide;

constexpr const char* kOurs = "throng_field";
constexpr int kFormat = 1;

void fill_leaf(const VoxelBricks& bricks,
               std::size_t stored,
               const openvdb::Coord& origin,
               FloatTree& tree)
{
    const float* const values = bricks.values.data() + stored * VoxelBricks::kValues;
    const auto band = static_cast<float>(bricks.band);
    auto* const leaf = new FloatTree::LeafNodeType(origin, band, false);
    float* const buffer = leaf->buffer().data();
    for (int x = 0; x < kCells; ++x)
        for (int y = 0; y < kCells; ++y)
            for (int z = 0; z < kCells; ++z) {
                const float value = values[(z * kSide + y) * kSide + x];
                const auto at = static_cast<openvdb::Index>((x * kCells + y) * kCells + z);
                buffer[at] = value;
                if (value < band) leaf->setValueOn(at, value);
            }
    tree.addLeaf(leaf);
}

// The grid's last layer lies beyond the last bricks' own cells.
void fill_rim(const VoxelBricks& bricks,
              std::size_t stored,
              const openvdb::Coord& origin,
              FloatTree& tree)
{
    const float* const values = bricks.values.data() + stored * VoxelBricks::kValues;
    bool rim = false;
    for (int k = 0; k < 3; ++k)
        rim |= origin[k] + kCells == bricks.bricks[static_cast<std::size_t>(k)] * kCells;
    if (!rim) return;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const float value = values[(z * kSide + y) * kSide + x];
                const bool beyond = x == kCells || y == kCells || z == kCells;
                if (beyond && value < static_cast<float>(bricks.band))
                    tree.setValueOn(origin.offsetBy(x, y, z), value);
            }
}

template <class Visitor>
void visit_bricks(const VoxelBricks& bricks, Visitor visit)
{
    std::size_t row = 0;
    for (int z = 0; z < bricks.bricks[2]; ++z)
        for (int y = 0; y < bricks.bricks[1]; ++y)
            for (int x = 0; x < bricks.bricks[0]; ++x, ++row)
                visit(row, openvdb::Coord(x * kCells, y * kCells, z * kCells));
}

FloatGrid::Ptr grid_of(const VoxelBricks& bricks, const FieldNotes& notes)
{
    const auto grid = FloatGrid::create(static_cast<float>(bricks.band));
    const auto stored_at = [&](std::size_t row) {
        return static_cast<std::size_t>(bricks.brick_of[row]);
    };
    visit_bricks(bricks, [&](std::size_t row, const openvdb::Coord& origin) {
        if (bricks.brick_of[row] >= 0) fill_leaf(bricks, stored_at(row), origin, grid->tree());
    });
    visit_bricks(bricks, [&](std::size_t row, const openvdb::Coord& origin) {
        if (bricks.brick_of[row] >= 0) fill_rim(bricks, stored_at(row), origin, grid->tree());
    });
    const auto transform = openvdb::math::Transform::createLinearTransform(bricks.voxel);
    transform->postTranslate({bricks.origin.x(), bricks.origin.y(), bricks.origin.z()});
    grid->setTransform(transform);
    grid->setName("distance");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setCreator("throng");
    grid->setSaveFloatAsHalf(false);

    using openvdb::Vec3d, openvdb::Vec3i;
    grid->insertMeta(kOurs, openvdb::Int32Metadata(kFormat));
    grid->insertMeta("throng_key", openvdb::StringMetadata(notes.key));
    grid->insertMeta("throng_error", openvdb::DoubleMetadata(notes.error));
    grid->insertMeta("throng_voxel", openvdb::DoubleMetadata(bricks.voxel));
    grid->insertMeta("throng_band", openvdb::DoubleMetadata(bricks.band));
    grid->insertMeta(
        "throng_origin",
        openvdb::Vec3DMetadata(Vec3d(bricks.origin.x(), bricks.origin.y(), bricks.origin.z())));
    grid->insertMeta(
        "throng_bricks",
        openvdb::Vec3IMetadata(Vec3i(bricks.bricks[0], bricks.bricks[1], bricks.bricks[2])));
    std::string warnings;
    for (const std::string& warning : notes.warnings) warnings += warning + "\n";
    grid->insertMeta("throng_remarks", openvdb::StringMetadata(warnings));
    return grid;
}

FieldNotes notes_of(const FloatGrid& grid)
{
    FieldNotes notes;
    notes.key = grid.metaValue<std::string>("throng_key");
    notes.error = grid.metaValue<double>("throng_error");
    const auto text = grid.metaValue<std::string>("throng_remarks");
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = text.find('\n', begin);
        notes.warnings.push_back(text.substr(begin, end - begin));
        if (end == std::string::npos) break;
        begin = end + 1;
    }
    return notes;
}

// --- Bricks from a tree

// What one leaf, or the one value in its place, gives a brick: at a corner beyond the first, the
// last layer of values alone. False where all of them are far outside.
bool copy_leaf(
    const FloatTree& tree, const openvdb::Coord& origin, int corner, float band, float* copied)
{
    const int ox = corner & 1, oy = corner >> 1 & 1, oz = corner >> 2;
    const openvdb::Coord base = origin.offsetBy(ox * kCells, oy * kCells, oz * kCells);
    const auto* const leaf = tree.probeConstLeaf(base);
    const float* const buffer = leaf != nullptr ? leaf->buffer().data() : nullptr;
    const float all = leaf != nullptr ? 0 : tree.getValue(base);
    bool near = false;
    for (int z = 0; z < (oz != 0 ? 1 : kCells); ++z)
        for (int y = 0; y < (oy != 0 ? 1 : kCells); ++y)
            for (int x = 0; x < (ox != 0 ? 1 : kCells); ++x) {
                const float value = buffer != nullptr ? buffer[(x * kCells + y) * kCells + z] : all;
                copied[((z + oz * kCells) * kSide + y + oy * kCells) * kSide + x + ox * kCells] =
                    std::min(value, band);
                near |= value < band;
            }
    return near;
}

// The values of a brick, leaf by leaf; false where all of them are far outside.
bool copy_brick(const FloatTree& tree, const openvdb::Coord& origin, float band, float* copied)
{
    bool near = false;
    for (int corner = 0; corner < 8; ++corner)
        near |= copy_leaf(tree, origin, corner, band, copied);
    return near;
}

void fill_from(const FloatTree& tree, const openvdb::Coord& first, VoxelBricks& bricks)
{
    const auto [nx, ny, nz] = bricks.bricks;
    const auto rows =
        static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz);
    bricks.brick_of.assign(rows, -1);
    std::array<float, VoxelBricks::kValues> copied;
    const auto band = static_cast<float>(bricks.band);
    visit_bricks(bricks, [&](std::size_t row, const openvdb::Coord& origin) {
        if (!copy_brick(tree, origin + first, band, copied.data())) return;
        bricks.brick_of[row] =
            static_cast<std::int32_t>(bricks.values.size() / VoxelBricks::kValues);
        bricks.values.insert(bricks.values.end(), copied.begin(), copied.end());
    });
}

// More than this many places for bricks would not fit in memory, nor in 32 bits.
constexpr double kMostBricks = 1 << 28;

bool can_be_laid(const openvdb::Vec3d& bricks)
{
    // Not at all, where a number is no number.
    return bricks.x() >= 1 && bricks.y() >= 1 && bricks.z() >= 1
        && bricks.x() * bricks.y() * bricks.z() <= kMostBricks;
}

VoxelBricks our_bricks(const FloatGrid& grid)
{
    VoxelBricks bricks;
    const auto origin = grid.metaValue<openvdb::Vec3d>("throng_origin");
    const auto count = grid.metaValue<openvdb::Vec3i>("throng_bricks");
    if (!can_be_laid(openvdb::Vec3d(count))) throw std::length_error("a wrong number of bricks");
    bricks.origin = {origin.x(), origin.y(), origin.z()};
    bricks.voxel = grid.metaValue<double>("throng_voxel");
    bricks.band = grid.metaValue<double>("throng_band");
    bricks.bricks = {count.x(), count.y(), count.z()};
    bricks.values.reserve((grid.tree().leafCount() + 1) * VoxelBricks::kValues);
    fill_from(grid.tree(), openvdb::Coord(0, 0, 0), bricks);
    return bricks;
}

// Where the surface is, of a grid of the given place.
MeshResult surface_of(const FloatGrid& grid)
{
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    // Not at 0 itself, which flat faces often have on the grid: quads of no area would come of it.
    openvdb::tools::volumeToMesh(grid, points, quads, 1e-3 * grid.voxelSize().x());
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    vertices.reserve(points.size());
    for (const openvdb::Vec3s& point : points)
        vertices.emplace_back(static_cast<double>(point.x()), static_cast<double>(point.y()),
                              static_cast<double>(point.z()));
    // Its faces run the other way round.
    for (const openvdb::Vec4I& quad : quads) {
        triangles.push_back({quad[0], quad[2], quad[1]});
        triangles.push_back({quad[0], quad[3], quad[2]});
    }
    MeshResult made = build_mesh(vertices, std::move(triangles));
    if (made.trouble.empty()) find_vertex_normals(made.mesh);
    return made;
}

// Whether the values about a place differ by more than distances do: there the level set ends, and
// not the shape.
bool is_cut(const openvdb::tree::ValueAccessor<const FloatTree, false>& values,
            const openvdb::Vec3d& place,
            double voxel)
{
    const openvdb::Coord cell = openvdb::Coord::floor(place);
    float least = values.getValue(cell), most = least;
    for (int corner = 1; corner < 8; ++corner) {
        const float value =
            values.getValue(cell.offsetBy(corner & 1, corner >> 1 & 1, corner >> 2));
        least = std::min(least, value);
        most = std::max(most, value);
    }
    // Along a cell's diagonal they differ by 1.8 voxels.
    return static_cast<double>(most - least) > 3 * voxel;
}

// The surface without what only closes it where the level set ends; all of it where that is all.
Mesh true_surface(const FloatGrid& grid, const Mesh& surface)
{
    const openvdb::tree::ValueAccessor<const FloatTree, false> values(grid.tree());
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (const auto& [a, b, c] : surface.triangles) {
        const Vec3 middle = (surface.vertices[a] + surface.vertices[b] + surface.vertices[c]) / 3;
        const openvdb::Vec3d place =
            grid.worldToIndex(openvdb::Vec3d(middle.x(), middle.y(), middle.z()));
        if (!is_cut(values, place, grid.voxelSize().x())) kept.push_back({a, b, c});
    }
    if (kept.empty() || kept.size() == surface.triangles.size()) return surface;
    MeshResult made = build_mesh(surface.vertices, std::move(kept));
    if (!made.trouble.empty()) return surface;
    return std::move(made.mesh);
}

// One layer of values far outside, all round those that say anything: what is inside goes no
// further.
void wall_in(const FloatGrid& grid,
             const openvdb::Coord& first,
             const VoxelBricks& laid,
             std::vector<FieldSeed>& seeds)
{
    openvdb::CoordBBox said, one;
    for (auto value = grid.tree().cbeginValueAll(); value; ++value)
        if (value.isValueOn() || *value < 0) {
            value.getBoundingBox(one);
            said.expand(one);
        }
    said.translate(-first);
    said.expand(1);
    openvdb::CoordBBox all({0, 0, 0}, {0, 0, 0});
    for (int k = 0; k < 3; ++k) all.max()[k] = laid.bricks[static_cast<std::size_t>(k)] * kCells;
    const openvdb::CoordBBox held(openvdb::Coord::maxComponent(said.min(), all.min()),
                                  openvdb::Coord::minComponent(said.max(), all.max()));
    for (int z = held.min()[2]; z <= held.max()[2]; ++z)
        for (int y = held.min()[1]; y <= held.max()[1]; ++y)
            for (int x = held.min()[0]; x <= held.max()[0]; ++x) {
                const openvdb::Coord at(x, y, z);
                bool wall = false;
                for (int k = 0; k < 3; ++k)
                    wall |= at[k] == said.min()[k] || at[k] == said.max()[k];
                if (wall) seeds.push_back({{x, y, z}, grid.background()});
            }
}

// The level set of another tool's: its values, and the depth below those that it has. Where they
// end and its surface does not, it is cut off upright.
VoxelBricks other_bricks(const FloatGrid& grid, const Mesh& surface)
{
    openvdb::CoordBBox box;
    grid.tree().evalLeafBoundingBox(box);
    VoxelBricks bricks;
    bricks.voxel = grid.voxelSize().x();
    bricks.band = static_cast<double>(grid.background());
    const openvdb::Coord first = box.min();
    const openvdb::Vec3d origin = grid.indexToWorld(first);
    bricks.origin = {origin.x(), origin.y(), origin.z()};
    for (int k = 0; k < 3; ++k)
        bricks.bricks[static_cast<std::size_t>(k)] = (box.max()[k] - first[k] + kCells) / kCells;

    std::vector<FieldSeed> seeds;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
        for (auto value = leaf->cbeginValueOn(); value; ++value) {
            const openvdb::Coord at = value.getCoord() - first;
            if (*value < grid.background()) seeds.push_back({{at[0], at[1], at[2]}, *value});
        }
    const Mesh known = true_surface(grid, surface);
    if (known.triangles.size() < surface.triangles.size()) wall_in(grid, first, bricks, seeds);
    return fill_bricks(known, bricks, seeds, SeedRule::value);
}

std::string trouble_with_grid(const FloatGrid& grid)
{
    const auto map = grid.transform().baseMap();
    const openvdb::Mat4R matrix = map->getAffineMap()->getMat4();
    const double h = grid.voxelSize().x();
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(matrix(i, k) - (i == k ? h : 0)) <= 1e-6 * h))
                return "has voxels that are not cubes along the axes; wanted one voxel size, "
                       "not turned";
    if (!(grid.background() > 0 && std::isfinite(grid.background())))
        return "has no background above 0; wanted the band's distance";
    if (grid.tree().leafCount() == 0) return "is empty; wanted values near a surface";
    openvdb::CoordBBox box;
    grid.tree().evalLeafBoundingBox(box);
    // In double: the box may be as wide as integers go.
    const openvdb::Vec3d sides = box.max().asVec3d() - box.min().asVec3d() + openvdb::Vec3d(1);
    if (!can_be_laid(sides / kCells + openvdb::Vec3d(1)))
        return "has values too far apart; wanted those of one shape";
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
        for (openvdb::Index i = 0; i < FloatTree::LeafNodeType::SIZE; ++i)
            if (!std::isfinite(leaf->getValue(i)))
                return "holds values that are no numbers; wanted distances";
    return {};
}

// The first float grid that is a level set.
FloatGrid::Ptr level_set_in(const openvdb::GridPtrVec& grids)
{
    for (const openvdb::GridBase::Ptr& grid : grids)
        if (auto found = openvdb::gridPtrCast<FloatGrid>(grid);
            found && found->getGridClass() == openvdb::GRID_LEVEL_SET)
            return found;
    return nullptr;
}

FloatGrid::Ptr level_set_in(openvdb::io::File& file)
{
    for (auto name = file.beginName(); name != file.endName(); ++name) {
        const auto grid = openvdb::gridPtrCast<FloatGrid>(file.readGridMetadata(name.gridName()));
        if (grid && grid->getGridClass() == openvdb::GRID_LEVEL_SET)
            return openvdb::gridPtrCast<FloatGrid>(file.readGrid(name.gridName()));
    }
    return nullptr;
}

VdbFile from_grid(const FloatGrid& grid, VdbWants wants)
{
    VdbFile result;
    const bool ours = grid[kOurs] && grid.metaValue<std::int32_t>(kOurs) == kFormat;
    result.trouble = trouble_with_grid(grid);
    if (!result.trouble.empty()) return result;
    if (ours) {
        result.notes = notes_of(grid);
        result.bricks = our_bricks(grid);
        if (wants == VdbWants::bricks) return result;
    }
    MeshResult surface = surface_of(grid);
    if (!surface.trouble.empty()) {
        result.trouble = "has no surface; wanted values of both signs";
        return result;
    }
    if (!ours) result.bricks = other_bricks(grid, surface.mesh);
    if (wants == VdbWants::bricks_and_surface) result.surface = std::move(surface.mesh);
    return result;
}

// What a file holds, by a function that gives its level set or throws.
template <class Read>
VdbFile read_grid(VdbWants wants, Read read)
{
    VdbFile result;
    try {
        const FloatGrid::Ptr grid = read();
        if (grid != nullptr) return from_grid(*grid, wants);
        result.trouble = "holds no float level-set grid; wanted one";
    } catch (const std::exception& error) {
        result.trouble = std::string("is no .vdb file that can be read (") + error.what()
            + "); wanted one with a float level set";
    }
    return result;
}

}  // namespace

MeshResult surface(const VoxelBricks& bricks) { return surface_of(*grid_of(bricks, {})); }

std::string
write(const std::filesystem::path& path, const VoxelBricks& bricks, const FieldNotes& notes)
{
    try {
        openvdb::io::File file(path.string());
        // Plain numbers: a few megabytes, read as fast as they are copied.
        file.setCompression(openvdb::io::COMPRESS_NONE);
        file.write({grid_of(bricks, notes)});
        file.close();
    } catch (const std::exception& error) {
        return path.string() + ": cannot be written: " + error.what();
    }
    return {};
}

VdbFile read(const std::filesystem::path& path, VdbWants wants)
{
    VdbFile result;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) {
        result.trouble =
            path.string() + ": there is no such file; wanted a .vdb file with a float level set";
        return result;
    }
    result = read_grid(wants, [&] {
        openvdb::io::File file(path.string());
        file.open(false);
        return level_set_in(file);
    });
    if (!result.trouble.empty()) result.trouble = path.string() + ": " + result.trouble;
    return result;
}

VdbFile read_bytes(std::string bytes, VdbWants wants)
{
    std::istringstream stream(std::move(bytes));
    return read_grid(wants, [&] {
        // What ends too soon must not go unseen: OpenVDB would go by counts that it never read.
        stream.exceptions(std::ios::eofbit | std::ios::failbit | std::ios::badbit);
        // Now, and not when a value is first asked for: the bytes are gone then.
        openvdb::io::Stream file(stream, false);
        return level_set_in(*file.getGrids());
    });
}

}  // namespace throng::vdb
