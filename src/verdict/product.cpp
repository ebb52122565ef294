// SPDX-License-Identifier: MIT
#include "puppetri/verdict/product.h"

#include <algorithm>
#include <limits>
#include <map>

namespace puppetri::verdict {

AtomRow Product::row_of(const proof::Graph& graph, std::uint32_t state) {
    const std::uint64_t words = (graph.atoms.atoms + 63) / 64;
    return {graph.atoms.may.data() + state * words, graph.atoms.must.data() + state * words};
}

Product make_product(const proof::Graph& graph, const Monitor* monitor, std::uint64_t most_edges,
                     const std::vector<proof::Stop>& stops, bool paced) {
    Product p;
    p.graph = &graph;
    if (!stops.empty()) {
        p.stop.resize(graph.size(), 0);
        for (const proof::Stop& stop : stops) {
            p.stop[stop.state] = 1;
        }
    }
    p.complete = graph.ended == proof::Ended::kDone;
    // Monitors have few states: a row of nodes for each.
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::map<std::uint32_t, std::vector<std::uint32_t>> known;
    const auto node_of = [&](std::uint32_t state, std::uint32_t m) {
        std::vector<std::uint32_t>& row = known[m];
        if (row.empty()) {
            row.resize(graph.size(), kNone);
        }
        if (row[state] == kNone) {
            row[state] = p.size();
            p.state.push_back(state);
            p.monitor.push_back(m);
        }
        return row[state];
    };
    std::vector<std::uint32_t> next;
    const auto settled = [&](std::uint32_t s) {
        return (graph.flags[s] & proof::Graph::kSettled) != 0;
    };
    // Where an event may still come in this instant, time need not pass: a monitor that looks only
    // where it does may have looked, or not.
    const auto may_skip = [&](std::uint32_t s, std::uint32_t m) {
        if (monitor == nullptr || !monitor->when_settled() ||
            std::find(next.begin(), next.end(), m) != next.end()) {
            return;
        }
        for (const proof::Edge& e : graph.edges.row(s)) {
            if (e.label != proof::Edge::kPass && (e.label & proof::Edge::kEvent) != 0) {
                next.push_back(m);
                return;
            }
        }
    };
    if (graph.size() == 0) {
        p.complete = false;
        p.starts.push_back(0);
        return p;
    }
    const std::uint32_t initial = graph.initial;
    if (monitor != nullptr) {
        const AtomRow row = Product::row_of(graph, initial);
        monitor->step(monitor->start(),
                      {.before = row, .now = row, .settled = settled(initial), .start = true},
                      next);
        may_skip(initial, monitor->start());
        for (const std::uint32_t m : next) {
            p.first.push_back(node_of(initial, m));
        }
    } else {
        p.first.push_back(node_of(initial, 0));
    }
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        p.starts.push_back(p.targets.size());
        if (p.broken(n)) {
            continue;
        }
        const std::uint32_t s = p.state[n], m = p.monitor[n];
        if (p.targets.size() > most_edges) {
            p.complete = false;
            continue;
        }
        if (p.cut(n)) {
            p.complete = false;
        }
        const AtomRow before = Product::row_of(graph, s);
        for (std::uint32_t e = graph.edges.starts[s]; e < graph.edges.starts[s + 1]; ++e) {
            const proof::Edge& edge = graph.edges.items[e];
            if (monitor == nullptr) {
                p.targets.push_back(node_of(edge.target, 0));
                p.edge.push_back(e);
                continue;
            }
            monitor->step(m,
                          {.before = before,
                           .now = Product::row_of(graph, edge.target),
                           .label = edge.label,
                           .settled = settled(edge.target) ||
                                      (paced && (edge.label & proof::Edge::kEvent) == 0)},
                          next);
            may_skip(edge.target, m);
            for (const std::uint32_t to : next) {
                p.targets.push_back(node_of(edge.target, to));
                p.edge.push_back(e);
            }
        }
    }
    p.starts.push_back(p.targets.size());
    return p;
}

namespace {

// Time may pass in the component, and every condition "what waits of this kind does not wait for
// ever" is met somewhere in it: a generalized Buechi condition, so that looking at whole components
// is enough.
bool is_just(const Product& p, const std::vector<std::uint32_t>& component,
             const std::vector<std::uint32_t>& of_node, std::uint32_t number, const Nodes& open,
             const std::vector<std::uint8_t>& left_out, const proof::Waits& waits) {
    const unsigned silent = waits.kinds != 0 ? proof::Graph::kSettled : proof::Graph::kOptional;
    const auto passes = [&](std::uint32_t n) {
        if ((p.graph->flags[p.state[n]] & silent) != 0) {
            return true;
        }
        for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1]; ++e) {
            const std::uint32_t to = p.targets[e];
            if (p.graph->lets_time_pass(p.edge[e]) && open[to] != 0 && of_node[to] == number &&
                (left_out.empty() || left_out[e] == 0)) {
                return true;
            }
        }
        return false;
    };
    if (std::none_of(component.begin(), component.end(), passes)) {
        return false;
    }
    for (std::uint32_t kind = 0; kind < waits.kinds; ++kind) {
        bool met = false;
        for (std::size_t i = 0; !met && i < component.size(); ++i) {
            met = !waits.waits(p.state[component[i]], kind);
        }
        for (std::size_t i = 0; !met && i < component.size(); ++i) {
            const std::uint32_t n = component[i];
            for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1] && !met; ++e) {
                const std::uint32_t to = p.targets[e];
                met = open[to] != 0 && of_node[to] == number &&
                      (left_out.empty() || left_out[e] == 0) && waits.stirs(p.edge[e], kind);
            }
        }
        if (!met) {
            return false;
        }
    }
    return true;
}

