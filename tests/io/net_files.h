// SPDX-License-Identifier: MIT
// Nets as their formats write them, with every construct that is read: for hostile tests, fuzzers
// and round trips. And drafts as text, to compare them whole.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "puppetri/io/net_file.h"

namespace puppetri::io::testing {

// The files of tests/corpus/nets, name and text, in order of name. queries.xml asks about
// pages.pnml.
inline std::vector<std::pair<std::string, std::string>> net_corpus() {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& entry :
         std::filesystem::directory_iterator(PUP_SOURCE_DIR "/tests/corpus/nets")) {
        std::ifstream in(entry.path(), std::ios::binary);
        out.emplace_back(entry.path().filename().string(),
                         std::string(std::istreambuf_iterator<char>(in), {}));
    }
    std::sort(out.begin(), out.end());
    return out;
}

// Everything of a draft that means something, but source positions. Equal texts: equal nets.
inline std::string expr_text(const Expr& e) {
    std::string out;
    for (const Expr::Node& n : e.nodes()) {
        out += " " + std::to_string(static_cast<int>(n.op)) + ":" +
               std::to_string(static_cast<int>(n.type.kind)) + ":" + std::to_string(n.a) + ":" +
               std::to_string(n.b) + ":" + std::to_string(n.literal) + ":" +
               std::to_string(n.slot.kind) + ":" + std::to_string(n.slot.index);
    }
    return out;
}

inline std::string draft_text(const net::NetDraft& draft) {
    std::string out = "net " + draft.name + (draft.sources_on_beats ? " sources" : "") + "\n";
    for (const net::PlaceDraft& p : draft.places) {
        out += "place " + p.path + " \"" + p.caption + "\"";
        for (const net::InitialToken& t : p.tokens) {
            out += " tokens " + std::to_string(t.count);
        }
        out += p.capacity ? " at most " + std::to_string(*p.capacity) : "";
        out += "\n";
    }
    for (const net::TransitionDraft& t : draft.transitions) {
        out += "transition " + t.path + " \"" + t.caption + "\" priority " +
               std::to_string(t.priority);
        out += t.odds ? " odds" + expr_text(*t.odds) : "";
        out += t.guard ? " when" + expr_text(*t.guard) : "";
        if (t.delay) {
            const net::DurationDraft& d = t.delay->duration;
            out += " after " + std::to_string(static_cast<int>(d.kind)) + expr_text(d.a) +
                   expr_text(d.b) + " law " + std::to_string(static_cast<int>(d.distribution));
            for (const Expr& e : d.parameters) {
                out += expr_text(e);
            }
            out += " servers " + std::to_string(t.delay->servers);
        }
        for (const net::ArcDraft& a : t.inputs) {
            out += "\n  in " + std::to_string(static_cast<int>(a.kind)) + " " +
                   std::to_string(a.place.value) + "*" + std::to_string(a.weight);
        }
        for (const net::OutputDraft& o : t.outputs) {
            out += "\n  out " + std::to_string(o.place.value) + "*" + std::to_string(o.weight);
        }
        out += "\n";
    }
    return out;
}

}  // namespace puppetri::io::testing
