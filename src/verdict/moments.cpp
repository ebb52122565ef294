// SPDX-License-Identifier: MIT
#include "moments.h"

#include <algorithm>
#include <map>

#include "puppetri/proof/graph_algorithms.h"
#include "puppetri/verdict/product.h"

namespace puppetri::verdict {
namespace {

// The labels that the formula asks for, sorted.
std::vector<std::uint32_t> asked_labels(const Obligation& o) {
    std::vector<std::uint32_t> labels;
    for (const Operand& operand : o.operands) {
        for (const Operand::Node& n : operand.nodes) {
            if (n.op == Operand::Node::Op::kFires) {
                labels.push_back(n.index);
            } else if (n.op == Operand::Node::Op::kEvent) {
                labels.push_back(proof::Edge::kEvent | n.index);
            }
        }
    }
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    return labels;
}

}  // namespace

Moments moments_of(const proof::TimedGraph& timed, const Obligation& o, bool stands_for_ever) {
    using proof::Graph;
    const Graph& from = timed.graph;
    const std::vector<std::uint32_t> labels = asked_labels(o);
    const std::uint32_t wait_words = (timed.waits.kinds + 63) / 64;
    Moments m;
    m.waits.kinds = timed.waits.kinds;
    m.waits.rare = timed.waits.rare;
    m.waits.by_outside = timed.waits.by_outside;
    m.graph.over = from.over;
    m.graph.exact = from.exact;
    m.graph.ended = from.ended;
    m.graph.atoms.atoms = static_cast<std::uint32_t>(o.operands.size());
    const std::uint32_t words = (m.graph.atoms.atoms + 63) / 64;
    if (from.size() == 0) {
        return m;
    }

    constexpr std::uint32_t kNew = ~std::uint32_t{0};
    std::map<std::uint32_t, std::vector<std::uint32_t>> known;
    std::vector<std::uint32_t> just;  // per node
    const auto node_of = [&](std::uint32_t state, std::uint32_t label) {
        if (!std::binary_search(labels.begin(), labels.end(), label)) {
            label = Operand::kNoFiring;
        }
        std::vector<std::uint32_t>& row = known[label];
        if (row.empty()) {
            row.resize(from.size(), kNew);
        }
        if (row[state] != kNew) {
            return row[state];
        }
        row[state] = static_cast<std::uint32_t>(m.state.size());
        m.state.push_back(state);
        just.push_back(label);
        // A path that may end here goes on first, where something has just happened.
        const bool ends = proof::may_end(from, state);
        const bool goes_on = ends && (stands_for_ever || label != Operand::kNoFiring);
        m.graph.flags.push_back(static_cast<std::uint8_t>(
            from.flags[state] & (goes_on ? ~unsigned{Graph::kOptional} : ~0u)));
        const std::size_t at = m.graph.atoms.may.size();
        m.graph.atoms.may.resize(at + words);
        m.graph.atoms.must.resize(at + words);
        for (std::size_t i = 0; i < o.operands.size(); ++i) {
            const Truth t = o.operands[i].at(Product::row_of(from, state), label);
            m.graph.atoms.may[at + i / 64] |= std::uint64_t{t.may ? 1u : 0u} << (i % 64);
            m.graph.atoms.must[at + i / 64] |= std::uint64_t{t.must ? 1u : 0u} << (i % 64);
        }
        if (wait_words != 0) {
            const auto row_at =
                timed.waits.waiting.begin() + static_cast<std::ptrdiff_t>(state) * wait_words;
            m.waits.waiting.insert(m.waits.waiting.end(), row_at, row_at + wait_words);
        }
        return row[state];
    };

    m.graph.initial = node_of(from.initial, Operand::kNoFiring);
    for (std::uint32_t n = 0; n < m.state.size(); ++n) {
        const std::uint32_t s = m.state[n];
        for (std::uint32_t e = from.edges.starts[s]; e < from.edges.starts[s + 1]; ++e) {
            const proof::Edge& edge = from.edges.items[e];
            m.graph.edges.items.push_back({edge.label, node_of(edge.target, edge.label)});
            m.origin.push_back(e);
            if (!from.high_ticks.empty()) {
                m.graph.high_ticks.push_back(from.high_ticks[e]);
            }
            if (wait_words != 0) {
                const auto row_at =
                    timed.waits.stirred.begin() + static_cast<std::ptrdiff_t>(e) * wait_words;
                m.waits.stirred.insert(m.waits.stirred.end(), row_at, row_at + wait_words);
            }
        }
        if (proof::may_end(from, s) && (stands_for_ever || just[n] != Operand::kNoFiring)) {
            m.graph.edges.items.push_back({proof::Edge::kPass, node_of(s, Operand::kNoFiring)});
            m.origin.push_back(Moments::kStands);
            if (!from.high_ticks.empty()) {
                m.graph.high_ticks.push_back(0);
            }
            m.waits.stirred.resize(m.waits.stirred.size() + wait_words);
        }
        m.graph.edges.starts.push_back(static_cast<std::uint32_t>(m.graph.edges.items.size()));
    }
    return m;
}

}  // namespace puppetri::verdict
