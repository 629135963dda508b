// Terrain: hills made of triangles, and bodies of every kind dropped on them.
#include "kernels/check.hpp"
#include "scene/catalog/noisy_balls.hpp"
#include "scene/catalog/parts.hpp"
#include "scene/catalog/recipes.hpp"
#include "scene/catalog/swept_meshes.hpp"
#include "scene/shapes/level_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace throng {

namespace {

// A number in [0, 1) for each corner of a lattice. Integers only, so that no machine rounds.
//
// Each multiplication by an odd number carries low bits up, each shift brings high bits down; the
// numbers are those of MurmurHash3's finish (Appleby, 2011).
double corner_height(std::uint32_t column, std::uint32_t row, std::uint64_t seed)
{
    std::uint64_t word = (std::uint64_t{row} << 32 | column) + seed * 0x9e3779b97f4a7c15u;
    for (const std::uint64_t odd : {0xff51afd7ed558ccdu, 0xc4ceb9fe1a85ec53u})
        word = (word ^ (word >> 33)) * odd;
    return static_cast<double>((word ^ (word >> 33)) >> 40) * 0x1p-24;
}

// Smoothly between the corners of a lattice of `period` cells, 0 to 1, without creases.
double hills(int column, int row, int period, std::uint64_t seed)
{
    const auto eased = [](double t) { return t * t * (3 - 2 * t); };
    const auto corner = [&](int i, int j) {
        return corner_height(static_cast<std::uint32_t>(column / period + i),
                             static_cast<std::uint32_t>(row / period + j), seed);
    };
    const double u = eased(static_cast<double>(column % period) / period);
    const double v = eased(static_cast<double>(row % period) / period);
    return (corner(0, 0) * (1 - u) + corner(1, 0) * u) * (1 - v)
        + (corner(0, 1) * (1 - u) + corner(1, 1) * u) * v;
}

// How high the hills may be; 2 m over 16 m, with 0.4 m over 4 m on top.
constexpr double kHighest = 2.4;

// A square of cells of 1 m about the origin. Beyond `inner` m from the middle it rises like a bowl,
// so that nothing rolls off.
TriangleSoup hill_mesh(int cells, double inner, std::uint64_t seed)
{
    TriangleSoup mesh;
    const int corners = cells + 1;
    for (int row = 0; row < corners; ++row)
        for (int column = 0; column < corners; ++column) {
            const double x = column - cells / 2.0, y = row - cells / 2.0;
            const double beyond = std::max({std::abs(x) - inner, std::abs(y) - inner, 0.0});
            const double z = 2.0 * hills(column, row, 16, 2 * seed)
                + 0.4 * hills(column, row, 4, 2 * seed + 1) + beyond;
            mesh.vertices.emplace_back(x, y, z);
        }
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const auto a = static_cast<std::uint32_t>(row * corners + column);
            const auto above = a + static_cast<std::uint32_t>(corners);
            // Diagonals alternate, so that ridges of triangles run both ways.
            if ((row + column) % 2 == 0) {
                mesh.triangles.push_back({a, a + 1, above + 1});
                mesh.triangles.push_back({a, above + 1, above});
            } else {
                mesh.triangles.push_back({a, a + 1, above});
                mesh.triangles.push_back({a + 1, above + 1, above});
            }
        }
    return mesh;
}

// Hills with a flat bottom 2 m below the lowest place and upright sides, closed all round: the
// bottom is the hills' own lattice once more, seen from the other side.
TriangleSoup hill_block(int cells, double inner, std::uint64_t seed)
{
    const double bottom = -2;
    TriangleSoup mesh = hill_mesh(cells, inner, seed);
    const auto corners = static_cast<std::uint32_t>(cells + 1);
    const auto below = static_cast<std::uint32_t>(mesh.vertices.size());
    const std::size_t upper = mesh.triangles.size();
    for (std::uint32_t i = 0; i < below; ++i) {
        const Vec3 above = mesh.vertices[i];
        mesh.vertices.emplace_back(above.x(), above.y(), bottom);
    }
    for (std::size_t t = 0; t < upper; ++t) {
        const auto [a, b, c] = mesh.triangles[t];
        mesh.triangles.push_back({below + a, below + c, below + b});
    }
    // Once round the rim, counter-clockwise seen from above.
    std::vector<std::uint32_t> rim;
    const std::uint32_t last = corners - 1;
    for (std::uint32_t i = 0; i < last; ++i) rim.push_back(i);
    for (std::uint32_t i = 0; i < last; ++i) rim.push_back(i * corners + last);
    for (std::uint32_t i = last; i > 0; --i) rim.push_back(last * corners + i);
    for (std::uint32_t i = last; i > 0; --i) rim.push_back(i * corners);
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const std::uint32_t a = rim[i], b = rim[(i + 1) % rim.size()];
        mesh.triangles.push_back({below + a, below + b, b});
        mesh.triangles.push_back({below + a, b, a});
    }
    return mesh;
}

