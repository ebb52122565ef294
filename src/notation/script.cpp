// SPDX-License-Identifier: MIT
// Space-time-event scripts (Camargo, Magalhães, Raposo 1995, section 2: "after t0 move from p0 to
// p1", and then events as well): a screenplay of cues. A cue has a trigger (a time, an event,
// the end of other cues, a place), somebody, and what they do. It becomes a place that waits for
// its trigger, a place in which it is done, and two transitions, `NAME_begins` and `NAME_ends`.
#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "kinds.h"
#include "line.h"
#include "make.h"

namespace puppetri::notation {
namespace {

using lang::Arc;
using lang::ArcKind;
using lang::Expr;
using lang::ExprKind;
using lang::Path;
using lang::Property;
using lang::Span;

constexpr std::string_view kForms =
    "from TIME to TIME: WHO VERB ..., at TIME: ..., when EVENT: ..., whenever EVENT: ..., with "
    "PLACE: ..., after CUE: ..., or then: ...";

// Words that name a parameter of the movement: throws ball to rui.
constexpr std::array kPrepositions = {
    std::string_view("to"),     std::string_view("from"), std::string_view("toward"),
    std::string_view("facing"), std::string_view("by"),   std::string_view("at"),
    std::string_view("before"), std::string_view("arms"), std::string_view("side")};

bool ends_with(std::string_view text, std::string_view end) {
    return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
}

// "waves" is wave, "catches" catch, "carries" carry, "goes" and "moves" go; a word without s is
// itself.
std::string movement_of(std::string_view verb) {
    if (verb == "moves" || verb == "move") {
        return "go";
    }
    const std::string text(verb);
    if (ends_with(verb, "ies")) {
        return text.substr(0, text.size() - 3) + "y";
    }
    for (const std::string_view end : {"ches", "shes", "sses", "xes", "zes", "oes"}) {
        if (ends_with(verb, end)) {
            return text.substr(0, text.size() - 2);
        }
    }
    return ends_with(verb, "s") && !ends_with(verb, "ss") ? text.substr(0, text.size() - 1) : text;
}

class Script {
 public:
    Script(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), file_(file), teller_(block, file, out), body_(out.net.body) {}

    void lower() {
        for (const Property& p : block_.properties) {
            if (p.name.steps.size() == 1 && p.name.steps[0].text == "mark") {
                mark(p);
            }
        }
        for (const Property& p : block_.properties) {
            if (p.name.steps.size() != 1 || p.name.steps[0].text != "mark") {
                read(p);
            }
        }
        for (Cue& cue : cues_) {
            follow(cue);
        }
        if (cues_.empty()) {
            teller_.error("empty-script", block_.name.span, "nobody does anything in this script",
                          "write at least one cue, such as: at 2 s: ana waves");
            return;
        }
        write();
    }

 private:
    enum class Trigger { kTime, kEvent, kCondition, kPlaces, kCues };
    struct After {
        std::string cue;
        Expr delay;
        Span span;
    };
    struct Cue {
        const Property* property = nullptr;
        std::string name;
        lang::Caption caption;
        Trigger trigger = Trigger::kTime;
        bool again = false;  // whenever
        Expr begins, lasts;  // kTime; what `from .. to` or `for` say
        std::vector<Path> events, places;
        Expr condition;
        std::vector<After> after;
        std::vector<std::pair<std::string, Expr>> does;  // the place and its movement
        Expr runs;
        Path raises;
        std::vector<std::string> followers;  // wait places that get a token when it ends
    };

    void mark(const Property& p) {
        Line line(p, teller_);
        const Path* name = line.path("the name of a mark");
        const Expr* at = name != nullptr ? line.value("a point, such as (1, 0, 2) m") : nullptr;
        line.finish("mark NAME (x, y, z) m");
        if (at != nullptr && !marks_.emplace(name->steps[0].text, *at).second) {
            teller_.error("name-twice", p.span, "there is already a mark " + name->steps[0].text,
                          "choose another name");
        }
    }

