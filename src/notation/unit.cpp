// SPDX-License-Identifier: MIT
// Event units (D. Kalra and A. H. Barr, "Modeling with Time and Events in Computer Animation",
// Computer Graphics Forum 11(3), 1992): primitives with a beginning and an end, put together in
// hierarchies. A unit becomes a *piece*: the arcs that begin it and the arcs that are possible when
// it has ended. A sequence joins the end of one piece to the beginning of the next by one
// transition; pieces side by side need none at all, their arcs add. What is cut is emptied by arcs
// `all now`.
#include <set>
#include <string>

#include "kinds.h"
#include "line.h"
#include "make.h"
#include "pieces.h"

namespace puppetri::notation {
namespace {

using lang::ArcKind;
using lang::Expr;
using lang::ExprKind;
using lang::Path;
using lang::Property;
using lang::Span;

constexpr std::string_view kForms =
    "does MOVEMENT takes TIME, runs NET, wait TIME, await EVENT, raise EVENT, set DATUM := VALUE, "
    "or sequence, parallel, race, choice, repeat, until, interrupt with { ... }";

using Unit = Labelled;  // one line of the block

class Units : Pieces {
 public:
    Units(const lang::Block& block, const lang::File& file, Lowered& out)
        : Pieces(out.net.body), block_(block), teller_(block, file, out) {}

    void lower() {
        for (const Property& p : block_.properties) {
            reserve(p);
            depth_of(p, 0);
        }
        const Span where = block_.span;
        Piece all = row(block_.properties, "", where, 0);
        lang::Place begin = make_place(make_name("begin", block_.name.span));
        begin.is_public = true;
        begin.role = lang::Role::kStart;
        give_token(begin);
        body_.places.push_back(std::move(begin));
        lang::Place done = make_place(make_name("done", block_.name.span));
        done.is_public = true;
        done.role = lang::Role::kFinish;
        body_.places.push_back(std::move(done));
        if (all.begins.empty()) {
            teller_.error("empty-unit", block_.name.span, "there is nothing to do in this unit",
                          "write at least one line such as: does ana.wave()");
            return;
        }
        lang::Transition start = join("start", {"begin"}, block_.name.span);
        begin_piece(start, all);
        body_.transitions.push_back(std::move(start));
        if (!all.never_ends) {
            body_.transitions.push_back(join("finish", all.ends, block_.name.span, {"done"}));
        }
    }

 private:
    // Labels are kept from names that are made.
    void reserve(const Property& p) {
        const Unit u = read_labelled(p);
        if (!u.label.empty() && !taken_.insert(u.label).second) {
            teller_.error("name-twice", p.span, "there is already a unit " + u.label,
                          "choose another name");
        }
        for (const Property& child : p.children) {
            reserve(child);
        }
    }

    void depth_of(const Property& p, int depth) {
        depth_ = std::max(depth_, depth);
        for (const Property& child : p.children) {
            depth_of(child, depth + 1);
        }
    }

    // The label, or `wanted`, with a number where that is taken.
    std::string name_of(const Unit& u, const std::string& wanted) {
        if (!u.label.empty()) {
            return u.label;
        }
        std::string name = wanted;
        for (int i = 2; !taken_.insert(name).second; ++i) {
            name = wanted + "_" + std::to_string(i);
        }
        return name;
    }

    // -- reading
    std::vector<Path> events(Line& line) {
        std::vector<Path> out;
        const Expr* e = line.value("the name of an event");
        if (e != nullptr && !paths_of(*e, lang::Op::kOr, out)) {
            teller_.error("syntax", e->span, "events are wanted here", "write EVENT or EVENT");
        }
        return out;
    }

