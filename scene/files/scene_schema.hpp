// Scene schema: the scene file format, as a JSON schema that editors and other programs read.
#pragma once

#include <string>

namespace throng {

/// The schema (JSON Schema, draft 2020-12), made of the tables of fields and of dials. Besides the
/// words of the standard each key has `unit`, in what it is counted; and `leftOut`, what holds
/// where it is left out and that is no plain value. Dials have `values`, what may be set, in words.
std::string scene_schema();

}  // namespace throng
