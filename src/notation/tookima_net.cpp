// SPDX-License-Identifier: MIT
// A script as a net, sampled: at each of SAMPLES instants, evenly spaced over TIME_INTERVAL with
// both ends, every machine performs at most one of its actions, one machine after the other in the
// order of their definition. A message lives from the instant it is sent at to the next one: MATCH
// sees what was sent at the instant before. Of several actions that could be performed those that
// wait for something go before those that are TRUE, and then the first of the script does.
//   A token goes round: `rest` -> the turn of each machine -> `rest`. Each machine is a net of its
// own, `LEFT_LEG`, with a place for each state and one for each function that it calls, in which
// the movement runs: its end is what an event of the machine means in a state that began with the
// call. Events that no movement brings about come from outside.
#include <algorithm>
#include <map>
#include <set>

#include "ending.h"
#include "foreign_formats.h"
#include "make.h"
#include "puppetri/base/text.h"
#include "tookima.h"

namespace puppetri::notation {
namespace {

using namespace tookima;

constexpr const char* kNone = "(none)";  // the message that is none
constexpr const char* kMessages = "Message";
constexpr const char* kBegun = "tokens at first";  // parameter: 0 where the script begins later
// The script that ends with its interval: right after the last instant.
constexpr const char* kOnce = "_once";
constexpr std::int64_t kEnds = 999'999;

std::string heard(const std::string& channel) { return channel + " heard"; }
std::string said(const std::string& channel) { return channel + " said"; }
std::string moves(const std::string& function) { return function + " moves"; }
std::string turn_of(const std::string& machine) { return "turn of " + machine; }
std::string seen_by(const std::string& machine, const std::string& event) {
    return event + " seen by " + machine;
}

class ScriptNet {
 public:
    ScriptNet(const Script& script, lang::Parsed& out, std::uint32_t file)
        : script_(script), out_(out), file_(file), whole_{0, size(), file} {}

    void write() {
        check_names();
        check_channels();
        for (const Machine& m : script_.machines) {
            check_states(m);
        }
        if (has_errors(out_.diagnostics)) {
            return;
        }
        write_messages();
        for (const Machine& m : script_.machines) {
            out_.file.body.nets.push_back(machine_net(m));
        }
        if (file_ == 0) {
            write_header();
            write_script(out_.file.body);
            return;
        }
        out_.file.body.nets.push_back(script_net(false));
        out_.file.body.nets.push_back(script_net(true));
    }

 private:
    // `once`: for places that run it.
    lang::Net script_net(bool once) {
        lang::Net net;
        net.name = make_name(std::string(stem_of(out_.file.filename)) + (once ? kOnce : ""),
                             {0, 1, file_});
        net.span = whole_;
        for (const Machine& m : script_.machines) {
            if (!calls_of(m).empty()) {
                add_parameter(net, m.name, nullptr);
                net.parameters.back().hidden = true;
            }
        }
        for (const Word& f : functions_) {
            add_parameter(net, f, "movement");
            net.parameters.back().default_value =
                make_call(make_path("half_step", f.span), {}, f.span);
        }
        once_ = once;
        occurring_.clear();
        write_script(net.body);
        if (once) {
            end_script(net.body);
        }
        return net;
    }

    // No token rests, and no instant is to come.
    void end_script(lang::Body& body) {
        const lang::Span at = script_.sampled;
        Ending ending;
        ending.span = at;
        ending.said = true;
        const auto has = [&](const char* place, std::int64_t count) {
            return make_binary(lang::Op::kEqual, make_count(make_path(place, at)),
                               make_number(Rational{count}, at));
        };
        ending.when = make_both(has("rest", 1), has("instants", 0));
        for (const Machine& m : script_.machines) {
            const auto add = [&](const std::string& place, bool begins) {
                ending.within.push_back(
                    {make_path({make_name(m.name.text, at), make_name(place, at)}, at), begins});
            };
            for (const std::string& state : states_of(m)) {
                add(state, state == m.initial.text);
            }
            for (const Word& f : calls_of(m)) {
                add(f.text, false);
            }
        }
        Lowered lowered;
        Teller teller("script", out_.file, lowered);
        make_ways("script", ending, kEnds, teller, body);
        out_.diagnostics.insert(out_.diagnostics.end(), lowered.diagnostics.begin(),
                                lowered.diagnostics.end());
    }

    std::uint32_t size() const { return static_cast<std::uint32_t>(out_.file.text.size()); }

