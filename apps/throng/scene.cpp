// Scene: writes a scene of the catalogue as a file, or lists the catalogue.
#include "apps/throng/commands.hpp"
#include "apps/throng/interrupt.hpp"
#include "apps/throng/scene_argument.hpp"
#include "scene/files/scene_schema.hpp"
#include "scene/names.hpp"
#include "throng/catalog.hpp"
#include "throng/scene_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <unistd.h>

namespace throng {
namespace {

namespace fs = std::filesystem;

constexpr Option kOptions[] = {
    kSeedOption,
    kMeshOption,
    {"--out", "FILE.json",
     "where it goes; many bodies go to FILE.0.bin beside it (default: the "
     "standard output, for scenes that need no other file)"},
    {"--schema", "",
     "the scene file format instead, as a JSON schema for editors and other programs"},
};

void list_catalog()
{
    std::size_t name_width = 4, range_width = 5;
    std::vector<std::string> ranges;
    for (const CatalogEntry& entry : catalog()) {
        ranges.push_back(std::to_string(entry.least) + " to " + std::to_string(entry.most));
        name_width = std::max(name_width, entry.name.size());
        range_width = std::max(range_width, ranges.back().size());
    }
    const auto print = [&](std::string name, const std::string& size, std::string range,
                           std::string_view about) {
        name.resize(std::max(name.size(), name_width), ' ');
        range.resize(std::max(range.size(), range_width), ' ');
        const std::size_t pad = 7 - std::min<std::size_t>(7, size.size());
        std::cout << name << "  " << std::string(pad, ' ') << size << "  " << range << "  " << about
                  << '\n';
    };
    print("name", "default", "sizes", "what it is");
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const CatalogEntry& entry = catalog()[i];
        print(std::string(entry.name), std::to_string(entry.default_size), ranges[i], entry.about);
    }
}

/// A folder that is gone in the end, with whatever is still in it.
class PassingFolder {
public:
    explicit PassingFolder(fs::path path) : path_(std::move(path))
    {
        std::error_code trouble;
        if (!fs::create_directory(path_, trouble))
            throw BadInput(path_.parent_path().string() + ": cannot be written: "
                           + (trouble ? trouble.message() : "a file is in the way"));
    }
    ~PassingFolder()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    PassingFolder(const PassingFolder&) = delete;
    PassingFolder& operator=(const PassingFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

std::string own_name(std::string_view base)
{
    return std::string(base) + '.' + std::to_string(::getpid()) + ".part";
}

/// Writes the scene in a folder and gives its files, the scene itself last.
std::vector<fs::path>
write_in(const PassingFolder& folder, const Scene& scene, const std::string& name)
{
    try {
        write_scene(scene, (folder.path() / name).string());
    } catch (const std::runtime_error& error) {
        throw BadInput(error.what());
    }
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
        if (entry.path().filename() != name) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    files.push_back(folder.path() / name);
    return files;
}

int write_to_stdout(const Scene& scene)
{
    const PassingFolder folder(fs::temp_directory_path() / own_name("throng"));
    const std::vector<fs::path> files = write_in(folder, scene, "scene.json");
    if (files.size() > 1)
        throw BadInput("scene: its bodies or meshes need files of their own beside it; say where "
                       "with --out FILE.json");
    if (interrupted()) return kInterrupted;
    std::cout << std::ifstream(files.front(), std::ios::binary).rdbuf();
    return kDone;
}

int write_to_file(const Scene& scene, const fs::path& out)
{
    std::error_code ignored;
    if (!out.has_filename() || fs::is_directory(out, ignored))
        throw BadInput("--out: " + out.string() + ": wanted the name of a file");
    // A new file takes the place of the old: a device or a pipe must not lose its name to it.
    if (fs::exists(out, ignored) && !fs::is_regular_file(fs::symlink_status(out, ignored)))
        throw BadInput("--out: " + out.string()
                       + ": wanted the name of a plain file; without --out, a scene that needs no "
                         "other file goes to the standard output");
    const fs::path where = out.has_parent_path() ? out.parent_path() : fs::path(".");
    const PassingFolder folder(where / own_name(out.filename().string()));
    const std::vector<fs::path> files = write_in(folder, scene, out.filename().string());
    if (interrupted()) return kInterrupted;
    for (const fs::path& file : files) {
        const fs::path there = out.parent_path() / file.filename();
        std::error_code trouble;
        fs::rename(file, there, trouble);
        if (trouble)
            throw BadInput("--out: " + there.string()
                           + ": cannot be written: " + trouble.message());
        std::cout << "file: " << there.string() << '\n';
    }
    std::cout << "bodies: " << scene.body_count() << '\n';
    return kDone;
}

int write_catalog_scene(const Options& options)
{
    if (options.has("--schema")) {
        if (!options.words().empty() || options.has("--out") || options.has("--seed")
            || options.has("--mesh"))
            throw BadInput("--schema: wanted nothing beside it; it goes to the standard output");
        std::cout << scene_schema();
        return kDone;
    }
    if (options.words().empty()) {
        if (options.has("--out") || options.has("--seed") || options.has("--mesh"))
            throw BadInput("scene: wanted the name of a scene to write (throng scene lists them)");
        list_catalog();
        return kDone;
    }
    std::string asked(options.words()[0]);
    if (options.words().size() > 1) {
        if (asked.find(':') != std::string::npos)
            throw BadInput("scene: the size is given twice: " + in_quotes(asked) + " and "
                           + in_quotes(options.words()[1]));
        asked += ':' + std::string(options.words()[1]);
    }
    const ParsedScene parsed = parse_scene(asked);
    if (parsed.entry == nullptr) throw BadInput(parsed.error);
    const std::uint64_t seed = seed_asked(options);

    note_interrupts();
    const MeshOption mesh(options);
    std::error_code ignored;
    if (mesh.asked_for() && fs::equivalent(mesh.file(), options.text("--out"), ignored))
        throw BadInput("--out: " + mesh.file() + " is taken by --mesh");
    const Scene scene = mesh.make(*parsed.entry, parsed.size, seed);
    return options.has("--out") ? write_to_file(scene, options.text("--out"))
                                : write_to_stdout(scene);
}

}  // namespace

const Command kScene = {
    {"scene", "[NAME [N]]",
     "Writes a scene of the catalogue as a scene file; without a name, lists the catalogue.", 0, 2,
     kOptions},
    write_catalog_scene,
    nullptr,
};

}  // namespace throng
