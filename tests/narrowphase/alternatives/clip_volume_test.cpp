#include "narrowphase/alternatives/clip_volume.hpp"

#include "kernels/geometry/cut_polyhedron.hpp"
#include "tests/support/polytope_pairs.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace throng {
namespace {

constexpr MethodStart kStarts[] = {MethodStart::cached, MethodStart::cold, MethodStart::plain};
constexpr ShapeRef kHullA{ShapeKind::hull, 0}, kHullB{ShapeKind::hull, 1};

MethodAnswer ask(const ConvexPair& pair, MethodStart start)
{
    MethodMemory memory;
    return query_clip_volume(pair, 0, start, memory);
}

Pose scaled(const Pose& pose, double scale) { return {pose.position * scale, pose.orientation}; }

Quat about(const Vec3& axis, double degrees)
{
    return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()));
}

Shapes cubes(double side) { return two_boxes(Vec3::Constant(side / 2), Vec3::Constant(side / 2)); }

// Two hulls of `few` to `many` points, or boxes, one in four.
Shapes some_shapes(RandomShapes& random, int few, int many)
{
    Shapes shapes;
    for (int i = 0; i < 2; ++i) {
        const int points = static_cast<int>(random.number(few, many + 1));
        if (random.number(0, 4) < 1) {
            shapes.hulls.push_back(build_hull(corners_of(random.vector(0.2, 0.6))).hull);
        } else {
            shapes.hulls.push_back(random.hull(points, random.number(0.3, 0.7)));
        }
    }
    return shapes;
}

// The twin: each face of either is cut by all planes of the other, a polygon on its own, and the
// divergence theorem adds up what is left. For shapes no face of which lies in one of the other.
using Wide = long double;
using WideVec = Vec3T<Wide>;

struct WideFaces {
    std::vector<std::vector<WideVec>> faces;
    std::vector<WideVec> normals;
    std::vector<Wide> offsets;

    WideFaces(const PolytopeView& shape, const Mat3& turn, const Vec3& shift)
    {
        const Mat3T<Wide> turn_wide = turn.cast<Wide>();
        for (std::size_t face = 0; face < shape.normals.size(); ++face) {
            std::vector<WideVec> corners;
            for (const std::uint16_t corner : shape.face(face))
                corners.push_back(turn_wide * shape.vertices[corner].cast<Wide>()
                                  + shift.cast<Wide>());
            faces.push_back(corners);
            normals.push_back(turn_wide * shape.normals[face].cast<Wide>());
            offsets.push_back(static_cast<Wide>(shape.offsets[face])
                              + normals.back().dot(shift.cast<Wide>()));
        }
    }
};

std::vector<WideVec> cut(const std::vector<WideVec>& corners, const WideVec& normal, Wide offset)
{
    std::vector<WideVec> kept;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const WideVec &from = corners[i], &to = corners[i + 1 < corners.size() ? i + 1 : 0];
        const Wide above = normal.dot(from) - offset, next = normal.dot(to) - offset;
        if (above <= 0) kept.push_back(from);
        if ((above < 0 && next > 0) || (above > 0 && next < 0))
            kept.push_back(from + (to - from) * (above / (above - next)));
    }
    return kept;
}

struct WideSum {
    Wide volume = 0, surface = 0;
    WideVec moment = WideVec::Zero(), on_a = WideVec::Zero();

    void add(const WideFaces& shape, const WideFaces& other, bool is_a)
    {
        for (std::vector<WideVec> face : shape.faces) {
            for (std::size_t k = 0; k < other.normals.size() && !face.empty(); ++k)
                face = cut(face, other.normals[k], other.offsets[k]);
            WideVec area = WideVec::Zero();
            for (std::size_t i = 2; i < face.size(); ++i) {
                const WideVec across = (face[i - 1] - face[0]).cross(face[i] - face[0]);
                area += across / 2;
                const Wide part = face[0].dot(across) / 6;
                volume += part;
                moment += (face[0] + face[i - 1] + face[i]) * (part / 4);
            }
            surface += area.norm();
            if (is_a) on_a += area;
        }
    }
};

WideSum by_faces(const PolytopePair& pair)
{
    const WideFaces a(pair.a, Mat3::Identity(), Vec3::Zero()), b(pair.b, pair.turn, pair.shift);
    WideSum sum;
    sum.add(a, b, true);
    sum.add(b, a, false);
    return sum;
}