    Piece unit(const Property& p, int depth) {
        const Unit u = read_labelled(p);
        if (p.name.steps.size() != 1 || u.word.empty()) {
            return unknown(p);
        }
        using Make = Piece (Units::*)(const Unit&, Line&, int);
        static constexpr std::pair<std::string_view, Make> kWords[] = {
            {"does", &Units::activity},      {"runs", &Units::activity},
            {"wait", &Units::activity},      {"await", &Units::await},
            {"raise", &Units::moment},       {"set", &Units::moment},
            {"sequence", &Units::nested},    {"parallel", &Units::parallel},
            {"race", &Units::race},          {"choice", &Units::choice},
            {"repeat", &Units::repeat},      {"until", &Units::interrupt},
            {"interrupt", &Units::interrupt}};
        for (const auto& [word, make] : kWords) {
            if (word == u.word) {
                Line line(p, teller_, u.first);
                Piece made = (this->*make)(u, line, depth);
                line.finish(kForms);
                return made;
            }
        }
        return unknown(p);
    }

    Piece unknown(const Property& p) {
        teller_.error("unknown-unit", p.name.span,
                      lang::to_text(p.name) + " is no kind of event unit",
                      "write " + std::string(kForms) + "; a name goes before it: NAME: does ...");
        return {};
    }

    // -- leaves: does, runs, wait
    Piece activity(const Unit& u, Line& line, int) {
        const Property& p = *u.property;
        const Expr* what = line.value(u.word == "does"   ? "a movement"
                                      : u.word == "runs" ? "a net"
                                                         : "a time");
        Piece out;
        if (what == nullptr) {
            return out;
        }
        std::string wanted = u.word;
        if (u.word != "wait" && (what->kind == ExprKind::kCall || what->kind == ExprKind::kPath)) {
            wanted.clear();
            for (const lang::Name& step : what->path.steps) {
                wanted += (wanted.empty() ? "" : "_") + step.text;
            }
        }
        out.name = name_of(u, wanted);
        lang::Place made = make_place(make_name(out.name, p.span));
        made.is_public = true;
        made.caption = u.caption;
        if (u.word == "does") {
            made.does = *what;
        } else if (u.word == "runs") {
            made.runs = *what;
        } else {
            made.takes = make_duration(*what);
        }
        while (!line.done()) {
            if (u.word == "does" && line.word("takes")) {
                if (const Expr* e = line.value("a time")) {
                    made.takes = make_duration(*e);
                }
            } else {
                line.finish("does MOVEMENT takes TIME, runs NET, or wait TIME");
            }
        }
        const Expr& time = made.takes.value;
        out.takes_time = !(time.kind == ExprKind::kNumber && time.number == Rational{0});
        body_.places.push_back(std::move(made));
        out.begins = out.ends = out.places = {out.name};
        return out;
    }

    Piece await(const Unit& u, Line& line, int) {
        Piece out;
        const std::vector<Path> list = events(line);
        if (list.empty()) {
            return out;
        }
        const Span where = u.property->span;
        out.name = name_of(u, "await_" + list[0].steps.back().text);
        place(out, out.name, where, true);
        body_.places.back().caption = u.caption;
        place(out, out.name + "_heard", where);
        lang::Transition t = join(out.name + "_hears", {out.name}, where, {out.name + "_heard"});
        t.events = list;
        t.next_event = true;
        body_.transitions.push_back(std::move(t));
        out.begins = {out.name};
        out.ends = {out.name + "_heard"};
        out.takes_time = true;
        return out;
    }

    // What takes no time: raise, set.
    Piece moment(const Unit& u, Line& line, int) {
        const Span where = u.property->span;
        Piece out;
        lang::Transition t;
        if (u.word == "raise") {
            const Path* event = line.path("the name of an event");
            if (event == nullptr) {
                return out;
            }
            out.name = name_of(u, "raise_" + event->steps.back().text);
            t = join(out.name + "_now", {out.name}, where, {out.name + "_done"});
            t.raises.push_back(*event);
        } else {
            const Path* datum = line.path("the name of a datum");
            if (datum == nullptr) {
                return out;
            }
            out.name = name_of(u, "set_" + datum->steps.back().text);
            t = join(out.name + "_now", {out.name}, where, {out.name + "_done"});
            if (!line.symbol(":=")) {
                teller_.error("syntax", where, "`:=` is wanted", "write set DATUM := VALUE");
                return {};
            }
            if (const Expr* e = line.value("a value")) {
                t.assignments.push_back(make_assignment(*datum, *e));
            }
        }
        place(out, out.name, where, true);
        place(out, out.name + "_done", where);
        body_.transitions.push_back(std::move(t));
        out.begins = {out.name};
        out.ends = {out.name + "_done"};
        return out;
    }

