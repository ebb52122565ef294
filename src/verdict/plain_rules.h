// SPDX-License-Identifier: MIT
// Rules that markings decide, for nets whose graph is too large to be looked at edge by edge: the
// portfolio of plain_session.h, asked in the words of rules. Of an untimed net everything that it
// says is exact. Of another net it sees every run, without its times: then only what no run can
// break is proved, and what none can reach refuted (SEMANTICS.md, section 8).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plain_session.h"
#include "puppetri/net/net.h"
#include "puppetri/verdict/check_graph.h"
#include "puppetri/verdict/obligation.h"
#include "puppetri/verdict/verdict.h"

namespace puppetri::verdict {

struct PlainFinding {
    Answer answer = Answer::kUnknown;
    Force force = Force::kPlain;
    How how = How::kNone;
    std::string reason;
    std::vector<std::string> notes;
    // Of kRefuted, and of kProved of `possible`: transitions of the net from the start on; with
    // lasso_from, the last ones go round for ever.
    Firings run;
    std::uint32_t lasso_from = kFar;
    Finding::Target target = Finding::Target::kBroken;  // what the run shows
    // Refuted though no single run was found: what branches has no single run as witness, all else
    // is not refuted without one.
    bool branches = false;
};

class PlainRules {
 public:
    // The net and the host (may be null) outlive it.
    PlainRules(const net::Net& net, const HostLowering* host, const proof::Budget& budget);
    // False: nothing may be concluded from markings.
    bool available() const { return session_.sound(); }
    bool exact() const { return session_.fits() && net_.paced(); }
    PlainFinding decide(const net::Rule& rule);

 private:
    PlainFinding every_state(const net::Rule& rule);
    PlainFinding possible(const net::Rule& rule);
    PlainFinding bounded();
    PlainFinding deadlock_free();
    PlainFinding quasi_live(const net::Rule& rule);
    PlainFinding stays_possible(const net::Rule& rule);
    PlainFinding ends();
    PlainFinding formula(const net::Rule& rule);
    std::string name(std::uint32_t transition) const;
    std::vector<std::uint32_t> transitions_of(const net::Rule& rule) const;

    const net::Net& net_;
    const HostLowering* host_;
    const proof::Budget budget_;
    PlainSession session_;
};

}  // namespace puppetri::verdict
