// SPDX-License-Identifier: MIT
// Searches in graphs of states, without recursion.
#include "puppetri/proof/graph_algorithms.h"

#include <algorithm>

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

bool lies_in(const StateBits* within, std::uint32_t s) { return within == nullptr || (*within)[s]; }

// The state that an edge leaves: the row it lies in.
std::uint32_t source_of(const Graph& graph, std::uint32_t edge) {
    const auto& starts = graph.edges.starts;
    const auto after = std::upper_bound(starts.begin(), starts.end(), edge);
    return static_cast<std::uint32_t>(after - starts.begin()) - 1;
}

// Back along the edges by which a search came.
Path path_to(const Graph& graph, std::uint32_t from, std::uint32_t to,
             const std::vector<std::uint32_t>& came_by) {
    Path path;
    for (std::uint32_t s = to; s != from;) {
        path.push_back(came_by[s]);
        s = source_of(graph, came_by[s]);
    }
    std::reverse(path.begin(), path.end());
    return path;
}

// Breadth first from the successors of `from` (which is not itself seen), until `found`.
template <class Found>
std::optional<Path> search(const Graph& graph, std::uint32_t from, const StateBits* within,
                           Found&& found) {
    std::vector<std::uint32_t> came_by(graph.size(), kNone);
    std::vector<std::uint32_t> queue = {from};
    for (std::size_t head = 0; head < queue.size(); ++head) {
        const std::uint32_t s = queue[head];
        for (std::uint32_t e = graph.edges.starts[s]; e < graph.edges.starts[s + 1]; ++e) {
            const std::uint32_t to = graph.edges.items[e].target;
            if (came_by[to] != kNone) {
                continue;
            }
            if (found(to)) {
                Path path = path_to(graph, from, s, came_by);
                path.push_back(e);
                return path;
            }
            if (to != from && lies_in(within, to)) {
                came_by[to] = e;
                queue.push_back(to);
            }
        }
    }
    return std::nullopt;
}

}  // namespace

StateBits::StateBits(std::uint32_t size, bool value)
    : size_(size), words_((std::uint64_t{size} + 63) / 64, value ? ~std::uint64_t{0} : 0) {
    if (value && size % 64 != 0) {
        words_.back() = (std::uint64_t{1} << (size % 64)) - 1;
    }
}

StateBits& StateBits::operator&=(const StateBits& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) {
        words_[i] &= other.words_[i];
    }
    return *this;
}

StateBits& StateBits::operator|=(const StateBits& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) {
        words_[i] |= other.words_[i];
    }
    return *this;
}

void StateBits::complement() {
    for (std::uint64_t& word : words_) {
        word = ~word;
    }
    if (size_ % 64 != 0) {
        words_.back() &= (std::uint64_t{1} << (size_ % 64)) - 1;
    }
}

std::uint32_t StateBits::count() const {
    std::uint32_t sum = 0;
    for (const std::uint64_t word : words_) {
        sum += static_cast<std::uint32_t>(__builtin_popcountll(word));
    }
    return sum;
}

bool StateBits::empty() const {
    return std::all_of(words_.begin(), words_.end(), [](std::uint64_t word) { return word == 0; });
}

StateBits states_where_atom_may(const Graph& graph, std::uint32_t atom) {
    StateBits bits(graph.size());
    for (std::uint32_t s = 0; s < graph.size(); ++s) {
        if (graph.atoms.may_hold(s, atom)) {
            bits.add(s);
        }
    }
    return bits;
}

StateBits states_where_atom_must(const Graph& graph, std::uint32_t atom) {
    StateBits bits(graph.size());
    for (std::uint32_t s = 0; s < graph.size(); ++s) {
        if (graph.atoms.must_hold(s, atom)) {
            bits.add(s);
        }
    }
    return bits;
}

bool may_end(const Graph& graph, std::uint32_t state) {
    const std::uint8_t flags = graph.flags.empty() ? std::uint8_t{0} : graph.flags[state];
    return (flags & Graph::kCut) == 0 && ((flags & Graph::kOptional) != 0 || graph.dead(state));
}

net::Rows<std::uint32_t> predecessors(const Graph& graph) {
    net::Rows<std::uint32_t> rows;
    const std::uint32_t size = graph.size();
    rows.starts.assign(std::size_t{size} + 1, 0);
    for (const Edge& e : graph.edges.items) {
        ++rows.starts[e.target];
    }
    std::uint32_t sum = 0;
    for (std::uint32_t& start : rows.starts) {  // each where its row ends
        sum += start;
        start = sum;
    }
    rows.items.resize(graph.edges.items.size());
    for (std::uint32_t s = size; s-- > 0;) {
        for (const Edge& e : graph.edges.row(s)) {
            rows.items[--rows.starts[e.target]] = s;
        }
    }
    return rows;
}

