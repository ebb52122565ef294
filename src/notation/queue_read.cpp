// SPDX-License-Identifier: MIT
// Reading the lines of a `queue` block.
#include <algorithm>
#include <map>

#include "make.h"
#include "queue_model.h"

namespace puppetri::notation {
namespace {

using lang::Expr;
using lang::ExprKind;

constexpr std::string_view kLineForms =
    "customer, data, inside, source, station, delay, pool, sink, ends, or FROM -> TO";
constexpr std::string_view kSourceForm =
    "source NAME every TIME first TIME batch NUMBER from POOL closes TIME repeats TIME { at TIME "
    "every TIME }";
constexpr std::string_view kStationForm =
    "station NAME servers NUMBER serves TIME order fifo room NUMBER lost patience TIME balks "
    "PROBABILITY customers NUMBER";
constexpr std::string_view kDelayForm = "delay NAME takes TIME does MOVEMENT customers NUMBER";
constexpr std::string_view kPoolForm = "pool NAME customers NUMBER (ATTRIBUTE = VALUE)";
constexpr std::string_view kRouteForm =
    "FROM -> TO probability NUMBER when CONDITION on full takes TIME { ATTRIBUTE := VALUE }";

bool is_assignment(const lang::Property& p) {
    return !p.values.empty() && p.values[0].kind == ExprKind::kSymbol && p.values[0].text == ":=";
}

// Clauses may stand in braces, on lines of their own: the same as one line.
lang::Property one_line(const lang::Property& p, bool (*apart)(const lang::Property&)) {
    lang::Property out = p;
    out.children.clear();
    for (const lang::Property& child : p.children) {
        if (apart(child)) {
            out.children.push_back(child);
            continue;
        }
        out.values.push_back(make_reference(child.name));
        out.values.insert(out.values.end(), child.values.begin(), child.values.end());
    }
    return out;
}

class Reader {
 public:
    Reader(const lang::Block& block, const lang::File& file, Teller& teller)
        : block_(block), file_(file), teller_(teller) {}

    QueueModel read() {
        for (const lang::Property& p : block_.properties) {
            if (!has_arrow(p)) {
                declaration(p);
            }
        }
        for (const lang::Property& p : block_.properties) {
            if (has_arrow(p)) {
                route(p);
            }
        }
        return std::move(model_);
    }

 private:
    void declaration(const lang::Property& p) {
        const std::string word = lang::to_text(p.name);
        static const std::map<std::string, NodeKind> kinds = {{"source", NodeKind::kSource},
                                                              {"station", NodeKind::kStation},
                                                              {"delay", NodeKind::kDelay},
                                                              {"pool", NodeKind::kPool},
                                                              {"sink", NodeKind::kSink}};
        const auto kind = kinds.find(word);
        if (is_ending(p)) {
            Line line(p, teller_);
            read_count(line, "customers", "queue_left", teller_, model_.ending);
        } else if (kind != kinds.end()) {
            node(p, kind->second);
        } else if (word == "customer") {
            customer(p);
        } else if (word == "data") {
            data(p);
        } else if (word == "inside") {
            Line line(p, teller_);
            if (const lang::Path* name = line.path("the name of a place")) {
                model_.inside = name->steps[0];
            }
            line.finish("inside NAME");
        } else {
            teller_.error("unknown-name", p.name.span, "there is no line '" + word + "' in a queue",
                          "there are: " + std::string(kLineForms));
        }
    }

    void customer(const lang::Property& p) {
        Line line(p, teller_);
        const Expr* e = line.value("the name of a type of customers");
        if (e == nullptr) {
            return;
        }
        if (!model_.customer.empty()) {
            teller_.error("name-twice", p.span, "there is one type of customers in a queue",
                          "give it an attribute that tells them apart: kind: Kind");
            return;
        }
        line.finish("customer NAME(ATTRIBUTE: TYPE = VALUE)");
        if ((e->kind != ExprKind::kCall && e->kind != ExprKind::kPath) ||
            e->path.steps.size() != 1) {
            teller_.error("syntax", e->span, "a name is wanted here",
                          "write customer Client(kind: Kind)");
            return;
        }
        model_.customer = e->path.steps[0].text;
        model_.customer_span = p.span;
        if (e->kind == ExprKind::kPath) {
            declared_elsewhere(*e);
            return;
        }
        for (const lang::Argument& a : e->args) {
            if (a.name.text.empty()) {
                teller_.error("syntax", a.value.span, "an attribute has a name and a type",
                              "write kind: Kind, or kind: Kind = normal");
                continue;
            }
            CustomerAttribute made{a.name, a.value, {}};
            if (a.value.kind == ExprKind::kBinary && a.value.op == lang::Op::kEqual) {
                made.type = a.value.args[0].value;
                made.initial = a.value.args[1].value;
            }
            model_.attributes.push_back(std::move(made));
        }
    }

