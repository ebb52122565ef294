// SPDX-License-Identifier: MIT
#include "crossings.h"

#include <algorithm>

#include "script_player.h"

namespace puppetri::verdict {
namespace {

constexpr const char* kReason =
    "when and whether crossings come is decided by equations and figures, which a proof takes for "
    "free; no run with them has shown it";

// The run of the witness with equations and sensors, firing for firing.
bool really_happens(const scene::Scene& scene, const Witness& witness) {
    if (witness.violates_after == Witness::kNone || witness.lasso_from != Witness::kNone) {
        return false;
    }
    // A crossing that was made to occur, instead of coming by itself.
    for (const Witness::Event& e : witness.events) {
        if (scene.net.declarations().events[scene.net.find_event(e.path).value].crossing) {
            return false;
        }
    }
    ScriptPlayer player(scene, witness);
    for (const Witness::Step& step : witness.steps) {
        if (!player.step() || player.player().now() != step.at ||
            scene.net.transition(player.player().last()).path != step.transition) {
            return false;
        }
    }
    return true;
}

bool of_all_states(net::RuleKind kind) {
    switch (kind) {
        case net::RuleKind::kNever:
        case net::RuleKind::kAlways:
        case net::RuleKind::kMutex:
        case net::RuleKind::kExactlyOne:
        case net::RuleKind::kBounded:
        case net::RuleKind::kAlternate:
        case net::RuleKind::kOnlyIf:
        case net::RuleKind::kUntil:
            return true;
        default:
            return false;
    }
}

// An over-approximation may prove it: it is said of every run.
bool of_all_runs(const net::Rule& rule) {
    switch (rule.kind) {
        case net::RuleKind::kPossible:
        case net::RuleKind::kLive:
        case net::RuleKind::kQuasiLive:
        case net::RuleKind::kReversible:
        case net::RuleKind::kNobodyFreezes:
        case net::RuleKind::kFormula:
            return false;
        default:
            return true;
    }
}

}  // namespace

bool has_crossings(const net::Net& net) {
    const auto& events = net.declarations().events;
    return std::any_of(events.begin(), events.end(),
                       [](const net::EventDraft& e) { return e.crossing; });
}

void mind_crossings(const Theatre& theatre, const net::Rule& rule, Verdict& v) {
    const auto shown = [&] {
        return theatre.scene != nullptr && v.witness && really_happens(*theatre.scene, *v.witness);
    };
    bool good = true;
    if (v.answer == Answer::kProved) {
        good = of_all_runs(rule) || (rule.kind == net::RuleKind::kPossible && shown());
    } else if (v.answer == Answer::kRefuted) {
        const bool nowhere = !v.witness && (rule.kind == net::RuleKind::kPossible ||
                                            rule.kind == net::RuleKind::kQuasiLive);
        good = nowhere || (of_all_states(rule.kind) && shown());
    }
    if (!good) {
        v.answer = Answer::kUnknown;
        v.force = Force::kPlain;
        v.reason = kReason;
        v.witness.reset();
    }
}

void mind_crossings(TimeAnswer& answer) {
    for (std::optional<TimeEnd>* end : {&answer.quickest, &answer.slowest}) {
        if (*end && (*end)->says != TimeEnd::Says::kUnknown) {
            const bool nowhere = (*end)->says == TimeEnd::Says::kNever && end == &answer.quickest;
            if (!nowhere) {
                **end = TimeEnd{};
                (*end)->reason = kReason;
            }
        }
    }
}

}  // namespace puppetri::verdict