StrongComponents strong_components(const Graph& graph, const StateBits* within) {
    struct Frame {
        std::uint32_t state, edge, low;
    };
    const std::uint32_t size = graph.size();
    StrongComponents result;
    result.of.assign(size, StrongComponents::kNone);
    std::vector<std::uint32_t> index(size, 0), open;  // 0: not seen
    std::vector<Frame> frames;
    std::uint32_t next = 0;
    for (std::uint32_t root = 0; root < size; ++root) {
        if (index[root] != 0 || !lies_in(within, root)) {
            continue;
        }
        const auto enter = [&](std::uint32_t s) {
            index[s] = ++next;
            open.push_back(s);
            frames.push_back({s, graph.edges.starts[s], next});
        };
        enter(root);
        while (!frames.empty()) {
            Frame& frame = frames.back();
            if (frame.edge < graph.edges.starts[frame.state + 1]) {
                const std::uint32_t to = graph.edges.items[frame.edge++].target;
                if (!lies_in(within, to)) {
                    continue;
                }
                if (index[to] == 0) {
                    enter(to);
                } else if (result.of[to] == StrongComponents::kNone) {
                    frame.low = std::min(frame.low, index[to]);
                }
                continue;
            }
            const Frame done = frame;
            frames.pop_back();
            if (!frames.empty()) {
                frames.back().low = std::min(frames.back().low, done.low);
            }
            if (done.low == index[done.state]) {
                std::uint32_t s = kNone;
                do {
                    s = open.back();
                    open.pop_back();
                    result.of[s] = result.count;
                } while (s != done.state);
                ++result.count;
            }
        }
    }
    return result;
}

StateBits bottom_components(const Graph& graph, const StrongComponents& components) {
    StateBits bottoms(components.count, true);
    for (std::uint32_t s = 0; s < graph.size(); ++s) {
        if (components.of[s] == StrongComponents::kNone) {
            continue;
        }
        for (const Edge& e : graph.edges.row(s)) {
            if (components.of[e.target] != components.of[s]) {
                bottoms.remove(components.of[s]);
            }
        }
    }
    return bottoms;
}

StateBits cyclic_components(const Graph& graph, const StrongComponents& components) {
    StateBits cyclic(components.count);
    for (std::uint32_t s = 0; s < graph.size(); ++s) {
        if (components.of[s] == StrongComponents::kNone) {
            continue;
        }
        for (const Edge& e : graph.edges.row(s)) {
            if (components.of[e.target] == components.of[s]) {
                cyclic.add(components.of[s]);
            }
        }
    }
    return cyclic;
}

StateBits reached_from(const Graph& graph, const StateBits& from, const StateBits* within) {
    StateBits seen(graph.size());
    std::vector<std::uint32_t> waiting;
    const auto meet = [&](std::uint32_t s) {
        if (!seen[s] && lies_in(within, s)) {
            seen.add(s);
            waiting.push_back(s);
        }
    };
    from.for_each(meet);
    while (!waiting.empty()) {
        const std::uint32_t s = waiting.back();
        waiting.pop_back();
        for (const Edge& e : graph.edges.row(s)) {
            meet(e.target);
        }
    }
    return seen;
}

StateBits leading_to(const net::Rows<std::uint32_t>& predecessors, const StateBits& goal,
                     const StateBits* within) {
    StateBits seen = goal;
    std::vector<std::uint32_t> waiting;
    goal.for_each([&](std::uint32_t s) { waiting.push_back(s); });
    while (!waiting.empty()) {
        const std::uint32_t s = waiting.back();
        waiting.pop_back();
        for (const std::uint32_t before : predecessors.row(s)) {
            if (!seen[before] && lies_in(within, before)) {
                seen.add(before);
                waiting.push_back(before);
            }
        }
    }
    return seen;
}

std::vector<std::uint32_t> states_along(const Graph& graph, std::uint32_t from, const Path& path) {
    std::vector<std::uint32_t> states = {from};
    for (const std::uint32_t edge : path) {
        states.push_back(graph.edges.items[edge].target);
    }
    return states;
}

std::optional<Path> shortest_path(const Graph& graph, std::uint32_t from, const StateBits& goal,
                                  const StateBits* within) {
    if (goal[from]) {
        return Path{};
    }
    if (!lies_in(within, from)) {
        return std::nullopt;
    }
    return search(graph, from, within, [&](std::uint32_t s) { return goal[s]; });
}

std::optional<Path> shortest_cycle(const Graph& graph, std::uint32_t state,
                                   const StateBits* within) {
    if (!lies_in(within, state)) {
        return std::nullopt;
    }
    return search(graph, state, within, [&](std::uint32_t s) { return s == state; });
}

std::optional<Lasso> lasso_within(const Graph& graph, std::uint32_t from, const StateBits& within) {
    if (!within[from]) {
        return std::nullopt;
    }
    const StrongComponents components = strong_components(graph, &within);
    const StateBits cyclic = cyclic_components(graph, components);
    StateBits goal(graph.size());
    within.for_each([&](std::uint32_t s) {
        if (may_end(graph, s) || cyclic[components.of[s]]) {
            goal.add(s);
        }
    });
    std::optional<Path> stem = shortest_path(graph, from, goal, &within);
    if (!stem.has_value()) {
        return std::nullopt;
    }
    const std::uint32_t last = stem->empty() ? from : graph.edges.items[stem->back()].target;
    Lasso lasso{std::move(*stem), {}};
    if (!may_end(graph, last)) {
        lasso.loop = shortest_cycle(graph, last, &within).value_or(Path{});
    }
    return lasso;
}

}  // namespace puppetri::proof
