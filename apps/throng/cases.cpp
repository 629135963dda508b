// Cases: runs the hard cases that throng claims, and prints each figure beside its bound. A program
// of its own, which `throng cases` becomes, and `throng cost` where it is given a case.
#include "cost/hard_cases/cases.hpp"

#include "apps/throng/commands.hpp"
#include "apps/throng/interrupt.hpp"
#include "apps/throng/output_file.hpp"
#include "apps/throng/scene_argument.hpp"
#include "scene/files/json_writer.hpp"
#include "scene/names.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>

namespace throng {
namespace {

std::vector<const HardCase*> cases_asked(const Options& options)
{
    std::vector<const HardCase*> cases;
    std::vector<std::string_view> names;
    for (const HardCase& one : hard_cases()) names.push_back(one.name);
    for (const std::string_view word : options.words()) {
        const HardCase* const found = find_case(word);
        if (found == nullptr)
            throw BadInput("there is no case " + in_quotes(word)
                           + "; there are: " + either_of(names));
        if (std::find(cases.begin(), cases.end(), found) == cases.end()) cases.push_back(found);
    }
    if (cases.empty())
        for (const HardCase& one : hard_cases()) cases.push_back(&one);
    return cases;
}

Settings settings_asked(const Options& options)
{
    Settings settings;
    for (const std::string_view text : options.all("--set")) {
        const std::size_t equals = text.find('=');
        if (equals == std::string_view::npos)
            throw BadInput("--set: wanted DIAL=VALUE, not " + in_quotes(text));
        const std::string wrong =
            set_dial(settings, text.substr(0, equals), text.substr(equals + 1));
        if (!wrong.empty()) throw BadInput("--set: " + wrong);
    }
    return settings;
}

std::string_view text_of(Verdict verdict)
{
    switch (verdict) {
    case Verdict::pass:
        return "pass";
    case Verdict::fail:
        return "fail";
    case Verdict::missed:
        return "missed";
    default:
        return "skipped";
    }
}

// A figure that is held to nothing; apart, so that nobody takes it for a pass.
std::string shown_line(const CaseResult& result)
{
    std::ostringstream line;
    line << std::left << std::setw(5) << result.name << ' ' << std::scientific
         << std::setprecision(2) << result.figure << ' ' << std::setw(4) << result.unit << ' '
         << result.setting << ": " << result.quantity << '\n';
    return line.str();
}

void print_line(const CaseResult& result)
{
    std::cout << std::left << std::setw(5) << result.name << ' ' << std::setw(7)
              << text_of(result.verdict) << ' ' << std::right << std::scientific
              << std::setprecision(2) << result.figure << " <= " << result.bound << ' ' << std::left
              << std::setw(4) << result.unit << ' ' << result.setting << ": " << result.quantity
              << (result.why.empty() ? "" : " (" + result.why + ")") << std::endl;
}

// Which methods keep their bounds in which cases: a row a method, a column a case.
class MethodTable {
public:
    void add(const CaseResult& result)
    {
        if (result.method.empty()) return;
        keep(methods_, result.method);
        keep(cases_, result.name);
        bool& failed = failed_[{result.method, result.name}];
        failed = failed || result.verdict == Verdict::fail;
    }

    void print(std::ostream& out) const
    {
        if (methods_.empty()) return;
        std::size_t widest = 6;
        for (const std::string& method : methods_) widest = std::max(widest, method.size());
        const auto begin_row = [&](const std::string& name) {
            out << std::left << std::setw(static_cast<int>(widest)) << name;
        };
        begin_row("method");
        for (const std::string& name : cases_) out << ' ' << std::setw(4) << name;
        out << '\n';
        for (const std::string& method : methods_) {
            begin_row(method);
            for (const std::string& name : cases_)
                out << ' ' << std::setw(4) << text_of(method, name);
            out << '\n';
        }
        out << std::flush;
    }

private:
    static void keep(std::vector<std::string>& names, const std::string& name)
    {
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    // A dash where the method claims nothing that the case asks for.
    std::string_view text_of(const std::string& method, const std::string& name) const
    {
        const auto found = failed_.find({method, name});
        if (found == failed_.end()) return "-";
        return found->second ? "fail" : "pass";
    }

    std::vector<std::string> methods_, cases_;
    std::map<std::pair<std::string, std::string>, bool> failed_;
};

std::string json_line(const CaseResult& result)
{
    JsonMembers line;
    line.add_text("case", result.name)
        .add_text("setting", result.setting)
        .add_text("quantity", result.quantity)
        .add("figure", result.figure)
        .add("bound", result.bound)
        .add_text("unit", result.unit)
        .add_text("status", text_of(result.verdict))
        .add("ms", result.time_ms);
    if (!result.method.empty()) line.add_text("method", result.method);
    if (!result.why.empty()) line.add_text("why", result.why);
    return line.text();
}

int run_cases(const Options& options)
{
    const std::vector<const HardCase*> cases = cases_asked(options);
    const Settings settings = settings_asked(options);
    OutputFile json("--json", options.text("--json"));
    note_interrupts();

    std::size_t passed = 0, failed = 0, skipped = 0, missed = 0;
    std::string lines, shown;
    MethodTable methods;
    const auto take_line = [&](const CaseResult& result) {
        if (result.verdict == Verdict::shown)
            shown += shown_line(result);
        else
            print_line(result);
        methods.add(result);
        lines += (lines.empty() ? "  " : ",\n  ") + json_line(result);
        passed += result.verdict == Verdict::pass ? 1 : 0;
        failed += result.verdict == Verdict::fail ? 1 : 0;
        skipped += result.verdict == Verdict::skipped ? 1 : 0;
        missed += result.verdict == Verdict::missed ? 1 : 0;
    };
    // Nobody reads on: there is nothing left to run for.
    const auto ended = [&] { return interrupted() || (!std::cout && !json.asked_for()); };
    for (const HardCase* one : cases) {
        run_case(*one, settings, Fault::none, threads_asked(options), Extent::whole,
                 {take_line, ended, options.has("--energy")});
        if (ended()) break;
    }
    if (json.asked_for()) {
        json.stream() << "[\n" << lines << "\n]\n";
        json.keep();
    }
    if (!shown.empty()) std::cout << "measured, held to nothing:\n" << shown;
    methods.print(std::cout);
    std::cout << passed << " passed, " << failed << " failed";
    if (skipped > 0) std::cout << ", " << skipped << " skipped";
    if (missed > 0) std::cout << ", " << missed << " missed by default";
    std::cout << std::endl;
    if (interrupted()) return kInterrupted;
    return failed == 0 ? kDone : kCaseFailed;
}

void list_cases(std::ostream& out)
{
    out << "\ncases\n";
    std::vector<std::pair<std::string, std::string>> rows;
    for (const HardCase& one : hard_cases()) rows.emplace_back(one.name, one.about);
    print_columns(rows, out);
}

const Command kCases = {kCasesUsage, run_cases, list_cases};
const Command* const kCommands[] = {&kCases, &kCostOfCase};

}  // namespace
}  // namespace throng

int main(int count, char** words) { return throng::run_program(throng::kCommands, count, words); }
