// SPDX-License-Identifier: MIT
// What a net says of durations, as far as abstractions have to know: which are not single numbers,
// and where the time that is left of a token goes. That time may be given on (`for left`): then it
// is still the same wait. Whoever computes with it asks what an abstraction does not know.
#include <algorithm>

#include "puppetri/base/distribution.h"
#include "puppetri/net/tables.h"
#include "timed_builder.h"

namespace puppetri::proof {

using namespace net;

namespace {

class TimeLeft {
 public:
    explicit TimeLeft(const Net& net) : n_(net.tables()) {
        attribute_.resize(n_.rich.size());
        for (std::uint32_t r = 0; r < n_.rich.size(); ++r) {
            attribute_[r].assign(n_.rich[r].attributes, false);
        }
        for (bool more = true; more;) {
            more = false;
            for (const Special& s : n_.specials) {
                const std::vector<bool> known = variables(s);
                for (const OutputTable& out : s.outputs) {
                    for (std::uint32_t k = 0; k < out.attributes.size(); ++k) {
                        if (out.rich != kNoIndex && !attribute_[out.rich][k] &&
                            mentions(out.attributes[k], known)) {
                            attribute_[out.rich][k] = true;
                            carried_ = more = true;
                        }
                    }
                }
            }
        }
    }
    bool carried() const { return carried_; }

    std::vector<std::string> misuses() const {
        std::vector<std::string> list;
        for (const Special& s : n_.specials) {
            const std::vector<bool> known = variables(s);
            const std::string who = "transition " + std::string(n_.transitions.path(s.transition));
            if (computes(s, known)) {
                list.push_back(who + " computes with the time left of a token");
            }
            if (s.delay != kNoIndex && s.searches && reads_variables(n_.delays[s.delay].duration) &&
                waits_unseen(s)) {
                list.push_back(who + " has a delay that depends on which waiting token it binds");
            }
        }
        for (const RichPlaceTable& r : n_.rich) {
            const std::uint32_t d = n_.place[r.place].duration;
            const std::vector<bool>& known = attribute_[n_.place_rich[r.place]];
            const auto reads = [&](ProgramIndex p) {
                return p.valid() && mentions(p, known, SlotKind::kAttribute);
            };
            if (reads(r.key) || (d != kNoIndex && reads_any(n_.durations[d], reads))) {
                list.push_back("place " + std::string(n_.places.path(r.place)) +
                               " computes with the time left of a token");
            }
        }
        return list;
    }

 private:
    bool mentions(ProgramIndex program, const std::vector<bool>& known,
                  SlotKind kind = SlotKind::kVariable) const {
        if (!program.valid()) {
            return false;
        }
        for (const Slot s : n_.code.slots(program)) {
            if (s.kind == static_cast<std::uint32_t>(kind) && known[s.index]) {
                return true;
            }
        }
        return false;
    }
    template <class Reads>
    static bool reads_any(const DurationTable& d, Reads&& reads) {
        return reads(d.a) || reads(d.b) ||
               std::any_of(d.parameters.begin(), d.parameters.end(),
                           [&](const DurationTable::Parameter& p) { return reads(p.program); });
    }
    bool reads_variables(const DurationTable& d) const {
        return reads_any(d, [&](ProgramIndex p) {
            if (!p.valid()) {
                return false;
            }
            const std::vector<Slot> slots = n_.code.slots(p);
            return std::any_of(slots.begin(), slots.end(), [](Slot s) {
                return s.kind == static_cast<std::uint32_t>(SlotKind::kVariable);
            });
        });
    }
    // Which variables of the transition may hold a time that is left.
    std::vector<bool> variables(const Special& s) const {
        std::vector<bool> known(s.variables, false);
        for (const ArcTable& arc : s.arcs) {
            if (arc.time_left != kNoIndex) {
                known[arc.time_left] = true;
            }
            for (const PatternTable& p : arc.pattern) {
                if (p.binds != kNoIndex && arc.rich != kNoIndex &&
                    attribute_[arc.rich][p.attribute]) {
                    known[p.binds] = true;
                }
            }
        }
        return known;
    }
    bool computes(const Special& s, const std::vector<bool>& known) const {
        const auto reads = [&](ProgramIndex p) { return mentions(p, known); };
        bool bad = reads(s.guard) || reads(s.odds);
        for (const auto& [datum, program] : s.assignments) {
            bad = bad || reads(program);
        }
        for (const OutputTable& out : s.outputs) {
            for (const ProgramIndex p : out.attributes) {
                bad = bad || (reads(p) && !n_.code.is_slot(p));
            }
            bad = bad || (reads(out.lasts) && !n_.code.is_slot(out.lasts));
        }
        if (s.delay != kNoIndex) {
            bad = bad || reads_any(n_.delays[s.delay].duration, reads);
        }
        std::vector<std::uint32_t> bound(s.variables, 0);
        for (const ArcTable& arc : s.arcs) {
            if (arc.time_left != kNoIndex) {
                ++bound[arc.time_left];
            }
            for (const PatternTable& p : arc.pattern) {
                const bool time = arc.rich != kNoIndex && attribute_[arc.rich][p.attribute];
                if (p.binds != kNoIndex) {
                    bound[p.binds] += arc.weight;
                } else {
                    bad = bad || time || reads(p.equals);
                }
            }
        }
        for (std::uint32_t v = 0; v < s.variables; ++v) {
            bad = bad || (known[v] && bound[v] > 1);  // compared
        }
        return bad;
    }
    // A test that may meet tokens that wait.
    static bool waits_unseen(const Special& s) {
        return std::any_of(s.arcs.begin(), s.arcs.end(), [](const ArcTable& a) {
            return a.kind == ArcKind::kTakeNow || a.kind == ArcKind::kReadNow;
        });
    }

