// SPDX-License-Identifier: MIT
// The low-level format of LoLA. Read arcs are written as loops; names without the signs that LoLA
// keeps for itself.
// Source  K. Wolf, "LoLA 2.0 user manual", section 3.1.
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "loops.h"
#include "net_features.h"
#include "net_writers.h"

namespace puppetri::io {
namespace {

class Names {
 public:
    // Unique among places and transitions together.
    const std::string& of(const std::string& path) {
        std::string name;
        for (const char c : path) {
            const bool kept = static_cast<unsigned char>(c) > 0x20 && c != ',' && c != ';' &&
                              c != ':' && c != '(' && c != ')' && c != '{' && c != '}' && c != '"';
            name += kept ? c : '_';
        }
        static const std::set<std::string> kWords = {"PLACE",   "MARKING", "TRANSITION",
                                                     "CONSUME", "PRODUCE", "SAFE",
                                                     "STRONG",  "WEAK",    "FAIR"};
        if (name.empty() || kWords.count(name) != 0) {
            name += "_";
        }
        const std::string stem = name;
        for (int n = 2; !taken_.insert(name).second; ++n) {
            name = stem + "_" + std::to_string(n);
        }
        changed_ += name != path ? 1 : 0;
        names_.push_back(std::move(name));
        return names_.back();
    }
    std::uint64_t changed() const { return changed_; }

 private:
    std::set<std::string> taken_;
    std::vector<std::string> names_;
    std::uint64_t changed_ = 0;
};

}  // namespace

std::string lola_text(const NetFile& file, Diagnostics& notes) {
    const net::NetDraft& draft = file.draft;
    Names names;
    std::vector<std::string> places;
    std::string out = "PLACE";
    for (const net::PlaceDraft& p : draft.places) {
        places.push_back(names.of(p.path));
        out += (places.size() > 1 ? ",\n  " : " ") + places.back();
    }
    out += ";\n\nMARKING";
    bool first = true;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (const std::int64_t tokens = initial_tokens(draft.places[i]); tokens > 0) {
            out += (first ? " " : ",\n  ") + places[i] + ": " + std::to_string(tokens);
            first = false;
        }
    }
    out += ";\n";
    for (const net::TransitionDraft& t : draft.transitions) {
        const Loops loops = with_loops(t);
        out += "\nTRANSITION " + names.of(t.path) + "\n";
        for (const bool takes : {true, false}) {
            out += takes ? "CONSUME" : "PRODUCE";
            bool begun = false;
            for (const auto& [place, weight] : takes ? loops.takes : loops.gives) {
                out += (begun ? ", " : " ") + places[place] + ": " + std::to_string(weight);
                begun = true;
            }
            out += ";\n";
        }
    }
    if (names.changed() > 0) {
        notes.push_back({Severity::kNote,
                         "renamed",
                         {},
                         "net " + draft.name,
                         std::to_string(names.changed()) + " names were changed: LoLA keeps "
                                                           "blanks and ,;:(){} for itself",
                         ""});
    }
    return out;
}

}  // namespace puppetri::io
