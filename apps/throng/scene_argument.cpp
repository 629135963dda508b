// Scene argument: the SCENE of a command line, with the dials that the line sets.
#include "apps/throng/scene_argument.hpp"

#include "cooking/cache/disk_cache.hpp"
#include "scene/files/scene_error.hpp"
#include "scene/names.hpp"
#include "throng/catalog.hpp"
#include "throng/dials.hpp"
#include "throng/scene_file.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>

namespace throng {
namespace {

/// A word that no scene of the catalogue answers to. `./pile` is a file whatever it is called.
bool is_file(std::string_view word)
{
    if (word.find('/') != std::string_view::npos || word.ends_with(".json")) return true;
    std::error_code ignored;
    return find_scene(word.substr(0, word.find(':'))) == nullptr
        && std::filesystem::exists(word, ignored);
}

}  // namespace

SceneArgument read_scene_argument(const Options& options)
{
    const std::string_view word = options.words().front();
    SceneArgument argument;
    if (is_file(word)) {
        if (options.has("--seed"))
            throw BadInput("--seed: only a scene of the catalogue has one; this one is a file");
        if (options.has("--mesh"))
            throw BadInput("--mesh: only a scene of the catalogue takes one; this one is a file");
        argument.label = argument.file = word;
        argument.scene = read_scene(argument.file);
    } else {
        const ParsedScene parsed = parse_scene(word);
        if (parsed.entry == nullptr) throw BadInput(parsed.error + " (nor is there such a file)");
        argument.label = std::string(parsed.entry->name) + ':' + std::to_string(parsed.size);
        argument.seed = seed_asked(options);
        const MeshOption mesh(options);
        argument.scene = mesh.make(*parsed.entry, parsed.size, argument.seed);
        if (mesh.asked_for()) {
            argument.mesh = mesh.file();
            argument.label += " --mesh " + mesh.file();
        }
    }
    argument.scene.cache_folder = default_cache_folder().string();
    set_dials_and_dt(argument.scene, options);
    return argument;
}

void set_from_line(Scene& scene,
                   std::string_view option,
                   std::string_view name,
                   std::string_view value)
{
    const std::string trouble = set_dial(scene.settings, name, value);
    if (!trouble.empty()) throw BadInput(std::string(option) + ": " + trouble);
    auto& set = scene.dials_set;
    if (std::find(set.begin(), set.end(), name) == set.end()) set.emplace_back(name);
}

void set_dials(Scene& scene, const Options& options)
{
    for (const std::string_view setting : options.all("--set")) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string_view::npos)
            throw BadInput("--set: wanted DIAL=VALUE, not " + in_quotes(setting));
        set_from_line(scene, "--set", setting.substr(0, equals), setting.substr(equals + 1));
    }
}

void set_dials_and_dt(Scene& scene, const Options& options)
{
    set_dials(scene, options);
    if (options.has("--dt")) set_from_line(scene, "--dt", "dt", options.text("--dt"));
}

World make_world(const SceneArgument& argument, int threads, bool quiet)
{
    try {
        World world(argument.scene, threads);
        if (quiet) return world;
        for (const std::string& warning : world.warnings())
            std::cerr << "warning: " << warning << '\n';
        return world;
    } catch (const SceneRefused& refused) {
        if (argument.file.empty()) throw BadInput(argument.label + ": " + refused.what());
        throw error_in_scene(argument.file, refused.trouble());
    } catch (const std::invalid_argument& error) {
        throw BadInput(argument.label + ": " + error.what());
    }
}

std::uint64_t seed_asked(const Options& options)
{
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    constexpr auto kStandard = static_cast<std::int64_t>(kDefaultSeed);
    return static_cast<std::uint64_t>(options.whole("--seed", kStandard, 0, kMost));
}

int threads_asked(const Options& options)
{
    return static_cast<int>(options.whole("--threads", 0, 1, 1024));
}

void print_dials(std::ostream& out)
{
    out << "\ndials (values with * are not available in this build)\n";
    std::vector<std::pair<std::string, std::string>> rows;
    for (const Dial& dial : dials()) {
        std::string values = dial.choices.empty() ? dial.values : "";
        for (const Choice& choice : dial.choices)
            values += (values.empty() ? "" : ", ") + std::string(choice.text)
                + (choice.available ? "" : "*");
        std::string text = values;
        if (!dial.unit.empty()) text += ", " + std::string(dial.unit);
        text += dial.available ? " (default " + dial.default_value + "); "
                               : " (" + dial.default_value + " alone in this build); ";
        rows.emplace_back(dial.name, text + std::string(dial.trades));
    }
    print_columns(rows, out);
}

}  // namespace throng
