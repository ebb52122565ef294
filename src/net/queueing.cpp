// SPDX-License-Identifier: MIT
#include "puppetri/net/queueing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "check.h"
#include "puppetri/base/distribution.h"

namespace puppetri::net {
namespace {

struct Law {
    double mean_s = 0;  // 0: no time; below 0: not known
    bool exponential = false, random = false;
};

Law law_of(const DurationDraft& d) {
    constexpr Law kUnknown{.mean_s = -1};
    const auto seconds = [](const Expr& e) {
        return static_cast<double>(e.literal_value()) / static_cast<double>(kTicksPerSecond);
    };
    switch (d.kind) {
        case DurationKind::kConstant:
        case DurationKind::kExpression:
            return d.a.is_literal() ? Law{.mean_s = seconds(d.a)} : kUnknown;
        case DurationKind::kInterval:
            return d.a.is_literal() && d.b.is_literal()
                       ? Law{.mean_s = (seconds(d.a) + seconds(d.b)) / 2,
                             .random = seconds(d.a) < seconds(d.b)}
                       : kUnknown;
        case DurationKind::kDistribution: {
            std::vector<double> parameters;
            for (const Expr& e : d.parameters) {
                if (!e.is_literal()) {
                    return kUnknown;
                }
                parameters.push_back(e.type().kind == ValueKind::kTime ? seconds(e)
                                     : e.type().kind == ValueKind::kReal
                                         ? real_of_value(e.literal_value())
                                         : static_cast<double>(e.literal_value()));
            }
            if (!check(d.distribution, parameters)) {
                return kUnknown;
            }
            const Moments m = moments(d.distribution, parameters);
            return {.mean_s = m.mean,
                    .exponential = d.distribution == DistributionKind::kExponential,
                    .random = m.variance > 0};
        }
        default:
            return kUnknown;
    }
}

bool has_guard(const TransitionDraft& t) {
    return t.guard && !(t.guard->is_literal() && t.guard->literal_value() != 0);
}

// Nothing but taking and giving: no condition, no delay, no event.
bool is_plain(const TransitionDraft& t) {
    return !has_guard(t) && !t.delay && !t.holding && t.events.empty() &&
           std::none_of(t.inputs.begin(), t.inputs.end(), [](const ArcDraft& a) {
               return a.kind != ArcKind::kTake ||
                      std::any_of(a.pattern.begin(), a.pattern.end(),
                                  [](const PatternDraft& p) { return !p.binds; });
           });
}

// The same, but that a token may be taken before it is ready.
bool is_plain_now(const TransitionDraft& t) {
    return !has_guard(t) && !t.delay && !t.holding && t.events.empty() && t.inputs.size() == 1 &&
           t.inputs[0].kind == ArcKind::kTakeNow;
}

bool has_odds(const TransitionDraft& t) { return !t.odds || t.odds->is_literal(); }

double odds_of(const TransitionDraft& t) {
    if (!t.odds) {
        return 1;
    }
    const Value v = t.odds->literal_value();
    return t.odds->type().kind == ValueKind::kReal ? real_of_value(v) : static_cast<double>(v);
}

constexpr std::uint32_t kNone = ~std::uint32_t{0};

class Finder {
 public:
    explicit Finder(const NetDraft& draft)
        : draft_(draft),
          takers_(draft.places.size()),
          givers_(draft.places.size()),
          law_(draft.places.size()),
          tokens_(draft.places.size()),
          center_of_(draft.places.size(), kNone),
          known_place_(draft.places.size()),
          known_transition_(draft.transitions.size()) {
        for (std::uint32_t t = 0; t < draft.transitions.size(); ++t) {
            for (const ArcDraft& a : draft.transitions[t].inputs) {
                add(takers_[a.place.value], t);
            }
            for (const OutputDraft& o : draft.transitions[t].outputs) {
                add(givers_[o.place.value], t);
            }
        }
        for (std::uint32_t p = 0; p < draft.places.size(); ++p) {
            law_[p] = law_of(effective_duration(draft.places[p]));
            for (const InitialToken& i : draft.places[p].tokens) {
                tokens_[p] += i.count;
            }
        }
    }

