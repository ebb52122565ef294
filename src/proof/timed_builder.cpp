// SPDX-License-Identifier: MIT
#include "timed_builder.h"

#include <algorithm>
#include <string_view>
#include <tuple>

#include "puppetri/base/varint.h"
#include "puppetri/net/tables.h"

namespace puppetri::proof {

using namespace net;

State TimedGraph::States::decode(std::uint32_t state, std::uint32_t* outside,
                                 std::size_t* length) const {
    if (plain) {
        State s;
        for (const std::uint32_t count : plain->marking(state)) {
            s.counts.push_back({count, count});
        }
        return s;
    }
    const std::span<const std::uint8_t> bytes = store[state];
    std::size_t at = 0;
    State s = codec.decode(bytes, &at);
    std::uint32_t events = 0;
    if (world.outside_events != 0 && world.outside_events != GraphRequest::kAnyNumber) {
        events = static_cast<std::uint32_t>(get_varint(bytes, at));
    }
    if (outside != nullptr) {
        *outside = events;
    }
    if (length != nullptr) {
        *length = at;
    }
    return s;
}

void TimedGraph::States::encode(const Driver& driver, std::vector<std::uint8_t>& out,
                                const std::unordered_map<std::int64_t, std::uint32_t>* variables) {
    codec.encode(driver.engine.state(), out, variables);
    if (world.outside_events != 0 && world.outside_events != GraphRequest::kAnyNumber) {
        put_varint(out, driver.outside);
    }
}

namespace {

// Named after a place with a movement: "a.throw.release". That movement may raise it, whoever else
// does.
bool of_movement(const Net& net, std::uint32_t event) {
    const std::string_view path = net.event({event}).path;
    const std::size_t dot = path.rfind('.');
    const PlaceIndex place =
        dot == std::string_view::npos ? PlaceIndex{} : net.find_place(path.substr(0, dot));
    return place.valid() && net.action(place).valid();
}

}  // namespace

World world_of(const GraphRequest& request, const AtomReader& atoms) {
    const NetTables& n = request.net.tables();
    World world;
    world.net = &request.net;
    world.actions.assign(request.actions.begin(), request.actions.end());
    world.outside_events = request.outside_events;
    world.beat = request.beat;
    std::vector<bool> raised(n.events.size(), false);
    for (const Special& s : n.specials) {
        for (const std::uint32_t e : s.raises) {
            raised[e] = true;
        }
    }
    for (const ScheduledEvent& s : n.declarations.schedule) {
        raised[s.event.value] = true;
    }
    std::vector<bool> set(n.data.size(), false);
    for (std::uint32_t e = 0; e < n.events.size(); ++e) {
        const EventDraft& event = n.declarations.events[e];
        if (event.sets.valid()) {
            set[event.sets.value] = true;
        }
        const bool matters = !n.event_listeners.row(e).empty() || event.sets.valid() ||
                             event.makes_ready.valid() || atoms.mentions_event(e);
        if (matters && event.outside && request.outside_events != 0) {
            world.outer_events.push_back(e);
        } else if (matters && !event.outside && (!raised[e] || of_movement(request.net, e))) {
            world.movement_events.push_back(e);
        }
    }
    for (std::uint32_t d = 0; d < n.data.size(); ++d) {
        if (n.declarations.data[d].sensor && !set[d]) {
            world.free_sensors.push_back(d);
        }
    }
    return world;
}

TimedBuilder::TimedBuilder(const GraphRequest& request, ClockForm form, const char* method)
    : request_(request),
      atoms_(request.net, request.atoms, graph_.why_not),
      meter_(request.budget, method) {
    graph_.states = std::make_unique<TimedGraph::States>(world_of(request, atoms_), form);
    driver_ = std::make_unique<Driver>(graph_.states->world, form);
    const NetTables& n = request.net.tables();
    Waits& waits = graph_.waits;
    waits.rare.assign(n.events.size(), 1);
    for (const Special& s : n.specials) {
        for (const std::uint32_t e : s.raises) {
            waits.rare[e] = 0;
        }
    }
    waits.by_outside = waits.rare;
    for (const ScheduledEvent& s : n.declarations.schedule) {
        waits.by_outside[s.event.value] = 0;
    }
    for (std::uint32_t e = 0; e < n.events.size(); ++e) {
        // A crossing may never come.
        const EventDraft& event = n.declarations.events[e];
        if (!event.crossing && (!event.outside || of_movement(request.net, e))) {
            waits.by_outside[e] = 0;
        }
    }
}

Ended TimedBuilder::look() {
    const Graph& g = graph_.graph;
    const std::uint32_t states = graph_.states->store.size();
    const std::uint64_t held =
        graph_.bytes() + g.flags.capacity() + 24 * std::uint64_t{g.edges.items.capacity()} +
        8 * (std::uint64_t{g.atoms.may.capacity()} + g.atoms.must.capacity() +
             graph_.waits.waiting.capacity() + graph_.waits.stirred.capacity()) +
        row_.size() * (sizeof(Row) + 8 * std::uint64_t{wait_words()});
    return meter_.look(states, g.edges.items.size() + row_.size(), states - g.edges.size(), held);
}

// The state in which the driver stands, whose string is in the buffer.
std::uint32_t TimedBuilder::add(std::uint32_t flags) {
    const auto [number, fresh] = graph_.states->store.insert(buffer_);
    if (fresh) {
        Graph& g = graph_.graph;
        atoms_.read(driver_->engine, g.atoms.may, g.atoms.must);
        g.flags.push_back(static_cast<std::uint8_t>(
            flags | (driver_->engine.in_final_marking() ? unsigned{Graph::kFinal} : 0u)));
        graph_.waits.waiting.resize(graph_.waits.waiting.size() + wait_words());
        read_waits(*driver_,
                   graph_.waits.waiting.data() + graph_.waits.waiting.size() - wait_words());
    }
    return number;
}

void TimedBuilder::note_stop(std::uint32_t state, bool fired) {
    graph_.graph.flags[state] |= Graph::kCut;
    const std::uint32_t label = fired ? driver_->engine.state().last : Edge::kPass;
    for (const Stop& s : graph_.stops) {
        if (s.state == state && s.label == label && s.fault.code == driver_->engine.fault().code) {
            return;
        }
    }
    graph_.stops.push_back({state, label, driver_->engine.fault()});
}

// All beginnings: one state, or one before them all.
void TimedBuilder::begin() {
    Graph& g = graph_.graph;
    std::vector<std::vector<std::uint8_t>> starts;
    Driver& d = *driver_;
    const auto each_start = [&](auto&& visit) {
        d.chooser.clear();
        do {
            d.chooser.rewind();
            d.start();
            buffer_.clear();
            if (encode(d, {}, buffer_)) {
                visit();
            }
            ended_ = look();
        } while (d.chooser.next() && ended_ == Ended::kDone);
    };
    each_start([&] {
        if (std::find(starts.begin(), starts.end(), buffer_) == starts.end()) {
            starts.push_back(buffer_);
        }
    });
    g.atoms.atoms = atoms_.count();
    const bool several = starts.size() > 1;
    graph_.states->several_starts = several;
    if (several) {
        buffer_ = starts.front();
        buffer_.push_back(0xFF);
        graph_.states->store.insert(buffer_);
        g.flags.push_back(0);
        // May: what may hold in one of them; must: what must in all.
        g.atoms.may.assign(atoms_.words(), 0);
        g.atoms.must.assign(atoms_.words(), ~std::uint64_t{0});
        graph_.waits.waiting.resize(wait_words());
    }
    each_start([&] {
        const std::uint32_t s = add(ends() ? unsigned{Graph::kCut} : 0u);
        if (d.engine.faulted()) {
            note_stop(s, false);
        }
        for (std::uint32_t w = 0; several && w < atoms_.words(); ++w) {
            g.atoms.may[w] |= g.atoms.may[std::size_t{s} * atoms_.words() + w];
            g.atoms.must[w] &= g.atoms.must[std::size_t{s} * atoms_.words() + w];
        }
        if (several) {
            Row r;
            r.edge = {Edge::kPass, s};
            r.stirs.resize(wait_words());
            row_.push_back(std::move(r));
        }
    });
    if (several) {
        close_row();
    }
}

void TimedBuilder::expand(std::uint32_t state) {
    Graph& g = graph_.graph;
    if ((g.flags[state] & Graph::kCut) != 0) {  // stopped before it began
        close_row();
        return;
    }
    Driver& d = *driver_;
    std::uint32_t outside = 0;
    const State base = graph_.states->decode(state, &outside);
    enter(state);
    d.chooser.clear();
    bool idle = false;
    bool settled = false;
    do {
        d.chooser.rewind();
        d.restore(base, outside);
        const std::uint64_t firings = d.engine.state().firings;
        Driver::Step step;
        const Driver::Did did = d.step(step);
        settled = settled || d.settled();
        idle = idle || d.idle();
        if (did == Driver::Did::kFault) {
            note_stop(state, d.engine.state().firings != firings);
        } else if (did == Driver::Did::kStep) {
            buffer_.clear();
            if (encode(d, step, buffer_)) {
                Row r;
                r.edge.label = step.label;
                r.edge.target = add(ends() ? unsigned{Graph::kCut} : 0u);
                std::tie(r.low, r.high) = ticks(step);
                r.coincidental = coincidental(d);
                r.weight = weighs_ ? weight(d, step) : 0;
                r.stirs.resize(wait_words());
                if (wait_words() != 0) {
                    stirred(d, step, r.stirs.data());
                }
                row_.push_back(std::move(r));
            }
        }
        ended_ = look();
        if (ended_ != Ended::kDone) {
            g.flags[state] |= Graph::kCut;
            break;
        }
    } while (d.chooser.next());
    const bool paced = request_.net.paced() && graph_.states->form != ClockForm::kExact;
    if (settled || (paced && state != 0)) {
        g.flags[state] |= Graph::kSettled;
    }
    if (idle && !row_.empty()) {
        g.flags[state] |= Graph::kOptional;
    }
    close_row();
}

void TimedBuilder::close_row() {
    Graph& g = graph_.graph;
    std::sort(row_.begin(), row_.end(), [](const Row& a, const Row& b) {
        return std::tie(a.edge.label, a.edge.target, a.low, a.high) <
               std::tie(b.edge.label, b.edge.target, b.low, b.high);
    });
    for (std::size_t i = 0; i < row_.size(); ++i) {
        const Row& r = row_[i];
        const bool again = i > 0 && row_[i - 1].edge.label == r.edge.label &&
                           row_[i - 1].edge.target == r.edge.target && row_[i - 1].low == r.low &&
                           row_[i - 1].high == r.high;
        if (!again) {
            g.edges.items.push_back(r.edge);
            if (weighs_) {
                graph_.weights.push_back(r.weight);
            }
            g.low_ticks.push_back(r.low);
            g.high_ticks.push_back(r.high);
            graph_.coincidental.push_back(r.coincidental ? 1 : 0);
            graph_.waits.stirred.insert(graph_.waits.stirred.end(), r.stirs.begin(), r.stirs.end());
            continue;
        }
        graph_.coincidental.back() &= r.coincidental ? 1 : 0;
        if (weighs_) {
            graph_.weights.back() += r.weight;
        }
        std::uint64_t* last =
            graph_.waits.stirred.data() + graph_.waits.stirred.size() - wait_words();
        for (std::uint32_t w = 0; w < wait_words(); ++w) {
            last[w] |= r.stirs[w];
        }
    }
    g.edges.starts.push_back(static_cast<std::uint32_t>(g.edges.items.size()));
    row_.clear();
}

TimedGraph TimedBuilder::build() {
    if (!graph_.available()) {
        return std::move(graph_);
    }
    Graph& g = graph_.graph;
    begin();
    while (g.edges.size() < graph_.states->store.size() && ended_ == Ended::kDone) {
        expand(g.edges.size());
    }
    for (std::uint32_t s = g.edges.size(); s < graph_.states->store.size(); ++s) {
        g.flags[s] |= Graph::kCut;
        close_row();
    }
    g.ended = ended_;
    // The engine counts the firings of an instant from the start of each step that is tried here.
    const std::uint32_t most = net::EngineOptions{}.firings_per_instant;
    if (g.size() > most) {
        graph_.assumptions.push_back("no instant has more than " + std::to_string(most) +
                                     " firings");
    }
    return std::move(graph_);
}

}  // namespace puppetri::proof
