// Version: which throng this is, and what it runs on.
#pragma once

namespace throng {

/// As the package says it: "0.1.0".
const char* version();

/// Of the instruction sets that the wide kernels were compiled for, the one that they run by:
/// "scalar", "avx2" or "avx512". The widest that this machine has, or what the environment variable
/// THRONG_LANES asks for. Read once: the width of a run never changes under it. Throws
/// std::runtime_error for one that cannot be had.
const char* lane_width();

}  // namespace throng
