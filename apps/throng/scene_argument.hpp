// Scene argument: the SCENE of a command line, with the dials that the line sets.
#pragma once

#include "apps/throng/mesh_option.hpp"
#include "apps/throng/options.hpp"
#include "throng/world.hpp"

#include <cstdint>

namespace throng {

struct SceneArgument {
    std::string label;  // the file as it was given, or NAME:SIZE and with which mesh
    std::string file;   // empty for a scene of the catalogue
    std::string mesh;   // the file of --mesh, empty without
    std::uint64_t seed = 0;
    Scene scene;  // settings and dials_set as the command line leaves them
};

inline constexpr std::int64_t kMostSteps = 1'000'000'000'000;

/// The options that read_scene_argument() reads, kMeshOption among them, for a command to list
/// among its own.
inline constexpr Option kSeedOption = {"--seed", "K",
                                       "seed of a scene of the catalogue, from 0 (default 1)"};
inline constexpr Option kDtOption = {
    "--dt", "S", "the step, s, as a number or a fraction (default: the scene's, else 1/60)"};
inline constexpr Option kSetOption = {
    "--set", "DIAL=VALUE", "sets a dial; may be given again (default: the scene's values)", true};
inline constexpr Option kThreadsOption = {
    "--threads", "N", "threads that run the step, 1 to 1024 (default: all cores)"};

/// Reads the scene that the first word names: a file, or a scene of the catalogue with its size.
/// Throws SceneError and BadInput.
SceneArgument read_scene_argument(const Options& options);

/// Sets a dial that an option of the line names. Throws BadInput, which names the option.
void set_from_line(Scene& scene,
                   std::string_view option,
                   std::string_view name,
                   std::string_view value);

/// Sets the dials that --set of the line names. Throws BadInput.
void set_dials(Scene& scene, const Options& options);
/// The same, and --dt, where that is one step and no list of them.
void set_dials_and_dt(Scene& scene, const Options& options);

/// The world of the scene; what it lost on the way goes to stderr, unless quiet. Throws BadInput
/// when it is impossible.
World make_world(const SceneArgument& argument, int threads, bool quiet = false);

/// Number of threads asked for; 0 for all cores.
int threads_asked(const Options& options);

std::uint64_t seed_asked(const Options& options);

/// Writes all dials: values, default, unit and what they trade.
void print_dials(std::ostream& out);

}  // namespace throng
