// Launcher: the script at the root, which builds what a command turns out to need.
#pragma once

namespace throng {

/// Has the library that makes and reads level sets built when a scene first has some, where the
/// launcher started this program: THRONG_LAUNCHER names it then.
void build_by_launcher();

}  // namespace throng