    void declared_elsewhere(const Expr& name) {
        for (const lang::TokenType& type : file_.body.token_types) {
            if (type.name.text == model_.customer) {
                model_.declared_elsewhere = true;
                for (const lang::Parameter& a : type.attributes) {
                    model_.attributes.push_back({a.name, a.type, a.default_value});
                }
                return;
            }
        }
        teller_.error("unknown-name", name.span,
                      "this file declares no tokens of type " + model_.customer,
                      "write the attributes here: customer " + model_.customer + "(kind: Kind)");
    }

    void data(const lang::Property& p) {
        Line line(p, teller_);
        lang::Data made;
        if (read_data(line, made)) {
            model_.data.push_back(std::move(made));
        }
    }

    void node(const lang::Property& p, NodeKind kind) {
        const lang::Property flat = one_line(
            p, [](const lang::Property& child) { return lang::to_text(child.name) == "at"; });
        Line line(flat, teller_);
        const lang::Path* name = line.path("a name");
        if (name == nullptr) {
            return;
        }
        QueueNode made;
        made.kind = kind;
        made.name = name->steps[0];
        made.span = p.span;
        made.caption = line.caption();
        if (kind == NodeKind::kSource) {
            source(line, flat, made);
        } else if (kind == NodeKind::kStation) {
            station(line, made);
        } else if (kind == NodeKind::kDelay) {
            delay(line, made);
        } else if (kind == NodeKind::kPool) {
            while (!line.done()) {
                if (line.word("customers")) {
                    customers(line, made);
                } else {
                    line.finish(kPoolForm);
                }
            }
        }
        line.finish("sink NAME");
        if (kind != NodeKind::kSource && !flat.children.empty()) {
            teller_.error("syntax", flat.children[0].span, "only sources have periods",
                          "remove the line");
        }
        if (find(made.text()) != nullptr) {
            teller_.error("name-twice", p.span, "there is already a node " + made.text(),
                          "choose another name");
            return;
        }
        model_.nodes.push_back(std::move(made));
    }

    void take(Line& line, std::string_view wanted, Expr& into) {
        if (const Expr* e = line.value(wanted)) {
            into = *e;
        }
    }

    void source(Line& line, const lang::Property& flat, QueueNode& made) {
        while (!line.done()) {
            if (line.word("every")) {
                take(line, "the time from one arrival to the next", made.every);
            } else if (line.word("first")) {
                take(line, "the time of the first arrival", made.first);
            } else if (line.word("closes")) {
                take(line, "a time", made.closes);
            } else if (line.word("batch")) {
                take(line, "how many come at once", made.batch);
            } else if (line.word("repeats")) {
                take(line, "how long a day is", made.repeats);
            } else if (line.word("from")) {
                if (const lang::Path* pool = line.path("the name of a pool")) {
                    made.from = *pool;
                }
            } else {
                line.finish(kSourceForm);
            }
        }
        for (const lang::Property& child : flat.children) {
            Line period(child, teller_);
            Period part;
            part.span = child.span;
            take(period, "the time at which the period begins", part.from);
            if (period.word("every")) {
                take(period, "the time from one arrival to the next", part.every);
            } else if (!period.word("closed")) {
                teller_.error("syntax", child.span, "nothing is said about this period",
                              "write at 9 h every exponential(3 min), or at 18 h closed");
            }
            period.finish("at TIME every TIME, or at TIME closed");
            made.periods.push_back(std::move(part));
        }
        if (made.every && !made.periods.empty()) {
            teller_.error("syntax", made.span, "what holds before the first period is said twice",
                          "write it as a period: at 0 s every ...");
        } else if (!made.every && made.periods.empty()) {
            teller_.error("syntax", made.span, "how often do they come?",
                          "write every exponential(10 s)");
        }
        if (made.repeats && made.periods.empty()) {
            teller_.error("syntax", made.span, "nothing repeats",
                          "write periods: at 9 h every ...");
        }
        if (made.first && !made.periods.empty()) {
            teller_.error("syntax", made.span, "the first period says when arrivals begin",
                          "remove first");
        }
    }

