// SPDX-License-Identifier: MIT
// PNML 2009 out. Pages, reference nodes, positions and other tools' elements are written where the
// net came from a file that had them, in the order of that file.
#include <algorithm>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "net_features.h"
#include "net_writers.h"
#include "puppetri/base/text.h"
#include "puppetri/io/xml_escaped.h"

namespace puppetri::io {
namespace {

const char* type_of(net::ArcKind kind) {
    switch (plain_kind(kind)) {
        case net::ArcKind::kUnless:
            return "inhibitor";
        case net::ArcKind::kRead:
            return "read";
        case net::ArcKind::kTakeAll:
            return "reset";
        default:
            return "";
    }
}

class Writer {
 public:
    explicit Writer(const NetFile& file) : file_(file), draft_(file.draft), look_(file.look) {
        looked_at_ = look_.places.size() == draft_.places.size() &&
                     look_.transitions.size() == draft_.transitions.size() && !look_.pages.empty();
    }

    std::string run() {
        collect_ids();
        collect_items();
        const std::string id = look_.id.empty() ? "net" : look_.id;
        out_ =
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<pnml xmlns=\"http://www.pnml.org/version-2009/grammar/pnml\">\n"
            "  <net id=\"" +
            xml_escaped(id) + "\" type=\"http://www.pnml.org/version-2009/grammar/ptnet\">\n";
        if (!draft_.name.empty() && draft_.name != id) {
            out_ += "    <name><text>" + xml_escaped(draft_.name) + "</text></name>\n";
        }
        // What stands in the net itself stands on a page of its own: the standard wants pages.
        const bool loose = std::any_of(items_.begin(), items_.end(), [](const Item& i) {
            return i.page == 0 && i.kind != Item::kPage;
        });
        if (loose || items_.empty()) {
            out_ += "    <page id=\"" + xml_escaped(fresh("page")) + "\">\n";
            page(0, 3);
            out_ += "    </page>\n";
        } else {
            page(0, 2);
        }
        if (looked_at_ && !look_.extra.empty() && file_.format == NetFormat::kPnml) {
            out_ += "    " + look_.extra + "\n";
        }
        out_ += "  </net>\n</pnml>\n";
        return std::move(out_);
    }

 private:
    struct Item {
        enum Kind : std::uint8_t { kPlace, kTransition, kReference, kArc, kPage };
        std::uint32_t page = 0, order = 0;
        Kind kind = kPlace;
        std::uint32_t index = 0;  // of arcs: in arcs_
    };
    struct Arc {
        std::uint32_t transition = 0, number = 0;
        bool is_output = false;
        const ArcLook* look = nullptr;
    };

    void collect_ids() {
        for (const net::PlaceDraft& p : draft_.places) {
            ids_.insert(p.path);
        }
        for (const net::TransitionDraft& t : draft_.transitions) {
            ids_.insert(t.path);
        }
        if (looked_at_) {
            for (const ReferenceLook& r : look_.references) {
                ids_.insert(r.id);
            }
            for (const PageLook& p : look_.pages) {
                ids_.insert(p.id);
            }
        }
    }

    // An id that nobody has.
    std::string fresh(const std::string& stem) {
        std::string id = stem;
        for (std::uint32_t n = 0; id.empty() || !ids_.insert(id).second; ++n) {
            id = stem + std::to_string(next_ + n);
        }
        return id;
    }
    std::string arc_id(const std::string& wanted) {
        if (!wanted.empty() && ids_.insert(wanted).second) {
            return wanted;
        }
        for (;; ++next_) {
            std::string id = "arc" + std::to_string(next_);
            if (ids_.insert(id).second) {
                return id;
            }
        }
    }

