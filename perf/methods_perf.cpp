// Methods: every way to ask about two convex shapes side by side: what it takes, how far off it is,
// how often it is wrong or does not know; and where touch is told with points, which of separating
// axes and GJK does it in less.
//
//   methods_perf [--quick] [--json FILE]
//
// All take turns over the same pairs in the same poses, and of each the best turn counts: thread
// processor time, ns of one question. Placing a pair is not counted, but for points of contact.
#include "narrowphase/box_pairs.hpp"
#include "narrowphase/methods/method_contacts.hpp"
#include "narrowphase/pair_functions.hpp"
#include "perf/pair_truth.hpp"
#include "perf/rolling_pairs.hpp"
#include "scenes/json.hpp"
#include "scenes/json_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <string_view>

namespace throng::perf {
namespace {

constexpr double kReach = 0.02;  // m, as in a pile of bodies of 1 m
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Within reach of the far ones is nothing, so that they need no more than to be told so.
constexpr Meeting kFar{"far", 2, kReach};
constexpr Meeting kNear{"near", 0.1, 1e9};
constexpr Meeting kTouching{"touching", -0.005, kReach};
constexpr Meeting kDeep{"deep", -0.2, kReach};
constexpr Meeting kMeetings[] = {kFar, kNear, kTouching, kDeep};

// A body that settles, and one that tumbles at some 6 rad/s.
constexpr Motion kSmall{"small", 0.002};
constexpr Motion kLarge{"large", 0.1};

// A plain start looks at everything, of hulls beyond this for longer than it is worth; and what
// separating axes take where nothing parts the two grows with the square.
constexpr std::size_t kMostPlain = 128, kMostAxes = 1000;

struct Effort {
    std::size_t pairs = 48;
    int turns = 7;
    double turn = 3e-3;  // s, beyond which a turn asks less
    std::size_t judged = 12;
};

// -------------------------------------------------------------------------------------- timing

// Of this thread alone, s: what others take of the machine's time is not counted.
double thread_seconds()
{
    timespec now = {};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / 1e9;
}

volatile double sink = 0;  // NOLINT: what is written here is not thrown away as unused

// One that takes turns with others: asks about a pair in the pose of a step, and gives a number.
struct Turn {
    std::function<double(std::size_t first, std::size_t pairs, std::size_t step)> ask;
    std::size_t pairs = 0;  // of those there are: fewer where a turn would take too long
    double best = kNone;    // ns

    void run(const Effort& effort)
    {
        constexpr std::size_t kQuestions = 2 * kSteps - 2;  // to and fro
        if (pairs == 0) {
            // So long that it needs no more than its first look.
            const double begin = thread_seconds();
            sink = ask(0, 1, 0);
            sink = ask(0, 1, 1);
            const double took = (thread_seconds() - begin) / 2;
            const double most = effort.turn / (kQuestions * std::max(took, 1e-9));
            pairs = std::clamp(static_cast<std::size_t>(most), std::size_t{2}, effort.pairs);
        }
        double sum = 0;
        const double begin = thread_seconds();
        for (std::size_t i = 0; i < kQuestions; ++i)
            sum += ask(0, pairs, i < kSteps ? i : kQuestions - i);
        const double took = thread_seconds() - begin;
        sink = sum;
        const double one = took * 1e9 / static_cast<double>(pairs * kQuestions);
        if (!(best <= one)) best = one;
    }
};

void take_turns(std::vector<Turn>& turns, const Effort& effort)
{
    for (int i = 0; i < effort.turns; ++i)
        for (Turn& turn : turns) turn.run(effort);
}

Turn asking(const ConvexMethod& method,
            const RollingPairs& rolling,
            const Meeting& meeting,
            MethodStart start)
{
    Turn turn;
    turn.ask = [&method, &rolling, reach = meeting.reach, start,
                memory = std::vector<MethodMemory>(rolling.pairs.size())](
                   std::size_t first, std::size_t count, std::size_t step) mutable {
        double sum = 0;
        for (std::size_t i = first; i < first + count; ++i)
            sum += method.ask(*rolling.pairs[i].asked[step], reach, start, memory[i]).separation;
        return sum;
    };
    return turn;
}

// --------------------------------------------------------------------------------------- errors

// What the answers about some pairs were worth.
//
//   error     the worst, m; of volumes, as a part of what is shared
//   asked     answers looked at; of them
//   wrong     said yes where it is no, or no where it is yes
//   undecided said neither
struct Worth {
    std::string error_of;
    double error = kNone;
    int asked = 0, wrong = 0, undecided = 0;

