// SPDX-License-Identifier: MIT
// Networks that pass messages both ways: nodes joined by links, on which messages travel in either
// direction. A node takes the messages that reach it one at a time, in the order in which they
// came; one that is meant for it may be answered, others go on to the next node on the way, over
// the fewest links. All tables are made here; the net has a place for what waits, what is handled,
// what is to be sent, and for each direction of each link.
//   messages whispers {
//     message hello
//     message reply
//     node ana does ana.wave takes 1 s
//     node rui takes 1 s
//     node eve takes 1 s
//     link ana rui takes 0.5 s
//     link rui eve takes 0.5 s
//     ana sends hello to eve every 10 s
//     eve answers hello with reply
//   }
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ending.h"
#include "kinds.h"
#include "line.h"
#include "literal.h"
#include "make.h"

namespace puppetri::notation {
namespace {

using lang::Expr;
using lang::ExprKind;
using lang::Op;

// Messages that reach a node in one instant line up in the order of the links: a settled order.
// What a node has handled leaves first, then what links bring, then nodes begin, then they send.
constexpr std::int64_t kHandled = 4'000'000, kArrives = 3'000'000, kBegins = 2'000'000,
                       kSends = 1'000'000;

// Right after the message has been handled.
constexpr std::int64_t kEnds = kHandled + 1;
constexpr const char* kEnding = "messages_ending";

// Variables of the transitions: names that nobody else uses.
constexpr const char* kKind = "its kind";
constexpr const char* kTo = "its target";
constexpr const char* kFrom = "its sender";

constexpr std::string_view kNodeForm = "node NAME \"caption\" takes TIME does MOVEMENT";
constexpr std::string_view kLinkForm = "link NODE NODE takes TIME [one at a time] [one way]";
constexpr std::string_view kSendForm =
    "NODE sends MESSAGE to NODE at TIME, every TIME, or on EVENT; to all";
constexpr std::string_view kEndForm = "ends when NODE has handled MESSAGE";
constexpr std::string_view kAnswerForm = "NODE answers MESSAGE with MESSAGE";

class Messages {
 public:
    Messages(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out), body_(out.net.body) {}

    void lower() {
        if (!has_plain_lines(block_, teller_)) {
            return;
        }
        const auto each = [this](std::string_view word, const auto& read) {
            each_line(
                block_, teller_, [&](const lang::Property& p) { return kind_of(p) == word; }, read);
        };
        each("message", [this](Line& line) { message(line); });
        each("node", [this](Line& line) { node(line); });
        each("link", [this](Line& line) { link(line); });
        if (nodes_.empty()) {
            teller_.error("no-states", block_.name.span, "there is no node",
                          "give each a line of its own: node NAME takes 1 s");
            return;
        }
        if (kinds_.empty()) {
            kinds_.push_back(make_name("message", block_.name.span));
        }
        find_ways();
        each("answers", [this](Line& line) { answer(line); });
        each("sends", [this](Line& line) { send(line); });
        each("ends", [this](Line& line) { ending(line); });
        for (const lang::Property& p : block_.properties) {
            if (kind_of(p).empty()) {
                teller_.error("syntax", p.span, "this is no node, link, message, sending or end",
                              "write " + std::string(kNodeForm));
            }
        }
        make();
        make_ways("messages", ending_, kEnds, teller_, body_);
    }

 private:
    struct Node {
        lang::Name name;
        lang::Caption caption;
        Expr does;
        lang::Duration takes;
        lang::Path raises;
        lang::Span span;
        std::map<std::string, std::pair<std::string, lang::Span>> answers;
        std::vector<std::size_t> next;  // by target: the link to go by; none: itself or no way
    };
    // One direction of a link.
    struct Way {
        std::size_t from = 0, to = 0;
        Expr takes;
        std::string shared;  // the place of the link's token; empty: as many as there are
        lang::Span span;
    };
    static constexpr std::size_t kNone = ~std::size_t{0};

    static std::string kind_of(const lang::Property& p) {
        const std::string& first = p.name.steps[0].text;
        if (first == "message" || first == "node" || first == "link") {
            return first;
        }
        if (is_ending(p)) {
            return "ends";
        }
        if (!p.values.empty() && p.values[0].kind == ExprKind::kPath &&
            p.values[0].path.steps.size() == 1) {
            const std::string& verb = p.values[0].path.steps[0].text;
            if (verb == "sends" || verb == "answers") {
                return verb;
            }
        }
        return "";
    }

