// SPDX-License-Identifier: MIT
// From the tables of a compiled net to its plain untimed picture. Whatever cannot be said in counts
// is dropped so that every run of the net stays a run of the picture, and is named: conditions that
// are dropped let more happen, and a transition that lost one no longer proves that a marking is
// alive. What takes a number of tokens that nobody can tell beforehand (`all P`) has no such
// picture.
#include "puppetri/proof/plain_net.h"

#include <algorithm>
#include <cmath>

#include "puppetri/base/distribution.h"
#include "puppetri/net/tables.h"

namespace puppetri::proof {

namespace {

using net::ArcKind;
using net::ArcTable;
using net::DurationKind;
using net::DurationTable;
using net::NetTables;
using net::PlaceKind;
using net::Special;
using net::Watcher;
using net::Weighted;

// What the conditions of one transition come down to.
struct Draft {
    std::vector<Weighted> takes, gives, reads, unless;
    std::vector<Weighted> waits;  // for ready tokens of timed places
    bool dropped = false;         // some condition is not in the picture
    bool gated = false;           // guard, binding, delay or event
    bool may_never_fire = false;
};

std::uint32_t saturated_sum(std::uint32_t a, std::uint32_t b) {
    return a > ~std::uint32_t{0} - b ? ~std::uint32_t{0} : a + b;
}

enum class Merge { kSum, kMost, kLeast };

void normalize(std::vector<Weighted>& row, Merge merge) {
    std::stable_sort(row.begin(), row.end(),
                     [](const Weighted& a, const Weighted& b) { return a.place < b.place; });
    std::size_t out = 0;
    for (const Weighted& w : row) {
        if (out == 0 || row[out - 1].place != w.place) {
            row[out++] = w;
            continue;
        }
        std::uint32_t& weight = row[out - 1].weight;
        weight = merge == Merge::kMost    ? std::max(weight, w.weight)
                 : merge == Merge::kLeast ? std::min(weight, w.weight)
                                          : saturated_sum(weight, w.weight);
    }
    row.resize(out);
}

std::uint32_t weight_in(const std::vector<Weighted>& row, std::uint32_t place) {
    const auto it =
        std::lower_bound(row.begin(), row.end(), place,
                         [](const Weighted& w, std::uint32_t p) { return w.place < p; });
    return it != row.end() && it->place == place ? it->weight : 0;
}

void append(net::Rows<Weighted>& rows, const std::vector<Weighted>& row) {
    rows.items.insert(rows.items.end(), row.begin(), row.end());
    rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
}

// A pattern that only names variables, each once, fits every token.
bool always_binds(const Special& s) {
    std::vector<std::uint32_t> bound;
    for (const ArcTable& arc : s.arcs) {
        for (const net::PatternTable& p : arc.pattern) {
            if (p.binds == net::kNoIndex || arc.weight > 1 || arc.kind == ArcKind::kUnless ||
                arc.kind == ArcKind::kUnlessReady) {
                return false;
            }
            bound.push_back(p.binds);
        }
    }
    std::sort(bound.begin(), bound.end());
    return std::adjacent_find(bound.begin(), bound.end()) == bound.end();
}

class Maker {
 public:
    Maker(const net::Net& net, Plain& out) : net_(net), tables_(net.tables()), out_(out) {}

    void run() {
        const std::uint32_t count = net_.transition_count();
        drafts_.resize(count);
        look_at_places();
        collect_watchers();
        for (std::uint32_t t = 0; t < count; ++t) {
            collect_arcs(t);
        }
        lay_out();
        set_levels();
    }

 private:
    std::string place(std::uint32_t p) const {
        return "place " + std::string(net_.place(net::PlaceIndex{p}).path);
    }
    std::string transition(std::uint32_t t) const {
        return "transition " + std::string(net_.transition(net::TransitionIndex{t}).path);
    }
    void leave_out(std::string why) { out_.net.left_out.push_back(std::move(why)); }

    bool plain_counts(std::uint32_t p) const { return tables_.place[p].kind == PlaceKind::kCount; }

    // Whether a token may wait here for ever until somebody makes it ready.
    bool is_open(std::uint32_t p) const {
        for (std::uint32_t steps = 0; steps <= net_.place_count(); ++steps) {
            const std::uint32_t d = tables_.place[p].duration;
            if (d == net::kNoIndex) {
                return false;
            }
            const DurationTable& table = tables_.durations[d];
            if (table.kind != DurationKind::kAs) {
                return table.kind == DurationKind::kOpen;
            }
            p = table.sibling;
        }
        return true;
    }

