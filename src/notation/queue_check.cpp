// SPDX-License-Identifier: MIT
// What can be wrong with a queueing network before anything is known about its parameters.
#include <algorithm>
#include <cmath>
#include <optional>

#include "puppetri/base/hash.h"
#include "queue_model.h"

namespace puppetri::notation {
namespace {

using lang::Expr;
using lang::ExprKind;
using lang::Op;

// The value of an expression in which every parameter, and whatever else is not known yet, has a
// value of its own made from `salt`: two sums that agree for two salts are the same formula (but
// for coincidences of 1 in 2^50).
double value_under(const Expr& e, std::uint64_t salt) {
    const auto arg = [&](std::size_t i) { return value_under(e.args[i].value, salt); };
    if (e.kind == ExprKind::kNumber && (e.unit.empty() || e.unit == "percent")) {
        const double x =
            static_cast<double>(e.number.numerator) / static_cast<double>(e.number.denominator);
        return e.unit.empty() ? x : x / 100;
    }
    if (e.kind == ExprKind::kUnary && e.op == Op::kNegate) {
        return -arg(0);
    }
    if (e.kind == ExprKind::kBinary && (e.op == Op::kAdd || e.op == Op::kSubtract ||
                                        e.op == Op::kMultiply || e.op == Op::kDivide)) {
        double x = arg(0);
        for (std::size_t i = 1; i < e.args.size(); ++i) {
            const double y = arg(i);
            x = e.op == Op::kAdd        ? x + y
                : e.op == Op::kSubtract ? x - y
                : e.op == Op::kMultiply ? x * y
                                        : x / y;
        }
        return x;
    }
    Hash64 h;
    h.add_text(lang::to_text(e)).add_u64(salt);
    return static_cast<double>(h.value() >> 11) * 0x1p-53;
}

// Made of numbers alone.
bool is_constant(const Expr& e) {
    if (e.kind == ExprKind::kNumber) {
        return true;
    }
    return (e.kind == ExprKind::kUnary || e.kind == ExprKind::kBinary) && e.op != Op::kNot &&
           std::all_of(e.args.begin(), e.args.end(),
                       [](const lang::Argument& a) { return is_constant(a.value); });
}

class Checker {
 public:
    Checker(const QueueModel& model, const lang::Block& block, const lang::File& file,
            Teller& teller)
        : model_(model), block_(block), file_(file), teller_(teller) {}

    void check() {
        names();
        for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
            const QueueNode& n = model_.nodes[i];
            ways_out(i);
            if (n.kind == NodeKind::kStation) {
                station(i);
            } else if (n.kind == NodeKind::kSource) {
                source(n);
            }
            for (const RouteOn on :
                 {RouteOn::kLeaving, RouteOn::kFull, RouteOn::kBalking, RouteOn::kImpatient}) {
                probabilities(n, model_.routes_of(i, on));
            }
        }
        for (const Route& r : model_.routes) {
            route(r);
        }
        reached();
    }

 private:
    const QueueNode& node(std::size_t i) const { return model_.nodes[i]; }

    // Attributes are read by their names: nothing else may be called so.
    void names() {
        const auto taken = [&](const std::string& name) {
            for (const lang::Parameter& p : block_.parameters) {
                if (p.name.text == name) {
                    return true;
                }
            }
            for (const lang::Data& d : model_.data) {
                if (d.name.text == name) {
                    return true;
                }
            }
            for (const QueueNode& n : model_.nodes) {
                if (n.text() == name) {
                    return true;
                }
            }
            for (const lang::CastMember& m : file_.body.cast) {
                if (m.name.text == name) {
                    return true;
                }
            }
            for (const lang::Enumeration& e : file_.body.enumerations) {
                for (const lang::Name& v : e.values) {
                    if (v.text == name) {
                        return true;
                    }
                }
            }
            return false;
        };
        for (const CustomerAttribute& a : model_.attributes) {
            if (taken(a.name.text)) {
                teller_.error("name-twice", a.name.span,
                              "customers have an attribute " + a.name.text +
                                  ", and something else is called so",
                              "call one of them otherwise");
            }
        }
    }

    void ways_out(std::size_t i) {
        const QueueNode& n = node(i);
        const bool ends = n.kind == NodeKind::kSink || n.kind == NodeKind::kPool;
        const bool goes_on = !model_.routes_of(i, RouteOn::kLeaving).empty();
        if (ends && goes_on) {
            teller_.error("wrong-routing", model_.routes_of(i, RouteOn::kLeaving)[0]->span,
                          "nobody goes on from " + n.text(),
                          n.kind == NodeKind::kPool
                              ? "let a source take its customers from it: source door from " +
                                    n.text() + " every 10 s"
                              : "make it a delay: delay " + n.text() + " takes 0 s");
        } else if (!ends && !goes_on) {
            teller_.error("wrong-routing", n.span, "customers never leave " + n.text(),
                          "say where they go: " + n.text() + " -> out, with a line: sink out");
        }
    }

