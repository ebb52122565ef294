// SPDX-License-Identifier: MIT
// Programs of Linda's processes as nets. Each operation is a place in which the process's token
// waits, and the transitions out of it; what a line leaves open, the next one goes on from. The
// variables in scope are attributes of the token: a transition binds all of them, as `its x`, and
// gives them to the token that goes on.
#include <algorithm>

#include "linda.h"
#include "literal.h"
#include "make.h"

namespace puppetri::notation {

using lang::Arc;
using lang::ArcKind;
using lang::Expr;
using lang::ExprKind;
using lang::Property;
using lang::Span;

namespace {

constexpr std::string_view kForms =
    "out TUPLE, in TUPLE, rd TUPLE, inp TUPLE { ... }, rdp TUPLE { ... }, else { ... }, eval "
    "PROCESS, does MOVEMENT takes TIME, wait TIME, await EVENT, raise EVENT, let NAME: TYPE := "
    "VALUE, if CONDITION { ... }, while CONDITION { ... }, repeat NUMBER { ... }, or return VALUE";

std::string its(const std::string& variable) { return "its " + variable; }
std::string got(const std::string& variable) { return "got " + variable; }

bool is_else(const Property& p) {
    return p.name.steps.size() == 1 && p.name.steps[0].text == "else" && p.values.empty();
}

// get(x), get(x: TYPE)
struct Formal {
    std::string name;  // empty: no formal
    Expr type;
};
Formal formal_of(const Expr& e) {
    if (e.kind != ExprKind::kCall || e.path.steps.size() != 1 || e.path.steps[0].text != "get" ||
        e.args.size() != 1) {
        return {};
    }
    const lang::Argument& a = e.args[0];
    return a.name.text.empty() ? Formal{std::string(word_of(a.value)), {}}
                               : Formal{a.name.text, a.value};
}

// Whether its first step is the name of a value, not of a function.
bool names_value(const Expr& e) {
    return !e.path.empty() && (e.kind != ExprKind::kCall || e.path.steps.size() > 1);
}

// The expression with `change` done to each part that names a value; inner parts first.
template <class Change>
Expr changed(Expr e, const Change& change) {
    for (lang::Argument& a : e.args) {
        a.value = changed(std::move(a.value), change);
    }
    for (lang::Name& step : e.path.steps) {
        for (Expr& index : step.index) {
            index = changed(std::move(index), change);
        }
    }
    if (names_value(e)) {
        change(e);
    }
    return e;
}

}  // namespace

LindaProgram::LindaProgram(Linda& space, std::size_t number)
    : space_(space),
      number_(number),
      name_(space.made_.instances[number].name),
      fixed_(space.made_.instances[number].fixed),
      becomes_(space.made_.instances[number].becomes),
      variables_(space.made_.instances[number].carried) {}

void LindaProgram::write() {
    const LindaInstance& instance = space_.made_.instances[number_];
    const Property& program = *space_.programs_[instance.program].property;
    const Span where = program.span;
    const std::size_t before = space_.made_.places.size();
    const std::string begin = name_ + "_begin";
    lang::Place first = make_place(make_name(begin, where));
    first.is_public = true;
    Linda::attributes(first, variables_);
    if (!variables_.empty()) {
        first.discipline = lang::Discipline::kAny;
    }
    if (!space_.ends_) {
        first.tokens = instance.tokens;
    }
    space_.body_.places.push_back(std::move(first));
    space_.made_.places.push_back(begin);
    open_.push_back({leave(name_ + "_begins", begin, where), {}});
    lines(program.children);
    if (becomes_ && !open_.empty()) {
        space_.error("no-value", where,
                     "this process may end without a value, and a tuple needs one of it",
                     "write return VALUE as its last line");
    }
    space_.made_.instances[number_].never_ends = open_.empty() && !returned_;
    lang::State state;
    state.name = make_name(name_, where);
    state.is_public = true;
    state.span = where;
    const auto& places = space_.made_.places;
    state.formula =
        make_any({places.begin() + static_cast<std::ptrdiff_t>(before), places.end()}, where);
    space_.body_.states.push_back(std::move(state));
}

bool LindaProgram::lines(const std::vector<Property>& list) {
    const std::size_t outer = variables_.size();
    bool time = false;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (open_.empty()) {
            space_.error("never-reached", list[i].span,
                         "no way goes on from the line before, so this is never reached",
                         "remove it, or write repeat NUMBER, while CONDITION, or a condition "
                         "before return");
            break;
        }
        const bool pair = i + 1 < list.size() && is_else(list[i + 1]);
        time = line(list[i], pair ? &list[i + 1] : nullptr) || time;
        slow_ = slow_ || time;
        i += pair ? 1 : 0;
    }
    variables_.resize(outer);
    return time;
}

