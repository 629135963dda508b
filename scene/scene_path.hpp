// Scene path: which part of a scene is meant, by name: `bodies[3].shape`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace throng {

/// One step down: into a member by its key, or into a list by its place.
struct PathStep {
    std::string key;
    std::size_t index = 0;
    bool is_index = false;

    // NOLINTBEGIN(google-explicit-constructor): a path is written as keys and places
    PathStep(std::string member) : key(std::move(member)) { }
    PathStep(const char* member) : key(member) { }
    PathStep(std::size_t place) : index(place), is_index(true) { }
    // NOLINTEND(google-explicit-constructor)
};

/// From the top of the scene downwards; empty is the scene itself.
using ScenePath = std::vector<PathStep>;

/// The path as messages have it. A key that is no plain word is put in brackets and quotes.
std::string path_text(const ScenePath& path);

}  // namespace throng
