#include "kernels/dynamics/integrators.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace throng {

namespace {

std::size_t numbers_of(const MotionLaw& law) { return law.places() + law.speeds(); }

// Room for so many rows of a state's length.
double* rows(const MotionLaw& law, std::size_t count, IntegratorScratch& scratch)
{
    scratch.resize(std::max(scratch.size(), count * numbers_of(law)));
    return scratch.data();
}

void all_rates(MotionLaw& law, double time, const double* state, double* rates)
{
    law.place_rates(state, rates);
    law.speed_rates(time, state, rates + law.places());
}

// out = from + span * rates, over a whole state.
void follow(const MotionLaw& law, const double* from, double span, const double* rates, double* out)
{
    for (std::size_t i = 0; i < numbers_of(law); ++i) out[i] = from[i] + span * rates[i];
}

void semi_implicit(
    MotionLaw& law, double time, double span, IntegratorScratch& scratch, double* state)
{
    double* const rates = rows(law, 1, scratch);
    law.kick(time, span, state);
    law.gyrate(span, state);
    law.place_rates(state, rates);
    for (std::size_t i = 0; i < law.places(); ++i) state[i] += span * rates[i];
}

void euler(MotionLaw& law, double time, double span, IntegratorScratch& scratch, double* state)
{
    double* const rates = rows(law, 1, scratch);
    all_rates(law, time, state, rates);
    follow(law, state, span, rates, state);
}

void midpoint(MotionLaw& law, double time, double span, IntegratorScratch& scratch, double* state)
{
    double* const rates = rows(law, 2, scratch);
    double* const middle = rates + numbers_of(law);
    all_rates(law, time, state, rates);
    follow(law, state, 0.5 * span, rates, middle);
    all_rates(law, time + 0.5 * span, middle, rates);
    follow(law, state, span, rates, state);
}

void splitting(MotionLaw& law, double time, double span, IntegratorScratch&, double* state)
{
    law.kick(time, 0.5 * span, state);
    law.drift(span, state);
    law.kick(time + span, 0.5 * span, state);
}

// What only falls.
void fall(MotionLaw& law, double time, double span, IntegratorScratch&, double* state)
{
    law.kick(time, span, state);
    law.drift(span, state);
}

void rk4(MotionLaw& law, double time, double span, IntegratorScratch& scratch, double* state)
{
    const std::size_t n = numbers_of(law);
    double* const first = rows(law, 5, scratch);
    double* const second = first + n;
    double* const third = second + n;
    double* const fourth = third + n;
    double* const stage = fourth + n;
    all_rates(law, time, state, first);
    follow(law, state, 0.5 * span, first, stage);
    all_rates(law, time + 0.5 * span, stage, second);
    follow(law, state, 0.5 * span, second, stage);
    all_rates(law, time + 0.5 * span, stage, third);
    follow(law, state, span, third, stage);
    all_rates(law, time + span, stage, fourth);
    for (std::size_t i = 0; i < n; ++i)
        state[i] += span / 6 * ((first[i] + fourth[i]) + 2 * (second[i] + third[i]));
}

// x'' = -2 ratio x' - x.
class Oscillation : public MotionLaw {
public:
    explicit Oscillation(double ratio) : ratio_(ratio) { }
    std::size_t places() const override { return 1; }
    std::size_t speeds() const override { return 1; }
    void place_rates(const double* state, double* rates) override { rates[0] = state[1]; }
    void speed_rates(double, const double* state, double* rates) override
    {
        rates[0] = -state[0] - 2 * ratio_ * state[1];
    }
    void kick(double time, double span, double* state) override
    {
        double rate = 0;
        speed_rates(time, state, &rate);
        state[1] += span * rate;
    }
    void gyrate(double, double*) override { }
    void drift(double span, double* state) override { state[0] += span * state[1]; }

private:
    double ratio_;
};

// Whether no state grows from step to step: the eigenvalues of the matrix of a step, which has
// trace t and determinant d, are within the unit circle where |t| <= 1 + d and |d| <= 1.
bool bounded(const IntegratorRow& integrator, double ratio, double span)
{
    constexpr double kRounding = 4e-15;
    Oscillation law(ratio);
    IntegratorScratch scratch;
    double x[2] = {1, 0}, y[2] = {0, 1};
    integrator.advance(law, 0, span, scratch, x);
    integrator.advance(law, 0, span, scratch, y);
    const double trace = x[0] + y[1], determinant = x[0] * y[1] - x[1] * y[0];
    return std::abs(trace) <= 1 + determinant + kRounding && std::abs(determinant) <= 1 + kRounding;
}

// What a spin does to itself swings at sqrt(2) times its rate at most: rk4 bears 2 sqrt(2) of a
// swing's phase. The two others gain at any: midpoint up to 0.4 % a span at a quarter of a radian.
constexpr double kOfRk4 = 2, kOfGrowing = 0.25, kAny = std::numeric_limits<double>::infinity();

constexpr IntegratorRow kIntegrators[] = {
    {Integrator::semi_implicit, "semi_implicit", 1, kAny, semi_implicit},
    {Integrator::euler, "euler", 1, kOfGrowing, euler},
    {Integrator::midpoint, "midpoint", 2, kOfGrowing, midpoint},
    {Integrator::splitting, "splitting", 2, kAny, splitting},
    {Integrator::rk4, "rk4", 4, kOfRk4, rk4},
};
constexpr IntegratorRow kFall = {Integrator::auto_, "auto", 1, kAny, fall};

}  // namespace

std::span<const IntegratorRow> integrators() { return kIntegrators; }

const IntegratorRow& chosen(Integrator integrator, bool acted_on)
{
    if (integrator == Integrator::auto_ && !acted_on) return kFall;
    if (integrator == Integrator::auto_) integrator = Integrator::splitting;
    return kIntegrators[static_cast<std::size_t>(integrator) - 1];
}

double stable_span(const IntegratorRow& integrator, double ratio)
{
    // No explicit method of so few stages gets as far as this. A method of order p that grows does
    // so by span^(p + 1) or more, which rounding hides below the step.
    constexpr double kFurthest = 16, kStep = 1.0 / 64;
    double low = 0;
    while (low < kFurthest && bounded(integrator, ratio, low + kStep)) low += kStep;
    double high = low + kStep;
    for (int k = 0; k < 48; ++k) {
        const double middle = 0.5 * (low + high);
        (bounded(integrator, ratio, middle) ? low : high) = middle;
    }
    return low < 1e-3 ? 0 : low;
}

}  // namespace throng
