// SPDX-License-Identifier: MIT
// Small nets for tests, written as arcs: make.t("t1", {"P1"}, {"P2", "2*P3"}).
#pragma once
#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "puppetri/net/chooser.h"
#include "puppetri/net/engine.h"
#include "puppetri/net/net.h"

namespace puppetri::net {

inline constexpr std::int64_t kSecond = kTicksPerSecond;
inline SimTime seconds(double s) {
    return {static_cast<std::int64_t>(std::nearbyint(s * kTicksPerSecond))};
}

inline Expr expr(ExprOp op, Expr a, Expr b) {
    return Expr::binary(op, std::move(a), std::move(b)).value();
}

inline DurationDraft lasts(double s) { return DurationDraft::constant(seconds(s)); }
inline DurationDraft drawn(DistributionKind kind, std::initializer_list<Expr> parameters) {
    DurationDraft d;
    d.kind = DurationKind::kDistribution;
    d.distribution = kind;
    d.parameters = parameters;
    return d;
}
inline DurationDraft exponential(double mean_s) {
    return drawn(DistributionKind::kExponential, {Expr::time(seconds(mean_s))});
}
inline DurationDraft between(std::int64_t low, std::int64_t high) {
    DurationDraft d;
    d.kind = DurationKind::kInterval;
    d.a = Expr::time({low});
    d.b = Expr::time({high});
    return d;
}
inline DurationDraft of_kind(DurationKind kind) {
    DurationDraft d;
    d.kind = kind;
    return d;
}
inline DurationDraft computed(Expr e) {
    DurationDraft d;
    d.kind = DurationKind::kExpression;
    d.a = std::move(e);
    return d;
}

class Maker {
 public:
    // References to places and transitions stay good: tests make few.
    Maker() {
        draft.places.reserve(10000);
        draft.transitions.reserve(10000);
    }
    NetDraft draft;

    // A place, made on first mention.
    PlaceIndex p(const std::string& name) {
        const auto it = places_.find(name);
        if (it != places_.end()) {
            return it->second;
        }
        const PlaceIndex index{static_cast<std::uint32_t>(draft.places.size())};
        PlaceDraft place;
        place.path = name;
        draft.places.push_back(place);
        places_[name] = index;
        return index;
    }
    PlaceDraft& place(const std::string& name) { return draft.places[p(name).value]; }
    PlaceDraft& place(const std::string& name, std::uint32_t tokens) {
        PlaceDraft& d = place(name);
        if (tokens != 0) {
            InitialToken initial;
            initial.count = tokens;
            d.tokens.push_back(initial);
        }
        return d;
    }
    PlaceDraft& place(const std::string& name, std::uint32_t tokens, DurationDraft duration) {
        PlaceDraft& d = place(name, tokens);
        d.duration = std::move(duration);
        return d;
    }

    // "P", "3*P", "now P", "all P", "allnow P", "with P", "while P", "unless 2*P", "unless ready
    // P".
    ArcDraft arc(std::string text) {
        static const std::pair<const char*, ArcKind> kWords[] = {
            {"unless ready ", ArcKind::kUnlessReady},
            {"unless ", ArcKind::kUnless},
            {"now ", ArcKind::kTakeNow},
            {"allnow ", ArcKind::kTakeAllNow},
            {"all ", ArcKind::kTakeAll},
            {"with ", ArcKind::kRead},
            {"while ", ArcKind::kReadNow}};
        ArcDraft a;
        for (const auto& [word, kind] : kWords) {
            if (text.rfind(word, 0) == 0) {
                a.kind = kind;
                text = text.substr(std::string(word).size());
                break;
            }
        }
        const std::size_t star = text.find('*');
        if (star != std::string::npos) {
            a.weight = std::stol(text.substr(0, star));
            text = text.substr(star + 1);
        }
        a.place = p(text);
        return a;
    }
    OutputDraft output(const std::string& text) {
        const ArcDraft a = arc(text);
        OutputDraft o;
        o.place = a.place;
        o.weight = a.weight;
        return o;
    }