bool LindaProgram::line(const Property& p, const Property* other) {
    const Labelled head = read_labelled(p);
    Line l(p, space_.teller_, head.first);
    struct Word {
        std::string_view word;
        bool (LindaProgram::*make)(const Step&);
        bool nests = false, branches = false;
    };
    static constexpr Word kWords[] = {{"out", &LindaProgram::give},
                                      {"eval", &LindaProgram::begin},
                                      {"in", &LindaProgram::take},
                                      {"rd", &LindaProgram::take},
                                      {"inp", &LindaProgram::try_take, true, true},
                                      {"rdp", &LindaProgram::try_take, true, true},
                                      {"does", &LindaProgram::act},
                                      {"wait", &LindaProgram::act},
                                      {"await", &LindaProgram::hear},
                                      {"raise", &LindaProgram::hear},
                                      {"let", &LindaProgram::let},
                                      {"if", &LindaProgram::choose, true, true},
                                      {"while", &LindaProgram::again, true},
                                      {"repeat", &LindaProgram::again, true},
                                      {"return", &LindaProgram::come_back}};
    for (const Word& known : kWords) {
        if (p.name.steps.size() != 1 || known.word != head.word) {
            continue;
        }
        if (other != nullptr && !known.branches) {
            space_.error("syntax", other->span, "there is nothing this is the other case of",
                         "write it behind inp, rdp or if");
        }
        if (p.has_children != known.nests) {
            space_.error("syntax", p.span,
                         known.nests ? "what is to be done then is missing"
                                     : "this line has lines of its own",
                         known.nests ? "write { ... } behind it" : "remove the braces");
        }
        const bool time = (this->*known.make)(Step{head, other, l, p.span});
        l.finish(kForms);
        return time;
    }
    space_.error("unknown-operation", p.name.span,
                 lang::to_text(p.name) + " is no operation of a process",
                 "write " + std::string(kForms));
    return true;
}

// ---------------------------------------------------------------------------------------------------------------------
// Values

const LindaField* LindaProgram::variable(std::string_view name) const {
    const auto found = std::find_if(variables_.begin(), variables_.end(),
                                    [&](const LindaField& v) { return v.name == name; });
    return found == variables_.end() ? nullptr : &*found;
}

Expr LindaProgram::settled(const Expr& e) const {
    return changed(e, [&](Expr& part) {
        lang::Name& first = part.path.steps[0];
        const auto found = fixed_.find(first.text);
        if (found == fixed_.end() || !first.index.empty() || variable(first.text) != nullptr) {
            return;
        }
        const Expr& value = found->second;
        if (value.kind == ExprKind::kPath) {
            std::vector<lang::Name> steps = value.path.steps;
            steps.insert(steps.end(), part.path.steps.begin() + 1, part.path.steps.end());
            part.path.steps = std::move(steps);
        } else if (part.kind == ExprKind::kPath && part.path.steps.size() == 1) {
            part = value;
        }
    });
}

Expr LindaProgram::value(const Expr& e) const {
    return changed(settled(e), [&](Expr& part) {
        lang::Name& first = part.path.steps[0];
        if (first.index.empty() && variable(first.text) != nullptr) {
            first.text = its(first.text);
        }
    });
}

bool LindaProgram::varies(const Expr& e) const {
    bool found = false;
    changed(e, [&](Expr& part) { found = found || variable(part.path.steps[0].text) != nullptr; });
    return found;
}

bool LindaProgram::fits(const LindaField& field, const Expr& e) {
    if (!formal_of(e).name.empty()) {
        space_.error("formal-in-out", e.span, "what is given must have a value",
                     "write a value instead of get(...)");
        return false;
    }
    const LindaField* v = variable(word_of(e));
    if (v != nullptr && sort_of(v->type) != sort_of(field.type)) {
        space_.error("type-mismatch", e.span,
                     field.name + " is " + lang::to_text(field.type) + ", and " + v->name + " is " +
                         lang::to_text(v->type),
                     "write a value of " + lang::to_text(field.type));
        return false;
    }
    if (v == nullptr) {
        space_.check_value(field, settled(e));
    }
    return true;
}

