// SPDX-License-Identifier: MIT
// What decides how two movements join, as a text: figures that do the same have the same.
#pragma once
#include <string>

#include "puppetri/net/net.h"
#include "puppetri/stage/stage.h"

namespace puppetri::verdict {

// The call of a place with how long it takes. Others that it speaks of are told by how they differ
// from the figure that moves at the start: two figures that stand elsewhere have the same text.
std::string join_key(const net::Net& net, const stage::Play& play, net::PlaceIndex place);
// The figure itself, and what it holds at the start.
std::string body_key(const stage::Cast& cast, std::uint32_t actor);

}  // namespace puppetri::verdict