    void look_at_places() {
        const std::uint32_t count = net_.place_count();
        out_.net.initial.assign(count, 0);
        for (const NetTables::Initial& i : tables_.initial) {
            out_.net.initial[i.place] += i.count;
        }
        open_.resize(count);
        for (std::uint32_t p = 0; p < count; ++p) {
            open_[p] = is_open(p);
            if (plain_counts(p)) {
                continue;
            }
            const std::uint32_t rich =
                tables_.place_rich.empty() ? net::kNoIndex : tables_.place_rich[p];
            if (rich != net::kNoIndex && tables_.rich[rich].attributes > 0) {
                leave_out(place(p) + " has tokens with attributes");
            }
            if (tables_.place[p].duration != net::kNoIndex || rich == net::kNoIndex) {
                leave_out(place(p) + " has a duration");
            }
        }
    }

    void collect_watchers() {
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            const bool counted = plain_counts(p);
            for (const Watcher& w : tables_.ready_watchers(p)) {
                Draft& d = drafts_[w.transition()];
                if (!w.inhibits()) {
                    d.reads.push_back({p, w.threshold});
                    if (!counted) {
                        d.waits.push_back({p, w.threshold});
                        d.may_never_fire = d.may_never_fire || open_[p];
                    }
                } else if (counted) {
                    d.unless.push_back({p, w.threshold});
                } else {
                    d.dropped = true;
                    leave_out(transition(w.transition()) + " asks how many tokens of " + place(p) +
                              " are ready");
                }
            }
            for (const Watcher& w : tables_.total_watchers(p)) {
                Draft& d = drafts_[w.transition()];
                (w.inhibits() ? d.unless : d.reads).push_back({p, w.threshold});
            }
        }
    }

    void collect_arcs(std::uint32_t t) {
        Draft& d = drafts_[t];
        const auto takes = tables_.takes(t), gives = tables_.gives(t);
        d.takes.assign(takes.begin(), takes.end());
        d.gives.assign(gives.begin(), gives.end());
        d.gated = (tables_.transition[t].flags & net::kGated) != 0;
        const std::uint32_t special = tables_.transition[t].special;
        if (special != net::kNoIndex) {
            collect_special(t, tables_.specials[special], d);
        }
        normalize(d.takes, Merge::kSum);
        normalize(d.gives, Merge::kSum);
        normalize(d.reads, Merge::kMost);
        normalize(d.unless, Merge::kLeast);
        normalize(d.waits, Merge::kMost);
        std::erase_if(d.reads,
                      [&](const Weighted& w) { return weight_in(d.takes, w.place) >= w.weight; });
    }

    void collect_special(std::uint32_t t, const Special& s, Draft& d) {
        for (const ArcTable& arc : s.arcs) {
            if (arc.kind == ArcKind::kTake || arc.kind == ArcKind::kTakeNow) {
                d.takes.push_back({arc.place, arc.weight});
            } else if (arc.kind == ArcKind::kTakeAll || arc.kind == ArcKind::kTakeAllNow) {
                out_.unsound = true;
                leave_out(transition(t) + " takes all tokens of " + place(arc.place));
            }
        }
        for (const net::OutputTable& o : s.outputs) {
            d.gives.push_back({o.place, o.weight});
        }
        if (s.searches && !always_binds(s)) {
            d.dropped = true;
            leave_out(transition(t) + " looks for tokens that fit a pattern");
        }
        if (s.guard.valid()) {
            d.dropped = true;
            leave_out(transition(t) + " has a guard");
        }
        if (!s.events.empty()) {
            d.dropped = true;
            leave_out(transition(t) + " waits for an event");
        }
        if (s.delay != net::kNoIndex) {
            d.may_never_fire = d.may_never_fire || unbounded(tables_.delays[s.delay].duration);
            leave_out(transition(t) + " has a delay");
        }
        if (s.odds.valid()) {
            leave_out(transition(t) + " has odds that are computed");
        }
        if (!s.assignments.empty()) {
            leave_out(transition(t) + " sets data");
        }
        if (!s.must_be_clean.empty()) {
            leave_out(transition(t) + " ends a module, which must be clean");
        }
    }

