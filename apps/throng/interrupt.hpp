// Interrupt: somebody wants the command to end.
#pragma once

namespace throng {

/// From now on SIGINT, SIGTERM and SIGHUP are noted and do nothing else, so that the step ends and
/// files are closed. A second one ends the process at once.
void note_interrupts();

/// One was noted.
bool interrupted();

}  // namespace throng
