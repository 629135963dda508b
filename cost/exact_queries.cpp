#include "cost/exact_queries.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace throng {

namespace {

namespace fs = std::filesystem;

// Eight rows a query, each of a fraction an axis and the truth: the points at the start, then
// those at the end.
void read_queries(const fs::path& file, bool edges, std::vector<ExactQuery>& queries)
{
    std::ifstream text(file);
    ExactQuery query;
    query.question.edges = edges;
    std::string line;
    for (std::size_t row = 0; std::getline(text, line); row = (row + 1) % 8) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream numbers(line);
        Vec3 above, below;
        int truth = 0;
        numbers >> above.x() >> below.x() >> above.y() >> below.y() >> above.z() >> below.z()
            >> truth;
        auto& points = row < 4 ? query.question.from : query.question.to;
        points[row % 4] = above.cwiseQuotient(below);
        query.meets = truth != 0;
        if (row == 7) queries.push_back(query);
    }
}

}  // namespace

std::vector<ExactQuery> read_exact_queries(const fs::path& folder, bool edges)
{
    const fs::path kind = folder / (edges ? "edge-edge" : "vertex-face");
    if (!fs::exists(kind)) return {};
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(kind)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<ExactQuery> queries;
    for (const fs::path& file : files) read_queries(file, edges, queries);
    return queries;
}

}  // namespace throng