    TransitionDraft& t(const std::string& name, const std::vector<std::string>& inputs,
                       const std::vector<std::string>& outputs) {
        TransitionDraft d;
        d.path = name;
        for (const std::string& i : inputs) {
            d.inputs.push_back(arc(i));
        }
        for (const std::string& o : outputs) {
            d.outputs.push_back(output(o));
        }
        draft.transitions.push_back(std::move(d));
        return draft.transitions.back();
    }
    TransitionIndex index(const std::string& name) const {
        for (std::uint32_t i = 0; i < draft.transitions.size(); ++i) {
            if (draft.transitions[i].path == name) {
                return {i};
            }
        }
        return {};
    }

    DatumIndex datum(const std::string& name, ValueType type, Value initial) {
        DatumDraft d;
        d.path = name;
        d.type = type;
        d.initial = initial;
        draft.data.push_back(d);
        return {static_cast<std::uint32_t>(draft.data.size()) - 1};
    }
    DatumIndex integer(const std::string& name, Value initial, Value low = -1000,
                       Value high = 1000) {
        const DatumIndex d = datum(name, {ValueKind::kInt, 0}, initial);
        draft.data.back().low = low;
        draft.data.back().high = high;
        return d;
    }
    Expr read(DatumIndex d) const {
        return Expr::slot(slot(SlotKind::kDatum, d.value), draft.data[d.value].type);
    }
    Expr count(const std::string& name) {
        return Expr::slot(slot(SlotKind::kCount, p(name).value), {ValueKind::kInt, 0});
    }
    static Expr variable(const TransitionDraft& t, std::uint32_t v) {
        return Expr::slot(slot(SlotKind::kVariable, v), t.variables[v].type);
    }

    EventIndex event(const std::string& name) {
        EventDraft e;
        e.path = name;
        draft.events.push_back(e);
        return {static_cast<std::uint32_t>(draft.events.size()) - 1};
    }
    void at(double s, EventIndex e) {
        ScheduledEvent scheduled;
        scheduled.at = seconds(s);
        scheduled.event = e;
        draft.schedule.push_back(scheduled);
    }

    Net net() const {
        Checked<Net> compiled = compile(draft);
        if (!compiled) {
            for (const Diagnostic& d : compiled.error()) {
                FAIL_CHECK(d.code << " " << d.element << ": " << d.message);
            }
        }
        REQUIRE(compiled.has_value());
        return std::move(compiled).value();
    }
    std::vector<std::string> codes() const {
        Checked<Net> compiled = compile(draft);
        std::vector<std::string> list;
        if (!compiled) {
            for (const Diagnostic& d : compiled.error()) {
                list.push_back(d.code);
            }
        }
        return list;
    }

 private:
    std::map<std::string, PlaceIndex> places_;
};

// The firings of a run as text: "0:t1 0.5:t2 2:t3" (seconds).
class Log final : public EngineListener {
 public:
    explicit Log(const Net& n) : net_(&n) {}
    void fired(SimTime at, TransitionIndex t) override { add(at, net_->transition(t).path); }
    void occurs(SimTime, EventIndex) override {}
    void lost(SimTime at, EventIndex e) override {
        add(at, "lost-" + std::string(net_->event(e).path));
    }
    std::string text;

 private:
    void add(SimTime at, std::string_view what) {
        std::string s = std::to_string(at.seconds());
        s.erase(s.find_last_not_of('0') + 1);
        if (s.back() == '.') {
            s.pop_back();
        }
        text += (text.empty() ? "" : " ") + s + ":" + std::string(what);
    }
    const Net* net_;
};

// One run, its engine and its log together.
struct Run {
    explicit Run(Net n, Chooser* chooser = nullptr, EngineOptions options = {})
        : net(std::move(n)),
          log(net),
          engine(net, chooser != nullptr ? *chooser : random, with(options)) {
        engine.start();
    }
    Engine::Outcome until(double s, std::uint64_t firings = ~std::uint64_t{0}) {
        return engine.run(seconds(s).ticks, firings);
    }
    std::uint32_t tokens(const std::string& place) const {
        return engine.state().counts[net.find_place(place).value].total;
    }
    std::uint32_t ready(const std::string& place) const {
        return engine.state().counts[net.find_place(place).value].ready;
    }
    Value datum(const std::string& name) const {
        return engine.state().data[net.find_datum(name).value];
    }

    Net net;
    Log log;
    RandomChooser random;
    Engine engine;

 private:
    EngineOptions with(EngineOptions options) {
        options.listener = &log;
        return options;
    }
};

}  // namespace puppetri::net
