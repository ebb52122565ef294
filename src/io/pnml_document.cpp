// SPDX-License-Identifier: MIT
#include "pnml_document.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "puppetri/base/text.h"

namespace puppetri::io {
namespace {

constexpr std::int64_t kMostCount = 0x7FFF'FFFF;

// Net types by the last part of their URI. Older drafts of the standard wrote the others.
constexpr std::array<std::string_view, 7> kPlainTypes = {
    "ptnet", "pnmlcoremodel", "ptNetb", "ptNet", "PTNet", "core", "pnmlcore"};
constexpr std::array<std::string_view, 4> kColouredTypes = {"symmetricnet", "hlpn", "pt-hlpng",
                                                            "highlevelnet"};

template <class List>
bool contains(const List& list, std::string_view x) {
    return std::find(list.begin(), list.end(), x) != list.end();
}

class Collector {
 public:
    Collector(PnmlDocument& out, const NetLimits& limits, Defects& defects)
        : out_(out), limits_(limits), defects_(defects) {}

    bool run() {
        const pugi::xml_node root = out_.text.root();
        if (local_name(root) != "pnml") {
            defects_.error("not-pnml", at(root), "", "the file is XML, but not a PNML file",
                           "a PNML file begins with <pnml>");
            return false;
        }
        if (!find_net(root)) {
            return false;
        }
        out_.id = out_.net.attribute("id").value();
        const pugi::xml_node name = child(out_.net, "name");
        out_.name = name ? label_text(name) : "";
        out_.pages.push_back({});  // the net itself
        walk();
        resolve_nodes();
        resolve_arcs();
        return true;
    }

 private:
    SourceSpan at(pugi::xml_node node) const { return out_.text.where(node); }

    bool find_net(pugi::xml_node root) {
        for (const pugi::xml_node node : root.children()) {
            const std::string_view name = local_name(node);
            if (node.type() != pugi::node_element || name == "toolspecific" || name == "name") {
                continue;
            }
            if (name != "net") {
                unknown(node, "file");
            } else if (out_.net) {
                defects_.error("many-nets", at(node), "net " + std::string(id_of(node)),
                               "the file holds more than one net",
                               "write each net into a file of its own");
            } else {
                out_.net = node;
            }
        }
        if (!out_.net) {
            defects_.error("not-pnml", at(root), "", "the file holds no net",
                           "put a <net> into <pnml>");
            return false;
        }
        const std::string_view type = out_.net.attribute("type").value();
        const std::string_view last = type.substr(type.find_last_of("/#") + 1);
        if (type.empty() || contains(kPlainTypes, last)) {
            out_.type = PnmlType::kPlain;
        } else if (contains(kColouredTypes, last)) {
            out_.type = PnmlType::kColoured;
        } else {
            defects_.error("unknown-net-type", at(out_.net), "net " + std::string(id_of(out_.net)),
                           "the net type " + std::string(type) + " is not read",
                           "place/transition nets (.../ptnet) and symmetric nets "
                           "(.../symmetricnet) are");
            return false;
        }
        return true;
    }

    static std::string_view id_of(pugi::xml_node node) { return node.attribute("id").value(); }

    void unknown(pugi::xml_node node, const std::string& inside) {
        defects_.error("unknown-label", at(node), inside,
                       "<" + std::string(local_name(node)) + "> is not known here",
                       "take it out, or put it into <toolspecific> if it changes nothing");
    }