// a cut by the planes of b in an order of chance.
Enclosed in_some_order(const PolytopePair& pair, RandomShapes& random)
{
    std::vector<CutPlane> planes;
    collect_planes(pair.b, 0.02 * pair.noise(), planes);
    CutPolyhedron rest;
    rest.start(pair.a, 0.02 * pair.noise(), planes.size());
    for (std::size_t left = planes.size(); left > 0; --left) {
        std::swap(planes[left - 1],
                  planes[static_cast<std::size_t>(random.number(0, static_cast<double>(left)))]);
        CutPlane plane = planes[left - 1];
        plane.normal = pair.turn * plane.normal;
        plane.offset += plane.normal.dot(pair.shift - pair.a.center);
        if (rest.cut(plane) == CutPolyhedron::Cut::gone) return {};
    }
    EXPECT_FALSE(rest.cut_short());
    return rest.enclosed();
}

struct Known {
    Pose pose;
    double volume;
    Vec3 center;
};

}  // namespace

TEST(ClipVolume, KnownVolumesOfUnitCubesAtEveryScale)
{
    const Known known[] = {
        {{Vec3::Zero(), about(Vec3::UnitZ(), 45)}, 0.828427124746190, Vec3::Zero()},
        {{Vec3::Zero(), about(Vec3::Ones(), 60)}, 0.75, Vec3::Zero()},
        {at(0.3, 0.4, 0.5), 0.21, {0.15, 0.2, 0.25}},
        {{{0.6, 0.2, 0.1}, Quat(1, 2, 3, 4).normalized()},
         0.287341666666667,
         {0.286826222644, 0.131183743211, 0.0564773156152}},
        {at(0, 0, 0), 1, Vec3::Zero()},
    };
    for (const Known& pair : known) {
        for (const double scale : {1e-6, 1.0, 1e6}) {
            const Shapes shapes = cubes(scale);
            const ConvexPair ab(shapes, kBoxA, kBoxB, scaled(pair.pose, scale));
            const ConvexPair ba(shapes, kBoxB, kBoxA, inverse(scaled(pair.pose, scale)));
            for (const MethodStart start : kStarts) {
                const MethodAnswer answer = ask(ab, start), swapped = ask(ba, start);
                const double cube = scale * scale * scale;
                EXPECT_EQ(answer.overlap, OverlapState::touching);
                EXPECT_NEAR(answer.volume / cube, pair.volume, 1e-14);
                EXPECT_NEAR(swapped.volume / cube, pair.volume, 1e-14);
                EXPECT_LT((answer.center / scale - pair.center).norm(), 1e-12);
                EXPECT_NEAR(answer.normal.norm(), 1, 1e-14);
            }
        }
    }
}

TEST(ClipVolume, MirroredTetrahedraShareAnOctahedron)
{
    const std::vector<Vec3> corners = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    std::vector<Vec3> mirrored;
    for (const Vec3& corner : corners) mirrored.push_back(-corner);
    Shapes shapes;
    shapes.hulls = {build_hull(corners).hull, build_hull(mirrored).hull};
    const ConvexPair pair(shapes, kHullA, kHullB, Pose{});
    for (const MethodStart start : kStarts) {
        const MethodAnswer answer = ask(pair, start);
        EXPECT_NEAR(answer.volume, 4.0 / 3, 1e-14);
        EXPECT_NEAR(answer.surface, 4 * std::sqrt(3), 1e-14);
        EXPECT_LT(answer.center.norm(), 1e-14);
    }
}