    const Expr& resolved(const Expr& e) const {
        const auto found = marks_.find(std::string(word_of(e)));
        return found == marks_.end() ? e : found->second;
    }

    // -- one line
    void read(const Property& p) {
        Line line(p, teller_);
        Cue cue;
        cue.property = &p;
        const std::string& word = p.name.steps[0].text;
        bool good = p.name.steps.size() == 1;
        if (word == "from" && good) {
            const Expr* begins = line.value("a time");
            if (begins == nullptr || !line.word("to")) {
                return wrong(p, "`to` and a second time are wanted");
            }
            const Expr* ends = line.value("a time");
            if (ends == nullptr) {
                return;
            }
            cue.begins = *begins;
            cue.lasts = make_binary(lang::Op::kSubtract, *ends, *begins);
            if (begins->kind == ExprKind::kNumber && ends->kind == ExprKind::kNumber &&
                begins->unit == ends->unit && compare(ends->number, begins->number) <= 0) {
                teller_.error("ends-before-it-begins", ends->span,
                              "this time is not after the first one", "write a later time");
            }
        } else if (word == "at" && good) {
            if (const Expr* e = line.value("a time")) {
                cue.begins = *e;
            } else {
                return;
            }
        } else if ((word == "when" || word == "whenever") && good) {
            const Expr* e = line.value("an event or a condition");
            if (e == nullptr) {
                return;
            }
            cue.again = word == "whenever";
            cue.trigger =
                paths_of(*e, lang::Op::kOr, cue.events) ? Trigger::kEvent : Trigger::kCondition;
            cue.condition = *e;
            if (cue.trigger == Trigger::kCondition && cue.again) {
                return wrong(p, "only an event can occur again and again");
            }
        } else if (word == "with" && good) {
            const Expr* e = line.value("places");
            if (e == nullptr || !paths_of(*e, lang::Op::kAnd, cue.places)) {
                return wrong(p, "places are wanted");
            }
            cue.trigger = Trigger::kPlaces;
        } else if (word == "after" && good) {
            const Expr* e = line.value("the name of a cue");
            if (e == nullptr || !after(*e, cue)) {
                return wrong(p, "names of cues are wanted, joined by `and`, perhaps with + TIME");
            }
            cue.trigger = Trigger::kCues;
        } else if (word == "then" && good) {
            if (cues_.empty()) {
                return wrong(p, "there is no cue before this");
            }
            cue.after.push_back({cues_.back().name, {}, p.span});
            cue.trigger = Trigger::kCues;
        } else {
            return wrong(p, lang::to_text(p.name) + " begins no cue");
        }
        line.symbol(":");
        action(line, cue);
    }

    void wrong(const Property& p, const std::string& what) {
        teller_.error("syntax", p.span, what, "write " + std::string(kForms));
    }

    // A, A + 2 s, A and B + 1 s
    bool after(const Expr& e, Cue& cue) {
        if (const std::string_view name = word_of(e); !name.empty()) {
            cue.after.push_back({std::string(name), {}, e.span});
            return true;
        }
        if (e.kind != ExprKind::kBinary) {
            return false;
        }
        if (e.op == lang::Op::kAdd && !word_of(e.args[0].value).empty() && e.args.size() == 2) {
            cue.after.push_back({std::string(word_of(e.args[0].value)), e.args[1].value, e.span});
            return true;
        }
        return e.op == lang::Op::kAnd &&
               std::all_of(e.args.begin(), e.args.end(),
                           [&](const lang::Argument& a) { return after(a.value, cue); });
    }

