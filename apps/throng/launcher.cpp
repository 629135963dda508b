#include "apps/throng/launcher.hpp"

#include "apps/throng/run_program.hpp"
#include "cooking/fields/field_module.hpp"

#include <cstdlib>
#include <string>

namespace throng {
void build_by_launcher()
{
    const char* const launcher = std::getenv("THRONG_LAUNCHER");  // NOLINT(concurrency-mt-unsafe)
    if (launcher == nullptr || *launcher != '/') return;
    build_field_module_by([launcher = std::string(launcher)] {
        return run_program({launcher, "build", "level-sets"});
    });
}

}  // namespace throng
