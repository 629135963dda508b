// Dial pairs: every value of a dial beside every value of every other.
//
// A covering array: as few settings as it takes for each pair of values to be among them once. Each
// runs a heap on one thread and on three; none may lose a body, and both have the same bits.
//
// Method: greedy rows, after Cohen, Dalal, Fredman & Patton, The AETG system (1997).
#include "cost/hard_cases/hard_cases.hpp"
#include "throng/catalog.hpp"
#include "throng/dials.hpp"
#include "throng/world.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace throng {

namespace {

struct Factor {
    std::string name;
    std::vector<std::string> values;
};

using Row = std::vector<std::size_t>;  // a value of each factor

// Numbers that a heap of crates can be run at: the default, and some way off it to either side.
const std::vector<Factor>& number_factors()
{
    static const std::vector<Factor> kNumbers = {
        {"dt", {"1/60", "0.005"}},
        {"substeps", {"4", "1"}},
        {"iterations", {"auto", "3"}},
        {"contact_rate", {"auto", "0.1", "fixed:30"}},
        {"push_limit", {"3", "0"}},
        {"direct_limit", {"8", "4"}},  // greater islands that fall take it seconds each
        {"penalty_stiffness", {"auto", "1e4", "1e9"}},
        {"penalty_damping", {"auto", "0"}},
        {"halvings", {"auto", "4"}},
        {"toi_tolerance", {"1e-4", "0.01"}},
    };
    return kNumbers;
}

std::vector<Factor> factors()
{
    std::vector<Factor> list;
    for (const Dial& dial : dials()) {
        Factor factor{std::string(dial.name), {}};
        for (const Choice& choice : dial.choices)
            if (choice.available) factor.values.emplace_back(choice.text);
        for (const Factor& numbers : number_factors())
            if (numbers.name == dial.name) factor.values = numbers.values;
        if (factor.values.size() > 1) list.push_back(std::move(factor));
    }
    return list;
}

struct Pair {
    std::size_t factor_a, value_a, factor_b, value_b;
    auto operator<=>(const Pair&) const = default;  // NOLINT(modernize-use-nullptr): has none
};

Pair pair_of(const Row& row, std::size_t a, std::size_t b)
{
    return a < b ? Pair{a, row[a], b, row[b]} : Pair{b, row[b], a, row[a]};
}

// A row round one pair that is wanted, each other value chosen for how many more it adds.
Row next_row(const std::vector<Factor>& list, const std::set<Pair>& wanted)
{
    Row row(list.size(), 0);
    const Pair first = *wanted.begin();
    std::vector<std::size_t> chosen = {first.factor_a, first.factor_b};
    row[first.factor_a] = first.value_a;
    row[first.factor_b] = first.value_b;
    for (std::size_t factor = 0; factor < list.size(); ++factor) {
        if (factor == first.factor_a || factor == first.factor_b) continue;
        std::size_t best = 0, most = 0;
        for (std::size_t value = 0; value < list[factor].values.size(); ++value) {
            row[factor] = value;
            const auto adds = static_cast<std::size_t>(
                std::count_if(chosen.begin(), chosen.end(), [&](std::size_t other) {
                    return wanted.contains(pair_of(row, factor, other));
                }));
            if (adds <= most) continue;
            best = value;
            most = adds;
        }
        row[factor] = best;
        chosen.push_back(factor);
    }
    return row;
}

std::vector<Row> covering_rows(const std::vector<Factor>& list)
{
    std::set<Pair> wanted;
    for (std::size_t a = 0; a < list.size(); ++a)
        for (std::size_t b = a + 1; b < list.size(); ++b)
            for (std::size_t i = 0; i < list[a].values.size(); ++i)
                for (std::size_t k = 0; k < list[b].values.size(); ++k) wanted.insert({a, i, b, k});
    std::vector<Row> rows;
    while (!wanted.empty()) {
        rows.push_back(next_row(list, wanted));
        for (std::size_t a = 0; a < list.size(); ++a)
            for (std::size_t b = a + 1; b < list.size(); ++b)
                wanted.erase(pair_of(rows.back(), a, b));
    }
    return rows;
}

// What is set, or why it cannot be.
std::string set_all(const std::vector<Factor>& list, const Row& row, Settings& settings)
{
    for (std::size_t i = 0; i < list.size(); ++i) {
        std::string trouble = set_dial(settings, list[i].name, list[i].values[row[i]]);
        if (!trouble.empty()) return trouble;
    }
    return {};
}

// Those that are not the default, as the command takes them.
std::string text_of(const std::vector<Factor>& list, const Row& row)
{
    std::string text;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (row[i] > 0)
            text += (text.empty() ? "" : " ") + list[i].name + '=' + list[i].values[row[i]];
    return text.empty() ? "defaults" : text;
}

std::size_t not_finite(const World& world)
{
    std::size_t count = 0;
    for (const BodyId body : world.bodies()) {
        const Pose pose = world.pose(body);
        const bool sound = pose.position.allFinite() && pose.orientation.coeffs().allFinite()
            && world.velocity(body).allFinite() && world.angular_velocity(body).allFinite();
        count += sound ? 0 : 1;
    }
    return count;
}

// s, as long as a row runs. What holds bodies apart by impulses looks for every touch of a heap
// that is falling together: where all 200 have met, a step takes it minutes.
double time_of(const Settings& settings)
{
    const bool held_apart =
        settings.overlap != Overlap::allow && settings.response == Response::impulse;
    return held_apart ? 0.55 : 200 * settings.dt;
}

void run_row(CaseBench& bench, const std::string& setting, const Settings& settings)
{
    const bool apart = settings.overlap != Overlap::allow;
    const int steps =
        bench.brief() ? 30 : static_cast<int>(std::lround(time_of(settings) / settings.dt));
    Scene scene = make_scene("pile", !bench.brief() ? 200 : apart ? 5 : 20);
    scene.settings = settings;
    std::string hash;
    std::size_t lost = 0;
    try {
        bench.run(scene, steps * settings.dt, [&](World& world, double) {
            lost = not_finite(world);
            hash = world.state_hash();
            return true;
        });
    } catch (const std::invalid_argument& refused) {
        return bench.skip(setting, "bodies not finite", refused.what());
    }
    bench.forgive_residual();
    World three(scene, 3);
    three.step(steps);
    bench.report(setting, "bodies not finite", static_cast<double>(lost), 0, "1");
    bench.report(setting, "other bits on three threads", hash == three.state_hash() ? 0 : 1, 0,
                 "1");
}

}  // namespace

void case_dial_pairs(CaseBench& bench)
{
    const std::vector<Factor> list = factors();
    for (const Row& row : covering_rows(list)) {
        Settings settings = bench.settings();
        const std::string trouble = set_all(list, row, settings);
        if (trouble.empty())
            run_row(bench, text_of(list, row), settings);
        else
            bench.skip(text_of(list, row), "bodies not finite", trouble);
    }
}

}  // namespace throng
