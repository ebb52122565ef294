// SPDX-License-Identifier: MIT
// The measures that a net declares: what is there all the time is integrated, what happens now and
// then is counted, summed, or kept for percentiles.
#include <algorithm>
#include <cmath>
#include <limits>

#include "puppetri/net/tables.h"
#include "puppetri/sim/meter.h"

namespace puppetri::sim {
namespace {

using net::Statistic;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kTick_s = 1.0 / static_cast<double>(kTicksPerSecond);

bool counts(Statistic s) { return s == Statistic::kCount || s == Statistic::kRate; }

// Reads a state from outside.
class PlayerReader final : public Code::Reader {
 public:
    explicit PlayerReader(const run::Player& player) : player_(player) {}
    Value read(std::uint32_t kind, std::uint32_t index) const override {
        switch (static_cast<net::SlotKind>(kind)) {
            case net::SlotKind::kDatum:
                return player_.datum({index});
            case net::SlotKind::kCount:
                return player_.tokens({index});
            case net::SlotKind::kReady:
                return player_.ready_tokens({index});
            default:
                return 0;
        }
    }

 private:
    const run::Player& player_;
};

}  // namespace

void Meter::Seen::forget() {
    count = true_count = 0;
    sum = most = least = last = 0;
    values.clear();
}

void Meter::Seen::see(double x) {
    most = count == 0 ? x : std::max(most, x);
    least = count == 0 ? x : std::min(least, x);
    ++count;
    sum += x;
    last = x;
    if (measure->statistic == Statistic::kPercentile) {
        values.push_back(x);
    } else if (measure->statistic == Statistic::kShare) {
        true_count += measure->above ? x > measure->above->seconds() : x != 0;
    }
}

double Meter::Seen::result(double passed_s) {
    const auto n = static_cast<double>(count);
    switch (measure->statistic) {
        case Statistic::kCount:
            return n;
        case Statistic::kRate:
            return passed_s > 0 ? n / passed_s : 0;
        case Statistic::kTotal:
            return sum;
        default:
            break;
    }
    if (count == 0) {
        return kNothing;
    }
    switch (measure->statistic) {
        case Statistic::kMost:
            return most;
        case Statistic::kLeast:
            return least;
        case Statistic::kFinal:
            return last;
        case Statistic::kShare:
            return static_cast<double>(true_count) / n;
        case Statistic::kPercentile: {
            const double rank = std::ceil(measure->percent / 100 * n - 1e-9);
            const auto k = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(rank), 1,
                                                      static_cast<std::ptrdiff_t>(count)) -
                           1;
            std::nth_element(values.begin(), values.begin() + k, values.end());
            return values[static_cast<std::size_t>(k)];
        }
        default:
            return sum / n;
    }
}

// Lays out what a measure needs to hear of.
void Meter::add_measure(std::uint32_t number) {
    const net::MeasureDraft& m = net_->declarations().measures[number];
    const net::NetTables& tables = net_->tables();
    const net::NetTables::MeasurePrograms& programs = tables.measures[number];
    if (m.seen == net::Seen::kState) {
        slots_.push_back(static_cast<std::uint32_t>(watched_.size()));
        watched_.push_back({.measure = &m, .number = number, .program = programs.value});
        return;
    }
    if (m.seen == net::Seen::kCourse) {
        followed_.push_back({&m, static_cast<std::uint32_t>(slots_.size())});
        slots_.push_back(0);
        return;
    }
    const auto seen = static_cast<std::uint32_t>(seen_.size());
    slots_.push_back(seen);
    seen_.push_back({.measure = &m});
    passages_.emplace_back();
    if (m.seen == net::Seen::kStays) {
        Place& place = places_[place_number(m.place.value)];
        place.seen.push_back(seen);
        switch (tables.place[m.place.value].kind) {
            case net::PlaceKind::kCount:
                break;
            case net::PlaceKind::kTimed:
                place.leaving = Leaving::kByReadiness;
                wants_.insides = true;
                break;
            case net::PlaceKind::kRich:
                place.leaving = Leaving::kTold;
                wants_.insides = true;
                break;
        }
        return;
    }
    const auto add = [&](const net::Moment& moment, Turn::Role role, ProgramIndex program) {
        Turn t{.role = role,
               .keyed = moment.keyed,
               .seen = seen,
               .measure = number,
               .program = program,
               .kind = moment.value.type().kind};
        wants_.insides |= moment.keyed;
        (moment.keyed ? turns_inside_ : turns_)[moment.transition.value].push_back(t);
    };
    const bool passage = m.seen == net::Seen::kPassages;
    // Ends first: from t to t is from one firing to the next.
    for (std::size_t i = 0; i < m.to.size(); ++i) {
        add(m.to[i], Turn::kEnd, programs.to[i]);
    }
    for (std::size_t i = 0; i < m.from.size(); ++i) {
        add(m.from[i], passage ? Turn::kBegin : Turn::kSee, programs.from[i]);
    }
}

