// SPDX-License-Identifier: MIT
// A siphon of a net is a trap of the net with all arcs turned round: one code for both.
//
// Minimal sets by partition (Cordone, Ferrarini, Piroddi 2005): a problem is a set of allowed
// places and a set of demanded ones, standing for all siphons S with demanded <= S <= allowed. Take
// the greatest siphon within the allowed places; shrink it to a minimal one that still holds the
// demanded places; if it is minimal at all, report it; then every other siphon of the problem lacks
// one of its free places p1, p2, ...: problem i forbids p_i and demands p1 .. p_(i-1).
#include "puppetri/proof/siphons.h"

#include <algorithm>

namespace puppetri::proof {

namespace {

constexpr std::uint64_t kMostSets = 20'000;

// Read for siphons; for traps everything is turned round. A read counts as an arc in and an arc
// out: who reads from a set fires only while it is marked, and leaves it marked.
struct Arcs {
    net::Rows<std::uint32_t> producers;  // per place
    net::Rows<net::Weighted> from;       // per transition: what it needs
    std::uint32_t places = 0;

    // Siphons: producers are those who give, `from` what they take. Traps: the other way round.
    Arcs(const PlainNet& net, bool siphons) : places(net.place_count()) {
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            for (const net::Weighted& w : (siphons ? net.takes : net.gives).row(t)) {
                from.items.push_back(w);
            }
            for (const net::Weighted& w : net.reads.row(t)) {
                if (siphons || !takes_as_much(net, t, w)) {
                    from.items.push_back(w);
                }
            }
            from.starts.push_back(static_cast<std::uint32_t>(from.items.size()));
        }
        const net::Rows<net::Weighted>& into = siphons ? net.gives : net.takes;
        producers.starts.assign(places + 1, 0);
        for (const net::Weighted& w : into.items) {
            ++producers.starts[w.place + 1];
        }
        for (std::uint32_t p = 0; p < places; ++p) {
            producers.starts[p + 1] += producers.starts[p];
        }
        producers.items.resize(into.items.size());
        std::vector<std::uint32_t> at(producers.starts.begin(), producers.starts.end() - 1);
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            for (const net::Weighted& w : into.row(t)) {
                producers.items[at[w.place]++] = t;
            }
        }
    }

    // The greatest siphon within the places marked 1; they are unmarked otherwise.
    void shrink(std::vector<std::uint8_t>& in) const {
        const std::uint32_t transitions = from.size();
        std::vector<std::uint32_t> supply(transitions, 0);  // how many places of the set it needs
        for (std::uint32_t t = 0; t < transitions; ++t) {
            for (const net::Weighted& w : from.row(t)) {
                supply[t] += in[w.place];
            }
        }
        std::vector<std::uint32_t> out;
        for (std::uint32_t p = 0; p < places; ++p) {
            if (in[p] != 0 && !fed(p, supply)) {
                in[p] = 0;
                out.push_back(p);
            }
        }
        if (out.empty()) {
            return;
        }
        const net::Rows<std::uint32_t>& needed_by = needers();
        while (!out.empty()) {
            const std::uint32_t p = out.back();
            out.pop_back();
            for (const std::uint32_t t : needed_by.row(p)) {
                if (--supply[t] == 0) {
                    for (const std::uint32_t q : targets(t)) {
                        if (in[q] != 0) {
                            in[q] = 0;
                            out.push_back(q);
                        }
                    }
                }
            }
        }
    }

 private:
    static bool takes_as_much(const PlainNet& net, std::uint32_t t, const net::Weighted& read) {
        const auto row = net.takes.row(t);
        return std::any_of(row.begin(), row.end(), [&](const net::Weighted& w) {
            return w.place == read.place && w.weight >= read.weight;
        });
    }
    bool fed(std::uint32_t p, const std::vector<std::uint32_t>& supply) const {
        const auto row = producers.row(p);
        return std::all_of(row.begin(), row.end(), [&](std::uint32_t t) { return supply[t] > 0; });
    }
    const net::Rows<std::uint32_t>& needers() const {
        if (needers_.items.empty() && needers_.size() == 0) {
            needers_.starts.assign(places + 1, 0);
            for (const net::Weighted& w : from.items) {
                ++needers_.starts[w.place + 1];
            }
            for (std::uint32_t p = 0; p < places; ++p) {
                needers_.starts[p + 1] += needers_.starts[p];
            }
            needers_.items.resize(from.items.size());
            std::vector<std::uint32_t> at(needers_.starts.begin(), needers_.starts.end() - 1);
            for (std::uint32_t t = 0; t < from.size(); ++t) {
                for (const net::Weighted& w : from.row(t)) {
                    needers_.items[at[w.place]++] = t;
                }
            }
        }
        return needers_;
    }
    const std::vector<std::uint32_t>& targets(std::uint32_t t) const {
        if (targets_.empty()) {
            targets_.resize(from.size());
            for (std::uint32_t p = 0; p < places; ++p) {
                for (const std::uint32_t u : producers.row(p)) {
                    targets_[u].push_back(p);
                }
            }
        }
        return targets_[t];
    }
    mutable net::Rows<std::uint32_t> needers_;
    mutable std::vector<std::vector<std::uint32_t>> targets_;
};

PlaceSet listed(const std::vector<std::uint8_t>& in) {
    PlaceSet set;
    for (std::uint32_t p = 0; p < in.size(); ++p) {
        if (in[p] != 0) {
            set.push_back(p);
        }
    }
    return set;
}

