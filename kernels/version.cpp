#include "throng/version.hpp"

namespace throng {

const char* version() { return THRONG_VERSION; }

}  // namespace throng
