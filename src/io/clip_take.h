// SPDX-License-Identifier: MIT
// A clip as a take, so that the writers of performances write clips too.
#pragma once
#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/dof.h"
#include "puppetri/io/clip_file.h"
#include "puppetri/io/take.h"

namespace puppetri::io {

struct ClipTakeOptions {
    double rate_hz = 0;         // 0: the source's frame time, else 60
    double source_frame_s = 0;  // 0: none
    // Keys at the clip's own instants besides the frames; without frames where these say it all and
    // no rate is asked for.
    bool own_keys = false;
};

// One actor without a name, with rods for a skin; marks become events.
// Fails   "too-large".
Checked<Take> take_of(const motion::Clip& clip, const figure::Skeleton& skeleton,
                      const figure::DofSet* dofs, const ClipTakeOptions& options);

}  // namespace puppetri::io