    static bool unbounded(const DurationTable& d) {
        if (d.kind == DurationKind::kOpen) {
            return true;
        }
        if (d.kind != DurationKind::kDistribution) {
            return false;
        }
        if (d.constants.empty()) {
            return d.distribution == DistributionKind::kNormal ||
                   d.distribution == DistributionKind::kExponential ||
                   d.distribution == DistributionKind::kErlang ||
                   d.distribution == DistributionKind::kGamma;
        }
        return !std::isfinite(support(d.distribution, d.constants).high);
    }

    void lay_out() {
        PlainNet& net = out_.net;
        for (const Draft& d : drafts_) {
            append(net.takes, d.takes);
            append(net.gives, d.gives);
            append(net.reads, d.reads);
            append(net.unless, d.unless);
            net.optional.push_back(d.dropped || d.may_never_fire ? 1 : 0);
        }
        net.level.assign(drafts_.size(), 0);
    }

    // Whether everybody above a boundary of priorities may be said to block everybody below it
    // (SEMANTICS.md, section 8): both without delay, event and guard, and whatever timed place the
    // higher waits for, the lower waits for too. Then the higher one fires at once wherever the
    // lower one could.
    void set_levels() {
        const std::size_t classes = tables_.level_priority.size();  // number 0 is the highest
        std::vector<std::vector<std::uint32_t>> members(classes);
        for (std::uint32_t t = 0; t < drafts_.size(); ++t) {
            members[tables_.transition[t].level].push_back(t);
        }
        std::vector<bool> kept(classes, false);  // the boundary above class i
        std::vector<Weighted> waits;             // of all classes above
        for (std::size_t i = 1; i < classes; ++i) {
            bool clear = true;
            for (const std::uint32_t t : members[i - 1]) {
                clear = clear && !drafts_[t].gated && !drafts_[t].dropped;
                waits.insert(waits.end(), drafts_[t].waits.begin(), drafts_[t].waits.end());
            }
            if (!clear) {
                break;  // such a one is above all further boundaries too
            }
            normalize(waits, Merge::kMost);
            kept[i] = true;
            for (std::size_t below = i; below < classes && kept[i]; ++below) {
                for (const std::uint32_t u : members[below]) {
                    const Draft& d = drafts_[u];
                    const bool fits =
                        !d.gated && std::all_of(waits.begin(), waits.end(), [&](const Weighted& w) {
                            return weight_in(d.waits, w.place) >= w.weight;
                        });
                    kept[i] = kept[i] && fits;
                }
            }
        }
        std::uint32_t level = 0;
        for (std::size_t i = classes; i-- > 0;) {
            for (const std::uint32_t t : members[i]) {
                out_.net.level[t] = level;
            }
            level += kept[i] ? 1 : 0;
        }
        out_.net.has_levels = level > 0;
        for (std::size_t i = 1; i < classes; ++i) {
            if (!kept[i]) {
                leave_out("priority " + std::to_string(tables_.level_priority[i - 1]) +
                          " does not block lower ones at every time");
            }
        }
    }

    const net::Net& net_;
    const NetTables& tables_;
    Plain& out_;
    std::vector<Draft> drafts_;
    std::vector<bool> open_;
};

}  // namespace

bool PlainNet::enabled(std::span<const std::uint32_t> marking, std::uint32_t t) const {
    for (const Weighted& w : takes.row(t)) {
        if (marking[w.place] < w.weight) {
            return false;
        }
    }
    for (const Weighted& w : reads.row(t)) {
        if (marking[w.place] < w.weight) {
            return false;
        }
    }
    for (const Weighted& w : unless.row(t)) {
        if (marking[w.place] >= w.weight) {
            return false;
        }
    }
    return true;
}

bool PlainNet::fire(std::span<std::uint32_t> marking, std::uint32_t t) const {
    for (const Weighted& w : takes.row(t)) {
        marking[w.place] -= w.weight;
    }
    const auto row = gives.row(t);
    for (std::size_t i = 0; i < row.size(); ++i) {
        std::uint32_t& count = marking[row[i].place];
        if (count > ~std::uint32_t{0} - row[i].weight) {
            while (i-- > 0) {
                marking[row[i].place] -= row[i].weight;
            }
            for (const Weighted& w : takes.row(t)) {
                marking[w.place] += w.weight;
            }
            return false;
        }
        count += row[i].weight;
    }
    return true;
}

Plain plain(const net::Net& net) {
    Plain out;
    Maker(net, out).run();
    return out;
}

}  // namespace puppetri::proof