// Which transitions change what a watched value reads; what may change without a firing is looked
// at in every instant.
void Meter::lay_out_watched() {
    const net::NetTables& tables = net_->tables();
    const auto count = static_cast<std::uint32_t>(watched_.size());
    std::vector<std::vector<std::uint32_t>> of_place(net_->place_count()),
        of_datum(net_->datum_count());
    for (std::uint32_t i = 0; i < count; ++i) {
        bool always = false;
        for (const Slot s : tables.measure_code.slots(watched_[i].program)) {
            switch (static_cast<net::SlotKind>(s.kind)) {
                case net::SlotKind::kCount:
                    of_place[s.index].push_back(i);
                    break;
                case net::SlotKind::kDatum:
                    always |= tables.declarations.data[s.index].sensor;
                    of_datum[s.index].push_back(i);
                    break;
                default:
                    always = true;
            }
        }
        if (always) {
            watched_always_.push_back(i);
            wants_.instants = true;
        }
    }
    for (std::uint32_t t = 0; t < net_->transition_count(); ++t) {
        std::vector<std::uint32_t> row;
        const auto add = [&](const std::vector<std::uint32_t>& list) {
            row.insert(row.end(), list.begin(), list.end());
        };
        for (const net::Weighted& w : tables.takes(t)) {
            add(of_place[w.place]);
        }
        for (const net::Weighted& w : tables.gives(t)) {
            add(of_place[w.place]);
        }
        if (tables.transition[t].special != net::kNoIndex) {
            const net::Special& special = tables.specials[tables.transition[t].special];
            for (const net::ArcTable& a : special.arcs) {
                add(of_place[a.place]);
            }
            for (const net::OutputTable& o : special.outputs) {
                add(of_place[o.place]);
            }
            for (const auto& assignment : special.assignments) {
                add(of_datum[assignment.first]);
            }
        }
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        watched_at_.items.insert(watched_at_.items.end(), row.begin(), row.end());
        watched_at_.starts.push_back(static_cast<std::uint32_t>(watched_at_.items.size()));
    }
}

double Meter::number_of(ProgramIndex program, std::uint32_t measure, ValueKind kind,
                        const Code::Reader& reader, Value* raw) {
    const Evaluated e = net_->tables().measure_code.evaluate(program, reader);
    if (e.fault != EvalFault::kNone) {
        if (!fault_) {
            const net::MeasureDraft& m = net_->declarations().measures[measure];
            fault_ = Diagnostic{
                .code = "evaluation-fault",
                .where = m.where,
                .element = "measure " + m.path,
                .message = std::string("what it measures cannot be computed: ") + name_of(e.fault),
                .remedy = "say what it is then: `#queue > 0 ? 1 / #queue : 0`"};
        }
        return 0;
    }
    if (raw != nullptr) {
        *raw = e.value;
    }
    switch (kind) {
        case ValueKind::kReal:
            return real_of_value(e.value);
        case ValueKind::kTime:
            return static_cast<double>(e.value) * kTick_s;
        default:
            return static_cast<double>(e.value);
    }
}

void Meter::watch(Watched& w, const run::Player& player) {
    const std::int64_t now = player.now().ticks;
    if (now > w.since) {
        w.sum += w.value * static_cast<double>(now - w.since);
        w.since = now;
    }
    w.value = number_of(w.program, w.number, w.measure->value.type().kind, PlayerReader(player));
    const bool counted = now >= from_;
    w.most = counted ? std::max(w.most, w.value) : w.value;
    w.least = counted ? std::min(w.least, w.value) : w.value;
}

void Meter::stayed(const Place& place, std::int64_t now, std::int64_t arrived) {
    if (now >= from_) {
        for (const std::uint32_t s : place.seen) {
            seen_[s].see(static_cast<double>(now - arrived) * kTick_s);
        }
    }
}

namespace {

constexpr auto kLater = [](const auto& a, const auto& b) {
    if (a.ready != b.ready) {
        return a.ready > b.ready;
    }
    return a.arrived != b.arrived ? a.arrived > b.arrived : a.serial > b.serial;
};

}  // namespace

