// SPDX-License-Identifier: MIT
// The graph of a PNML file before it means anything: nodes and arcs of all pages in the order of
// the file, references followed, ids resolved, labels checked for being known. Place/transition
// nets (pnml.cpp) and symmetric nets (symmetric_*.cpp) are made from it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "defects.h"
#include "puppetri/io/net_file.h"
#include "xml_text.h"

namespace puppetri::io {

enum class PnmlType : std::uint8_t { kPlain, kColoured };
enum class PnmlArcType : std::uint8_t { kNormal, kInhibitor, kRead, kReset };

struct PnmlNode {
    enum Kind : std::uint8_t { kPlace, kTransition, kReferencePlace, kReferenceTransition };
    Kind kind = kPlace;
    pugi::xml_node xml;
    std::string id, name;
    std::uint32_t page = 0, order = 0;
    std::uint32_t stands_for = 0;  // the node itself, or what a reference leads to
    bool is_place() const { return kind == kPlace || kind == kReferencePlace; }
    bool is_reference() const { return kind == kReferencePlace || kind == kReferenceTransition; }
};

struct PnmlArc {
    pugi::xml_node xml;
    std::string id, source, target;
    std::uint32_t place = 0, transition = 0;  // nodes, references followed
    bool is_output = false;
    PnmlArcType type = PnmlArcType::kNormal;
    std::uint32_t page = 0, order = 0;
};

struct PnmlDocument {
    XmlText text;
    pugi::xml_node net;
    PnmlType type = PnmlType::kPlain;
    std::string id, name;
    std::vector<PnmlNode> nodes;
    std::vector<PnmlArc> arcs;
    std::vector<PageLook> pages;
    std::vector<pugi::xml_node> declarations;  // of colours, in order
};

// Gives  false if nothing can be made of the file; arcs with defects are left out.
bool read_pnml_document(std::string_view text, const std::string& path, const NetLimits& limits,
                        PnmlDocument& out, Defects& defects);

// `<text>`, or the `<value>` of older files, of a label.
std::string label_text(pugi::xml_node label);
// What a label says as a number from `least` on; `otherwise` without label. Tells why not.
std::int64_t label_count(const PnmlDocument& document, pugi::xml_node label, std::int64_t least,
                         std::int64_t otherwise, const std::string& element, Defects& defects);
// The drawing of a node or arc whose value label (initial marking, inscription) has that name.
ElementLook look_of(pugi::xml_node xml, std::uint32_t page, std::uint32_t order,
                    std::string_view value_label);
// Fills pages, references, id and toolspecific elements.
void fill_look(const PnmlDocument& document, NetLook& look);

}  // namespace puppetri::io
