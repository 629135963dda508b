// Changes: dials turned away from what a scene has.
#pragma once

#include "throng/scene.hpp"

#include <string>
#include <vector>

namespace throng {

struct Change {
    std::string dial, value;
    bool operator==(const Change&) const = default;
};

/// No dial twice.
using Changes = std::vector<Change>;

/// `dt=1/120 substeps=8`; empty for none.
std::string text_of(const Changes& changes);
/// As the command line takes them: `--set dt=1/120 --set substeps=8`.
std::string as_options(const Changes& changes);
/// As a scene file has them: `"settings": {"dt": "1/120", "substeps": 8}`.
std::string as_settings(const Changes& changes);

/// Both, the second's value where they turn the same dial.
Changes joined(const Changes& first, const Changes& second);

/// The scene by them. Throws std::invalid_argument where they cannot be had together.
Scene changed(const Scene& scene, const Changes& changes);

}  // namespace throng
