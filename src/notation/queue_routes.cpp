// SPDX-License-Identifier: MIT
// Routing: each customer that leaves one node goes one way, and is taken in, lost, or waits for
// room there.
#include <optional>

#include "make.h"
#include "queue_builder.h"

namespace puppetri::notation {

using lang::Arc;
using lang::ArcKind;
using lang::Expr;
using lang::Op;
using lang::Span;

namespace {

const char* name_of(RouteOn on) {
    switch (on) {
        case RouteOn::kFull:
            return "_full";
        case RouteOn::kBalking:
            return "_balks";
        case RouteOn::kImpatient:
            return "_gives_up";
        default:
            return "";
    }
}

void append(std::vector<Arc>& to, const std::vector<Arc>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

Expr product(const Expr& a, const Expr& b) {
    return !a ? b : !b ? a : make_binary(Op::kMultiply, a, b);
}

Expr one_minus(const Expr& p) {
    return make_binary(Op::kSubtract, make_number(Rational{1}, p.span), p);
}

Expr not_of(const Expr& a) { return make_unary(Op::kNot, a); }

// Of probabilities that are numbers.
std::optional<Rational> known_sum(const std::vector<const Route*>& routes) {
    std::optional<Rational> sum = Rational{0, 1};
    for (const Route* r : routes) {
        if (r->probability.kind == lang::ExprKind::kNumber && r->probability.unit.empty()) {
            sum = sum ? add(*sum, r->probability.number) : sum;
        } else if (r->probability) {
            return std::nullopt;
        }
    }
    return sum;
}

bool is_number(const Expr& e) { return e.kind == lang::ExprKind::kNumber; }

bool is_zero(const Expr& e) { return is_number(e) && e.number.numerator == 0; }
bool is_one(const Expr& e) { return is_number(e) && e.number == Rational{1}; }

}  // namespace

// Where customers come in: those whose service may be interrupted first learn how long it will be.
std::string QueueBuilder::way_in(const QueueNode& station) const {
    return station.text() + (station.resumes() ? "_in" : "_queue");
}

// How many are at a node, waiting or served.
Expr QueueBuilder::number_at(const QueueNode& node, Span span) const {
    Expr served = make_count(make_path(node.text(), span));
    if (node.kind != NodeKind::kStation) {
        return served;
    }
    return make_binary(Op::kAdd, make_count(make_path(node.text() + "_queue", span)),
                       std::move(served));
}

// `reserved`: the room was taken when the customer set out.
std::vector<Way> QueueBuilder::ways_into(std::size_t index, const Values& values, const Expr& count,
                                         Span span, bool reserved) {
    const QueueNode& node = model_.nodes[index];
    Way enter;
    if (node.kind == NodeKind::kSink || node.kind == NodeKind::kPool) {
        if (node.kind == NodeKind::kPool) {
            enter.gives.push_back(give_customer(node.text(), values, span, count));
        } else if (model_.ending) {
            enter.gives.push_back(take(ArcKind::kGive, model_.ending.counts, span, count));
        }
        enter.leaves = true;
        return {enter};
    }
    if (node.kind == NodeKind::kDelay) {
        enter.gives.push_back(give_customer(node.text(), values, span, count));
        return {enter};
    }
    enter.gives.push_back(give_customer(way_in(node), values, span, count));
    const std::string room = node.text() + "_room";
    if (node.room && !reserved) {
        enter.takes.push_back(take(ArcKind::kTake, room, span, count));
    }
    std::vector<Way> ways;
    Way balk;
    balk.suffix = "_balks";
    bool balks = false;
    if (node.balks && !is_zero(node.balks)) {
        balks = true;
        const Expr zero = make_number(Rational{0}, span);
        const Expr one = make_number(Rational{1}, span);
        balk.odds = node.balks;
        enter.odds = one_minus(node.balks);
        if (!is_number(node.balks)) {  // odds are above 0
            balk.guard = make_binary(Op::kGreater, node.balks, zero);
            enter.guard = make_binary(Op::kLess, node.balks, one);
        }
    } else if (node.balks_when) {
        balks = true;
        balk.guard = node.balks_when;
        enter.guard = not_of(node.balks_when);
    }
    if (!balks || !is_one(node.balks)) {
        ways.push_back(enter);
    }
    if (balks) {
        if (node.room) {
            balk.tests.push_back(take(ArcKind::kWith, room, span, count));
        }
        turned_away(index, RouteOn::kBalking, values, count, span, balk);
        ways.push_back(balk);
    }
    if (node.room && node.full == WhenFull::kLost) {
        Way full;
        full.suffix = "_full";
        full.tests.push_back(take(ArcKind::kUnless, room, span, count));
        turned_away(index, RouteOn::kFull, values, count, span, full);
        ways.push_back(full);
    }
    return ways;
}

// Who does not come in goes where the routes say, or leaves the network.
void QueueBuilder::turned_away(std::size_t index, RouteOn on, const Values& values,
                               const Expr& count, Span span, Way& way) {
    const std::vector<const Route*> routes = model_.routes_of(index, on);
    if (routes.empty()) {
        way.leaves = true;
        return;
    }
    const QueueNode& to = model_.nodes[routes[0]->to[0]];
    const bool plain = routes.size() == 1 && routes[0]->to.size() == 1 && !routes[0]->when &&
                       !routes[0]->takes && !routes[0]->does && !to.room && !to.balks &&
                       !to.balks_when;
    if (plain) {
        const Way there =
            ways_into(routes[0]->to[0], changed(values, routes[0]->sets), count, span, false)[0];
        append(way.gives, there.gives);
        way.leaves = there.leaves;
        return;
    }
    gates_.insert({index, on});
    way.gives.push_back(
        give_customer(model_.nodes[index].text() + name_of(on), values, span, count));
}

// Places in which customers who were turned away decide, at once.
void QueueBuilder::build_gates() {
    while (gates_.size() > built_gates_.size()) {
        for (const Gate& gate : std::set<Gate>(gates_)) {
            if (!built_gates_.insert(gate).second) {
                continue;
            }
            const QueueNode& node = model_.nodes[gate.node];
            const std::string name = node.text() + name_of(gate.on);
            customers_place(name, node.span);
            Exit exit;
            exit.name = name;
            exit.span = node.span;
            exit.takes = {customer(ArcKind::kTake, name, node.span)};
            exit.values = same(node.span);
            exit.priority = kDecides;
            emit(exit, model_.routes_of(gate.node, gate.on));
        }
    }
}

// Sends customers along one of the routes: the first whose condition holds; else one drawn by the
// probabilities of those without a condition. None: out of the network.
void QueueBuilder::emit(const Exit& exit, const std::vector<const Route*>& routes) {
    if (routes.empty()) {
        Way out;
        out.leaves = true;
        fire(exit, exit.name, out, {}, {}, {});
        return;
    }
    Expr none_before, sum;
    const Route* rest = nullptr;  // takes what the probabilities of the others leave
    for (const Route* r : routes) {
        if (r->probability) {
            sum = sum ? make_binary(Op::kAdd, sum, r->probability) : r->probability;
        } else if (!r->when) {
            rest = r;
        }
    }
    for (const Route* r : routes) {
        Expr guard = none_before;
        if (r->when) {
            guard = make_both(guard, r->when);
            none_before = make_both(none_before, not_of(r->when));
        } else {
            guard = {};
            for (const Route* other : routes) {
                if (other->when) {
                    guard = make_both(guard, not_of(other->when));
                }
            }
        }
        Expr odds = r->probability;
        if (r == rest && sum) {
            const std::optional<Rational> others = known_sum(routes);
            const auto left = others ? subtract({1, 1}, *others) : std::nullopt;
            odds = left ? make_number(*left, r->span) : one_minus(sum);
        }
        if (is_zero(odds)) {
            continue;
        }
        if (odds && !is_number(odds)) {  // odds are above 0
            guard = make_both(guard,
                              make_binary(Op::kGreater, odds, make_number(Rational{0}, odds.span)));
        }
        for (const std::size_t to : r->to) {
            Expr here = guard;
            for (const std::size_t other : r->to) {
                if (other != to) {
                    here = make_both(
                        here, make_binary(Op::kLessEqual, number_at(model_.nodes[to], r->span),
                                          number_at(model_.nodes[other], r->span)));
                }
            }
            bool waits = false;  // for room: then where to has been decided before
            for (const Route* any : routes) {
                for (const std::size_t n : any->to) {
                    waits = waits || blocks(model_.nodes[n]);
                }
            }
            if (!waits || (routes.size() == 1 && r->to.size() == 1)) {
                send(exit, *r, to, here, odds);
                continue;
            }
            const std::string decided = exit.name + "_for_" + model_.nodes[to].text();
            customers_place(decided, r->span);
            Way picks;
            picks.gives.push_back(give_customer(decided, exit.values, r->span, exit.count));
            Exit chosen = exit;
            chosen.gives.clear();
            // Where he was before, he still is: the count of those inside changes on leaving.
            fire(chosen, exit.name + "_picks_" + model_.nodes[to].text(), picks, here, odds, {});
            Exit later = exit;
            later.takes = {customer(ArcKind::kTake, decided, r->span, exit.count)};
            later.values = same(r->span);
            later.outside = false;
            send(later, *r, to, {}, {});
        }
    }
}

void QueueBuilder::send(const Exit& exit, const Route& route, std::size_t to, const Expr& guard,
                        const Expr& odds) {
    const QueueNode& target = model_.nodes[to];
    const Values values = changed(exit.values, route.sets);
    const std::string name = exit.name + "_to_" + target.text();
    if (!route.takes && !route.does) {
        for (const Way& way : ways_into(to, values, exit.count, route.span, false)) {
            fire(exit, name + way.suffix, way, guard, odds, route.sets);
        }
        return;
    }
    const std::string road = exit.name + "_" + target.text() + "_way";
    lang::Place& on_the_way = customers_place(road, route.span);
    if (route.takes) {
        on_the_way.takes = make_duration(route.takes);
    }
    on_the_way.does = route.does;
    Way sets_out;
    sets_out.gives.push_back(give_customer(road, values, route.span, exit.count));
    if (blocks(target)) {
        sets_out.takes.push_back(
            take(ArcKind::kTake, target.text() + "_room", route.span, exit.count));
    }
    fire(exit, name, sets_out, guard, odds, route.sets);
    Exit arrives;
    arrives.name = road;
    arrives.span = route.span;
    arrives.takes = {customer(ArcKind::kTake, road, route.span)};
    arrives.values = same(route.span);
    arrives.priority = kArrives;
    for (const Way& way : ways_into(to, arrives.values, {}, route.span, blocks(target))) {
        fire(arrives, road + "_ends" + way.suffix, way, {}, {}, {});
    }
}

void QueueBuilder::fire(const Exit& exit, const std::string& name, const Way& way,
                        const Expr& guard, const Expr& odds,
                        const std::vector<lang::Binding>& sets) {
    lang::Transition& t = transition(name, exit.span, exit.priority);
    append(t.inputs, exit.takes);
    append(t.inputs, way.takes);
    append(t.tests, way.tests);
    append(t.outputs, exit.gives);
    append(t.outputs, way.gives);
    t.guard = make_both(guard, way.guard);
    t.odds = product(odds, way.odds);
    for (const lang::Binding& set : sets) {
        if (model_.attribute(lang::to_text(set.name)) == nullptr) {
            t.assignments.push_back(set);
        }
    }
    if (model_.inside && exit.outside != way.leaves) {
        Arc inside = take(exit.outside ? ArcKind::kGive : ArcKind::kTake, model_.inside->text,
                          exit.span, exit.count);
        (exit.outside ? t.outputs : t.inputs).push_back(std::move(inside));
    }
}

}  // namespace puppetri::notation
