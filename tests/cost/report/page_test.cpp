// Report: the page and the chart of a sweep hold what was found, and nothing else.
#include "cost/report/cost_report.hpp"
#include "tests/cost/sweep/made_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace throng {
namespace {

CostReport report()
{
    CostReport made;
    made.scene = "a<b>&\"c\"";
    made.wish.error = 2e-3;
    made.found.points = {made_point(1, 1e-2, {}), made_point(2, 1e-3, {{"substeps", "8"}}),
                         made_point(4, 1e-4, {{"substeps", "16"}}),
                         made_point(9, 1e-2, {{"dt", "1/120"}}),
                         made_point(9, NAN, {{"solver", "pgs"}})};
    made.found.points.emplace_back();
    made.found.points.back().trouble = "takes <too> long";
    mark_front(made.found.points, kDrift);
    return made;
}

std::size_t count(const std::string& text, std::string_view what)
{
    std::size_t found = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
}

TEST(CostChart, HasADotForEachErrorAndALineForEachDial)
{
    std::ostringstream out;
    write_cost_svg(report(), out);
    const std::string svg = out.str();
    EXPECT_EQ(svg.find("<svg "), 0u);
    EXPECT_EQ(count(svg, "data-point="), 4u) << svg;
    EXPECT_EQ(count(svg, "<polyline class=\"dial "), 2u) << "substeps, dt";
    EXPECT_EQ(count(svg, "<polyline class=\"front\""), 1u);
    EXPECT_EQ(count(svg, " advised\""), 2u) << "the dot, and the one that explains it";
    EXPECT_NE(svg.find("substeps=8: drift 0.001 m, 2 ms, on the front"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("inf"), std::string::npos) << svg;
}

TEST(CostChart, SaysWhereNothingIsToBeDrawn)
{
    CostReport none = report();
    none.found.points.resize(1);
    none.found.points[0].errors.assign(4, Errors{});
    std::ostringstream out;
    write_cost_svg(none, out);
    EXPECT_NE(out.str().find("no setting has an error above 0"), std::string::npos) << out.str();
}

TEST(CostPage, HasTheTimeOfEachStageWhereTheyWereTimed)
{
    CostReport made = report();
    const auto page_of = [&] {
        std::ostringstream out;
        write_cost_page(made, out);
        return out.str();
    };
    EXPECT_EQ(page_of().find("Time by stage"), std::string::npos);
    made.stages = {{"find_pairs", 0.25}, {"relax", 0.5}};
    made.advised_stages = {{"find_pairs", 0.125}, {"solve_direct", 2}};
    const std::string page = page_of();
    EXPECT_NE(page.find("<tr><td>find_pairs</td><td data-value=\"0.25\">0.25</td>"
                        "<td data-value=\"0.125\">0.12</td></tr>"),
              std::string::npos)
        << page;
    EXPECT_NE(page.find("<tr><td>relax</td><td data-value=\"0.5\">0.5</td><td></td></tr>"),
              std::string::npos);
    EXPECT_NE(page.find("<tr><td>solve_direct</td><td></td><td data-value=\"2\">2</td></tr>"),
              std::string::npos);
}

TEST(CostPage, HoldsAllOfItAndLoadsNothing)
{
    std::ostringstream out;
    write_cost_page(report(), out);
    const std::string page = out.str();
    EXPECT_EQ(page.find("{{"), std::string::npos);
    EXPECT_EQ(page.find("<b>"), std::string::npos) << "of the scene's name";
    EXPECT_NE(page.find("a&lt;b&gt;&amp;&quot;c&quot;: what accuracy costs"), std::string::npos);
    EXPECT_NE(page.find("takes &lt;too&gt; long"), std::string::npos);
    EXPECT_EQ(count(page, "<tr data-point="), 6u);
    EXPECT_NE(page.find("the cheapest within 0.002 m:\n  --set substeps=8"), std::string::npos);
    EXPECT_NE(page.find("1 setting whose error is 0 or beyond all bounds, not drawn"),
              std::string::npos);
    for (const char* const loads : {" src=", "@import", "url(", "<iframe"})
        EXPECT_EQ(page.find(loads), std::string::npos) << loads;
    EXPECT_EQ(count(page, "href="), 1u) << "the icon that there is none";
    EXPECT_EQ(count(page, "http"), 1u) << "what SVG is called";
}

TEST(CostPage, TellsOtherErrorsOfTheAdviceAndWhichDialsDidNotMatter)
{
    CostReport made = report();
    made.found.points.push_back(made_point(3, 1e-2, {{"broadphase", "grid"}}));
    for (Errors& errors : made.found.points[1].errors) {
        of(errors, Measure::momentum) = 0.25;
        of(errors, Measure::missed_contacts) = 0.04;
    }
    std::ostringstream page, text, json, csv;
    write_cost_page(made, page);
    write_cost_text(made, text);
    write_cost_json(made, json);
    write_cost_csv(made, csv);
    for (const std::string& told : {page.str(), text.str()}) {
        EXPECT_NE(told.find("momentum 0.5 N s, "), std::string::npos) << told;
        EXPECT_NE(told.find("missed_contacts 0.2, "), std::string::npos) << told;
        EXPECT_NE(told.find("\ndid not matter here, errors alike: dt, broadphase\n"),
                  std::string::npos)
            << told;
    }
    EXPECT_NE(json.str().find("\"idle_dials\": [\"dt\", \"broadphase\"]"), std::string::npos)
        << json.str();
    EXPECT_NE(json.str().find("\"momentum\": 0.5"), std::string::npos);
    const std::string heads = csv.str().substr(0, csv.str().find('\n'));
    for (const char* const head :
         {"momentum_N_s", "complementarity_m/s", "friction_cone_m/s", "missed_contacts_1",
          "missed_contacts_at_most_1", "force_error_1"})
        EXPECT_NE(heads.find(std::string(",") + head + ','), std::string::npos) << heads;
    std::istringstream lines(text.str());
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.find("besides:") == std::string::npos ? 0 : line.size(), 80u) << line;
}

TEST(CostPage, IsSmallForManySettings)
{
    CostReport many = report();
    for (int i = 0; i < 500; ++i)
        many.found.points.push_back(made_point(1 + i, 1e-2 / (1 + i), {{"substeps", "17"}}));
    std::ostringstream out;
    write_cost_page(many, out);
    EXPECT_LT(out.str().size(), 1000000u);
}

}  // namespace
}  // namespace throng
