// SPDX-License-Identifier: MIT
#include "puppetri/base/require.h"

#include <cstdio>
#include <cstdlib>

namespace puppetri {

void fail_requirement(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: requirement failed: %s\n", file, line, condition);
    std::abort();
}

}  // namespace puppetri
