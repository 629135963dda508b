#include "cost/hard_cases/case_trials.hpp"

#include "cost/clock.hpp"
#include "kernels/math/hash.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace throng {

namespace {

void add_once(std::vector<std::string>& list, const std::string& text)
{
    if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

std::string listed(const std::vector<std::string>& list)
{
    std::string text;
    for (const std::string& each : list) text += (text.empty() ? "" : "; ") + each;
    return text;
}

// A sentence for one that asks methods about shapes.
std::string refusal_of(const HardCase& which)
{
    std::vector<std::string_view> others;
    for (const HardCase& one : hard_cases())
        if (!one.asks_alone) others.push_back(one.name);
    return std::string(which.name)
        + " asks methods about shapes and steps no world, so that no setting of a step changes "
          "what it tells; wanted "
        + either_of(others);
}

}  // namespace

CaseTrials::CaseTrials(const HardCase& which, const CasePlan& plan, const Watch& watch)
    : which_(which), plan_(plan), watch_(watch)
{
    if (which.asks_alone) throw std::invalid_argument(refusal_of(which));
    const WallClock::time_point begin = WallClock::now();
    // Lines that come late in a case may come soon in a brief one; the first comes at once in both.
    Found brief;
    if (!plan_.quantity.empty()) brief = go({}, Extent::brief, plan_.patience / 2);
    own_ = go({}, Extent::whole, std::max(1.0, plan_.patience - seconds_since(begin)));
    const auto is_alike = [&](const Found& other) {
        return other.has_line && other.line.setting == own_.line.setting
            && other.line.figure == own_.line.figure && other.durations == own_.durations;
    };
    if (own_.has_line) {
        if (!is_alike(brief)) return;
        extent_ = Extent::brief;
        own_ = std::move(brief);
        return;
    }
    for (const std::string& each : brief.quantities) add_once(own_.quantities, each);
    const bool is_listed = !plan_.quantity.empty() && !own_.quantities.empty();
    if (own_.is_late && (!is_listed || brief.has_line)) throw TooSlow{};
    const std::string name(which.name);
    if (!is_listed)
        throw std::invalid_argument(name + " has no line that comes from runs"
                                    + (own_.skipped.empty() ? "" : ": " + listed(own_.skipped)));
    throw std::invalid_argument(name + " has no line of " + in_quotes(plan_.quantity)
                                + " that comes from runs; there are "
                                + (own_.is_late ? "in this time: " : "") + listed(own_.quantities));
}

bool CaseTrials::is_wanted(const CaseResult& line) const
{
    if (own_.has_line)
        return line.quantity == own_.line.quantity && line.setting == own_.line.setting;
    return plan_.quantity.empty() || line.quantity == plan_.quantity;
}

CaseTrials::Found CaseTrials::go(const Changes& changes, Extent extent, double patience) const
{
    const WallClock::time_point begin = WallClock::now();
    Found found;
    bool told = false, ended = false;  // of the runs so far; by who waits
    CaseListener listener;
    listener.ran = [&](const CaseRun& run) {
        found.all_seconds += run.simulated;
        // A line is of the runs since the line before, or of the same as that.
        if (std::exchange(told, false)) {
            found.scene.reset();
            found.durations.clear();
            found.steps_ms = found.seconds = 0;
            found.lost = false;
        }
        if (!found.scene) found.scene = run.scene;
        found.durations.push_back(run.duration);
        found.steps_ms += run.steps_ms;
        found.seconds += run.simulated;
        found.lost = found.lost || run.lost > 0;
    };
    listener.line = [&](const CaseResult& line) {
        told = true;
        if (line.verdict == Verdict::skipped) add_once(found.skipped, line.why);
        const bool is_measured =
            line.verdict != Verdict::skipped && line.method.empty() && line.unit != "ns";
        if (!is_measured || !found.scene || found.has_line) return;
        add_once(found.quantities, line.quantity);
        if (!is_wanted(line)) return;
        found.line = line;
        found.has_line = true;
    };
    listener.enough = [&] {
        ended = ended || (watch_.ended && watch_.ended());
        found.is_late = found.is_late || (!found.has_line && seconds_since(begin) > patience);
        return found.has_line || found.is_late || ended;
    };
    CaseBench bench({}, Fault::none, plan_.threads, extent, listener);
    bench.force(joined(plan_.given, changes));
    bench.run(which_);
    if (ended) throw Interrupted{};
    return found;
}

Trial CaseTrials::trial_of(const Found& found) const
{
    if (found.is_late) throw TooSlow{};
    if (!found.has_line) throw std::invalid_argument("the case has no such line by this");
    // Below zero is better than asked for: a limit that is kept with something to spare.
    const double figure = found.line.figure;
    const bool is_lost = found.lost || std::isnan(figure);
    const double error = is_lost ? INFINITY : std::max(0.0, figure);
    return {{error * error}, found.seconds > 0 ? found.steps_ms * kFrame / found.seconds : 0};
}

Trial CaseTrials::run(const Changes& changes, std::size_t /*trial*/, double patience) const
{
    return trial_of(changes.empty() ? own_ : go(changes, extent_, patience));
}

double CaseTrials::time_ms(const Changes& changes, std::size_t /*trial*/) const
{
    return trial_of(go(changes, extent_, std::numeric_limits<double>::infinity())).time_ms;
}

std::vector<Quantity> CaseTrials::quantities() const
{
    return {{own_.line.quantity, own_.line.unit,
             "what the case says it is off its exact answer by, or how far off a limit; 0 or less "
             "is no error"}};
}

std::string CaseTrials::state_hash() const
{
    Hash hash;
    for (const std::string& text : {std::string(which_.name), own_.line.setting, own_.line.quantity,
                                    own_.line.unit, text_of(plan_.given)}) {
        hash.add(std::uint64_t{text.size()});
        for (const char letter : text) hash.add(std::uint64_t{static_cast<unsigned char>(letter)});
    }
    hash.add(own_.line.figure);
    for (const double duration : own_.durations) hash.add(duration);
    return hash.text();
}

bool CaseTrials::holds_whole_steps(double dt) const
{
    return std::all_of(own_.durations.begin(), own_.durations.end(), [&](double duration) {
        const double steps = duration / dt;
        return steps > 0.5 && std::abs(steps - std::round(steps)) < 1e-9 * steps;
    });
}

}  // namespace throng