    // All pages, in the order of the file, without recursion.
    void walk() {
        struct Open {
            pugi::xml_node next;
            std::uint32_t page = 0;
        };
        std::vector<Open> open = {{out_.net.first_child(), 0}};
        while (!open.empty()) {
            const pugi::xml_node node = open.back().next;
            if (!node) {
                open.pop_back();
                continue;
            }
            open.back().next = node.next_sibling();
            const std::uint32_t page = open.back().page;
            if (node.type() != pugi::node_element) {
                if (node.type() == pugi::node_pcdata && !trimmed(node.value()).empty()) {
                    defects_.error("unknown-label", at(node.parent()), "",
                                   "text where elements are expected", "take it out");
                }
                continue;
            }
            const std::string_view name = local_name(node);
            if (name == "page") {
                if (open.size() > limits_.nesting) {
                    defects_.error("nested-too-deep", at(node), "page " + std::string(id_of(node)),
                                   "pages are nested deeper than " +
                                       std::to_string(limits_.nesting) + " levels",
                                   "flatten them");
                    continue;
                }
                const pugi::xml_node label = child(node, "name");
                out_.pages.push_back({.id = std::string(id_of(node)),
                                      .name = label ? label_text(label) : "",
                                      .parent = page,
                                      .order = order_++,
                                      .extra = extra_of(node)});
                open.push_back(
                    {node.first_child(), static_cast<std::uint32_t>(out_.pages.size()) - 1});
            } else if (name == "place") {
                add_node(node, PnmlNode::kPlace, page);
            } else if (name == "transition") {
                add_node(node, PnmlNode::kTransition, page);
            } else if (name == "referencePlace") {
                add_node(node, PnmlNode::kReferencePlace, page);
            } else if (name == "referenceTransition") {
                add_node(node, PnmlNode::kReferenceTransition, page);
            } else if (name == "arc") {
                add_arc(node, page);
            } else if (name == "declaration") {
                out_.declarations.push_back(node);
            } else if (name != "name" && name != "graphics" && name != "toolspecific") {
                unknown(node, page == 0 ? "net " + out_.id : "page " + out_.pages[page].id);
            }
        }
    }

    static std::string extra_of(pugi::xml_node node) {
        std::string out;
        for (const pugi::xml_node c : node.children()) {
            const std::string_view name = local_name(c);
            if (name == "graphics" || name == "toolspecific") {
                out += raw(c);
            }
        }
        return out;
    }

    void check_inside(pugi::xml_node node, const std::string& element,
                      std::initializer_list<std::string_view> labels,
                      std::initializer_list<std::string_view> attributes) {
        std::array<std::uint8_t, 8> seen{};
        for (const pugi::xml_node c : node.children()) {
            if (c.type() == pugi::node_pcdata && !trimmed(c.value()).empty()) {
                defects_.error("unknown-label", at(node), element, "text where labels are expected",
                               "take it out");
            }
            if (c.type() != pugi::node_element) {
                continue;
            }
            const std::string_view name = local_name(c);
            if (name == "toolspecific") {
                continue;
            }
            const auto found = std::find(labels.begin(), labels.end(), name);
            if (found == labels.end()) {
                unknown(c, element);
            } else if (++seen[static_cast<std::size_t>(found - labels.begin())] == 2) {
                defects_.error("duplicate-label", at(c), element,
                               "<" + std::string(name) + "> stands here twice", "keep one of them");
            }
        }
        for (const pugi::xml_attribute a : node.attributes()) {
            const std::string_view name = a.name();
            if (std::find(attributes.begin(), attributes.end(), name) == attributes.end() &&
                name.find(':') == std::string_view::npos && name != "xmlns") {
                defects_.error("unknown-attribute", at(node), element,
                               "the attribute " + std::string(name) + " is not known here",
                               "take it out; if it has a meaning, say it with an element of PNML");
            }
        }
    }

    void add_node(pugi::xml_node xml, PnmlNode::Kind kind, std::uint32_t page) {
        PnmlNode node;
        node.kind = kind;
        node.xml = xml;
        node.id = id_of(xml);
        node.page = page;
        node.order = order_++;
        const std::string element = element_of(node);
        const bool coloured = out_.type == PnmlType::kColoured;
        if (node.is_reference()) {
            check_inside(xml, element, {"name", "graphics"}, {"id", "ref"});
        } else if (kind == PnmlNode::kTransition) {
            if (coloured) {
                check_inside(xml, element, {"name", "graphics", "condition"}, {"id"});
            } else {
                check_inside(xml, element, {"name", "graphics"}, {"id"});
            }
        } else if (coloured) {
            check_inside(xml, element, {"name", "graphics", "type", "hlinitialMarking"}, {"id"});
        } else {
            check_inside(xml, element, {"name", "graphics", "initialMarking"}, {"id"});
        }
        if (node.id.empty()) {
            defects_.error("missing-id", at(xml), element, "it has no id", "give it one");
        }
        const pugi::xml_node label = child(xml, "name");
        if (label) {
            node.name = label_text(label);
        }
        node.stands_for = static_cast<std::uint32_t>(out_.nodes.size());
        out_.nodes.push_back(std::move(node));
    }

