// Dials: one table, every value of it settable or refused with a reason.
#include "throng/dials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace throng {
namespace {

TEST(Dials, AreAllThere)
{
    const char* const names[] = {"dt",
                                 "substeps",
                                 "iterations",
                                 "contact_rate",
                                 "push_limit",
                                 "friction_at",
                                 "precision",
                                 "integrator",
                                 "rotation",
                                 "gyroscopic",
                                 "broadphase",
                                 "narrowphase",
                                 "method_start",
                                 "bounds_filter",
                                 "nonconvex",
                                 "voxel_size",
                                 "image_resolution",
                                 "sphere_levels",
                                 "max_parts",
                                 "response",
                                 "solver",
                                 "direct_limit",
                                 "penalty_stiffness",
                                 "penalty_damping",
                                 "friction_cone",
                                 "impact_law",
                                 "overlap",
                                 "halvings",
                                 "toi_method",
                                 "toi_tolerance",
                                 "sleep",
                                 "escalation",
                                 "relax_iterations",
                                 "mesh_tree",
                                 "effects",
                                 "effects_error",
                                 "partial_rest",
                                 "rest_force"};
    for (const char* name : names) EXPECT_NE(find_dial(name), nullptr) << name;
    EXPECT_EQ(find_dial("speed"), nullptr);

    std::set<std::string_view> seen;
    for (const Dial& dial : dials()) {
        EXPECT_TRUE(seen.insert(dial.name).second) << dial.name;
        EXPECT_FALSE(dial.values.empty()) << dial.name;
        EXPECT_FALSE(dial.trades.empty()) << dial.name;
    }
}

TEST(Dials, TakeTheirDefaults)
{
    for (const Dial& dial : dials()) {
        Settings settings;
        EXPECT_EQ(set_dial(settings, dial.name, dial.default_value), "");
        EXPECT_EQ(dial_value(settings, dial.name), dial.default_value);
        EXPECT_EQ(dial_value(Settings{}, dial.name), dial.default_value);
    }
}

TEST(Dials, TakeEveryValueOnOfferAndRefuseTheOthersByName)
{
    for (const Dial& dial : dials()) {
        for (const Choice& choice : dial.choices) {
            Settings settings;
            const std::string answer = set_dial(settings, dial.name, choice.text);
            if (choice.available) {
                EXPECT_EQ(answer, "");
                EXPECT_EQ(dial_value(settings, dial.name), choice.text);
            } else {
                EXPECT_NE(answer.find("\"" + std::string(choice.text)
                                      + "\" is not available in this build"),
                          answer.npos)
                    << answer;
                EXPECT_EQ(answer.find(std::string(dial.name) + ": wanted "), 0u) << answer;
                EXPECT_EQ(dial_value(settings, dial.name), dial.default_value);
            }
        }
    }
}

TEST(Dials, ValuesSetBackGiveTheSame)
{
    const char* const all[][2] = {{"dt", "0.01"},
                                  {"dt", "1/60"},
                                  {"dt", "1/240"},
                                  {"dt", "0.016666"},
                                  {"dt", "1e-9"},
                                  {"dt", "1/7"},
                                  {"dt", "3/7"},
                                  {"dt", "10000"},
                                  {"substeps", "1000"},
                                  {"substeps", "1"},
                                  {"substeps", "1e2"},
                                  {"iterations", "7"},
                                  {"iterations", "auto"},
                                  {"contact_rate", "auto"},
                                  {"contact_rate", "0.3"},
                                  {"contact_rate", "fixed:30"},
                                  {"contact_rate", "fixed:0.1"},
                                  {"push_limit", "0"},
                                  {"push_limit", "0.1"},
                                  {"precision", "double"},
                                  {"sleep", "off"},
                                  {"broadphase", "all_pairs"},
                                  {"toi_tolerance", "0.0001"},
                                  {"solver", "direct"},
                                  {"impact_law", "simultaneous"},
                                  {"direct_limit", "20"},
                                  {"effects", "auto"},
                                  {"effects_error", "0.001"},
                                  {"partial_rest", "on"},
                                  {"rest_force", "0.1"}};
    for (const auto& [name, value] : all) {
        Settings first, second;
        ASSERT_EQ(set_dial(first, name, value), "");
        ASSERT_EQ(set_dial(second, name, dial_value(first, name)), "");
        EXPECT_EQ(dial_value(first, name), dial_value(second, name)) << name << ' ' << value;
        EXPECT_EQ(first.dt, second.dt) << value;
        EXPECT_EQ(first.contact_rate, second.contact_rate) << value;
        EXPECT_EQ(first.contact_hertz, second.contact_hertz) << value;
        EXPECT_EQ(first.push_limit, second.push_limit) << value;
    }
    Settings settings;
    EXPECT_EQ(dial_value(settings, "dt"), "1/60");
    ASSERT_EQ(set_dial(settings, "dt", "0.01"), "");
    EXPECT_EQ(dial_value(settings, "dt"), "0.01");
}

TEST(Dials, SayWhatWasWanted)
{
    const char* const all[][3] = {
        {"substeps", "x", "substeps: wanted a whole number from 1 to 1000, not \"x\""},
        {"substeps", "0", "substeps: wanted a whole number from 1 to 1000, not \"0\""},
        {"substeps", "1001", "substeps: wanted a whole number from 1 to 1000, not \"1001\""},
        {"substeps", "2.5", "substeps: wanted a whole number from 1 to 1000, not \"2.5\""},
        {"substeps", "", "substeps: wanted a whole number from 1 to 1000, not \"\""},
        {"substeps", "nan", "substeps: wanted a whole number from 1 to 1000, not \"nan\""},
        {"substeps", "4 ", "substeps: wanted a whole number from 1 to 1000, not \"4 \""},
        {"dt", "0", "dt: wanted a time from 1e-9 to 1e4 s"},
        {"dt", "-1", "dt: wanted a time"},
        {"dt", "1/0", "dt: wanted a time"},
        {"dt", "1/60/2", "dt: wanted a time"},
        {"dt", "inf", "dt: wanted a time"},
        {"contact_rate", "fixed:", "contact_rate: wanted auto, a number above 0"},
        {"contact_rate", "fixed:-3", "contact_rate: wanted auto, a number above 0"},
        {"contact_rate", "0", "contact_rate: wanted auto, a number above 0"},
        {"contact_rate", "2", "contact_rate: wanted auto, a number above 0 and up to 1"},
        {"push_limit", "-1", "push_limit: wanted a speed from 0 to 1e6 m/s"},
        {"precision", "half", "precision: wanted float or double, not \"half\""},
        {"solver", "exact", "solver: wanted soft_step, pgs or direct, not \"exact\""},
        {"direct_limit", "0", "direct_limit: wanted a whole number from 1 to 100000, not \"0\""},
        {"sleep", "true", "sleep: wanted on or off, not \"true\""},
        {"voxel_size", "-1", "voxel_size: wanted auto or a length from 1e-9 to 1e9 m"},
        {"image_resolution", "2", "image_resolution: wanted auto or a whole number from 4 to 512"},
        {"sphere_levels", "2.5", "sphere_levels: wanted auto or a whole number from 1 to 6"},
        {"effects", "all", "effects: wanted called or auto, not \"all\""},
        {"effects_error", "2", "effects_error: wanted a share of the radius from 0 to 1, not"},
        {"partial_rest", "true", "partial_rest: wanted off or on, not \"true\""},
        {"rest_force", "2", "rest_force: wanted a share of the load from 1e-6 to 1, not"},
        {"toi_tolerance", "1e-13", "toi_tolerance: wanted a share of the shape's size from 1e-12"},
        {"substep", "4", "substep: wanted the name of a dial, perhaps substeps"},
        {"presicion", "4", "presicion: wanted the name of a dial, perhaps precision"},
        {"zzzzzzzzz", "4", "zzzzzzzzz: wanted the name of a dial, one of: dt, substeps"},
    };
    for (const auto& [name, value, expected] : all) {
        Settings settings;
        const std::string answer = set_dial(settings, name, value);
        EXPECT_EQ(answer.substr(0, std::string(expected).size()), expected);
    }
}

TEST(Dials, StayAsTheyWereWhenRefused)
{
    for (const Dial& dial : dials()) {
        Settings settings;
        EXPECT_NE(set_dial(settings, dial.name, "no such value"), "") << dial.name;
        for (const Dial& other : dials())
            EXPECT_EQ(dial_value(settings, other.name), other.default_value);
    }
}

TEST(ParseTime, ReadsNumbersAndFractions)
{
    EXPECT_EQ(parse_time("1/60"), 1.0 / 60);
    EXPECT_EQ(parse_time("0.25"), 0.25);
    EXPECT_EQ(parse_time("1e-3"), 1e-3);
    EXPECT_EQ(parse_time("3/4"), 0.75);
    for (const char* bad : {"", "/", "1/", "/2", "1/0", "0/0", "1//2", "a", "1 /60", "1e999", "+1",
                            "0x1", "inf", "1/2s"})
        EXPECT_TRUE(std::isnan(parse_time(bad))) << bad;
}

}  // namespace
}  // namespace throng
