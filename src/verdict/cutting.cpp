// SPDX-License-Identifier: MIT
#include "cutting.h"

#include <algorithm>
#include <utility>

#include "puppetri/net/visit.h"
#include "puppetri/proof/coverability.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;
using net::NetDraft;

// Its duration can neither fail nor be asked of anybody.
bool harmless(const net::PlaceDraft& p) {
    if (!p.duration) {
        return !p.action.valid();
    }
    const net::DurationDraft& d = *p.duration;
    switch (d.kind) {
        case net::DurationKind::kConstant:
        case net::DurationKind::kAs:
        case net::DurationKind::kOpen:
            return true;
        case net::DurationKind::kInterval:
            return d.a.is_literal() && d.b.is_literal();
        default:
            return false;
    }
}

// The rule asks of the place whether it has a token, and nothing else.
void note_reads(const Formula& f, std::vector<std::uint8_t>& counted) {
    for (const Formula::Node& n : f.nodes) {
        const bool asks = n.op == FormulaOp::kMarked && n.count == 1;
        if (net::speaks_of_place(n.op) && !asks) {
            counted[n.index] = 1;
        }
    }
    for (Expr e : f.expressions) {
        e.rename_slots([&](Slot s) {
            if (net::speaks_of_place(s)) {
                counted[s.index] = 1;
            }
            return s;
        });
    }
}

}  // namespace

std::vector<std::uint32_t> collectors(const NetDraft& lowered) {
    NetDraft draft = lowered;  // the walks below may write
    draft.rules.clear();
    draft.states.clear();
    draft.questions.clear();
    draft.measures.clear();
    std::vector<std::uint8_t> given(draft.places.size(), 0), read(draft.places.size(), 0);
    for (net::TransitionDraft& t : draft.transitions) {
        for (const net::OutputDraft& out : t.outputs) {
            given[out.place.value] = 1;
            if (out.lasts) {
                read[out.place.value] = 1;
            }
        }
        t.outputs.clear();  // else every place is mentioned
    }
    net::each_place_mention(draft, [&](std::uint32_t& p) { read[p] = 1; });
    std::vector<std::uint32_t> list;
    for (std::uint32_t p = 0; p < draft.places.size(); ++p) {
        const net::PlaceDraft& place = draft.places[p];
        const bool plain = place.attributes.empty() && !place.capacity && !place.action.valid() &&
                           !place.busy && !place.keeps_order && harmless(place);
        if (given[p] != 0 && read[p] == 0 && plain) {
            list.push_back(p);
        }
    }
    return list;
}

bool bears_cutting(const Asked& asked, const std::vector<std::uint32_t>& collectors) {
    if (asked.question != Question::kRule) {
        return asked.question != Question::kOneOfEach;
    }
    const net::Rule& rule = asked.rule;
    if (rule.kind == net::RuleKind::kReversible ||
        (rule.kind == net::RuleKind::kBounded && rule.operands.empty())) {
        return false;
    }
    std::uint32_t places = 0;
    for (const std::uint32_t p : collectors) {
        places = std::max(places, p + 1);
    }
    std::vector<std::uint8_t> counted;
    for (const Formula& f : rule.operands) {
        for (const Formula::Node& n : f.nodes) {
            if (n.op == FormulaOp::kAllNext || n.op == FormulaOp::kSomeNext ||
                n.op == FormulaOp::kNext) {
                return false;  // the time that passes in a collector is a step
            }
            places = std::max(places, n.index + 1);
        }
        for (Expr e : f.expressions) {
            e.rename_slots([&](Slot s) {
                places = std::max(places, s.index + 1);
                return s;
            });
        }
    }
    counted.assign(places, 0);
    for (const Formula& f : rule.operands) {
        note_reads(f, counted);
        // `bounded(P, by: k)` names its places as marked.
        for (const Formula::Node& n : f.nodes) {
            if (rule.kind == net::RuleKind::kBounded && n.op == FormulaOp::kMarked) {
                counted[n.index] = 1;
            }
        }
    }
    return std::none_of(collectors.begin(), collectors.end(),
                        [&](std::uint32_t p) { return counted[p] != 0; });
}

bool surely_bounded(const net::Net& net, const proof::Budget& budget) {
    const proof::Plain plain = proof::plain(net);
    return !plain.unsound &&
           proof::boundedness(plain.net, budget).kind == proof::BoundednessAnswer::kBounded;
}

NetDraft without_collectors(NetDraft draft) {
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::vector<std::uint8_t> asked(draft.places.size(), 0);
    for (const net::Rule& rule : draft.rules) {
        for (const Formula& f : rule.operands) {
            for (const Formula::Node& n : f.nodes) {
                if (n.op == FormulaOp::kMarked) {
                    asked[n.index] = 1;
                }
            }
        }
    }
    draft.states.clear();
    draft.questions.clear();
    draft.measures.clear();
    std::vector<std::uint8_t> cut(draft.places.size(), 0);
    for (const std::uint32_t p : collectors(draft)) {
        if (asked[p] == 0) {
            cut[p] = 1;
            continue;
        }
        // One token, which is there at once: nobody asks when it is ready.
        draft.places[p].duration = net::DurationDraft::constant(SimTime{0});
        std::vector<net::InitialToken>& tokens = draft.places[p].tokens;
        if (!tokens.empty()) {
            tokens.resize(1);
            tokens[0].count = std::min<std::uint32_t>(tokens[0].count, 1);
        }
        for (net::TransitionDraft& t : draft.transitions) {
            bool gives = false;
            std::erase_if(t.outputs, [&](net::OutputDraft& out) {
                const bool here = out.place.value == p && out.weight > 0;
                const bool again = here && gives;
                gives = gives || here;
                out.weight = here ? 1 : out.weight;
                return again;
            });
            if (gives) {
                net::ArcDraft all;
                all.kind = net::ArcKind::kTakeAll;
                all.place = net::PlaceIndex{p};
                t.inputs.push_back(std::move(all));
            }
        }
    }
    std::vector<std::uint32_t> number(draft.places.size(), kNone);
    std::vector<net::PlaceDraft> kept;
    for (std::uint32_t p = 0; p < draft.places.size(); ++p) {
        if (cut[p] == 0) {
            number[p] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(std::move(draft.places[p]));
        }
    }
    draft.places = std::move(kept);
    for (net::TransitionDraft& t : draft.transitions) {
        std::erase_if(t.outputs,
                      [&](const net::OutputDraft& out) { return cut[out.place.value] != 0; });
    }
    net::each_place_mention(draft, [&](std::uint32_t& p) { p = number[p]; });
    return draft;
}

}  // namespace puppetri::verdict