    void message(Line& line) {
        const lang::Path* path = line.path("the name of a kind of message");
        line.finish("message NAME");
        if (path == nullptr) {
            return;
        }
        if (has_kind(path->steps[0].text)) {
            teller_.error("name-twice", line.span(),
                          "there is already a message " + path->steps[0].text,
                          "choose another name");
            return;
        }
        kinds_.push_back(path->steps[0]);
    }

    bool has_kind(std::string_view name) const {
        return std::any_of(kinds_.begin(), kinds_.end(),
                           [&](const lang::Name& k) { return k.text == name; });
    }

    void node(Line& line) {
        const lang::Path* path = line.path("the name of a node");
        if (path == nullptr) {
            return;
        }
        Node made{.name = path->steps[0],
                  .caption = line.caption(),
                  .does = {},
                  .takes = {},
                  .raises = {},
                  .span = line.span(),
                  .answers = {},
                  .next = {}};
        while (!line.done()) {
            if (line.takes(made.takes) || line.clause("does", "a movement", made.does)) {
                continue;
            }
            if (line.word("raises")) {
                if (const lang::Path* event = line.path("the name of an event")) {
                    made.raises = *event;
                }
            } else {
                line.finish(kNodeForm);
            }
        }
        if (!numbers_.emplace(made.name.text, nodes_.size()).second) {
            teller_.error("name-twice", made.span, "there is already a node " + made.name.text,
                          "choose another name");
            return;
        }
        nodes_.push_back(std::move(made));
    }

    std::optional<std::size_t> find(const lang::Path* path) {
        if (path == nullptr) {
            return std::nullopt;
        }
        const auto found =
            path->steps.size() == 1 ? numbers_.find(path->steps[0].text) : numbers_.end();
        if (found == numbers_.end()) {
            teller_.error("unknown-name", path->span, "there is no node " + lang::to_text(*path),
                          "give it a line of its own: node " + lang::to_text(*path));
            return std::nullopt;
        }
        return found->second;
    }

    void link(Line& line) {
        const auto a = find(line.path("the name of a node"));
        const auto b = find(line.path("the name of a node"));
        Expr takes = make_number(Rational{0}, line.span(), "s");
        bool one_at_a_time = false, one_way = false;
        while (!line.done()) {
            if (line.clause("takes", "a time", takes)) {
                continue;
            }
            if (line.word("one")) {
                if (line.word("way")) {
                    one_way = true;
                } else if (line.word("at") && line.word("a") && line.word("time")) {
                    one_at_a_time = true;
                } else {
                    line.finish(kLinkForm);
                }
            } else {
                line.finish(kLinkForm);
            }
        }
        if (!a || !b) {
            return;
        }
        if (*a == *b) {
            teller_.error("link-to-itself", line.span(), "a link joins two nodes",
                          "write " + std::string(kLinkForm));
            return;
        }
        const std::string& from = nodes_[*a].name.text;
        const std::string& to = nodes_[*b].name.text;
        for (const Way& w : ways_) {
            if ((w.from == *a && w.to == *b) || (!one_way && w.from == *b && w.to == *a)) {
                teller_.error("name-twice", line.span(),
                              "there is already a link between " + from + " and " + to,
                              "remove one of them");
                return;
            }
        }
        const std::string shared = one_at_a_time ? from + "_" + to + "_free" : "";
        if (one_at_a_time) {
            lang::Place free = make_place(make_name(shared, line.span()));
            free.is_public = true;
            give_token(free);
            body_.places.push_back(std::move(free));
        }
        ways_.push_back({*a, *b, takes, shared, line.span()});
        if (!one_way) {
            ways_.push_back({*b, *a, takes, shared, line.span()});
        }
    }

    // Over the fewest links, and of equally many the one that is written first.
    void find_ways() {
        for (Node& n : nodes_) {
            n.next.assign(nodes_.size(), kNone);
        }
        for (std::size_t target = 0; target < nodes_.size(); ++target) {
            std::vector<std::size_t> far(nodes_.size(), kNone), open{target};
            far[target] = 0;
            for (std::size_t i = 0; i < open.size(); ++i) {
                for (const Way& w : ways_) {
                    if (w.to == open[i] && far[w.from] == kNone) {
                        far[w.from] = far[open[i]] + 1;
                        open.push_back(w.from);
                    }
                }
            }
            for (std::size_t w = ways_.size(); w-- > 0;) {
                const Way& way = ways_[w];
                if (far[way.to] != kNone && way.from != target &&
                    far[way.from] == far[way.to] + 1) {
                    nodes_[way.from].next[target] = w;
                }
            }
        }
    }

