// Version: which throng this is, and what it runs on.
#pragma once

namespace throng {

/// As the package says it: "0.1.0".
const char* version();

/// Of the instruction sets that the wide kernels were compiled for, the one that they run by:
/// "scalar", "avx2" or "avx512". The widest that this machine has (avx2 stands for AVX2 and FMA,
/// x86-64-v3), or what the environment variable THRONG_LANES asks for, which is read once. The
/// answer never depends on it. Throws std::runtime_error for one that cannot be had.
const char* lane_width();

/// True for "scalar", "avx2" or "avx512" where this machine has it.
bool machine_has_lanes(const char* width);

/// Takes the kernels of another width that this machine has from here on, to measure it; not while
/// a world steps. Throws std::runtime_error for one that cannot be had.
void take_lanes(const char* width);

}  // namespace throng
