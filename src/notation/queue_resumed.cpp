// SPDX-License-Identifier: MIT
// Stations whose services are interrupted and go on where they were: by customers that go before,
// and by servers that fail. How long a service takes is drawn when the customer comes (the token
// waits in s_in just long enough to be asked how long it would); what is left of it travels with
// the customer.
#include "make.h"
#include "queue_builder.h"

namespace puppetri::notation {

using lang::Arc;
using lang::ArcKind;
using lang::Expr;
using lang::Op;

namespace {

constexpr const char* kRest = "rest_of_service";
constexpr const char* kCut = "interrupted";
constexpr const char* kServer = "server_number";
constexpr const char* kOther = " of the one in service";

lang::Binding equal(const char* name, Expr value, lang::Span span) {
    return make_assignment(make_path(name, span), std::move(value));
}

}  // namespace

std::string QueueBuilder::type_of_resumed(const QueueNode& s) const {
    return s.text() + "_customer";
}

// Servers that fail one by one must be told apart, unless there is one.
bool QueueBuilder::numbered(const QueueNode& s) const {
    return s.fails && s.servers && s.servers.kind == lang::ExprKind::kNumber &&
           s.servers.number != Rational{1};
}

void QueueBuilder::give_servers(lang::Place& place, const QueueNode& s) {
    const Expr count = s.servers ? s.servers : make_number(Rational{1}, s.span);
    if (!numbered(s)) {
        place.tokens.push_back({count, {}, false, s.span});
        return;
    }
    place.of_type = make_path(s.text() + "_server", s.span);
    for (std::int64_t i = 1; i <= count.number.numerator; ++i) {
        place.tokens.push_back({make_number(Rational{1}, s.span),
                                {equal(kServer, make_number(Rational{i}, s.span), s.span)},
                                false,
                                s.span});
    }
}

Arc QueueBuilder::server(ArcKind kind, const std::string& place, const QueueNode& s) const {
    Arc arc = take(kind, place, s.span);
    if (numbered(s)) {
        arc.pattern = {equal(kServer, make_reference(kServer, s.span), s.span)};
    }
    return arc;
}

void QueueBuilder::build_resumed(std::size_t index) {
    const QueueNode& s = model_.nodes[index];
    const lang::Span span = s.span;
    const std::string in = s.text() + "_in", queue_name = s.text() + "_queue",
                      free = s.text() + "_free";
    const auto parameter = [&](const char* name, Expr type) {
        lang::Parameter p;
        p.name = make_name(name, span);
        p.type = std::move(type);
        return p;
    };
    const auto range = [&](std::int64_t to) {
        Expr e;
        e.kind = lang::ExprKind::kRange;
        e.span = span;
        e.args.push_back({{}, make_number(Rational{0}, span)});
        e.args.push_back({{}, make_number(Rational{to}, span)});
        return e;
    };
    lang::TokenType waiting, busy;
    waiting.name = make_name(type_of_resumed(s), span);
    busy.name = make_name(s.text() + "_service", span);
    waiting.span = busy.span = span;
    for (const CustomerAttribute& a : model_.attributes) {
        waiting.attributes.push_back({.name = a.name, .type = a.type, .span = span});
    }
    busy.attributes = waiting.attributes;
    waiting.attributes.push_back(parameter(kRest, make_reference("time", span)));
    waiting.attributes.push_back(parameter(kCut, range(1)));
    if (numbered(s)) {
        const Expr number = range(s.servers.number.numerator);
        busy.attributes.push_back(parameter(kServer, number));
        lang::TokenType servers;
        servers.name = make_name(s.text() + "_server", span);
        servers.attributes.push_back(parameter(kServer, number));
        servers.span = span;
        body_.token_types.push_back(std::move(servers));
    }
    const bool plain_service = busy.attributes.empty();
    if (!plain_service) {
        body_.token_types.push_back(busy);
    }
    body_.token_types.push_back(waiting);

    lang::Place& drawn = customers_place(in, span);
    drawn.takes = make_duration(s.serves);
    give_customers(drawn, s);
    lang::Place& queue = place(queue_name, span);
    queue.of_type = make_path(waiting.name.text, span);
    build_line(s, queue);
    const Expr cut = make_reference(kCut, span);
    if (s.order == Order::kFifo || s.order == Order::kRandom) {
        queue.discipline = lang::Discipline::kMost;  // who was interrupted goes on first
        queue.discipline_key = cut;
    } else if (s.order != Order::kLifo) {
        // Whole numbers (check_queue): among equal ones, who was interrupted goes on first.
        const Expr twice = make_binary(Op::kMultiply, make_number(Rational{2}, span), s.key);
        queue.discipline_key =
            make_binary(s.order == Order::kMost ? Op::kAdd : Op::kSubtract, twice, cut);
    }
    lang::Place& served = place(s.text(), span);
    if (!plain_service) {
        served.of_type = make_path(busy.name.text, span);
    }
    served.caption = s.caption;
    served.does = s.does;
    if (s.preempts && (s.order == Order::kLeast || s.order == Order::kMost)) {
        // The one who has to make way: the last of the order.
        served.discipline =
            s.order == Order::kMost ? lang::Discipline::kLeast : lang::Discipline::kMost;
        served.discipline_key = s.key;
    }
    give_servers(place(free, span), s);

    const Expr rest = make_reference(kRest, span);
    lang::Transition& draws = transition(s.text() + "_comes", span, kDraws);
    Arc asked = customer(ArcKind::kTakeNow, in, span);
    asked.pattern.push_back(equal("left", rest, span));
    draws.inputs = {asked};
    Arc queued = give_customer(queue_name, same(span), span);
    queued.pattern.push_back(equal(kRest, rest, span));
    queued.pattern.push_back(equal(kCut, make_number(Rational{0}, span), span));
    draws.outputs = {queued};

    lang::Transition& start = transition(s.text() + "_start", span, kStarts);
    Arc waits = customer(ArcKind::kTake, queue_name, span);
    waits.pattern.push_back(equal(kRest, rest, span));
    start.inputs = {waits, server(ArcKind::kTake, free, s)};
    Arc begins = give_customer(s.text(), same(span), span);
    if (numbered(s)) {
        begins.pattern.push_back(equal(kServer, make_reference(kServer, span), span));
    }
    begins.pattern.push_back(equal("left", rest, span));
    start.outputs = {begins};

    const std::vector<const Route*> routes = model_.routes_of(index, RouteOn::kLeaving);
    if (!routes.empty()) {
        Exit end = service_end(s);
        if (numbered(s)) {
            end.takes[0].pattern.push_back(equal(kServer, make_reference(kServer, span), span));
        }
        emit(end, routes);
    }
    if (s.preempts) {
        build_preemption(s);
    }
    if (s.fails) {
        build_failures(s);
    }
}

// The interrupted one goes back to the queue with the rest of his service.
void QueueBuilder::build_preemption(const QueueNode& s) {
    const lang::Span span = s.span;
    const std::string queue = s.text() + "_queue", free = s.text() + "_free";
    lang::Transition& t = transition(s.text() + "_interrupts", span, kStarts);
    const Expr rest = make_reference(kRest, span), left = make_reference("left over", span);
    Arc comes = customer(ArcKind::kTake, queue, span);
    comes.pattern.push_back(equal(kRest, rest, span));
    if (s.order == Order::kLifo) {
        comes.pattern.push_back(equal(kCut, make_number(Rational{0}, span), span));
    }
    Arc goes = take(ArcKind::kTakeNow, s.text(), span);
    Values others;
    for (const CustomerAttribute& a : model_.attributes) {
        others.push_back(
            equal(a.name.text.c_str(), make_reference(a.name.text + kOther, span), span));
    }
    goes.pattern = others;
    Arc begins = give_customer(s.text(), same(span), span);
    if (numbered(s)) {
        goes.pattern.push_back(equal(kServer, make_reference(kServer, span), span));
        begins.pattern.push_back(equal(kServer, make_reference(kServer, span), span));
    }
    goes.pattern.push_back(equal("left", left, span));
    begins.pattern.push_back(equal("left", rest, span));
    Arc waits = give_customer(queue, others, span);
    waits.pattern.push_back(equal(kRest, left, span));
    waits.pattern.push_back(equal(kCut, make_number(Rational{1}, span), span));
    t.inputs = {comes, goes};
    t.outputs = {begins, waits};
    t.tests = {take(ArcKind::kUnless, free, span)};
    if (s.order != Order::kLifo) {
        t.guard = make_binary(s.order == Order::kMost ? Op::kGreater : Op::kLess, s.key,
                              renamed(s.key, model_.attributes, kOther));
    }
}

// Each server works for a while, whether it has customers or not; then it is repaired.
void QueueBuilder::build_failures(const QueueNode& s) {
    const lang::Span span = s.span;
    const std::string up = s.text() + "_up", down = s.text() + "_down", free = s.text() + "_free",
                      queue = s.text() + "_queue";
    lang::Place& works = place(up, span);
    works.takes = make_duration(s.fails);
    give_servers(works, s);
    lang::Place& repaired = place(down, span);
    repaired.takes = make_duration(s.repairs);
    if (numbered(s)) {
        repaired.of_type = make_path(s.text() + "_server", span);
    }
    lang::Transition& idle = transition(s.text() + "_fails_idle", span, kArrives);
    idle.inputs = {server(ArcKind::kTake, up, s), server(ArcKind::kTake, free, s)};
    idle.outputs = {server(ArcKind::kGive, down, s)};
    lang::Transition& fails = transition(s.text() + "_fails", span, kArrives);
    const Expr left = make_reference("left over", span);
    Arc goes = customer(ArcKind::kTakeNow, s.text(), span);
    if (numbered(s)) {
        goes.pattern.push_back(equal(kServer, make_reference(kServer, span), span));
    }
    goes.pattern.push_back(equal("left", left, span));
    Arc waits = give_customer(queue, same(span), span);
    waits.pattern.push_back(equal(kRest, left, span));
    waits.pattern.push_back(equal(kCut, make_number(Rational{1}, span), span));
    fails.inputs = {server(ArcKind::kTake, up, s), goes};
    fails.outputs = {server(ArcKind::kGive, down, s), waits};
    lang::Transition& works_again = transition(s.text() + "_repaired", span, kEnds);
    works_again.inputs = {server(ArcKind::kTake, down, s)};
    works_again.outputs = {server(ArcKind::kGive, up, s), server(ArcKind::kGive, free, s)};
}

}  // namespace puppetri::notation