// Source  R. Tarjan, Depth-first search and linear graph algorithms, SIAM J. Computing 1, 1972;
//         without recursion.
std::optional<std::vector<std::uint32_t>> cycles(const Product& p, const Nodes& open,
                                                 const std::vector<std::uint8_t>& left_out,
                                                 const proof::Waits* waits) {
    constexpr std::uint32_t kNew = ~std::uint32_t{0};
    std::vector<std::uint32_t> index(p.size(), kNew), low(p.size(), 0),
        component_of(p.size(), kNew), stack;
    std::vector<std::pair<std::uint32_t, std::uint64_t>> path;  // node, next edge
    std::uint32_t count = 0, components = 0;
    const auto inside = [&](std::uint64_t e) {
        return open[p.targets[e]] != 0 && (left_out.empty() || left_out[e] == 0);
    };
    for (std::uint32_t root = 0; root < p.size(); ++root) {
        if (open[root] == 0 || index[root] != kNew) {
            continue;
        }
        path.push_back({root, p.starts[root]});
        index[root] = low[root] = count++;
        stack.push_back(root);
        while (!path.empty()) {
            auto& [n, e] = path.back();
            if (e < p.starts[n + 1]) {
                const std::uint64_t edge = e++;
                const std::uint32_t to = p.targets[edge];
                if (!inside(edge)) {
                    continue;
                }
                if (index[to] == kNew) {
                    index[to] = low[to] = count++;
                    stack.push_back(to);
                    path.push_back({to, p.starts[to]});
                } else if (component_of[to] == kNew) {
                    low[n] = std::min(low[n], index[to]);
                }
                continue;
            }
            const std::uint32_t done = n;
            path.pop_back();
            if (!path.empty()) {
                low[path.back().first] = std::min(low[path.back().first], low[done]);
            }
            if (low[done] != index[done]) {
                continue;
            }
            std::vector<std::uint32_t> component;
            std::uint32_t member = kNew;
            while (member != done) {
                member = stack.back();
                stack.pop_back();
                component_of[member] = components;
                component.push_back(member);
            }
            bool cycle = component.size() > 1;
            for (std::uint64_t k = p.starts[done]; k < p.starts[done + 1] && !cycle; ++k) {
                cycle = inside(k) && p.targets[k] == done;
            }
            if (cycle && (waits == nullptr || is_just(p, component, component_of, components, open,
                                                      left_out, *waits))) {
                return component;
            }
            ++components;
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> endless(const Product& p, const Nodes& open,
                                                  const std::vector<std::uint8_t>& left_out,
                                                  const proof::Waits* waits) {
    if (waits == nullptr) {
        return cycles(p, open, left_out, nullptr);
    }
    // Where no time passes, nothing that waits helps, and events come finitely often.
    std::vector<std::uint8_t> without = left_out;
    without.resize(p.targets.size(), 0);
    for (std::uint64_t e = 0; e < p.targets.size(); ++e) {
        const proof::Edge& edge = p.graph->edges.items[p.edge[e]];
        without[e] =
            without[e] != 0 || edge.label == proof::Edge::kPass || waits->is_rare(edge) ? 1 : 0;
    }
    auto zeno = cycles(p, open, without, nullptr);
    return zeno ? zeno : cycles(p, open, left_out, waits);
}

namespace {

constexpr std::int64_t kForEver = std::numeric_limits<std::int64_t>::max();

std::int64_t plus(std::int64_t a, std::int64_t b) { return a > kForEver - b ? kForEver : a + b; }

class Stay {
 public:
    Stay(const Product& p, const Nodes& open, bool by_ticks, const proof::Waits* waits,
         const std::vector<std::int64_t>& at_most)
        : p_(p), open_(open), waits_(waits), at_most_(at_most), known_(p.size(), kUnknown) {
        timed_ = by_ticks && p.graph->high_ticks.size() == p.graph->edges.items.size();
    }

    // For nodes in `open`.
    std::int64_t longest(std::uint32_t n) {
        if (known_[n] != kUnknown) {
            return known_[n] == kBusy ? kForEver : known_[n];
        }
        // Deep paths would use up the stack: no bound is known then.
        if (depth_ > 20'000 || work_ > 50'000'000) {
            return kForEver;
        }
        known_[n] = kBusy;
        ++depth_;
        std::int64_t value = 0;
        if (p_.rests(n) || p_.cut(n)) {
            value = kForEver;
        } else if (timed_ || !time_passes(n)) {
            for (std::uint64_t e = p_.starts[n]; e < p_.starts[n + 1] && value != kForEver; ++e) {
                const std::uint32_t to = p_.targets[e];
                const std::int64_t ticks = timed_ ? p_.graph->high_ticks[p_.edge[e]] : 0;
                value = std::max(value, open_[to] != 0 ? plus(longest(to), ticks) : ticks);
            }
        } else {
            value = kForEver;
            for (std::uint32_t kind = 0; waits_ != nullptr && kind < waits_->kinds; ++kind) {
                if (kind < at_most_.size() && at_most_[kind] < value &&
                    waits_->waits(p_.state[n], kind)) {
                    value = std::min(value, while_waiting(n, kind));
                }
            }
        }
        --depth_;
        known_[n] = value;
        return value;
    }

 private:
    static constexpr std::int64_t kUnknown = -1, kBusy = -2;

    bool time_passes(std::uint32_t n) const {
        if ((p_.graph->flags[p_.state[n]] & proof::Graph::kSettled) != 0) {
            return true;
        }
        for (std::uint64_t e = p_.starts[n]; e < p_.starts[n + 1]; ++e) {
            if (p_.label(e) == proof::Edge::kPass) {
                return true;
            }
        }
        return false;
    }

    // Something of the kind waits in n. Where the paths from n lead to, staying open, when that
    // has ended or may have been stirred; it is at most at_most_[kind] later.
    std::int64_t while_waiting(std::uint32_t n, std::uint32_t kind) {
        std::vector<std::uint32_t> region = {n}, exits;
        std::vector<std::uint8_t> seen(p_.size(), std::uint8_t{0});
        work_ += p_.size() / 8;
        seen[n] = 1;
        for (std::size_t i = 0; i < region.size(); ++i) {
            const std::uint32_t from = region[i];
            for (std::uint64_t e = p_.starts[from]; e < p_.starts[from + 1]; ++e) {
                ++work_;
                const std::uint32_t to = p_.targets[e];
                if (open_[to] == 0) {
                    continue;
                }
                if (!waits_->waits(p_.state[to], kind) || waits_->stirs(p_.edge[e], kind)) {
                    exits.push_back(to);
                } else if (seen[to] == 0) {
                    seen[to] = 1;
                    region.push_back(to);
                }
            }
        }
        std::int64_t worst = 0;
        for (const std::uint32_t exit : exits) {
            worst = std::max(worst, longest(exit));
            if (worst == kForEver) {
                return kForEver;
            }
        }
        return plus(worst, at_most_[kind]);
    }

    const Product& p_;
    const Nodes& open_;
    const proof::Waits* waits_;
    const std::vector<std::int64_t>& at_most_;
    std::vector<std::int64_t> known_;
    bool timed_ = false;
    std::uint32_t depth_ = 0;
    std::uint64_t work_ = 0;
};

}  // namespace

std::optional<std::int64_t> longest_stay(const Product& product, const Nodes& open,
                                         const std::vector<std::uint32_t>& from, bool by_ticks,
                                         const proof::Waits* waits,
                                         const std::vector<std::int64_t>& at_most) {
    Stay stay(product, open, by_ticks, waits, at_most);
    std::int64_t worst = 0;
    for (const std::uint32_t n : from) {
        worst = std::max(worst, stay.longest(n));
    }
    return worst == kForEver ? std::nullopt : std::optional(worst);
}

std::vector<std::uint32_t> distances_to_edges(const Product& p,
                                              const std::vector<std::uint8_t>& edges,
                                              const Nodes& targets,
                                              const std::vector<std::uint8_t>& left_out) {
    std::vector<std::uint64_t> starts(p.size() + 1, 0);
    for (std::uint64_t e = 0; e < p.targets.size(); ++e) {
        starts[p.targets[e] + 1] += left_out.empty() || left_out[e] == 0 ? 1 : 0;
    }
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        starts[n + 1] += starts[n];
    }
    std::vector<std::uint32_t> sources(p.targets.size());
    std::vector<std::uint64_t> at(starts.begin(), starts.end() - 1);
    std::vector<std::uint32_t> distance(p.size(), kFar), queue;
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        bool here = !targets.empty() && targets[n] != 0;
        for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1]; ++e) {
            if (!left_out.empty() && left_out[e] != 0) {
                continue;
            }
            sources[at[p.targets[e]]++] = n;
            here = here || (!edges.empty() && edges[e] != 0);
        }
        if (here) {
            distance[n] = 0;
            queue.push_back(n);
        }
    }
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const std::uint32_t n = queue[i];
        for (std::uint64_t k = starts[n]; k < starts[n + 1]; ++k) {
            if (distance[sources[k]] == kFar) {
                distance[sources[k]] = distance[n] + 1;
                queue.push_back(sources[k]);
            }
        }
    }
    return distance;
}

std::vector<std::uint32_t> distances(const Product& product, const Nodes& targets,
                                     const std::vector<std::uint8_t>& left_out) {
    return distances_to_edges(product, {}, targets, left_out);
}

}  // namespace puppetri::verdict