TEST(ClipVolume, WhatMerelyTouchesSharesNoVolume)
{
    const Quat turns[] = {Quat::Identity(), about({1, 1, 1}, 50), about({1, -2, 3}, 111)};
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Shapes shapes = cubes(scale);
        // Sharing a face in part, a face, an edge, and a corner.
        for (const Vec3& shift :
             {Vec3(1, 0.2, 0.1), Vec3(0, 0, -1), Vec3(0, 1, 1), Vec3(1, -1, 1)}) {
            const ConvexPair pair(shapes, kBoxA, kBoxB, {shift * scale, Quat::Identity()});
            for (const MethodStart start : kStarts) {
                const MethodAnswer answer = ask(pair, start);
                EXPECT_EQ(answer.overlap, OverlapState::touching);
                EXPECT_EQ(answer.volume, 0);
                EXPECT_NEAR(answer.normal.dot(shift), 1, 1e-14);
                EXPECT_LT((answer.center / scale).cwiseAbs().maxCoeff(), 0.5 + 1e-14);
                EXPECT_LT((answer.center / scale - shift).cwiseAbs().maxCoeff(), 0.5 + 1e-14);
            }
        }
        // A corner on a face: by rounding they may be a hair apart, and then that is the answer.
        for (const Quat& turn : turns) {
            double lowest = 0;
            for (const Vec3& corner : corners_of(Vec3::Constant(0.5)))
                lowest = std::min(lowest, (turn * corner).z());
            const Pose pose{Vec3(0.1, 0.2, 0.5 - lowest) * scale, turn};
            const ConvexPair pair(shapes, kBoxA, kBoxB, pose);
            EXPECT_EQ(ask(pair, MethodStart::cold).volume, 0);
            EXPECT_EQ(ask(pair, MethodStart::plain).volume, 0);
        }
    }
}

TEST(ClipVolume, AgreesWithFacesCutOneByOne)
{
    RandomShapes random(71);
    int compared = 0;
    for (int i = 0; i < 150; ++i) {
        SCOPED_TRACE("seed 71, pair " + std::to_string(i));
        const Shapes shapes = some_shapes(random, 4, i < 100 ? 12 : 40);
        const ConvexPair pair(shapes, kHullA, kHullB, random.pose(0.45));
        if (std::max(stray_of(view_of(shapes.hulls[0])), stray_of(view_of(shapes.hulls[1])))
            > 1e-14)
            continue;
        const WideSum truth = by_faces(*pair.polytopes());
        if (truth.volume < 1e-4L) continue;
        ++compared;
        for (const MethodStart start : kStarts) {
            const MethodAnswer answer = ask(pair, start);
            ASSERT_NEAR(answer.volume, static_cast<double>(truth.volume), 1e-15);
            ASSERT_NEAR(answer.surface, static_cast<double>(truth.surface), 1e-14);
            const Vec3 center = (truth.moment / truth.volume).cast<double>();
            ASSERT_LT((answer.center - center).norm(), 1e-13);
            if (truth.on_a.norm() < 1e-3L) continue;
            ASSERT_LT((answer.normal - truth.on_a.normalized().cast<double>()).norm(), 1e-12);
        }
    }
    EXPECT_GT(compared, 100);
}

TEST(ClipVolume, NeitherTheOrderOfThePlanesNorOfTheShapesMatters)
{
    RandomShapes random(72);
    for (int i = 0; i < 1000; ++i) {
        SCOPED_TRACE("seed 72, pair " + std::to_string(i));
        const Shapes shapes = some_shapes(random, 8, i < 900 ? 20 : 60);
        const double scale = std::pow(10.0, random.number(-6, 6));
        Shapes large = shapes;
        for (Hull& hull : large.hulls) {
            for (Vec3& vertex : hull.vertices) vertex *= scale;
            for (double& offset : hull.offsets) offset *= scale;
            hull.center *= scale;
            hull.inner_radius *= scale;
            hull.outer_radius *= scale;
        }
        const Pose pose = random.pose(0.5);
        const ConvexPair ab(shapes, kHullA, kHullB, pose);
        const ConvexPair ba(shapes, kHullB, kHullA, inverse(pose));
        const ConvexPair grown(large, kHullA, kHullB, scaled(pose, scale));
        const MethodAnswer cold = ask(ab, MethodStart::cold), plain = ask(ab, MethodStart::plain);
        const MethodAnswer swapped = ask(ba, MethodStart::plain);
        const MethodAnswer far = ask(grown, MethodStart::cold);
        ASSERT_EQ(plain.overlap, cold.overlap);
        ASSERT_EQ(swapped.overlap, cold.overlap);
        ASSERT_NEAR(plain.volume, cold.volume, 1e-14);
        ASSERT_NEAR(swapped.volume, cold.volume, 1e-14);
        ASSERT_NEAR(far.volume / (scale * scale * scale), cold.volume, 1e-14);
        ASSERT_NEAR(plain.surface, cold.surface, 1e-12);
        ASSERT_NEAR(in_some_order(*ab.polytopes(), random).volume, cold.volume, 1e-14);
        ASSERT_NEAR(in_some_order(*ba.polytopes(), random).volume, cold.volume, 1e-14);
        if (cold.volume < 1e-3) continue;
        ASSERT_LT((pose * swapped.center - cold.center).norm(), 1e-11);
        if (depth_along(ab, cold.normal) > 0.9) continue;
        ASSERT_LT((pose.orientation * swapped.normal + cold.normal).norm(), 1e-9);
    }
}

