// Errors of windows: their formulas, and what other windows may come to.
#include "cost/windows/errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

BodyStates two_bodies()
{
    BodyStates states(2);
    for (BodyState& state : states) state.counts = true;
    states[1].center = Vec3(5, 0, 0);
    return states;
}

TEST(Errors, AreMeanSquaresOverBodies)
{
    const BodyStates reference = two_bodies();
    BodyStates states = reference;
    states[0].center += Vec3(0, 3, 0);
    states[1].velocity += Vec3(0, 0, 2);
    states[1].pose.orientation = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX()));
    Errors errors;
    compare(states, reference, errors);
    EXPECT_DOUBLE_EQ(of(errors, Measure::drift), 9.0 / 2);
    EXPECT_DOUBLE_EQ(of(errors, Measure::velocity), 4.0 / 2);
    EXPECT_NEAR(of(errors, Measure::turn), 0.16 / 2, 1e-12);
}

TEST(Errors, AreTheSameForAQuaternionOfTheOtherSign)
{
    const BodyStates reference = two_bodies();
    BodyStates states = reference;
    states[0].pose.orientation.coeffs() *= -1;
    Errors errors;
    compare(states, reference, errors);
    EXPECT_EQ(of(errors, Measure::turn), 0);
}

TEST(Errors, OfABodyThatIsLostAreInfinite)
{
    const BodyStates reference = two_bodies();
    BodyStates states = reference;
    states[1].counts = false;
    Errors errors;
    compare(states, reference, errors);
    EXPECT_TRUE(std::isinf(of(errors, Measure::drift)));
}

TEST(Errors, LeaveOutWhoIsNotDynamicInTheReference)
{
    BodyStates reference = two_bodies();
    reference[1].counts = false;
    BodyStates states = reference;
    states[1].center += Vec3(7, 0, 0);
    Errors errors;
    compare(states, reference, errors);
    EXPECT_EQ(of(errors, Measure::drift), 0);
}

TEST(Errors, OfOtherWindowsAreAtMostWhatIsTold)
{
    // Windows of which one in ten is ten times as bad: nothing tells a choice that has none of
    // them. Of a hundred choices some 10 are worse than what another tells.
    std::uint64_t state = 1;
    const auto drawn = [&] {
        std::vector<Errors> windows(24);
        for (Errors& window : windows) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            const double share = static_cast<double>(state >> 11) * 0x1p-53;
            of(window, Measure::drift) = share < 0.1 ? 100 : 1 + share;
        }
        return windows;
    };
    int worse = 0;
    for (int round = 0; round < 200; ++round) {
        const double promised = rms_at_most(drawn(), place_of(Measure::drift));
        worse += rms(drawn(), place_of(Measure::drift)) > promised ? 1 : 0;
    }
    EXPECT_LE(worse, 24);
    EXPECT_GE(worse, 2);
}

TEST(Errors, HaveNamesUnitsAndWordsForWhoErrs)
{
    for (const std::string_view name : measure_names())
        EXPECT_EQ(info(measure_named(name)).name, name);
    EXPECT_EQ(info(Measure::drift).unit, "m");
    EXPECT_THROW(measure_named("drft"), std::invalid_argument);
}

}  // namespace
}  // namespace throng
