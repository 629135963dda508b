// Check: a programmer's mistake, caught where it is made.
//
// On in dev and sanitizer builds (THRONG_CHECKS), nothing at all in a release.
#pragma once

#ifdef THRONG_CHECKS
#include <cstdio>
#include <cstdlib>

#define THRONG_CHECK(condition, why)                                                               \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            std::fprintf(stderr, "%s:%d: check failed: %s: %s\n", __FILE__, __LINE__, #condition,  \
                         why);                                                                     \
            std::abort();                                                                          \
        }                                                                                          \
    } while (false)
#else
#define THRONG_CHECK(condition, why) static_cast<void>(0)
#endif