    QueueNetwork find() {
        if (!draft_.fusions.empty() || !draft_.rendezvous.empty()) {
            net_.why_not.push_back("places or transitions are shared");
            return std::move(net_);
        }
        find_stations();
        find_delays();
        find_sources();
        const std::size_t n = net_.centers.size();
        net_.arrivals_per_s.assign(n, 0);
        net_.routing.assign(n * n, 0);
        route_sources();
        route_centers();
        for (const QueueCenter& c : net_.centers) {
            net_.customers += tokens_[c.service.value];
            net_.customers += c.queue.valid() ? tokens_[c.queue.value] : 0;
        }
        find_inside();
        say_why_not();
        return std::move(net_);
    }

 private:
    static void add(std::vector<std::uint32_t>& list, std::uint32_t t) {
        if (list.empty() || list.back() != t) {
            list.push_back(t);
        }
    }
    bool gives(std::uint32_t t, std::uint32_t p) const {
        const auto& outputs = draft_.transitions[t].outputs;
        return std::any_of(outputs.begin(), outputs.end(), [&](const OutputDraft& o) {
            return o.place.value == p && o.weight == 1;
        });
    }
    bool takes(std::uint32_t t, std::uint32_t p) const {
        return std::binary_search(takers_[p].begin(), takers_[p].end(), t);
    }
    // It takes a token that stands for a server who is away.
    bool returns_server(std::uint32_t t, std::uint32_t free, std::uint32_t service) const {
        const auto& inputs = draft_.transitions[t].inputs;
        return std::any_of(inputs.begin(), inputs.end(), [&](const ArcDraft& a) {
            const std::uint32_t away = a.place.value;
            return tokens_[away] == 0 && a.kind == ArcKind::kTake &&
                   std::all_of(givers_[away].begin(), givers_[away].end(), [&](std::uint32_t g) {
                       return gives(g, away) && (takes(g, free) || takes(g, service));
                   });
        });
    }
    bool instant(std::uint32_t p) const { return law_[p].mean_s == 0; }

    // start: queue + free -> service, and every other transition that takes the service gives the
    // server back.
    void find_stations() {
        for (std::uint32_t t = 0; t < draft_.transitions.size(); ++t) {
            const TransitionDraft& start = draft_.transitions[t];
            if (!is_plain(start) || start.inputs.size() != 2 || start.outputs.size() != 1 ||
                start.inputs[0].weight != 1 || start.inputs[1].weight != 1 ||
                start.outputs[0].weight != 1) {
                continue;
            }
            const std::uint32_t service = start.outputs[0].place.value;
            for (const bool swapped : {false, true}) {
                const std::uint32_t queue = start.inputs[swapped ? 1 : 0].place.value,
                                    free = start.inputs[swapped ? 0 : 1].place.value;
                if (station(t, queue, free, service)) {
                    break;
                }
            }
        }
    }

