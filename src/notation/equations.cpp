// SPDX-License-Identifier: MIT
#include "puppetri/notation/equations.h"

#include <utility>

#include "kinds.h"
#include "line.h"
#include "make.h"

namespace puppetri::notation {
namespace {

using lang::Expr;
using lang::ExprKind;
using lang::Op;

constexpr const char* kForms =
    "one of `x starts at 1 m`, `x.rate = v`, `x.next = 2*x every 0.1 s`, `x.before = 1 m`, "
    "`name = x + y`, `event hit when x falls through 0 m`, `sensor high when x > 1 m`, "
    "`on hit set x := 0 m`, `while PLACE`, `ball.position = (0 m, x, 0 m)`, `solver stiff`, "
    "`solver stiff by sundials`, `baked \"x.courses\"`, `tolerance 1e-6`, `steps at most 10 ms`";

bool is_word(const Expr& e, std::string_view text) {
    return e.kind == ExprKind::kPath && e.path.steps.size() == 1 && e.path.steps[0].text == text &&
           e.path.steps[0].index.empty();
}

// `at -1 m` reads as a difference, `at - 1 m`: takes the word from its beginning and leaves what
// was meant. Gives   whether the word was there.
bool split_word(Expr& e, std::string_view word) {
    if (e.kind != ExprKind::kBinary || e.args.empty()) {
        return false;
    }
    Expr& first = e.args[0].value;
    if (!is_word(first, word)) {
        const bool found = split_word(first, word);
        e.span.begin = found ? first.span.begin : e.span.begin;
        return found;
    }
    if ((e.op != Op::kSubtract && e.op != Op::kAdd) || e.args.size() < 2) {
        return false;
    }
    Expr second = std::move(e.args[1].value);
    if (e.op == Op::kSubtract) {
        lang::Span span = second.span;
        second = make_unary(Op::kNegate, std::move(second));
        second.span = span;
    }
    if (e.args.size() == 2) {
        e = std::move(second);
    } else {
        e.args.erase(e.args.begin());
        e.args[0].value = std::move(second);
    }
    return true;
}

class Reader {
 public:
    Reader(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out) {}

    EquationLines read() {
        for (const lang::Property& p : block_.properties) {
            if (p.has_children) {
                wrong(p.span);
                continue;
            }
            values_ = p.values;
            at_ = 0;
            property_ = &p;
            statement(p);
        }
        return std::move(lines_);
    }

 private:
    void wrong(lang::Span where) {
        teller_.error("syntax", where, "this is no line of a block of equations",
                      std::string("write ") + kForms);
    }
    void wrong() { wrong(at_ < values_.size() ? values_[at_].span : property_->span); }

    bool word(std::string_view text) {
        if (at_ < values_.size() && is_word(values_[at_], text)) {
            ++at_;
            return true;
        }
        return at_ < values_.size() && split_word(values_[at_], text);
    }
    bool symbol(std::string_view text) {
        const bool found = at_ < values_.size() && values_[at_].kind == ExprKind::kSymbol &&
                           values_[at_].text == text;
        at_ += found ? 1 : 0;
        return found;
    }
    std::optional<lang::Name> name() {
        if (at_ < values_.size() && values_[at_].kind == ExprKind::kPath &&
            values_[at_].path.steps.size() == 1) {
            return values_[at_++].path.steps[0];
        }
        return std::nullopt;
    }
    std::optional<lang::Path> path() {
        if (at_ < values_.size() && values_[at_].kind == ExprKind::kPath) {
            return values_[at_++].path;
        }
        return std::nullopt;
    }
    lang::Caption caption() {
        if (at_ < values_.size() && values_[at_].kind == ExprKind::kString) {
            const Expr& e = values_[at_++];
            return {e.text, e.span};
        }
        return {};
    }
    std::optional<Expr> value() {
        if (at_ < values_.size() && values_[at_].kind != ExprKind::kSymbol) {
            return values_[at_++];
        }
        return std::nullopt;
    }
    // Whether everything has been read; tells it otherwise.
    bool end(bool good) {
        if (good && at_ == values_.size()) {
            return true;
        }
        wrong();
        return false;
    }

    void statement(const lang::Property& p) {
        const auto& steps = p.name.steps;
        const std::string& first = steps[0].text;
        if (steps.size() == 1 && keyword(p, first)) {
            return;
        }
        if (symbol("=")) {
            formula(p);
            return;
        }
        // h starts at 2 m
        const lang::Caption ignored = caption();
        const bool starts = steps.size() == 1 && word("starts") && word("at");
        const std::optional<Expr> at = starts ? value() : std::nullopt;
        if (end(at.has_value())) {
            lines_.variables.push_back({steps[0], *at, p.span});
        }
    }

    void formula(const lang::Property& p) {
        const auto& steps = p.name.steps;
        const std::optional<Expr> right = value();
        const std::string last = steps.size() == 2 ? steps[1].text : "";
        if (right && last == "next") {
            const std::optional<Expr> every = word("every") ? value() : std::nullopt;
            if (end(every.has_value())) {
                lines_.nexts.push_back({steps[0], *right, *every, p.span});
            }
            return;
        }
        if (!end(right.has_value())) {
            return;
        }
        if (steps.size() == 1) {
            lines_.locals.push_back({steps[0], *right, p.span});
        } else if (last == "rate") {
            lines_.rates.push_back({steps[0], *right, p.span});
        } else if (last == "before") {
            lines_.befores.push_back({steps[0], *right, p.span});
        } else {
            lines_.driven.push_back({p.name, *right, p.span});
        }
    }