    void warn(std::string code, lang::Span where, const std::string& element, std::string message,
              std::string remedy) {
        tell(out_, Severity::kWarning, std::move(code), where, element, std::move(message),
             std::move(remedy));
    }
    void error(std::string code, lang::Span where, const std::string& element, std::string message,
               std::string remedy) {
        tell(out_, Severity::kError, std::move(code), where, element, std::move(message),
             std::move(remedy));
    }

    // ---- what a script gets wrong

    static std::vector<std::string> texts(const std::vector<Word>& list) {
        std::vector<std::string> out;
        for (const Word& w : list) {
            out.push_back(w.text);
        }
        return out;
    }

    // Declares what is used and was not; told once per name.
    void declare(std::vector<Word>& list, const Word& used, const char* statement,
                 const std::string& element) {
        if (index_of(list, used.text) >= 0) {
            return;
        }
        const std::vector<std::string> known = texts(list);
        const std::string_view nearest = nearest_name(used.text, known);
        warn("undeclared", used.span, element,
             used.text + " is used, and no " + statement + " declares it",
             nearest.empty() ? std::string("write ") + statement + "(" + used.text + ") above"
                             : "did you mean " + std::string(nearest) + "?");
        list.push_back(used);
    }

    void check_names() {
        channels_ = script_.channels;
        functions_ = script_.functions;
        std::vector<Word> events = script_.events;
        for (const Machine& m : script_.machines) {
            const std::string element = "machine " + m.name.text;
            if (!m.begun) {
                warn("never-begun", m.name.span, element, m.name.text + " has no actions",
                     "write BEGIN_ESM(" + m.name.text + ") ... END_ESM, or remove it");
            }
            std::vector<Word> used, listened;
            for (const Action& a : m.actions) {
                if (a.when == When::kMatch) {
                    declare(channels_, a.subject, "DEF_CHANNEL", element);
                    used.push_back(a.subject);
                }
                if (a.when == When::kEvent) {
                    declare(events, a.subject, "DEF_EVENT", element);
                    listened.push_back(a.subject);
                }
                if (a.task == Task::kCall) {
                    declare(functions_, a.target, "FUNCTION", element);
                }
                if (a.task == Task::kSend || a.task == Task::kSendState) {
                    declare(channels_, a.target, "DEF_CHANNEL", element);
                    used.push_back(a.target);
                }
                check_sent(m, a, element);
            }
            check_listed(m, m.channels, used, channels_, "CHANNEL", element);
            check_listed(m, m.events, listened, events, "EVENT", element);
        }
    }

    void check_sent(const Machine& m, const Action& a, const std::string& element) {
        if (a.task != Task::kSendState || a.sent.text == m.name.text) {
            return;
        }
        const bool other =
            std::any_of(script_.machines.begin(), script_.machines.end(),
                        [&](const Machine& machine) { return machine.name.text == a.sent.text; });
        if (other) {
            error("other-state", a.sent.span, element,
                  "a machine sends its own state, and " + a.sent.text + " is another",
                  "write " + a.target.text + "=" + m.name.text);
        } else {
            warn("quotes-missing", a.sent.span, element,
                 a.sent.text + " is no machine, and is taken as a message",
                 "write " + a.target.text + "=\"" + a.sent.text + "\"");
        }
    }

    // CHANNEL(...) and EVENT(...) of a machine against what its actions use.
    void check_listed(const Machine& m, const std::vector<Word>& listed,
                      const std::vector<Word>& used, const std::vector<Word>& declared,
                      const std::string& statement, const std::string& element) {
        std::set<std::string> missing;
        for (const Word& w : used) {
            if (index_of(listed, w.text) < 0) {
                missing.insert(w.text);
            }
        }
        std::string names;
        for (const std::string& name : missing) {
            names += (names.empty() ? "" : ", ") + name;
        }
        bool told = false;
        for (const Word& w : listed) {
            if (index_of(declared, w.text) >= 0) {
                continue;
            }
            told = true;
            warn(
                "other-name", w.span, element,
                statement + "(" + w.text + ") names nothing of this script" +
                    (missing.empty() ? "" : "; the actions use " + names + ", which is not listed"),
                missing.empty() ? "remove it"
                                : "write " + statement + "(" + *missing.begin() + ")");
        }
        for (const std::string& name : told ? std::set<std::string>{} : missing) {
            warn("other-name", used[static_cast<std::size_t>(index_of(used, name))].span, element,
                 name + " is used in a machine that does not list it",
                 "write " + statement + "(" + name + ") behind BEGIN_ESM(" + m.name.text + ")");
        }
    }