    void add_error(std::string_view of, double more)
    {
        error_of = of;
        if (!(more <= error)) error = more;
    }
};

struct KnownPair {
    std::size_t pair, step;
    double separation, volume;
};

bool can_ask(const ConvexMethod& method, const Build& build, const Meeting& meeting)
{
    const std::size_t vertices = std::max(build.vertices_a, build.vertices_b);
    return method.name != "sat" || vertices <= kMostAxes || meeting.gap > 0;
}

bool can_ask_plain(const Build& build)
{
    return std::max(build.vertices_a, build.vertices_b) <= kMostPlain;
}

std::vector<KnownPair>
know(const RollingPairs& rolling, const Meeting& meeting, const Effort& effort, double& unproved)
{
    std::vector<KnownPair> known;
    for (std::size_t i = 0; i < std::min(effort.judged, rolling.pairs.size()); ++i) {
        const std::size_t step = i % 2 == 0 ? 0 : kSteps - 1;
        const Pose& pose = rolling.pairs[i].b_in_a[step];
        const PolytopePair& pair = *rolling.pairs[i].asked[step]->polytopes();
        const PairTruth truth = pair_truth(pair, pose);
        unproved = std::max(unproved, truth.unproved);
        const bool shares = meeting.gap < 0;
        known.push_back({i, step, truth.separation, shares ? shared_volume(pair, pose) : 0});
    }
    return known;
}

void judge(const ConvexMethod& method,
           const MethodAnswer& answer,
           const KnownPair& known,
           const Meeting& meeting,
           Worth& worth)
{
    ++worth.asked;
    const bool touch = known.separation <= 0;
    if (answer.touch == Touch::undecided) {
        ++worth.undecided;
        return;
    }
    if ((answer.touch == Touch::touching) != touch) ++worth.wrong;
    const double off = std::abs(answer.separation - known.separation);
    if (touch && (method.tells & kTellsDepth) != 0) worth.add_error("depth", off);
    if (!touch && (method.tells & kTellsDistance) != 0 && known.separation <= meeting.reach)
        worth.add_error("distance", off);
    if (touch && (method.tells & kTellsVolume) != 0)
        worth.add_error("volume", std::abs(answer.volume - known.volume) / known.volume);
}

Worth worth_of(const ConvexMethod& method,
               const RollingPairs& rolling,
               std::span<const KnownPair> known,
               const Build& build,
               const Meeting& meeting)
{
    Worth worth;
    for (const KnownPair& one : known) {
        const auto& asked = rolling.pairs[one.pair].asked;
        MethodMemory memory;
        for (std::size_t step = 0; step < one.step; ++step)
            method.ask(*asked[step], meeting.reach, MethodStart::cached, memory);
        for (const MethodStart start :
             {MethodStart::cached, MethodStart::cold, MethodStart::plain}) {
            if (start == MethodStart::plain && !can_ask_plain(build)) continue;
            judge(method, method.ask(*asked[one.step], meeting.reach, start, memory), one, meeting,
                  worth);
        }
    }
    return worth;
}

// ---------------------------------------------------------------------------------------- methods

struct Row {
    std::string_view method;
    std::string build;
    std::string_view meeting;
    double cold = kNone, plain = kNone, warm_small = kNone, warm_large = kNone;  // ns
    Worth worth;
};

void measure_meeting(const Shapes& shapes,
                     const Build& build,
                     const Meeting& meeting,
                     const Effort& effort,
                     double& unproved,
                     std::vector<Row>& rows)
{
    Effort here = effort;
    if (std::max(build.vertices_a, build.vertices_b) > kMostAxes) {
        here.pairs = std::min<std::size_t>(effort.pairs, 16);
        here.judged = std::min<std::size_t>(effort.judged, 4);
    }
    const RollingPairs small(shapes, build, meeting, kSmall, here.pairs);
    const RollingPairs large(shapes, build, meeting, kLarge, here.pairs);
    const std::vector<KnownPair> known = know(large, meeting, here, unproved);

    std::vector<Row> made;
    std::vector<Turn> turns;
    for (const ConvexMethod& method : convex_methods()) {
        if (!can_ask(method, build, meeting)) continue;
        made.push_back({method.name, build.name, meeting.name, kNone, kNone, kNone, kNone,
                        worth_of(method, large, known, build, meeting)});
        turns.push_back(asking(method, small, meeting, MethodStart::cold));
        turns.push_back(asking(method, small, meeting, MethodStart::cached));
        turns.push_back(asking(method, large, meeting, MethodStart::cached));
        if (can_ask_plain(build))
            turns.push_back(asking(method, small, meeting, MethodStart::plain));
    }
    take_turns(turns, here);
    std::size_t next = 0;
    for (Row& row : made) {
        row.cold = turns[next++].best;
        row.warm_small = turns[next++].best;
        row.warm_large = turns[next++].best;
        if (can_ask_plain(build)) row.plain = turns[next++].best;
        rows.push_back(std::move(row));
    }
}

// --------------------------------------------------------------------------------------- contacts

// What a pair with its points of contact takes, warm: by a method of the user's choice, and by what
// `auto` takes in either number type.
struct ContactRow {
    std::string build;
    std::string_view meeting, motion;
    double gjk = kNone, sat = kNone, auto_float = kNone, auto_double = kNone;  // ns
};

template <class Found>
double told(const Found& found)
{
    return found.count > 0 ? static_cast<double>(found.points[0].separation) : 0;
}

Turn colliding_by(std::string_view name, const Shapes& shapes, const RollingPairs& rolling)
{
    Turn turn;
    turn.ask = [&shapes, &rolling, method = find_convex_method(name),
                memory = std::vector<MethodMemory>(rolling.pairs.size())](
                   std::size_t first, std::size_t count, std::size_t step) mutable {
        double sum = 0;
        LocalManifold<double> found;
        for (std::size_t i = first; i < first + count; ++i) {
            const auto& one = rolling.pairs[i];
            collide_by(*method, MethodStart::cached, shapes, one.a, one.b, one.b_in_a[step],
                       kReach, memory[i], found);
            sum += told(found);
        }
        return sum;
    };
    return turn;
}

template <class Real>
Turn colliding(const Shapes& shapes, const RollingPairs& rolling)
{
    const bool boxes = rolling.pairs[0].b.kind == ShapeKind::box;
    Turn turn;
    turn.ask = [&shapes, &rolling, collide = boxes ? box_box<Real> : hull_hull<Real>,
                caches = std::vector<PairCache>(rolling.pairs.size())](
                   std::size_t first, std::size_t count, std::size_t step) mutable {
        double sum = 0;
        LocalManifold<Real> found;
        for (std::size_t i = first; i < first + count; ++i) {
            const auto& one = rolling.pairs[i];
            const PoseT<Real> pose{one.b_in_a[step].position.template cast<Real>(),
                                   one.b_in_a[step].orientation.template cast<Real>()};
            collide(shapes, one.a, one.b, pose, static_cast<Real>(kReach), caches[i], found);
            sum += told(found);
        }
        return sum;
    };
    return turn;
}

// All pairs at once, as the step has its boxes in float collided.
Turn colliding_boxes(const Shapes& shapes, const RollingPairs& rolling)
{
    Turn turn;
    turn.ask = [&shapes, &rolling, pairs = std::vector<BoxPair>(),
                manifolds = std::vector<LocalManifold<float>>(rolling.pairs.size())](
                   std::size_t first, std::size_t count, std::size_t step) mutable {
        pairs.clear();
        for (std::size_t i = first; i < first + count; ++i) {
            const auto& one = rolling.pairs[i];
            const PoseT<float> pose{one.b_in_a[step].position.cast<float>(),
                                    one.b_in_a[step].orientation.cast<float>()};
            pairs.push_back(box_pair(pose, shapes.boxes[one.a.index].half_extents.cast<float>(),
                                     shapes.boxes[one.b.index].half_extents.cast<float>(),
                                     static_cast<float>(kReach)));
        }
        collide_boxes(pairs, std::span(manifolds).first(count));
        return told(manifolds[0]);
    };
    return turn;
}

std::vector<ContactRow>
measure_contacts(const Shapes& shapes, const Build& build, const Effort& effort)
{
    std::vector<ContactRow> rows;
    const bool too_many = std::max(build.vertices_a, build.vertices_b) > kMostAxes;
    Effort here = effort;
    if (too_many) here.pairs = std::min<std::size_t>(effort.pairs, 8);
    for (const Meeting& meeting : {kTouching, kDeep})
        for (const Motion& motion : {kSmall, kLarge}) {
            const RollingPairs rolling(shapes, build, meeting, motion, here.pairs);
            const bool boxes = rolling.pairs[0].b.kind == ShapeKind::box;
            // Of two hulls of thousands GJK alone; beside a box the other ways still end.
            const bool gjk_alone = too_many && std::min(build.vertices_a, build.vertices_b) > 0;
            std::vector<Turn> turns{colliding_by("gjk", shapes, rolling)};
            if (!gjk_alone) {
                turns.push_back(colliding_by("sat", shapes, rolling));
                turns.push_back(boxes ? colliding_boxes(shapes, rolling)
                                      : colliding<float>(shapes, rolling));
                turns.push_back(colliding<double>(shapes, rolling));
            }
            take_turns(turns, here);
            ContactRow row{build.name, meeting.name, motion.name, turns[0].best};
            if (!gjk_alone) {
                row.sat = turns[1].best;
                row.auto_float = turns[2].best;
                row.auto_double = turns[3].best;
            }
            rows.push_back(row);
        }
    return rows;
}

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
std::string worth_text(const std::vector<Row>& rows, std::string_view method, const char* meeting)
{
    Worth all;
    for (const Row& row : rows) {
        if (row.method != method || row.meeting != meeting) continue;
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
    for (const Meeting& meeting : kMeetings)
        for (const ConvexMethod& method : convex_methods()) {
            std::printf("%-9s %-12s", meeting.name, std::string(method.name).c_str());
            for (const Build& build : builds) {
                const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& one) {
                    return one.method == method.name && one.build == build.name
                        && one.meeting == meeting.name;
                });
                const std::string text = row == rows.end()
                    ? "-"
                    : time_text(first(*row)) + "/" + time_text(second(*row));
                std::printf(" %15s", text.c_str());
            }
            std::printf("%s\n",
                        worth ? worth_text(rows, method.name, meeting.name).c_str() : "");
        }
}

void print_contacts(const std::vector<ContactRow>& rows)
{
    std::printf("\nWith points of contact, warm: ns of a pair, placing it included\n\n"
                "%-14s %-9s %-6s %10s %10s %12s %12s\n",
                "", "", "motion", "gjk", "sat", "auto float", "auto double");
    for (const ContactRow& row : rows)
        std::printf("%-14s %-9s %-6s %10s %10s %12s %12s\n", row.build.c_str(),
                    std::string(row.meeting).c_str(), std::string(row.motion).c_str(),
                    time_text(row.gjk).c_str(), time_text(row.sat).c_str(),
                    time_text(row.auto_float).c_str(), time_text(row.auto_double).c_str());
}

std::string number_or_null(double number) { return std::isnan(number) ? "null" : json_text(number); }

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
        members.add("separation", json_string(row.meeting));
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
        members.add("separation", json_string(row.meeting));
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
        builds.push_back({std::to_string(vertices), vertices, vertices});
    std::vector<Row> rows;
    double unproved = 0;
    for (const Build& build : builds) {
        std::fprintf(stderr, "%s\n", build.name.c_str());
        const Shapes shapes = make_shapes(build);
        for (const Meeting& meeting : kMeetings)
            measure_meeting(shapes, build, meeting, effort, unproved, rows);
    }
    print_methods(rows, builds, "One question, ns: cold / warm along a small motion",
                  [](const Row& row) { return row.cold; },
                  [](const Row& row) { return row.warm_small; }, true);
    print_methods(rows, builds, "The same: plain / warm along a large motion",
                  [](const Row& row) { return row.plain; },
                  [](const Row& row) { return row.warm_large; }, false);
    std::printf("\nTruths are proved to %.1e m.\n", unproved);
    std::fflush(stdout);

    std::vector<ContactRow> contacts = measure_contacts(make_shapes(builds[0]), {"box-box", 0, 0},
                                                        effort);
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