    void collect_items() {
        std::vector<std::tuple<std::uint32_t, bool, std::uint32_t, const ArcLook*>> looks;
        if (looked_at_) {
            for (const ArcLook& a : look_.arcs) {
                looks.emplace_back(a.transition.value, a.is_output, a.number, &a);
            }
            std::sort(looks.begin(), looks.end(), [](const auto& a, const auto& b) {
                return std::tuple(std::get<0>(a), std::get<1>(a), std::get<2>(a)) <
                       std::tuple(std::get<0>(b), std::get<1>(b), std::get<2>(b));
            });
        }
        const auto look_of_arc = [&](const Arc& arc) -> const ArcLook* {
            const auto at =
                std::lower_bound(looks.begin(), looks.end(), arc, [](const auto& a, const Arc& b) {
                    return std::tuple(std::get<0>(a), std::get<1>(a), std::get<2>(a)) <
                           std::tuple(b.transition, b.is_output, b.number);
                });
            return at != looks.end() && std::get<0>(*at) == arc.transition &&
                           std::get<1>(*at) == arc.is_output && std::get<2>(*at) == arc.number
                       ? std::get<3>(*at)
                       : nullptr;
        };
        for (std::uint32_t i = 0; i < draft_.places.size(); ++i) {
            add(Item::kPlace, i, looked_at_ ? &look_.places[i] : nullptr);
        }
        for (std::uint32_t i = 0; i < draft_.transitions.size(); ++i) {
            const ElementLook* look = looked_at_ ? &look_.transitions[i] : nullptr;
            add(Item::kTransition, i, look);
            const net::TransitionDraft& t = draft_.transitions[i];
            for (const bool is_output : {false, true}) {
                const auto count =
                    static_cast<std::uint32_t>(is_output ? t.outputs.size() : t.inputs.size());
                for (std::uint32_t n = 0; n < count; ++n) {
                    Arc arc{.transition = i, .number = n, .is_output = is_output};
                    arc.look = look_of_arc(arc);
                    arcs_.push_back(arc);
                    add(Item::kArc, static_cast<std::uint32_t>(arcs_.size()) - 1,
                        arc.look != nullptr ? &arc.look->look : nullptr);
                    if (arc.look == nullptr && look != nullptr) {
                        items_.back().page = look->page;
                        items_.back().order = ~std::uint32_t{0};
                    }
                }
            }
        }
        if (looked_at_) {
            for (std::uint32_t i = 0; i < look_.references.size(); ++i) {
                add(Item::kReference, i, &look_.references[i].look);
            }
            for (std::uint32_t i = 1; i < look_.pages.size(); ++i) {
                items_.push_back({look_.pages[i].parent, look_.pages[i].order, Item::kPage, i});
            }
        }
        std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
            return std::tuple(a.page, a.order, a.kind, a.index) <
                   std::tuple(b.page, b.order, b.kind, b.index);
        });
    }

    void add(Item::Kind kind, std::uint32_t index, const ElementLook* look) {
        items_.push_back(
            {look != nullptr ? look->page : 0, look != nullptr ? look->order : 0, kind, index});
    }

    // Depth: at most what the reader let in.
    void page(std::uint32_t number, unsigned depth) {
        auto at = std::lower_bound(items_.begin(), items_.end(), number,
                                   [](const Item& i, std::uint32_t p) { return i.page < p; });
        for (; at != items_.end() && at->page == number; ++at) {
            const std::string indent(2 * std::min(depth, 20u), ' ');
            switch (at->kind) {
                case Item::kPlace:
                    place(at->index, indent);
                    break;
                case Item::kTransition:
                    transition(at->index, indent);
                    break;
                case Item::kReference:
                    reference(look_.references[at->index], indent);
                    break;
                case Item::kArc:
                    arc(arcs_[at->index], indent);
                    break;
                case Item::kPage: {
                    const PageLook& p = look_.pages[at->index];
                    out_ += indent + "<page id=\"" + xml_escaped(p.id) + "\">\n";
                    if (!p.name.empty()) {
                        out_ +=
                            indent + "  <name><text>" + xml_escaped(p.name) + "</text></name>\n";
                    }
                    if (!p.extra.empty()) {
                        out_ += indent + "  " + p.extra + "\n";
                    }
                    page(at->index, depth + 1);
                    out_ += indent + "</page>\n";
                    break;
                }
            }
        }
    }

    // Only what is a graphics element of PNML: PIPE writes empty ones.
    static std::string graphics(const std::string& xml) {
        return xml.find("<position") != std::string::npos ||
                       xml.find("<offset") != std::string::npos ||
                       xml.find("<line") != std::string::npos ||
                       xml.find("<dimension") != std::string::npos
                   ? xml
                   : "";
    }

    void name_and_look(const std::string& name, const ElementLook* look,
                       const std::string& indent) {
        if (!name.empty()) {
            out_ += indent + "  <name>" + (look != nullptr ? graphics(look->name_graphics) : "") +
                    "<text>" + xml_escaped(name) + "</text></name>\n";
        }
        if (look != nullptr && !graphics(look->graphics).empty()) {
            out_ += indent + "  " + look->graphics + "\n";
        } else if (look != nullptr && look->at) {
            out_ += indent + "  <graphics><position x=\"" + number_to_text(look->at->x) +
                    "\" y=\"" + number_to_text(look->at->y) + "\"/></graphics>\n";
        }
    }