// Ready tokens are taken in the order of their ready times, then of their coming; those that come
// with this firing cannot leave with it.
void Meter::leave_by_readiness(Place& place, std::uint32_t leave, std::int64_t now) {
    std::vector<Order>& heap = place.waiting;
    for (std::uint32_t i = 0; i < leave && !heap.empty(); ++i) {
        std::pop_heap(heap.begin(), heap.end(), kLater);
        stayed(place, now, heap.back().arrived);
        heap.pop_back();
    }
    for (const Order& token : place.fresh) {
        heap.push_back(token);
        std::push_heap(heap.begin(), heap.end(), kLater);
    }
    place.fresh.clear();
}

void Meter::arrives(SimTime at, net::PlaceIndex p, SimTime ready) {
    if (number_[p.value] != net::kNoIndex) {
        Place& place = places_[number_[p.value]];
        if (place.leaving == Leaving::kByReadiness) {
            place.fresh.push_back({ready.ticks, at.ticks, serials_++});
        }
    }
}

void Meter::leaves(SimTime at, net::PlaceIndex p, SimTime arrived) {
    if (number_[p.value] != net::kNoIndex) {
        const Place& place = places_[number_[p.value]];
        if (place.leaving == Leaving::kTold) {
            stayed(place, at.ticks, arrived.ticks);
        }
    }
}

void Meter::fires(SimTime at, net::TransitionIndex t, const Code::Reader& before) {
    for (const Turn& each : turns_inside_[t.value]) {
        Value raw = 0;
        const double x = number_of(each.program, each.measure, each.kind, before, &raw);
        if (each.role != Turn::kSee) {
            turn(each, at.ticks, raw);
        } else if (at.ticks >= from_ &&
                   (!counts(seen_[each.seen].measure->statistic) || raw != 0)) {
            seen_[each.seen].see(x);
        }
    }
}

void Meter::turn(const Turn& turn, std::int64_t now, Value key) {
    if (turn.role == Turn::kSee) {
        if (now >= from_) {
            seen_[turn.seen].see(1);
        }
        return;
    }
    Passage& passage = passages_[turn.seen];
    if (turn.role == Turn::kBegin) {
        (turn.keyed ? passage.begun_by_key[key] : passage.begun).push(now);
        return;
    }
    const auto found = turn.keyed ? passage.begun_by_key.find(key) : passage.begun_by_key.end();
    if (turn.keyed && found == passage.begun_by_key.end()) {
        return;  // it was under way from the start
    }
    Arrivals& begun = turn.keyed ? found->second : passage.begun;
    if (begun.size == 0) {
        return;
    }
    const std::int64_t began = begun.pop();
    if (turn.keyed && begun.size == 0) {
        passage.begun_by_key.erase(found);
    }
    if (now >= from_) {
        seen_[turn.seen].see(static_cast<double>(now - began) * kTick_s);
    }
}

// What goes on beside the net has kept how it went.
void Meter::follow(SimTime end, std::span<double> values) {
    const bool counts = end.ticks >= from_;
    for (const Followed& f : followed_) {
        run::CourseSum sum;
        Diagnostic why{.code = "nothing-beside",
                       .where = f.measure->where,
                       .message = "the run has no equations beside it that could be measured",
                       .remedy = "play the scene, not its net alone"};
        const bool found =
            counts && std::any_of(coupled_.begin(), coupled_.end(), [&](run::Coupled* c) {
                return c->measure(f.measure->course, {from_}, end, sum, why);
            });
        if (!found) {
            if (counts && !fault_) {
                why.element = "measure " + f.measure->path;
                fault_ = std::move(why);
            }
            values[f.metric] = kNothing;
            continue;
        }
        const double passed_s = SimTime{end.ticks}.seconds() - SimTime{from_}.seconds();
        switch (f.measure->statistic) {
            case Statistic::kMost:
                values[f.metric] = sum.most;
                break;
            case Statistic::kLeast:
                values[f.metric] = sum.least;
                break;
            case Statistic::kFinal:
                values[f.metric] = sum.last;
                break;
            case Statistic::kTotal:
                values[f.metric] = sum.integral;
                break;
            default:
                values[f.metric] = passed_s > 0 ? sum.integral / passed_s : kNothing;
        }
    }
}

double Meter::measured(std::uint32_t measure, std::uint32_t slot, double passed) {
    const net::MeasureDraft& m = net_->declarations().measures[measure];
    if (m.seen == net::Seen::kCourse) {
        return kNothing;  // see follow()
    }
    if (m.seen != net::Seen::kState) {
        return seen_[slot].result(passed * kTick_s);
    }
    const Watched& w = watched_[slot];
    switch (m.statistic) {
        case Statistic::kMost:
            return w.most;
        case Statistic::kLeast:
            return w.least;
        case Statistic::kFinal:
            return w.value;
        case Statistic::kTotal:
            return w.sum * kTick_s;
        default:
            return passed > 0 ? w.sum / passed : kNothing;
    }
}

}  // namespace puppetri::sim
