#include "cost/shared_data.hpp"

#include <cstdlib>

namespace throng {

namespace fs = std::filesystem;

fs::path find_shared(const fs::path& name)
{
    // Cases change no environment.
    const char* named = std::getenv("THRONG_DATA");  // NOLINT(concurrency-mt-unsafe)
    if (named != nullptr && fs::exists(fs::path(named) / name)) return fs::path(named) / name;
    const fs::path source = fs::absolute(__FILE__);
    for (auto folder = source.parent_path(); folder != folder.root_path();
         folder = folder.parent_path())
        if (fs::exists(folder / "shared/data" / name)) return folder / "shared/data" / name;
    return {};
}

}  // namespace throng