LindaPattern LindaProgram::put(std::size_t kind, const std::vector<const Expr*>& values,
                               Span where) const {
    LindaPattern out{.kind = kind, .constants = {}, .for_ever = endless_ > 0, .span = where};
    for (const Expr* e : values) {
        out.constants.push_back(e == nullptr || varies(*e) ? std::string()
                                                           : space_.constant(settled(*e)));
    }
    return out;
}

// ---------------------------------------------------------------------------------------------------------------------
// Places and transitions

std::string LindaProgram::name_of(const Step& s, const std::string& wanted) {
    return space_.unused(name_ + "_" + (s.head.label.empty() ? wanted : s.head.label));
}

lang::Place& LindaProgram::enter(const std::string& name, const Step& s) {
    lang::Place place = make_place(make_name(name, s.span));
    place.is_public = true;
    place.caption = s.head.caption;
    Linda::attributes(place, variables_);
    if (!variables_.empty()) {
        place.discipline = lang::Discipline::kAny;
    }
    space_.body_.places.push_back(std::move(place));
    space_.made_.places.push_back(name);
    go_to(name, s.span);
    return space_.body_.places.back();
}

void LindaProgram::go_to(const std::string& name, Span where) {
    for (const Open& open : open_) {
        Arc arc = make_arc(ArcKind::kGive, make_path(name, where));
        for (const LindaField& v : variables_) {
            const auto value = open.values.find(v.name);
            arc.pattern.push_back(
                {make_path(v.name, where),
                 value != open.values.end() ? value->second : make_reference(its(v.name), where),
                 where});
        }
        space_.body_.transitions[open.transition].outputs.push_back(std::move(arc));
    }
    open_.clear();
}

std::size_t LindaProgram::leave(const std::string& name, const std::string& place, Span where) {
    lang::Transition t = make_transition(make_name(name, where), {}, {});
    Arc arc = make_arc(ArcKind::kTake, make_path(place, where));
    for (const LindaField& v : variables_) {
        arc.pattern.push_back(
            {make_path(v.name, where), make_reference(its(v.name), where), where});
    }
    t.inputs.push_back(std::move(arc));
    t.span = where;
    t.is_public = true;
    space_.body_.transitions.push_back(std::move(t));
    return space_.body_.transitions.size() - 1;
}

// ---------------------------------------------------------------------------------------------------------------------
// Operations

bool LindaProgram::give(const Step& s) {
    const Expr* e = s.line.value("a tuple");
    const auto number = e != nullptr ? space_.find(space_.tuples_, *e, "tuple") : std::nullopt;
    if (!number) {
        return false;
    }
    const LindaKind& kind = space_.tuples_[*number];
    const std::vector<const Expr*> values = space_.match(kind, *e);
    const std::string name = name_of(s, "out_" + kind.name);
    enter(name, s);
    const std::size_t t = leave(name + "_done", name, s.span);
    Arc arc = make_arc(ArcKind::kGive, make_path(kind.name, s.span));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (fits(kind.fields[i], *values[i])) {
            arc.pattern.push_back(
                {make_path(kind.fields[i].name, s.span), value(*values[i]), s.span});
        }
    }
    space_.made_.puts.push_back(put(*number, values, s.span));
    space_.body_.transitions[t].outputs.push_back(std::move(arc));
    open_.push_back({t, {}});
    return false;
}

// The instance that such a call begins; adds what its token gets to `arc`.
std::optional<std::size_t> LindaProgram::child(const Expr& call,
                                               std::optional<LindaBecomes> becomes, Arc& arc) {
    const auto program = space_.find(space_.programs_, call, "process");
    if (!program) {
        return std::nullopt;
    }
    const LindaKind& kind = space_.programs_[*program];
    const std::vector<const Expr*> values = space_.match(kind, call);
    if (values.size() != kind.fields.size()) {
        return std::nullopt;
    }
    std::map<std::string, Expr> fixed;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const LindaField& field = kind.fields[i];
        if (!is_fixed(field)) {
            if (fits(field, *values[i])) {
                arc.pattern.push_back(
                    {make_path(field.name, call.span), value(*values[i]), call.span});
            }
        } else if (varies(*values[i])) {
            space_.error("not-known-before", values[i]->span,
                         field.name + " of " + kind.name +
                             " must be known before the run, and this is a variable",
                         "ask for it: if " + lang::to_text(*values[i]) + " = NAME { eval " +
                             kind.name + "(NAME) }");
            return std::nullopt;
        } else {
            fixed[field.name] = settled(*values[i]);
        }
    }
    const std::size_t number = space_.instance(*program, std::move(fixed), becomes);
    arc.place = make_path(space_.made_.instances[number].name + "_begin", call.span);
    return number;
}