    // -- what is made of others
    // One after the other.
    Piece row(const std::vector<Property>& lines, const std::string& name, Span where, int depth) {
        Piece out;
        out.name = name;
        const Piece* before = nullptr;
        Piece last;
        for (const Property& p : lines) {
            if (depth == 0 && p.name.steps[0].text == "data" && read_labelled(p).label.empty()) {
                datum(p);
                continue;
            }
            Piece next = unit(p, depth);
            if (next.begins.empty()) {
                continue;
            }
            absorb(out, next);
            out.takes_time = out.takes_time || next.takes_time;
            if (before == nullptr) {
                out.begins = next.begins;
                out.left = next.left;
                out.rounds = next.rounds;
            } else if (last.never_ends) {
                teller_.error("never-reached", p.span,
                              "the unit before goes on for ever, so this never begins",
                              "put that into until EVENT { ... }, or write repeat NUMBER");
            } else {
                lang::Transition t = join(last.name + "_to_" + next.name, last.ends, p.span);
                begin_piece(t, next);
                body_.transitions.push_back(std::move(t));
            }
            out.never_ends = out.never_ends || next.never_ends;
            last = std::move(next);
            before = &last;
        }
        out.ends = last.ends;
        if (before == nullptr && depth > 0) {
            teller_.error("empty-unit", where, "there is nothing to do in this unit",
                          "write at least one line between its braces");
        }
        return out;
    }

    // data NAME TYPE starts VALUE
    void datum(const Property& p) {
        Line line(p, teller_);
        const Path* name = line.path("a name");
        const Expr* type = name != nullptr ? line.value("a type, such as 0 .. 5 or bool") : nullptr;
        if (type == nullptr) {
            return;
        }
        lang::Data made;
        made.name = name->steps[0];
        made.is_public = true;
        made.type = *type;
        made.span = p.span;
        line.clause("starts", "a value", made.initial);
        line.finish("data NAME TYPE starts VALUE");
        body_.data.push_back(std::move(made));
    }

    Piece nested(const Unit& u, Line&, int depth) {
        Piece out = row(u.property->children, name_of(u, u.word), u.property->span, depth + 1);
        name_state(out, u.caption, u.property->span);
        return out;
    }

    Piece parallel(const Unit& u, Line&, int depth) {
        Piece out;
        out.name = name_of(u, u.word);
        lang::Transition split;
        std::vector<Piece> parts = parts_of(u, depth);
        bool weighted = false;
        for (const Piece& part : parts) {
            weighted = weighted || !part.left.empty();
        }
        if (weighted) {  // arcs with weights cannot be added: a transition begins all
            place(out, out.name + "_begins", u.property->span);
            out.begins = {out.name + "_begins"};
            split = join(out.name + "_parts", out.begins, u.property->span);
        }
        for (const Piece& part : parts) {
            if (weighted) {
                begin_piece(split, part);
            } else {
                out.begins.insert(out.begins.end(), part.begins.begin(), part.begins.end());
            }
            out.ends.insert(out.ends.end(), part.ends.begin(), part.ends.end());
            absorb(out, part);
            out.never_ends = out.never_ends || part.never_ends;
            out.takes_time = out.takes_time || part.takes_time;
        }
        if (weighted) {
            body_.transitions.push_back(std::move(split));
        }
        name_state(out, u.caption, u.property->span);
        return out;
    }

    std::vector<Piece> parts_of(const Unit& u, int depth) {
        std::vector<Piece> parts;
        for (const Property& child : u.property->children) {
            parts.push_back(unit(child, depth + 1));
            if (parts.back().begins.empty()) {
                parts.pop_back();
            }
        }
        if (parts.empty()) {
            teller_.error("empty-unit", u.property->span, "there is nothing to do in this unit",
                          "write at least one line between its braces");
        }
        return parts;
    }