// The kinds that are dropped, in the order of their ids.
enum class Kind { sphere, capsule, cylinder, box, hull, compound };
constexpr int kKinds = 6;
constexpr int kStones = 4;  // hulls come in so many forms

// Sizes of a body of that kind, such that it fits in a ball of 0.7 m.
Vec3 random_size(Kind kind, Random& random)
{
    if (kind == Kind::box) return random_vector(random, 0.2, 0.4);
    const double radius = random.uniform(0.2, 0.35);
    if (kind == Kind::sphere) return {radius, 0, 0};
    return {radius, random.uniform(0.1, 0.35), 0};
}

template <class Shape>
void add_terrain(Scene& scene, Shape hills)
{
    BodyDescription ground;
    ground.name = "terrain";
    ground.shape = add_shape(scene, "terrain", std::move(hills));
    ground.material = 0;
    ground.motion = Motion::static_;
    scene.bodies.push_back(std::move(ground));
}

// m, no stone reaches further from its middle.
constexpr double kReachOfStone = 0.6;

// How wide hills must be for so many bodies to be dropped on them, and from where those drop.
struct Ground {
    explicit Ground(int size)
    {
        const double spacing = 1.45;
        const int side = heap_layout(size).side;
        inner = side * spacing / 2 + 5;
        cells = 2 * static_cast<int>(std::ceil(inner + 5));
        grid = {side, spacing, kHighest + 1};
    }

    double inner = 0;
    int cells = 0;
    Grid grid;
};

// A corner piece: a plate with a post on its end.
std::uint32_t add_corner_piece(Scene& scene)
{
    const std::uint32_t plate = add_shape(scene, "plate", BoxShape{{0.4, 0.25, 0.1}});
    const std::uint32_t post = add_shape(scene, "post", BoxShape{{0.1, 0.25, 0.3}});
    CompoundShape corner;
    corner.parts.push_back({plate, {{0, 0, -0.2}, Quat::Identity()}});
    corner.parts.push_back({post, {{-0.3, 0, 0.2}, Quat::Identity()}});
    return add_shape(scene, "corner piece", std::move(corner));
}

}  // namespace

// Spheres, capsules, cylinders, boxes, stones and corner pieces, dropped on hills of triangles.
// Stresses contact with meshes, above all the edges inside a surface, at which a body that slides
// or rolls must not trip; and every pair of shapes there is.
//
// Bodies are grouped by kind, so ids run kind by kind, while neighbors in space differ in kind.
Scene make_meshes(int size, std::uint64_t seed)
{
    Scene scene = begin_scene("meshes", size);
    Random random(seed);
    const Ground ground(size);
    add_terrain(scene, mesh_shape(hill_mesh(ground.cells, ground.inner, seed)));

    std::array<std::uint32_t, kKinds> shapes = {
        add_shape(scene, "sphere", SphereShape{0.5}),
        add_shape(scene, "capsule", CapsuleShape{0.25, 0.25}),
        add_shape(scene, "cylinder", CylinderShape{0.25, 0.25}),
        add_shape(scene, "box", BoxShape{Vec3::Constant(0.25)}),
        0,
        add_corner_piece(scene)};

    // Body i of the grid is of kind i mod 6; hulls take turns among their forms as well.
    const auto drop = [&](Kind kind, std::uint32_t shape, int first, int stride) {
        if (first >= size) return;
        const bool own_sizes = kind != Kind::hull && kind != Kind::compound;
        const auto count = static_cast<std::size_t>((size - first + stride - 1) / stride);
        Instances& group = add_instances(scene, shape, count, own_sizes);
        for (int i = first; i < size; i += stride) {
            const Vec3 position = ground.grid.place(i, random);
            const Vec3 velocity = random_drift(random);
            const Quat orientation = random_turn(random, std::numbers::pi);
            if (own_sizes)
                add_record(group, {position, orientation}, velocity, Vec3::Zero(),
                           random_size(kind, random));
            else
                add_record(group, {position, orientation}, velocity);
        }
    };
    for (int k = 0; k < kKinds; ++k) {
        const Kind kind = static_cast<Kind>(k);
        if (kind != Kind::hull) {
            drop(kind, shapes[static_cast<std::size_t>(k)], k, kKinds);
            continue;
        }
        for (int form = 0; form < kStones; ++form) {
            const std::uint32_t stone =
                add_shape(scene, "stone " + std::to_string(form), HullShape{random_stone(random)});
            drop(kind, stone, k + form * kKinds, kStones * kKinds);
        }
    }
    return scene;
}

