#include "cooking/fields/field_module.hpp"

#include "throng/version.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <optional>
#include <string_view>
#include <utility>

namespace throng {
namespace {

constexpr const char* kFile = "libthrong_cooking.so";

// Where the library that this is in may be, and where the program is. What the linker tells of a
// program is how it was called, which may be a name that the shell looked up.
std::vector<std::filesystem::path> own_folders()
{
    std::vector<std::filesystem::path> folders;
    Dl_info told{};
    const auto* const here = reinterpret_cast<const void*>(&field_module);
    if (::dladdr(here, &told) != 0 && told.dli_fname != nullptr && *told.dli_fname == '/')
        folders.push_back(std::filesystem::path(told.dli_fname).parent_path());
    std::error_code trouble;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", trouble);
    if (!trouble) folders.push_back(program.parent_path());
    return folders;
}

// In the order in which they are tried. The last is for the system to find.
std::vector<std::string> places()
{
    if (const char* const named = std::getenv("THRONG_COOKING");  // NOLINT(concurrency-mt-unsafe)
        named != nullptr && *named != '\0')
        return {named};
    std::vector<std::string> all;
    for (const std::filesystem::path& folder : own_folders())
        for (const std::filesystem::path& place :
             {folder, folder / ".." / THRONG_LIBRARIES, folder / ".." / "lib",
              folder / ".." / ".." / "lib"})
            all.push_back((place / kFile).string());
    all.emplace_back(kFile);
    return all;
}

OpenedFieldModule refused(const std::string& why)
{
    return {nullptr,
            "needs " + std::string(kFile) + ", which makes and reads level sets: " + why
                + "; install it beside the program or its libraries, or name it in THRONG_COOKING"};
}

// A program sets it as it begins.
BuildFieldModule build_file;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

// The first that is found, or none: `why` says of the last place what is wrong there.
std::optional<OpenedFieldModule> find_module(std::string& why)
{
    for (const std::string& place : places()) {
        std::error_code ignored;
        if (place.find('/') != std::string::npos && !std::filesystem::exists(place, ignored)) {
            why = place + ": no such file";
            continue;
        }
        void* const opened = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (opened == nullptr) {
            const char* const said =
                ::dlerror();  // NOLINT(concurrency-mt-unsafe): its thread's own
            why = said != nullptr ? said : place;
            continue;
        }
        using Door = const FieldModule* (*)();
        const auto door = reinterpret_cast<Door>(::dlsym(opened, "throng_field_module"));
        const FieldModule* const module = door != nullptr ? door() : nullptr;
        if (module == nullptr || module->size != sizeof(FieldModule)
            || std::string_view(module->version) != version())
            return refused(place + " is of another version");
        return OpenedFieldModule{module, {}};
    }
    return std::nullopt;
}

OpenedFieldModule open_module()
{
    std::string why;
    std::optional<OpenedFieldModule> found = find_module(why);
    if (!found && build_file && build_file()) found = find_module(why);
    return found ? *found : refused(why);
}

}  // namespace

void build_field_module_by(BuildFieldModule build) { build_file = std::move(build); }

const OpenedFieldModule& field_module()
{
    static const OpenedFieldModule opened = open_module();
    return opened;
}

}  // namespace throng
