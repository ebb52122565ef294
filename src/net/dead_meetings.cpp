// SPDX-License-Identifier: MIT
// Rendezvous that can never happen, as far as arcs tell: a token that one of them needs never comes
// to be. Guards, times and how many tokens there are do not count, so what is told is true of every
// run.
#include <algorithm>

#include "check.h"
#include "classes.h"
#include "lower.h"

namespace puppetri::net {
namespace {

class Possible {
 public:
    explicit Possible(const NetDraft& net)
        : net_(net),
          same_(classes(net.fusions, net.places.size())),
          marked_(net.places.size(), false),
          fires_(net.transitions.size(), false) {
        for (std::size_t p = 0; p < net_.places.size(); ++p) {
            const auto& tokens = net_.places[p].tokens;
            if (net_.places[p].busy || std::any_of(tokens.begin(), tokens.end(),
                                                   [](const auto& t) { return t.count > 0; })) {
                marked_[same_[p]] = true;
            }
        }
        for (bool more = true; more;) {
            more = false;
            for (const RefinementDraft& r : net_.refinements) {
                if (marked_[same_[r.place.value]]) {
                    more = mark(r.start) || more;
                }
            }
            for (std::uint32_t t = 0; t < net_.transitions.size(); ++t) {
                if (!fires_[t] && !lacks(t).valid()) {
                    fires_[t] = more = true;
                    for (const OutputDraft& o : net_.transitions[t].outputs) {
                        marked_[same_[o.place.value]] = true;
                    }
                }
            }
        }
    }

    bool fires(std::uint32_t t) const { return fires_[t]; }

    // A place without a token that this transition needs; invalid where there is none.
    PlaceIndex lacks(std::uint32_t t) const {
        for (const ArcDraft& a : net_.transitions[t].inputs) {
            const bool needs = a.kind == ArcKind::kTake || a.kind == ArcKind::kTakeNow ||
                               a.kind == ArcKind::kRead || a.kind == ArcKind::kReadNow;
            if (needs && a.weight > 0 && !marked_[same_[a.place.value]]) {
                return a.place;
            }
        }
        return {};
    }

 private:
    bool mark(const std::vector<PlaceIndex>& places) {
        bool more = false;
        for (const PlaceIndex p : places) {
            more = more || !marked_[same_[p.value]];
            marked_[same_[p.value]] = true;
        }
        return more;
    }

    const NetDraft& net_;
    const std::vector<std::uint32_t>
        same_;  // by place: the one that stands for all it is fused with
    std::vector<bool> marked_, fires_;
};

}  // namespace

void warn_of_dead_meetings(const NetDraft& net, const std::vector<Meets>& meetings,
                           Diagnostics& defects) {
    // What follows from messages that nobody takes need not be told as well.
    const bool told = std::any_of(defects.begin(), defects.end(), [](const Diagnostic& d) {
        return d.code == "rendezvous-never" && d.severity == Severity::kWarning;
    });
    if (meetings.empty() || told) {
        return;
    }
    const Possible possible(net);
    const auto fires = [&](const Meets& m) {
        return std::any_of(m.products.begin(), m.products.end(),
                           [&](std::uint32_t t) { return possible.fires(t); });
    };
    for (const Meets& m : meetings) {
        if (m.products.empty() || fires(m)) {
            continue;
        }
        const bool others = std::any_of(meetings.begin(), meetings.end(), [&](const Meets& other) {
            return other.group == m.group && fires(other);
        });
        const PlaceIndex place = possible.lacks(m.products.front());
        report(defects, "rendezvous-never", m.where, "transition " + m.path,
               "this rendezvous can never happen, since " + net.places[place.value].path +
                   " never gets a token",
               "give it one, or let a transition that can fire lead there",
               others ? Severity::kNote : Severity::kWarning);
    }
}

}  // namespace puppetri::net