    // WHO VERB ... | runs NET(...) | raise EVENT, then `for TIME`, `as NAME`, a caption
    void action(Line& line, Cue& cue) {
        const Property& p = *cue.property;
        if (line.word("runs")) {
            if (const Expr* e = line.value("a net")) {
                cue.runs = *e;
                cue.name = e->path.empty() ? "runs" : e->path.steps.back().text;
            }
        } else if (line.word("raise")) {
            if (const Path* e = line.path("an event")) {
                cue.raises = *e;
                cue.name = "raise_" + e->steps.back().text;
            }
        } else {
            const Expr* who = line.value("somebody, and what they do: ana waves");
            std::vector<Path> actors;
            if (who == nullptr) {
                return;
            }
            if (!paths_of(*who, lang::Op::kAnd, actors)) {
                return wrong(p, "somebody is wanted, and what they do: ana waves");
            }
            const Expr* verb = line.value("what " + lang::to_text(*who) + " does, such as waves");
            if (verb == nullptr) {
                return;
            }
            if (verb->path.steps.size() != 1) {
                return wrong(p, "what " + lang::to_text(*who) + " does is wanted, such as waves");
            }
            sentence(line, cue, actors, *verb);
        }
        while (!line.done()) {
            if (line.word("for")) {
                if (const Expr* e = line.value("a time")) {
                    if (cue.lasts) {
                        wrong(p, "how long is said twice");
                    }
                    cue.lasts = *e;
                }
            } else if (line.word("as")) {
                if (const Path* name = line.path("a name")) {
                    cue.name = name->steps[0].text;
                    named_ = true;
                }
            } else if (lang::Caption caption = line.caption(); !caption.text.empty()) {
                cue.caption = std::move(caption);
            } else {
                line.finish(kForms);
            }
        }
        if (cue.runs && cue.lasts) {
            teller_.error("conflicting-clauses", p.span, "a net ends when it has ended",
                          "say at TIME instead of from .. to, and leave `for` out");
        }
        const std::string wanted = cue.name;
        for (int i = 2; names_.count(cue.name) != 0; ++i) {
            cue.name = wanted + "_" + std::to_string(i);
        }
        if (named_ && cue.name != wanted) {
            teller_.error("name-twice", p.span, "there is already a cue " + wanted,
                          "choose another name");
        }
        named_ = false;
        names_[cue.name] = cues_.size();
        cues_.push_back(std::move(cue));
    }

    void sentence(Line& line, Cue& cue, const std::vector<Path>& actors, const Expr& verb) {
        const Property& p = *cue.property;
        const std::string& said = verb.path.steps[0].text;
        std::string movement = movement_of(said);
        for (const std::string_view particle : {"up", "over"}) {
            if (line.word(particle)) {
                movement += "_" + std::string(particle);
            }
        }
        Expr call = make_call({}, {}, verb.span);
        if (verb.kind == ExprKind::kCall) {
            call.args = verb.args;
        }
        std::string preposition;
        while (const Expr* e = line.peek()) {
            const std::string_view word = word_of(*e);
            if (e->kind == ExprKind::kSymbol || e->kind == ExprKind::kString || word == "for" ||
                word == "as") {
                break;
            }
            line.value("a value");
            if (preposition.empty() &&
                std::find(kPrepositions.begin(), kPrepositions.end(), word) !=
                    kPrepositions.end() &&
                line.peek() != nullptr) {
                preposition = word;
                continue;
            }
            lang::Argument argument{{}, resolved(*e)};
            if (!preposition.empty()) {
                argument.name = make_name(preposition, e->span);
            } else if (e->kind == ExprKind::kNumber && e->unit.empty() && line.peek() != nullptr &&
                       !word_of(*line.peek()).empty() && word_of(*line.peek()) != "for" &&
                       word_of(*line.peek()) != "as") {  // walks 4 steps
                argument.name = make_name(std::string(word_of(*line.peek())), e->span);
                line.value("a word");
            } else if (movement == "go") {  // moves p0 to p1: it stands on p0
                stands(actors, *e, argument.value);
                continue;
            }
            if (movement == "go" && preposition == "to") {
                for (const Path& who : actors) {
                    stands_at_[lang::to_text(who)] = lang::to_text(argument.value);
                }
            }
            preposition.clear();
            call.args.push_back(std::move(argument));
        }
        if (!preposition.empty()) {
            wrong(p, "something is missing behind `" + preposition + "`");
        }
        std::string group;
        for (const Path& who : actors) {
            Expr does = call;
            does.path = who;
            does.path.steps.push_back(make_name(movement, verb.span));
            does.path.span = verb.span;
            does.kind = ExprKind::kCall;
            std::string name;
            for (const lang::Name& step : who.steps) {
                name += (name.empty() ? "" : "_") + step.text;
            }
            group += (group.empty() ? "" : "_and_") + name;
            cue.does.emplace_back(name, std::move(does));
        }
        cue.name = group + "_" + said;
    }

