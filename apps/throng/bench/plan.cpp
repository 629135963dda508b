// Plan: what a benchmark is to run, as its options say.
#include "apps/throng/bench/plan.hpp"

#include "apps/throng/scene_argument.hpp"
#include "cost/answers/answers.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"
#include "throng/version.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

namespace throng::bench {
namespace {

constexpr std::int64_t kStandardSteps = 200, kMostBenchSteps = 100'000;
constexpr std::string_view kStandardScenes =
    "pile,spheres,hulls,wall,pyramid,stacks,tumbler,crowd,sparse";
constexpr std::string_view kStandardSizes = "1000,10000,100000";
constexpr std::string_view kStandardSeconds = "20";
constexpr std::string_view kKnownPeers[] = {"bullet", "ode"};
constexpr std::string_view kWidths[] = {"scalar", "avx2", "avx512"};

constexpr Option kPlanOptions[] = {
    {"--scenes", "A,B",
     "scenes of the catalogue (default pile,spheres,hulls,wall,pyramid,stacks,tumbler,crowd,"
     "sparse; with --error all that have an answer)"},
    {"--sizes", "N,M",
     "sizes of each scene (default 1000,10000,100000; with --error the scene's own)"},
    {"--dt", "S,T",
     "steps, s, as numbers or fractions, each a run of its own (default: the scene's)"},
    {"--error", "",
     "how far every engine is from the scene's answer, beside its times: of rolling, bouncing, "
     "ball_cube and elastic_ball_cube, in the unit and for the time of SimBenchmark; others have "
     "no answer and are refused"},
    {"--threads", "N,M", "numbers of threads, 1 to 1024 (default: 1 and all cores)"},
    {"--efficiency", "",
     "what the threads of a run do together, of what as many runs of one thread do beside one "
     "another; takes a run of those for each of --threads"},
    {"--steps", "N",
     "steps of each run, from 1; the same first steps for all (default 200; with --error for as "
     "long as the answer is followed)"},
    {"--repeat", "K", "runs of each engine, from worlds made anew (default 2)"},
    {"--max-seconds", "S",
     "an engine stops a run after so long; what is compared is then the steps that both have done "
     "(default 20)"},
    {"--peers", "A,B",
     "other engines to run in turn: bullet, ode, or none (default: those that were found when "
     "throng was built)"},
    {"--peer-at", "NAME=DIR",
     "another engine, built by yourself: box3d, jolt or physx, and the folder where it is "
     "installed, "
     "or of its source with a build in it; on each of --threads. Its adapter is built first, which "
     "takes cmake and a compiler. May be given again",
     true},
    {"--vary", "DIAL=A,B",
     "throng with each of these values of a dial, side by side; all ends are then judged with the "
     "scene's own value"},
    {"--lanes", "A,B",
     "throng by each of these widths of its kernels, side by side: scalar, avx2, avx512; their "
     "ends have to be the same (default: the widest of the machine, or what THRONG_LANES asks "
     "for)"},
    kSeedOption,
    kMeshOption,
    kSetOption,
};

std::string_view text_or(const Options& options, std::string_view name, std::string_view standard)
{
    return options.has(name) ? options.text(name) : standard;
}

std::vector<int> numbers_of(std::string_view option, std::string_view text, std::int64_t most)
{
    std::vector<int> numbers;
    for (const std::string_view part : parts_of(option, text))
        numbers.push_back(static_cast<int>(parse_whole(option, part, 1, most)));
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
}

std::vector<const CatalogEntry*> scenes_of(std::string_view text)
{
    std::vector<const CatalogEntry*> scenes;
    for (const std::string_view part : parts_of("--scenes", text)) {
        if (part.find(':') != std::string_view::npos)
            throw BadInput("--scenes: wanted names alone, not " + in_quotes(part)
                           + "; sizes go to --sizes");
        const ParsedScene parsed = parse_scene(part);
        if (parsed.entry == nullptr) throw BadInput("--scenes: " + parsed.error);
        if (std::find(scenes.begin(), scenes.end(), parsed.entry) != scenes.end())
            throw BadInput("--scenes: " + in_quotes(part) + " is given twice");
        scenes.push_back(parsed.entry);
    }
    return scenes;
}

std::vector<std::string> peers_of(std::string_view text)
{
    std::vector<std::string> peers;
    if (text == "none") return peers;
    for (const std::string_view part : parts_of("--peers", text)) {
        if (std::find(std::begin(kKnownPeers), std::end(kKnownPeers), part)
            == std::end(kKnownPeers))
            throw BadInput("--peers: wanted " + either_of(kKnownPeers)
                           + ", some of them with commas between, or none; not " + in_quotes(part));
        if (std::find(peers.begin(), peers.end(), part) == peers.end()) peers.emplace_back(part);
    }
    return peers;
}

std::vector<PeerAt> peers_at(const Options& options)
{
    std::vector<PeerAt> peers;
    for (const std::string_view text : options.all("--peer-at")) {
        PeerAt peer = peer_at(text);
        const auto same = [&](const PeerAt& other) { return other.name == peer.name; };
        if (std::any_of(peers.begin(), peers.end(), same))
            throw BadInput("--peer-at: " + peer.name + " is given twice");
        peers.push_back(std::move(peer));
    }
    return peers;
}

Variation variation_of(std::string_view text)
{
    Variation varied;
    if (text.empty()) return varied;
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos)
        throw BadInput("--vary: wanted DIAL=VALUE,VALUE, not " + in_quotes(text));
    varied.dial = text.substr(0, equals);
    for (const std::string_view value : parts_of("--vary", text.substr(equals + 1))) {
        Scene unused;
        set_from_line(unused, "--vary", varied.dial, value);
        if (std::find(varied.values.begin(), varied.values.end(), value) != varied.values.end())
            throw BadInput("--vary: " + in_quotes(value) + " is given twice");
        varied.values.emplace_back(value);
    }
    return varied;
}

std::vector<std::string> lanes_of(std::string_view text)
{
    std::vector<std::string> widths;
    if (text.empty()) return widths;
    for (const std::string_view part : parts_of("--lanes", text)) {
        std::string width(part);
        if (std::find(std::begin(kWidths), std::end(kWidths), part) == std::end(kWidths))
            throw BadInput("--lanes: wanted " + either_of(kWidths)
                           + ", some of them with commas between, not " + in_quotes(part));
        if (!machine_has_lanes(width.c_str()))
            throw BadInput("--lanes: this machine has no " + width + "; leave it out");
        if (std::find(widths.begin(), widths.end(), width) != widths.end())
            throw BadInput("--lanes: " + in_quotes(part) + " is given twice");
        widths.push_back(std::move(width));
    }
    return widths;
}

std::string all_cores()
{
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    return cores == 1 ? "1" : "1," + std::to_string(cores);
}

double seconds_of(std::string_view text)
{
    const double seconds = parse_number(text);
    if (!(seconds > 0 && seconds <= 1e9))
        throw BadInput("--max-seconds: wanted a time above 0, s, not " + in_quotes(text));
    return seconds;
}

std::vector<double> dts_of(std::string_view text)
{
    std::vector<double> dts;
    if (text.empty()) return dts;
    for (const std::string_view part : parts_of("--dt", text)) {
        Scene unused;
        set_from_line(unused, "--dt", "dt", part);
        if (std::find(dts.begin(), dts.end(), unused.settings.dt) != dts.end())
            throw BadInput("--dt: " + in_quotes(part) + " is given twice");
        dts.push_back(unused.settings.dt);
    }
    return dts;
}

std::string scenes_with_answers(std::string_view between)
{
    std::string names;
    for (const SceneAnswer& answer : scene_answers())
        names += (names.empty() ? std::string() : std::string(between)) + std::string(answer.scene);
    return names;
}

void check_answers(const Plan& plan)
{
    for (const CatalogEntry* scene : plan.scenes)
        if (find_answer(scene->name) == nullptr)
            throw BadInput("--error: " + std::string(scene->name)
                           + " has no answer to be held against; give --scenes some of "
                           + scenes_with_answers(", "));
    // Peers would go by the scene's own, and be told as if they were compared.
    if (plan.varied.dial == "dt")
        throw BadInput("--vary: dt would be throng's alone; with --error give --dt its values");
}

void check_sizes(const Plan& plan)
{
    for (const CatalogEntry* scene : plan.scenes)
        for (const int size : plan.sizes)
            if (size < scene->least || size > scene->most)
                throw BadInput("--sizes: " + std::string(scene->name) + " has sizes from "
                               + std::to_string(scene->least) + " to " + std::to_string(scene->most)
                               + ", not " + std::to_string(size));
}

}  // namespace

