// Cases usage: how `throng cases` is asked for.
#include "apps/throng/commands.hpp"
#include "apps/throng/scene_argument.hpp"

namespace throng {
namespace {

constexpr Option kOptions[] = {
    {"--energy", "",
     "adds a line to each case: energy that its runs by the default dials gained from nowhere"},
    {"--json", "FILE", "writes the lines as JSON too"},
    kSetOption,
    kThreadsOption,
};

}  // namespace

const Usage kCasesUsage = {
    "cases",
    "[NAME...]",
    "Runs hard cases (all, or those named) and prints each figure beside its bound.",
    0,
    1000,
    kOptions};

}  // namespace throng
