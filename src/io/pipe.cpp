// SPDX-License-Identifier: MIT
// PIPE writes <value> where PNML has <text>, "Default,1" where it has 1, and puts time beside it.
#include "puppetri/io/pipe.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "defects.h"
#include "pnml_document.h"
#include "puppetri/base/text.h"
#include "test_arcs.h"
#include "xml_text.h"

namespace puppetri::io {
namespace {

constexpr std::int64_t kMostCount = 0x3FFF'FFFF;
constexpr std::size_t kMostClasses = 1000;

std::string value_of(pugi::xml_node node, std::string_view label) {
    const pugi::xml_node l = child(node, label);
    return l ? label_text(l) : "";
}

// How many tokens of each class, by number of the class.
using Multiset = std::vector<std::pair<std::uint32_t, std::int64_t>>;

class Reader {
 public:
    Reader(const XmlText& text, const NetLimits& limits, NetFile& out, Defects& defects)
        : text_(text), limits_(limits), out_(out), defects_(defects) {}

    void run() {
        const pugi::xml_node root = text_.root();
        net_ = child(root, "net");
        if (local_name(root) != "pnml" || !net_) {
            error("not-pipe", root, "", "the file is XML, but holds no net of PIPE",
                  "PIPE's files have <net> in <pnml>");
            return;
        }
        out_.draft.name = net_.attribute("id").value();
        out_.draft.sources_on_beats = true;
        out_.look.id = out_.draft.name;
        out_.look.pages.push_back({});
        collect();
        make_places();
        make_transitions();
        make_arcs();
        for (const pugi::xml_node group : groups_) {
            make_state(group);
        }
        out_.ids.sort();
        join_parallel_tests(out_, defects_);
    }

 private:
    struct RawPlace {
        pugi::xml_node xml;
        std::string id;
        Multiset marking;
        std::vector<std::uint32_t> classes;   // that it may ever hold, in order
        std::vector<net::PlaceIndex> places;  // one per class
    };
    struct RawArc {
        pugi::xml_node xml;
        std::uint32_t place = 0, transition = 0;
        bool is_output = false, inhibitor = false;
        Multiset weight;
    };

    void error(const char* code, pugi::xml_node at, std::string element, std::string message,
               std::string remedy) {
        defects_.error(code, text_.where(at), std::move(element), std::move(message),
                       std::move(remedy));
    }

    void collect() {
        for (const pugi::xml_node node : net_.children()) {
            if (node.type() == pugi::node_element && local_name(node) == "token" &&
                classes_.size() <= kMostClasses) {
                class_of(node.attribute("id").value());
            }
        }
        if (classes_.size() > kMostClasses) {
            error("net-too-large", net_, "",
                  "more than " + std::to_string(kMostClasses) + " classes of tokens",
                  "declare those that are used");
            return;
        }
        std::vector<pugi::xml_node> arcs;
        for (const pugi::xml_node node : net_.children()) {
            if (node.type() != pugi::node_element) {
                continue;
            }
            const std::string_view name = local_name(node);
            const std::string id = node.attribute("id").value();
            if (name == "place" || name == "transition") {
                if (id.empty()) {
                    error("missing-id", node, std::string(name), "it has no id", "give it one");
                    continue;
                }
                const bool is_place = name == "place";
                const auto index =
                    static_cast<std::uint32_t>(is_place ? places_.size() : transitions_.size());
                if (!nodes_.emplace(id, std::pair(is_place, index)).second) {
                    error("duplicate-id", node, std::string(name) + " " + id,
                          "the id is taken by another element", "give one of them another id");
                    continue;
                }
                if (is_place) {
                    RawPlace place{.xml = node, .id = id};
                    place.marking = multiset(node, "initialMarking", "place " + id, 0);
                    places_.push_back(std::move(place));
                } else {
                    transitions_.push_back(node);
                }
            } else if (name == "arc") {
                arcs.push_back(node);
            } else if (name == "stategroup") {
                groups_.push_back(node);
            } else if (name == "labels") {
                out_.look.extra += raw(node);
            } else if (name == "definition") {
                // A named rate or marking: the elements that use it repeat its value.
                continue;
            } else if (name != "token" && name != "name" && name != "graphics" &&
                       name != "toolspecific") {
                error("unknown-label", node, "net", "<" + std::string(name) + "> is not known here",
                      "take it out, or put it into <toolspecific> if it changes nothing");
            }
        }
        if (places_.size() + transitions_.size() + arcs.size() > limits_.elements) {
            error("net-too-large", net_, "",
                  "more than " + std::to_string(limits_.elements) + " elements",
                  "split the model, or ask for more");
            return;
        }
        for (const pugi::xml_node arc : arcs) {
            read_arc(arc);
        }
    }