    void tools(const ElementLook* look, const std::string& indent) {
        if (look != nullptr && !look->tools.empty()) {
            out_ += indent + "  " + look->tools + "\n";
        }
    }

    void place(std::uint32_t i, const std::string& indent) {
        const net::PlaceDraft& p = draft_.places[i];
        const ElementLook* look = looked_at_ ? &look_.places[i] : nullptr;
        out_ += indent + "<place id=\"" + xml_escaped(p.path) + "\">\n";
        name_and_look(p.caption, look, indent);
        if (const std::int64_t tokens = initial_tokens(p); tokens > 0) {
            out_ += indent + "  <initialMarking>" +
                    (look != nullptr ? graphics(look->value_graphics) : "") + "<text>" +
                    std::to_string(tokens) + "</text></initialMarking>\n";
        }
        tools(look, indent);
        out_ += indent + "</place>\n";
    }

    void transition(std::uint32_t i, const std::string& indent) {
        const net::TransitionDraft& t = draft_.transitions[i];
        const ElementLook* look = looked_at_ ? &look_.transitions[i] : nullptr;
        out_ += indent + "<transition id=\"" + xml_escaped(t.path) + "\">\n";
        name_and_look(t.caption, look, indent);
        tools(look, indent);
        out_ += indent + "</transition>\n";
    }

    void reference(const ReferenceLook& r, const std::string& indent) {
        const std::string tag = r.is_place ? "referencePlace" : "referenceTransition";
        out_ += indent + "<" + tag + " id=\"" + xml_escaped(r.id) + "\" ref=\"" +
                xml_escaped(r.to) + "\">\n";
        name_and_look(r.name, &r.look, indent);
        tools(&r.look, indent);
        out_ += indent + "</" + tag + ">\n";
    }

    void arc(const Arc& arc, const std::string& indent) {
        const net::TransitionDraft& t = draft_.transitions[arc.transition];
        const net::ArcDraft* in = arc.is_output ? nullptr : &t.inputs[arc.number];
        const net::PlaceIndex place_index = arc.is_output ? t.outputs[arc.number].place : in->place;
        const std::int64_t weight = arc.is_output ? t.outputs[arc.number].weight : in->weight;
        // The ids of reference nodes, where they lead to this very place and transition.
        std::string place = draft_.places[place_index.value].path, transition = t.path;
        if (arc.look != nullptr) {
            const std::string& from = arc.is_output ? arc.look->target : arc.look->source;
            const std::string& other = arc.is_output ? arc.look->source : arc.look->target;
            const auto* places = file_.ids.find_places(from);
            const auto* transitions = file_.ids.find_transitions(other);
            if (places != nullptr && places->size() == 1 && places->front() == place_index) {
                place = from;
            }
            if (transitions != nullptr && transitions->size() == 1 &&
                transitions->front().value == arc.transition) {
                transition = other;
            }
        }
        out_ += indent + "<arc id=\"" +
                xml_escaped(arc_id(arc.look != nullptr ? arc.look->id : "")) + "\" source=\"" +
                xml_escaped(arc.is_output ? transition : place) + "\" target=\"" +
                xml_escaped(arc.is_output ? place : transition) + "\"";
        if (const std::string type = in != nullptr ? type_of(in->kind) : ""; !type.empty()) {
            out_ += " type=\"" + type + "\"";
        }
        const std::string drawn = arc.look != nullptr ? graphics(arc.look->look.graphics) : "";
        const std::string value =
            arc.look != nullptr ? graphics(arc.look->look.value_graphics) : "";
        const std::string tools = arc.look != nullptr ? arc.look->look.tools : "";
        if (drawn.empty() && value.empty() && tools.empty() && weight == 1) {
            out_ += "/>\n";
            return;
        }
        out_ += ">" + drawn;
        if (weight != 1 || !value.empty()) {
            out_ += "<inscription>" + value + "<text>" + std::to_string(weight) +
                    "</text></inscription>";
        }
        out_ += tools + "</arc>\n";
    }

    const NetFile& file_;
    const net::NetDraft& draft_;
    const NetLook& look_;
    bool looked_at_ = false;
    std::set<std::string> ids_;
    std::uint32_t next_ = 1;
    std::vector<Item> items_;
    std::vector<Arc> arcs_;
    std::string out_;
};

}  // namespace

std::string pnml_text(const NetFile& file, Diagnostics&) { return Writer(file).run(); }

}  // namespace puppetri::io
