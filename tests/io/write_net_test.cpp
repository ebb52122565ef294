// SPDX-License-Identifier: MIT
// Out and in again: equal drafts; and what a format cannot say is refused.
#include "puppetri/io/write_net.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "io/net_files.h"
#include "puppetri/io/load_net.h"
#include "puppetri/io/pipe.h"
#include "puppetri/io/pnml.h"
#include "puppetri/io/tina.h"
#include "puppetri/net/net.h"
#include "puppetri/scene/scene.h"
#include "shared_nets.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;

namespace {

NetFile corpus(const std::string& name) {
    for (const auto& [file, text] : net_corpus()) {
        if (file == name) {
            const Checked<NetFile> read = read_net(text, file);
            if (!read) {
                FAIL(read.error()[0].message);
            }
            return *read;
        }
    }
    FAIL("no such file: " << name);
    return {};
}

std::string written(const NetFile& file, NetFormat format, bool lossy = false) {
    const Checked<WrittenNet> out = write_net(file, format, {.lossy = lossy});
    if (!out) {
        FAIL(out.error()[0].element << " " << out.error()[0].message);
    }
    return out->text;
}

NetFile read_again(const std::string& text, NetFormat format) {
    const Checked<NetFile> file = format == NetFormat::kPnml   ? read_pnml(text, "again.pnml")
                                  : format == NetFormat::kPipe ? read_pipe(text, "again.xml")
                                                               : read_tina(text, "again.net");
    if (!file) {
        FAIL(file.error()[0].message << "\n" << text);
    }
    return *file;
}

std::vector<std::string> refused(const NetFile& file, NetFormat format) {
    const Checked<WrittenNet> out = write_net(file, format);
    std::vector<std::string> elements;
    if (!out) {
        for (const Diagnostic& d : out.error()) {
            CHECK(d.code == "not-in-format");
            elements.push_back(d.element);
        }
    }
    return elements;
}

}  // namespace

TEST_CASE("PNML, PIPE and TINA: in, out and in again is the same net [law]") {
    const auto same = [](const std::string& name, NetFormat format) {
        CAPTURE(name);
        const NetFile first = corpus(name);
        const std::string text = written(first, format);
        const NetFile second = read_again(text, format);
        CHECK(draft_text(second.draft) == draft_text(first.draft));
        // And what is written of it is written again, byte for byte.
        CHECK(written(second, format) == text);
    };
    same("pages.pnml", NetFormat::kPnml);
    same("readers.xml", NetFormat::kPipe);
    same("timed.net", NetFormat::kTina);
    same("untimed.net", NetFormat::kTina);
}

TEST_CASE("pages, references, labels and other tools' elements are written back [unit]") {
    const std::string text = written(corpus("pages.pnml"), NetFormat::kPnml);
    for (const char* kept :
         {"<page id=\"outer\">", "<page id=\"inner\">", "<name><text>outside</text></name>",
          "<referencePlace id=\"r1\" ref=\"r2\">", "<referenceTransition id=\"rt\" ref=\"begin\">",
          "<position x=\"210\" y=\"150\"/>", "<dimension x=\"20\" y=\"20\"/>",
          "<offset x=\"-5\" y=\"35\"/>", "<colour r=\"3\">red</colour>", "tool=\"nupn\"", "<grid/>",
          "source=\"r1\" target=\"begin\"",
          "<arc id=\"a7\" source=\"blocked\" target=\"rt\" "
          "type=\"reset\"",
          "<initialMarking><graphics><offset x=\"1\" y=\"2\"/></graphics><text>3</text>",
          "<text>Pages &amp; references</text>"}) {
        CAPTURE(kept);
        CHECK(text.find(kept) != std::string::npos);
    }
}

TEST_CASE("plain nets go through every format and come back the same [law]") {
    for (const std::string& path : shared_nets("mcc", "model.pnml")) {
        CAPTURE(path);
        NetFile file = *load_net(path);
        CHECK(draft_text(read_again(written(file, NetFormat::kPnml), NetFormat::kPnml).draft) ==
              draft_text(file.draft));
        const NetFile tina = read_again(written(file, NetFormat::kTina), NetFormat::kTina);
        CHECK(draft_text(tina.draft) == draft_text(file.draft));
        // PIPE names everything: a name that is the id is none.
        const NetFile pipe = read_again(written(file, NetFormat::kPipe), NetFormat::kPipe);
        net::NetDraft expected = file.draft;
        for (net::PlaceDraft& p : expected.places) {
            p.caption = p.caption == p.path ? "" : p.caption;
        }
        for (net::TransitionDraft& t : expected.transitions) {
            t.caption = t.caption == t.path ? "" : t.caption;
        }
        CHECK(draft_text(pipe.draft) == draft_text(expected));
    }
    for (const std::string& path : shared_nets("inhibitor", "model.pnml")) {
        CAPTURE(path);
        const NetFile file = *load_net(path);
        const NetFile tina = read_again(written(file, NetFormat::kTina), NetFormat::kTina);
        CHECK(draft_text(tina.draft) == draft_text(file.draft));
    }
    for (const std::string& path : shared_nets("pipe", "")) {
        CAPTURE(path);
        const NetFile file = *load_net(path);
        const NetFile again = read_again(written(file, NetFormat::kPipe), NetFormat::kPipe);
        net::NetDraft expected = file.draft;
        for (net::PlaceDraft& p : expected.places) {
            p.caption = p.caption == p.path ? "" : p.caption;
        }
        for (net::TransitionDraft& t : expected.transitions) {
            t.caption = t.caption == t.path ? "" : t.caption;
        }
        CHECK(draft_text(again.draft) == draft_text(expected));
    }
}