    void source(const QueueNode& n) {
        if (!n.from.empty()) {
            const std::string name = lang::to_text(n.from);
            const auto found =
                std::find_if(model_.nodes.begin(), model_.nodes.end(),
                             [&](const QueueNode& other) { return other.text() == name; });
            if (found == model_.nodes.end() || found->kind != NodeKind::kPool) {
                teller_.error("unknown-name", n.from.span, name + " is no pool of this queue",
                              "write a line: pool " + name + " customers 5");
            }
            if (n.batch) {
                teller_.error("not-together", n.span, "customers leave a pool one by one",
                              "remove batch, or from");
            }
        }
    }

    // A key that is a whole number as far as can be seen.
    bool whole(const Expr& e) const {
        switch (e.kind) {
            case ExprKind::kNumber:
                return e.unit.empty() && e.number.denominator == 1;
            case ExprKind::kPath: {
                const CustomerAttribute* a = model_.attribute(lang::to_text(e.path));
                return a != nullptr &&
                       (a->type.kind == ExprKind::kRange ||
                        (a->type.kind == ExprKind::kPath && lang::to_text(a->type.path) == "int"));
            }
            case ExprKind::kUnary:
                return e.op != Op::kNot && whole(e.args[0].value);
            case ExprKind::kBinary:
                return (e.op == Op::kAdd || e.op == Op::kSubtract || e.op == Op::kMultiply) &&
                       std::all_of(e.args.begin(), e.args.end(),
                                   [&](const lang::Argument& a) { return whole(a.value); });
            case ExprKind::kConditional:
                return whole(e.args[1].value) && whole(e.args[2].value);
            default:
                return false;
        }
    }

    void station(std::size_t i) {
        const QueueNode& n = node(i);
        const auto apart = [&](const std::string& message, const std::string& remedy) {
            teller_.error("not-together", n.span, message, remedy);
        };
        if (n.preempts && n.order != Order::kLifo && n.order != Order::kLeast &&
            n.order != Order::kMost) {
            apart("who goes before whom?",
                  "write order most RANK preempts, or order lifo preempts");
        }
        if (n.resumes() && (n.order == Order::kLeast || n.order == Order::kMost) && !whole(n.key)) {
            apart("where services are interrupted, ranks are whole numbers",
                  "give customers one: customer Client(rank: 0 .. 9), order most rank");
        }
        if (n.resumes() && n.patience) {
            apart("patience and interrupted services cannot be combined",
                  "remove patience, or preempts and fails");
        }
        if (n.resumes() && n.order == Order::kRandom) {
            apart("whose service was interrupted goes on first, so that the order is not random",
                  "write order fifo");
        }
        if (n.gathers && (n.resumes() || n.patience || !model_.customer.empty())) {
            apart("only customers that nothing tells apart, and that wait for ever, are gathered",
                  "remove gathers, or patience, preempts, fails and the type of customers");
        }
        if (n.patience && n.order == Order::kRandom) {
            apart("patience and a random order cannot be combined", "write order fifo");
        }
        if ((n.balks || n.balks_when) && n.room && n.full == WhenFull::kBlocks) {
            apart("who may go away need not wait for room",
                  "write room ... lost; they are sent on by " + n.text() + " -> ... on full");
        }
        if (n.fails && n.servers && n.servers.kind != ExprKind::kNumber) {
            apart("how many servers may fail must be known here", "write servers 2, as a number");
        }
        if (n.resumes()) {
            for (const Route* r : model_.routes_of(i, RouteOn::kLeaving)) {
                for (const std::size_t to : r->to) {
                    if (node(to).room && node(to).full == WhenFull::kBlocks) {
                        teller_.error("not-together", r->span,
                                      "a service at " + n.text() +
                                          " can be interrupted, so its customer cannot keep the "
                                          "server while " +
                                          node(to).text() + " has no room",
                                      "put a delay between: " + n.text() + " -> desk, desk -> " +
                                          node(to).text() + ", with a line: delay desk takes 0 s");
                    }
                }
            }
        }
    }

