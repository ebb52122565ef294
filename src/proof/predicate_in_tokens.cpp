// SPDX-License-Identifier: MIT
// Predicates that other nets can be asked: about tokens alone.
#include <algorithm>

#include "predicate_builder.h"

namespace puppetri::proof {

using Op = Predicate::Op;

Predicate told_in_tokens(const Predicate& p, const PlainNet& net,
                         std::span<const std::uint32_t> place_to) {
    PredicateBuilder builder;
    const auto moved = [&](std::uint32_t place) {
        return place_to.empty() ? place : place_to[place];
    };
    const auto enabled = [&](std::uint32_t t, bool negated) {
        std::vector<std::uint32_t> parts;
        const auto want = [&](const net::Weighted& w, bool at_least) {
            LinearSum sum{{{moved(w.place), 1}}};
            const std::int64_t weight = w.weight;
            parts.push_back(at_least ? builder.at_least(std::move(sum), weight)
                                     : builder.at_most(std::move(sum), weight - 1));
        };
        for (const net::Weighted& w : net.takes.row(t)) {
            want(w, !negated);
        }
        for (const net::Weighted& w : net.reads.row(t)) {
            want(w, !negated);
        }
        for (const net::Weighted& w : net.unless.row(t)) {
            want(w, negated);
        }
        return negated ? builder.any_of(parts) : builder.all_of(parts);
    };
    const std::uint32_t root = rebuild(
        p, builder, [&](const Predicate::Node& node, std::vector<std::uint32_t>& transitions) {
            if (node.op == Op::kAtMost || node.op == Op::kAtLeast) {
                LinearSum sum = p.sums[node.index];
                for (LinearSum::Term& term : sum.terms) {
                    term.place = moved(term.place);
                }
                normalize(sum);
                return node.op == Op::kAtMost ? builder.at_most(std::move(sum), node.limit)
                                              : builder.at_least(std::move(sum), node.limit);
            }
            const bool none = node.op == Op::kNoneEnabled;
            for (std::uint32_t& t : transitions) {
                t = enabled(t, none);
            }
            return none ? builder.all_of(transitions) : builder.any_of(transitions);
        });
    return builder.finish(root);
}

std::vector<std::uint32_t> places_of(const Predicate& predicate, const PlainNet& net) {
    return CompiledPredicate(net, predicate).places();
}

}  // namespace puppetri::proof