    bool keyword(const lang::Property& p, const std::string& first) {
        if (values_.empty() || values_[0].kind == ExprKind::kSymbol ||
            is_word(values_[0], "starts")) {
            return false;
        }
        if (first == "event") {
            event(p);
        } else if (first == "sensor") {
            sensor(p);
        } else if (first == "on") {
            const auto transition = path();
            const bool set = transition && word("set");
            const auto variable = set ? name() : std::nullopt;
            const auto right = variable && symbol(":=") ? value() : std::nullopt;
            if (end(right.has_value())) {
                lines_.resets.push_back({*transition, *variable, *right, p.span});
            }
        } else if (first == "while") {
            places(values_[0]);
            ++at_;
            end(true);
        } else if (first == "solver") {
            lines_.stiff = word("stiff");
            lines_.by_sundials = word("by") && word("sundials");
            lines_.solver_span = p.span;
            end(lines_.stiff);
        } else if (first == "baked") {
            const auto file = value();
            if (end(file && file->kind == ExprKind::kString)) {
                lines_.baked = *file;
            }
        } else if (first == "tolerance") {
            const auto size = value();
            if (end(size.has_value())) {
                lines_.tolerance = *size;
            }
        } else if (first == "steps") {
            const auto most = word("at") && word("most") ? value() : std::nullopt;
            if (end(most.has_value())) {
                lines_.longest_step = *most;
            }
        } else {
            return false;
        }
        return true;
    }

    void event(const lang::Property& p) {
        EquationLines::Event made;
        const auto called = name();
        made.caption = caption();
        const auto quantity = called && word("when") ? value() : std::nullopt;
        bool good = quantity.has_value();
        if (good && word("rises")) {
            made.direction = EquationLines::Direction::kRises;
        } else if (good && word("passes")) {
            made.direction = EquationLines::Direction::kPasses;
        } else {
            good = good && word("falls");
        }
        const auto threshold = good && word("through") ? value() : std::nullopt;
        if (end(threshold.has_value())) {
            made.name = *called;
            made.quantity = *quantity;
            made.threshold = *threshold;
            made.span = p.span;
            lines_.events.push_back(std::move(made));
        }
    }

    void sensor(const lang::Property& p) {
        const auto called = name();
        const lang::Caption text = caption();
        const auto condition = called && word("when") ? value() : std::nullopt;
        if (!end(condition.has_value())) {
            return;
        }
        const bool greater = condition->op == Op::kGreater || condition->op == Op::kGreaterEqual;
        const bool less = condition->op == Op::kLess || condition->op == Op::kLessEqual;
        if (condition->kind != ExprKind::kBinary || (!greater && !less)) {
            teller_.error("syntax", condition->span, "a sensor compares two quantities",
                          "write one such as `h > 1 m`");
            return;
        }
        lines_.sensors.push_back({*called, text, condition->args[greater ? 0 : 1].value,
                                  condition->args[greater ? 1 : 0].value, p.span});
    }

    void places(const Expr& e) {
        if (e.kind == ExprKind::kPath) {
            lines_.enabled_by.push_back(e.path);
        } else if (e.kind == ExprKind::kBinary && e.op == Op::kOr) {
            for (const lang::Argument& a : e.args) {
                places(a.value);
            }
        } else {
            teller_.error("syntax", e.span, "this is no place",
                          "write `while PLACE`, or `while PLACE or PLACE`");
        }
    }

    const lang::Block& block_;
    Teller teller_;
    EquationLines lines_;
    std::vector<Expr> values_;
    std::size_t at_ = 0;
    const lang::Property* property_ = nullptr;
};

}  // namespace

EquationLines read_equations(const lang::Block& block, const lang::File& file, Lowered& out) {
    return Reader(block, file, out).read();
}

void lower_equations(const lang::Block& block, const lang::File& file, Lowered& out) {
    const EquationLines lines = read_equations(block, file, out);
    const auto add_event = [&](const lang::Name& name, const lang::Caption& caption,
                               lang::Span span) {
        lang::Event event;
        event.name = name;
        event.caption = caption;
        event.is_public = true;
        event.span = span;
        out.net.body.events.push_back(std::move(event));
    };
    for (const EquationLines::Event& e : lines.events) {
        add_event(e.name, e.caption, e.span);
    }
    for (const EquationLines::Sensor& s : lines.sensors) {
        lang::Data datum;
        datum.name = s.name;
        datum.caption = s.caption;
        datum.is_public = true;
        datum.type = make_reference("bool", s.span);
        datum.span = s.span;
        out.net.body.data.push_back(std::move(datum));
        for (const std::string_view suffix : {kSensorBegins, kSensorEnds}) {
            add_event(make_name(s.name.text + std::string(suffix), s.name.span), {}, s.span);
        }
    }
}

}  // namespace puppetri::notation
