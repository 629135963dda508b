// Command: the built program, run as a user runs it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace throng {

/// What a run of the program left behind.
struct Outcome {
    int code = -1;    // exit code; 128 + signal when it was killed
    std::string out;  // standard output
    std::string err;  // standard error
};

/// Runs `throng` with these words and waits for it. Where there is something to do meanwhile, it is
/// called once with the process, after it began.
Outcome run_throng(const std::vector<std::string>& words,
                   const std::function<void(pid_t)>& meanwhile = {});

/// The same with a terminal for its standard error.
Outcome run_throng_on_terminal(const std::vector<std::string>& words);

/// A folder for one test, empty at first and gone in the end.
class TestFolder {
public:
    TestFolder();
    ~TestFolder();
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    /// Writes a file and gives its path.
    std::string write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const;
    /// Names of the files in it, sorted.
    std::vector<std::string> files() const;

private:
    std::filesystem::path path_;
};

/// How often a text holds another.
std::size_t count_of(const std::string& text, const std::string& part);

}  // namespace throng
