// SPDX-License-Identifier: MIT
// A drawing for Graphviz: `dot -Tsvg`, or `neato -n` where the net came with positions. Nothing is
// refused: what has no sign of its own is written beside the element.
#include <string>

#include "net_features.h"
#include "net_writers.h"
#include "puppetri/base/text.h"

namespace puppetri::io {
namespace {

std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
        }
        out += c == '\n' || c == '\r' ? ' ' : c;
    }
    return out + "\"";
}

std::string position(const std::vector<ElementLook>& looks, std::size_t count, std::size_t i) {
    if (looks.size() != count || !looks[i].at) {
        return "";
    }
    // Graphviz counts upwards.
    return ", pos=" +
           quoted(number_to_text(looks[i].at->x) + "," + number_to_text(-looks[i].at->y) + "!");
}

std::string seconds(const Expr& e) {
    return e.is_literal() && e.type().kind == ValueKind::kTime
               ? number_to_text(SimTime{e.literal_value()}.seconds())
               : "?";
}

// "after 2 s", "exponential(0.5 s)", ...
std::string delay_text(const net::DurationDraft& d) {
    double mean = 0;
    if (is_exponential(d, mean)) {
        return "exponential(" + number_to_text(mean) + " s)";
    }
    switch (d.kind) {
        case net::DurationKind::kConstant:
            return seconds(d.a) + " s";
        case net::DurationKind::kInterval:
            return seconds(d.a) + " .. " + seconds(d.b) + " s";
        case net::DurationKind::kDistribution:
            return name_of(d.distribution);
        case net::DurationKind::kOpen:
            return "open";
        default:
            return "computed";
    }
}

}  // namespace

std::string graphviz_text(const NetFile& file, Diagnostics&) {
    const net::NetDraft& draft = file.draft;
    std::string out = "digraph " + quoted(draft.name) +
                      " {\n  rankdir=LR;\n  node [fontname=\"Helvetica\", fontsize=10];\n"
                      "  edge [fontname=\"Helvetica\", fontsize=9, arrowsize=0.7];\n";
    for (std::size_t i = 0; i < draft.places.size(); ++i) {
        const net::PlaceDraft& p = draft.places[i];
        const std::int64_t tokens = initial_tokens(p);
        std::string beside = p.caption.empty() ? p.path : p.caption;
        if (p.duration && !is_untimed(p)) {
            beside += " takes " + delay_text(*p.duration);
        }
        if (p.capacity) {
            beside += " at most " + std::to_string(*p.capacity);
        }
        out += "  p" + std::to_string(i) + " [shape=circle, fixedsize=true, width=0.4, label=" +
               quoted(tokens == 0   ? ""
                      : tokens == 1 ? "\u2022"
                                    : std::to_string(tokens)) +
               ", xlabel=" + quoted(beside) + position(file.look.places, draft.places.size(), i) +
               "];\n";
    }
    for (std::size_t i = 0; i < draft.transitions.size(); ++i) {
        const net::TransitionDraft& t = draft.transitions[i];
        std::string beside = t.caption.empty() ? t.path : t.caption;
        if (t.delay) {
            beside += " after " + delay_text(t.delay->duration);
        }
        if (t.priority != 1) {
            beside += " priority " + std::to_string(t.priority);
        }
        beside += t.guard ? " when ..." : "";
        out += "  t" + std::to_string(i) + " [shape=box, fixedsize=true, width=0.15, height=0.4, " +
               (t.delay ? "" : "style=filled, fillcolor=black, ") +
               "label=\"\", xlabel=" + quoted(beside) +
               position(file.look.transitions, draft.transitions.size(), i) + "];\n";
        const auto edge = [&](std::uint32_t place, bool is_output, std::int64_t weight,
                              const char* style) {
            const std::string p = "p" + std::to_string(place), own = "t" + std::to_string(i);
            out += "  " + (is_output ? own : p) + " -> " + (is_output ? p : own);
            std::string attributes = style;
            if (weight != 1) {
                attributes += std::string(attributes.empty() ? "" : ", ") + "label=\"" +
                              std::to_string(weight) + "\"";
            }
            out += (attributes.empty() ? "" : " [" + attributes + "]") + ";\n";
        };
        for (const net::ArcDraft& a : t.inputs) {
            const net::ArcKind kind = plain_kind(a.kind);
            edge(a.place.value, false, a.weight,
                 kind == net::ArcKind::kUnless    ? "arrowhead=odot"
                 : kind == net::ArcKind::kRead    ? "style=dashed, arrowhead=none"
                 : kind == net::ArcKind::kTakeAll ? "arrowhead=normalnormal"
                                                  : "");
        }
        for (const net::OutputDraft& o : t.outputs) {
            edge(o.place.value, true, o.weight, "");
        }
    }
    return out + "}\n";
}

}  // namespace puppetri::io
