// SPDX-License-Identifier: MIT
// Sources: a clock is a token that waits from one arrival to the next.
#include "make.h"
#include "queue_builder.h"

namespace puppetri::notation {

using lang::ArcKind;
using lang::Expr;
using lang::ExprKind;

void QueueBuilder::build_source(std::size_t index) {
    const QueueNode& source = model_.nodes[index];
    if (!source.periods.empty()) {
        build_periods(source);
        for (std::size_t i = 0; i < source.periods.size(); ++i) {
            if (source.periods[i].every) {
                arrivals(index, source.text() + "_" + std::to_string(i + 1));
            }
        }
    } else {
        lang::Place& clock = place(source.text(), source.span);
        clock.caption = source.caption;
        clock.takes = make_duration(source.every);
        if (source.first) {
            lang::Place& first = place(source.text() + "_first", source.span);
            first.takes = make_duration(source.first);
            give_token(first);
            arrivals(index, source.text() + "_first");
        } else {
            give_token(clock);
        }
        arrivals(index, source.text());
    }
    if (source.closes) {
        lang::Event closes;
        closes.name = make_name(source.text() + "_closes", source.span);
        closes.at = {source.closes};
        closes.is_public = true;
        closes.span = source.span;
        std::vector<std::string> clocks;
        for (std::size_t i = 0; i < source.periods.size(); ++i) {
            clocks.push_back(source.text() + "_" + std::to_string(i + 1));
        }
        if (clocks.empty()) {
            clocks.push_back(source.text());
            if (source.first) {
                clocks.push_back(source.text() + "_first");
            }
        }
        for (const std::string& clock : clocks) {
            lang::Transition& t = transition(source.text() + "_closing", source.span, kArrives);
            t.inputs.push_back(take(ArcKind::kTakeNow, clock, source.span));
            t.events.push_back(make_path(closes.name.text, source.span));
        }
        body_.events.push_back(std::move(closes));
    }
}

// One place for each period; events move the clock's token from one to the next.
void QueueBuilder::build_periods(const QueueNode& source) {
    const auto name = [&](std::size_t i) { return source.text() + "_" + std::to_string(i); };
    const std::size_t n = source.periods.size();
    const Expr& begins = source.periods[0].from;
    const bool at_once = begins.kind == ExprKind::kNumber && begins.number.numerator == 0;
    // Who holds the token at the beginning: the first period, the last one of the day before, or
    // nobody who lets customers come.
    const std::size_t holder = at_once ? 1 : source.repeats ? n : 0;
    if (holder == 0) {
        give_token(place(name(0), source.span));
    }
    for (std::size_t i = 1; i <= n; ++i) {
        const Period& period = source.periods[i - 1];
        lang::Place& clock = place(name(i), period.span);
        if (period.every) {
            clock.takes = make_duration(period.every);
        }
        if (i == holder) {
            give_token(clock);
        }
        if (i == 1 && at_once && !source.repeats) {
            continue;  // nothing brings it again
        }
        lang::Event event;
        event.name = make_name(source.text() + "_from_" + std::to_string(i), period.span);
        event.is_public = true;
        event.span = period.span;
        if (source.repeats) {
            event.every = source.repeats;
            event.from = i == 1 && at_once ? source.repeats : period.from;
        } else {
            event.at = {period.from};
        }
        if (const std::size_t before = i > 1 ? i - 1 : source.repeats ? n : 0; before != i) {
            lang::Transition& t =
                transition(source.text() + "_begins_" + std::to_string(i), period.span, kArrives);
            t.inputs.push_back(take(ArcKind::kTakeNow, name(before), period.span));
            t.outputs.push_back(take(ArcKind::kGive, name(i), period.span));
            t.events.push_back(make_path(event.name.text, period.span));
        }
        body_.events.push_back(std::move(event));
    }
}

// What a tick of this clock brings.
void QueueBuilder::arrivals(std::size_t index, const std::string& clock) {
    const QueueNode& source = model_.nodes[index];
    const std::vector<const Route*> routes = model_.routes_of(index, RouteOn::kLeaving);
    if (routes.empty()) {
        return;  // told by check_queue
    }
    Exit exit;
    exit.name = source.text();
    exit.span = source.span;
    exit.outside = true;
    exit.priority = kArrives;
    exit.takes = {take(ArcKind::kTake, clock, source.span)};
    const std::string next = clock == source.text() + "_first" ? source.text() : clock;
    exit.gives = {take(ArcKind::kGive, next, source.span)};
    if (!source.from.empty()) {
        const std::string pool = lang::to_text(source.from);
        lang::Transition& nobody = transition(source.text() + "_nobody", source.span, kArrives);
        nobody.inputs = exit.takes;
        nobody.outputs = exit.gives;
        nobody.tests.push_back(take(ArcKind::kUnless, pool, source.span));
        exit.takes.push_back(customer(ArcKind::kTake, pool, source.span));
        exit.values = same(source.span);
    } else {
        exit.values = initial(source, routes);
    }
    if (!source.batch) {
        emit(exit, routes);
        return;
    }
    const bool drawn =
        source.batch.kind == ExprKind::kCall && lang::to_text(source.batch.path) == "discrete";
    if (!drawn && one_way(routes)) {
        exit.count = source.batch;
        emit(exit, routes);
        return;
    }
    // Each customer of the batch decides for himself.
    const std::string batch = source.text() + "_batch";
    bool known = false;
    for (const lang::Place& p : body_.places) {
        known = known || p.name.text == batch;
    }
    const auto bring = [&](const Expr& count, const Expr& odds, const std::string& name) {
        lang::Transition& t = transition(name, source.span, kArrives);
        t.inputs = exit.takes;
        t.outputs = exit.gives;
        t.outputs.push_back(give_customer(batch, exit.values, source.span, count));
        t.odds = odds;
    };
    if (!drawn) {
        bring(source.batch, {}, source.text() + "_brings");
    } else {
        for (const lang::Argument& a : source.batch.args) {
            if (a.value.kind != ExprKind::kTuple || a.value.args.size() != 2) {
                teller_.error("syntax", a.value.span, "a number and its weight are wanted",
                              "write batch discrete((1, 0.5), (3, 0.5))");
                continue;
            }
            const Expr& count = a.value.args[0].value;
            bring(count, a.value.args[1].value, source.text() + "_brings_" + lang::to_text(count));
        }
    }
    if (known) {
        return;
    }
    customers_place(batch, source.span);
    Exit each;
    each.name = source.text();
    each.span = source.span;
    each.outside = true;
    each.priority = kDecides;
    each.takes = {customer(ArcKind::kTake, batch, source.span)};
    each.values = same(source.span);
    emit(each, routes);
}

}  // namespace puppetri::notation
