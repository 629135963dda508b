// Solve widths: every width of every kernel of the solver against the scalar one, to the last bit.
#include "tests/kernels/solver/random_iteration.hpp"
#include "tests/support/same_bytes.hpp"

#include <gtest/gtest.h>

#include <string>

namespace throng {
namespace {

using given::BlockCase;
using given::BlockWish;

template <class T>
bool same_bits(const std::vector<T>& x, const std::vector<T>& y)
{
    return x.size() == y.size()
        && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(T)) == 0);
}

template <class Real>
bool same_bits(const ContactConstraints<Real>& x, const ContactConstraints<Real>& y)
{
    return same_bits(x.blocks, y.blocks) && same_bits(x.points, y.points)
        && same_bits(x.restitutions, y.restitutions)
        && same_bits(x.rolling_frictions, y.rolling_frictions) && same_bits(x.bodies, y.bodies)
        && same_bits(x.point_frictions, y.point_frictions);
}

// Calls check(scalar kernels, wide kernels) for every width that this machine has.
template <class Real, class Check>
void for_widths(Check check)
{
    const SolveKernels<Real>& scalar = *solve_kernels_of<Real>("scalar");
    EXPECT_EQ(scalar.lanes, 1);
    for (const char* width : {"avx2", "avx512"}) {
        const SolveKernels<Real>* const wide = solve_kernels_of<Real>(width);
        if (wide == nullptr) {
            std::printf("this machine has no %s\n", width);
            continue;
        }
        EXPECT_EQ(wide->name, std::string(width));
        EXPECT_EQ(wide->lanes, (width == std::string("avx2") ? 32 : 64) / int(sizeof(Real)));
        check(scalar, *wide);
    }
}

// Lanes that nobody uses hold 0, of whichever sign: who skips them leaves it as it was.
template <class Real>
void drop_signs_of_unused(BlockCase<Real>& of, int lanes)
{
    for (int lane = lanes; lane < kBlock; ++lane) of.block().torsional_impulse.at[lane] += Real(0);
}

template <class Real>
void check_contacts(const SolveKernels<Real>& scalar,
                    const SolveKernels<Real>& wide,
                    bool friction_at_points,
                    bool pyramid)
{
    const unsigned seeds = friction_at_points || pyramid ? 25 : 100;
    for (unsigned seed = 0; seed < seeds; ++seed)
        for (int lanes = 1; lanes <= kBlock; ++lanes)
            for (int points = 1; points <= 4; ++points) {
                std::mt19937 random(seed * 100 + static_cast<unsigned>(4 * lanes + points));
                const BlockWish wish{.lanes = lanes,
                                     .points = points,
                                     .turns = random() % 4 != 0 || friction_at_points || pyramid,
                                     .restitutions = random() % 4 != 0,
                                     .rolls = random() % 2 == 0,
                                     .pivots = random() % 4 == 0,
                                     .friction_at_points = friction_at_points,
                                     .pyramid = pyramid};
                BlockCase<Real> narrow = given::packed_block<Real>(random, wish);
                BlockCase<Real> broad = narrow;
                const SolverIteration<Real> iteration = given::random_iteration<Real>(random, wish);
                const auto expect_same = [&](const char* after) {
                    drop_signs_of_unused(narrow, lanes);
                    drop_signs_of_unused(broad, lanes);
                    ASSERT_TRUE(same_bits(narrow.constraints, broad.constraints))
                        << after << " of " << wide.name << ", seed " << seed << ", " << lanes
                        << " lanes, " << points << " points";
                };
                narrow.prepare(scalar);
                broad.prepare(wide);
                ASSERT_NO_FATAL_FAILURE(expect_same("prepare"));
                narrow.warm_start(scalar, iteration);
                broad.warm_start(wide, iteration);
                ASSERT_NO_FATAL_FAILURE(expect_same("warm_start"));
                narrow.solve(scalar, iteration);
                broad.solve(wide, iteration);
                ASSERT_NO_FATAL_FAILURE(expect_same("sweep"));
                given::run_all(scalar, narrow, iteration);
                given::run_all(wide, broad, iteration);
                ASSERT_NO_FATAL_FAILURE(expect_same("restitute"));
            }
}

void check_contacts(bool friction_at_points, bool pyramid)
{
    for_widths<float>([&](const auto& scalar, const auto& wide) {
        check_contacts<float>(scalar, wide, friction_at_points, pyramid);
    });
    for_widths<double>([&](const auto& scalar, const auto& wide) {
        check_contacts<double>(scalar, wide, friction_at_points, pyramid);
    });
}

TEST(SolveWidths, GiveTheSameBitsForContacts) { check_contacts(false, false); }

TEST(SolveWidths, GiveTheSameBitsForFrictionOfEveryKind)
{
    check_contacts(true, false);
    check_contacts(false, true);
    check_contacts(true, true);
}