    std::optional<std::string> kind(Line& line) {
        const lang::Path* path = line.path("the name of a message");
        if (path == nullptr) {
            return std::nullopt;
        }
        if (!has_kind(path->steps[0].text)) {
            teller_.error("unknown-name", path->span, "there is no message " + lang::to_text(*path),
                          "give it a line of its own: message " + lang::to_text(*path));
            return std::nullopt;
        }
        return path->steps[0].text;
    }

    void answer(Line& line) {
        const auto who = find(&line.name());
        line.word("answers");
        const auto asked = kind(line);
        const bool with = line.word("with");
        const auto reply = with ? kind(line) : std::nullopt;
        line.finish(kAnswerForm);
        if (!with) {
            teller_.error("syntax", line.span(), "it does not say with what",
                          "write " + std::string(kAnswerForm));
        }
        if (!who || !asked || !reply) {
            return;
        }
        if (!nodes_[*who].answers.emplace(*asked, std::pair(*reply, line.span())).second) {
            teller_.error("name-twice", line.span(),
                          nodes_[*who].name.text + " answers " + *asked + " already",
                          "keep one of the lines");
        }
    }

    void ending(Line& line) {
        if (!begin_ending(line, "when", kEndForm, teller_, ending_)) {
            return;
        }
        const auto who = find(line.path("the name of a node"));
        if (!line.word("has") || !line.word("handled")) {
            teller_.error("syntax", line.span(), "it does not say when this ends",
                          "write " + std::string(kEndForm));
            return;
        }
        const auto what = kind(line);
        line.finish(kEndForm);
        if (who && what) {
            ending_.given = kEnding;
            last_node_ = *who;
            last_kind_ = *what;
        }
    }

    void send(Line& line) {
        const auto who = find(&line.name());
        line.word("sends");
        const auto what = kind(line);
        if (!line.word("to")) {
            teller_.error("syntax", line.span(), "it does not say to whom",
                          "write " + std::string(kSendForm));
            return;
        }
        std::vector<std::size_t> targets;
        if (line.word("all")) {
            for (std::size_t n = 0; who && n < nodes_.size(); ++n) {
                if (n != *who) {
                    targets.push_back(n);
                }
            }
        } else if (const auto target = find(line.path("the name of a node"))) {
            targets.push_back(*target);
        }
        const lang::Span span = line.span();
        if (!who || !what || targets.empty()) {
            return;
        }
        for (const std::size_t t : targets) {
            if (t == *who || nodes_[*who].next[t] == kNone) {
                teller_.error("no-way", span,
                              t == *who ? "a node sends to others"
                                        : "no links lead from " + nodes_[*who].name.text + " to " +
                                              nodes_[t].name.text,
                              "add a link: link " + nodes_[*who].name.text + " " +
                                  nodes_[t].name.text + " takes 1 s");
                return;
            }
        }
        const std::string& name = nodes_[*who].name.text;
        const int number = ++sendings_[name];
        const std::string verb =
            name + "_sends" + (number == 1 ? "" : "_" + std::to_string(number));
        lang::Transition t = make_transition(make_name(verb, span), {}, {});
        t.span = span;
        t.is_public = true;
        lang::Event event;
        event.name = make_name(verb + "_time", span);
        event.span = span;
        if (line.word("on")) {
            do {
                if (const lang::Path* path = line.path("the name of an event")) {
                    t.events.push_back(*path);
                }
            } while (line.word("or"));
        } else {
            if (line.word("every")) {
                if (const Expr* e = line.value("a time")) {
                    event.every = *e;
                }
                line.clause("from", "a time", event.from);
            } else if (line.word("at")) {
                const Expr* e = line.value("a time");
                if (e != nullptr && e->kind == ExprKind::kList) {
                    for (const lang::Argument& a : e->args) {
                        Expr time = a.value;
                        if (time.kind == ExprKind::kNumber && time.unit.empty()) {
                            time.unit = e->unit;
                            time.unit_span = e->unit_span;
                        }
                        event.at.push_back(std::move(time));
                    }
                } else if (e != nullptr) {
                    event.at.push_back(*e);
                }
            } else {
                event.at.push_back(make_number(Rational{0}, span, "s"));
            }
            t.events.push_back(make_path(event.name.text, span));
            body_.events.push_back(std::move(event));
        }
        line.finish(kSendForm);
        for (const std::size_t target : targets) {
            t.outputs.push_back(give(name + "_outbox", make_reference(*what, span),
                                     number_of(target, span), number_of(*who, span), span));
        }
        body_.transitions.push_back(std::move(t));
    }

