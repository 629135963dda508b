// Short text: a number as warnings tell it.
#pragma once

#include <string>

namespace throng {

/// Three digits say enough.
std::string short_text(double number);

}  // namespace throng
