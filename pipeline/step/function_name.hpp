// Function name: what a function is called in the code, for tables that are printed.
#pragma once

#include <string_view>

namespace throng {

/// Of a function or a member function, given by its pointer: its own name, without what it is in
/// and without template arguments.
template <auto function>
consteval std::string_view function_name()
{
    // "... [with auto function = &throng::Island::advance<float>; ...]" by GCC, without "with auto"
    // and what follows by Clang.
    const std::string_view all = __PRETTY_FUNCTION__, key = "function = ";
    std::string_view text = all.substr(all.find(key) + key.size());
    text = text.substr(0, text.find_first_of(";]"));
    if (text.ends_with('>')) {
        int open = 0;
        std::size_t at = text.size();
        do {
            --at;
            open += text[at] == '>' ? 1 : text[at] == '<' ? -1 : 0;
        } while (open > 0);
        text = text.substr(0, at);
    }
    // Not there where the function stands alone: npos is one before 0.
    return text.substr(text.find_last_of(":&") + 1);
}

}  // namespace throng
