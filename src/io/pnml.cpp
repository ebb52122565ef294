// SPDX-License-Identifier: MIT
#include "puppetri/io/pnml.h"

#include "defects.h"
#include "pnml_document.h"
#include "symmetric_unfold.h"
#include "test_arcs.h"

namespace puppetri::io {
namespace {

net::ArcKind arc_kind(PnmlArcType type) {
    switch (type) {
        case PnmlArcType::kInhibitor:
            return net::ArcKind::kUnless;
        case PnmlArcType::kRead:
            return net::ArcKind::kRead;
        case PnmlArcType::kReset:
            return net::ArcKind::kTakeAll;
        case PnmlArcType::kNormal:
            break;
    }
    return net::ArcKind::kTake;
}

// The draft of a place/transition net, element by element.
void build_plain(const PnmlDocument& document, NetFile& out, Defects& defects) {
    std::vector<std::uint32_t> index(document.nodes.size(), 0);
    const auto index_of = [&](std::uint32_t node) {
        return index[document.nodes[node].stands_for];
    };
    for (std::uint32_t n = 0; n < document.nodes.size(); ++n) {
        const PnmlNode& node = document.nodes[n];
        if (node.kind == PnmlNode::kPlace) {
            net::PlaceDraft place;
            place.path = node.id;
            place.caption = node.name;
            place.where = document.text.where(node.xml);
            const std::int64_t tokens = label_count(document, child(node.xml, "initialMarking"), 0,
                                                    0, "place " + node.id, defects);
            if (tokens > 0) {
                place.tokens.push_back({.count = static_cast<std::uint32_t>(tokens)});
            }
            index[n] = static_cast<std::uint32_t>(out.draft.places.size());
            out.draft.places.push_back(std::move(place));
            out.look.places.push_back(look_of(node.xml, node.page, node.order, "initialMarking"));
        } else if (node.kind == PnmlNode::kTransition) {
            net::TransitionDraft transition;
            transition.path = node.id;
            transition.caption = node.name;
            transition.where = document.text.where(node.xml);
            index[n] = static_cast<std::uint32_t>(out.draft.transitions.size());
            out.draft.transitions.push_back(std::move(transition));
            out.look.transitions.push_back(look_of(node.xml, node.page, node.order, ""));
        }
    }
    for (std::uint32_t n = 0; n < document.nodes.size(); ++n) {
        const PnmlNode& node = document.nodes[n];
        if (node.is_place()) {
            out.ids.add_place(node.id, {net::PlaceIndex{index_of(n)}});
        } else {
            out.ids.add_transition(node.id, {net::TransitionIndex{index_of(n)}});
        }
    }
    out.ids.sort();
    for (const PnmlArc& arc : document.arcs) {
        const net::TransitionIndex t{index_of(arc.transition)};
        net::TransitionDraft& transition = out.draft.transitions[t.value];
        const net::PlaceIndex place{index_of(arc.place)};
        const std::int64_t weight =
            label_count(document, child(arc.xml, "inscription"), 1, 1, "arc " + arc.id, defects);
        ArcLook look{.transition = t,
                     .is_output = arc.is_output,
                     .id = arc.id,
                     .source = arc.source,
                     .target = arc.target,
                     .look = look_of(arc.xml, arc.page, arc.order, "inscription")};
        if (arc.is_output) {
            look.number = static_cast<std::uint32_t>(transition.outputs.size());
            transition.outputs.push_back(
                {.place = place, .weight = weight, .where = document.text.where(arc.xml)});
        } else {
            look.number = static_cast<std::uint32_t>(transition.inputs.size());
            transition.inputs.push_back({.kind = arc_kind(arc.type),
                                         .place = place,
                                         .weight = weight,
                                         .where = document.text.where(arc.xml)});
        }
        out.look.arcs.push_back(std::move(look));
    }
    join_parallel_tests(out, defects);
}

}  // namespace

Checked<NetFile> read_pnml(std::string_view text, const std::string& path,
                           const NetLimits& limits) {
    Defects defects;
    PnmlDocument document;
    NetFile out;
    out.format = NetFormat::kPnml;
    out.draft.sources_on_beats = true;
    if (read_pnml_document(text, path, limits, document, defects)) {
        out.draft.name = document.name.empty() ? document.id : document.name;
        if (document.nodes.size() + document.arcs.size() > limits.elements) {
            defects.error("net-too-large", {path, 0, 0, 1}, "",
                          "more than " + std::to_string(limits.elements) + " elements",
                          "split the model, or ask for more");
        } else {
            fill_look(document, out.look);
            if (document.type == PnmlType::kColoured) {
                build_symmetric(document, limits, out, defects);
            } else {
                build_plain(document, out, defects);
            }
        }
    }
    if (defects.any()) {
        return Unexpected(defects.take());
    }
    out.notes = defects.take();
    return out;
}

}  // namespace puppetri::io
