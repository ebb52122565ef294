// SPDX-License-Identifier: MIT
// Linda's tuple spaces: declarations, and what only the whole space shows: patterns that nobody
// serves, processes that are never begun or begun without end. Programs are in linda_program.cpp.
//   linda yard {
//     tuple task(kind: 0 .. 1)
//     out 3 task(0)
//     start worker(ana)
//     process worker(me: actor) {
//       repeat {
//         in task(get(kind))
//         does me.wave()
//       }
//     }
//   }
#include "linda.h"

#include <algorithm>
#include <array>

#include "kinds.h"
#include "literal.h"
#include "make.h"

namespace puppetri::notation {

using lang::Expr;
using lang::ExprKind;
using lang::Property;
using lang::Span;

namespace {

constexpr std::string_view kTupleForm = "tuple NAME(FIELD: TYPE, ...) oldest";
constexpr std::string_view kProcessForm = "process NAME(PARAMETER: TYPE, ...) { ... }";
constexpr std::size_t kMostInstances = 1000;

// task(kind, n)
std::string form_of(const LindaKind& kind) {
    std::string form = kind.name;
    for (const LindaField& f : kind.fields) {
        form += (&f == &kind.fields.front() ? "(" : ", ") + f.name;
    }
    return form + (kind.fields.empty() ? "" : ")");
}

bool is_ends(const Property& p) {
    return p.name.steps.size() == 1 && p.name.steps[0].text == "ends" && p.values.empty() &&
           !p.has_children;
}

}  // namespace

bool compatible(const LindaPattern& a, const LindaPattern& b) {
    if (a.kind != b.kind || a.constants.size() != b.constants.size()) {
        return a.kind == b.kind;
    }
    for (std::size_t i = 0; i < a.constants.size(); ++i) {
        if (!a.constants[i].empty() && !b.constants[i].empty() &&
            a.constants[i] != b.constants[i]) {
            return false;
        }
    }
    return true;
}

bool is_fixed(const LindaField& parameter) {
    static constexpr std::array kTypes = {
        std::string_view("actor"),    std::string_view("prop"),       std::string_view("set"),
        std::string_view("event"),    std::string_view("side"),       std::string_view("place"),
        std::string_view("movement"), std::string_view("transition"), std::string_view("data"),
        std::string_view("point"),    std::string_view("text")};
    return std::find(kTypes.begin(), kTypes.end(), word_of(parameter.type)) != kTypes.end();
}

std::string sort_of(const Expr& type) {
    const std::string_view word = word_of(type);
    if (type.kind == ExprKind::kRange || word == "int" || word == "real") {
        return "number";
    }
    return lang::to_text(type);
}

std::string kept(const std::string& field) { return "kept " + field; }

void Linda::lower() {
    ends_ = std::any_of(block_.properties.begin(), block_.properties.end(), is_ends);
    if (ends_) {
        names_.insert({"begin", "start", "running", "finish", "done"});
    }
    for (const Property& p : block_.properties) {
        declare(p);
    }
    for (const Property& p : block_.properties) {
        if (const std::string& word = p.name.steps[0].text; word == "out" || word == "start") {
            initial(p);
        }
    }
    for (std::size_t i = 0; i < made_.instances.size(); ++i) {
        LindaProgram(*this, i).write();
    }
    // A program that nobody begins is read for its defects; nothing is made of it.
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        if (programs_[i].used) {
            continue;
        }
        warn("never-begun", programs_[i].property->span,
             "nobody begins the process " + programs_[i].name,
             "write start " + form_of(programs_[i]) + ", or eval it in another process");
        lang::Body body = body_;
        Made made = made_;
        for (std::size_t j = instance(i, {}, std::nullopt); j < made_.instances.size(); ++j) {
            LindaProgram(*this, j).write();
        }
        body_ = std::move(body);
        made_ = std::move(made);
    }
    make_tuples();
    check_patterns();
    check_births();
    if (programs_.empty()) {
        teller_.error("empty-linda", block_.name.span, "there is no process here",
                      "write " + std::string(kProcessForm) + " and start NAME(...)");
    }
    make_ended();
    if (ends_) {
        make_ways();
    }
}