TEST(ClipVolume, YesAndNoAreThoseOfTheSeparatingAxes)
{
    RandomShapes random(73);
    int touching = 0;
    constexpr int kPairs = 20000;
    for (int i = 0; i < kPairs / 20; ++i) {
        const Shapes shapes = some_shapes(random, 8, i % 50 == 0 ? 60 : 14);
        for (int k = 0; k < 20; ++k) {
            SCOPED_TRACE("seed 73, pair " + std::to_string(20 * i + k));
            Pose pose = random.pose(0.75);
            // Parallel, and concentric.
            if (k % 5 == 1) pose.orientation = Quat::Identity();
            if (k % 5 == 2) pose.position.setZero();
            ConvexPair pair(shapes, kHullA, kHullB, pose);
            const double separation = separation_of(pair);
            MethodMemory memory;
            for (const MethodStart start : kStarts) {
                const MethodAnswer answer = query_clip_volume(pair, 0, start, memory);
                ASSERT_FALSE(answer.cut_short);
                if (std::abs(separation) < 1e-9) continue;
                ASSERT_EQ(answer.overlap,
                          separation > 0 ? OverlapState::apart : OverlapState::touching);
                if (separation > 0) continue;
                ASSERT_GT(answer.volume, 0);
                ASSERT_TRUE(answer.center.allFinite());
            }
            touching += separation < 0;
        }
    }
    EXPECT_GT(touching, kPairs / 4);
    EXPECT_LT(touching, 3 * kPairs / 4);
}

TEST(ClipVolume, YesAndNoHoldAHairFromTouching)
{
    RandomShapes random(74);
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE("seed 74, pair " + std::to_string(i));
        const Shapes shapes = some_shapes(random, 8, 16);
        Pose pose = random.pose(0.4);
        Vec3 normal;
        const PolytopeView a = view_of(shapes.hulls[0]), b = view_of(shapes.hulls[1]);
        const double separation = polytope_separation(a, b, pose, &normal);
        const double clearance = (i % 2 == 0 ? 1 : -1) * 3e-9;
        pose.position += normal * (clearance - separation);
        if (std::abs(polytope_separation(a, b, pose, nullptr)) < 1e-9) continue;
        const ConvexPair pair(shapes, kHullA, kHullB, pose);
        const OverlapState truth =
            separation_of(pair) > 0 ? OverlapState::apart : OverlapState::touching;
        for (const MethodStart start : kStarts) ASSERT_EQ(ask(pair, start).overlap, truth);
    }
}

