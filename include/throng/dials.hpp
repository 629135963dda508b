// Dials: every choice that trades accuracy for time, by name.
//
// One table, which the command line, scene files, the cost report and the docs read. A name or a
// value is never changed, only added. A value that this build cannot do yet is in the table all the
// same: it is refused with a sentence that says what can be had instead.
#pragma once

#include "throng/settings.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace throng {

/// One value of a dial that has names for values.
struct Choice {
    std::string_view text;
    bool available = true;  // this build can do it
};

struct Dial {
    std::string_view name;
    std::string values;  // what may be set, default first
    std::string default_value;
    std::string_view unit;            // empty where it has none
    std::string_view trades;          // what more of it gives, and costs
    std::span<const Choice> choices;  // named values, default first; empty for a number
    bool available;                   // this build takes more than its default

    /// Empty, or what was wanted.
    std::string (*set)(Settings&, std::string_view text);
    /// The present value; setting it back gives the same settings.
    std::string (*get)(const Settings&);
};

/// All dials, in the order of the docs.
std::span<const Dial> dials();

/// The dial of that name, or null.
const Dial* find_dial(std::string_view name);

/// Sets a dial from text. Empty when done; otherwise the settings are as before and the answer says
/// what was wanted: `substeps: wanted a whole number from 1 to 1000, not "x"`.
std::string set_dial(Settings& settings, std::string_view name, std::string_view value);

/// The present value of a dial, as text that set_dial() takes; empty for an unknown name.
std::string dial_value(const Settings& settings, std::string_view name);

struct Scene;

/// Of Scene::dials_set those that do nothing, in that order, each with its reason:
/// `contact_rate: unused, solver pgs has no soft contacts`.
std::vector<std::string> unused_dials(const Scene& scene);

/// Which dial has a value that another's does not allow, and what was wanted; empty for none.
std::string clashing_dials(const Settings& settings);

/// A time in seconds, as a number or a fraction: "0.01", "1/60". NaN where it is neither.
double parse_time(std::string_view text);

}  // namespace throng
