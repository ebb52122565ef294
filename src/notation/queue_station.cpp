// SPDX-License-Identifier: MIT
// Stations: customers wait in s_queue, are served in s; s_free holds the servers that are idle.
#include "make.h"
#include "queue_builder.h"

namespace puppetri::notation {

using lang::ArcKind;
using lang::Expr;
using lang::Op;

void QueueBuilder::build() {
    declare_customers();
    for (const lang::Data& d : model_.data) {
        body_.data.push_back(d);
    }
    if (model_.inside) {
        lang::Place& inside = place(model_.inside->text, model_.inside->span);
        for (const QueueNode& n : model_.nodes) {
            for (const lang::InitialTokens& group : n.customers) {
                if (n.kind != NodeKind::kPool) {
                    inside.tokens.push_back({group.count, {}, false, group.span});
                }
            }
        }
    }
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
        const QueueNode& n = model_.nodes[i];
        switch (n.kind) {
            case NodeKind::kSource:
                build_source(i);
                break;
            case NodeKind::kStation:
                build_station(i);
                break;
            case NodeKind::kDelay: {
                lang::Place& delay = customers_place(n.text(), n.span);
                delay.caption = n.caption;
                delay.takes = make_duration(n.serves);
                delay.does = n.does;
                give_customers(delay, n);
                Exit exit;
                exit.name = n.text();
                exit.span = n.span;
                exit.takes = {customer(ArcKind::kTake, n.text(), n.span)};
                exit.values = same(n.span);
                exit.priority = kArrives;
                const auto routes = model_.routes_of(i, RouteOn::kLeaving);
                if (!routes.empty()) {
                    emit(exit, routes);
                }
                break;
            }
            case NodeKind::kPool: {
                lang::Place& pool = customers_place(n.text(), n.span);
                pool.caption = n.caption;
                give_customers(pool, n);
                break;
            }
            case NodeKind::kSink:
                break;
        }
    }
    build_gates();
}

void QueueBuilder::build_station(std::size_t index) {
    const QueueNode& s = model_.nodes[index];
    if (s.room) {
        lang::Place& room = place(s.text() + "_room", s.span);
        Expr left = s.room;
        for (const lang::InitialTokens& group : s.customers) {
            left = make_binary(Op::kSubtract, std::move(left), group.count);
        }
        lang::InitialTokens tokens;
        tokens.count = std::move(left);
        tokens.span = s.span;
        room.tokens.push_back(std::move(tokens));
    }
    if (s.resumes()) {
        build_resumed(index);
    } else {
        build_plain(index);
    }
    build_jockeys(index);
    build_breaks(s);
}

// In which order they are served; what nothing tells apart has none.
void QueueBuilder::build_line(const QueueNode& s, lang::Place& queue) {
    const bool told_apart = typed() || s.patience || s.resumes();
    queue.by_arrival = static_cast<bool>(s.patience);
    switch (s.order) {
        case Order::kFifo:
            queue.discipline =
                queue.by_arrival ? lang::Discipline::kOldest : lang::Discipline::kDefault;
            break;
        case Order::kLifo:
            queue.discipline = told_apart ? lang::Discipline::kNewest : lang::Discipline::kDefault;
            break;
        case Order::kRandom:
            queue.discipline = told_apart ? lang::Discipline::kAny : lang::Discipline::kDefault;
            queue.by_arrival = false;
            break;
        case Order::kLeast:
            queue.discipline = lang::Discipline::kLeast;
            queue.discipline_key = s.key;
            break;
        case Order::kMost:
            queue.discipline = lang::Discipline::kMost;
            queue.discipline_key = s.key;
            break;
    }
}

void QueueBuilder::build_plain(std::size_t index) {
    const QueueNode& s = model_.nodes[index];
    const std::string queue_name = s.text() + "_queue", free = s.text() + "_free";
    lang::Place& queue = customers_place(queue_name, s.span);
    if (s.patience) {
        queue.takes = make_duration(s.patience);
    }
    build_line(s, queue);
    give_customers(queue, s);
    lang::Place& served = customers_place(s.text(), s.span);
    served.caption = s.caption;
    served.takes = make_duration(s.serves);
    served.does = s.does;
    give_servers(place(free, s.span), s);

    lang::Transition& start = transition(s.text() + "_start", s.span, kStarts);
    const ArcKind kind = s.patience ? ArcKind::kTakeNow : ArcKind::kTake;
    start.inputs = {customer(kind, queue_name, s.span, s.gathers),
                    take(ArcKind::kTake, free, s.span)};
    start.outputs = {give_customer(s.text(), same(s.span), s.span)};

    const std::vector<const Route*> routes = model_.routes_of(index, RouteOn::kLeaving);
    if (!routes.empty()) {
        Exit end = service_end(s);
        if (s.gathers && !one_way(routes)) {
            // Each of those who were served together goes his way.
            const std::string batch = s.text() + "_batch";
            customers_place(batch, s.span);
            Way apart;
            apart.gives.push_back(give_customer(batch, same(s.span), s.span, s.gathers));
            fire(end, s.text() + "_end", apart, {}, {}, {});
            Exit each;
            each.name = s.text();
            each.span = s.span;
            each.priority = kDecides;
            each.takes = {customer(ArcKind::kTake, batch, s.span)};
            each.values = same(s.span);
            emit(each, routes);
        } else {
            end.count = s.gathers;
            emit(end, routes);
        }
    }
    if (s.patience) {
        Exit leaves;
        leaves.name = s.text() + "_gives_up";
        leaves.span = s.span;
        leaves.takes = {customer(ArcKind::kTake, queue_name, s.span)};
        if (s.room) {
            leaves.gives = {take(ArcKind::kGive, s.text() + "_room", s.span)};
        }
        leaves.values = same(s.span);
        leaves.priority = kGivesUp;
        emit(leaves, model_.routes_of(index, RouteOn::kImpatient));
    }
}

