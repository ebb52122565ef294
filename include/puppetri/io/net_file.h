// SPDX-License-Identifier: MIT
// A net as a foreign file holds it: the draft that means it, the names that the file gives to its
// elements, and what only its drawing or another tool knows, kept to be written back. Readers:
// io/pnml.h, io/pipe.h, io/tina.h, or io/load_net.h for any of them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/net/draft.h"

namespace puppetri::io {

enum class NetFormat : std::uint8_t { kPnml, kPipe, kTina, kLola, kGraphviz, kScene };
// "PNML", "PIPE", "TINA", "LoLA", "Graphviz", "scene".
const char* name_of(NetFormat format);

// How large a file and what it unfolds to may be; beyond that a reader fails with code
// "file-too-large" or "net-too-large".
struct NetLimits {
    std::uint64_t bytes = 100'000'000;    // of the file
    std::uint64_t elements = 5'000'000;   // places, transitions and arcs together, after unfolding
    std::uint64_t bindings = 50'000'000;  // of variables tried while unfolding a coloured net
    std::uint32_t nesting = 200;          // of pages, of terms
};

// The names that a file gives, and what they stand for: one element; several, where a coloured
// node was unfolded; none, where no binding of a coloured transition fits. Reference nodes stand
// for what they refer to.
class NetIds {
 public:
    void add_place(std::string id, std::vector<net::PlaceIndex> places);
    void add_transition(std::string id, std::vector<net::TransitionIndex> transitions);
    // To be called once, after the last add and before the first find.
    void sort();

    // Gives  nullptr if the file has no such place or transition.
    // Cost   O(log n).
    const std::vector<net::PlaceIndex>* find_places(std::string_view id) const;
    const std::vector<net::TransitionIndex>* find_transitions(std::string_view id) const;

 private:
    template <class T>
    using Table = std::vector<std::pair<std::string, std::vector<T>>>;  // sorted by id
    Table<net::PlaceIndex> places_;
    Table<net::TransitionIndex> transitions_;
};

// A point of a drawing, in the file's own units (usually pixels, y downwards).
struct DrawingPoint {
    double x = 0, y = 0;
    bool operator==(const DrawingPoint&) const = default;
};

// What the drawing and other tools know of one element. The XML texts are kept as they were.
struct ElementLook {
    std::uint32_t page = 0;          // in NetLook::pages
    std::uint32_t order = 0;         // among all elements and pages of the file
    std::optional<DrawingPoint> at;  // of the element's middle
    std::string graphics;            // the PNML element <graphics>
    std::string name_graphics;       // the same of the name's label
    std::string value_graphics;      // of the initial marking or the inscription
    std::string tools;               // all <toolspecific> elements, one after another
};

// An arc: of which transition, and which of its inputs or outputs.
struct ArcLook {
    net::TransitionIndex transition;
    bool is_output = false;
    std::uint32_t number = 0;  // in TransitionDraft::inputs or outputs
    std::string id;
    std::string source, target;  // as the arc names them: perhaps reference nodes
    ElementLook look;
};

struct PageLook {
    std::string id, name;
    std::uint32_t parent = 0;  // an earlier page
    std::uint32_t order = 0;
    std::string extra;  // graphics and toolspecific elements
};

// A reference place or transition.
struct ReferenceLook {
    bool is_place = true;
    std::string id, to, name;
    ElementLook look;
};

// Empty, or as long as the draft's lists: who changes the draft empties the look.
struct NetLook {
    std::string id;               // of the net
    std::string extra;            // toolspecific elements of the net itself
    std::vector<PageLook> pages;  // pages[0] stands for the net itself
    std::vector<ElementLook> places, transitions;
    std::vector<ArcLook> arcs;
    std::vector<ReferenceLook> references;
};

struct NetFile {
    NetFormat format = NetFormat::kPnml;
    // Paths are the file's ids, captions its names; of unfolded elements id(colour), "Eat(3)".
    // A file without time gives a paced net; delays of files without units are in seconds.
    net::NetDraft draft;
    NetIds ids;
    NetLook look;
    Diagnostics notes;  // warnings and notes: no errors
};

}  // namespace puppetri::io
