// SPDX-License-Identifier: MIT
// Supervisor places from place invariants.
#include "puppetri/proof/supervisor.h"

#include <algorithm>

#include "puppetri/proof/semiflows.h"
#include "wide_integer.h"

namespace puppetri::proof {

namespace {

constexpr std::int64_t kMostTokens = 1 << 30;

bool may_not_hold_back(std::span<const std::uint8_t> uncontrollable, std::uint32_t t) {
    return !uncontrollable.empty() && uncontrollable[t] != 0;
}

// How much a firing changes the sum; false if that does not fit.
bool change_of(const std::vector<std::int64_t>& factor, const Flow& effect, std::int64_t& out) {
    Wide sum = 0;
    for (const Flow::Term& term : effect.terms) {
        sum += Wide{factor[term.index]} * term.factor;
    }
    return fits(sum, out) && out < kMostTokens && out > -kMostTokens;
}

SupervisorAnswer no(std::string reason, std::uint32_t transition = ~std::uint32_t{0}) {
    SupervisorAnswer answer;
    answer.reason = std::move(reason);
    answer.transition = transition;
    return answer;
}

}  // namespace

SupervisorAnswer supervise(const PlainNet& net, const LinearSum& sum, std::int64_t limit,
                           std::span<const std::uint8_t> uncontrollable) {
    const std::vector<Flow> columns = effects(net);
    std::vector<std::int64_t> factor(net.place_count(), 0);
    for (const LinearSum::Term& term : sum.terms) {
        factor[term.place] += term.factor;
    }
    // An uncontrollable transition that makes the sum grow by g: a place from which it takes w is
    // counted with ceil(g / w) more, so that the transition finds room that was set aside before.
    // Places are only ever counted more, so sum m <= limit still follows.
    for (std::uint32_t round = 0;; ++round) {
        std::uint32_t bad = net.transition_count();
        std::int64_t grows = 0;
        for (std::uint32_t t = 0; t < net.transition_count() && bad == net.transition_count();
             ++t) {
            if (may_not_hold_back(uncontrollable, t)) {
                if (!change_of(factor, columns[t], grows)) {
                    return no("the weights are too large");
                }
                bad = grows > 0 ? t : bad;
            }
        }
        if (bad == net.transition_count()) {
            break;
        }
        const auto source = std::find_if(columns[bad].terms.begin(), columns[bad].terms.end(),
                                         [](const Flow::Term& f) { return f.factor < 0; });
        if (source == columns[bad].terms.end() || round > 4 * net.place_count()) {
            return no("a transition that nobody may hold back makes the sum grow", bad);
        }
        factor[source->index] += (grows - source->factor - 1) / -source->factor;
    }
    SupervisorAnswer answer;
    Wide initially = 0;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (factor[p] != 0) {
            answer.sum.terms.push_back({p, factor[p]});
            initially += Wide{factor[p]} * net.initial[p];
        }
    }
    answer.limit = limit;
    const Wide tokens = Wide{limit} - initially;
    if (tokens < 0) {
        return no("the sum is above the limit in the beginning");
    }
    if (tokens > kMostTokens) {
        return no("the limit is too large");
    }
    answer.place.tokens = static_cast<std::uint32_t>(tokens);
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        std::int64_t grows = 0;
        if (!change_of(factor, columns[t], grows)) {
            return no("the weights are too large");
        }
        if (grows > 0) {
            answer.place.takes.push_back({t, static_cast<std::uint32_t>(grows)});
        } else if (grows < 0) {
            answer.place.gives.push_back({t, static_cast<std::uint32_t>(-grows)});
        }
    }
    answer.possible = true;
    return answer;
}

SupervisorAnswer monitor_siphon(const PlainNet& net, const PlaceSet& siphon,
                                std::span<const std::uint8_t> uncontrollable) {
    LinearSum sum;
    for (const std::uint32_t p : siphon) {
        sum.terms.push_back({p, -1});
    }
    return supervise(net, sum, -1, uncontrollable);
}

PlaceSet siphon_of_deadlock(const PlainNet& net, std::span<const std::uint32_t> dead_marking) {
    PlaceSet empty;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (dead_marking[p] == 0) {
            empty.push_back(p);
        }
    }
    return greatest_siphon_within(net, empty);
}

PlainNet with_monitor(const PlainNet& net, const MonitorPlace& place) {
    PlainNet out = net;
    const std::uint32_t p = net.place_count();
    out.initial.push_back(place.tokens);
    const auto extend = [&](net::Rows<net::Weighted>& rows,
                            const std::vector<MonitorPlace::Arc>& arcs) {
        net::Rows<net::Weighted> to;
        auto arc = arcs.begin();
        for (std::uint32_t t = 0; t < rows.size(); ++t) {
            const auto row = rows.row(t);
            to.items.insert(to.items.end(), row.begin(), row.end());
            if (arc != arcs.end() && arc->transition == t) {
                to.items.push_back({p, arc->weight});
                ++arc;
            }
            to.starts.push_back(static_cast<std::uint32_t>(to.items.size()));
        }
        rows = std::move(to);
    };
    extend(out.takes, place.takes);
    extend(out.gives, place.gives);
    return out;
}

}  // namespace puppetri::proof
