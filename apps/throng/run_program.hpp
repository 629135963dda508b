// Run program: another program, run and waited for.
#pragma once

#include <string>
#include <vector>

namespace throng {

/// Whether a program did what it was told.
///
///   words  the program, sought along PATH where it has no slash, and what is passed to it
///   log    a file that all it says is appended to; empty: it goes to the standard error, as the
///          output is the command's
bool run_program(std::vector<std::string> words, const std::string& log = {});

}  // namespace throng
