// Forks: a program that links throng has one thread, and so has a child of it, which ends.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <sys/wait.h>
#include <thread>
#include <throng/throng.hpp>
#include <unistd.h>

namespace {

long thread_count()
{
    return std::distance(std::filesystem::directory_iterator("/proc/self/task"),
                         std::filesystem::directory_iterator());
}

// Simulates and leaves as programs do: what libraries registered for the end runs.
[[noreturn]] void be_a_child()
{
    throng::World world(throng::make_scene("pile", 20), 2);
    world.step(10);
    std::exit(world.report().step == 10 ? 0 : 1);
}

// Whether a child ended well within ten seconds; one that hangs is killed.
bool ended_well(pid_t child)
{
    for (int tenth = 0; tenth < 100; ++tenth) {
        int status = 0;
        if (::waitpid(child, &status, WNOHANG) == child)
            return WIFEXITED(status) && WEXITSTATUS(status) == 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    return false;
}

}  // namespace

int main()
{
    const long threads = thread_count();
    if (threads != 1) std::printf("linked, throng has started %ld threads\n", threads - 1);
    const pid_t child = ::fork();
    if (child == 0) be_a_child();
    const bool well = ended_well(child);
    if (!well) std::printf("a forked child does not end\n");
    return threads == 1 && well ? 0 : 1;
}
