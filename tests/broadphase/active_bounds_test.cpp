// Active bounds: the wide kernel against shape_bounds() and fattened(), one collider at a time.
#include "broadphase/active_bounds.hpp"

#include "broadphase/margins.hpp"
#include "kernels/data/bodies.hpp"
#include "kernels/geometry/shape_bounds.hpp"
#include "tests/broadphase/random_boxes.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace throng::test {
namespace {

constexpr double kDt = 1.0 / 60;

struct ActiveBodies {
    Shapes shapes;
    Poses poses;
    Velocities velocities;
    std::vector<ShapeRef> shape;
    std::vector<float> half[3], round;
    std::vector<std::uint8_t> form;
    std::vector<double> inner, outer, speculative_margin;
    std::vector<Pose> placed;
    std::vector<Box3> boxes;
    std::vector<NearBox> near;
    std::vector<std::uint32_t> colliders, bodies;  // asked about
    double loose = ActiveBoundsRule().loose;

    explicit ActiveBodies(std::uint32_t count, std::uint64_t seed)
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
            form.push_back(static_cast<std::uint8_t>(ActiveBoundsForm::box));
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
                form.back() = static_cast<std::uint8_t>(ActiveBoundsForm::cylinder);
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
        speculative_margin.resize(count);
        placed.resize(count);
        near.resize(count);
    }

    template <class T>
    static std::uint32_t count_of(const std::vector<T>& list)
    {
        return static_cast<std::uint32_t>(list.size());
    }

    ActiveBoundsRule rule() const
    {
        const MarginRule margin;
        return {kDt, 0.04, 0.001, margin.base, margin.steps, margin.longest, loose};
    }
    std::vector<std::uint32_t> run(const char* width)
    {
        const ActiveBoundsArrays arrays{poses.position[0].data(),
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
                                        speculative_margin.data(),
                                        near[0].lower};
        std::vector<std::uint32_t> asked(colliders.size());
        const ActiveBoundsKernel& update = *active_bounds_kernel_of(width);
        asked.resize(update(rule(), arrays, colliders.data(), bodies.data(), colliders.size(),
                            asked.data()));
        return asked;
    }
};

TEST(ActiveBounds, AgreeWithOneColliderAtATime)
{
    ActiveBodies active(400, 1);
    const std::vector<Box3> before = active.boxes;
    const std::vector<std::uint32_t> asked = active.run("scalar");
    std::vector<std::uint32_t> wanted_asked;
    for (std::uint32_t i = 0; i < 400; ++i) {
        const Pose placed = active.poses.at(i);
        const double speculative_margin = std::max(0.04 * active.inner[i], 0.001)
            + active.velocities.linear[i].norm() * kDt
            + std::min(active.velocities.angular[i].norm() * active.outer[i] * kDt,
                       2 * active.outer[i]);
        Box3 box = shape_bounds(active.shapes, active.shape[i], placed);
        box.lower.array() -= speculative_margin;
        box.upper.array() += speculative_margin;
        EXPECT_EQ(active.placed[i].position, placed.position);
        EXPECT_EQ(active.placed[i].orientation.coeffs(), placed.orientation.coeffs());
        EXPECT_NEAR(active.speculative_margin[i], speculative_margin, 1e-14 * speculative_margin);
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(double{active.near[i].lower[k]}, box.lower[k]);
            EXPECT_GE(double{active.near[i].upper[k]}, box.upper[k]);
            EXPECT_NEAR(double{active.near[i].lower[k]}, box.lower[k], 4e-5);
            EXPECT_NEAR(double{active.near[i].upper[k]}, box.upper[k], 4e-5);
        }
        if (before[i].contains(box)) {
            EXPECT_EQ(active.boxes[i].lower, before[i].lower);
            continue;
        }
        wanted_asked.push_back(i);
        const Box3 fat = fattened(box, active.velocities.linear[i], active.inner[i], kDt);
        EXPECT_LE((active.boxes[i].lower - fat.lower).cwiseAbs().maxCoeff(), 1e-12) << i;
        EXPECT_LE((active.boxes[i].upper - fat.upper).cwiseAbs().maxCoeff(), 1e-12) << i;
    }
    EXPECT_EQ(asked, wanted_asked);
}

TEST(ActiveBounds, MakeALooseBoxAnew)
{
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        if (active_bounds_kernel_of(width) == nullptr) continue;
        ActiveBodies active(300, 5);
        MarginRule margin;
        active.loose = margin.loose;
        active.run(width);
        EXPECT_TRUE(active.run(width).empty()) << width;
        const std::vector<Box3> before = active.boxes;
        for (Vec3& velocity : active.velocities.linear) velocity *= 0.1;
        const std::vector<std::uint32_t> asked = active.run(width);
        std::vector<std::uint32_t> wanted;
        for (std::uint32_t i = 0; i < 300; ++i) {
            Box3 box = shape_bounds(active.shapes, active.shape[i], active.placed[i]);
            box.lower.array() -= active.speculative_margin[i];
            box.upper.array() += active.speculative_margin[i];
            if (loose(before[i], box, active.velocities.linear[i], active.inner[i], kDt))
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

TEST(ActiveBounds, AreTheSameBitsAtEveryWidth)
{
    for (const std::uint32_t count : {1u, 7u, 8u, 9u, 16u, 100u, 333u})
        for (const bool separations : {false, true}) {
            ActiveBodies stated(count, count);
            if (separations) {
                std::erase_if(stated.colliders, [](auto id) { return id % 5 == 2; });
                stated.bodies = stated.colliders;
            }
            if (stated.colliders.empty()) continue;
            ActiveBodies wanted = stated;
            const auto wanted_asked = wanted.run("scalar");
            for (const char* width : {"avx2", "avx512"}) {
                if (active_bounds_kernel_of(width) == nullptr) continue;
                ActiveBodies active = stated;
                EXPECT_EQ(active.run(width), wanted_asked) << width << ", " << count;
                EXPECT_TRUE(same_bits(active.placed, wanted.placed)) << width << ", " << count;
                EXPECT_TRUE(same_bits(active.speculative_margin, wanted.speculative_margin))
                    << width << ", " << count;
                EXPECT_TRUE(same_bits(active.boxes, wanted.boxes)) << width << ", " << count;
                EXPECT_TRUE(same_bits(active.near, wanted.near)) << width << ", " << count;
            }
        }
}

}  // namespace
}  // namespace throng::test
