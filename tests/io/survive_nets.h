// SPDX-License-Identifier: MIT
// What must hold for any bytes whatever that are given to the readers of nets and queries: the
// tests of hostile files and the fuzzers ask the same.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

#include "io/net_files.h"
#include "puppetri/io/contest_queries.h"
#include "puppetri/io/pipe.h"
#include "puppetri/io/pnml.h"
#include "puppetri/io/tina.h"
#include "puppetri/io/write_net.h"
#include "puppetri/lang/parse.h"
#include "puppetri/net/net.h"

namespace puppetri::io::testing {

// Small enough that a bomb is refused in no time.
inline NetLimits hostile_limits() {
    NetLimits limits;
    limits.elements = 20'000;
    limits.bindings = 20'000;
    return limits;
}

inline std::string broken_diagnostics(const Diagnostics& list, std::string_view text) {
    const auto lines = static_cast<std::uint32_t>(1 + std::count(text.begin(), text.end(), '\n'));
    for (const Diagnostic& d : list) {
        if (d.message.empty() || d.code.empty() || d.remedy.empty()) {
            return "a diagnostic says what is wrong and what to do";
        }
        if (d.where.length < 1 || d.where.line > lines || d.where.file.empty()) {
            return "a diagnostic points into the file";
        }
    }
    return has_errors(list) ? "" : "who fails says why";
}

inline Checked<NetFile> read_as(NetFormat format, std::string_view text) {
    return format == NetFormat::kPnml   ? read_pnml(text, "hostile", hostile_limits())
           : format == NetFormat::kPipe ? read_pipe(text, "hostile", hostile_limits())
                                        : read_tina(text, "hostile", hostile_limits());
}

// Empty when all is well, otherwise the law that the text broke.
inline std::string broken_net_law(NetFormat format, std::string_view text) {
    const Checked<NetFile> file = read_as(format, text);
    if (!file) {
        return broken_diagnostics(file.error(), text);
    }
    // Compiled or refused: never a crash. What compiles is written and read again.
    const Checked<net::Net> net = net::compile(file->draft);
    if (!net) {
        return has_errors(net.error()) ? "" : "who fails says why";
    }
    if (const Checked<WrittenNet> written = write_net(*file, format)) {
        const Checked<NetFile> again = read_as(format, written->text);
        if (!again) {
            return "what is written is read: " + again.error()[0].message;
        }
        if (draft_text(again->draft) != draft_text(file->draft)) {
            return "what is written says the same";
        }
    }
    if (const Checked<WrittenNet> scene = write_net(*file, NetFormat::kScene)) {
        if (has_errors(lang::parse(scene->text, "net.pup").diagnostics)) {
            return "a scene that is written can be parsed";
        }
    }
    for (const NetFormat other : {NetFormat::kLola, NetFormat::kGraphviz}) {
        if (!write_net(*file, other, {.lossy = true})) {
            return "whatever is lossy can be written";
        }
    }
    return {};
}

inline std::string broken_query_law(const NetFile& net, std::string_view text) {
    const Checked<ContestQueries> queries =
        read_contest_queries(text, "hostile", net, hostile_limits());
    if (!queries) {
        return broken_diagnostics(queries.error(), text);
    }
    for (const verdict::ContestQuery& q : queries->queries) {
        for (std::size_t i = 0; i < q.formula.nodes.size(); ++i) {
            const net::Formula::Node& n = q.formula.nodes[i];
            if (i > 0 && (n.a >= i || n.b >= i)) {
                return "operands stand before operators";
            }
            if ((n.op == net::FormulaOp::kFireable && n.index >= net.draft.transitions.size()) ||
                (n.op == net::FormulaOp::kExpr && n.index >= q.formula.expressions.size())) {
                return "atoms speak of what is there";
            }
        }
    }
    return {};
}

inline NetFormat format_of(std::string_view name) {
    const auto ends = [&](std::string_view ending) {
        return name.size() >= ending.size() && name.substr(name.size() - ending.size()) == ending;
    };
    return ends(".pnml") ? NetFormat::kPnml : ends(".xml") ? NetFormat::kPipe : NetFormat::kTina;
}

// What queries.xml asks about.
inline const NetFile& queried_net() {
    static const NetFile net = [] {
        for (const auto& [file, pages] : net_corpus()) {
            if (file == "pages.pnml") {
                return read_pnml(pages, file).value();
            }
        }
        return NetFile();
    }();
    return net;
}

// By the name of a file of the corpus.
inline bool is_read(std::string_view name, std::string_view text) {
    return name == "queries.xml" ? read_contest_queries(text, "hostile", queried_net()).has_value()
                                 : read_as(format_of(name), text).has_value();
}
inline std::string broken_file_law(std::string_view name, std::string_view text) {
    return name == "queries.xml" ? broken_query_law(queried_net(), text)
                                 : broken_net_law(format_of(name), text);
}

}  // namespace puppetri::io::testing
