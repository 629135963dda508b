// Catalogue: scenes by name, for the command, the tests and the benchmarks alike.
//
// A scene is written "NAME" or "NAME:SIZE". To add one: write its recipe, declare it in
// recipes.hpp, list it in catalog.cpp, and every test of the catalogue runs on it.
#pragma once

#include "throng/scene.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace throng {

/// A scene on offer. What the size counts is said in `about`.
struct CatalogEntry {
    std::string_view name;
    int default_size = 0;
    int least = 1;
    int most = 0;
    std::string_view about;
    Scene (*make)(int size, std::uint64_t seed) = nullptr;
    /// The same with a mesh in place of the generated ones, brought to their size; null where the
    /// scene has none that another could replace.
    Scene (*make_of)(int size, std::uint64_t seed, const TriangleSoup& mesh) = nullptr;
};

/// All scenes, in the order in which they are listed to users.
std::span<const CatalogEntry> catalog();

/// The scene of that name, or null.
const CatalogEntry* find_scene(std::string_view name);

/// What a text "NAME" or "NAME:SIZE" asks for; when it asks for nothing on offer, entry is null and
/// error says what was wanted.
struct ParsedScene {
    const CatalogEntry* entry = nullptr;
    int size = 0;
    std::string error;
};
ParsedScene parse_scene(std::string_view text);

inline constexpr std::uint64_t kDefaultSeed = 1;

/// Makes the scene. Throws std::invalid_argument, with parse_scene's words, when there is none of
/// that name or it cannot have that size.
Scene make_scene(std::string_view name, int size, std::uint64_t seed = kDefaultSeed);

}  // namespace throng
