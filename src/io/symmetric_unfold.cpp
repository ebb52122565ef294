// SPDX-License-Identifier: MIT
#include "symmetric_unfold.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "symmetric_sorts.h"
#include "symmetric_terms.h"
#include "test_arcs.h"

namespace puppetri::io {
namespace {

class Unfolding {
 public:
    Unfolding(const PnmlDocument& document, const NetLimits& limits, NetFile& out, Defects& defects)
        : document_(document),
          limits_(limits),
          out_(out),
          defects_(defects),
          terms_(document, colours_, limits, defects) {}

    void run() {
        colours_.read(document_, limits_, defects_);
        nodes_.resize(document_.nodes.size());
        arcs_of_.resize(document_.nodes.size());
        for (std::uint32_t n = 0; n < document_.nodes.size(); ++n) {
            if (document_.nodes[n].kind == PnmlNode::kPlace) {
                read_place(n);
            }
        }
        for (std::uint32_t a = 0; a < document_.arcs.size(); ++a) {
            read_arc(a);
        }
        for (std::uint32_t n = 0; n < document_.nodes.size(); ++n) {
            if (document_.nodes[n].kind == PnmlNode::kTransition) {
                read_condition(n);
            }
        }
        if (defects_.any()) {
            return;
        }
        for (std::uint32_t n = 0; n < document_.nodes.size() && !stopped_; ++n) {
            if (document_.nodes[n].kind == PnmlNode::kPlace) {
                unfold_place(n);
            }
        }
        for (std::uint32_t n = 0; n < document_.nodes.size() && !stopped_; ++n) {
            if (document_.nodes[n].kind == PnmlNode::kTransition) {
                unfold_transition(n);
            }
        }
        for (std::uint32_t n = 0; n < document_.nodes.size() && !stopped_; ++n) {
            const PnmlNode& node = document_.nodes[n];
            if (node.is_place()) {
                out_.ids.add_place(node.id, nodes_[node.stands_for].unfolded);
            } else {
                out_.ids.add_transition(node.id, nodes_[node.stands_for].transitions);
            }
        }
        out_.ids.sort();
        out_.look.references.clear();  // what they refer to has other names now
        join_parallel_tests(out_, defects_);
    }

 private:
    struct Node {
        std::uint32_t sort = 0;
        std::optional<std::uint32_t> term;  // of places: the marking; of transitions: the condition
        std::vector<net::PlaceIndex> unfolded;
        std::vector<net::TransitionIndex> transitions;
    };
    struct Arc {
        std::uint32_t arc = 0;
        std::optional<std::uint32_t> term;  // nothing: one dot
    };

    void error(const char* code, pugi::xml_node at, const std::string& element, std::string message,
               std::string remedy) {
        defects_.error(code, document_.text.where(at), element, std::move(message),
                       std::move(remedy));
    }

    void too_large(pugi::xml_node at, const std::string& element, std::string what) {
        if (!stopped_) {
            error("net-too-large", at, element, std::move(what),
                  "use smaller sorts, or ask for more");
        }
        stopped_ = true;
    }

    bool count(std::uint64_t elements, pugi::xml_node at, const std::string& element) {
        elements_ += elements;
        if (elements_ > limits_.elements) {
            too_large(
                at, element,
                "the net unfolds to more than " + std::to_string(limits_.elements) + " elements");
        }
        return !stopped_;
    }

    void read_place(std::uint32_t n) {
        const PnmlNode& node = document_.nodes[n];
        const std::string element = "place " + node.id;
        const pugi::xml_node type = child(child(node.xml, "type"), "structure");
        pugi::xml_node sort;
        for (const pugi::xml_node c : type.children()) {
            sort = c.type() == pugi::node_element && !sort ? c : sort;
        }
        if (!sort) {
            error("unknown-label", node.xml, element, "it has no <type> with a sort",
                  "write the sort of its tokens in <type><structure>");
            return;
        }
        const std::optional<std::uint32_t> found = colours_.sort_of(sort, element);
        if (!found) {
            return;
        }
        nodes_[n].sort = *found;
        if (const pugi::xml_node marking = child(node.xml, "hlinitialMarking")) {
            nodes_[n].term = terms_.bag(marking, *found, element);
            std::vector<bool> used(colours_.variables().size(), false);
            if (nodes_[n].term) {
                terms_.variables_of(*nodes_[n].term, used);
            }
            if (std::find(used.begin(), used.end(), true) != used.end()) {
                error("wrong-operands", marking, element, "its marking reads a variable",
                      "write constants");
            }
        }
    }

