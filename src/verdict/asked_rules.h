// SPDX-License-Identifier: MIT
// Which rules are asked of a scene, or of a net from elsewhere: its own and the built-in ones.
#pragma once
#include <vector>

#include "builtin_rules.h"
#include "puppetri/scene/scene.h"
#include "puppetri/verdict/prove.h"

namespace puppetri::verdict {

std::vector<Asked> all_rules(const scene::Scene& scene);
std::vector<Asked> all_rules(const net::NetDraft& draft, const net::Net& net);
// Those that the options want.
std::vector<Asked> chosen(std::vector<Asked> all, const ProveOptions& options);

}  // namespace puppetri::verdict
