// The hard cases that are claimed, run as the command runs them, and shown able to fail.
#include "cost/hard_cases/cases.hpp"

#include <gtest/gtest.h>

#include <map>

namespace throng {
namespace {

class HardCases : public testing::TestWithParam<HardCase> { };

std::vector<CaseResult> run(const HardCase& which, int threads = 1)
{
    return run_case(which, {}, Fault::none, threads, Extent::brief);
}

std::string told(const CaseResult& result)
{
    return result.name + ", " + result.setting + ": " + result.quantity + " is "
        + std::to_string(result.figure) + ", bound " + std::to_string(result.bound);
}

// Of memory and undefined behaviour a case shows what it has to show in its first steps, on one
// thread: a checker, by which all takes ten times as long, looks at these.
#ifdef __SANITIZE_ADDRESS__
constexpr bool kIsChecked = true;
#else
constexpr bool kIsChecked = false;
#endif
constexpr int kCheckedSteps = 500;

// With the same figures on three threads.
TEST_P(HardCases, KeepsItsBounds)
{
    std::size_t runs = 0;
    int steps = 0;
    CaseListener listener;
    listener.ran = [&](const CaseRun&) { ++runs; };
    if (kIsChecked) listener.enough = [&] { return ++steps > kCheckedSteps; };
    const std::vector<CaseResult> results =
        run_case(GetParam(), {}, Fault::none, 1, Extent::brief, listener);
    if (steps <= kCheckedSteps) {
        ASSERT_FALSE(results.empty());
        EXPECT_EQ(runs == 0, GetParam().asks_alone);
    }
    for (const CaseResult& result : results) {
        EXPECT_NE(result.verdict, Verdict::fail) << told(result);
        EXPECT_TRUE(result.verdict == Verdict::pass || !result.why.empty()) << told(result);
    }
    if (kIsChecked) return;
    const std::vector<CaseResult> three = run(GetParam(), 3);
    ASSERT_EQ(results.size(), three.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (results[i].unit == "ns") continue;  // a time is never the same twice
        EXPECT_EQ(results[i].figure, three[i].figure);
    }
}

// Its lines until one is seen that is looked for.
template <class Sought>
std::vector<CaseResult> run_until(const HardCase& which, Fault fault, const Sought& sought)
{
    bool seen = false;
    CaseListener listener;
    listener.line = [&](const CaseResult& result) { seen = seen || sought(result); };
    listener.enough = [&] { return seen; };
    return run_case(which, {}, fault, 1, Extent::brief, listener);
}

// A method that measures, and whose lines a fault leaves alone, is not looked at by its case.
TEST_P(HardCases, NoticesAPlantedFaultInEveryMethod)
{
    const bool is_of_methods = GetParam().shown_by == Fault::nudge;
    const std::vector<CaseResult> results =
        run_until(GetParam(), GetParam().shown_by, [&](const CaseResult& result) {
            return !is_of_methods && result.verdict == Verdict::fail;
        });
    std::size_t failed = 0, skipped = 0;
    std::map<std::string, bool> measures, noticed;
    for (const CaseResult& result : results) {
        failed += result.verdict == Verdict::fail ? 1 : 0;
        skipped += result.verdict == Verdict::skipped ? 1 : 0;
        measures[result.method] |=
            result.bound > 0 && result.quantity.find("rounds") == std::string::npos;
        noticed[result.method] |= result.verdict == Verdict::fail;
    }
    if (skipped == results.size()) GTEST_SKIP() << results.front().why;
    EXPECT_GT(failed, 0u) << GetParam().name << " passes with a fault in it";
    if (!is_of_methods) return;
    for (const auto& [method, has_figures] : measures)
        if (!method.empty() && has_figures) {
            EXPECT_TRUE(noticed[method]) << GetParam().name << " passes with a fault in " << method;
        }
}

INSTANTIATE_TEST_SUITE_P(Catalogue,
                         HardCases,
                         testing::ValuesIn(hard_cases().begin(), hard_cases().end()),
                         [](const auto& one) { return std::string(one.param.name); });

// What a case's own fault leaves alone, and the fault that it is noticed by.
struct OtherFault {
    const char* name;
    Fault fault;
    const char* quantity;
};

class OtherFaults : public testing::TestWithParam<OtherFault> { };

TEST_P(OtherFaults, AreNoticedInTheQuantityThatTheyChange)
{
    const OtherFault& one = GetParam();
    bool looked_at = false, noticed = false;
    run_until(*find_case(one.name), one.fault, [&](const CaseResult& result) {
        const bool is_of_it = result.quantity == one.quantity;
        looked_at |= is_of_it;
        noticed |= is_of_it && result.verdict == Verdict::fail;
        return noticed;
    });
    EXPECT_TRUE(looked_at) << one.name << " has no line of " << one.quantity;
    EXPECT_TRUE(noticed) << one.name << " passes with a fault in " << one.quantity;
}

// clang-format off
constexpr OtherFault kOtherFaults[] = {
    {"H7",  Fault::skew, "way apart of equal bodies"},
    {"H7",  Fault::haste, "velocity error"},
    {"H8",  Fault::sink, "greatest overlap"},
    {"H8",  Fault::skew, "speed after 10 s"},
    {"H9",  Fault::sink, "greatest overlap over the smallest box"},
    {"H9",  Fault::sink, "way that the top one sank"},
    {"H10", Fault::grip, "falls: wrong outcomes"},
    {"H12", Fault::haste, "way off the line over the way"},
    {"H15", Fault::sink, "overlap"},
    {"H15", Fault::restitution, "error of the time to rest"},
    {"H16", Fault::sink, "greatest overlap"},
    {"H16", Fault::sink, "mean over steps of the squared overlaps"},
    {"H17", Fault::restitution, "error of the velocities"},
    {"H17", Fault::skew, "difference of the mirror images"},
    {"H18", Fault::haste, "error of the energy"},
    {"H18", Fault::skew, "difference of the mirror images"},
    {"H18", Fault::skew, "difference by the order of bodies"},
    {"H21", Fault::sink, "greatest overlap"},
    {"H21", Fault::haste, "growth of energy in a step over the first"},
    {"H21", Fault::haste, "growth of energy over the first"},
    {"H21", Fault::skew, "speed at the end"},
    {"H22", Fault::grip, "falls: wrong outcomes"},
    {"H23", Fault::haste, "error of the wedge's acceleration"},
    {"H24", Fault::grip, "stays: wrong outcomes"},
    {"H24", Fault::skew, "off its straight way"},
    {"H76", Fault::whirl, "fastest spin"},
    {"H102", Fault::friction, "mean squared error of the velocities"},
    {"H102", Fault::restitution, "mean squared error of the energy"},
    {"H102", Fault::sink, "mean squared overlaps, added up"},
};
// clang-format on

// By case and place in the list: a fault has no name that a test's may have.
INSTANTIATE_TEST_SUITE_P(Planted,
                         OtherFaults,
                         testing::ValuesIn(kOtherFaults),
                         [](const auto& info) {
                             return std::string(info.param.name) + "_" + std::to_string(info.index);
                         });

TEST(HardCaseNames, AreFoundWhateverTheCaseOfLetters)
{
    EXPECT_EQ(find_case("h8")->name, "H8");
    EXPECT_EQ(find_case("H33")->name, "H33");
    EXPECT_EQ(find_case("H"), nullptr);
    EXPECT_EQ(find_case(""), nullptr);
}

}  // namespace
}  // namespace throng
