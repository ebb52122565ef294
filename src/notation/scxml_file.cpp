// SPDX-License-Identifier: MIT
// Statecharts in files of other programs (SCXML).
#include "chart.h"
#include "foreign_formats.h"
#include "make.h"

namespace puppetri::notation {

void read_scxml(lang::Parsed& out, std::uint32_t file) {
    const xml::Document document = xml::parse(out.file.text, file);
    for (const xml::Defect& d : document.defects) {
        out.diagnostics.push_back({.code = d.code,
                                   .where = out.file.where(d.where),
                                   .element = "file " + out.file.filename,
                                   .message = d.message,
                                   .remedy = d.remedy});
    }
    if (!document.defects.empty()) {
        return;
    }
    const chart::Chart chart = chart::read(document.root, out);
    if (has_errors(out.diagnostics)) {
        return;
    }
    const std::string& path = out.file.filename;
    const std::size_t slash = path.find_last_of("/\\");
    std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
    name = name.substr(0, name.find('.'));
    std::vector<lang::Span> vague;
    std::vector<int> never;
    out.file.body.nets.push_back(chart::make_net(chart, name, document.root.span, vague, never));
    for (const int state : never) {
        const chart::State& s = chart.at(state);
        out.diagnostics.push_back({.severity = Severity::kWarning,
                                   .code = "never-entered",
                                   .where = out.file.where(s.span),
                                   .element = "chart",
                                   .message = "no transition leads to " + s.name,
                                   .remedy = "add one, or remove the state"});
    }
    for (const lang::Span span : vague) {
        if (span == document.root.span) {
            out.diagnostics.push_back(
                {.code = "too-large",
                 .where = out.file.where(span),
                 .element = "chart",
                 .message = "too many transitions of different regions leave one another's states, "
                            "or too many histories depend on each other",
                 .remedy = "let regions speak by events, and leave a <parallel> by a transition of "
                           "its own"});
            continue;
        }
        out.diagnostics.push_back(
            {.code = "outside-subset",
             .where = out.file.where(span),
             .element = "chart",
             .message = "what this transition leaves depends on what the history holds, which is "
                        "outside of the SCXML that is read here",
             .remedy = "begin the transition at the state that has the history, or outside of it"});
    }
    // As a scene of its own: the chart alone.
    const lang::Span where = document.root.span;
    out.file.header.title = {chart.name.empty() ? name : chart.name, where};
    out.file.header.scene_span = where;
    lang::Use use;
    use.name = make_name(name, where);
    use.net = make_path(name, where);
    use.span = where;
    out.file.body.uses.push_back(std::move(use));
}

}  // namespace puppetri::notation
