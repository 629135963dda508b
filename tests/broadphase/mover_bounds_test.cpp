// Mover bounds: the wide kernel against shape_bounds() and fattened(), one collider at a time.
#include "broadphase/mover_bounds.hpp"

#include "broadphase/margins.hpp"
#include "kernels/data/bodies.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "tests/broadphase/random_boxes.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace throng::test {
namespace {

constexpr double kDt = 1.0 / 60;

struct Movers {
    Shapes shapes;
    Poses poses;
    Velocities velocities;
    std::vector<ShapeRef> shape;
    std::vector<float> half[3], round;
    std::vector<std::uint8_t> form;
    std::vector<double> inner, outer, reach;
    std::vector<Pose> placed;
    std::vector<Box3> boxes;
    std::vector<NearBox> near;
    std::vector<std::uint32_t> colliders, bodies;  // asked about
    double loose = MoverRule().loose;

    explicit Movers(std::uint32_t count, std::uint64_t seed)
    {
        Dice dice(seed);
        for (std::vector<float>& h : half) h.resize(count);
        round.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            poses.position.push_back(dice.point(50));
            poses.orientation.push_back(Quat(dice.between(0.1, 1), dice.between(-1, 1),
                                             dice.between(-1, 1), dice.between(-1, 1))
                                            .normalized());
            velocities.linear.push_back(dice.point(dice.chance(0.1) ? 300 : 3));
            velocities.angular.push_back(dice.chance(0.2) ? Vec3(0, 0, 0) : dice.point(5));
            // Whole numbers of 1/64: exact in float.
            const auto size = [&] { return (1 + dice.below(128)) / 64.0; };
            const Vec3 sizes(size(), size(), size());
            Vec3 h = Vec3::Zero();
            double r = 0;
            form.push_back(static_cast<std::uint8_t>(MoverForm::box));
            switch (dice.below(4)) {
            case 0:
                shape.push_back({ShapeKind::sphere, count_of(shapes.spheres)});
                shapes.spheres.push_back({r = sizes.x()});
                break;
            case 1:
                shape.push_back({ShapeKind::capsule, count_of(shapes.capsules)});
                shapes.capsules.push_back({r = sizes.x(), h.z() = sizes.y()});
                break;
            case 2:
                shape.push_back({ShapeKind::cylinder, count_of(shapes.cylinders)});
                shapes.cylinders.push_back({r = sizes.x(), h.z() = sizes.y()});
                form.back() = static_cast<std::uint8_t>(MoverForm::cylinder);
                break;
            default:
                shape.push_back({ShapeKind::box, count_of(shapes.boxes)});
                shapes.boxes.push_back({h = sizes});
            }
            for (int k = 0; k < 3; ++k) half[k][i] = static_cast<float>(h[k]);
            round[i] = static_cast<float>(r);
            inner.push_back(inner_extent(shapes, shape.back()));
            outer.push_back(outer_radius(shapes, shape.back()));
            const Vec3 middle = poses.position.back();
            boxes.push_back(dice.chance(0.5) ? box_around(middle, Vec3::Constant(20)) : Box3{});
            colliders.push_back(i);
            bodies.push_back(i);
        }
        reach.resize(count);
        placed.resize(count);
        near.resize(count);
    }

    template <class T>
    static std::uint32_t count_of(const std::vector<T>& list)
    {
        return static_cast<std::uint32_t>(list.size());
    }

    MoverRule rule() const
    {
        const MarginRule margin;
        return {kDt, 0.04, 0.001, margin.base, margin.steps, margin.longest, loose};
    }
    std::vector<std::uint32_t> run(const char* width)
    {
        const MoverArrays arrays{poses.position[0].data(),
                                 velocities.linear[0].data(),
                                 velocities.angular[0].data(),
                                 poses.orientation[0].coeffs().data(),
                                 {half[0].data(), half[1].data(), half[2].data()},
                                 round.data(),
                                 form.data(),
                                 inner.data(),
                                 outer.data(),
                                 placed[0].position.data(),
                                 boxes[0].lower.data(),
                                 reach.data(),
                                 near[0].lower};
        std::vector<std::uint32_t> asked(colliders.size());
        asked.resize(mover_kernel_of(width)(rule(), arrays, colliders.data(), bodies.data(),
                                            colliders.size(), asked.data()));
        return asked;
    }
};