    // The messages that a machine puts into a channel with this action.
    std::vector<std::string> sent_by(const Machine& m, const Action& a) const {
        if (a.task == Task::kSend || (a.task == Task::kSendState && a.sent.text != m.name.text)) {
            return {a.sent.text};
        }
        return a.task == Task::kSendState ? std::vector<std::string>{a.from.text}
                                          : std::vector<std::string>{};
    }

    void check_channels() {
        for (const Word& channel : channels_) {
            const std::string element = "channel " + channel.text;
            const Machine* sender = nullptr;
            const Machine* receiver = nullptr;
            const Action* sends = nullptr;
            const Action* matches = nullptr;
            std::set<std::string> sent;
            for (const Machine& m : script_.machines) {
                for (const Action& a : m.actions) {
                    const bool writes = a.task != Task::kCall && a.target.text == channel.text;
                    const bool reads = a.when == When::kMatch && a.subject.text == channel.text;
                    if (writes && sender != nullptr && sender != &m) {
                        error("two-senders", a.target.span, element,
                              sender->name.text + " and " + m.name.text +
                                  " both send, and a channel joins one machine to one other",
                              "define a channel for each of them");
                    }
                    if (reads && receiver != nullptr && receiver != &m) {
                        error("two-receivers", a.subject.span, element,
                              receiver->name.text + " and " + m.name.text +
                                  " both receive, and a channel joins one machine to one other",
                              "define a channel for each of them");
                    }
                    if (writes) {
                        sender = &m;
                        sends = &a;
                        for (std::string& message : sent_by(m, a)) {
                            sent.insert(std::move(message));
                        }
                    }
                    if (reads) {
                        receiver = &m;
                        matches = &a;
                    }
                }
            }
            if (sender != nullptr && sender == receiver) {
                error("channel-within", matches->subject.span, element,
                      sender->name.text + " would receive what it sends itself",
                      "remember it by a state of its own");
            } else if (sender != nullptr && receiver == nullptr) {
                warn("unmatched-channel-end", sends->target.span, element,
                     "nobody looks at what " + sender->name.text + " sends",
                     "add an action with MATCH(" + channel.text + ", ...), or remove the channel");
            } else if (receiver != nullptr && sender == nullptr) {
                warn("unmatched-channel-end", matches->subject.span, element,
                     "nobody sends what " + receiver->name.text + " waits for",
                     "add an action with " + channel.text + "=..., or remove the channel");
            }
            for (const Machine& m : script_.machines) {
                for (const Action& a : m.actions) {
                    if (a.when == When::kMatch && a.subject.text == channel.text &&
                        sender != nullptr && sent.count(a.message.text) == 0) {
                        const std::vector<std::string> known(sent.begin(), sent.end());
                        const std::string_view nearest = nearest_name(a.message.text, known);
                        warn("rendezvous-never", a.message.span, element,
                             "nobody ever sends \"" + a.message.text + "\"",
                             nearest.empty()
                                 ? "compare it with what " + sender->name.text + " sends"
                                 : "did you mean \"" + std::string(nearest) + "\"?");
                    }
                }
            }
        }
    }

    void check_states(const Machine& m) {
        std::set<std::string> entered = {m.initial.text};
        for (bool more = true; more;) {
            more = false;
            for (const Action& a : m.actions) {
                if (entered.count(a.from.text) != 0 && entered.insert(a.to.text).second) {
                    more = true;
                }
            }
        }
        std::set<std::string> told;
        for (const Action& a : m.actions) {
            if (entered.count(a.from.text) == 0 && told.insert(a.from.text).second) {
                const std::vector<std::string> known(entered.begin(), entered.end());
                const std::string_view nearest = nearest_name(a.from.text, known);
                warn("never-entered", a.from.span, "machine " + m.name.text,
                     "no way leads from \"" + m.initial.text + "\" to \"" + a.from.text + "\"",
                     nearest.empty() ? "add an action that leads to it, or remove these"
                                     : "did you mean \"" + std::string(nearest) + "\"?");
            }
        }
    }

    // ---- the net

    static void add_parameter(lang::Net& net, const Word& name, const char* type) {
        lang::Parameter p;
        p.name = make_name(name.text, name.span);
        if (type != nullptr) {
            p.type = make_reference(type, name.span);
        }
        p.span = name.span;
        net.parameters.push_back(std::move(p));
    }

