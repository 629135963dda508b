#include "apps/throng/launcher.hpp"

#include "cooking/fields/field_module.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace throng {
namespace {

// What it says goes to the standard error: the output is the command's.
bool build(std::string launcher, std::string what)
{
    std::string word = "build";
    const std::array<char*, 4> words = {launcher.data(), word.data(), what.data(), nullptr};
    posix_spawn_file_actions_t actions;
    if (::posix_spawn_file_actions_init(&actions) != 0) return false;
    ::posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    ::pid_t child = 0;
    const int trouble =
        ::posix_spawn(&child, launcher.c_str(), &actions, nullptr, words.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (trouble != 0) return false;
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return false;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void build_by_launcher()
{
    const char* const launcher = std::getenv("THRONG_LAUNCHER");  // NOLINT(concurrency-mt-unsafe)
    if (launcher == nullptr || *launcher != '/') return;
    build_field_module_by(
        [launcher = std::string(launcher)] { return build(launcher, "level-sets"); });
}

}  // namespace throng