std::span<const Option> plan_options() { return kPlanOptions; }

Plan read_plan(const Options& options)
{
    Plan plan;
    plan.errors = options.has("--error");
    const std::string standard_scenes =
        plan.errors ? scenes_with_answers(",") : std::string(kStandardScenes);
    plan.scenes = scenes_of(text_or(options, "--scenes", standard_scenes));
    if (!plan.errors || options.has("--sizes"))
        plan.sizes = numbers_of("--sizes", text_or(options, "--sizes", kStandardSizes), 10'000'000);
    plan.dts = dts_of(options.text("--dt"));
    plan.threads = numbers_of("--threads", text_or(options, "--threads", all_cores()), 1024);
    plan.efficiency = options.has("--efficiency");
    if (plan.efficiency && plan.threads.back() == 1)
        throw BadInput("--efficiency: is of more threads than one; give --threads some");
    plan.peers_asked_for = options.has("--peers");
    plan.peers = peers_of(text_or(options, "--peers", "bullet,ode"));
    plan.peers_at = peers_at(options);
    plan.varied = variation_of(options.text("--vary"));
    plan.lanes = lanes_of(options.text("--lanes"));
    if (!plan.errors || options.has("--steps"))
        plan.steps = options.whole("--steps", kStandardSteps, 1, kMostBenchSteps);
    plan.repeats = static_cast<int>(options.whole("--repeat", 2, 1, 1000));
    plan.max_seconds = seconds_of(text_or(options, "--max-seconds", kStandardSeconds));
    plan.seed = seed_asked(options);
    check_sizes(plan);
    if (plan.errors) check_answers(plan);
    return plan;
}

std::vector<PlannedScene> planned_scenes(const Plan& plan, double standard_dt)
{
    std::vector<PlannedScene> planned;
    const std::vector<double> dts = plan.dts.empty() ? std::vector<double>{standard_dt} : plan.dts;
    for (const CatalogEntry* entry : plan.scenes)
        for (const int size :
             plan.sizes.empty() ? std::vector<int>{entry->default_size} : plan.sizes)
            for (const double dt : dts) {
                std::int64_t steps = plan.steps;
                if (steps == 0) steps = std::llround(find_answer(entry->name)->time / dt);
                planned.push_back({entry, size, dt, std::max<std::int64_t>(1, steps)});
            }
    return planned;
}

}  // namespace throng::bench