    static std::string element_of(const PnmlNode& node) {
        constexpr std::array<const char*, 4> kNames = {"place ", "transition ", "reference place ",
                                                       "reference transition "};
        return kNames[node.kind] + node.id;
    }

    void add_arc(pugi::xml_node xml, std::uint32_t page) {
        PnmlArc arc;
        arc.xml = xml;
        arc.id = id_of(xml);
        arc.source = xml.attribute("source").value();
        arc.target = xml.attribute("target").value();
        arc.page = page;
        arc.order = order_++;
        if (out_.type == PnmlType::kColoured) {
            check_inside(xml, "arc " + arc.id,
                         {"name", "graphics", "type", "arctype", "hlinscription"},
                         {"id", "source", "target", "type"});
        } else {
            check_inside(xml, "arc " + arc.id,
                         {"name", "graphics", "type", "arctype", "inscription"},
                         {"id", "source", "target", "type"});
        }
        out_.arcs.push_back(std::move(arc));
    }

    // Ids in order, to be searched.
    using Table = std::vector<std::pair<std::string_view, std::uint32_t>>;

    const std::uint32_t* find(std::string_view id) const {
        const auto at = std::lower_bound(table_.begin(), table_.end(),
                                         std::pair<std::string_view, std::uint32_t>{id, 0});
        return at == table_.end() || at->first != id ? nullptr : &at->second;
    }

    std::string similar(std::string_view id) const {
        if (table_.size() > 2000) {
            return "";
        }
        std::vector<std::string> known;
        known.reserve(table_.size());
        for (const auto& row : table_) {
            known.emplace_back(row.first);
        }
        return std::string(nearest_name(id, known));
    }

    void unknown_id(pugi::xml_node xml, const std::string& element, const char* what,
                    const std::string& id) {
        if (id.empty()) {
            defects_.error("missing-id", at(xml), element, std::string("it has no ") + what,
                           "name a place or transition");
            return;
        }
        const std::string near = similar(id);
        defects_.error(
            "unknown-id", at(xml), element,
            std::string("its ") + what + " " + id + " does not exist",
            near.empty() ? "name a place or transition of the file" : "did you mean " + near + "?");
    }

    void resolve_nodes() {
        for (std::uint32_t i = 0; i < out_.nodes.size(); ++i) {
            table_.emplace_back(out_.nodes[i].id, i);
        }
        std::sort(table_.begin(), table_.end());
        for (std::size_t i = 1; i < table_.size(); ++i) {
            const PnmlNode& node = out_.nodes[table_[i].second];
            if (table_[i].first == table_[i - 1].first && !node.id.empty()) {
                const SourceSpan first = at(out_.nodes[table_[i - 1].second].xml);
                defects_.error(
                    "duplicate-id", at(node.xml), element_of(node),
                    "the id is taken by another element, in line " + std::to_string(first.line),
                    "give one of them another id");
            }
        }
        // References: 0 not looked at, 1 on the way, 2 done.
        std::vector<std::uint8_t> seen(out_.nodes.size(), 0);
        std::vector<std::uint32_t> chain;
        for (std::uint32_t i = 0; i < out_.nodes.size(); ++i) {
            chain.clear();
            std::uint32_t n = i;
            bool fine = true;
            while (out_.nodes[n].is_reference() && seen[n] == 0) {
                seen[n] = 1;
                chain.push_back(n);
                const PnmlNode& node = out_.nodes[n];
                const std::string to = node.xml.attribute("ref").value();
                const std::uint32_t* next = find(to);
                if (next == nullptr) {
                    unknown_id(node.xml, element_of(node), "ref", to);
                    fine = false;
                    break;
                }
                if (out_.nodes[*next].is_place() != node.is_place()) {
                    defects_.error("wrong-reference", at(node.xml), element_of(node),
                                   "it refers to " + element_of(out_.nodes[*next]),
                                   "a reference place refers to places, a reference transition to "
                                   "transitions");
                    fine = false;
                    break;
                }
                n = *next;
            }
            if (fine && out_.nodes[n].is_reference() && seen[n] == 1) {
                defects_.error("wrong-reference", at(out_.nodes[n].xml), element_of(out_.nodes[n]),
                               "it refers to itself, in a circle of references",
                               "let one of them refer to a real node");
            }
            const std::uint32_t end =
                out_.nodes[n].is_reference() && seen[n] == 2 ? out_.nodes[n].stands_for : n;
            for (const std::uint32_t c : chain) {
                seen[c] = 2;
                out_.nodes[c].stands_for = end;
            }
        }
    }