// Bodies as a batch has them: some of them do not move, some turn fast, some have run away.
template <class Real>
std::vector<SolverBody<Real>> random_bodies(std::mt19937& random, std::size_t count)
{
    std::vector<SolverBody<Real>> bodies;
    for (std::size_t i = 0; i < count; ++i) {
        SolverBody<Real> body = given::random_body<Real>(random);
        const double faster = std::pow(10.0, given::random_number(random, -3, 6));
        for (int k = 4; k < 7; ++k) body.motion[k] *= static_cast<Real>(faster);
        switch (random() % 8) {
        case 0:
            for (Real& number : body.inertia) number = 0;
            break;
        case 1:
            for (Real& number : body.motion) number = 0;
            break;
        case 2:
            body.motion[random() % 2 == 0 ? 1 : 6] = random() % 2 == 0
                ? std::numeric_limits<Real>::quiet_NaN()
                : static_cast<Real>(-3e16);
            break;
        default:
            break;
        }
        bodies.push_back(body);
    }
    return bodies;
}

template <class Real>
std::vector<GyroscopicInertia<Real>> random_inertias(std::mt19937& random, std::size_t count)
{
    const unsigned few = random() % 2 == 0 ? 4 : 12;  // most have one, or few
    std::vector<GyroscopicInertia<Real>> inertias(count);
    for (GyroscopicInertia<Real>& inertia : inertias) {
        const double x = given::random_number(random, 0.01, 1),
                     y = given::random_number(random, 0.01, 1), z = x + y - 0.5 * std::min(x, y);
        const Sym3 six =
            in_world_axes({x, y, z, 0, 0, 0}, exponential(given::random_vector(random, 2)));
        const double numbers[6] = {six.xx, six.yy, six.zz, six.xy, six.xz, six.yz};
        inertia = {};
        for (int k = 0; k < 6; ++k) inertia.share[k] = static_cast<Real>(numbers[k] / (x + y + z));
        inertia.share[6] = (random() % few == 0) == (few == 4) ? 0 : 1;
        if (random() % 2 == 0) continue;
        const Vec3 axis = given::random_vector(random, 1).normalized();
        for (int k = 0; k < 3; ++k) inertia.axis[k] = static_cast<Real>(axis[k]);
        inertia.axis[3] = static_cast<Real>(given::random_number(random, 1e-6, 2));
    }
    return inertias;
}

template <class Real>
void check_bodies(const SolveKernels<Real>& scalar, const SolveKernels<Real>& wide)
{
    using How = typename Substep<Real>::Gyroscopic;
    for (unsigned seed = 0; seed < 20; ++seed)
        for (std::size_t count = 0; count <= 150; count += count < 50 ? 1 : 33) {
            std::mt19937 random(seed * 100 + static_cast<unsigned>(count));
            // One more, which is nobody's business.
            std::vector<SolverBody<Real>> narrow = random_bodies<Real>(random, count + 1);
            std::vector<SolverBody<Real>> broad = narrow;
            const SolverBody<Real> last = narrow.back();
            const auto inertias = random_inertias<Real>(random, count);
            std::vector<std::uint8_t> precesses;
            for (const auto& inertia : inertias) precesses.push_back(inertia.share[6] > 0 ? 1 : 0);
            const auto how = static_cast<int>(random() % 3);
            const Substep<Real> substep{{Real(0.01), Real(-0.02), Real(-0.04)},
                                        Real(1) / 240,
                                        random() % 2 == 0,
                                        how == 0       ? How::off
                                            : how == 1 ? How::implicit
                                                       : How::direct};
            const GyroscopicInertia<Real>* spins = how == 0 ? nullptr : inertias.data();
            // One by one: each by itself, whoever else there is.
            const auto spin_of = [&](std::size_t i) {
                return spins == nullptr ? spins : spins + i;
            };
            for (std::size_t i = 0; i < count; ++i)
                scalar.begin_substep(narrow.data() + i, spin_of(i), nullptr, 1, substep);
            wide.begin_substep(broad.data(), spins, precesses.data(), count, substep);
            ASSERT_TRUE(same_bits(narrow, broad))
                << "begin_substep of " << wide.name << ", seed " << seed << ", " << count;
            const bool turns = random() % 4 != 0;
            std::size_t fast = 0;
            for (std::size_t i = 0; i < count; ++i)
                fast +=
                    scalar.advance(narrow.data() + i, spin_of(i), nullptr, 1, substep.time, turns);
            ASSERT_EQ(
                fast,
                wide.advance(broad.data(), spins, precesses.data(), count, substep.time, turns));
            ASSERT_TRUE(same_bits(narrow, broad))
                << "advance of " << wide.name << ", seed " << seed << ", " << count;
            ASSERT_TRUE(given::same_bytes(last, broad.back()));
        }
}

TEST(SolveWidths, GiveTheSameBitsForBodies)
{
    for_widths<float>(check_bodies<float>);
    for_widths<double>(check_bodies<double>);
}

TEST(SolveWidths, UnknownOnesAreNotThere)
{
    EXPECT_EQ(solve_kernels_of<float>("mmx"), nullptr);
    EXPECT_EQ(solve_kernels_of<double>(""), nullptr);
    EXPECT_NE(solve_kernels_of<float>("scalar"), nullptr);
}

}  // namespace
}  // namespace throng
