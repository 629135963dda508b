// Shared data: real input from public projects, kept beside the project and not in it.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace throng {

/// The path of a file of the shared data, or an empty one where it is absent. Looks in the
/// directory named by THRONG_DATA, then in shared/data beside each folder above the sources.
inline std::filesystem::path shared_data(const std::string& name)
{
    // Tests change no environment.
    const char* named = std::getenv("THRONG_DATA");  // NOLINT(concurrency-mt-unsafe)
    if (named != nullptr && std::filesystem::exists(std::filesystem::path(named) / name))
        return std::filesystem::path(named) / name;
    const std::filesystem::path source = std::filesystem::absolute(__FILE__);
    for (auto folder = source.parent_path(); folder != folder.root_path();
         folder = folder.parent_path())
        if (std::filesystem::exists(folder / "shared/data" / name))
            return folder / "shared/data" / name;
    return {};
}

}  // namespace throng