    void route(const Route& r) {
        const QueueNode& from = node(r.from);
        for (const std::size_t to : r.to) {
            if (node(to).kind == NodeKind::kSource) {
                teller_.error("wrong-routing", r.span, "nobody goes to a source",
                              "name a station, a delay, a pool or a sink");
            }
            if (r.to.size() > 1 &&
                (node(to).kind == NodeKind::kSink || node(to).kind == NodeKind::kPool)) {
                teller_.error("wrong-routing", r.span, node(to).text() + " has no line",
                              "name stations and delays in shortest(...)");
            }
        }
        const auto needs = [&](bool has, const char* occasion, const char* remedy) {
            if (!has) {
                teller_.error("wrong-routing", r.span,
                              "nobody leaves " + from.text() + " " + occasion,
                              "write station " + from.text() + " ... " + remedy);
            }
        };
        switch (r.on) {
            case RouteOn::kLeaving:
                break;
            case RouteOn::kFull:
                needs(from.room && from.full == WhenFull::kLost, "because it is full",
                      "room 5 lost");
                break;
            case RouteOn::kBalking:
                needs(from.balks || from.balks_when, "by balking", "balks 0.2");
                break;
            case RouteOn::kImpatient:
                needs(static_cast<bool>(from.patience), "out of impatience",
                      "patience exponential(1 min)");
                break;
            case RouteOn::kJockeying:
                if (from.kind != NodeKind::kStation || from.resumes() || r.probability || r.takes ||
                    r.does || std::any_of(r.to.begin(), r.to.end(), [&](std::size_t to) {
                        return node(to).kind != NodeKind::kStation || to == r.from;
                    })) {
                    teller_.error("wrong-routing", r.span,
                                  "one changes from the line of a station to that of another",
                                  "write FROM -> TO on jockeying when CONDITION, for stations "
                                  "whose services are not interrupted");
                }
                break;
        }
    }

    void probabilities(const QueueNode& n, const std::vector<const Route*>& routes) {
        double sum[2] = {0, 0};
        const Route *last = nullptr, *rest = nullptr;
        int without = 0, always = 0;
        bool constant = true;
        for (const Route* r : routes) {
            if (r->when && r->probability) {
                teller_.error("wrong-routing", r->span, "a route has a condition or a probability",
                              "remove one of them; conditions are looked at first");
                return;
            }
            if (r->when) {
                continue;
            }
            ++always;
            last = r;
            if (!r->probability) {
                ++without;
                rest = r;
                continue;
            }
            constant = constant && is_constant(r->probability);
            for (int salt = 0; salt < 2; ++salt) {
                sum[salt] += value_under(r->probability, static_cast<std::uint64_t>(salt));
            }
            if (is_constant(r->probability) &&
                !(value_under(r->probability, 0) >= 0 && value_under(r->probability, 0) <= 1)) {
                teller_.error("wrong-routing", r->probability.span,
                              "a probability is a number from 0 to 1", "write 0.3, or 30 percent");
                return;
            }
        }
        if (routes.empty()) {
            return;
        }
        if (always == 0) {
            teller_.error(
                "wrong-routing", routes.back()->span,
                "where do customers of " + n.text() + " go for whom none of the conditions holds?",
                "write one route without a condition: it is for all others");
            return;
        }
        if (without > 1) {
            teller_.error("wrong-routing", rest->span,
                          "several routes from " + n.text() + " say nothing about who takes them",
                          "write probability ... or when ...; or FROM -> shortest(A, B)");
            return;
        }
        const auto text = [](double x) {
            std::string t = std::to_string(x);
            t.erase(t.find_last_not_of('0') + 1);
            return t.back() == '.' ? t + "0" : t;
        };
        if (without == 1) {
            if (constant && sum[0] > 1 + 1e-9) {
                teller_.error("wrong-routing", last->span,
                              "the probabilities of the routes from " + n.text() + " sum to " +
                                  text(sum[0]) + ", more than 1",
                              "make them sum to 1 at most: what is left over takes the route "
                              "without a probability");
            }
            return;
        }
        if (std::abs(sum[0] - 1) > 1e-9 || std::abs(sum[1] - 1) > 1e-9) {
            teller_.error(
                "wrong-routing", last->span,
                constant
                    ? "the probabilities of the routes from " + n.text() + " sum to " + text(sum[0])
                    : "the probabilities of the routes from " + n.text() +
                          " do not sum to 1 whatever the parameters are",
                "make them sum to 1, or leave the last one out: it takes what is left over");
        }
    }

    void reached() {
        std::vector<bool> there(model_.nodes.size());
        for (std::size_t i = 0; i < there.size(); ++i) {
            there[i] = node(i).kind == NodeKind::kSource || !node(i).customers.empty();
        }
        for (bool more = true; more;) {
            more = false;
            for (const Route& r : model_.routes) {
                for (const std::size_t to : r.to) {
                    if (there[r.from] && !there[to] &&
                        !(is_constant(r.probability) && value_under(r.probability, 0) == 0)) {
                        there[to] = more = true;
                    }
                }
            }
        }
        for (std::size_t i = 0; i < there.size(); ++i) {
            if (!there[i]) {
                teller_.warn("never-entered", node(i).span,
                             "no customer ever comes to " + node(i).text(),
                             "add a route: ... -> " + node(i).text() + ", or remove it");
            }
        }
    }

    const QueueModel& model_;
    const lang::Block& block_;
    const lang::File& file_;
    Teller& teller_;
};

}  // namespace

void check_queue(const QueueModel& model, const lang::Block& block, const lang::File& file,
                 Teller& teller) {
    Checker(model, block, file, teller).check();
}

}  // namespace puppetri::notation
