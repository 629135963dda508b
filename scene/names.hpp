// Names: what a sentence about a wrong name or value needs.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace throng {

/// The text in quotes, fit for one line of a message: control characters escaped, the middle of a
/// long one left out.
std::string in_quotes(std::string_view text);

/// Shortest decimal that reads back to the same bits.
std::string number_text(double number);

/// The number that the whole text spells, in decimal; NaN where it spells none, or one that is not
/// finite. The same on every locale.
double parse_number(std::string_view text);

/// The known names nearest to a mistyped one, nearest first: at most three, none when all are far.
std::string nearest_names(std::string_view name, std::span<const std::string_view> known);

/// Words as a sentence lists them: "a", "a or b", "a, b or c".
std::string either_of(std::span<const std::string_view> words);

}  // namespace throng
