// Command: the built program, run as a user runs it.
#include "tests/apps/throng/command.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <poll.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace throng {
namespace {

/// Reads both ends until they are closed.
void drain(int out, int err, Outcome& outcome)
{
    std::array<pollfd, 2> ends = {{{out, POLLIN, 0}, {err, POLLIN, 0}}};
    std::array<std::string*, 2> texts = {&outcome.out, &outcome.err};
    for (int open = 2; open > 0;) {
        ::poll(ends.data(), ends.size(), -1);
        for (std::size_t i = 0; i < 2; ++i) {
            if (ends[i].fd < 0 || ends[i].revents == 0) continue;
            std::array<char, 4096> buffer;
            const ssize_t got = ::read(ends[i].fd, buffer.data(), buffer.size());
            if (got > 0) {
                texts[i]->append(buffer.data(), static_cast<std::size_t>(got));
                continue;
            }
            // A terminal whose program has ended gives an error in place of an end.
            ::close(ends[i].fd);
            ends[i].fd = -1;
            --open;
        }
    }
}

Outcome run_with(const std::vector<std::string>& words,
                 int err_read,
                 int err_write,
                 const std::function<void(pid_t)>& meanwhile)
{
    std::vector<std::string> all = {THRONG_COMMAND};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    std::array<int, 2> out;
    if (::pipe2(out.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    const pid_t process = ::fork();
    if (process == 0) {
        ::dup2(out[1], STDOUT_FILENO);
        ::dup2(err_write, STDERR_FILENO);
        ::execv(arguments[0], arguments.data());
        ::_exit(127);
    }
    ::close(out[1]);
    ::close(err_write);
    if (meanwhile) meanwhile(process);
    Outcome outcome;
    drain(out[0], err_read, outcome);
    int status = 0;
    ::waitpid(process, &status, 0);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
}

}  // namespace

Outcome run_throng(const std::vector<std::string>& words,
                   const std::function<void(pid_t)>& meanwhile)
{
    std::array<int, 2> err;
    if (::pipe2(err.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    return run_with(words, err[0], err[1], meanwhile);
}

Outcome run_throng_on_terminal(const std::vector<std::string>& words)
{
    const int ours = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (ours < 0 || ::grantpt(ours) != 0 || ::unlockpt(ours) != 0)
        throw std::runtime_error("no terminal");
    std::array<char, 128> name;
    ::ptsname_r(ours, name.data(), name.size());
    const int theirs = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    return run_with(words, ours, theirs, {});
}

TestFolder::TestFolder()
{
    std::string name = (std::filesystem::temp_directory_path() / "throng_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for the test");
    path_ = name;
}

TestFolder::~TestFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string TestFolder::write(const std::string& name, const std::string& text) const
{
    std::ofstream(path_ / name, std::ios::binary) << text;
    return *this / name;
}

std::string TestFolder::read(const std::string& name) const
{
    std::ostringstream text;
    text << std::ifstream(path_ / name, std::ios::binary).rdbuf();
    return text.str();
}

std::vector<std::string> TestFolder::files() const
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::size_t count_of(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

}  // namespace throng