    void resolve_arcs() {
        std::vector<std::string_view> ids;
        std::size_t kept = 0;
        for (PnmlArc& arc : out_.arcs) {
            const std::string element = "arc " + arc.id;
            const std::uint32_t* from = find(arc.source);
            const std::uint32_t* to = find(arc.target);
            if (from == nullptr) {
                unknown_id(arc.xml, element, "source", arc.source);
            }
            if (to == nullptr) {
                unknown_id(arc.xml, element, "target", arc.target);
            }
            const bool known = read_type(arc, element);
            if (from == nullptr || to == nullptr) {
                continue;
            }
            const bool from_place = out_.nodes[*from].is_place();
            if (from_place == out_.nodes[*to].is_place()) {
                defects_.error("arc-joins-alike", at(arc.xml), element,
                               from_place ? "it joins two places" : "it joins two transitions",
                               "an arc goes from a place to a transition, or back");
                continue;
            }
            arc.is_output = !from_place;
            if (arc.is_output && known && arc.type != PnmlArcType::kNormal) {
                defects_.error("arc-type-backwards", at(arc.xml), element,
                               "an arc of this type cannot lead from a transition to a place",
                               "let it lead from the place to the transition");
                continue;
            }
            arc.place = out_.nodes[from_place ? *from : *to].stands_for;
            arc.transition = out_.nodes[from_place ? *to : *from].stands_for;
            if (out_.nodes[arc.place].is_reference() || out_.nodes[arc.transition].is_reference()) {
                continue;  // told before
            }
            if (kept != static_cast<std::size_t>(&arc - out_.arcs.data())) {
                out_.arcs[kept] = std::move(arc);
            }
            ++kept;
        }
        out_.arcs.resize(kept);
    }

    // What an arc is, in all dialects: the attribute type="inhibitor", a child
    // <type value="inhibitor"/>, <type><text>.., <arctype><text>...
    // Fails  on every word that is not known.
    bool read_type(PnmlArc& arc, const std::string& element) {
        std::vector<std::string> words;
        if (const pugi::xml_attribute type = arc.xml.attribute("type")) {
            words.emplace_back(type.value());
        }
        for (const std::string_view name : {"type", "arctype"}) {
            if (const pugi::xml_node label = child(arc.xml, name)) {
                const pugi::xml_attribute value = label.attribute("value");
                words.push_back(value ? value.value() : label_text(label));
            }
        }
        bool fine = true;
        for (std::size_t i = 0; i < words.size(); ++i) {
            const std::string& word = words[i];
            PnmlArcType type = PnmlArcType::kNormal;
            if (word == "inhibitor") {
                type = PnmlArcType::kInhibitor;
            } else if (word == "read" || word == "test") {
                type = PnmlArcType::kRead;
            } else if (word == "reset") {
                type = PnmlArcType::kReset;
            } else if (word != "normal") {
                defects_.error("unknown-arc-type", at(arc.xml), element,
                               "the arc type \"" + word + "\" is not known",
                               "known are normal, inhibitor, read, test and reset");
                fine = false;
                continue;
            }
            if (i > 0 && type != arc.type) {
                defects_.error("unknown-arc-type", at(arc.xml), element,
                               "it has two types that disagree", "keep one of them");
                fine = false;
            }
            arc.type = type;
        }
        return fine;
    }

