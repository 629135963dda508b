// Commands: what `throng NAME` can be. One file each; to add one, write it, declare it here and
// list it in main.cpp.
#pragma once

#include "apps/throng/options.hpp"

namespace throng {

/// What the process ends with. A body that was quarantined counts as a failed case.
inline constexpr int kDone = 0, kCaseFailed = 1, kBadInput = 2, kFault = 3, kInterrupted = 130;

struct Command {
    Usage usage;
    int (*run)(const Options& options) = nullptr;
    void (*more_help)(std::ostream& out) = nullptr;        // what follows the options; may be null
    const char* program = nullptr;                         // that this command is; null: this one
    bool (*by_program)(const Options& options) = nullptr;  // when it is; null: always
};

extern const Command kRun, kExplain, kScene, kCost, kCostOfCase, kBench;
extern const Usage kCasesUsage, kCostUsage;

/// Whether the word that `cost` was given is a hard case's, of which the program of the cases
/// knows more.
bool asks_for_case(const Options& options);

/// What main() does: runs the command that the words ask for, and answers with the exit code.
int run_program(std::span<const Command* const> commands, int count, char** words);

}  // namespace throng
