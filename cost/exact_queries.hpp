// Exact queries: what public sets ask of corners and triangles, edges and edges, with the answers.
#pragma once

#include "throng/impact_query.hpp"

#include <filesystem>
#include <vector>

namespace throng {

struct ExactQuery {
    LinearQuestion question;
    bool meets = false;
};

/// All queries of one kind in a set's folder; none where it has none of that kind.
std::vector<ExactQuery> read_exact_queries(const std::filesystem::path& folder, bool edges);

}  // namespace throng