    void customers(Line& line, QueueNode& made) {
        lang::InitialTokens group;
        group.span = made.span;
        take(line, "how many customers are there", group.count);
        const Expr* e = line.peek();
        const bool bindings =
            e != nullptr && (e->kind == ExprKind::kTuple ||
                             (e->kind == ExprKind::kBinary && e->op == lang::Op::kEqual));
        if (bindings) {
            line.value("attributes");
            const auto add = [&](const Expr& b) {
                if (b.kind == ExprKind::kBinary && b.op == lang::Op::kEqual &&
                    b.args[0].value.kind == ExprKind::kPath) {
                    group.attributes.push_back({b.args[0].value.path, b.args[1].value, b.span});
                } else {
                    teller_.error("syntax", b.span, "an attribute and its value are wanted",
                                  "write (kind = vip)");
                }
            };
            if (e->kind == ExprKind::kTuple) {
                for (const lang::Argument& a : e->args) {
                    add(a.value);
                }
            } else {
                add(*e);
            }
        }
        made.customers.push_back(std::move(group));
    }

    void delay(Line& line, QueueNode& made) {
        while (!line.done()) {
            if (line.word("takes")) {
                take(line, "a time", made.serves);
            } else if (line.word("does")) {
                take(line, "a movement", made.does);
            } else if (line.word("customers")) {
                customers(line, made);
            } else {
                line.finish(kDelayForm);
            }
        }
        if (!made.serves) {
            teller_.error("syntax", made.span, "how long does it take?", "write takes 5 s");
        }
    }

    void order(Line& line, QueueNode& made) {
        if (line.word("fifo")) {
            made.order = Order::kFifo;
        } else if (line.word("lifo")) {
            made.order = Order::kLifo;
        } else if (line.word("random")) {
            made.order = Order::kRandom;
        } else if (line.word("least")) {
            made.order = Order::kLeast;
            take(line, "what is compared", made.key);
        } else if (line.word("most")) {
            made.order = Order::kMost;
            take(line, "what is compared", made.key);
        } else {
            teller_.error("syntax", line.span(), "in which order are they served?",
                          "write order fifo, lifo, random, least EXPR or most EXPR");
            line.value("an order");
        }
    }

    void station(Line& line, QueueNode& made) {
        while (!line.done()) {
            if (line.word("servers")) {
                take(line, "the number of servers", made.servers);
            } else if (line.word("serves")) {
                take(line, "the time of a service", made.serves);
            } else if (line.word("order")) {
                order(line, made);
            } else if (line.word("preempts")) {
                made.preempts = true;
            } else if (line.word("room")) {
                take(line, "for how many there is room", made.room);
                made.full = line.word("lost") ? WhenFull::kLost : WhenFull::kBlocks;
                line.word("blocks");
            } else if (line.word("patience")) {
                take(line, "how long they wait", made.patience);
            } else if (line.word("balks")) {
                if (line.word("when")) {
                    take(line, "a condition", made.balks_when);
                } else {
                    take(line, "a probability", made.balks);
                }
            } else if (line.word("gathers")) {
                take(line, "how many are served at once", made.gathers);
            } else if (line.word("breaks")) {
                breaks(line, made);
            } else if (line.word("fails")) {
                take(line, "the time until a server fails", made.fails);
                if (line.word("repairs")) {
                    take(line, "the time of a repair", made.repairs);
                } else {
                    teller_.error("syntax", line.span(), "how long does a repair take?",
                                  "write fails exponential(10 h) repairs exponential(1 h)");
                }
            } else if (line.word("does")) {
                take(line, "a movement", made.does);
            } else if (line.word("customers")) {
                customers(line, made);
            } else {
                line.finish(kStationForm);
            }
        }
        if (!made.serves) {
            teller_.error("syntax", made.span, "how long does a service take?",
                          "write serves exponential(20 s)");
        }
    }