    void read_arc(std::uint32_t a) {
        const PnmlArc& arc = document_.arcs[a];
        const std::string element = "arc " + arc.id;
        Arc read{.arc = a};
        const std::uint32_t sort = nodes_[arc.place].sort;
        const pugi::xml_node label = child(arc.xml, "hlinscription");
        if (arc.type == PnmlArcType::kReset) {
            error("not-supported", arc.xml, element, "reset arcs of coloured nets are not read",
                  "take out each colour by a transition");
        } else if (label) {
            read.term = terms_.bag(label, sort, element);
        } else if (sort != Colours::kDotSort) {
            error("missing-label", arc.xml, element, "it says not which colours it moves",
                  "give it a <hlinscription>");
        }
        arcs_of_[arc.transition].push_back(read);
    }

    void read_condition(std::uint32_t n) {
        const PnmlNode& node = document_.nodes[n];
        if (const pugi::xml_node condition = child(node.xml, "condition")) {
            nodes_[n].term = terms_.condition(condition, "transition " + node.id);
        }
    }

    void unfold_place(std::uint32_t n) {
        const PnmlNode& node = document_.nodes[n];
        Node& place = nodes_[n];
        const std::uint32_t size = colours_.sort(place.sort).size;
        if (!count(size, node.xml, "place " + node.id)) {
            return;
        }
        const SourceSpan where = document_.text.where(node.xml);
        const ElementLook look = look_of(node.xml, node.page, node.order, "hlinitialMarking");
        for (std::uint32_t value = 0; value < size; ++value) {
            net::PlaceDraft draft;
            draft.path = place.sort == Colours::kDotSort
                             ? node.id
                             : node.id + "(" + colours_.name(place.sort, value) + ")";
            draft.caption = node.name == node.id ? "" : node.name;
            draft.where = where;
            place.unfolded.push_back({static_cast<std::uint32_t>(out_.draft.places.size())});
            out_.draft.places.push_back(std::move(draft));
            out_.look.places.push_back(look);
        }
        if (!place.term) {
            return;
        }
        ColourBag bag;
        if (!terms_.evaluate(*place.term, {}, bag, 1, limits_.elements)) {
            too_large(node.xml, "place " + node.id, "its marking is too large");
            return;
        }
        normalize(bag);
        for (const auto& [value, tokens] : bag) {
            if (tokens < 0 || tokens > 0x3FFF'FFFF) {
                error(tokens < 0 ? "number-too-small" : "number-too-large", node.xml,
                      "place " + node.id,
                      "its marking has " + std::to_string(tokens) + " tokens of one colour",
                      "mark it with a number from 0 on");
                return;
            }
            out_.draft.places[place.unfolded[value].value].tokens.push_back(
                {.count = static_cast<std::uint32_t>(tokens)});
        }
    }

    // Depth first over the variables, in the order of their declaration; each part of the
    // condition is looked at as soon as its variables are bound.
    void unfold_transition(std::uint32_t n) {
        const PnmlNode& node = document_.nodes[n];
        std::vector<bool> used(colours_.variables().size(), false);
        for (const Arc& arc : arcs_of_[n]) {
            if (arc.term) {
                terms_.variables_of(*arc.term, used);
            }
        }
        std::vector<std::uint32_t> parts;
        if (nodes_[n].term) {
            terms_.variables_of(*nodes_[n].term, used);
            terms_.conjuncts(*nodes_[n].term, parts);
        }
        std::vector<std::uint32_t> variables;
        for (std::uint32_t v = 0; v < used.size(); ++v) {
            if (used[v]) {
                variables.push_back(v);
            }
        }
        // conditions[d]: those that the first d variables decide.
        std::vector<std::vector<std::uint32_t>> conditions(variables.size() + 1);
        for (const std::uint32_t part : parts) {
            std::vector<bool> read(used.size(), false);
            terms_.variables_of(part, read);
            std::size_t depth = 0;
            for (std::size_t d = 0; d < variables.size(); ++d) {
                depth = read[variables[d]] ? d + 1 : depth;
            }
            conditions[depth].push_back(part);
        }
        std::vector<std::uint32_t> binding(used.size(), 0);
        const auto fits = [&](std::size_t depth) {
            if (++tried_ > limits_.bindings) {
                too_large(node.xml, "transition " + node.id,
                          "more than " + std::to_string(limits_.bindings) +
                              " bindings of variables were tried");
                return false;
            }
            return std::all_of(conditions[depth].begin(), conditions[depth].end(),
                               [&](std::uint32_t c) { return terms_.holds(c, binding); });
        };
        if (!fits(0)) {
            return;
        }
        if (variables.empty()) {
            add_transition(n, variables, binding);
            return;
        }
        std::size_t depth = 0;
        std::vector<std::uint32_t> next(variables.size(), 0);
        while (!stopped_) {
            const std::uint32_t variable = variables[depth];
            if (next[depth] == colours_.sort(colours_.variables()[variable].sort).size) {
                next[depth] = 0;
                if (depth == 0) {
                    return;
                }
                --depth;
                continue;
            }
            binding[variable] = next[depth]++;
            if (!fits(depth + 1)) {
                continue;
            }
            if (depth + 1 == variables.size()) {
                add_transition(n, variables, binding);
            } else {
                ++depth;
            }
        }
    }