    PnmlDocument& out_;
    const NetLimits& limits_;
    Defects& defects_;
    Table table_;
    std::uint32_t order_ = 0;
};

std::optional<DrawingPoint> point_of(pugi::xml_node graphics) {
    const pugi::xml_node position = child(graphics, "position");
    if (!position) {
        return std::nullopt;
    }
    const auto x = parse_number(position.attribute("x").value());
    const auto y = parse_number(position.attribute("y").value());
    return x && y ? std::optional<DrawingPoint>({*x, *y}) : std::nullopt;
}

std::string graphics_of(pugi::xml_node label) {
    const pugi::xml_node graphics = label ? child(label, "graphics") : pugi::xml_node();
    return graphics ? raw(graphics) : "";
}

}  // namespace

bool read_pnml_document(std::string_view text, const std::string& path, const NetLimits& limits,
                        PnmlDocument& out, Defects& defects) {
    return out.text.parse(text, path, limits.bytes, defects) &&
           Collector(out, limits, defects).run();
}

std::string label_text(pugi::xml_node label) {
    pugi::xml_node text = child(label, "text");
    if (!text) {
        text = child(label, "value");
    }
    return text ? text_of(text) : "";
}

std::int64_t label_count(const PnmlDocument& document, pugi::xml_node label, std::int64_t least,
                         std::int64_t otherwise, const std::string& element, Defects& defects) {
    if (!label) {
        return otherwise;
    }
    const std::string said = label_text(label);
    const ParsedInteger number = parse_integer(said);
    const std::string what = "<" + std::string(local_name(label)) + ">";
    if (number.kind == ParsedInteger::kNoNumber) {
        defects.error("not-a-number", document.text.where(label), element,
                      what + " says \"" + said.substr(0, 40) + "\", which is no whole number",
                      "write a whole number from " + std::to_string(least) + " on");
        return otherwise;
    }
    if (number.kind == ParsedInteger::kTooLarge || number.value > kMostCount) {
        defects.error("number-too-large", document.text.where(label), element,
                      what + " is larger than " + std::to_string(kMostCount), "use fewer tokens");
        return otherwise;
    }
    if (number.value < least) {
        defects.error("number-too-small", document.text.where(label), element,
                      what + " is less than " + std::to_string(least),
                      "write a whole number from " + std::to_string(least) + " on");
        return otherwise;
    }
    return number.value;
}

ElementLook look_of(pugi::xml_node xml, std::uint32_t page, std::uint32_t order,
                    std::string_view value_label) {
    ElementLook look;
    look.page = page;
    look.order = order;
    for (const pugi::xml_node c : xml.children()) {
        const std::string_view name = local_name(c);
        if (name == "graphics") {
            look.graphics = raw(c);
            look.at = point_of(c);
        } else if (name == "toolspecific") {
            look.tools += raw(c);
        } else if (name == "name") {
            look.name_graphics = graphics_of(c);
        } else if (name == value_label) {
            look.value_graphics = graphics_of(c);
        }
    }
    return look;
}

void fill_look(const PnmlDocument& document, NetLook& look) {
    look.id = document.id;
    for (const pugi::xml_node c : document.net.children()) {
        if (local_name(c) == "toolspecific") {
            look.extra += raw(c);
        }
    }
    // Page 0 is the net itself in both.
    look.pages = document.pages;
    for (const PnmlNode& node : document.nodes) {
        if (node.is_reference()) {
            look.references.push_back({.is_place = node.is_place(),
                                       .id = node.id,
                                       .to = node.xml.attribute("ref").value(),
                                       .name = node.name,
                                       .look = look_of(node.xml, node.page, node.order, "")});
        }
    }
}

}  // namespace puppetri::io