    // Nodes are told apart by their numbers, from 1, in tokens.
    static Expr number_of(std::size_t node, lang::Span span) {
        return make_number(Rational{static_cast<std::int64_t>(node) + 1}, span);
    }

    static Expr variable(const char* name, lang::Span span) { return make_reference(name, span); }

    static lang::Arc arc(lang::ArcKind kind, const std::string& place, Expr what, Expr to,
                         Expr from, lang::Span span) {
        lang::Arc a = make_arc(kind, make_path(place, span));
        a.pattern.push_back(make_assignment(make_path("kind", span), std::move(what)));
        a.pattern.push_back(make_assignment(make_path("target", span), std::move(to)));
        a.pattern.push_back(make_assignment(make_path("sender", span), std::move(from)));
        return a;
    }
    static lang::Arc give(const std::string& place, Expr what, Expr to, Expr from,
                          lang::Span span) {
        return arc(lang::ArcKind::kGive, place, std::move(what), std::move(to), std::move(from),
                   span);
    }
    // Takes or gives a message as it is.
    static lang::Arc any(lang::ArcKind kind, const std::string& place, lang::Span span) {
        return arc(kind, place, variable(kKind, span), variable(kTo, span), variable(kFrom, span),
                   span);
    }

    lang::Place store(const std::string& name, lang::Span span) const {
        lang::Place p = make_place(make_name(name, span));
        p.is_public = true;
        p.of_type = make_path("Message", span);
        return p;
    }

    lang::Transition& transition(const std::string& name, std::int64_t priority, lang::Span span) {
        lang::Transition t = make_transition(make_name(name, span), {}, {});
        t.span = span;
        t.is_public = true;
        t.priority = make_number(Rational{priority}, span);
        body_.transitions.push_back(std::move(t));
        return body_.transitions.back();
    }

    void make() {
        const lang::Span span = block_.name.span;
        lang::Enumeration kinds;
        kinds.name = make_name("Kind", span);
        kinds.values = kinds_;
        kinds.span = span;
        body_.enumerations.push_back(std::move(kinds));
        lang::TokenType type;
        type.name = make_name("Message", span);
        type.span = span;
        const auto attribute = [&](const char* name, Expr of) {
            lang::Parameter p;
            p.name = make_name(name, span);
            p.type = std::move(of);
            p.span = span;
            type.attributes.push_back(std::move(p));
        };
        attribute("kind", make_reference("Kind", span));
        attribute("target", make_reference("int", span));
        attribute("sender", make_reference("int", span));
        body_.token_types.push_back(std::move(type));
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            make_node(i);
        }
        for (std::size_t i = 0; i < ways_.size(); ++i) {
            make_way(i);
        }
    }