    std::uint32_t class_of(const std::string& name) {
        const auto at = std::find(classes_.begin(), classes_.end(), name);
        if (at == classes_.end()) {
            classes_.push_back(name);
            return static_cast<std::uint32_t>(classes_.size()) - 1;
        }
        return static_cast<std::uint32_t>(at - classes_.begin());
    }

    // "3", or "Readers,2,Writers,0": what is 0 is left out.
    Multiset multiset(pugi::xml_node node, std::string_view label, const std::string& element,
                      std::int64_t otherwise) {
        const pugi::xml_node l = child(node, label);
        const std::string said = l ? label_text(l) : "";
        Multiset out;
        const auto add = [&](std::uint32_t token, std::string_view number) {
            const ParsedInteger count = parse_integer(number);
            if (count.kind == ParsedInteger::kNoNumber || count.value < 0) {
                error("not-a-number", l ? l : node, element,
                      "<" + std::string(label) + "> says \"" + said.substr(0, 60) +
                          "\", which is no number of tokens",
                      "write a whole number from 0 on, or class,number,class,number");
            } else if (count.value > kMostCount) {
                error("number-too-large", l ? l : node, element,
                      "<" + std::string(label) + "> is larger than " + std::to_string(kMostCount),
                      "use fewer tokens");
            } else if (count.value > 0) {
                const auto known = std::find_if(out.begin(), out.end(),
                                                [&](const auto& x) { return x.first == token; });
                if (known != out.end()) {
                    error("duplicate-label", l ? l : node, element,
                          "<" + std::string(label) + "> names a class of tokens twice",
                          "name each class once");
                } else {
                    out.emplace_back(token, count.value);
                }
            }
        };
        if (said.empty()) {
            if (otherwise > 0) {
                out.emplace_back(class_of(default_class()), otherwise);
            }
            return out;
        }
        std::vector<std::string_view> parts;
        std::string_view rest = said;
        for (std::size_t comma = rest.find(','); comma != std::string_view::npos;
             comma = rest.find(',')) {
            parts.push_back(trimmed(rest.substr(0, comma)));
            rest.remove_prefix(comma + 1);
        }
        parts.push_back(trimmed(rest));
        if (parts.size() == 1) {
            add(class_of(default_class()), parts[0]);
            return out;
        }
        for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
            if (std::find(classes_.begin(), classes_.end(), parts[i]) == classes_.end() &&
                parts[i] != "Default") {
                error("unknown-id", l, element,
                      "there is no class of tokens " + std::string(parts[i].substr(0, 60)),
                      "declare it with <token id=...>");
                return out;
            }
            add(class_of(std::string(parts[i])), parts[i + 1]);
        }
        if (parts.size() % 2 != 0) {
            error("not-a-number", l, element,
                  "<" + std::string(label) + "> has a class of tokens without a number",
                  "write class,number,class,number");
        }
        std::sort(out.begin(), out.end());
        return out;
    }

    std::string default_class() const {
        return classes_.size() == 1 ? classes_[0] : std::string("Default");
    }

    // PIPE writes a name for everything, and mostly the id once more.
    static std::string caption(pugi::xml_node node, const std::string& id) {
        std::string name = value_of(node, "name");
        return name == id ? "" : name;
    }

    void refuse_tags(pugi::xml_node node, const std::string& element) {
        if (value_of(node, "tagged") == "true") {
            error("not-supported", node, element,
                  "tagged tokens, which are followed one by one, are not read",
                  "take the tag away");
        }
    }

