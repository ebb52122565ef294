// SPDX-License-Identifier: MIT
// Guards against bugs of the caller. PUP_REQUIRE stands at public doors and is always on;
// PUP_ASSERT is for debug builds. Neither is for bad input: that is a Result.
#pragma once

namespace puppetri {

// Prints "FILE:LINE: condition" to stderr and aborts (traps in WebAssembly).
[[noreturn]] void fail_requirement(const char* condition, const char* file, int line);

}  // namespace puppetri

#define PUP_REQUIRE(condition) \
    ((condition) ? (void)0 : ::puppetri::fail_requirement(#condition, __FILE__, __LINE__))

#ifdef NDEBUG
#define PUP_ASSERT(condition) ((void)0)
#else
#define PUP_ASSERT(condition) PUP_REQUIRE(condition)
#endif
