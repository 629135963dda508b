// Shared data: real input from public projects, kept beside the project and not in it.
#pragma once

#include <filesystem>

namespace throng {

/// The path of a file or folder of the shared data, or an empty one where it is absent. Looks in
/// the directory named by THRONG_DATA, then in shared/data beside each folder above the sources.
std::filesystem::path find_shared(const std::filesystem::path& name);

}  // namespace throng