    const NetTables& n_;
    std::vector<std::vector<bool>> attribute_;  // per place with records
    bool carried_ = false;
};

}  // namespace

std::vector<std::string> misused_time_left(const Net& net) { return TimeLeft(net).misuses(); }
bool carries_time_left(const Net& net) { return TimeLeft(net).carried(); }

std::vector<std::string> open_durations(const Net& net, const World& world) {
    const NetTables& n = net.tables();
    std::vector<std::string> list;
    const auto say = [&](const std::string& who, const DurationTable& d) {
        Value a = 0;
        Value b = 0;
        if (d.kind == DurationKind::kInterval) {
            const bool known = n.code.is_constant(d.a, a) && n.code.is_constant(d.b, b);
            if (!known || a != b) {
                list.push_back(who + (known
                                          ? " lasts " + time_in_words(a) + " .. " + time_in_words(b)
                                          : " lasts an interval"));
            }
        } else if (d.kind == DurationKind::kDistribution) {
            list.push_back(who + " lasts as a distribution says");
        }
    };
    for (std::uint32_t p = 0; p < n.places.size(); ++p) {
        if (n.place[p].duration == kNoIndex) {
            continue;
        }
        const DurationTable& d = n.durations[n.place[p].duration];
        const std::string who = "place " + std::string(n.places.path(p));
        say(who, d);
        if (d.kind == DurationKind::kAuto) {
            const TickRange range = movement_range(world, p);
            if (range.low != range.high) {
                list.push_back(who + ": its movement takes " + time_in_words(range.low) + " .. " +
                               time_in_words(range.high));
            }
        }
    }
    for (const DelayTable& d : n.delays) {
        say("transition " + std::string(n.transitions.path(d.transition)), d.duration);
    }
    return list;
}

namespace {

// Only what is surely 0 or more is taken for it.
bool may_be_negative(const DurationTable& d) {
    if (d.kind != DurationKind::kDistribution || d.distribution == DistributionKind::kExponential ||
        d.distribution == DistributionKind::kErlang || d.distribution == DistributionKind::kGamma) {
        return false;
    }
    return d.constants.size() != d.parameters.size() ||
           support(d.distribution, d.constants).low < 0;
}

}  // namespace

std::vector<std::string> assumed(const World& world) {
    const NetTables& n = world.net->tables();
    std::vector<std::string> list;
    for (std::uint32_t p = 0; p < n.places.size(); ++p) {
        if (n.place[p].duration != kNoIndex && may_be_negative(n.durations[n.place[p].duration])) {
            list.push_back("place " + std::string(n.places.path(p)) +
                           ": what is drawn for it is not below 0");
        }
    }
    for (const DelayTable& d : n.delays) {
        if (may_be_negative(d.duration)) {
            list.push_back("transition " + std::string(n.transitions.path(d.transition)) +
                           ": what is drawn for its delay is not below 0");
        }
    }
    for (std::uint32_t p = 0; p < n.places.size(); ++p) {
        if (n.place[p].duration != kNoIndex &&
            n.durations[n.place[p].duration].kind == DurationKind::kAuto) {
            const TickRange range = movement_range(world, p);
            if (range.high < kWaiting) {
                list.push_back("place " + std::string(n.places.path(p)) + ": its movement takes " +
                               time_in_words(range.low) +
                               (range.low == range.high ? "" : " .. " + time_in_words(range.high)) +
                               " (checked at each preparation)");
            }
        }
    }
    for (std::uint32_t e = 0; e < n.events.size() && world.outside_events == 0; ++e) {
        if (n.declarations.events[e].outside && !n.event_listeners.row(e).empty()) {
            list.emplace_back("no event comes from outside");
            break;
        }
    }
    if (world.outside_events != 0 && world.outside_events != GraphRequest::kAnyNumber &&
        !world.outer_events.empty()) {
        list.push_back("at most " + std::to_string(world.outside_events) +
                       " events come from outside");
    }
    for (const std::uint32_t e : world.movement_events) {
        list.push_back("event " + std::string(n.events.path(e)) + " may occur at any time");
    }
    for (const std::uint32_t d : world.free_sensors) {
        list.push_back("sensor " + std::string(n.data.path(d)) + " may change at any time");
    }
    for (std::uint32_t p = 0; p < n.places.size(); ++p) {
        if (world.net->action(PlaceIndex{p}).valid()) {
            list.emplace_back("every movement can be performed when it begins");
            break;
        }
    }
    // A run that goes on for ever ends with the range of its clock (net/engine.h).
    if (!world.net->paced()) {
        list.emplace_back("no run is longer than 414 years, where the clock ends");
    }
    return list;
}

}  // namespace puppetri::proof