std::vector<std::uint8_t> marked(const PlainNet& net, std::span<const std::uint32_t> places) {
    std::vector<std::uint8_t> in(net.place_count(), 0);
    for (const std::uint32_t p : places) {
        in[p] = 1;
    }
    return in;
}

bool includes(const std::vector<std::uint8_t>& in, const PlaceSet& set) {
    return std::all_of(set.begin(), set.end(), [&](std::uint32_t p) { return in[p] != 0; });
}

bool is_empty(const std::vector<std::uint8_t>& in) {
    return std::find(in.begin(), in.end(), std::uint8_t{1}) == in.end();
}

// Takes places away while something with all demanded ones remains.
void minimize(const Arcs& arcs, std::vector<std::uint8_t>& in, const PlaceSet& demanded) {
    for (std::uint32_t p = 0; p < in.size(); ++p) {
        if (in[p] == 0 || std::binary_search(demanded.begin(), demanded.end(), p)) {
            continue;
        }
        std::vector<std::uint8_t> less = in;
        less[p] = 0;
        arcs.shrink(less);
        if (!is_empty(less) && includes(less, demanded)) {
            in = std::move(less);
        }
    }
}

bool is_minimal(const Arcs& arcs, const std::vector<std::uint8_t>& in) {
    for (std::uint32_t p = 0; p < in.size(); ++p) {
        if (in[p] != 0) {
            std::vector<std::uint8_t> less = in;
            less[p] = 0;
            arcs.shrink(less);
            if (!is_empty(less)) {
                return false;
            }
        }
    }
    return true;
}

// Calls with each minimal set until it answers false. True: all were visited.
template <class Visit>
bool each_minimal(const PlainNet& net, bool siphons, const Budget& budget, Visit visit) {
    struct Problem {
        std::vector<std::uint8_t> allowed;
        PlaceSet demanded;
    };
    const Arcs arcs(net, siphons);
    Meter meter(budget, siphons ? "siphons" : "traps");
    std::vector<Problem> open;
    open.push_back({std::vector<std::uint8_t>(net.place_count(), 1), {}});
    std::uint64_t steps = 0;
    while (!open.empty()) {
        if (meter.look(steps++, 0, open.size(), open.size() * net.place_count()) != Ended::kDone) {
            return false;
        }
        Problem problem = std::move(open.back());
        open.pop_back();
        arcs.shrink(problem.allowed);
        if (is_empty(problem.allowed) || !includes(problem.allowed, problem.demanded)) {
            continue;
        }
        std::vector<std::uint8_t> found = problem.allowed;
        minimize(arcs, found, problem.demanded);
        const PlaceSet set = listed(found);
        if ((problem.demanded.empty() || is_minimal(arcs, found)) && !visit(set)) {
            return false;
        }
        PlaceSet demanded = problem.demanded;
        for (const std::uint32_t p : set) {
            if (std::binary_search(problem.demanded.begin(), problem.demanded.end(), p)) {
                continue;
            }
            Problem next{problem.allowed, demanded};
            next.allowed[p] = 0;
            open.push_back(std::move(next));
            demanded.insert(std::lower_bound(demanded.begin(), demanded.end(), p), p);
        }
    }
    return true;
}

PlaceSets minimal_sets(const PlainNet& net, bool siphons, const Budget& budget) {
    PlaceSets out;
    const std::uint64_t most = std::min(budget.states, kMostSets);
    out.complete = each_minimal(net, siphons, budget, [&](const PlaceSet& set) {
        if (out.sets.size() >= most) {
            return false;
        }
        out.sets.push_back(set);
        return true;
    });
    std::sort(out.sets.begin(), out.sets.end());
    return out;
}

PlaceSet greatest_within(const PlainNet& net, bool siphons, std::span<const std::uint32_t> places) {
    std::vector<std::uint8_t> in = marked(net, places);
    Arcs(net, siphons).shrink(in);
    return listed(in);
}

}  // namespace

bool is_trap(const PlainNet& net, std::span<const std::uint32_t> places) {
    return greatest_trap_within(net, places).size() == listed(marked(net, places)).size();
}
bool is_siphon(const PlainNet& net, std::span<const std::uint32_t> places) {
    return greatest_siphon_within(net, places).size() == listed(marked(net, places)).size();
}

PlaceSet greatest_trap_within(const PlainNet& net, std::span<const std::uint32_t> places) {
    return greatest_within(net, false, places);
}
PlaceSet greatest_siphon_within(const PlainNet& net, std::span<const std::uint32_t> places) {
    return greatest_within(net, true, places);
}

PlaceSets minimal_siphons(const PlainNet& net, const Budget& budget) {
    return minimal_sets(net, true, budget);
}
PlaceSets minimal_traps(const PlainNet& net, const Budget& budget) {
    return minimal_sets(net, false, budget);
}

// Minimal siphons are enough: a trap of a part is a trap of the whole.
SiphonAnswer commoner(const PlainNet& net, const Budget& budget) {
    SiphonAnswer answer;
    answer.kind = SiphonAnswer::kHolds;
    const Arcs traps(net, false);
    const bool all = each_minimal(net, true, budget, [&](const PlaceSet& siphon) {
        std::vector<std::uint8_t> in = marked(net, siphon);
        traps.shrink(in);
        for (std::uint32_t p = 0; p < in.size(); ++p) {
            if (in[p] != 0 && net.initial[p] > 0) {
                return true;
            }
        }
        answer.kind = SiphonAnswer::kFails;
        answer.siphon = siphon;
        return false;
    });
    if (!all && answer.kind == SiphonAnswer::kHolds) {
        answer.kind = SiphonAnswer::kUnknown;
    }
    return answer;
}

}  // namespace puppetri::proof
