// Interrupt: somebody wants the command to end.
#include "apps/throng/interrupt.hpp"

#include "apps/throng/commands.hpp"

#include <csignal>
#include <initializer_list>
#include <iostream>
#include <semaphore.h>
#include <unistd.h>
#include <utility>

namespace throng {
namespace {

// A handler can reach nothing but globals, and may wake nobody but by such a semaphore.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
volatile std::sig_atomic_t noted = 0;
sem_t awaited;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void note(int)
{
    noted = 1;
    ::sem_post(&awaited);
}

sem_t& awaited_by_all()
{
    static const int made = ::sem_init(&awaited, 0, 0);
    static_cast<void>(made);
    return awaited;
}

}  // namespace

void note_interrupts()
{
    awaited_by_all();
    struct sigaction action = {};
    action.sa_handler = note;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
    // A run under nohup goes on without its terminal.
    struct sigaction before = {};
    ::sigaction(SIGHUP, nullptr, &before);
    if (before.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() { return noted != 0; }

StepGuard::StepGuard(std::function<void()> last_words)
    : last_words_(std::move(last_words)), watch_([this] { watch(); })
{ }

StepGuard::~StepGuard()
{
    {
        const std::lock_guard lock(guard_);
        over_ = true;
    }
    ended_.notify_all();
    ::sem_post(&awaited_by_all());
    watch_.join();
}

void StepGuard::set_within(bool within)
{
    const std::lock_guard lock(guard_);
    within_ = within;
}

void StepGuard::watch()
{
    while (::sem_wait(&awaited_by_all()) != 0) { }
    std::unique_lock lock(guard_);
    // Whoever is not within a step after this time finds the interrupt himself before the next.
    ended_.wait_for(lock, kPatience, [this] { return over_; });
    if (over_ || !within_) return;
    last_words_();
    std::cerr << "interrupted within a step; what comes at the end of a run is not written\n"
              << std::flush;
    ::_exit(kInterrupted);
}

}  // namespace throng