    // The first that ends cuts the others.
    Piece race(const Unit& u, Line&, int depth) {
        const Span where = u.property->span;
        Piece out;
        out.name = name_of(u, u.word);
        const std::vector<Piece> parts = parts_of(u, depth);
        const std::string on = place(out, out.name + "_on", where);
        const std::string over = out.name + "_over";
        lang::Transition begin = join(out.name + "_parts", {out.name + "_begins"}, where, {on});
        out.never_ends = true;
        out.takes_time = !parts.empty();
        for (const Piece& part : parts) {
            begin_piece(begin, part);
            out.takes_time = out.takes_time && part.takes_time;
            if (part.never_ends) {
                continue;
            }
            out.never_ends = false;
            std::vector<std::string> from = {on};
            from.insert(from.end(), part.ends.begin(), part.ends.end());
            lang::Transition wins = join(part.name + "_wins", from, where, {over});
            for (const Piece& other : parts) {
                empty_piece(wins, other, part.ends);
            }
            body_.transitions.push_back(std::move(wins));
        }
        for (const Piece& part : parts) {
            absorb(out, part);
        }
        place(out, out.name + "_begins", where);
        place(out, over, where);
        body_.transitions.push_back(std::move(begin));
        out.begins = {out.name + "_begins"};
        out.ends = {over};
        name_state(out, u.caption, u.property->span);
        return out;
    }

    // choice { option when C odds W on E after D { ... }  otherwise { ... } }
    Piece choice(const Unit& u, Line&, int depth) {
        const Span where = u.property->span;
        Piece out;
        out.name = name_of(u, u.word);
        const std::string at = place(out, out.name + "_chooses", where, true);
        const std::string over = place(out, out.name + "_over", where);
        out.never_ends = true;
        out.takes_time = true;
        Expr any;  // of the conditions
        int number = 0;
        bool free = false;
        for (const Property& child : u.property->children) {
            Unit option = read_labelled(child);
            if (option.word != "option" && option.word != "otherwise") {
                teller_.error("syntax", child.span, "a choice is made between options",
                              "write option { ... }, or option when CONDITION odds NUMBER on "
                              "EVENT after TIME { ... }");
                continue;
            }
            ++number;
            const std::string name = option.label.empty()
                                         ? name_of(option, out.name + "_" + std::to_string(number))
                                         : option.label;
            Line line(child, teller_, option.first);
            lang::Transition t = join(out.name + "_takes_" + name, {at}, child.span);
            t.caption = option.caption;
            bool waits = false;
            while (!line.done()) {
                if (option.word == "option" && line.word("when")) {
                    if (const Expr* e = line.value("a condition")) {
                        t.guard = *e;
                    }
                } else if (option.word == "option" && line.word("odds")) {
                    if (const Expr* e = line.value("a number above 0")) {
                        t.odds = *e;
                    }
                } else if (option.word == "option" && line.word("on")) {
                    t.events = events(line);
                    t.next_event = waits = true;
                } else if (option.word == "option" && line.word("after")) {
                    if (const Expr* e = line.value("a time")) {
                        t.delay = *e;
                        waits = true;
                    }
                } else {
                    line.finish("option when CONDITION odds NUMBER on EVENT after TIME { ... }");
                }
            }
            if (option.word == "otherwise") {
                if (!any || free) {
                    teller_.error("never-reached", child.span,
                                  "this is never chosen: an option before it is always possible",
                                  "give every option before it a condition: option when ...");
                } else {
                    t.guard = make_unary(lang::Op::kNot, any);
                }
            } else if (!waits) {
                if (t.guard) {
                    any = any ? make_binary(lang::Op::kOr, std::move(any), t.guard) : t.guard;
                } else {
                    free = true;
                }
            }
            Piece part = row(child.children, name, child.span, depth + 1);
            if (part.begins.empty()) {
                continue;
            }
            begin_piece(t, part);
            body_.transitions.push_back(std::move(t));
            absorb(out, part);
            out.takes_time = out.takes_time && (part.takes_time || waits);
            if (!part.never_ends) {
                out.never_ends = false;
                body_.transitions.push_back(
                    join(name + "_chosen_ends", part.ends, child.span, {over}));
            }
            option.label = name;
            name_state(part, option.caption, child.span);
        }
        out.begins = {at};
        out.ends = {over};
        if (number == 0) {
            teller_.error("empty-unit", where, "there is nothing to choose from",
                          "write at least one option { ... }");
            return {};
        }
        name_state(out, u.caption, u.property->span);
        return out;
    }