    void read_arc(pugi::xml_node node) {
        const std::string element = "arc " + std::string(node.attribute("id").value());
        RawArc arc{.xml = node};
        const auto end = [&](const char* attribute) {
            const std::string id = node.attribute(attribute).value();
            const auto at = nodes_.find(id);
            if (at == nodes_.end()) {
                error("unknown-id", node, element,
                      std::string("its ") + attribute + " " + id + " does not exist",
                      "name a place or transition of the file");
            }
            return at;
        };
        const auto from = end("source"), to = end("target");
        std::string type = node.attribute("type").value();
        if (const pugi::xml_node label = child(node, "type")) {
            type = label.attribute("value") ? label.attribute("value").value() : label_text(label);
        }
        arc.inhibitor = type == "inhibitor";
        if (!arc.inhibitor && type != "normal" && !type.empty()) {
            error("unknown-arc-type", node, element, "the arc type \"" + type + "\" is not known",
                  "known are normal and inhibitor");
            return;
        }
        refuse_tags(node, element);
        for (const pugi::xml_node c : node.children()) {
            const std::string_view name = local_name(c);
            if (c.type() == pugi::node_element && name != "graphics" && name != "inscription" &&
                name != "arcpath" && name != "type" && name != "tagged" && name != "name" &&
                name != "toolspecific") {
                error("unknown-label", c, element, "<" + std::string(name) + "> is not known here",
                      "take it out, or put it into <toolspecific> if it changes nothing");
            }
        }
        if (from == nodes_.end() || to == nodes_.end()) {
            return;
        }
        if (from->second.first == to->second.first) {
            error("arc-joins-alike", node, element,
                  from->second.first ? "it joins two places" : "it joins two transitions",
                  "an arc goes from a place to a transition, or back");
            return;
        }
        arc.is_output = to->second.first;
        arc.place = arc.is_output ? to->second.second : from->second.second;
        arc.transition = arc.is_output ? from->second.second : to->second.second;
        arc.weight = multiset(node, "inscription", element, 1);
        if (arc.weight.empty() && !defects_.any()) {
            error("number-too-small", node, element, "the arc takes or gives no token at all",
                  "give it a weight, or take it out");
        }
        if (arc.inhibitor && arc.is_output) {
            error("arc-type-backwards", node, element,
                  "an inhibitor arc cannot lead from a transition to a place",
                  "let it lead from the place to the transition");
            return;
        }
        arcs_.push_back(std::move(arc));
    }

    // The classes that occur at all; a net of one class is not unfolded.
    void make_places() {
        std::vector<std::vector<std::uint32_t>> seen(places_.size());
        std::vector<bool> used(classes_.size(), false);
        const auto mark = [&](std::uint32_t place, const Multiset& tokens) {
            for (const auto& [token, count] : tokens) {
                used[token] = true;
                seen[place].push_back(token);
            }
        };
        for (std::uint32_t p = 0; p < places_.size(); ++p) {
            mark(p, places_[p].marking);
        }
        for (const RawArc& arc : arcs_) {
            mark(arc.place, arc.weight);
        }
        coloured_ = std::count(used.begin(), used.end(), true) > 1;
        for (std::uint32_t p = 0; p < places_.size(); ++p) {
            std::sort(seen[p].begin(), seen[p].end());
            seen[p].erase(std::unique(seen[p].begin(), seen[p].end()), seen[p].end());
            if (seen[p].empty()) {
                seen[p].push_back(0);
            }
            places_[p].classes = coloured_ ? seen[p] : std::vector<std::uint32_t>{seen[p][0]};
            make_place(places_[p]);
        }
    }

    void make_place(RawPlace& raw_place) {
        const std::string element = "place " + raw_place.id;
        std::optional<std::uint32_t> capacity;
        const std::string said = value_of(raw_place.xml, "capacity");
        if (!said.empty()) {
            const ParsedInteger number = parse_integer(said);
            if (number.kind != ParsedInteger::kFine || number.value < 0 ||
                number.value > kMostCount) {
                error("not-a-number", raw_place.xml, element,
                      "its capacity \"" + said.substr(0, 40) + "\" is no number of tokens",
                      "write a whole number; 0 means no limit");
            } else if (number.value > 0) {
                capacity = static_cast<std::uint32_t>(number.value);
            }
        }
        if (capacity && raw_place.classes.size() > 1) {
            error("not-supported", raw_place.xml, element,
                  "a capacity for tokens of several classes is not read", "take the capacity away");
        }
        refuse_tags(raw_place.xml, element);
        for (const pugi::xml_node c : raw_place.xml.children()) {
            const std::string_view name = local_name(c);
            if (c.type() == pugi::node_element && name != "graphics" && name != "name" &&
                name != "initialMarking" && name != "capacity" && name != "tagged" &&
                name != "toolspecific") {
                error("unknown-label", c, element, "<" + std::string(name) + "> is not known here",
                      "take it out, or put it into <toolspecific> if it changes nothing");
            }
        }
        for (const std::uint32_t token : raw_place.classes) {
            net::PlaceDraft place;
            place.path = coloured_ ? raw_place.id + "(" + class_name(token) + ")" : raw_place.id;
            place.caption = caption(raw_place.xml, raw_place.id);
            place.where = text_.where(raw_place.xml);
            place.capacity = capacity;
            for (const auto& [of, count] : raw_place.marking) {
                if (of == token) {
                    place.tokens.push_back({.count = static_cast<std::uint32_t>(count)});
                }
            }
            raw_place.places.push_back({static_cast<std::uint32_t>(out_.draft.places.size())});
            out_.draft.places.push_back(std::move(place));
            out_.look.places.push_back(look_of(raw_place.xml, 0, 0, "initialMarking"));
        }
        out_.ids.add_place(raw_place.id, raw_place.places);
    }

