#include "cost/report/markup.hpp"

#include <cstdio>

namespace throng {

std::string in_markup(std::string_view text)
{
    std::string written;
    for (const char letter : text) {
        switch (letter) {
        case '&':
            written += "&amp;";
            break;
        case '<':
            written += "&lt;";
            break;
        case '>':
            written += "&gt;";
            break;
        case '"':
            written += "&quot;";
            break;
        default:
            written += letter;
        }
    }
    return written;
}

std::string pixels(double length)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", length);
    return text;
}

}  // namespace throng
