// Methods: every way to ask about two convex shapes side by side: what it takes, how far off it is,
// how often it is wrong or does not know; and where touch is told with points, which of separating
// axes and GJK does it in less.
//
//   methods_perf [--quick] [--json FILE]
//
// All take turns over the same pairs in the same poses, and of each the best turn counts: thread
// processor time, ns of one question. Placing a pair is not counted, but for points of contact.
#include "perf/narrowphase/contact_figures.hpp"
#include "perf/narrowphase/method_figures.hpp"
#include "scene/files/json.hpp"
#include "scene/files/json_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string_view>

namespace throng::perf {
namespace {

// ----------------------------------------------------------------------------------------- output

// Three digits, in the unit that makes them readable.
std::string time_text(double ns)
{
    if (std::isnan(ns)) return "-";
    std::array<char, 32> text;
    const bool micro = ns >= 9999.5;
    const double figure = micro ? ns / 1000 : ns;
    std::snprintf(text.data(), text.size(), "%.*f%s", figure < 10 ? 1 : 0, figure,
                  micro ? "us" : "");
    return text.data();
}

std::string share_text(int part, int all)
{
    if (part == 0) return "0";
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.2g", static_cast<double>(part) / all);
    return text.data();
}

using Pick = double (*)(const Row&);

// The worth of a method in one kind of meeting, over all builds.
std::string worth_text(const std::vector<Row>& rows, std::string_view method, const char* pair_case)
{
    Worth all;
    for (const Row& row : rows) {
        if (row.method != method || row.pair_case != pair_case) continue;
        all.asked += row.worth.asked;
        all.wrong += row.worth.wrong;
        all.undecided += row.worth.undecided;
        if (!std::isnan(row.worth.error)) all.add_error(row.worth.error_of, row.worth.error);
    }
    std::array<char, 96> text;
    std::array<char, 32> error{"-"};
    if (!std::isnan(all.error))
        std::snprintf(error.data(), error.size(), "%.1e %s", all.error, all.error_of.c_str());
    std::snprintf(text.data(), text.size(), "  %-17s %6s %6s", error.data(),
                  share_text(all.wrong, all.asked).c_str(),
                  share_text(all.undecided, all.asked).c_str());
    return text.data();
}

void print_methods(const std::vector<Row>& rows,
                   const std::vector<Build>& builds,
                   const char* title,
                   Pick first,
                   Pick second,
                   bool worth)
{
    std::printf("\n%s\n\n%-9s %-12s", title, "", "");
    for (const Build& build : builds) std::printf(" %15s", build.name.c_str());
    std::printf("%s\n", worth ? "  error             wrong  undecided" : "");
    for (const PairCase& pair_case : kPairCases)
        for (const ConvexMethod& method : convex_methods()) {
            std::printf("%-9s %-12s", pair_case.name, std::string(method.name).c_str());
            for (const Build& build : builds) {
                const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& one) {
                    return one.method == method.name && one.build == build.name
                        && one.pair_case == pair_case.name;
                });
                const std::string text = row == rows.end()
                    ? "-"
                    : time_text(first(*row)) + "/" + time_text(second(*row));
                std::printf(" %15s", text.c_str());
            }
            std::printf("%s\n", worth ? worth_text(rows, method.name, pair_case.name).c_str() : "");
        }
}

void print_contacts(const std::vector<ContactRow>& rows)
{
    std::printf("\nWith points of contact, warm: ns of a pair, placing it included\n\n"
                "%-14s %-9s %-6s %10s %10s %12s %12s\n",
                "", "", "motion", "gjk", "sat", "auto float", "auto double");
    for (const ContactRow& row : rows)
        std::printf("%-14s %-9s %-6s %10s %10s %12s %12s\n", row.build.c_str(),
                    std::string(row.pair_case).c_str(), std::string(row.motion).c_str(),
                    time_text(row.gjk).c_str(), time_text(row.sat).c_str(),
                    time_text(row.auto_float).c_str(), time_text(row.auto_double).c_str());
}

std::string number_or_null(double number)
{
    return std::isnan(number) ? "null" : json_text(number);
}

