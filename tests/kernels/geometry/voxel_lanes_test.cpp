// Voxel samples side by side: the bits of those taken one by one, at every width.
#include "kernels/geometry/voxel_bricks.hpp"
#include "kernels/geometry/voxel_kernels.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

namespace throng {
namespace {

struct Samples {
    explicit Samples(std::size_t count) : distance(count), gx(count), gy(count), gz(count) { }
    std::vector<float> distance, gx, gy, gz;
};

bool same_bits(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), 4 * a.size()) == 0;
}

class VoxelLanes : public testing::Test {
protected:
    VoxelLanes()
    {
        // Bounds and corners of bricks among them, and what is far outside or no number.
        std::mt19937 random(3);
        std::uniform_real_distribution<float> anywhere(-2, 2), near(-0.9F, 0.9F);
        const auto add = [&](float a, float b, float c) {
            x_.push_back(a);
            y_.push_back(b);
            z_.push_back(c);
        };
        for (int i = 0; i < 400; ++i) add(anywhere(random), anywhere(random), anywhere(random));
        for (int i = 0; i < 600; ++i) add(near(random), near(random), near(random));
        for (int i = 0; i < 100; ++i) {
            const Vec3 at = bricks_.origin + bricks_.voxel * 8.0 * Vec3(i % 4, i / 4 % 4, i / 16);
            add(static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()));
        }
        constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
        constexpr float kInf = std::numeric_limits<float>::infinity();
        for (const float odd : {kNan, kInf, -kInf, 3e38F, -3e38F, 1e-40F, -0.0F}) {
            add(odd, 0, 0);
            add(0, odd, 0);
            add(0, 0, odd);
        }
    }

    Samples plain(std::size_t count) const
    {
        Samples out(count);
        for (std::size_t i = 0; i < count; ++i) {
            const auto sample = sample_bricks<float>(bricks_, {x_[i], y_[i], z_[i]});
            out.distance[i] = sample.distance;
            out.gx[i] = sample.gradient.x();
            out.gy[i] = sample.gradient.y();
            out.gz[i] = sample.gradient.z();
        }
        return out;
    }

    // A shell: outside, inside and bricks that are not stored.
    VoxelBricks bricks_ =
        bake_bricks({Vec3::Constant(-0.7), Vec3::Constant(0.7)}, 0.041, 0.123, [](const Vec3& at) {
            return std::abs(at.norm() - 0.6) - 0.05;
        });
    std::vector<float> x_, y_, z_;
};

TEST_F(VoxelLanes, GiveTheBitsOfSingleSamplesAtEveryWidth)
{
    const Samples wanted = plain(x_.size());
    ASSERT_NE(std::count(bricks_.brick_of.begin(), bricks_.brick_of.end(), -1), 0);
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        const SampleKernel* const kernel = sample_kernel_of(width);
        if (kernel == nullptr) continue;
        Samples got(x_.size());
        (*kernel)(view_of(bricks_),
                  {x_.data(), y_.data(), z_.data(), got.distance.data(), got.gx.data(),
                   got.gy.data(), got.gz.data()},
                  x_.size());
        EXPECT_TRUE(same_bits(got.distance, wanted.distance)) << width;
        EXPECT_TRUE(same_bits(got.gx, wanted.gx)) << width;
        EXPECT_TRUE(same_bits(got.gy, wanted.gy)) << width;
        EXPECT_TRUE(same_bits(got.gz, wanted.gz)) << width;
    }
}

TEST_F(VoxelLanes, WriteEveryPointOfEveryLengthAndNoOther)
{
    const Samples wanted = plain(80);
    for (const char* width : {"scalar", "avx2", "avx512"}) {
        const SampleKernel* const kernel = sample_kernel_of(width);
        if (kernel == nullptr) continue;
        for (std::size_t count = 0; count <= 70; ++count) {
            Samples got(80);
            (*kernel)(view_of(bricks_),
                      {x_.data(), y_.data(), z_.data(), got.distance.data(), got.gx.data(),
                       got.gy.data(), got.gz.data()},
                      count);
            for (std::size_t i = 0; i < 80; ++i)
                ASSERT_EQ(got.distance[i], i < count ? wanted.distance[i] : 0) << width << count;
        }
    }
}

TEST_F(VoxelLanes, ServeWhatIsEmptyToo)
{
    Samples got(3);
    VoxelBricks empty;
    empty.voxel = 1;
    empty.band = 2;
    sample_many(empty,
                {std::span(x_).first(3), std::span(y_).first(3), std::span(z_).first(3),
                 got.distance, got.gx, got.gy, got.gz});
    EXPECT_EQ(got.distance, (std::vector<float>{2, 2, 2}));
    const Samples wanted = plain(3);
    sample_many(bricks_,
                {std::span(x_).first(3), std::span(y_).first(3), std::span(z_).first(3),
                 got.distance, got.gx, got.gy, got.gz});
    EXPECT_EQ(got.distance, wanted.distance);
}

}  // namespace
}  // namespace throng