    // Who moves p0 to p1 must be on p0: where the cue before sent them, or the cast put them.
    void stands(const std::vector<Path>& actors, const Expr& said, const Expr& from) {
        for (const Path& who : actors) {
            const std::string name = lang::to_text(who);
            std::string at;
            if (const auto found = stands_at_.find(name); found != stands_at_.end()) {
                at = found->second;
            } else {
                for (const lang::CastMember& member : file_.body.cast) {
                    for (const Property& property : member.properties) {
                        if (member.name.text == name && property.name.steps[0].text == "at" &&
                            property.values.size() == 1) {
                            at = lang::to_text(property.values[0]);
                        }
                    }
                }
            }
            if (!at.empty() && at != lang::to_text(from)) {
                teller_.warn(
                    "stands-elsewhere", said.span,
                    name + " is at " + at + " then, not at " + lang::to_text(from),
                    "begin where the line before ends, or leave it out: " + name + " moves to ...");
            }
        }
    }

    // -- the net
    std::string wait_place(const Cue& cue, std::size_t i) const {
        return cue.name + "_waits" + (i == 0 ? "" : "_" + std::to_string(i + 1));
    }

    void follow(Cue& cue) {
        for (std::size_t i = 0; i < cue.after.size(); ++i) {
            const auto found = names_.find(cue.after[i].cue);
            if (found == names_.end()) {
                teller_.error("unknown-name", cue.after[i].span,
                              "there is no cue " + cue.after[i].cue + " in this script",
                              "name the cue with `as " + cue.after[i].cue +
                                  "`, or write what it is called: WHO_VERB");
                continue;
            }
            Cue& before = cues_[found->second];
            if (&before == &cue) {
                teller_.error("cue-cycle", cue.after[i].span, "this cue waits for itself",
                              "write a time, an event or another cue");
            }
            before.followers.push_back(wait_place(cue, i));
        }
    }

    void place(const std::string& name, Span where, lang::Duration takes = {}) {
        lang::Place made = make_place(make_name(name, where));
        made.takes = std::move(takes);
        body_.places.push_back(std::move(made));
    }

    static Path path(const std::string& name, Span where) { return make_path(name, where); }