bool write_json(const char* file,
                const std::vector<Row>& rows,
                const std::vector<ContactRow>& contacts,
                double unproved)
{
    std::ofstream out(file);
    out << "{\n\"unproved_m\": " << json_text(unproved) << ",\n\"methods\": [";
    const char* between = "\n";
    for (const Row& row : rows) {
        JsonMembers members;
        members.add("method", json_string(row.method));
        members.add("separation", json_string(row.pair_case));
        members.add("vertices", json_string(row.build));
        members.add("cold_ns", number_or_null(row.cold));
        members.add("plain_ns", number_or_null(row.plain));
        members.add("warm_small_ns", number_or_null(row.warm_small));
        members.add("warm_large_ns", number_or_null(row.warm_large));
        members.add("error_of", json_string(row.worth.error_of));
        members.add("error", number_or_null(row.worth.error));
        members.add("asked", json_text(row.worth.asked));
        members.add("wrong", json_text(row.worth.wrong));
        members.add("undecided", json_text(row.worth.undecided));
        out << between << members.text();
        between = ",\n";
    }
    out << "],\n\"contacts\": [";
    between = "\n";
    for (const ContactRow& row : contacts) {
        JsonMembers members;
        members.add("pair", json_string(row.build));
        members.add("separation", json_string(row.pair_case));
        members.add("motion", json_string(row.motion));
        members.add("gjk_ns", number_or_null(row.gjk));
        members.add("sat_ns", number_or_null(row.sat));
        members.add("auto_float_ns", number_or_null(row.auto_float));
        members.add("auto_double_ns", number_or_null(row.auto_double));
        out << between << members.text();
        between = ",\n";
    }
    out << "]\n}\n";
    return static_cast<bool>(out.flush());
}

// -------------------------------------------------------------------------------------------- all

int run(bool quick, const char* json)
{
    const Effort effort = quick ? Effort{12, 3, 5e-4, 4} : Effort{};
    std::vector<Build> builds{{"box", 0, 0}};
    for (const std::size_t vertices : {8, 32, 128, 1000, 10000})
        if (!quick || vertices <= kMostAxes)
            builds.push_back({std::to_string(vertices), vertices, vertices});
    std::vector<Row> rows;
    double unproved = 0;
    for (const Build& build : builds) {
        std::fprintf(stderr, "%s\n", build.name.c_str());
        const Shapes shapes = make_shapes(build);
        for (const PairCase& pair_case : kPairCases)
            measure_meeting(shapes, build, pair_case, effort, unproved, rows);
    }
    print_methods(
        rows, builds, "One question, ns: cold / warm along a small motion",
        [](const Row& row) { return row.cold; }, [](const Row& row) { return row.warm_small; },
        true);
    print_methods(
        rows, builds, "The same: plain / warm along a large motion",
        [](const Row& row) { return row.plain; }, [](const Row& row) { return row.warm_large; },
        false);
    std::printf("\nTruths are proved to %.1e m.\n", unproved);
    std::fflush(stdout);

    std::vector<ContactRow> contacts =
        measure_contacts(make_shapes(builds[0]), {"box-box", 0, 0}, effort);
    std::vector<std::size_t> counts{8, 32, 128, 1000};
    if (!quick) counts = {8, 16, 32, 64, 96, 128, 192, 256, 512, 1000, 10000};
    for (const bool box : {true, false})
        for (const std::size_t vertices : counts) {
            std::fprintf(stderr, "contacts %zu\n", vertices);
            const Build build{(box ? "box-" : "hull-") + std::to_string(vertices),
                              box ? 0 : vertices, vertices};
            const auto made = measure_contacts(make_shapes(build), build, effort);
            contacts.insert(contacts.end(), made.begin(), made.end());
        }
    print_contacts(contacts);
    if (json != nullptr && !write_json(json, rows, contacts, unproved)) {
        std::fprintf(stderr, "%s: cannot be written\n", json);
        return 2;
    }
    return 0;
}

}  // namespace
}  // namespace throng::perf

int main(int count, char** arguments)
{
    bool quick = false;
    const char* json = nullptr;
    for (int i = 1; i < count; ++i) {
        const std::string_view argument = arguments[i];
        if (argument == "--quick") {
            quick = true;
        } else if (argument == "--json" && i + 1 < count) {
            json = arguments[++i];
        } else {
            std::fprintf(stderr, "methods_perf [--quick] [--json FILE]\n");
            return 2;
        }
    }
    return throng::perf::run(quick, json);
}