// Whether all of a batch can go on together: one way, and nothing to decide on it.
bool QueueBuilder::one_way(const std::vector<const Route*>& routes) const {
    if (routes.size() != 1 || routes[0]->to.size() != 1 || routes[0]->when || routes[0]->takes ||
        routes[0]->does) {
        return false;
    }
    const QueueNode& to = model_.nodes[routes[0]->to[0]];
    return !to.balks && !to.balks_when && (!to.room || to.full == WhenFull::kBlocks);
}

Exit QueueBuilder::service_end(const QueueNode& s) const {
    Exit exit;
    exit.name = s.text();
    exit.span = s.span;
    exit.takes = {customer(ArcKind::kTake, s.text(), s.span)};
    exit.gives = {server(ArcKind::kGive, s.text() + "_free", s)};
    if (s.room) {
        exit.gives.push_back(take(ArcKind::kGive, s.text() + "_room", s.span, s.gathers));
    }
    exit.values = same(s.span);
    return exit;
}

// From one line to another: whose turn is next, as soon as the other is shorter by two.
void QueueBuilder::build_jockeys(std::size_t index) {
    const QueueNode& s = model_.nodes[index];
    for (const Route* r : model_.routes_of(index, RouteOn::kJockeying)) {
        for (const std::size_t to : r->to) {
            const QueueNode& target = model_.nodes[to];
            Exit exit;
            exit.name = s.text() + "_jockeys";
            exit.span = r->span;
            exit.takes = {customer(s.patience ? ArcKind::kTakeNow : ArcKind::kTake,
                                   s.text() + "_queue", r->span)};
            if (s.room) {
                exit.gives = {take(ArcKind::kGive, s.text() + "_room", r->span)};
            }
            exit.priority = kJockeys;
            const Values values = changed(same(r->span), r->sets);
            Way way;
            way.gives = {give_customer(way_in(target), values, r->span)};
            if (target.room) {
                way.takes = {take(ArcKind::kTake, target.text() + "_room", r->span)};
            }
            Expr guard = r->when;
            if (!guard) {
                guard = make_binary(Op::kGreater, number_at(s, r->span),
                                    make_binary(Op::kAdd, number_at(target, r->span),
                                                make_number(Rational{1}, r->span)));
            }
            fire(exit, exit.name + "_to_" + target.text(), way, guard, {}, r->sets);
        }
    }
}

// A server who is called goes as soon as he is free, before the next customer.
void QueueBuilder::build_breaks(const QueueNode& s) {
    int number = 0;
    for (const Break& pause : s.breaks) {
        const std::string n = ++number == 1 ? "" : "_" + std::to_string(number);
        const std::string event = s.text() + "_break" + n, called = s.text() + "_called" + n,
                          away = s.text() + "_away" + n;
        lang::Event calls;
        calls.name = make_name(event, pause.span);
        calls.is_public = true;
        calls.every = pause.every;
        calls.from = pause.first;
        calls.span = pause.span;
        body_.events.push_back(std::move(calls));
        place(called, pause.span);
        lang::Place& gone = place(away, pause.span);
        gone.takes = make_duration(pause.lasting);
        if (numbered(s)) {
            gone.of_type = make_path(s.text() + "_server", pause.span);
        }
        lang::Transition& call = transition(called + "_now", pause.span, kArrives);
        call.outputs = {take(ArcKind::kGive, called, pause.span)};
        call.events = {make_path(event, pause.span)};
        lang::Transition& begin = transition(event + "_begins", pause.span, kDraws);
        begin.inputs = {take(ArcKind::kTake, called, pause.span),
                        server(ArcKind::kTake, s.text() + "_free", s)};
        begin.outputs = {server(ArcKind::kGive, away, s)};
        lang::Transition& end = transition(event + "_ends", pause.span, kEnds);
        end.inputs = {server(ArcKind::kTake, away, s)};
        end.outputs = {server(ArcKind::kGive, s.text() + "_free", s)};
    }
}

}  // namespace puppetri::notation
