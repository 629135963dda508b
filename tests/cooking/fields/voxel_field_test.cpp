// Voxel field: against distances asked for one by one, the truth of balls and tori, and its files.
#include "cooking/fields/voxel_field.hpp"

#include "cooking/fields/field_values.hpp"
#include "cooking/repair/build_mesh.hpp"
#include "kernels/geometry/mass.hpp"
#include "kernels/geometry/mesh.hpp"
#include "kernels/geometry/voxel_bricks.hpp"
#include "kernels/parallel/blocks.hpp"
#include "scene/catalog/random.hpp"
#include "tests/support/closed.hpp"
#include "tests/support/dice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>

namespace throng {
namespace {

FieldResult field_of(const Mesh& mesh, double voxel, FieldSign sign = FieldSign::normals)
{
    FieldSettings settings;
    settings.voxel = voxel;
    settings.sign = sign;
    return build_field(mesh, settings);
}

// Not on the grid's planes: a part that is no round share of a voxel.
TriangleSoup tilted_box()
{
    TriangleSoup soup = box_mesh({0.5, 0.4, 0.3});
    const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
    for (Vec3& vertex : soup.vertices) vertex = turn * vertex + Vec3(3.1, -2.2, 0.7);
    return soup;
}

void expect_baked(const char* name, const Mesh& mesh, double voxel)
{
    const FieldResult field = field_of(mesh, voxel);
    ASSERT_EQ(field.trouble, "") << name;
    const VoxelBricks baked =
        bake_bricks(box_of(mesh), voxel, kBandVoxels * voxel,
                    [&](const Vec3& at) { return signed_distance(mesh, at); });
    EXPECT_EQ(field.bricks.origin, baked.origin) << name;
    EXPECT_EQ(field.bricks.bricks, baked.bricks) << name;
    EXPECT_EQ(field.bricks.brick_of, baked.brick_of) << name;
    ASSERT_EQ(field.bricks.values.size(), baked.values.size()) << name;
    // Deeper than is searched, the neighbors' triangles may miss the nearest by a little.
    const auto searched = static_cast<float>(-kSearchedVoxels * voxel);
    std::size_t off = 0, shallower = 0;
    for (std::size_t i = 0; i < baked.values.size(); ++i) {
        const float value = field.bricks.values[i], truth = baked.values[i];
        off += truth >= searched && value != truth ? 1 : 0;
        shallower += value > truth || value < truth - static_cast<float>(0.25 * voxel) ? 1 : 0;
    }
    EXPECT_EQ(off, 0u) << name;
    EXPECT_EQ(shallower, 0u) << name;
}

TEST(VoxelField, HoldsTheVeryBitsOfDistancesAskedForOneByOne)
{
    expect_baked("ball", closed(ball_mesh(1, 24, 12)), 0.11);
    expect_baked("torus", closed(torus_mesh(1, 0.3, 24, 12)), 0.09);
    expect_baked("box on the grid", closed(box_mesh({0.5, 0.4, 0.3})), 0.05);
    expect_baked("box", closed(tilted_box()), 0.043);
    expect_baked("two",
                 closed(both(ball_mesh(0.5, 12, 8), moved(ball_mesh(0.4, 12, 8), {1, 0.3, 0}))),
                 0.07);
}

TEST(VoxelField, LeavesHollowsEmpty)
{
    const Mesh mesh = closed(both(box_mesh({1, 1, 1}), turned_inward(box_mesh({0.6, 0.6, 0.6}))));
    expect_baked("hollow box", mesh, 0.1);
    const VoxelBricks bricks = field_of(mesh, 0.1).bricks;
    EXPECT_GT(sample_bricks<double>(bricks, {0, 0, 0}).distance, 0);
    EXPECT_NEAR(sample_bricks<double>(bricks, {0.8, 0, 0}).distance, -0.2, 0.01);
}

TEST(VoxelField, HasTheSameBitsForEveryNumberOfWorkers)
{
    // By normals, and by flood where triangles cut each other.
    const Mesh sound = closed(torus_mesh(1, 0.3, 30, 16));
    const Mesh cut =
        closed(both(ball_mesh(1, 20, 12), moved(ball_mesh(0.7, 18, 11), {0.9, 0.1, 0})));
    for (const FieldSign sign : {FieldSign::normals, FieldSign::flood}) {
        const Mesh& mesh = sign == FieldSign::normals ? sound : cut;
        VoxelBricks first;
        for (const int workers : {1, 2, 5}) {
            ThreadPool pool(workers);
            FieldResult field;
            pool.run(
                [&](std::size_t, std::size_t, std::size_t) { field = field_of(mesh, 0.09, sign); });
            ASSERT_EQ(field.trouble, "");
            if (first.empty()) first = field.bricks;
            EXPECT_EQ(field.bricks.brick_of, first.brick_of) << workers;
            EXPECT_EQ(field.bricks.values, first.values) << workers;
        }
    }
}

// Root mean square of how far the field is off about a surface, in m.
double rms_error(const VoxelBricks& bricks, const std::function<double(const Vec3&)>& truth)
{
    Random random(5);
    const double h = bricks.voxel;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < 200000 && count < 4000; ++i) {
        const Vec3 at(random.uniform(-1.3, 1.3), random.uniform(-1.3, 1.3),
                      random.uniform(-1.3, 1.3));
        if (std::abs(truth(at)) > h) continue;
        const double off = sample_bricks<double>(bricks, at).distance - truth(at);
        sum += off * off;
        ++count;
    }
    return std::sqrt(sum / count);
}

double fitted_slope(const std::vector<double>& x, const std::vector<double>& y)
{
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const auto n = static_cast<double>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double lx = std::log(x[i]), ly = std::log(y[i]);
        sx += lx;
        sy += ly;
        sxx += lx * lx;
        sxy += lx * ly;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(VoxelField, DepthIsOfSecondOrderInTheVoxelOnSmoothSurfaces)
{
    // Triangles fine enough that what they miss of the smooth shape is less than the grid does.
    const Mesh ball = closed(ball_mesh(1, 120, 60)), torus = closed(torus_mesh(1, 0.3, 160, 70));
    const auto to_ball = [](const Vec3& at) { return at.norm() - 1; };
    const auto to_torus = [](const Vec3& at) {
        return std::hypot(std::hypot(at.x(), at.y()) - 1, at.z()) - 0.3;
    };
    const std::vector<double> voxels{0.2, 0.14, 0.1};
    std::vector<double> ball_errors, torus_errors;
    for (const double h : voxels) {
        ball_errors.push_back(rms_error(field_of(ball, h).bricks, to_ball));
        torus_errors.push_back(rms_error(field_of(torus, h * 0.7).bricks, to_torus));
        // h^2 / 8 times the sum of the curvatures, a voxel inside, and what the triangles miss.
        EXPECT_LT(ball_errors.back(), h * h / 4 / (1 - h) + 4e-4);
    }
    EXPECT_NEAR(fitted_slope(voxels, ball_errors), 2, 0.3);
    EXPECT_NEAR(fitted_slope(voxels, torus_errors), 2, 0.3);
}

TEST(VoxelField, DepthIsNeverFurtherOffThanHalfTheDiagonalOfACell)
{
    const Mesh mesh = closed(tilted_box());
    const double h = 0.05;
    const FieldResult field = field_of(mesh, h);
    EXPECT_LE(field.error, kWorstVoxels * h);
    EXPECT_GT(field.error, 0.05 * h);  // edges are seen
    Random random(3);
    for (int i = 0; i < 5000; ++i) {
        const Box3 box = box_of(mesh);
        const Vec3 at(random.uniform(box.lower.x(), box.upper.x()),
                      random.uniform(box.lower.y(), box.upper.y()),
                      random.uniform(box.lower.z(), box.upper.z()));
        const double truth = signed_distance(mesh, at);
        if (truth > (kBandVoxels - 2) * h) continue;
        EXPECT_NEAR(sample_bricks<double>(field.bricks, at).distance, truth,
                    kWorstVoxels * h + 1e-6);
    }
}

TEST(VoxelField, TellsTheVolumeByCounting)
{
    // A mean over several places of the grid, of second order: within a hundredth at 20 across.
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 by(0.013 * i, 0.029 * i, -0.017 * i);
        const Mesh mesh = closed(moved(ball_mesh(1, 40, 20), by));
        VoxelBricks bricks = field_of(mesh, 0.1).bricks;
        std::size_t inside = 0;
        // Of each brick the values that no other shares.
        for (std::size_t brick = 0; brick < bricks.values.size() / VoxelBricks::kValues; ++brick)
            for (std::size_t z = 0; z < 8; ++z)
                for (std::size_t y = 0; y < 8; ++y)
                    for (std::size_t x = 0; x < 8; ++x)
                        inside +=
                            bricks.values[brick * VoxelBricks::kValues + (z * 9 + y) * 9 + x] < 0;
        sum += static_cast<double>(inside) * 1e-3 / 8;
    }
    const double exact = 4 * std::numbers::pi / 3;
    EXPECT_NEAR(sum, exact, 0.02 * exact);
}

TEST(VoxelField, FloodTakesWhatCutsItselfForOneSolid)
{
    const Mesh mesh = closed(both(ball_mesh(1, 30, 20), moved(ball_mesh(1, 30, 20), {0.8, 0, 0})));
    const FieldResult field = field_of(mesh, 0.08, FieldSign::flood);
    ASSERT_EQ(field.trouble, "");
    // On a wall that the other ball buries, and outside of both.
    EXPECT_LT(sample_bricks<double>(field.bricks, {0.99, 0, 0}).distance, -0.4);
    EXPECT_LT(sample_bricks<double>(field.bricks, {-0.9, 0, 0}).distance, 0);
    EXPECT_GT(sample_bricks<double>(field.bricks, {0.4, 1.05, 0}).distance, 0);
}

TEST(VoxelField, FloodClosesHolesUpToAVoxelAndRefusesWiderOnes)
{
    TriangleSoup soup = ball_mesh(1, 60, 40);
    soup.triangles.erase(soup.triangles.begin() + 1200);
    MeshResult open = build_mesh(soup.vertices, soup.triangles);
    find_vertex_normals(open.mesh);
    const FieldResult field = field_of(open.mesh, 0.2, FieldSign::flood);
    ASSERT_EQ(field.trouble, "");
    EXPECT_LT(sample_bricks<double>(field.bricks, {0, 0, 0}).distance, -0.9);

    TriangleSoup half = ball_mesh(1, 60, 40);
    half.triangles.resize(half.triangles.size() / 2);
    MeshResult bowl = build_mesh(half.vertices, half.triangles);
    find_vertex_normals(bowl.mesh);
    const std::string trouble = field_of(bowl.mesh, 0.05, FieldSign::flood).trouble;
    EXPECT_NE(trouble.find("open wider than"), std::string::npos) << trouble;
}

// Of a bowl the distance is known: to its sphere above the rim's cone, to the rim elsewhere.
TEST(VoxelField, SheetIsAVoxelThickToEitherSide)
{
    constexpr double kVoxel = 0.05;
    TriangleSoup bowl = ball_mesh(1, 120, 80);
    std::erase_if(bowl.triangles, [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(),
                           [&](std::uint32_t corner) { return bowl.vertices[corner].z() > 1e-9; });
    });
    MeshResult open = build_mesh(bowl.vertices, bowl.triangles);
    find_vertex_normals(open.mesh);
    const FieldResult field = field_of(open.mesh, kVoxel, FieldSign::sheet);
    ASSERT_EQ(field.trouble, "");
    EXPECT_FALSE(field.hollow);
    EXPECT_NEAR(field.bricks.band, kBandVoxels * kVoxel, 1e-12);
    EXPECT_NEAR(field.error, kVoxel, 0.1 * kVoxel);
    const double known = field.bricks.band - std::sqrt(3) * kVoxel;  // by all corners of a cell
    test::Dice dice(41);
    int inside = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 at = dice.point(1.2);
        const double across = std::hypot(at.x(), at.y());
        const double to_sheet =
            at.z() <= 0 ? std::abs(at.norm() - 1) : std::hypot(across - 1, at.z());
        const double truth = std::min(to_sheet - kVoxel, known);
        // A cell with corners on both sides of the sheet does not see where it is least.
        const double error = to_sheet < 2 * kVoxel ? 0.9 * kVoxel : 0.1 * kVoxel;
        const double told = sample_bricks<double>(field.bricks, at).distance;
        ASSERT_NEAR(std::min(told, known), truth, error) << at.transpose();
        inside += told < 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 200);
    const MeshResult surface = field_surface(field.bricks);
    ASSERT_EQ(surface.trouble, "");
    // Of a half shell of two voxels, its rim rounded.
    EXPECT_NEAR(mass_of(surface.mesh).volume / (2 * std::numbers::pi * 2 * kVoxel), 1, 0.06);
}