    void breaks(Line& line, QueueNode& made) {
        Break pause;
        pause.span = line.span();
        if (line.word("every")) {
            take(line, "how often", pause.every);
        }
        if (line.word("first")) {
            take(line, "when", pause.first);
        }
        if (line.word("for")) {
            take(line, "how long", pause.lasting);
        }
        if (!pause.every || !pause.lasting) {
            teller_.error("syntax", line.span(), "when, and how long, is a break?",
                          "write breaks every 2 h for 15 min");
            return;
        }
        made.breaks.push_back(std::move(pause));
    }

    const QueueNode* find(const std::string& name) const {
        for (const QueueNode& n : model_.nodes) {
            if (n.text() == name) {
                return &n;
            }
        }
        return nullptr;
    }

    std::optional<std::size_t> node_at(const lang::Path& path) {
        const QueueNode* found = path.steps.size() == 1 ? find(path.steps[0].text) : nullptr;
        if (found == nullptr) {
            teller_.error("unknown-name", path.span,
                          "there is no node " + lang::to_text(path) + " in this queue",
                          "declare it: station " + lang::to_text(path) + " serves 1 s, or sink " +
                              lang::to_text(path));
            return std::nullopt;
        }
        return static_cast<std::size_t>(found - model_.nodes.data());
    }

    void route(const lang::Property& p) {
        const lang::Property flat = one_line(p, is_assignment);
        Line line(flat, teller_);
        line.symbol("->");
        const Expr* target = line.value("the name of a node");
        if (target == nullptr) {
            return;
        }
        Route made;
        made.span = p.span;
        const auto from = node_at(p.name);
        bool good = from.has_value();
        made.from = from.value_or(0);
        const auto add = [&](const Expr& e) {
            if (e.kind != ExprKind::kPath) {
                teller_.error("syntax", e.span, "the name of a node is wanted here",
                              "write FROM -> TO");
                good = false;
                return;
            }
            const auto to = node_at(e.path);
            good = good && to.has_value();
            made.to.push_back(to.value_or(0));
        };
        if (target->kind == ExprKind::kCall && lang::to_text(target->path) == "shortest") {
            for (const lang::Argument& a : target->args) {
                add(a.value);
            }
        } else {
            add(*target);
        }
        made.caption = line.caption();
        while (!line.done()) {
            if (line.word("probability")) {
                take(line, "a number from 0 to 1", made.probability);
            } else if (line.word("when")) {
                take(line, "a condition", made.when);
            } else if (line.word("takes")) {
                take(line, "a time", made.takes);
            } else if (line.word("does")) {
                take(line, "a movement", made.does);
            } else if (line.word("on")) {
                reason(line, made);
            } else {
                line.finish(kRouteForm);
            }
        }
        for (const lang::Property& child : flat.children) {
            if (child.values.size() == 2) {
                made.sets.push_back(make_assignment(child.name, child.values[1]));
            } else {
                teller_.error("syntax", child.span, "one value is wanted", "write kind := vip");
            }
        }
        if (good && !made.to.empty()) {
            model_.routes.push_back(std::move(made));
        }
    }

    void reason(Line& line, Route& made) {
        if (line.word("full")) {
            made.on = RouteOn::kFull;
        } else if (line.word("balking")) {
            made.on = RouteOn::kBalking;
        } else if (line.word("impatience")) {
            made.on = RouteOn::kImpatient;
        } else if (line.word("jockeying")) {
            made.on = RouteOn::kJockeying;
        } else {
            teller_.error("syntax", line.span(), "on which occasion?",
                          "write on full, on balking, on impatience or on jockeying");
            line.value("an occasion");
        }
    }

    const lang::Block& block_;
    const lang::File& file_;
    Teller& teller_;
    QueueModel model_;
};

}  // namespace

QueueModel read_queue(const lang::Block& block, const lang::File& file, Teller& teller) {
    return Reader(block, file, teller).read();
}

}  // namespace puppetri::notation
