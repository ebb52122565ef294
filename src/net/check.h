// SPDX-License-Identifier: MIT
// The check of a lowered draft: all defects at once.
#pragma once
#include "puppetri/base/diagnostic.h"
#include "puppetri/net/draft.h"

namespace puppetri::net {

void check_lowered(const NetDraft& net, Diagnostics& defects);

// The duration of a place, defaults filled in.
DurationDraft effective_duration(const PlaceDraft& p);

}  // namespace puppetri::net