    // repeat 3 { }, repeat { }, repeat until EVENT { }
    Piece repeat(const Unit& u, Line& line, int depth) {
        const Span where = u.property->span;
        Piece out;
        out.name = name_of(u, u.word);
        std::vector<Path> end;
        Expr times;
        if (line.word("until")) {
            end = events(line);
        } else if (!line.done()) {
            if (const Expr* e = line.value("a number")) {
                times = *e;
            }
            if (times.kind == ExprKind::kNumber &&
                (times.number.numerator < 1 || !times.number.whole())) {
                teller_.error("out-of-range", times.span, "a unit is repeated once or more",
                              "write a whole number from 1, or nothing: for ever");
            }
        }
        const Piece part = row(u.property->children, out.name + "_round", where, depth + 1);
        if (part.begins.empty()) {
            return {};
        }
        if (part.never_ends) {
            teller_.error("never-reached", where, "a round of this goes on for ever",
                          "leave repeat out, or let the round end");
        }
        absorb(out, part);
        out.takes_time = part.takes_time;
        if (!times && !part.takes_time) {
            teller_.error("zero-time-loop", where, "a round of this may take no time at all",
                          "put a wait TIME into it, or a movement");
        }
        if (times) {
            const std::string next = place(out, out.name + "_next", where);
            const std::string left = place(out, out.name + "_left", where);
            const std::string over = place(out, out.name + "_over", where);
            lang::Transition round = join(out.name + "_begins_round", {next, left}, where);
            begin_piece(round, part);
            body_.transitions.push_back(std::move(round));
            body_.transitions.push_back(join(out.name + "_ends_round", part.ends, where, {next}));
            lang::Transition ends = join(out.name + "_ends", {next}, where, {over});
            ends.tests.push_back(make_arc(ArcKind::kUnless, make_path(left, where)));
            body_.transitions.push_back(std::move(ends));
            out.begins = {next, left};
            out.left = left;
            out.rounds = times;
            out.ends = {over};
        } else if (end.empty()) {
            lang::Transition again = join(out.name + "_again", part.ends, where);
            begin_piece(again, part);
            body_.transitions.push_back(std::move(again));
            out.begins = part.begins;
            out.left = part.left;
            out.rounds = part.rounds;
            out.never_ends = true;
        } else {
            const std::string next = place(out, out.name + "_next", where);
            const std::string open = place(out, out.name + "_open", where);
            const std::string asked = place(out, out.name + "_asked", where);
            const std::string over = place(out, out.name + "_over", where);
            lang::Transition begin = join(out.name + "_begins_round", {next}, where);
            begin.tests.push_back(make_arc(ArcKind::kWith, make_path(open, where)));
            begin_piece(begin, part);
            body_.transitions.push_back(std::move(begin));
            lang::Transition hears = join(out.name + "_hears", {open}, where, {asked});
            hears.events = end;
            hears.next_event = true;
            hears.priority = make_number(Rational{2 + depth_ - depth}, where);
            body_.transitions.push_back(std::move(hears));
            body_.transitions.push_back(join(out.name + "_ends_round", part.ends, where, {next}));
            body_.transitions.push_back(join(out.name + "_ends", {next, asked}, where, {over}));
            out.begins = {next, open};
            out.ends = {over};
        }
        name_state(out, u.caption, u.property->span);
        return out;
    }