    void write() {
        const Span top = block_.name.span;
        lang::Place begin = make_place(make_name("begin", top));
        begin.is_public = true;
        begin.role = lang::Role::kStart;
        give_token(begin);
        body_.places.push_back(std::move(begin));
        lang::Place done = make_place(make_name("done", top));
        done.is_public = true;
        done.role = lang::Role::kFinish;
        body_.places.push_back(std::move(done));
        lang::Transition start = make_transition(make_name("start", top), {path("begin", top)}, {});
        lang::Transition finish =
            make_transition(make_name("finish", top), {}, {path("done", top)});
        bool ends = true;
        for (const Cue& cue : cues_) {
            const Span where = cue.property->span;
            lang::Transition begins =
                make_transition(make_name(cue.name + "_begins", where), {}, {});
            lang::Transition finishes =
                make_transition(make_name(cue.name + "_ends", where), {}, {});
            const std::size_t waits = std::max<std::size_t>(1, cue.after.size());
            for (std::size_t i = 0; i < waits; ++i) {
                const std::string name = wait_place(cue, i);
                place(name, where,
                      cue.trigger == Trigger::kTime ? make_duration(cue.begins)
                      : i < cue.after.size() && cue.after[i].delay
                          ? make_duration(cue.after[i].delay)
                          : lang::Duration{});
                begins.inputs.push_back(make_arc(ArcKind::kTake, path(name, where)));
                if (cue.after.empty()) {
                    start.outputs.push_back(make_arc(ArcKind::kGive, path(name, where)));
                }
            }
            begins.events = cue.events;
            begins.next_event = !cue.events.empty();
            if (cue.trigger == Trigger::kCondition) {
                begins.guard = cue.condition;
            }
            for (const Path& p : cue.places) {
                begins.tests.push_back(make_arc(ArcKind::kWith, p));
            }
            performed(cue, begins, finishes);
            if (!cue.raises.empty()) {
                finishes.raises.push_back(cue.raises);
            }
            for (const std::string& follower : cue.followers) {
                finishes.outputs.push_back(make_arc(ArcKind::kGive, path(follower, where)));
            }
            if (cue.again) {
                ends = false;
                finishes.outputs.push_back(
                    make_arc(ArcKind::kGive, path(wait_place(cue, 0), where)));
            } else {
                place(cue.name + "_over", where);
                finishes.outputs.push_back(
                    make_arc(ArcKind::kGive, path(cue.name + "_over", where)));
                finish.inputs.push_back(make_arc(ArcKind::kTake, path(cue.name + "_over", where)));
            }
            for (lang::Transition* t : {&begins, &finishes}) {
                t->span = where;
                t->is_public = true;
                body_.transitions.push_back(std::move(*t));
            }
        }
        start.span = finish.span = top;
        start.is_public = finish.is_public = true;
        body_.transitions.push_back(std::move(start));
        if (ends) {
            body_.transitions.push_back(std::move(finish));
        }
    }

    // The places in which a cue is done.
    void performed(const Cue& cue, lang::Transition& begins, lang::Transition& finishes) {
        const Span where = cue.property->span;
        std::vector<std::string> names;
        const std::size_t parts = std::max<std::size_t>(1, cue.does.size());
        for (std::size_t i = 0; i < parts; ++i) {
            lang::Place made = make_place(
                make_name(parts == 1 ? cue.name : cue.name + "_" + cue.does[i].first, where));
            made.span = where;
            made.is_public = true;
            made.caption = cue.caption;
            made.runs = cue.runs;
            if (i < cue.does.size()) {
                made.does = cue.does[i].second;
            }
            if (cue.lasts) {
                made.takes = make_duration(cue.lasts);
            }
            names.push_back(made.name.text);
            begins.outputs.push_back(make_arc(ArcKind::kGive, path(names.back(), where)));
            finishes.inputs.push_back(make_arc(ArcKind::kTake, path(names.back(), where)));
            body_.places.push_back(std::move(made));
        }
        if (parts > 1) {
            lang::State state;
            state.name = make_name(cue.name, where);
            state.caption = cue.caption;
            state.is_public = true;
            state.span = where;
            for (const std::string& name : names) {
                Expr e = make_reference(name, where);
                state.formula = state.formula ? make_binary(lang::Op::kOr, std::move(state.formula),
                                                            std::move(e))
                                              : std::move(e);
            }
            body_.states.push_back(std::move(state));
        }
    }

    const lang::Block& block_;
    const lang::File& file_;
    Teller teller_;
    lang::Body& body_;
    std::map<std::string, Expr> marks_;
    std::map<std::string, std::string> stands_at_;  // by actor, as written
    std::vector<Cue> cues_;
    std::map<std::string, std::size_t> names_;
    bool named_ = false;
};

}  // namespace

void lower_script(const lang::Block& block, const lang::File& file, Lowered& out) {
    Script(block, file, out).lower();
}

}  // namespace puppetri::notation