    // The functions that a machine calls, and where first.
    static std::vector<Word> calls_of(const Machine& m) {
        std::vector<Word> out;
        for (const Action& a : m.actions) {
            if (a.task == Task::kCall && index_of(out, a.target.text) < 0) {
                out.push_back(a.target);
            }
        }
        return out;
    }
    // Those whose movement a state begins with.
    static std::vector<Word> begun_in(const Machine& m, const std::string& state) {
        std::vector<Word> out;
        for (const Action& a : m.actions) {
            if (a.task == Task::kCall && a.to.text == state && index_of(out, a.target.text) < 0) {
                out.push_back(a.target);
            }
        }
        return out;
    }
    // Events that no movement of the machine brings about.
    static std::vector<Word> outside_events(const Machine& m) {
        std::vector<Word> out;
        for (const Action& a : m.actions) {
            if (a.when == When::kEvent && begun_in(m, a.from.text).empty() &&
                index_of(out, a.subject.text) < 0) {
                out.push_back(a.subject);
            }
        }
        return out;
    }
    // The channels that it hears (reads), or says something on.
    static std::vector<Word> channels_of(const Machine& m, bool hears) {
        std::vector<Word> out;
        for (const Action& a : m.actions) {
            const bool sends = a.task == Task::kSend || a.task == Task::kSendState;
            if (hears ? a.when == When::kMatch : sends) {
                const Word& channel = hears ? a.subject : a.target;
                if (index_of(out, channel.text) < 0) {
                    out.push_back(channel);
                }
            }
        }
        return out;
    }

    void write_messages() {
        std::set<std::string> messages;
        for (const Machine& m : script_.machines) {
            for (const Action& a : m.actions) {
                for (std::string& message : sent_by(m, a)) {
                    messages.insert(std::move(message));
                }
                if (a.when == When::kMatch) {
                    messages.insert(a.message.text);
                }
            }
        }
        lang::Enumeration e;
        e.name = make_name(kMessages, {0, 1, file_});
        e.span = {0, 1, file_};
        e.values.push_back(make_name(kNone, e.span));
        for (const std::string& message : messages) {
            e.values.push_back(make_name(message, e.span));
        }
        out_.file.body.enumerations.push_back(std::move(e));
    }

    lang::Net machine_net(const Machine& m) {
        lang::Net net;
        net.name = make_name(m.name.text, m.name.span);
        net.span = m.name.span;
        const auto parameter = [&](std::string name) {
            add_parameter(net, {std::move(name), m.name.span}, nullptr);
        };
        parameter("turn");
        parameter("next");
        for (const bool hears : {true, false}) {
            for (const Word& channel : channels_of(m, hears)) {
                parameter(hears ? heard(channel.text) : said(channel.text));
            }
        }
        for (const Word& event : outside_events(m)) {
            parameter(seen_by(m.name.text, event.text));
        }
        const std::vector<Word> calls = calls_of(m);
        if (file_ != 0 && !calls.empty()) {
            add_parameter(net, m.name, nullptr);
            for (const Word& f : calls) {
                add_parameter(net, {moves(f.text), f.span}, "movement");
            }
        }
        add_parameter(net, {kBegun, m.name.span}, "int");
        net.parameters.back().default_value = make_number(Rational{1}, m.name.span);
        for (const std::string& state : states_of(m)) {
            lang::Place place = make_place(make_name(state, first_mention(m, state)));
            place.is_public = true;
            if (state == m.initial.text) {
                give_token(place);
                place.tokens.back().count = make_reference(kBegun, m.name.span);
            }
            net.body.places.push_back(std::move(place));
        }
        for (const Word& f : calls) {
            net.body.places.push_back(movement_place(m, f));
        }
        // Those that wait for something go before those that are TRUE.
        std::int64_t rank = static_cast<std::int64_t>(m.actions.size()) + 1;
        for (const bool always : {false, true}) {
            for (const Action& a : m.actions) {
                if ((a.when == When::kTrue) == always) {
                    write_action(m, a, rank--, net.body);
                }
            }
        }
        lang::Transition pass =
            make_transition(make_name("waits", m.name.span), {make_path("turn", m.name.span)},
                            {make_path("next", m.name.span)});
        pass.is_public = true;
        net.body.transitions.push_back(std::move(pass));
        return net;
    }