TEST(VoxelField, FloodAsksNoWindingWhatIsThick)
{
    const FieldResult field =
        field_of(closed(turned_inward(box_mesh({0.5, 0.5, 0.5}))), 0.06, FieldSign::flood);
    EXPECT_EQ(field.trouble, "");
    EXPECT_TRUE(field.warnings.empty());
}

TEST(VoxelField, RefusesWhatNeedsMoreThanIsGranted)
{
    const Mesh mesh = closed(box_mesh({1, 1, 1}));
    FieldSettings settings;
    settings.voxel = 1e-4;
    settings.most_bytes = 5e7;
    const std::string trouble = build_field(mesh, settings).trouble;
    EXPECT_NE(trouble.find("at voxel size 0.0001 m, more than the limit of 47.7 MB"),
              std::string::npos)
        << trouble;
    const std::string wanted = "give voxel_size at least ";
    const std::size_t at = trouble.find(wanted);
    ASSERT_NE(at, std::string::npos) << trouble;
    settings.voxel = std::stod(trouble.substr(at + wanted.size()));
    EXPECT_EQ(build_field(mesh, settings).trouble, "");
    EXPECT_LT(settings.voxel, 0.04);  // and not much more than needed
    for (const double bad : {-1.0, std::nan("")}) {
        settings.voxel = bad;
        EXPECT_NE(build_field(mesh, settings).trouble.find("voxel_size is"), std::string::npos);
    }
}