TEST_CASE("what a format cannot say is refused, element by element [unit]") {
    using Names = std::vector<std::string>;
    const NetFile pages = corpus("pages.pnml");
    CHECK(refused(pages, NetFormat::kTina) == Names{"transition begin"});  // the reset
    CHECK(refused(pages, NetFormat::kPipe) == Names{"transition begin"});
    CHECK(refused(pages, NetFormat::kLola) == Names{"transition begin", "transition end"});
    CHECK(refused(pages, NetFormat::kGraphviz).empty());
    CHECK(refused(pages, NetFormat::kScene).empty());
    const NetFile gspn = corpus("readers.xml");
    CHECK(refused(gspn, NetFormat::kPnml) == Names{"place ready to go", "transition T0",
                                                   "transition T0", "transition T1",
                                                   "transition T2"});
    CHECK(refused(corpus("timed.net"), NetFormat::kPipe).size() >= 4);
    CHECK(refused(corpus("timed.net"), NetFormat::kScene) ==
          Names{"transition t2", "transition t5"});
    CHECK(refused(corpus("untimed.net"), NetFormat::kScene).size() >= 1);  // the source
}

TEST_CASE("lossy drops what a format cannot say, and tells each kind [unit]") {
    const NetFile gspn = corpus("readers.xml");
    const Checked<WrittenNet> out = write_net(gspn, NetFormat::kPnml, {.lossy = true});
    REQUIRE(out.has_value());
    std::size_t kinds = 0;
    for (const Diagnostic& d : out->notes) {
        kinds += d.code == "dropped" ? 1 : 0;
    }
    CHECK(kinds == 5);  // delays, servers, odds, a capacity, a state
    const NetFile again = read_again(out->text, NetFormat::kPnml);
    CHECK(again.draft.places.size() == gspn.draft.places.size());
    CHECK(net::compile(again.draft)->paced());
}

TEST_CASE("a net that was written as a scene is the same net [law]") {
    const auto check_scene = [](const NetFile& file) {
        scene::MemoryFiles files;
        files.add("net.pup", written(file, NetFormat::kScene));
        const Checked<scene::Scene> loaded = scene::load(files, "net.pup");
        if (!loaded) {
            FAIL(loaded.error()[0].message << "\n" << written(file, NetFormat::kScene));
        }
        const Checked<net::Net> net = net::compile(file.draft);
        REQUIRE(net.has_value());
        REQUIRE(loaded->net.place_count() == net->place_count());
        REQUIRE(loaded->net.transition_count() == net->transition_count());
        for (std::uint32_t i = 0; i < net->transition_count(); ++i) {
            const net::TransitionDraft& t = file.draft.transitions[i];
            const net::TransitionIndex other = loaded->net.find_transition(t.path);
            REQUIRE(other.valid());
            const net::TransitionDraft& u = loaded->draft.transitions[other.value];
            CHECK(u.inputs.size() == t.inputs.size());
            CHECK(u.outputs.size() == t.outputs.size());
            CHECK(u.priority == t.priority);
            CHECK(u.delay.has_value() == t.delay.has_value());
            for (const net::ArcDraft& a : t.inputs) {
                const net::PlaceIndex p =
                    loaded->net.find_place(file.draft.places[a.place.value].path);
                const bool found =
                    std::any_of(u.inputs.begin(), u.inputs.end(), [&](const net::ArcDraft& b) {
                        return b.place == p && b.kind == a.kind && b.weight == a.weight;
                    });
                CHECK(found);
            }
        }
        for (const net::PlaceDraft& p : file.draft.places) {
            const net::PlaceDraft& q = loaded->draft.places[loaded->net.find_place(p.path).value];
            CHECK(q.capacity == p.capacity);
            CHECK(q.tokens.size() == p.tokens.size());
        }
    };
    check_scene(corpus("pages.pnml"));
    check_scene(corpus("readers.xml"));
    for (const std::string& path : shared_nets("inhibitor", "model.pnml")) {
        CAPTURE(path);
        const NetFile file = *load_net(path);
        if (refused(file, NetFormat::kScene).empty()) {
            check_scene(file);
        }
    }
}

TEST_CASE("LoLA gets read arcs as loops, and names that it can read [unit]") {
    const NetFile file =
        *read_tina("pl {a b} (2)\npl {a,b}\ntr t {a b}?3 {a b} -> {a,b}*2\n", "n.net");
    CHECK(written(file, NetFormat::kLola) ==
          "PLACE a_b,\n  a_b_2;\n\nMARKING a_b: 2;\n\nTRANSITION t\nCONSUME a_b: 3;\n"
          "PRODUCE a_b: 2, a_b_2: 2;\n");
}

TEST_CASE("Graphviz gets a node per element and an edge per arc [unit]") {
    const NetFile file = corpus("pages.pnml");
    const std::string text = written(file, NetFormat::kGraphviz);
    CHECK(occurrences(text, "shape=circle") == 3);
    CHECK(occurrences(text, "shape=box") == 2);
    CHECK(occurrences(text, " -> ") == 8);
    CHECK(occurrences(text, "arrowhead=odot") == 2);
    CHECK(occurrences(text, "arrowhead=none") == 1);
}

TEST_CASE("formats are known by ending and by name [unit]") {
    CHECK(written_format_of("a/b.PNML") == NetFormat::kPnml);
    CHECK(written_format_of("a.b/c") == std::nullopt);
    CHECK(written_format_of("x.gv") == NetFormat::kGraphviz);
    CHECK(written_format_named("Tina") == NetFormat::kTina);
    CHECK(written_format_named("word") == std::nullopt);
}