    static std::set<std::string> states_of(const Machine& m) {
        std::set<std::string> states = {m.initial.text};
        for (const Action& a : m.actions) {
            states.insert(a.from.text);
            states.insert(a.to.text);
        }
        return states;
    }

    static lang::Span first_mention(const Machine& m, const std::string& state) {
        for (const Action& a : m.actions) {
            if (a.from.text == state) {
                return a.from.span;
            }
            if (a.to.text == state) {
                return a.to.span;
            }
        }
        return m.initial.span;
    }

    lang::Place movement_place(const Machine& m, const Word& f) {
        lang::Place place = make_place(make_name(f.text, f.span));
        place.is_public = true;
        place.capacity = make_number(Rational{1}, f.span);
        if (file_ != 0) {
            place.does = make_call(
                make_path({make_name(m.name.text, f.span), make_name(moves(f.text), f.span)},
                          f.span),
                {}, f.span);
        } else {
            tell(out_, Severity::kNote, "unbound-function", f.span, "function " + f.text,
                 "moves nobody here, and is taken to last from one instant to the next",
                 "bind it in a scene: use \"" + std::string(stem_of(out_.file.filename)) +
                     ".tookima\" as legs { " + m.name.text + ": ana.left_leg }");
            place.takes = make_duration(make_number(step(), f.span, "s"));
        }
        return place;
    }

    void write_action(const Machine& m, const Action& a, std::int64_t rank, lang::Body& body) {
        std::vector<std::optional<Word>> endings = {std::nullopt};
        if (a.when == When::kEvent) {
            const std::vector<Word> begun = begun_in(m, a.from.text);
            if (begun.empty()) {
                endings = {Word{seen_by(m.name.text, a.subject.text), a.subject.span}};
            } else {
                endings.assign(begun.begin(), begun.end());
            }
        }
        for (const std::optional<Word>& ending : endings) {
            const std::string base = a.from.text + "_to_" + a.to.text;
            const int same = ++names_[m.name.text + "." + base];
            lang::Transition t = make_transition(
                make_name(same == 1 ? base : base + "_" + std::to_string(same), a.span),
                {make_path("turn", a.span), make_path(a.from.text, a.from.span)},
                {make_path(a.to.text, a.to.span), make_path("next", a.span)});
            t.span = a.span;
            t.is_public = true;
            t.priority = make_number(Rational{rank + 1}, a.span);
            if (ending) {
                t.inputs.push_back(
                    make_arc(lang::ArcKind::kTake, make_path(ending->text, a.subject.span)));
            }
            if (a.when == When::kMatch) {
                t.guard = make_binary(lang::Op::kEqual,
                                      make_reference(heard(a.subject.text), a.subject.span),
                                      make_reference(a.message.text, a.message.span));
            }
            for (const std::string& message : sent_by(m, a)) {
                t.assignments.push_back(make_assignment(make_path(said(a.target.text), a.span),
                                                        make_reference(message, a.sent.span)));
            }
            if (a.task == Task::kCall) {
                // An end that nobody has looked at is forgotten.
                if (!ending || ending->text != a.target.text) {
                    t.inputs.push_back(
                        make_arc(lang::ArcKind::kTakeAll, make_path(a.target.text, a.target.span)));
                }
                t.outputs.push_back(
                    make_arc(lang::ArcKind::kGive, make_path(a.target.text, a.target.span)));
            }
            body.transitions.push_back(std::move(t));
        }
    }

    Rational step() const {
        const auto length = subtract(script_.to, script_.from);
        const auto part = length ? divide(*length, Rational{script_.samples - 1}) : std::nullopt;
        return part.value_or(Rational{1});
    }

    void write_header() {
        lang::Header& header = out_.file.header;
        header.title = {std::string(stem_of(out_.file.filename)), {0, 1, 0}};
        header.scene_span = {0, 1, 0};
        header.horizon_kind = lang::HorizonKind::kTime;
        header.horizon = make_number(script_.to, script_.interval, "s");
    }

