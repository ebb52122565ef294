// SPDX-License-Identifier: MIT
// A figure in somebody else's program.
#include "puppetri/stage/stage.h"

#include <cstdio>

#include "puppetri/figure/mannequin.h"

using namespace puppetri;

int main() {
    const figure::Figure ana = figure::make_mannequin(1.75);
    const std::size_t joints = ana.skeleton.joints.size();
    std::printf("%.2f m, %zu joints\n", ana.skeleton.height_m, joints);
    return joints > 20 ? 0 : 1;
}
