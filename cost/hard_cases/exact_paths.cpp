// Exact paths: H42, whether corners and triangles, edges and edges, meet on straight lines.
//
// Answers: exact ones that come with the sets, in integers. None that meet may be missed; how many
// of those that do not are told to is printed as their share, for a tolerance of a millionth.
#include "cost/exact_queries.hpp"
#include "cost/hard_cases/hard_cases.hpp"
#include "cost/shared_data.hpp"
#include "throng/dials.hpp"

#include <algorithm>
#include <filesystem>

namespace throng {

namespace {

namespace fs = std::filesystem;

constexpr double kTolerance = 1e-6;  // m, as the sets are commonly asked with; they are some m wide

void ask_set(CaseBench& bench, const std::string& name, const std::vector<ExactQuery>& queries)
{
    const auto count = static_cast<double>(queries.size());
    for (const Choice& method : find_dial("toi_method")->choices) {
        Settings settings;
        set_dial(settings, "toi_method", method.text);
        double missed = 0, spurious = 0, evaluations = 0, apart = 0;
        for (const ExactQuery& query : queries) {
            const ImpactAnswer answer =
                bench.ask_linear_paths(query.question, settings.toi_method, kTolerance);
            missed += query.meets && !(answer.meets && answer.time <= 1) ? 1 : 0;
            spurious += !query.meets && answer.meets ? 1 : 0;
            apart += query.meets ? 0 : 1;
            evaluations += answer.evaluations;
        }
        const double ns = bench.spent_on(method.text) * 1e6 / count;
        const std::string setting = name + ", " + std::to_string(queries.size()) + " queries";
        bench.report_method(method.text, setting, "touches missed", missed, 0, "1");
        const std::string by = setting + ", " + std::string(method.text);
        bench.show(by, "of those apart, told to touch", spurious / std::max(apart, 1.0), "1");
        bench.show(by, "evaluations a query", evaluations / count, "1");
        bench.show(by, "time a query", ns, "ns");
    }
}

}  // namespace

void case_exact_paths(CaseBench& bench)
{
    const fs::path sets = find_shared("ccd");
    if (sets.empty()) {
        bench.skip("public sets", "touches missed", "shared/data/ccd is absent");
        return;
    }
    std::vector<fs::path> folders;
    for (const auto& entry : fs::directory_iterator(sets))
        if (entry.is_directory()) folders.push_back(entry.path());
    std::sort(folders.begin(), folders.end());
    for (const fs::path& folder : folders)
        for (const bool edges : {false, true})
            if (const std::vector<ExactQuery> queries = read_exact_queries(folder, edges);
                !queries.empty())
                ask_set(bench, folder.filename().string() + (edges ? " edge-edge" : " vertex-face"),
                        queries);
}

}  // namespace throng