TEST(VoxelField, EstimatesWhatItTakesAndNeverTooLittle)
{
    for (const double h : {0.1, 0.05, 0.03}) {
        const Mesh mesh = closed(torus_mesh(1, 0.3, 40, 20));
        const VoxelBricks bricks = field_of(mesh, h).bricks;
        const auto stored = static_cast<double>(4 * bricks.values.size());
        EXPECT_GT(field_bytes(mesh, h), 2 * stored);
        EXPECT_LT(field_bytes(mesh, h), 20 * stored);
    }
}

TEST(VoxelField, SaysWhereAMeshIsThinnerThanAVoxel)
{
    const Mesh fin =
        closed(both(box_mesh({0.5, 0.5, 0.5}), moved(box_mesh({0.5, 0.5, 0.01}), {0, 0, 2})));
    const FieldResult field = field_of(fin, 0.06);
    ASSERT_EQ(field.trouble, "");
    ASSERT_EQ(field.warnings.size(), 1u);
    EXPECT_EQ(field.warnings[0].find("thinner than a voxel somewhere: 25"), 0u)
        << field.warnings[0];
    EXPECT_TRUE(field_of(closed(box_mesh({0.5, 0.5, 0.5})), 0.06).warnings.empty());
    // A sheet between two layers of values is not there at all.
    EXPECT_NE(
        field_of(closed(box_mesh({0.5, 0.5, 0.01})), 0.0433).trouble.find("nothing is inside"),
        std::string::npos);
}