    std::string class_name(std::uint32_t token) const {
        return token < classes_.size() ? classes_[token] : std::string("Default");
    }

    bool flag(pugi::xml_node node, std::string_view label, const std::string& element) {
        const std::string said = value_of(node, label);
        if (!said.empty() && said != "true" && said != "false") {
            error("not-a-number", node, element,
                  "<" + std::string(label) + "> says \"" + said.substr(0, 40) + "\"",
                  "write true or false");
        }
        return said == "true";
    }

    void make_transitions() {
        for (const pugi::xml_node node : transitions_) {
            net::TransitionDraft t;
            t.path = node.attribute("id").value();
            t.caption = caption(node, t.path);
            t.where = text_.where(node);
            const std::string element = "transition " + t.path;
            for (const pugi::xml_node c : node.children()) {
                const std::string_view name = local_name(c);
                if (c.type() == pugi::node_element && name != "graphics" && name != "name" &&
                    name != "orientation" && name != "rate" && name != "timed" &&
                    name != "infiniteServer" && name != "priority" && name != "tagged" &&
                    name != "toolspecific") {
                    error("unknown-label", c, element,
                          "<" + std::string(name) + "> is not known here",
                          "take it out, or put it into <toolspecific> if it changes nothing");
                }
            }
            refuse_tags(node, element);
            const bool timed = flag(node, "timed", element);
            const bool infinite = flag(node, "infiniteServer", element);
            const std::string said = value_of(node, "rate");
            const std::optional<double> rate =
                said.empty() ? std::optional(1.0) : parse_number(said);
            if (!rate || !(*rate >= 1e-9 && *rate <= 1e12)) {
                error("not-a-number", node, element,
                      "its rate \"" + said.substr(0, 60) + "\" is no number from 1e-9 to 1e12",
                      "rates that depend on the marking are not read; write a number");
            } else if (timed) {
                net::DelayDraft delay;
                delay.duration.kind = net::DurationKind::kDistribution;
                delay.duration.distribution = DistributionKind::kExponential;
                delay.duration.parameters = {Expr::real(1 / *rate)};
                delay.servers = infinite ? net::DelayDraft::kInfiniteServers : 1;
                t.delay = std::move(delay);
            } else if (*rate != 1) {
                t.odds = Expr::real(*rate);
            }
            const std::string priority = value_of(node, "priority");
            const ParsedInteger number = parse_integer(priority);
            if (!priority.empty() && (number.kind != ParsedInteger::kFine || number.value < 0 ||
                                      number.value > kMostCount)) {
                error("not-a-number", node, element,
                      "its priority \"" + priority.substr(0, 40) + "\" is no whole number",
                      "write a whole number from 1 on");
            }
            t.priority = timed ? 0 : priority.empty() ? 1 : std::max<std::int64_t>(1, number.value);
            out_.ids.add_transition(t.path,
                                    {{static_cast<std::uint32_t>(out_.draft.transitions.size())}});
            out_.draft.transitions.push_back(std::move(t));
            out_.look.transitions.push_back(look_of(node, 0, 0, ""));
        }
    }