// eval PROCESS(...), eval TUPLE(..., PROCESS(...), ...)
bool LindaProgram::begin(const Step& s) {
    const Expr* e = s.line.value("a process, or a tuple with a process in it");
    if (e == nullptr) {
        return false;
    }
    Arc arc = make_arc(ArcKind::kGive, make_path("", s.span));
    std::optional<std::size_t> number;
    std::string wanted;
    const auto tuple = space_.find(space_.tuples_, *e, nullptr);
    if (!tuple) {
        number = child(*e, std::nullopt, arc);
        wanted = e->path.empty() ? "" : e->path.steps[0].text;
    } else {
        const LindaKind& kind = space_.tuples_[*tuple];
        std::vector<const Expr*> values = space_.match(kind, *e);
        std::size_t field = values.size();
        int live = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (names_value(*values[i]) || values[i]->kind == ExprKind::kCall) {
                if (space_.find(space_.programs_, *values[i], nullptr)) {
                    field = i;
                    ++live;
                }
            }
        }
        if (live != 1) {
            space_.error("eval-without-process", e->span,
                         live == 0 ? "no field of this tuple is a process"
                                   : "several fields of this tuple are processes",
                         live == 0 ? "write out " + lang::to_text(*e)
                                   : "give each process a tuple of its own");
            return false;
        }
        for (std::size_t i = 0; i < values.size(); ++i) {
            const LindaField& f = kind.fields[i];
            if (i != field && fits(f, *values[i])) {
                arc.pattern.push_back({make_path(kept(f.name), s.span), value(*values[i]), s.span});
            }
        }
        number = child(*values[field], LindaBecomes{*tuple, field}, arc);
        values[field] = nullptr;
        space_.made_.puts.push_back(put(*tuple, values, s.span));
        wanted = kind.name;
    }
    if (!number) {
        return false;
    }
    const std::string name = name_of(s, "eval_" + wanted);
    enter(name, s);
    const std::size_t t = leave(name + "_done", name, s.span);
    space_.body_.transitions[t].outputs.push_back(std::move(arc));
    space_.made_.births.push_back({.parent = number_,
                                   .child = *number,
                                   .always = branches_ == 0,
                                   .at_once = !slow_,
                                   .for_ever = endless_ > 0,
                                   .span = s.span});
    open_.push_back({t, {}});
    return false;
}

// return, return VALUE
bool LindaProgram::come_back(const Step& s) {
    const Expr* e = s.line.done() ? nullptr : s.line.value("a value");
    const std::string name = name_of(s, "return");
    enter(name, s);
    const std::size_t t = leave(name + "_done", name, s.span);
    returned_ = true;
    if (!becomes_) {
        return true;
    }
    const LindaKind& kind = space_.tuples_[becomes_->kind];
    if (e == nullptr) {
        space_.error("no-value", s.span, "a tuple " + kind.name + " needs a value of this process",
                     "write return VALUE");
        return true;
    }
    Arc arc = make_arc(ArcKind::kGive, make_path(kind.name, s.span));
    for (std::size_t i = 0; i < kind.fields.size(); ++i) {
        const LindaField& f = kind.fields[i];
        if (i != becomes_->field) {
            arc.pattern.push_back(
                {make_path(f.name, s.span), make_reference(its(kept(f.name)), s.span), s.span});
        } else if (fits(f, *e)) {
            arc.pattern.push_back({make_path(f.name, s.span), value(*e), s.span});
        }
    }
    space_.body_.transitions[t].outputs.push_back(std::move(arc));
    return true;
}