    // until EVENT { ... }, until after TIME { ... }, and
    // interrupt { ...  on EVENT { ... }  on EVENT again { ... }  after TIME { ... } }.
    // Outer cuts go before inner ones and before anything that waits inside; a time that is over
    // cuts when nothing else can happen at that instant.
    Piece interrupt(const Unit& u, Line& line, int depth) {
        const Span where = u.property->span;
        Piece out;
        out.name = name_of(u, u.word);
        const std::string on = place(out, out.name + "_on", where);
        const std::string over = place(out, out.name + "_over", where);
        std::vector<Property> body;
        std::vector<const Property*> cases;
        for (const Property& child : u.property->children) {
            const std::string& word = child.name.steps[0].text;
            if (u.word == "interrupt" && read_labelled(child).label.empty() &&
                (word == "on" || word == "after")) {
                cases.push_back(&child);
            } else {
                body.push_back(child);
            }
        }
        const Piece part = row(body, out.name + "_body", where, depth + 1);
        if (part.begins.empty()) {
            return {};
        }
        absorb(out, part);
        out.never_ends = true;
        if (!part.never_ends) {
            out.never_ends = false;
            std::vector<std::string> from = {on};
            from.insert(from.end(), part.ends.begin(), part.ends.end());
            body_.transitions.push_back(join(out.name + "_ends", from, where, {over}));
        }
        out.takes_time = part.takes_time;
        const auto cut = [&](const std::string& name, Line& l, bool timed, Span at) {
            lang::Transition t = join(name, {on}, at);
            if (timed) {
                if (const Expr* e = l.value("a time")) {
                    t.delay = *e;
                }
                t.priority = make_number(Rational{-depth}, at);
            } else {
                t.events = events(l);
                t.next_event = true;
                t.priority = make_number(Rational{2 + depth_ - depth}, at);
            }
            empty_piece(t, part);
            return t;
        };
        if (u.word == "until") {
            const bool timed = line.word("after");
            lang::Transition t = cut(out.name + "_cut", line, timed, where);
            t.outputs.push_back(make_arc(ArcKind::kGive, make_path(over, where)));
            body_.transitions.push_back(std::move(t));
            out.never_ends = false;
        }
        int number = 0;
        for (const Property* c : cases) {
            const std::string name =
                out.name + "_cut" + (++number == 1 ? "" : "_" + std::to_string(number));
            Line l(*c, teller_);
            lang::Transition t = cut(name, l, c->name.steps[0].text == "after", c->span);
            const bool again = l.word("again");
            l.finish("on EVENT { ... }, on EVENT again { ... }, or after TIME { ... }");
            Piece instead;
            if (c->has_children && !c->children.empty()) {
                instead = row(c->children, name + "_instead", c->span, depth + 1);
                absorb(out, instead);
            }
            lang::Transition back = again ? join(name + "_again", instead.ends, c->span, {on})
                                          : join(name + "_ends", instead.ends, c->span, {over});
            if (again) {
                begin_piece(back, part);
            } else if (!instead.never_ends) {
                out.never_ends = false;
            }
            if (instead.begins.empty()) {
                t.outputs.insert(t.outputs.end(), back.outputs.begin(), back.outputs.end());
            } else {
                begin_piece(t, instead);
                if (!instead.never_ends) {
                    body_.transitions.push_back(std::move(back));
                }
            }
            body_.transitions.push_back(std::move(t));
        }
        if (u.word == "interrupt" && cases.empty()) {
            teller_.error("syntax", where, "nothing interrupts this",
                          "add a line such as: on EVENT { ... }");
        }
        // One transition begins the marker and the body.
        lang::Transition begin = join(out.name + "_begins", {out.name + "_first"}, where, {on});
        begin_piece(begin, part);
        place(out, out.name + "_first", where);
        body_.transitions.push_back(std::move(begin));
        out.begins = {out.name + "_first"};
        out.ends = {over};
        name_state(out, u.caption, u.property->span);
        return out;
    }

    const lang::Block& block_;
    Teller teller_;
    std::set<std::string> taken_ = {"begin", "done", "start", "finish"};
    int depth_ = 0;
};

}  // namespace

void lower_unit(const lang::Block& block, const lang::File& file, Lowered& out) {
    Units(block, file, out).lower();
}

}  // namespace puppetri::notation
