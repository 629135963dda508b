// Page template: page.html, as the build puts it into the library.
#pragma once

#include <string_view>

namespace throng {

/// Words in double braces stand for what the report says.
extern const std::string_view kPageTemplate;

}  // namespace throng
