// Short text: a number as remarks tell it.
#pragma once

#include <string>

namespace throng {

/// Three digits say enough.
std::string short_text(double number);

}  // namespace throng