    void make_arcs() {
        for (const RawArc& arc : arcs_) {
            net::TransitionDraft& t = out_.draft.transitions[arc.transition];
            const RawPlace& place = places_[arc.place];
            const SourceSpan where = text_.where(arc.xml);
            if (arc.inhibitor && arc.weight.size() > 1) {
                error("not-supported", arc.xml,
                      "arc " + std::string(arc.xml.attribute("id").value()),
                      "an inhibitor arc for tokens of several classes is not read",
                      "write one inhibitor arc for each class");
                continue;
            }
            for (const auto& [token, weight] : arc.weight) {
                const auto at = std::find(place.classes.begin(), place.classes.end(), token);
                if (at == place.classes.end()) {
                    continue;  // told before
                }
                const net::PlaceIndex index =
                    place.places[static_cast<std::size_t>(at - place.classes.begin())];
                ArcLook look{.transition = {arc.transition},
                             .is_output = arc.is_output,
                             .id = arc.xml.attribute("id").value(),
                             .source = arc.xml.attribute("source").value(),
                             .target = arc.xml.attribute("target").value(),
                             .look = look_of(arc.xml, 0, 0, "inscription")};
                look.number =
                    static_cast<std::uint32_t>(arc.is_output ? t.outputs.size() : t.inputs.size());
                if (arc.is_output) {
                    t.outputs.push_back({.place = index, .weight = weight, .where = where});
                } else {
                    t.inputs.push_back(
                        {.kind = arc.inhibitor ? net::ArcKind::kUnless : net::ArcKind::kTake,
                         .place = index,
                         .weight = weight,
                         .where = where});
                }
                out_.look.arcs.push_back(std::move(look));
            }
        }
    }

    // <stategroup>: a named state, the conjunction of conditions "P8 == 2".
    void make_state(pugi::xml_node group) {
        net::NamedState state;
        state.path = group.attribute("id").value();
        state.caption = value_of(group, "name");
        state.where = text_.where(group);
        const std::string element = "state group " + state.path;
        net::Formula all = net::Formula::constant(true);
        for (const pugi::xml_node condition : group.children()) {
            if (condition.type() != pugi::node_element ||
                local_name(condition) != "statecondition") {
                continue;
            }
            std::optional<Expr> one = state_condition(label_text(condition));
            if (!one) {
                defects_.note(Severity::kWarning, "not-supported", text_.where(condition), element,
                              "the condition \"" + label_text(condition).substr(0, 60) +
                                  "\" is not understood: the state group is left out",
                              "write PLACE OPERATOR NUMBER");
                return;
            }
            all = net::Formula::binary(net::FormulaOp::kAnd, std::move(all),
                                       net::Formula::expression(std::move(*one)));
        }
        state.condition = std::move(all);
        out_.draft.states.push_back(std::move(state));
    }

    std::optional<Expr> state_condition(std::string_view text) {
        static constexpr std::pair<std::string_view, ExprOp> kOperators[] = {
            {"==", ExprOp::kEqual},        {"!=", ExprOp::kNotEqual}, {"<=", ExprOp::kLessEqual},
            {">=", ExprOp::kGreaterEqual}, {"<", ExprOp::kLess},      {">", ExprOp::kGreater},
            {"=", ExprOp::kEqual}};
        for (const auto& [word, op] : kOperators) {
            const std::size_t at = text.rfind(word);
            if (at == std::string_view::npos) {
                continue;
            }
            const std::string place(trimmed(text.substr(0, at)));
            const ParsedInteger number = parse_integer(text.substr(at + word.size()));
            const auto found = nodes_.find(place);
            if (number.kind != ParsedInteger::kFine || found == nodes_.end() ||
                !found->second.first) {
                return std::nullopt;
            }
            std::optional<Expr> sum;
            for (const net::PlaceIndex p : places_[found->second.second].places) {
                Expr count =
                    Expr::slot(net::slot(net::SlotKind::kCount, p.value), {ValueKind::kInt, 0});
                sum = sum ? Expr::binary(ExprOp::kAdd, std::move(*sum), std::move(count)).value()
                          : std::move(count);
            }
            return Expr::binary(op, std::move(*sum), Expr::integer(number.value)).value();
        }
        return std::nullopt;
    }

    const XmlText& text_;
    const NetLimits& limits_;
    NetFile& out_;
    Defects& defects_;
    pugi::xml_node net_;
    std::vector<std::string> classes_;
    std::map<std::string, std::pair<bool, std::uint32_t>> nodes_;  // is a place; which
    std::vector<RawPlace> places_;
    std::vector<pugi::xml_node> transitions_, groups_;
    std::vector<RawArc> arcs_;
    bool coloured_ = false;
};

}  // namespace

Checked<NetFile> read_pipe(std::string_view text, const std::string& path,
                           const NetLimits& limits) {
    Defects defects;
    XmlText xml;
    NetFile out;
    out.format = NetFormat::kPipe;
    if (xml.parse(text, path, limits.bytes, defects)) {
        Reader(xml, limits, out, defects).run();
    }
    if (defects.any()) {
        return Unexpected(defects.take());
    }
    out.notes = defects.take();
    return out;
}

}  // namespace puppetri::io