TEST(ClipVolume, DepthAlongTheNormalPartsThem)
{
    RandomShapes random(75);
    for (int i = 0; i < 500; ++i) {
        SCOPED_TRACE("seed 75, pair " + std::to_string(i));
        const Shapes shapes = some_shapes(random, 8, 20);
        Pose pose = random.pose(0.5);
        const ConvexPair pair(shapes, kHullA, kHullB, pose);
        const MethodAnswer answer = ask(pair, MethodStart::cold);
        if (answer.overlap != OverlapState::touching) continue;
        const double depth = depth_along(pair, answer.normal);
        ASSERT_GE(depth, -separation_of(pair) - 1e-12);
        pose.position += answer.normal * (depth + 1e-9);
        ASSERT_EQ(ask(ConvexPair(shapes, kHullA, kHullB, pose), MethodStart::cold).overlap,
                  OverlapState::apart);
    }
    // A box that stands on a box is pushed straight up.
    const Shapes boxes = two_boxes({1, 1, 1}, {0.2, 0.3, 0.4});
    const ConvexPair resting(boxes, kBoxA, kBoxB, {{0.1, 0.2, 1.399}, about({0, 0, 1}, 20)});
    const MethodAnswer answer = ask(resting, MethodStart::cold);
    EXPECT_LT((answer.normal - Vec3::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(depth_along(resting, answer.normal), 0.001, 1e-14);
    EXPECT_NEAR(answer.volume, 0.4 * 0.6 * 0.001, 1e-15);
}

TEST(ClipVolume, SidesInOnePlaneLeanToNeitherSide)
{
    // Flush at +x and at both sides of y; b stands back from -x.
    const Shapes shapes = two_boxes({1, 1, 1}, {0.8, 1, 0.5});
    const Pose pose = at(0.2, 0, 1.25);
    const MethodAnswer answer = ask(ConvexPair(shapes, kBoxA, kBoxB, pose), MethodStart::cold);
    const MethodAnswer swapped =
        ask(ConvexPair(shapes, kBoxB, kBoxA, inverse(pose)), MethodStart::cold);
    EXPECT_NEAR(answer.volume, 1.6 * 2 * 0.25, 1e-14);
    EXPECT_LT((answer.normal + swapped.normal).norm(), 1e-14);
    // Half of the side at +x, of 2 by 0.25, against the top of 1.6 by 2.
    const Vec3 expected = Vec3(0.25, 0, 3.2).normalized();
    EXPECT_LT((answer.normal - expected).norm(), 1e-14);
}

TEST(ClipVolume, NeedlesKeepTheirThickness)
{
    RandomShapes random(76);
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("seed 76, pair " + std::to_string(i));
        // Through two faces of a unit cube that look at one another, at most 17 degrees askew.
        const Shapes shapes = two_boxes(Vec3::Constant(0.5), {1000, 0.0005, 0.0005});
        const Quat turn = about(random.vector(-1, 1), random.number(-17, 17));
        const Pose pose{turn * Vec3(random.number(-500, 500), 0, 0) + random.vector(-0.1, 0.1),
                        turn};
        const double length = 1 / std::abs((turn * Vec3::UnitX()).x());
        const double truth = 1e-6 * length;
        const ConvexPair ab(shapes, kBoxA, kBoxB, pose), ba(shapes, kBoxB, kBoxA, inverse(pose));
        // The needle's place across is known to the rounding of its length, 1e-13 m in 1e-3.
        EXPECT_NEAR(ask(ab, MethodStart::cold).volume / truth, 1, 1e-9);
        EXPECT_NEAR(ask(ba, MethodStart::cold).volume / truth, 1, 1e-9);
        EXPECT_NEAR(ask(ab, MethodStart::plain).volume / truth, 1, 1e-9);
        EXPECT_NEAR(ask(ba, MethodStart::plain).volume / truth, 1, 1e-9);
    }
}

TEST(ClipVolume, ASmallShapeKeepsItsOwnAccuracyBesideALargeOne)
{
    // A small cube half sunk into a face a million times its size, away from anything round.
    const Shapes shapes = two_boxes(Vec3::Constant(0x1p20), Vec3::Constant(0.5));
    const Pose pose = at(0x1p20 + 0.25, 12345.678, -0x1p19 / 3);
    for (const bool swapped : {false, true}) {
        const ConvexPair pair(shapes, swapped ? kBoxB : kBoxA, swapped ? kBoxA : kBoxB,
                              swapped ? inverse(pose) : pose);
        EXPECT_NEAR(ask(pair, MethodStart::cold).volume, 0.25, 1e-14);
    }
}

TEST(ClipVolume, FacesThatAreNotQuiteFlatAreTheHullOfTheirCorners)
{
    for (const double raised : {0.0, 1e-12, 1e-9, 1e-7, 2e-6}) {
        std::vector<Vec3> corners = corners_of(Vec3::Constant(0.5));
        corners[4].z() += raised;
        corners[7].z() += raised;
        Shapes shapes;
        shapes.hulls = {build_hull(corners).hull, build_hull(corners_of({2, 1, 3})).hull};
        ASSERT_EQ(shapes.hulls[0].normals.size(), 6U);
        const Pose pose = at(0.1, 0.2, 0.3);
        // A ridge from corner to corner: thirds of the height on either side.
        const double truth = 1 + raised * 2 / 3;
        for (const MethodStart start : kStarts) {
            const ConvexPair ab(shapes, kHullA, kHullB, pose);
            const ConvexPair ba(shapes, kHullB, kHullA, inverse(pose));
            EXPECT_NEAR(ask(ab, start).volume, truth, 2e-15);
            EXPECT_NEAR(ask(ba, start).volume, truth, 2e-15);
        }
        // A point over the middle of what would be the flat top touches the ridge.
        if (raised < 1e-8) continue;
        shapes.hulls[1] =
            build_hull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}}).hull;
        for (const double height : {0.99, 1.01}) {
            const ConvexPair above(shapes, kHullA, kHullB, at(0, 0, 0.5 + raised * height));
            for (const MethodStart start : kStarts)
                EXPECT_EQ(ask(above, start).overlap,
                          height < 1 ? OverlapState::touching : OverlapState::apart);
        }
        // Beside the ridge the face is lower.
        const ConvexPair beside(shapes, kHullA, kHullB, at(0.49, 0.49 - 0.98, 0.5 + raised * 0.5));
        for (const MethodStart start : kStarts)
            EXPECT_EQ(ask(beside, start).overlap, OverlapState::apart);
    }
}