// Balls, boxes, stones, capsules and cylinders dropped on wide fine hills, a hundred triangles for
// each and a layer of them: a landscape that is far larger than all who are on it together.
Scene make_hills(int size, std::uint64_t seed)
{
    constexpr double kCell = 0.5;  // m
    Scene scene = begin_scene("hills", size);
    Random random(seed);
    const int rim = 8;  // cells
    const int cells = 2 * (rim + static_cast<int>(std::ceil(std::sqrt(50.0 * size) / 2)));
    TriangleSoup ground = hill_mesh(cells, cells / 2.0 - rim, seed);
    for (Vec3& vertex : ground.vertices) vertex *= kCell;
    add_terrain(scene, mesh_shape(std::move(ground)));

    std::vector<ShapeDescription> kinds;
    kinds.push_back({"ball", SphereShape{0.3}});
    kinds.push_back({"box", BoxShape{{0.35, 0.25, 0.2}}});
    kinds.push_back({"stone", HullShape{random_stone(random)}});
    kinds.push_back({"capsule", CapsuleShape{0.2, 0.3}});
    kinds.push_back({"cylinder", CylinderShape{0.25, 0.25}});
    const int side = static_cast<int>(std::ceil(std::sqrt(size)));
    const double width = (cells - 2 * rim) * kCell;
    drop_in_turn(scene, std::move(kinds), size,
                 {side, width / side, kHighest * kCell + kReachOfStone}, random);
    return scene;
}

namespace {

// A quarter of the hills' cells tells all that they are. The band holds the balls that are dropped.
// Where the ground is too wide for that, coarser, so that it is made in a second.
VoxelsShape voxels_of(const TriangleSoup& hills, int cells)
{
    const double voxel = std::max(0.25, cells / 128.0);
    LevelSetResult made = make_level_set(hills.vertices, hills.triangles, voxel, 4 * voxel);
    THRONG_CHECK(made.trouble.empty(), "hills have an inside");
    return {{}, std::move(made.level_set)};
}

// Balls, boxes and stones in turn with solids, on hills that are solid themselves.
Scene drop_on_hills(int size, std::uint64_t seed, std::vector<ShapeDescription> solids)
{
    Scene scene = begin_scene("terrain", size);
    Random random(seed);
    const Ground ground(size);
    add_terrain(scene, voxels_of(hill_block(ground.cells, ground.inner, seed), ground.cells));

    std::vector<ShapeDescription> kinds;
    kinds.push_back({"ball", SphereShape{0.4}});
    kinds.push_back({"box", BoxShape{{0.4, 0.3, 0.25}}});
    kinds.push_back({"stone", HullShape{random_stone(random)}});
    for (ShapeDescription& solid : solids) kinds.push_back(std::move(solid));
    drop_in_turn(scene, std::move(kinds), size, ground.grid, random);
    return scene;
}

// How far a solid reaches from its middle, m.
constexpr double kReach = 0.6;

}  // namespace

// Balls, boxes, stones, tori, lumps and knots, dropped on a block of hills made of voxels: solids
// against a ground that is large, solid and everywhere curved.
Scene make_terrain(int size, std::uint64_t seed)
{
    return drop_on_hills(
        size, seed,
        {{"torus", mesh_shape(fitted(torus_mesh(0.4, 0.15, 32, 16), kReach))},
         {"lump", mesh_shape(fitted(noisy_ball(1, 0.5, 1280, seed), kReach))},
         {"knot",
          mesh_shape(fitted(tube_mesh(torus_knot({2, 3, 1, 0.45}, 72), 0.28, 12), kReach))}});
}

Scene make_terrain_of(int size, std::uint64_t seed, const TriangleSoup& mesh)
{
    return drop_on_hills(size, seed, {{"solid", mesh_shape(fitted(mesh, kReach))}});
}

}  // namespace throng
