#include "apps/throng/run_program.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace throng {

bool run_program(std::vector<std::string> words, const std::string& log)
{
    std::vector<char*> passed(words.size() + 1, nullptr);
    std::transform(words.begin(), words.end(), passed.begin(),
                   [](std::string& word) { return word.data(); });
    posix_spawn_file_actions_t actions;
    if (::posix_spawn_file_actions_init(&actions) != 0) return false;
    if (!log.empty())
        ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                           O_WRONLY | O_CREAT | O_APPEND, 0600);
    ::posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    ::pid_t child = 0;
    const int trouble =
        ::posix_spawnp(&child, passed[0], &actions, nullptr, passed.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (trouble != 0) return false;
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return false;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace throng