void Linda::error(const char* code, Span where, std::string message, std::string remedy) {
    if (told_.emplace(where.begin, code).second) {
        teller_.error(code, where, std::move(message), std::move(remedy));
    }
}

void Linda::warn(const char* code, Span where, std::string message, std::string remedy) {
    if (told_.emplace(where.begin, code).second) {
        teller_.warn(code, where, std::move(message), std::move(remedy));
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Declarations

void Linda::declare(const Property& p) {
    const std::string& word = p.name.steps[0].text;
    if (is_ends(p) || (p.name.steps.size() == 1 && (word == "out" || word == "start"))) {
        return;
    }
    if (p.name.steps.size() != 1 || (word != "tuple" && word != "process")) {
        error("syntax", p.name.span, "this is no part of a tuple space",
              "write " + std::string(kTupleForm) + ", " + std::string(kProcessForm) +
                  ", start PROCESS(...), out TUPLE(...), or ends");
        return;
    }
    const bool tuple = word == "tuple";
    Line line(p, teller_);
    const Expr* e = line.value("a name, with its fields in brackets");
    if (e == nullptr || e->path.steps.size() != 1) {
        if (e != nullptr) {
            error("syntax", e->span, "a name is wanted here",
                  "write " + std::string(tuple ? kTupleForm : kProcessForm));
        }
        return;
    }
    LindaKind kind;
    kind.name = e->path.steps[0].text;
    kind.property = &p;
    std::set<std::string> names;
    for (const lang::Argument& a : e->args) {
        if (a.name.text.empty()) {
            error("syntax", a.value.span, "a field has a name and a type",
                  "write NAME: TYPE, such as n: 0 .. 9");
        } else if (a.name.text == "left") {
            error("reserved-name", a.name.span, "`left` is how long a token has still to wait",
                  "choose another name for the field");
        } else if (!names.insert(a.name.text).second) {
            error("name-twice", a.name.span, kind.name + " has two fields " + a.name.text,
                  "choose another name");
        } else {
            kind.fields.push_back({a.name.text, a.value});
        }
    }
    static constexpr std::pair<std::string_view, lang::Discipline> kWho[] = {
        {"any", lang::Discipline::kAny},       {"oldest", lang::Discipline::kOldest},
        {"newest", lang::Discipline::kNewest}, {"least", lang::Discipline::kLeast},
        {"most", lang::Discipline::kMost},
    };
    for (const auto& [policy, discipline] : kWho) {
        if (tuple && line.word(policy)) {
            kind.discipline = discipline;
            if (policy == "least" || policy == "most") {
                if (const Expr* key = line.value("what is compared")) {
                    kind.key = *key;
                }
            }
            break;
        }
    }
    line.finish(tuple ? kTupleForm : kProcessForm);
    if (tuple && p.has_children) {
        error("syntax", p.span, "this line has lines of its own", "remove the braces");
    }
    if (!names_.insert(kind.name).second) {
        error("name-twice", p.span, "there is already a " + kind.name, "choose another name");
        return;
    }
    (tuple ? tuples_ : programs_).push_back(std::move(kind));
}

std::optional<std::size_t> Linda::find(const std::vector<LindaKind>& list, const Expr& e,
                                       const char* what) {
    for (std::size_t i = 0; e.path.steps.size() == 1 && i < list.size(); ++i) {
        if (list[i].name == e.path.steps[0].text) {
            return i;
        }
    }
    if (what != nullptr) {
        error("unknown-name", e.span, std::string("there is no ") + what + " " + lang::to_text(e),
              std::string("declare it: ") + what + " NAME(FIELD: TYPE, ...)");
    }
    return std::nullopt;
}

std::vector<const Expr*> Linda::match(const LindaKind& kind, const Expr& call) {
    std::vector<const Expr*> out(kind.fields.size(), nullptr);
    std::size_t next = 0;
    bool good = true;
    for (const lang::Argument& a : call.args) {
        std::size_t i = next++;
        if (!a.name.text.empty()) {
            for (i = 0; i < kind.fields.size() && kind.fields[i].name != a.name.text; ++i) {
            }
        }
        if (i >= out.size() || out[i] != nullptr) {
            good = false;
        } else {
            out[i] = &a.value;
        }
    }
    if (good && std::find(out.begin(), out.end(), nullptr) == out.end()) {
        return out;
    }
    const std::size_t n = kind.fields.size();
    error("wrong-fields", call.span,
          kind.name + (n == 0 ? " has no fields"
                              : " has " + std::to_string(n) + (n == 1 ? " field" : " fields")),
          "write " + form_of(kind));
    return {};
}

void Linda::check_value(const LindaField& field, const Expr& value) {
    const auto number = literal_number(value);
    const std::string sort = sort_of(field.type);
    const bool is_bool = value.kind == ExprKind::kBool;
    static constexpr std::array kNoNumbers = {std::string_view("bool"),  std::string_view("actor"),
                                              std::string_view("prop"),  std::string_view("set"),
                                              std::string_view("event"), std::string_view("side"),
                                              std::string_view("text")};
    if ((is_bool && sort != "bool") || (value.kind == ExprKind::kString && sort != "text") ||
        (number && std::find(kNoNumbers.begin(), kNoNumbers.end(), sort) != kNoNumbers.end())) {
        error("type-mismatch", value.span,
              field.name + " is " + lang::to_text(field.type) + ", and " + lang::to_text(value) +
                  " is none",
              "write a value of " + lang::to_text(field.type));
    } else if (number && field.type.kind == ExprKind::kRange) {
        const auto low = literal_number(field.type.args[0].value);
        const auto high = literal_number(field.type.args[1].value);
        if ((low && compare(*number, *low) < 0) || (high && compare(*number, *high) > 0)) {
            error(
                "out-of-range", value.span,
                field.name + " is " + lang::to_text(field.type) + ", never " + lang::to_text(value),
                "write another value, or give the field a wider range");
        }
    }
}

std::string Linda::constant(const Expr& value) const {
    if (const auto number = literal_number(value)) {
        return std::to_string(number->numerator) + "/" + std::to_string(number->denominator);
    }
    if (value.kind == ExprKind::kBool) {
        return lang::to_text(value);
    }
    const std::string_view word = word_of(value);
    const auto& given = block_.parameters;
    return std::any_of(given.begin(), given.end(),
                       [&](const lang::Parameter& p) { return p.name.text == word; })
               ? std::string()
               : std::string(word);
}

// start 3 worker(ana), out task(1)
void Linda::initial(const Property& p) {
    Line line(p, teller_);
    const bool tuple = p.name.steps[0].text == "out";
    const char* what = tuple ? "tuple" : "process";
    const Expr* e = line.value(std::string("a ") + what);
    lang::InitialTokens tokens;
    tokens.span = p.span;
    tokens.count = make_number(Rational{1}, p.span);
    if (e != nullptr && !line.done()) {
        tokens.count = *e;
        e = line.value(std::string("a ") + what);
    }
    line.finish(tuple ? "out NUMBER TUPLE(...)" : "start NUMBER PROCESS(...)");
    std::vector<LindaKind>& list = tuple ? tuples_ : programs_;
    const auto number = e != nullptr ? find(list, *e, what) : std::nullopt;
    if (!number) {
        return;
    }
    LindaKind& kind = list[*number];
    kind.used = true;
    const std::vector<const Expr*> values = match(kind, *e);
    std::map<std::string, Expr> fixed;
    LindaPattern put{.kind = *number, .constants = {}, .span = p.span};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const LindaField& field = kind.fields[i];
        check_value(field, *values[i]);
        put.constants.push_back(constant(*values[i]));
        if (!tuple && is_fixed(field)) {
            fixed[field.name] = *values[i];
        } else {
            tokens.attributes.push_back({make_path(field.name, p.span), *values[i], p.span});
        }
    }
    if (tuple) {
        made_.puts.push_back(std::move(put));
        kind.tokens.push_back(std::move(tokens));
    } else if (values.size() == kind.fields.size()) {
        made_.instances[instance(*number, std::move(fixed), std::nullopt)].tokens.push_back(
            std::move(tokens));
    }
}

std::size_t Linda::instance(std::size_t program, std::map<std::string, Expr> fixed,
                            std::optional<LindaBecomes> becomes) {
    LindaKind& kind = programs_[program];
    kind.used = true;
    LindaInstance made;
    made.program = program;
    made.name = kind.name;
    made.becomes = becomes;
    std::string key = kind.name;
    for (const LindaField& f : kind.fields) {
        const auto value = fixed.find(f.name);
        if (value == fixed.end()) {
            if (!is_fixed(f)) {
                made.carried.push_back(f);
            }
            continue;
        }
        key += "(" + lang::to_text(value->second);
        if (value->second.kind == ExprKind::kPath) {
            const lang::Name& last = value->second.path.steps.back();
            made.name += "_" + last.text;
            for (const Expr& index : last.index) {
                made.name += "_" + lang::to_text(index);
            }
        }
    }
    if (becomes) {
        const LindaKind& tuple = tuples_[becomes->kind];
        key += ">" + tuple.name + "." + std::to_string(becomes->field);
        made.name += "_to_" + tuple.name;
        for (std::size_t i = 0; i < tuple.fields.size(); ++i) {
            if (i != becomes->field) {
                made.carried.push_back({kept(tuple.fields[i].name), tuple.fields[i].type});
            }
        }
    }
    const auto [known, is_new] = made_.keys.emplace(std::move(key), made_.instances.size());
    if (!is_new) {
        return known->second;
    }
    if (made_.instances.size() >= kMostInstances) {
        error("too-many-processes", kind.property->span,
              "there are more than " + std::to_string(kMostInstances) +
                  " kinds of this process, by what its parameters are",
              "give what changes from process to process in a field with a range");
        return 0;
    }
    if (made.name != kind.name) {
        made.name = unused(made.name);
    }
    made.fixed = std::move(fixed);
    made_.instances.push_back(std::move(made));
    return made_.instances.size() - 1;
}

std::string Linda::unused(const std::string& wanted) {
    std::string name = wanted;
    for (int i = 2; !names_.insert(name).second; ++i) {
        name = wanted + "_" + std::to_string(i);
    }
    return name;
}

void Linda::attributes(lang::Place& place, const std::vector<LindaField>& fields) {
    if (fields.empty()) {
        return;
    }
    place.of_type = make_path("tokens of " + place.name.text, place.span);
    for (const LindaField& f : fields) {
        lang::Parameter a;
        a.name = make_name(f.name, place.span);
        a.type = f.type;
        a.span = place.span;
        place.attributes.push_back(std::move(a));
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// The whole space

void Linda::make_tuples() {
    for (LindaKind& tuple : tuples_) {
        lang::Place place = make_place(make_name(tuple.name, tuple.property->span));
        place.is_public = true;
        attributes(place, tuple.fields);
        if (!tuple.fields.empty()) {
            place.discipline = tuple.discipline;
            place.discipline_key = tuple.key;
        }
        if (!ends_) {
            place.tokens = tuple.tokens;
        }
        body_.places.push_back(std::move(place));
    }
}

void Linda::check_patterns() {
    for (const LindaPattern& t : made_.takes) {
        if (std::none_of(made_.puts.begin(), made_.puts.end(),
                         [&](const LindaPattern& p) { return compatible(p, t); })) {
            const std::string& name = tuples_[t.kind].name;
            const bool none = std::none_of(made_.puts.begin(), made_.puts.end(),
                                           [&](const LindaPattern& p) { return p.kind == t.kind; });
            warn("never-put", t.span,
                 none ? "nobody in this space ever puts a tuple " + name
                      : "nobody in this space ever puts a tuple " + name + " that fits this",
                 "write out " + form_of(tuples_[t.kind]) +
                     " in a process or at the top, with values that fit");
        }
    }
    for (const LindaPattern& p : made_.puts) {
        if (p.for_ever &&
            std::none_of(made_.takes.begin(), made_.takes.end(),
                         [&](const LindaPattern& t) { return t.removes && compatible(p, t); })) {
            warn("grows-without-bound", p.span,
                 "nobody in this space ever takes what is put here again and again",
                 "take it somewhere: in " + form_of(tuples_[p.kind]));
        }
    }
}

// An unconditional `eval` of oneself, over others or not, never comes to an end; without time
// between, not even the first instant does.
void Linda::check_births() {
    const std::size_t n = made_.instances.size();
    const auto reaches = [&](std::size_t from, std::size_t to, bool at_once) {
        std::vector<bool> seen(n, false);
        std::vector<std::size_t> open{from};
        seen[from] = true;
        while (!open.empty()) {
            const std::size_t i = open.back();
            open.pop_back();
            if (i == to) {
                return true;
            }
            for (const LindaBirth& b : made_.births) {
                if (b.parent == i && b.always && (b.at_once || !at_once) && !seen[b.child]) {
                    seen[b.child] = true;
                    open.push_back(b.child);
                }
            }
        }
        return false;
    };
    std::map<std::size_t, int> circles;  // unconditional births that lead back to their parent
    for (const LindaBirth& b : made_.births) {
        const std::string& name = programs_[made_.instances[b.child].program].name;
        if (b.always && b.at_once && reaches(b.child, b.parent, true)) {
            error("zero-time-loop", b.span,
                  "this begins " + name +
                      ", which begins this again, without end, and perhaps in no time",
                  "put it into if CONDITION { ... }, or a wait TIME before it");
            continue;
        }
        const bool circle = b.always && reaches(b.child, b.parent, false);
        circles[b.parent] += circle ? 1 : 0;
        if ((b.for_ever && made_.instances[b.child].never_ends) ||
            (circle && (made_.instances[b.parent].never_ends || circles[b.parent] > 1))) {
            warn("unbounded-processes", b.span,
                 "again and again this begins a process " + name + " more than end",
                 "let " + name + " end, or begin it under a condition");
        }
    }
}

// Every process has come to its end.
void Linda::make_ended() {
    const Span where = block_.name.span;
    lang::State state;
    state.name = make_name("ended", where);
    state.is_public = true;
    state.span = where;
    state.formula = make_any(made_.places, where);
    if (state.formula) {
        state.formula = make_unary(lang::Op::kNot, std::move(state.formula));
        body_.states.push_back(std::move(state));
    }
}

void Linda::make_ways() {
    const Span where = block_.name.span;
    for (const char* name : {"begin", "running", "done"}) {
        lang::Place place = make_place(make_name(name, where));
        place.is_public = true;
        if (place.name.text == "begin") {
            place.role = lang::Role::kStart;
            give_token(place);
        } else if (place.name.text == "done") {
            place.role = lang::Role::kFinish;
        }
        body_.places.push_back(std::move(place));
    }
    lang::Transition start = make_transition(make_name("start", where), {make_path("begin", where)},
                                             {make_path("running", where)});
    lang::Transition finish = make_transition(
        make_name("finish", where), {make_path("running", where)}, {make_path("done", where)});
    const auto put = [&](const std::string& place, const std::vector<lang::InitialTokens>& list) {
        for (const lang::InitialTokens& tokens : list) {
            lang::Arc arc =
                make_arc(lang::ArcKind::kGive, make_path(place, tokens.span), tokens.count);
            arc.pattern = tokens.attributes;
            start.outputs.push_back(std::move(arc));
        }
    };
    for (const LindaKind& tuple : tuples_) {
        put(tuple.name, tuple.tokens);
        finish.inputs.push_back(make_arc(lang::ArcKind::kTakeAllNow, make_path(tuple.name, where)));
    }
    for (const LindaInstance& instance : made_.instances) {
        put(instance.name + "_begin", instance.tokens);
    }
    for (const std::string& place : made_.places) {
        finish.tests.push_back(make_arc(lang::ArcKind::kUnless, make_path(place, where)));
    }
    for (lang::Transition* t : {&start, &finish}) {
        t->is_public = true;
        t->span = where;
        body_.transitions.push_back(std::move(*t));
    }
}

void lower_linda(const lang::Block& block, const lang::File& file, Lowered& out) {
    Linda(block, file, out).lower();
    // What is wrong in a program is found in each of its instances.
    Diagnostics told;
    for (Diagnostic& d : out.diagnostics) {
        if (std::none_of(told.begin(), told.end(), [&](const Diagnostic& other) {
                return other.code == d.code && other.where == d.where;
            })) {
            told.push_back(std::move(d));
        }
    }
    out.diagnostics = std::move(told);
}

}  // namespace puppetri::notation