    void make_node(std::size_t number) {
        const Node& n = nodes_[number];
        const std::string& name = n.name.text;
        const auto at = static_cast<std::int64_t>(number);
        body_.places.push_back(store(name + "_inbox", n.span));
        body_.places.push_back(store(name + "_outbox", n.span));
        lang::Place handles = store(name + "_handles", n.span);
        handles.caption = n.caption;
        handles.does = n.does;
        handles.takes = n.takes;
        body_.places.push_back(std::move(handles));
        lang::Place free = make_place(make_name(name + "_free", n.span));
        free.is_public = true;
        give_token(free);
        body_.places.push_back(std::move(free));
        const auto plain = [&](lang::ArcKind kind) {
            return make_arc(kind, make_path(name + "_free", n.span));
        };

        lang::Transition& begins = transition(name + "_begins", kBegins - at, n.span);
        begins.inputs.push_back(any(lang::ArcKind::kTake, name + "_inbox", n.span));
        begins.inputs.push_back(plain(lang::ArcKind::kTake));
        begins.outputs.push_back(any(lang::ArcKind::kGive, name + "_handles", n.span));

        const Expr me = number_of(number, n.span);
        for (const auto& [asked, reply] : n.answers) {
            const lang::Span span = reply.second;
            lang::Transition& t = transition(name + "_answers_" + asked, kHandled - at, span);
            t.inputs.push_back(arc(lang::ArcKind::kTake, name + "_handles",
                                   make_reference(asked, span), me, variable(kFrom, span), span));
            t.outputs.push_back(plain(lang::ArcKind::kGive));
            t.outputs.push_back(give(name + "_outbox", make_reference(reply.first, span),
                                     variable(kFrom, span), me, span));
            if (!n.raises.empty()) {
                t.raises.push_back(n.raises);
            }
            if (ending_ && number == last_node_ && asked == last_kind_) {
                t.outputs.push_back(
                    make_arc(lang::ArcKind::kGive, make_path(kEnding, ending_.span)));
            }
        }
        // The message that ends it, where it is not answered.
        const bool last = ending_ && number == last_node_ && n.answers.count(last_kind_) == 0;
        if (last) {
            lang::Transition& t =
                transition(name + "_gets_" + last_kind_, kHandled - at, ending_.span);
            t.inputs.push_back(arc(lang::ArcKind::kTake, name + "_handles",
                                   make_reference(last_kind_, n.span), me, variable(kFrom, n.span),
                                   n.span));
            t.outputs.push_back(plain(lang::ArcKind::kGive));
            t.outputs.push_back(make_arc(lang::ArcKind::kGive, make_path(kEnding, ending_.span)));
            if (!n.raises.empty()) {
                t.raises.push_back(n.raises);
            }
        }
        lang::Transition& gets = transition(name + "_gets", kHandled - at, n.span);
        gets.inputs.push_back(any(lang::ArcKind::kTake, name + "_handles", n.span));
        gets.outputs.push_back(plain(lang::ArcKind::kGive));
        gets.guard = make_binary(Op::kEqual, variable(kTo, n.span), me);
        for (const auto& [asked, reply] : n.answers) {
            gets.guard = make_both(
                std::move(gets.guard),
                make_binary(Op::kNotEqual, variable(kKind, n.span), make_reference(asked, n.span)));
        }
        if (last) {
            gets.guard =
                make_both(std::move(gets.guard), make_binary(Op::kNotEqual, variable(kKind, n.span),
                                                             make_reference(last_kind_, n.span)));
        }
        if (!n.raises.empty()) {
            gets.raises.push_back(n.raises);
        }
        lang::Transition& passes = transition(name + "_passes", kHandled - at, n.span);
        passes.inputs.push_back(any(lang::ArcKind::kTake, name + "_handles", n.span));
        passes.outputs.push_back(plain(lang::ArcKind::kGive));
        passes.outputs.push_back(any(lang::ArcKind::kGive, name + "_outbox", n.span));
        passes.guard = make_binary(Op::kNotEqual, variable(kTo, n.span), me);
    }

    void make_way(std::size_t number) {
        const Way& w = ways_[number];
        const std::string& from = nodes_[w.from].name.text;
        const std::string& to = nodes_[w.to].name.text;
        Expr guard;
        for (std::size_t target = 0; target < nodes_.size(); ++target) {
            if (nodes_[w.from].next[target] == number) {
                Expr one =
                    make_binary(Op::kEqual, variable(kTo, w.span), number_of(target, w.span));
                guard =
                    guard ? make_binary(Op::kOr, std::move(guard), std::move(one)) : std::move(one);
            }
        }
        if (!guard) {
            return;  // no message ever goes this way
        }
        const auto at = static_cast<std::int64_t>(number);
        lang::Place way = store(from + "_to_" + to, w.span);
        way.takes = make_duration(w.takes);
        way.keeps_order = true;
        body_.places.push_back(std::move(way));
        lang::Transition& leaves = transition(from + "_sends_to_" + to, kSends - at, w.span);
        leaves.inputs.push_back(any(lang::ArcKind::kTake, from + "_outbox", w.span));
        leaves.outputs.push_back(any(lang::ArcKind::kGive, from + "_to_" + to, w.span));
        leaves.guard = std::move(guard);
        lang::Transition& arrives = transition(from + "_reaches_" + to, kArrives - at, w.span);
        arrives.inputs.push_back(any(lang::ArcKind::kTake, from + "_to_" + to, w.span));
        arrives.outputs.push_back(any(lang::ArcKind::kGive, to + "_inbox", w.span));
        if (!w.shared.empty()) {
            body_.transitions[body_.transitions.size() - 2].inputs.push_back(
                make_arc(lang::ArcKind::kTake, make_path(w.shared, w.span)));
            arrives.outputs.push_back(make_arc(lang::ArcKind::kGive, make_path(w.shared, w.span)));
        }
    }

    const lang::Block& block_;
    Teller teller_;
    lang::Body& body_;
    std::vector<lang::Name> kinds_;
    std::vector<Node> nodes_;
    std::map<std::string, std::size_t> numbers_;
    std::vector<Way> ways_;
    std::map<std::string, int> sendings_;
    Ending ending_;
    std::size_t last_node_ = kNone;  // and the kind of message whose handling ends it
    std::string last_kind_;
};

}  // namespace

void lower_messages(const lang::Block& block, const lang::File& file, Lowered& out) {
    Messages(block, file, out).lower();
}

}  // namespace puppetri::notation