    void write_script(lang::Body& body) {
        const lang::Span at = script_.sampled;
        lang::Event instants;
        instants.name = make_name("instants", at);
        instants.is_public = true;
        instants.span = at;
        for (std::int64_t k = 0; k < script_.samples; ++k) {
            const auto part = multiply(step(), Rational{k});
            const auto t = part ? add(script_.from, *part) : std::nullopt;
            if (!t) {
                error("wrong-samples", at, "script", "these instants are no numbers that fit",
                      "choose a rounder interval");
                return;
            }
            instants.at.push_back(make_number(*t, at, "s"));
        }
        body.events.push_back(std::move(instants));
        lang::Place rest = make_place(make_name("rest", at));
        rest.caption = {"between two instants", at};
        rest.is_public = true;
        give_token(rest);
        body.places.push_back(std::move(rest));
        if (!once_) {
            lang::End end;
            end.formulas.push_back(make_reference("rest", at));
            end.span = at;
            body.ends.push_back(std::move(end));
        }
        const std::vector<Machine>& machines = script_.machines;
        lang::Transition sample =
            make_transition(make_name("sample", at), {make_path("rest", at)},
                            {make_path(turn_of(machines.front().name.text), at)});
        sample.is_public = true;
        sample.span = at;
        sample.events.push_back(make_path("instants", at));
        for (const Word& channel : channels_) {
            for (const bool hears : {true, false}) {
                lang::Data d;
                d.name = make_name(hears ? heard(channel.text) : said(channel.text), channel.span);
                d.is_public = true;
                d.type = make_reference(kMessages, channel.span);
                d.initial = make_reference(kNone, channel.span);
                d.span = channel.span;
                body.data.push_back(std::move(d));
            }
            sample.assignments.push_back(
                make_assignment(make_path(heard(channel.text), channel.span),
                                make_reference(said(channel.text), channel.span)));
            sample.assignments.push_back(make_assignment(
                make_path(said(channel.text), channel.span), make_reference(kNone, channel.span)));
        }
        body.transitions.push_back(std::move(sample));
        for (std::size_t k = 0; k < machines.size(); ++k) {
            use_machine(machines[k],
                        k + 1 < machines.size() ? turn_of(machines[k + 1].name.text) : "rest",
                        body);
        }
    }

    void use_machine(const Machine& m, const std::string& next, lang::Body& body) {
        const lang::Span at = m.name.span;
        lang::Place turn = make_place(make_name(turn_of(m.name.text), at));
        turn.is_public = true;
        body.places.push_back(std::move(turn));
        lang::Use use;
        use.name = make_name(m.name.text, at);
        use.net = make_path(m.name.text, at);
        use.span = at;
        const auto give = [&](const std::string& name, lang::Span span) {
            use.args.push_back({{}, make_reference(name, span)});
        };
        give(turn_of(m.name.text), at);
        give(next, at);
        for (const bool hears : {true, false}) {
            for (const Word& channel : channels_of(m, hears)) {
                give(hears ? heard(channel.text) : said(channel.text), at);
            }
        }
        for (const Word& event : outside_events(m)) {
            const std::string seen = seen_by(m.name.text, event.text);
            if (occurring_.insert(event.text).second) {
                lang::Event e;
                e.name = make_name(event.text, event.span);
                e.is_public = true;
                e.span = event.span;
                body.events.push_back(std::move(e));
            }
            lang::Place latch = make_place(make_name(seen, event.span));
            latch.is_public = true;
            body.places.push_back(std::move(latch));
            lang::Transition occurs = make_transition(make_name(seen + " now", event.span), {},
                                                      {make_path(seen, event.span)});
            occurs.events.push_back(make_path(event.text, event.span));
            occurs.tests.push_back(make_arc(lang::ArcKind::kUnless, make_path(seen, event.span)));
            body.transitions.push_back(std::move(occurs));
            give(seen, event.span);
        }
        const std::vector<Word> calls = calls_of(m);
        if (file_ != 0 && !calls.empty()) {
            give(m.name.text, at);
            for (const Word& f : calls) {
                give(f.text, f.span);
            }
        }
        if (once_) {
            use.args.push_back({make_name(kBegun, at), make_number(Rational{0}, at)});
        }
        body.uses.push_back(std::move(use));
    }

    const Script& script_;
    lang::Parsed& out_;
    std::uint32_t file_;
    lang::Span whole_;
    std::vector<Word> channels_, functions_;  // also those that were not declared
    std::map<std::string, int> names_;
    std::set<std::string> occurring_;
    bool once_ = false;  // the script that is written ends with its interval
};

}  // namespace

void read_tookima(lang::Parsed& out, std::uint32_t file) {
    const Script script = tookima::parse(out, file);
    if (!has_errors(out.diagnostics)) {
        ScriptNet(script, out, file).write();
    }
}

}  // namespace puppetri::notation
