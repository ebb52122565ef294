// SPDX-License-Identifier: MIT
// Proving: every rule of a scene or a net, and those that are built in, by the cheapest method that
// can answer (docs/proof.md). What a method may say is settled in check_graph.h; here they are put
// in order, and every REFUTED is a run that was played twice.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/proof/budget.h"
#include "puppetri/scene/scene.h"
#include "puppetri/verdict/verdict.h"

namespace puppetri::verdict {

struct ProveOptions {
    // Only rules whose path is this, or this and an instance (`if_ready` for `if_ready.a`).
    // Empty: all.
    std::string only;
    proof::Budget budget;  // for everything together
    // How often the outside makes an event occur; proof::GraphRequest::kAnyNumber: any number.
    std::uint32_t outside_events = ~std::uint32_t{0};
    bool built_in = true;
    // Runs to sample where nothing else answers; 0: none (sample.h).
    std::uint64_t samples = 0;
    // Graphs of up to so many markings are looked at edge by edge; of larger ones of nets without
    // time, markings alone decide what they can (structure, walks, reductions, decision diagrams).
    std::uint32_t first_look_states = 100'000;
    // Called with each verdict as soon as it is known.
    void (*tell)(void* context, const Verdict& verdict) = nullptr;
    void* context = nullptr;
};

// In the order of the rules, built-in ones last.
std::vector<Verdict> prove(const scene::Scene& scene, const ProveOptions& options);

// A net from elsewhere. Without rules of its own it is asked what one asks of nets: deadlock_free,
// bounded, quasi_live, live, reversible.
std::vector<Verdict> prove(const net::NetDraft& draft, const net::Net& net,
                           const ProveOptions& options);

// The rules that the two above look at.
std::vector<net::Rule> rules_of(const scene::Scene& scene);
std::vector<net::Rule> rules_of(const net::Net& net);

}  // namespace puppetri::verdict
