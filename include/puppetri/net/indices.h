// SPDX-License-Identifier: MIT
// The typed indices of a net, draft or compiled. (Events and actions: net/host.h.)
#pragma once
#include "puppetri/base/index.h"

namespace puppetri::net {

using PlaceIndex = Index<struct PlaceTag>;
using TransitionIndex = Index<struct TransitionTag>;
using DatumIndex = Index<struct DatumTag>;
using HostAtomIndex = Index<struct HostAtomTag>;

}  // namespace puppetri::net