// A pattern as an arc; its formals get values in `open` and come into scope by `bound`.
Arc LindaProgram::pattern(std::size_t number, const Expr& e, ArcKind how, Open* open,
                          Variables& bound) {
    const LindaKind& kind = space_.tuples_[number];
    Arc arc = make_arc(how, make_path(kind.name, e.span));
    const std::vector<const Expr*> values = space_.match(kind, e);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Formal formal = formal_of(*values[i]);
        const LindaField& field = kind.fields[i];
        const lang::Path name = make_path(field.name, e.span);
        if (word_of(*values[i]) == "_") {
            continue;
        }
        if (formal.name.empty()) {
            if (fits(field, *values[i])) {
                arc.pattern.push_back({name, value(*values[i]), e.span});
            }
            continue;
        }
        if (open == nullptr) {
            continue;
        }
        const LindaField* known = variable(formal.name);
        const Expr* other = formal.type ? &formal.type : known != nullptr ? &known->type : nullptr;
        if (other != nullptr && lang::to_text(*other) != lang::to_text(field.type)) {
            space_.error("type-mismatch", values[i]->span,
                         field.name + " is " + lang::to_text(field.type) + ", and " + formal.name +
                             " is " + lang::to_text(*other),
                         "get it with a variable of its own type");
        } else if (formal.name == "left" || fixed_.count(formal.name) != 0) {
            space_.error("reserved-name", values[i]->span, formal.name + " cannot change",
                         "get it with another variable");
        } else if (std::any_of(bound.begin(), bound.end(),
                               [&](const LindaField& b) { return b.name == formal.name; })) {
            space_.error("name-twice", values[i]->span,
                         "this pattern gets " + formal.name + " twice",
                         "use two names, and compare them");
        } else {
            arc.pattern.push_back({name, make_reference(got(formal.name), e.span), e.span});
            open->values[formal.name] = make_reference(got(formal.name), e.span);
            bound.push_back({formal.name, field.type});
        }
    }
    return arc;
}

void LindaProgram::bring(const Variables& bound) {
    for (const LindaField& b : bound) {
        if (variable(b.name) == nullptr) {
            variables_.push_back(b);
        }
    }
}

// The kind of tuple that this line wants; notes what fits it.
std::optional<std::size_t> LindaProgram::taken_kind(const Step& s, const Expr*& e) {
    e = s.line.value("a tuple, with values and get(NAME) in brackets");
    const auto number = e != nullptr ? space_.find(space_.tuples_, *e, "tuple") : std::nullopt;
    if (!number) {
        return std::nullopt;
    }
    std::vector<const Expr*> values = space_.match(space_.tuples_[*number], *e);
    for (const Expr*& v : values) {
        if (word_of(*v) == "_" || !formal_of(*v).name.empty()) {
            v = nullptr;
        }
    }
    LindaPattern pattern = put(*number, values, s.span);
    pattern.removes = s.head.word == "in" || s.head.word == "inp";
    space_.made_.takes.push_back(std::move(pattern));
    return number;
}

// in, rd
bool LindaProgram::take(const Step& s) {
    const Expr* e = nullptr;
    const auto kind = taken_kind(s, e);
    if (!kind) {
        return true;
    }
    const bool removes = s.head.word == "in";
    const std::string name = name_of(s, s.head.word + "_" + space_.tuples_[*kind].name);
    enter(name, s);
    Open open{leave(name + "_done", name, s.span), {}};
    Variables bound;
    Arc arc = pattern(*kind, *e, removes ? ArcKind::kTake : ArcKind::kWith, &open, bound);
    lang::Transition& t = space_.body_.transitions[open.transition];
    (removes ? t.inputs : t.tests).push_back(std::move(arc));
    open_.push_back(std::move(open));
    bring(bound);
    return removes;
}

// inp, rdp: one transition for each answer; one of them is always possible.
bool LindaProgram::try_take(const Step& s) {
    const Expr* e = nullptr;
    const auto kind = taken_kind(s, e);
    if (!kind) {
        return true;
    }
    const bool removes = s.head.word == "inp";
    const std::string name = name_of(s, s.head.word + "_" + space_.tuples_[*kind].name);
    enter(name, s);
    Open found{leave(name + "_found", name, s.span), {}};
    Open none{leave(name + "_none", name, s.span), {}};
    Variables bound, nothing;
    Arc arc = pattern(*kind, *e, removes ? ArcKind::kTake : ArcKind::kWith, &found, bound);
    lang::Transition& t = space_.body_.transitions[found.transition];
    (removes ? t.inputs : t.tests).push_back(std::move(arc));
    space_.body_.transitions[none.transition].tests.push_back(
        pattern(*kind, *e, ArcKind::kUnless, nullptr, nothing));
    return branches(s, std::move(found), std::move(none), bound);
}

