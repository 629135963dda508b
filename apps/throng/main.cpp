// Main: the command, with all its words.
#include "apps/throng/commands.hpp"

namespace throng {
namespace {

// Most of what takes long to compile, and what few ask for: a program of its own.
const Command kCases = {kCasesUsage, nullptr, nullptr, "throng_cases"};

const Command* const kCommands[] = {&kRun, &kExplain, &kCost, &kScene, &kCases, &kBench};

}  // namespace
}  // namespace throng

int main(int count, char** words) { return throng::run_program(throng::kCommands, count, words); }
