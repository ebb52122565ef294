// SPDX-License-Identifier: MIT
#include "puppetri/scene/mathematics.h"

#include <algorithm>
#include <functional>
#include <map>
#include <vector>

#include "puppetri/net/net.h"

namespace puppetri::scene {
namespace {

std::string list(const std::vector<std::string>& items, const char* between) {
    std::string text;
    for (std::size_t i = 0; i < items.size(); ++i) {
        text += (i > 0 ? between : "") + items[i];
    }
    return text;
}

struct Arcs {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> pre,
        post;  // (place, transition): weight
    std::vector<std::string> tests;
};

const char* word_of(net::ArcKind kind) {
    switch (kind) {
        case net::ArcKind::kTakeAll:
            return "takes all of ";
        case net::ArcKind::kTakeAllNow:
            return "takes now all of ";
        case net::ArcKind::kRead:
            return "with ";
        case net::ArcKind::kReadNow:
            return "while ";
        case net::ArcKind::kUnless:
            return "unless ";
        default:
            return "unless ready ";
    }
}

Arcs arcs_of(const net::NetDraft& draft) {
    Arcs out;
    for (std::uint32_t t = 0; t < draft.transitions.size(); ++t) {
        const net::TransitionDraft& transition = draft.transitions[t];
        for (const net::ArcDraft& a : transition.inputs) {
            if (a.kind == net::ArcKind::kTake || a.kind == net::ArcKind::kTakeNow) {
                out.pre[{a.place.value, t}] += a.weight;
            } else {
                const std::string weight = a.weight == 1 ? "" : std::to_string(a.weight) + " ";
                out.tests.push_back(transition.path + " " + word_of(a.kind) + weight +
                                    draft.places[a.place.value].path);
            }
        }
        for (const net::OutputDraft& a : transition.outputs) {
            out.post[{a.place.value, t}] += a.weight;
        }
    }
    return out;
}

}  // namespace

std::string to_mathematics(const net::NetDraft& written) {
    const auto lowered = net::lower(written);
    const net::NetDraft& draft = lowered ? *lowered : written;
    const Arcs arcs = arcs_of(draft);
    std::vector<std::string> places, transitions, flow;
    std::map<std::int64_t, std::vector<std::string>, std::greater<>> weights;  // heavy ones first
    std::string marking;
    for (const net::PlaceDraft& p : draft.places) {
        places.push_back(p.path);
        std::uint64_t tokens = 0;
        for (const net::InitialToken& t : p.tokens) {
            tokens += t.count;
        }
        marking += (marking.empty() ? "" : " ") + std::to_string(tokens);
    }
    for (const net::TransitionDraft& t : draft.transitions) {
        transitions.push_back(t.path);
    }
    const auto add = [&](const std::string& pair, std::int64_t weight) {
        flow.push_back(pair);
        weights[weight].push_back("w" + pair);
    };
    for (const auto& [arc, weight] : arcs.pre) {
        add("(" + places[arc.first] + ", " + transitions[arc.second] + ")", weight);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> by_transition;
    for (const auto& [arc, weight] : arcs.post) {
        by_transition[{arc.second, arc.first}] = weight;
    }
    for (const auto& [arc, weight] : by_transition) {
        add("(" + transitions[arc.first] + ", " + places[arc.second] + ")", weight);
    }
    std::vector<std::string> weighted;
    for (const auto& [weight, pairs] : weights) {
        weighted.push_back(list(pairs, " = ") + " = " + std::to_string(weight));
    }
    std::string text = "P = {" + list(places, ", ") + "}\nT = {" + list(transitions, ", ") +
                       "}\nF = {" + list(flow, ", ") + "}\n" + list(weighted, "; ") + "\nM0 = [" +
                       marking + "]^T\n";

    std::size_t name_width = 0;
    for (const std::string& p : places) {
        name_width = std::max(name_width, p.size());
    }
    text += "\nC" + std::string(name_width - (name_width > 0 ? 1 : 0), ' ');
    std::vector<std::size_t> widths;
    for (const std::string& t : transitions) {
        widths.push_back(std::max<std::size_t>(t.size(), 3));
        text += "  " + std::string(widths.back() - t.size(), ' ') + t;
    }
    text += "\n";
    for (std::uint32_t p = 0; p < places.size(); ++p) {
        text += places[p] + std::string(name_width - places[p].size(), ' ');
        for (std::uint32_t t = 0; t < transitions.size(); ++t) {
            const auto given = arcs.post.find({p, t});
            const auto taken = arcs.pre.find({p, t});
            const std::int64_t change = (given == arcs.post.end() ? 0 : given->second) -
                                        (taken == arcs.pre.end() ? 0 : taken->second);
            const std::string entry = std::to_string(change);
            text += "  " +
                    std::string(entry.size() < widths[t] ? widths[t] - entry.size() : 0, ' ') +
                    entry;
        }
        text += "\n";
    }
    for (const std::string& test : arcs.tests) {
        text += test + "\n";
    }
    return text;
}

}  // namespace puppetri::scene