bool LindaProgram::branches(const Step& s, Open yes, Open no, const Variables& bound) {
    const std::size_t outer = variables_.size();
    const bool slow = slow_;
    ++branches_;
    open_.push_back(std::move(yes));
    bring(bound);
    const bool yes_time = lines(s.head.property->children) || open_.empty();
    variables_.resize(outer);
    std::vector<Open> after = std::move(open_);
    open_.clear();
    open_.push_back(std::move(no));
    slow_ = slow;
    const bool no_time = s.other != nullptr && (lines(s.other->children) || open_.empty());
    slow_ = slow;
    --branches_;
    open_.insert(open_.end(), std::make_move_iterator(after.begin()),
                 std::make_move_iterator(after.end()));
    return yes_time && no_time;
}

// does, wait
bool LindaProgram::act(const Step& s) {
    const bool does = s.head.word == "does";
    const Expr* e = s.line.value(does ? "a movement" : "a time");
    if (e == nullptr) {
        return true;
    }
    const std::string name =
        name_of(s, does && !e->path.empty() ? e->path.steps.back().text : s.head.word);
    if (does && e->path.steps.size() > 1 && variable(e->path.steps[0].text) != nullptr) {
        space_.error("not-known-before", e->span, "who is moved must be known before the run",
                     "make the figure a parameter of the process, of type actor, or ask: if " +
                         e->path.steps[0].text + " = NAME { does NAME... }");
        return true;
    }
    // Durations and arguments see the token's attributes by their own names.
    ++waits_;
    lang::Place& place = enter(name, s);
    const Expr* time = does ? nullptr : e;
    if (does) {
        place.does = settled(*e);
        time = s.line.word("takes") ? s.line.value("a time") : nullptr;
    }
    if (time != nullptr) {
        place.takes = make_duration(settled(*time));
    }
    open_.push_back({leave(name + "_done", name, s.span), {}});
    return time == nullptr || time->kind != ExprKind::kNumber || !(time->number == Rational{0});
}

// await, raise
bool LindaProgram::hear(const Step& s) {
    const bool waits = s.head.word == "await";
    std::vector<lang::Path> events;
    const Expr* e = s.line.value("the name of an event");
    if (e == nullptr) {
        return true;
    }
    const Expr known = settled(*e);
    if (!paths_of(known, lang::Op::kOr, events) || (!waits && events.size() > 1)) {
        space_.error("syntax", e->span, "events are wanted here",
                     waits ? "write EVENT or EVENT" : "write raise EVENT");
        return true;
    }
    const std::string name = name_of(s, s.head.word + "_" + events[0].steps.back().text);
    enter(name, s);
    const std::size_t number = leave(name + "_done", name, s.span);
    lang::Transition& t = space_.body_.transitions[number];
    (waits ? t.events : t.raises) = std::move(events);
    t.next_event = waits;
    waits_ += waits ? 1 : 0;
    open_.push_back({number, {}});
    return waits;
}

// let x: 0 .. 9 := n + 1, let x := n + 1
bool LindaProgram::let(const Step& s) {
    const lang::Path* path = s.line.path("a name");
    if (path == nullptr) {
        return false;
    }
    const std::string& name = path->steps[0].text;
    const LindaField* known = variable(name);
    const bool typed = s.line.symbol(":");
    const Expr* type = typed ? s.line.value("a type") : nullptr;
    if (name == "left" || fixed_.count(name) != 0) {
        space_.error("reserved-name", path->span, name + " cannot change", "choose another name");
        return false;
    }
    if (typed != (known == nullptr) || !s.line.symbol(":=")) {
        space_.error(
            "syntax", s.span,
            known != nullptr ? "this variable has a type already"
                             : "a new variable needs a type and a value",
            known != nullptr ? "write let NAME := VALUE" : "write let NAME: 0 .. 9 := VALUE");
        return false;
    }
    const Expr* e = s.line.value("a value");
    if (e == nullptr || (typed && type == nullptr)) {
        return false;
    }
    const LindaField made = known != nullptr ? *known : LindaField{name, *type};
    if (!fits(made, *e)) {
        return false;
    }
    const std::string place = name_of(s, "let_" + name);
    enter(place, s);
    Open open{leave(place + "_done", place, s.span), {}};
    open.values[name] = value(*e);
    open_.push_back(std::move(open));
    bring({made});
    return false;
}

