// Integrators: orders on a law that they know nothing of, and how long a step may be.
#include "kernels/dynamics/integrators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace throng {
namespace {

// A planet about a sun at the origin: two places, two speeds.
class Orbit : public MotionLaw {
public:
    std::size_t places() const override { return 2; }
    std::size_t speeds() const override { return 2; }
    void place_rates(const double* state, double* rates) override
    {
        rates[0] = state[2];
        rates[1] = state[3];
    }
    void speed_rates(double, const double* state, double* rates) override
    {
        const double cube = std::pow(state[0] * state[0] + state[1] * state[1], 1.5);
        rates[0] = -state[0] / cube;
        rates[1] = -state[1] / cube;
    }
    void kick(double time, double span, double* state) override
    {
        double rates[2];
        speed_rates(time, state, rates);
        for (int k = 0; k < 2; ++k) state[2 + k] += span * rates[k];
    }
    void gyrate(double, double*) override { }
    void drift(double span, double* state) override
    {
        for (int k = 0; k < 2; ++k) state[k] += span * state[2 + k];
    }
};

// How far from its place it is after a quarter of an orbit. After a whole one, what a method of
// first order is off by on the way there is made good on the way back.
double error_after_quarter(const IntegratorRow& integrator, int steps)
{
    Orbit law;
    IntegratorScratch scratch;
    double state[4] = {1, 0, 0, 1};
    const double span = 0.5 * std::numbers::pi / steps;
    for (int i = 0; i < steps; ++i) integrator.advance(law, i * span, span, scratch, state);
    return std::hypot(state[0], state[1] - 1);
}

TEST(Integrators, HaveTheOrdersThatTheyState)
{
    for (const IntegratorRow& integrator : integrators()) {
        const double coarse = error_after_quarter(integrator, 250);
        const double fine = error_after_quarter(integrator, 500);
        EXPECT_NEAR(std::log2(coarse / fine), integrator.order, 0.15) << integrator.name;
    }
}

TEST(Integrators, AreTheOnesThatAreAskedFor)
{
    for (const IntegratorRow& row : integrators())
        for (const bool acted_on : {false, true})
            EXPECT_EQ(chosen(row.which, acted_on).name, row.name);
    EXPECT_EQ(chosen(Integrator::auto_, true).name, "splitting");
    EXPECT_EQ(chosen(Integrator::auto_, false).name, "auto");
}

// Roots of each method's polynomial, worked out by hand.
TEST(StableSpan, IsThatOfTheory)
{
    const auto span = [](Integrator which, double ratio) {
        return stable_span(chosen(which, true), ratio);
    };
    for (const double ratio : {0.0, 0.1, 1.0, 3.0})
        EXPECT_NEAR(span(Integrator::semi_implicit, ratio),
                    2 * (std::sqrt(1 + ratio * ratio) - ratio), 1e-6);
    EXPECT_NEAR(span(Integrator::splitting, 0), 2, 1e-6);
    EXPECT_NEAR(span(Integrator::rk4, 0), 2 * std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(span(Integrator::euler, 0.1), 0.2, 1e-6);
    EXPECT_EQ(span(Integrator::euler, 0), 0);
    EXPECT_EQ(span(Integrator::midpoint, 0), 0);
}

}  // namespace
}  // namespace throng
