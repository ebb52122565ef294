// SPDX-License-Identifier: MIT
// A state does not say what began last. So each state gets the set of what may have: the least sets
// that contain what goes on at first and are closed under the edges. An edge whose firing begins
// something on a lane replaces the set, any other one hands it on; both keep unions, so the least
// sets are exactly the union over all paths.
#include "puppetri/proof/successions.h"

#include <algorithm>
#include <deque>

namespace puppetri::proof {
namespace {

class LastBegun {
 public:
    explicit LastBegun(const SuccessionRequest& request) : r_(request) {
        for (const std::uint32_t items : r_.items) {
            starts_.push_back(words_);
            words_ += (items + 1 + 63) / 64;
        }
        starts_.push_back(words_);
        sets_.assign(std::size_t{r_.graph.size()} * words_, 0);
    }

    std::vector<Succession> run() {
        std::uint64_t* first = row(r_.graph.initial);
        for (std::uint32_t lane = 0; lane < r_.items.size(); ++lane) {
            set(first, {lane, r_.items[lane]});
        }
        for (const Begin& b : r_.initially) {  // at least one: then something has begun
            clear(first, b.lane);
        }
        for (const Begin& b : r_.initially) {
            set(first, b);
        }
        std::deque<std::uint32_t> open{r_.graph.initial};
        std::vector<std::uint8_t> waits(r_.graph.size(), 0);
        std::vector<std::uint64_t> next(words_);
        while (!open.empty()) {
            const std::uint32_t s = open.front();
            open.pop_front();
            waits[s] = 0;
            for (std::uint64_t e = r_.graph.edges.starts[s]; e < r_.graph.edges.starts[s + 1];
                 ++e) {
                const Edge& edge = r_.graph.edges.items[e];
                std::copy(row(s), row(s) + words_, next.begin());
                for (const Begin& b : begins(edge)) {
                    clear(next.data(), b.lane);
                }
                for (const Begin& b : begins(edge)) {
                    set(next.data(), b);
                }
                if (join(row(edge.target), next) && waits[edge.target] == 0) {
                    waits[edge.target] = 1;
                    open.push_back(edge.target);
                }
            }
        }
        return collect();
    }

 private:
    std::span<const Begin> begins(const Edge& edge) const {
        return edge.label == Edge::kPass || (edge.label & Edge::kEvent) != 0
                   ? std::span<const Begin>()
                   : std::span<const Begin>(r_.begins.row(edge.label));
    }
    std::uint64_t* row(std::uint32_t state) { return sets_.data() + std::size_t{state} * words_; }
    void set(std::uint64_t* row, Begin b) const {
        row[starts_[b.lane] + b.item / 64] |= std::uint64_t{1} << (b.item % 64);
    }
    void clear(std::uint64_t* row, std::uint32_t lane) const {
        std::fill(row + starts_[lane], row + starts_[lane + 1], 0);
    }
    bool join(std::uint64_t* to, const std::vector<std::uint64_t>& from) const {
        bool grown = false;
        for (std::uint32_t w = 0; w < words_; ++w) {
            grown = grown || (from[w] & ~to[w]) != 0;
            to[w] |= from[w];
        }
        return grown;
    }

    std::vector<Succession> collect() {
        std::vector<Succession> out;
        std::size_t united = 0;
        for (std::uint32_t s = 0; s < r_.graph.size(); ++s) {
            if (std::all_of(row(s), row(s) + words_, [](std::uint64_t w) { return w == 0; })) {
                continue;  // no path comes here
            }
            for (std::uint64_t e = r_.graph.edges.starts[s]; e < r_.graph.edges.starts[s + 1];
                 ++e) {
                const Edge& edge = r_.graph.edges.items[e];
                const std::span<const Begin> list = begins(edge);
                for (const Begin& b : list) {
                    for (std::uint32_t i = 0; i <= r_.items[b.lane]; ++i) {
                        if ((row(s)[starts_[b.lane] + i / 64] >> (i % 64)) & 1) {
                            out.push_back({b.lane, i, edge.label, b.item});
                        }
                    }
                    for (const Begin& other : list) {
                        if (other.lane == b.lane && &other != &b) {
                            out.push_back({b.lane, other.item, edge.label, b.item});
                        }
                    }
                }
            }
            if (out.size() > 2 * united + 4096) {
                unite(out);
                united = out.size();
            }
        }
        unite(out);
        return out;
    }
    static void unite(std::vector<Succession>& list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }

    const SuccessionRequest& r_;
    std::vector<std::uint32_t> starts_;  // of each lane's words in a row
    std::uint32_t words_ = 0;
    std::vector<std::uint64_t> sets_;
};

}  // namespace

std::uint64_t bytes_for_successions(const SuccessionRequest& request) {
    std::uint64_t words = 0;
    for (const std::uint32_t items : request.items) {
        words += (items + 1 + 63) / 64;
    }
    return words * sizeof(std::uint64_t) * request.graph.size();
}

std::vector<Succession> successions(const SuccessionRequest& request) {
    return LastBegun(request).run();
}

}  // namespace puppetri::proof
