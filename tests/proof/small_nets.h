// SPDX-License-Identifier: MIT
// Small random plain nets and their whole state spaces, by the shortest code that can be seen to be
// right: the oracle of everything structural.
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/random.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::proof::test {

// A few bits of chance per call.
class Chance {
 public:
    explicit Chance(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15ull + 1) {}
    std::uint32_t below(std::uint32_t n) {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 7;
        state_ ^= state_ << 17;
        return static_cast<std::uint32_t>((state_ * 0x2545f4914f6cdd1dull) >> 33) % n;
    }
    bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
    std::uint64_t state_;
};

struct SmallNetShape {
    std::uint32_t places = 5, transitions = 5;  // at most
    std::uint32_t tokens = 2;                   // per place, at most
    bool weights = false, reads = false, inhibitors = false, optional = false;
    bool conservative = true;  // as many arcs out as in: bounded
};

inline void add_row(net::Rows<net::Weighted>& rows,
                    const std::map<std::uint32_t, std::uint32_t>& w) {
    for (const auto& [place, weight] : w) {
        rows.items.push_back({place, weight});
    }
    rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
}

inline void add_transition(PlainNet& net, const std::map<std::uint32_t, std::uint32_t>& takes,
                           const std::map<std::uint32_t, std::uint32_t>& gives,
                           const std::map<std::uint32_t, std::uint32_t>& reads = {},
                           const std::map<std::uint32_t, std::uint32_t>& unless = {},
                           bool optional = false) {
    add_row(net.takes, takes);
    add_row(net.gives, gives);
    add_row(net.reads, reads);
    add_row(net.unless, unless);
    net.level.push_back(0);
    net.optional.push_back(optional ? 1 : 0);
}

inline PlainNet small_net(Chance& chance, const SmallNetShape& shape) {
    PlainNet net;
    const std::uint32_t places = 2 + chance.below(shape.places - 1);
    const std::uint32_t transitions = 1 + chance.below(shape.transitions);
    for (std::uint32_t p = 0; p < places; ++p) {
        net.initial.push_back(chance.one_in(2) ? 0 : chance.below(shape.tokens + 1));
    }
    for (std::uint32_t t = 0; t < transitions; ++t) {
        std::map<std::uint32_t, std::uint32_t> takes, gives, reads, unless;
        const std::uint32_t in = chance.one_in(12) && !shape.conservative ? 0 : 1 + chance.below(2);
        for (std::uint32_t i = 0; i < in; ++i) {
            takes[chance.below(places)] = shape.weights && chance.one_in(4) ? 2 : 1;
        }
        if (shape.conservative) {
            std::uint32_t left = 0;
            for (const auto& [p, w] : takes) {
                left += w;
            }
            left -= chance.one_in(6) ? chance.below(left + 1) : 0;
            for (; left > 0; --left) {
                ++gives[chance.below(places)];
            }
            if (!shape.weights) {
                for (auto& [p, w] : gives) {
                    w = 1;
                }
            }
        } else {
            const std::uint32_t out = chance.below(3);
            for (std::uint32_t i = 0; i < out; ++i) {
                gives[chance.below(places)] = shape.weights && chance.one_in(4) ? 2 : 1;
            }
        }
        if (shape.reads && chance.one_in(4)) {
            const std::uint32_t p = chance.below(places);
            if (takes.count(p) == 0) {
                reads[p] = 1 + (shape.weights ? chance.below(2) : 0);
            } else if (shape.weights && chance.one_in(2)) {
                reads[p] = takes[p] + 1;
            }
        }
        if (shape.inhibitors && chance.one_in(4)) {
            unless[chance.below(places)] = 1 + chance.below(2);
        }
        add_transition(net, takes, gives, reads, unless, shape.optional && chance.one_in(6));
    }
    return net;
}

struct Space {
    std::vector<Marking> markings;  // number 0 is the initial one
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> edges;  // transition, target
    bool complete = true;
    std::map<Marking, std::uint32_t> number;

    bool dead(const PlainNet& net, std::uint32_t s) const {
        return std::none_of(edges[s].begin(), edges[s].end(),
                            [&](const auto& e) { return net.optional[e.first] == 0; });
    }
};

inline Space whole_space(const PlainNet& net, std::uint32_t limit = 5000,
                         std::uint32_t most_tokens = 40) {
    Space space;
    space.markings.push_back(net.initial);
    space.number[net.initial] = 0;
    for (std::uint32_t s = 0; s < space.markings.size(); ++s) {
        space.edges.emplace_back();
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            Marking m = space.markings[s];
            if (!net.enabled(m, t)) {
                continue;
            }
            net.fire(m, t);
            if (space.markings.size() >= limit ||
                std::any_of(m.begin(), m.end(), [&](std::uint32_t n) { return n > most_tokens; })) {
                space.complete = false;
                return space;
            }
            const auto [it, is_new] =
                space.number.emplace(m, static_cast<std::uint32_t>(space.markings.size()));
            if (is_new) {
                space.markings.push_back(m);
            }
            space.edges[s].emplace_back(t, it->second);
        }
    }
    return space;
}