// if CONDITION
bool LindaProgram::choose(const Step& s) {
    const Expr* e = s.line.value("a condition");
    if (e == nullptr) {
        return true;
    }
    const std::string name = name_of(s, "if");
    enter(name, s);
    Open yes{leave(name + "_true", name, s.span), {}};
    Open no{leave(name + "_false", name, s.span), {}};
    space_.body_.transitions[yes.transition].guard = value(*e);
    space_.body_.transitions[no.transition].guard = make_unary(lang::Op::kNot, value(*e));
    return branches(s, std::move(yes), std::move(no), {});
}

// while CONDITION, repeat NUMBER, repeat
bool LindaProgram::again(const Step& s) {
    const bool counted = s.head.word == "repeat" && !s.line.done();
    const bool ends = counted || s.head.word == "while";
    const Expr* e = ends ? s.line.value(counted ? "a number of rounds" : "a condition") : nullptr;
    if (ends && e == nullptr) {
        return true;
    }
    const std::string name = name_of(s, s.head.word);
    const std::size_t outer = variables_.size();
    const std::string counter = "rounds of " + name;
    if (counted) {
        Expr type = make_reference("int", s.span);
        if (!varies(*e)) {
            type = make_binary(lang::Op::kNone, make_number(Rational{0}, s.span), settled(*e));
            type.kind = ExprKind::kRange;
        }
        for (Open& open : open_) {
            open.values[counter] = value(*e);
        }
        variables_.push_back({counter, std::move(type)});
    }
    enter(name, s);
    Open round{leave(name + "_round", name, s.span), {}};
    Open over;
    if (ends) {
        over.transition = leave(name + "_ends", name, s.span);
        Expr more = counted ? Expr{} : value(*e);
        if (counted) {
            const Expr left = make_reference(its(counter), s.span);
            more = make_binary(lang::Op::kGreater, left, make_number(Rational{0}, s.span));
            round.values[counter] =
                make_binary(lang::Op::kSubtract, left, make_number(Rational{1}, s.span));
        }
        space_.body_.transitions[over.transition].guard = make_unary(lang::Op::kNot, more);
        space_.body_.transitions[round.transition].guard = std::move(more);
    }
    open_.push_back(std::move(round));
    const bool slow = slow_;
    const int waits = waits_;
    const std::size_t puts = space_.made_.puts.size(), takes = space_.made_.takes.size();
    (ends ? branches_ : endless_) += 1;
    const bool time = lines(s.head.property->children);
    (ends ? branches_ : endless_) -= 1;
    slow_ = slow;
    if (!time && !ends && !open_.empty()) {
        space_.error("zero-time-loop", s.span, "a round of this may take no time at all",
                     "put a wait TIME into it, a movement, or an `in` that waits for a tuple");
    } else if (!ends && !open_.empty() && waits == waits_) {
        check_round(s.span, puts, takes);
    }
    go_to(name, s.span);
    if (ends) {
        open_.push_back(std::move(over));
    }
    variables_.resize(outer);
    return !ends;
}

// A round in which nothing lasts, and that puts itself all that it takes: `puts` and `takes` are
// where its own begin.
void LindaProgram::check_round(Span where, std::size_t puts, std::size_t takes) {
    const std::vector<LindaPattern>&all = space_.made_.puts, &wanted = space_.made_.takes;
    const bool feeds_itself = std::all_of(
        wanted.begin() + static_cast<std::ptrdiff_t>(takes), wanted.end(),
        [&](const LindaPattern& t) {
            return !t.removes ||
                   std::any_of(all.begin() + static_cast<std::ptrdiff_t>(puts), all.end(),
                               [&](const LindaPattern& p) { return compatible(p, t); });
        });
    if (feeds_itself) {
        space_.warn("zero-time-poll", where,
                    "nothing in a round of this lasts, and what it takes it puts itself: it may go "
                    "round for ever in no time",
                    "put a wait TIME into it, or a movement");
    }
}

}  // namespace puppetri::notation
