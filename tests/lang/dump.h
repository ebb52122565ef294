// SPDX-License-Identifier: MIT
// A syntax tree as text without positions: two files with the same dump say the same.
#pragma once
#include <string>

#include "puppetri/lang/syntax.h"

namespace puppetri::lang::testing {

class Dump {
 public:
    static std::string of(const File& file) {
        Dump dump;
        const Header& h = file.header;
        dump.item("header", h.language, h.title, h.frames_per_second,
                  static_cast<int>(h.horizon_kind), h.horizon, h.seed, h.pace, h.time_unit);
        for (const Import& i : file.imports) {
            dump.item("import", i.names, i.path);
        }
        dump.body(file.body);
        return dump.out_;
    }
    static std::string of(const Expr& e) {
        Dump dump;
        dump.add(e);
        return dump.out_;
    }

 private:
    void add(const std::string& s) { out_ += '\'' + s + '\''; }
    void add(const char* s) { out_ += s; }
    void add(int i) { out_ += std::to_string(i); }
    void add(bool b) { out_ += b ? "yes" : "no"; }
    template <class T>
    void add(const std::vector<T>& list) {
        out_ += '[';
        for (const T& x : list) {
            add(x);
            out_ += ',';
        }
        out_ += ']';
    }
    void add(const Name& n) {
        add(n.text);
        if (!n.index.empty()) {
            add(n.index);
        }
    }
    void add(const Path& p) { add(p.steps); }
    void add(const Caption& c) { add(c.text); }
    void add(const Argument& a) { item("arg", a.name, a.value); }
    void add(const Binding& b) { item("bind", b.name, b.value); }
    void add(const Parameter& p) { item("param", p.name, p.type, p.default_value); }
    void add(const InitialTokens& t) { item("tokens", t.count, t.attributes, t.ready); }
    void add(const Arc& a) { item("arc", static_cast<int>(a.kind), a.weight, a.place, a.pattern); }
    void add(const Moment& m) { item("moment", m.transition, m.key); }
    void add(const Property& p) { item("property", p.name, p.values, p.has_children, p.children); }
    void add(const Expr& e) {
        item("expr", static_cast<int>(e.kind), static_cast<int>(e.op),
             std::to_string(e.number.numerator), std::to_string(e.number.denominator), e.unit,
             e.text, e.path, e.args);
    }
    template <class... T>
    void item(const char* kind, const T&... parts) {
        out_ += '(';
        out_ += kind;
        ((out_ += ' ', add(parts)), ...);
        out_ += ')';
    }
    void body(const Body& b) {
        out_ += '{';
        for (const Place& p : b.places) {
            item("place", p.name, p.caption, p.is_public, static_cast<int>(p.role), p.does, p.runs,
                 static_cast<int>(p.takes.kind), p.takes.value, p.takes.as, p.tokens, p.capacity,
                 p.keeps_order, static_cast<int>(p.discipline), p.by_arrival, p.discipline_key,
                 p.of_type, p.attributes, p.same_as, p.starts, p.final);
        }
        for (const Transition& t : b.transitions) {
            item("transition", t.name, t.caption, t.is_public, t.inputs, t.outputs, t.tests,
                 t.priority, t.guard, t.events, t.delay, static_cast<int>(t.memory), t.servers,
                 t.holding, t.holding_left, t.assignments, t.odds, t.raises, t.together_with,
                 t.send, t.message, t.receive, t.received, t.poll);
        }
        for (const State& s : b.states) {
            item("state", s.name, s.caption, s.is_public, s.formula);
        }
        for (const Data& d : b.data) {
            item("data", d.name, d.caption, d.is_public, d.type, d.initial);
        }
        for (const Channel& c : b.channels) {
            item("channel", c.name, c.caption, c.is_public, c.type);
        }
        for (const Enumeration& e : b.enumerations) {
            item("enum", e.name, e.values);
        }
        for (const TokenType& t : b.token_types) {
            item("token", t.name, t.attributes);
        }
        for (const Event& e : b.events) {
            item("event", e.name, e.caption, e.is_public, e.is_consumed, e.at, e.every, e.from,
                 e.until);
        }
        for (const EventFile& e : b.event_files) {
            item("events", e.path);
        }
        for (const Use& u : b.uses) {
            item("use", u.name, u.net, u.path, u.args);
        }
        for (const Rule& r : b.rules) {
            item("rule", r.name, r.caption, static_cast<int>(r.kind), r.operands, r.bound,
                 r.when_settled);
        }
        for (const Question& q : b.questions) {
            item("question", q.name, q.caption, static_cast<int>(q.kind), q.about);
        }
        for (const Measure& m : b.measures) {
            item("measure", m.name, m.caption, m.statistic, m.percent, static_cast<int>(m.seen),
                 m.value, m.place, m.from, m.to, m.above);
        }
        for (const End& e : b.ends) {
            item("end", e.formulas);
        }
        for (const CastMember& c : b.cast) {
            item("cast", c.name, c.kind, c.properties);
        }
        for (const Block& k : b.blocks) {
            item("block", k.kind, k.name, k.parameters, k.properties);
        }
        for (const For& f : b.loops) {
            item("for", f.variable, f.domain);
            body(f.body);
        }
        for (const Net& n : b.nets) {
            item("net", n.name, n.caption, n.is_machine, n.parameters);
            body(n.body);
        }
        out_ += '}';
    }

    std::string out_;
};

}  // namespace puppetri::lang::testing