TEST(ClipVolume, ThousandsOfFaces)
{
    RandomShapes random(77);
    Shapes shapes;
    shapes.hulls = {random.hull(1200, 0.5), random.hull(900, 0.5)};
    const Pose pose{{0.3, 0.2, 0.1}, random.turn()};
    const ConvexPair ab(shapes, kHullA, kHullB, pose), ba(shapes, kHullB, kHullA, inverse(pose));
    const MethodAnswer answer = ask(ab, MethodStart::cold);
    ASSERT_FALSE(answer.cut_short);
    EXPECT_NEAR(ask(ba, MethodStart::cold).volume, answer.volume, 1e-14);
    EXPECT_NEAR(ask(ba, MethodStart::plain).volume, answer.volume, 1e-14);
    // The lens of two balls, a hundredth larger than the hulls in them.
    const double d = pose.position.norm();
    const double lens = std::numbers::pi * (4 * 0.5 + d) * (1 - d) * (1 - d) / 12;
    EXPECT_NEAR(answer.volume / lens, 1, 0.03);
    EXPECT_LT(answer.volume, lens);
    EXPECT_LT((answer.normal - pose.position / d).norm(), 0.02);
}

TEST(ClipVolume, BoxesOfNoThicknessGiveFiniteAnswers)
{
    for (const Vec3& half : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)}) {
        for (const Vec3& other : {Vec3(0, 0, 0), Vec3(0, 2, 0), Vec3(0, 1, 1), Vec3(1, 1, 1)}) {
            const Shapes shapes = two_boxes(half, other);
            for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0, 0.5, 0.5), Vec3(0, 0, 3)}) {
                const ConvexPair pair(shapes, kBoxA, kBoxB, {shift, Quat::Identity()});
                for (const MethodStart start : kStarts) {
                    const MethodAnswer answer = ask(pair, start);
                    EXPECT_TRUE(answer.center.allFinite() && std::isfinite(answer.surface));
                    EXPECT_EQ(answer.volume, 0);
                    EXPECT_NEAR(answer.normal.norm(), 1, 1e-14);
                    if (shift.isZero()) {
                        EXPECT_EQ(answer.overlap, OverlapState::touching);
                    }
                    if (shift.z() == 3) {
                        EXPECT_EQ(answer.overlap, OverlapState::apart);
                    }
                }
            }
        }
    }
}

TEST(ClipVolume, WhatIsRememberedChangesTheTimeAlone)
{
    RandomShapes random(78);
    MethodMemory memory;
    int quick = 0;
    for (int i = 0; i < 40; ++i) {
        const Shapes shapes = some_shapes(random, 8, 30);
        const Vec3 start = random.vector(-1, 1), spin = random.vector(-1, 1);
        // Memory of other shapes altogether is as good as none.
        for (int k = 0; k < 50; ++k) {
            SCOPED_TRACE("seed 78, run " + std::to_string(i) + ", step " + std::to_string(k));
            const Pose pose{start * (1.5 - 0.03 * k), about(spin, 2 * k)};
            const ConvexPair pair(shapes, kHullA, kHullB, pose);
            const MethodAnswer cached = query_clip_volume(pair, 0, MethodStart::cached, memory);
            const MethodAnswer cold = ask(pair, MethodStart::cold);
            ASSERT_EQ(cached.overlap, cold.overlap);
            ASSERT_EQ(cached.volume, cold.volume);
            ASSERT_EQ(cached.surface, cold.surface);
            if (cached.overlap == OverlapState::apart) quick += cached.rounds == 1;
        }
    }
    EXPECT_GT(quick, 500);
}

}  // namespace throng