    bool station(std::uint32_t t, std::uint32_t queue, std::uint32_t free, std::uint32_t service) {
        if (queue == free || queue == service || free == service || !instant(queue) ||
            !instant(free) || tokens_[free] == 0 || center_of_[service] != kNone ||
            draft_.places[queue].capacity || tokens_[service] != 0) {
            return false;
        }
        Law law = law_[service];
        std::uint32_t entry = queue;
        bool strict = true;
        if (draft_.transitions[t].outputs[0].lasts) {
            // The service was drawn on coming in: by a place that was left before it was over.
            strict = false;
            law.mean_s = -1;
            for (const std::uint32_t g : givers_[queue]) {
                const TransitionDraft& draws = draft_.transitions[g];
                if (is_plain_now(draws) && draws.outputs.size() == 1) {
                    entry = draws.inputs[0].place.value;
                    law = law_[entry];
                }
            }
        }
        if (!(law.mean_s > 0)) {
            return false;
        }
        QueueCenter c;
        for (const std::uint32_t e : takers_[service]) {
            const TransitionDraft& end = draft_.transitions[e];
            if (gives(e, service)) {
                strict = false;  // another takes the place of the one who was served
                continue;
            }
            if (gives(e, free) &&
                std::all_of(end.inputs.begin(), end.inputs.end(),
                            [&](const ArcDraft& a) { return a.kind == ArcKind::kTake; })) {
                c.ends.push_back({e});
            } else if (gives(e, queue)) {
                strict = false;  // the server failed
            } else {
                return false;
            }
        }
        // A taker of a queue is a customer that does not wait, unless it gives one back.
        for (const std::uint32_t q : takers_[queue]) {
            if (q != t && !gives(q, queue)) {
                return false;
            }
        }
        for (const std::uint32_t f : takers_[free]) {
            strict = strict && f == t;
        }
        // Nobody adds servers, and nobody is served without one.
        for (const std::uint32_t g : givers_[free]) {
            if (!takes(g, service) && !returns_server(g, free, service)) {
                return false;
            }
        }
        for (const std::uint32_t g : givers_[service]) {
            if (g != t && !takes(g, service) && !takes(g, free)) {
                return false;
            }
        }
        c.name = draft_.places[service].path;
        c.queue = {queue};
        c.service = {service};
        c.free = {free};
        c.servers =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(tokens_[free], 1'000'000'000));
        c.mean_s = law.mean_s;
        c.exponential = law.exponential && strict && !draft_.places[service].keeps_order &&
                        !draft_.places[service].capacity;
        c.random = law.random;
        c.start = {t};
        c.where = draft_.places[service].where;
        for (const std::uint32_t p : {entry, queue, service}) {
            center_of_[p] = static_cast<std::uint32_t>(net_.centers.size());
        }
        if (strict) {
            known_place_[queue] = known_place_[service] = known_place_[free] = true;
            known_transition_[t] = true;
        }
        net_.centers.push_back(std::move(c));
        return true;
    }

    // Timed places whose tokens all go on alone.
    void find_delays() {
        for (std::uint32_t p = 0; p < draft_.places.size(); ++p) {
            if (!(law_[p].mean_s > 0) || center_of_[p] != kNone || takers_[p].empty() ||
                draft_.places[p].capacity || draft_.places[p].keeps_order) {
                continue;
            }
            const bool alone =
                std::all_of(takers_[p].begin(), takers_[p].end(), [&](std::uint32_t t) {
                    return is_plain(draft_.transitions[t]) &&
                           draft_.transitions[t].inputs[0].place.value == p && !gives(t, p);
                });
            if (!alone) {
                continue;
            }
            QueueCenter c;
            c.name = draft_.places[p].path;
            c.service = {p};
            c.mean_s = law_[p].mean_s;
            c.exponential = law_[p].exponential;
            c.random = law_[p].random;
            c.where = draft_.places[p].where;
            for (const std::uint32_t t : takers_[p]) {
                c.ends.push_back({t});
            }
            center_of_[p] = static_cast<std::uint32_t>(net_.centers.size());
            known_place_[p] = true;
            net_.centers.push_back(std::move(c));
        }
    }

    void find_sources() {
        for (std::uint32_t p = 0; p < draft_.places.size(); ++p) {
            if (!(law_[p].mean_s > 0) || center_of_[p] != kNone || takers_[p].empty()) {
                continue;
            }
            const bool ticks =
                std::all_of(takers_[p].begin(), takers_[p].end(), [&](std::uint32_t t) {
                    const TransitionDraft& tick = draft_.transitions[t];
                    return is_plain(tick) && tick.inputs[0].place.value == p &&
                           tick.inputs[0].weight == 1 && gives(t, p) && has_odds(tick);
                });
            // It has the clock's token, or gets it once, from a place that nobody fills.
            std::uint64_t first = tokens_[p];
            bool once = true;
            for (const std::uint32_t g : givers_[p]) {
                const std::vector<ArcDraft>& in = draft_.transitions[g].inputs;
                if (!gives(g, p) || in.empty() ||
                    std::find(takers_[p].begin(), takers_[p].end(), g) != takers_[p].end()) {
                    continue;
                }
                once = once && in.size() == 1 && givers_[in[0].place.value].empty();
                first += tokens_[in[0].place.value];
            }
            if (!ticks || !once || first != 1) {
                continue;
            }
            QueueSource s;
            s.clock = {p};
            s.rate_per_s = 1 / law_[p].mean_s;
            s.exponential = law_[p].exponential && tokens_[p] == 1;
            s.random = law_[p].random;
            for (const std::uint32_t t : takers_[p]) {
                s.ticks.push_back({t});
            }
            known_place_[p] = s.exponential;
            net_.sources.push_back(std::move(s));
        }
        for (std::uint32_t t = 0; t < draft_.transitions.size(); ++t) {
            const TransitionDraft& tick = draft_.transitions[t];
            if (!tick.delay || !tick.inputs.empty() || has_guard(tick) || !tick.events.empty() ||
                tick.holding || tick.delay->servers != 1) {
                continue;
            }
            const Law law = law_of(tick.delay->duration);
            if (law.mean_s > 0) {
                net_.sources.push_back({.clock = {},
                                        .ticks = {{t}},
                                        .rate_per_s = 1 / law.mean_s,
                                        .exponential = law.exponential,
                                        .random = law.random});
            }
        }
    }

    // How the odds of these transitions share, those that have any to share.
    double total_odds(const std::vector<TransitionIndex>& list) const {
        double sum = 0;
        for (const TransitionIndex t : list) {
            if (!has_odds(draft_.transitions[t.value])) {
                return 0;
            }
            sum += odds_of(draft_.transitions[t.value]);
        }
        return sum;
    }

    void route_sources() {
        for (QueueSource& s : net_.sources) {
            const double sum = total_odds(s.ticks);
            bool strict = sum > 0;
            for (const TransitionIndex t : s.ticks) {
                const TransitionDraft& tick = draft_.transitions[t.value];
                const std::size_t known = s.clock.valid() ? 1 : 0;
                if (!(sum > 0) || tick.inputs.size() != known) {
                    strict = false;
                    continue;
                }
                std::size_t to = 0;
                for (const OutputDraft& o : tick.outputs) {
                    const std::uint32_t c = center_of_[o.place.value];
                    if (c != kNone) {
                        s.to.push_back(c);
                        net_.arrivals_per_s[c] +=
                            s.rate_per_s * odds_of(tick) / sum * static_cast<double>(o.weight);
                        to += static_cast<std::size_t>(o.weight);
                    }
                }
                strict = strict && to <= 1;
                known_transition_[t.value] = to <= 1;
            }
            if (!strict || !s.exponential) {
                for (const TransitionIndex t : s.ticks) {
                    known_transition_[t.value] = false;
                }
            }
        }
    }

    void route_centers() {
        const std::size_t n = net_.centers.size();
        for (std::size_t i = 0; i < n; ++i) {
            const QueueCenter& c = net_.centers[i];
            const double sum = total_odds(c.ends);
            // A guard, or something else that is taken, decides: nothing is certain.
            const bool certain =
                sum > 0 && std::all_of(c.ends.begin(), c.ends.end(), [&](TransitionIndex t) {
                    const TransitionDraft& end = draft_.transitions[t.value];
                    return is_plain(end) && (end.inputs.size() == 1 || counts_inside(end));
                });
            if (!certain) {
                continue;
            }
            for (const TransitionIndex t : c.ends) {
                const TransitionDraft& end = draft_.transitions[t.value];
                std::size_t to = 0;
                net_.centers[i].shares.push_back(odds_of(end) / sum);
                for (const OutputDraft& o : end.outputs) {
                    const std::uint32_t j = center_of_[o.place.value];
                    if (j != kNone) {
                        net_.routing[i * n + j] +=
                            odds_of(end) / sum * static_cast<double>(o.weight);
                        to += static_cast<std::size_t>(o.weight);
                    }
                }
                known_transition_[t.value] = to <= 1;
            }
        }
    }

    // The second thing that a leaving customer takes may be a place that counts customers.
    bool counts_inside(const TransitionDraft& end) {
        if (end.inputs.size() != 2) {
            return false;
        }
        for (const ArcDraft& a : end.inputs) {
            if (center_of_[a.place.value] == kNone && instant(a.place.value) && a.weight == 1) {
                if (net_.inside.valid() && net_.inside != a.place) {
                    return false;
                }
                net_.inside = a.place;
                return is_count(a.place.value);
            }
        }
        return false;
    }

    // Every firing changes it by as many as there are customers more or fewer afterwards.
    bool is_count(std::uint32_t p) const {
        std::uint64_t there = 0;
        for (const QueueCenter& c : net_.centers) {
            there += tokens_[c.service.value] + (c.queue.valid() ? tokens_[c.queue.value] : 0);
        }
        if (there != tokens_[p]) {
            return false;
        }
        for (const TransitionDraft& t : draft_.transitions) {
            std::int64_t change = 0;
            for (const ArcDraft& a : t.inputs) {
                change += a.place.value == p                   ? a.weight
                          : center_of_[a.place.value] != kNone ? -a.weight
                                                               : 0;
            }
            for (const OutputDraft& o : t.outputs) {
                change -= o.place.value == p                   ? o.weight
                          : center_of_[o.place.value] != kNone ? -o.weight
                                                               : 0;
            }
            if (change != 0) {
                return false;
            }
        }
        return true;
    }

    // A place that nobody takes from without counting.
    void find_inside() {
        if (net_.inside.valid() && is_count(net_.inside.value)) {
            known_place_[net_.inside.value] = true;
        } else {
            net_.inside = {};
        }
    }

    void say_why_not() {
        std::vector<std::string>& why = net_.why_not;
        if (net_.centers.empty()) {
            why.push_back("there is no station");
            return;
        }
        for (const QueueCenter& c : net_.centers) {
            if (c.servers != 0 && !c.exponential) {
                why.push_back("services at " + c.name + " are not exponential, or interrupted");
            }
        }
        for (std::uint32_t p = 0; p < draft_.places.size(); ++p) {
            if (!known_place_[p]) {
                why.push_back("place " + draft_.places[p].path +
                              " is no part of a plain queueing network");
            }
        }
        for (std::uint32_t t = 0; t < draft_.transitions.size(); ++t) {
            if (!known_transition_[t]) {
                why.push_back("transition " + draft_.transitions[t].path +
                              " is no part of a plain queueing network");
            }
        }
        if (!net_.sources.empty() && net_.customers != 0) {
            why.push_back("customers come from outside, and others are there from the beginning");
        }
        if (!draft_.refinements.empty() || !draft_.schedule.empty()) {
            why.push_back("events, or nets within places, take part");
        }
    }

    const NetDraft& draft_;
    std::vector<std::vector<std::uint32_t>> takers_, givers_;  // transitions, by place
    std::vector<Law> law_;
    std::vector<std::uint64_t> tokens_;
    std::vector<std::uint32_t> center_of_;  // by place: where a token given to it goes
    std::vector<bool> known_place_, known_transition_;
    QueueNetwork net_;
};

}  // namespace

QueueNetwork find_queues(const NetDraft& draft) { return Finder(draft).find(); }

Diagnostics growing_queues(const NetDraft& draft) {
    const QueueNetwork net = find_queues(draft);
    const std::size_t n = net.centers.size();
    // The least solution of: comes = from outside + what the others pass on.
    std::vector<double> comes(n, 0), passes(n, 0);
    std::vector<bool> random(n, false);  // what comes, comes at random
    for (const QueueSource& s : net.sources) {
        for (const std::size_t j : s.to) {
            random[j] = random[j] || s.random || s.ticks.size() > 1;
        }
    }
    for (int round = 0; round < 10000; ++round) {
        double change = 0;
        for (std::size_t j = 0; j < n; ++j) {
            double sum = net.arrivals_per_s[j];
            for (std::size_t i = 0; i < n; ++i) {
                const double share = net.routing[i * n + j];
                sum += passes[i] * share;
                random[j] = random[j] || (passes[i] * share > 0 &&
                                          (random[i] || net.centers[i].random || share < 1));
            }
            change = std::max(change, std::abs(sum - comes[j]) / std::max(sum, 1e-300));
            comes[j] = sum;
            const QueueCenter& c = net.centers[j];
            passes[j] = c.servers == 0 ? sum : std::min(sum, c.servers / c.mean_s);
        }
        if (change < 1e-12) {
            break;
        }
    }
    Diagnostics out;
    for (std::size_t i = 0; i < n; ++i) {
        const QueueCenter& c = net.centers[i];
        if (c.servers == 0) {
            continue;
        }
        const double load = comes[i] * c.mean_s / c.servers;
        if (load > 1 + 1e-9 || (load > 1 - 1e-9 && (c.random || random[i]))) {
            char text[40];
            std::snprintf(text, sizeof text, "%.4g", load);
            out.push_back({.severity = Severity::kWarning,
                           .code = "grows-without-bound",
                           .where = c.where,
                           .element = "station " + c.name,
                           .message = "the queue before " + c.name +
                                      " grows without bound: its utilisation would be " + text,
                           .remedy = "let customers come less often, serve them faster or by more "
                                     "servers, or give the station a room"});
        }
    }
    return out;
}

}  // namespace puppetri::net