TEST(VoxelField, IsReadBackAsItWasWritten)
{
    const auto path = std::filesystem::path(testing::TempDir()) / "voxel_field_test.vdb";
    const Mesh mesh = closed(torus_mesh(1, 0.3, 40, 20));
    const VoxelBricks bricks = field_of(mesh, 0.05).bricks;
    ASSERT_EQ(write_vdb(path, bricks, {"0123456789abcdef", 0.25, {"one", "two"}}), "");
    const VdbFile read = read_vdb(path, VdbWants::bricks_and_surface);
    ASSERT_EQ(read.trouble, "");
    EXPECT_EQ(read.notes.key, "0123456789abcdef");
    EXPECT_EQ(read.notes.error, 0.25);
    EXPECT_EQ(read.notes.warnings, (std::vector<std::string>{"one", "two"}));
    EXPECT_EQ(read.bricks.origin, bricks.origin);
    EXPECT_EQ(read.bricks.voxel, bricks.voxel);
    EXPECT_EQ(read.bricks.band, bricks.band);
    EXPECT_EQ(read.bricks.brick_of, bricks.brick_of);
    EXPECT_EQ(read.bricks.values, bricks.values);
    // Its surface is closed, turned outward, and lies where the distance is 0.
    EXPECT_TRUE(is_closed(read.surface));
    for (const Vec3& vertex : read.surface.vertices)
        ASSERT_LT(std::abs(signed_distance(mesh, vertex)), 0.5 * bricks.voxel);
    EXPECT_LT(signed_distance(read.surface, {1, 0, 0}), -0.2);
    EXPECT_GT(signed_distance(read.surface, {0, 0, 0}), 0.5);
    std::filesystem::remove(path);
}

TEST(VoxelField, SaysWhichFileIsWrongAndWhatWasWanted)
{
    const auto folder = std::filesystem::path(testing::TempDir());
    const auto absent = folder / "no_such.vdb", text = folder / "voxel_field_text.vdb";
    std::ofstream(text) << "this is no grid at all, but it is longer than a header would be";
    EXPECT_EQ(read_vdb(absent, VdbWants::bricks).trouble,
              absent.string()
                  + ": there is no such file; wanted a .vdb file with a float level set");
    const std::string trouble = read_vdb(text, VdbWants::bricks).trouble;
    EXPECT_EQ(trouble.find(text.string() + ": is no .vdb file that can be read"), 0u) << trouble;
    std::filesystem::remove(text);
    const Mesh mesh = closed(box_mesh({1, 1, 1}));
    const std::string unwritable =
        write_vdb(folder / "no_such_folder" / "a.vdb", field_of(mesh, 0.2).bricks, {});
    EXPECT_NE(unwritable.find("cannot be written"), std::string::npos) << unwritable;
}

}  // namespace
}  // namespace throng