    void add_transition(std::uint32_t n, const std::vector<std::uint32_t>& variables,
                        const std::vector<std::uint32_t>& binding) {
        const PnmlNode& node = document_.nodes[n];
        net::TransitionDraft t;
        t.path = node.id;
        for (std::size_t i = 0; i < variables.size(); ++i) {
            const ColourVariable& v = colours_.variables()[variables[i]];
            t.path += (i == 0 ? "(" : ",") + colours_.name(v.sort, binding[variables[i]]);
        }
        t.path += variables.empty() ? "" : ")";
        t.caption = node.name == node.id ? "" : node.name;
        t.where = document_.text.where(node.xml);
        const net::TransitionIndex index{static_cast<std::uint32_t>(out_.draft.transitions.size())};
        std::uint64_t arcs = 0;
        for (const Arc& arc : arcs_of_[n]) {
            if (!add_arcs(arc, binding, t, arcs)) {
                return;
            }
        }
        if (!count(1 + arcs, node.xml, "transition " + node.id)) {
            return;
        }
        nodes_[n].transitions.push_back(index);
        out_.draft.transitions.push_back(std::move(t));
        out_.look.transitions.push_back(look_of(node.xml, node.page, node.order, ""));
    }

    bool add_arcs(const Arc& arc, const std::vector<std::uint32_t>& binding,
                  net::TransitionDraft& t, std::uint64_t& arcs) {
        const PnmlArc& raw_arc = document_.arcs[arc.arc];
        const std::string element = "arc " + raw_arc.id;
        ColourBag bag;
        if (!arc.term) {
            bag.emplace_back(0, 1);
        } else if (!terms_.evaluate(*arc.term, binding, bag, 1, limits_.elements)) {
            too_large(raw_arc.xml, element, "its inscription is too large");
            return false;
        }
        normalize(bag);
        if (raw_arc.type == PnmlArcType::kInhibitor && bag.size() != 1) {
            error("not-supported", raw_arc.xml, element,
                  "an inhibitor arc with no colour, or with several, is not read",
                  "write one inhibitor arc for each colour");
            stopped_ = true;
            return false;
        }
        const std::vector<net::PlaceIndex>& places = nodes_[raw_arc.place].unfolded;
        for (const auto& [value, weight] : bag) {
            if (weight < 0 || weight > 0x3FFF'FFFF) {
                error(weight < 0 ? "number-too-small" : "number-too-large", raw_arc.xml, element,
                      "it moves " + std::to_string(weight) + " tokens of colour " +
                          colours_.name(nodes_[raw_arc.place].sort, value) + " in transition " +
                          t.path,
                      "exclude the binding by a condition");
                stopped_ = true;
                return false;
            }
            // Without position and look: there are too many of them, and the node's say enough.
            if (raw_arc.is_output) {
                t.outputs.push_back({.place = places[value], .weight = weight});
            } else {
                t.inputs.push_back(
                    {.kind = raw_arc.type == PnmlArcType::kInhibitor ? net::ArcKind::kUnless
                             : raw_arc.type == PnmlArcType::kRead    ? net::ArcKind::kRead
                                                                     : net::ArcKind::kTake,
                     .place = places[value],
                     .weight = weight});
            }
            if (++arcs + elements_ > limits_.elements) {
                return count(arcs, raw_arc.xml, element);
            }
        }
        return true;
    }

    const PnmlDocument& document_;
    const NetLimits& limits_;
    NetFile& out_;
    Defects& defects_;
    Colours colours_;
    ColourTerms terms_;
    std::vector<Node> nodes_;  // per node of the document
    std::vector<std::vector<Arc>> arcs_of_;
    std::uint64_t elements_ = 0, tried_ = 0;
    bool stopped_ = false;
};

}  // namespace

void build_symmetric(const PnmlDocument& document, const NetLimits& limits, NetFile& out,
                     Defects& defects) {
    Unfolding(document, limits, out, defects).run();
}

}  // namespace puppetri::io