// From every reachable marking every transition can be enabled again.
inline std::vector<std::uint8_t> live_transitions(const PlainNet& net, const Space& space) {
    std::vector<std::uint8_t> live(net.transition_count(), 1);
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        std::vector<std::uint8_t> can(space.markings.size(), 0);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::uint32_t s = 0; s < space.markings.size(); ++s) {
                for (const auto& [u, target] : space.edges[s]) {
                    if (can[s] == 0 && (u == t || can[target] != 0)) {
                        can[s] = 1;
                        changed = true;
                    }
                }
            }
        }
        live[t] = std::find(can.begin(), can.end(), 0) == can.end() ? 1 : 0;
    }
    return live;
}

inline Predicate small_predicate(Chance& chance, const PlainNet& net, int depth = 2) {
    const std::uint32_t kind = chance.below(depth > 0 ? 5 : 3);
    if (kind >= 3) {
        std::vector<Predicate> parts;
        const std::uint32_t count = 2 + chance.below(2);
        for (std::uint32_t i = 0; i < count; ++i) {
            parts.push_back(small_predicate(chance, net, depth - 1));
        }
        return kind == 3 ? Predicate::all_of(parts) : Predicate::any_of(parts);
    }
    if (kind == 2 && net.transition_count() > 0) {
        Predicate p = Predicate::enabled({chance.below(net.transition_count())});
        return chance.one_in(2) ? p : p.negated();
    }
    LinearSum sum;
    std::map<std::uint32_t, std::int64_t> terms;
    const std::uint32_t count = 1 + chance.below(3);
    for (std::uint32_t i = 0; i < count; ++i) {
        terms[chance.below(net.place_count())] =
            chance.one_in(4) ? std::int64_t{-1} : 1 + chance.below(2);
    }
    for (const auto& [p, f] : terms) {
        sum.terms.push_back({p, f});
    }
    const std::int64_t limit = std::int64_t{chance.below(5)} - 1;
    return kind == 0 ? Predicate::at_most(sum, limit) : Predicate::at_least(sum, limit);
}

// For messages of failing tests.
inline std::string text(const PlainNet& net) {
    std::string out = "initial";
    for (const std::uint32_t n : net.initial) {
        out += " " + std::to_string(n);
    }
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        out += "\nt" + std::to_string(t) + (net.optional[t] != 0 ? " optional" : "");
        const auto row = [&](const char* name, std::span<const net::Weighted> arcs) {
            for (const net::Weighted& w : arcs) {
                out += std::string(" ") + name + std::to_string(w.weight) + "*p" +
                       std::to_string(w.place);
            }
        };
        row("-", net.takes.row(t));
        row("+", net.gives.row(t));
        row("read ", net.reads.row(t));
        row("unless ", net.unless.row(t));
    }
    return out;
}

}  // namespace puppetri::proof::test
