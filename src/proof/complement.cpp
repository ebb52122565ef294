// SPDX-License-Identifier: MIT
// Complement places.
#include "puppetri/proof/complement.h"

#include <algorithm>
#include <map>

#include "puppetri/proof/semiflows.h"
#include "puppetri/proof/state_equation.h"

namespace puppetri::proof {

namespace {

constexpr std::uint64_t kGreatest = 1 << 30;

std::uint32_t weight_in(std::span<const net::Weighted> row, std::uint32_t place) {
    for (const net::Weighted& w : row) {
        if (w.place == place) {
            return w.weight;
        }
    }
    return 0;
}

// The most tokens that the place can have; kNoBound: not known.
std::uint64_t bound_of(const PlainNet& net, std::uint32_t p, const Budget& budget) {
    // Whoever adds to it finds fewer than its limit there.
    std::uint64_t bound = net.initial[p];
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        const std::uint64_t gives = weight_in(net.gives.row(t), p);
        const std::uint64_t takes = weight_in(net.takes.row(t), p);
        if (gives > takes) {
            const std::uint32_t limit = weight_in(net.unless.row(t), p);
            if (limit == 0) {
                const auto known = upper_bound(net, {{{p, 1}}}, budget);
                return known && *known >= 0 ? static_cast<std::uint64_t>(*known) : kNoBound;
            }
            bound = std::max(bound, limit - 1 + gives - takes);
        }
    }
    return bound;
}

}  // namespace

std::optional<PlainNet> without_inhibitors(const PlainNet& net, const Budget& budget) {
    PlainNet out;
    out.initial = net.initial;
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> complement;  // place -> it, B
    for (const net::Weighted& w : net.unless.items) {
        if (complement.count(w.place) != 0) {
            continue;
        }
        const std::uint64_t bound = bound_of(net, w.place, budget);
        if (bound > kGreatest) {
            return std::nullopt;
        }
        complement[w.place] = {static_cast<std::uint32_t>(out.initial.size()),
                               static_cast<std::uint32_t>(bound)};
        out.initial.push_back(static_cast<std::uint32_t>(bound) - net.initial[w.place]);
    }
    const auto put = [](net::Rows<net::Weighted>& rows, std::span<const net::Weighted> row,
                        std::vector<net::Weighted> more) {
        more.insert(more.end(), row.begin(), row.end());
        std::sort(more.begin(), more.end(),
                  [](const auto& a, const auto& b) { return a.place < b.place; });
        rows.items.insert(rows.items.end(), more.begin(), more.end());
        rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
    };
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        std::vector<net::Weighted> takes, gives, reads;
        for (const auto& [p, its] : complement) {
            const std::uint32_t in = weight_in(net.takes.row(t), p);
            const std::uint32_t add = weight_in(net.gives.row(t), p);
            const std::uint32_t limit = weight_in(net.unless.row(t), p);
            if (add > in) {
                takes.push_back({its.first, add - in});
            } else if (in > add) {
                gives.push_back({its.first, in - add});
            }
            if (limit != 0 && limit <= its.second) {
                const std::uint32_t need = its.second - limit + 1;
                if (need > (add > in ? add - in : 0)) {
                    reads.push_back({its.first, need});
                }
            }
        }
        put(out.takes, net.takes.row(t), std::move(takes));
        put(out.gives, net.gives.row(t), std::move(gives));
        put(out.reads, net.reads.row(t), std::move(reads));
        put(out.unless, {}, {});
    }
    out.level = net.level;
    out.has_levels = net.has_levels;
    out.optional = net.optional;
    out.left_out = net.left_out;
    return out;
}

}  // namespace puppetri::proof
