// Interrupt: somebody wants the command to end.
#include "apps/throng/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace throng {
namespace {

// A handler can reach nothing but a global.
volatile std::sig_atomic_t noted = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

void note(int) { noted = 1; }

}  // namespace

void note_interrupts()
{
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

}  // namespace throng