TEST(MoverBounds, AgreeWithOneColliderAtATime)
{
    Movers movers(400, 1);
    const std::vector<Box3> before = movers.boxes;
    const std::vector<std::uint32_t> asked = movers.run("scalar");
    std::vector<std::uint32_t> wanted_asked;
    for (std::uint32_t i = 0; i < 400; ++i) {
        const Pose placed = movers.poses.at(i);
        const double reach = std::max(0.04 * movers.inner[i], 0.001)
            + movers.velocities.linear[i].norm() * kDt
            + std::min(movers.velocities.angular[i].norm() * movers.outer[i] * kDt,
                       2 * movers.outer[i]);
        Box3 box = shape_bounds(movers.shapes, movers.shape[i], placed);
        box.lower.array() -= reach;
        box.upper.array() += reach;
        EXPECT_EQ(movers.placed[i].position, placed.position);
        EXPECT_EQ(movers.placed[i].orientation.coeffs(), placed.orientation.coeffs());
        EXPECT_NEAR(movers.reach[i], reach, 1e-14 * reach);
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(double{movers.near[i].lower[k]}, box.lower[k]);
            EXPECT_GE(double{movers.near[i].upper[k]}, box.upper[k]);
            EXPECT_NEAR(double{movers.near[i].lower[k]}, box.lower[k], 4e-5);
            EXPECT_NEAR(double{movers.near[i].upper[k]}, box.upper[k], 4e-5);
        }
        if (before[i].contains(box)) {
            EXPECT_EQ(movers.boxes[i].lower, before[i].lower);
            continue;
        }
        wanted_asked.push_back(i);
        const Box3 fat = fattened(box, movers.velocities.linear[i], movers.inner[i], kDt);
        EXPECT_LE((movers.boxes[i].lower - fat.lower).cwiseAbs().maxCoeff(), 1e-12) << i;
        EXPECT_LE((movers.boxes[i].upper - fat.upper).cwiseAbs().maxCoeff(), 1e-12) << i;
    }
    EXPECT_EQ(asked, wanted_asked);
}

TEST(MoverBounds, MakeALooseBoxAnew)
{
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        if (mover_kernel_of(width) == nullptr) continue;
        Movers movers(300, 5);
        MarginRule margin;
        movers.loose = margin.loose;
        movers.run(width);
        EXPECT_TRUE(movers.run(width).empty()) << width;
        const std::vector<Box3> before = movers.boxes;
        for (Vec3& velocity : movers.velocities.linear) velocity *= 0.1;
        const std::vector<std::uint32_t> asked = movers.run(width);
        std::vector<std::uint32_t> wanted;
        for (std::uint32_t i = 0; i < 300; ++i) {
            Box3 box = shape_bounds(movers.shapes, movers.shape[i], movers.placed[i]);
            box.lower.array() -= movers.reach[i];
            box.upper.array() += movers.reach[i];
            if (loose(before[i], box, movers.velocities.linear[i], movers.inner[i], kDt))
                wanted.push_back(i);
        }
        EXPECT_EQ(asked, wanted) << width;
        EXPECT_GT(asked.size(), 10u);
        EXPECT_LT(asked.size(), 290u);
    }
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(MoverBounds, AreTheSameBitsAtEveryWidth)
{
    for (const std::uint32_t count : {1u, 7u, 8u, 9u, 16u, 100u, 333u})
        for (const bool gaps : {false, true}) {
            Movers stated(count, count);
            if (gaps) {
                std::erase_if(stated.colliders, [](auto id) { return id % 5 == 2; });
                stated.bodies = stated.colliders;
            }
            if (stated.colliders.empty()) continue;
            Movers wanted = stated;
            const auto wanted_asked = wanted.run("scalar");
            for (const char* width : {"avx2", "avx512"}) {
                if (mover_kernel_of(width) == nullptr) continue;
                Movers movers = stated;
                EXPECT_EQ(movers.run(width), wanted_asked) << width << ", " << count;
                EXPECT_TRUE(same_bits(movers.placed, wanted.placed)) << width << ", " << count;
                EXPECT_TRUE(same_bits(movers.reach, wanted.reach)) << width << ", " << count;
                EXPECT_TRUE(same_bits(movers.boxes, wanted.boxes)) << width << ", " << count;
                EXPECT_TRUE(same_bits(movers.near, wanted.near)) << width << ", " << count;
            }
        }
}

}  // namespace
}  // namespace throng::test
