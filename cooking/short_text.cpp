#include "cooking/short_text.hpp"

#include <cstdio>

namespace throng {

std::string short_text(double number)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", number);
    return text;
}

}  // namespace throng
