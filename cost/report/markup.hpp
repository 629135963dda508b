// Markup: text as HTML and SVG have it.
#pragma once

#include <string>
#include <string_view>

namespace throng {

/// The text with what would end it, or begin an element, written as entities.
std::string in_markup(std::string_view text);

/// A place or length in a drawing, to a hundredth.
std::string pixels(double length);

}  // namespace throng
