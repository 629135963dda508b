// Lane width: which of the instruction sets that the wide kernels were compiled for a run takes.
#pragma once

namespace throng {

/// True for "scalar", "avx2" or "avx512" where this machine has it.
bool machine_has_lanes(const char* width);

/// The widest that this machine has, or what the environment variable THRONG_LANES asks for. Read
/// once: the width of a run never changes under it. Throws std::runtime_error for one that cannot
/// be had.
const char* lane_width();

}  // namespace throng
