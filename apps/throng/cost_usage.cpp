// Cost usage: how `throng cost` is asked for, of a scene and of a hard case.
#include "apps/throng/cost_options.hpp"
#include "apps/throng/scene_argument.hpp"

#include <algorithm>
#include <cctype>

namespace throng {
namespace {

constexpr Option kOptions[] = {
    {"--error", "E",
     "names the cheapest setting whose error is at most that, in the measure's unit"},
    {"--within", "MS",
     "names the most exact setting that takes at most so long for each 1/60 s of the scene"},
    {"--measure", "M",
     "the error, of a scene: drift, m; turn, rad; velocity, m/s; overlap, m; energy, J; momentum, "
     "N s; complementarity, m/s; friction_cone, m/s; missed_contacts and force_error, shares "
     "(default drift); of a case: a quantity of its lines (default: that of the first)"},
    {"--dials", "A,B",
     "tries values of these dials alone; none: measures the scene as it is (default: all that may "
     "matter here)"},
    {"--settings", "FILE",
     "tries these alone, each measured whole: a line a setting, as in dt=1/120 solver=pgs"},
    {"--window", "S", "s that bodies may drift from the reference in (default 0.1)"},
    {"--windows", "N", "how many windows, 2 to 1000 (default 24)"},
    {"--seconds", "S", "s of the scene, from its beginning, that windows lie in (default 5)"},
    {"--minutes", "M", "of the clock, after which nothing new is begun (default 4)"},
    kThreadsOption,
    kDtOption,
    kSetOption,
    kSeedOption,
    kMeshOption,
    {"--out", "DIR",
     "folder of the report: cost.html, a page for a browser; cost.json, cost.csv and cost.svg "
     "(default: cost-SCENE)"},
    {"--resume", "", "takes what cost.json in that folder has of the same windows, and goes on"},
    {"--compare", "",
     "measures nothing: prints two reports side by side, throng cost --compare A.json B.json"},
    {"--text", "", "draws the front in letters"},
    {"--quiet", "", "no progress and no warnings"},
};

}  // namespace

const Usage kCostUsage = {
    "cost",
    "SCENE|CASE",
    "Measures error and time of a scene, or of a hard case, by many settings, and names the one to "
    "take.",
    1,
    2,
    kOptions};

bool asks_for_case(const Options& options)
{
    if (options.has("--compare") || options.words().size() != 1) return false;
    std::string word(options.words().front());
    for (char& letter : word)
        letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
    return word == "PAIRS"
        || (word.size() > 1 && word[0] == 'H'
            && std::all_of(word.begin() + 1, word.end(), is_digit));
}

}  // namespace throng
