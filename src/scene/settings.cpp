// SPDX-License-Identifier: MIT
// Where a setting's value stands in the text.
#include "puppetri/scene/settings.h"

#include <algorithm>
#include <vector>

#include "puppetri/lang/edit.h"
#include "puppetri/lang/parse.h"

namespace puppetri::scene {
namespace {

using lang::Edit;
using lang::Span;

// `insert` at the end of a node.
Edit behind(Span node, std::string text) {
    return {{node.end, node.end, node.file}, std::move(text)};
}

class Setter {
 public:
    Setter(const lang::File& file, const Setting& setting) : file_(file), setting_(setting) {
        const std::size_t dot = setting.path.rfind('.');
        owner_ = setting.path.substr(0, dot == std::string::npos ? 0 : dot);
        name_ = setting.path.substr(dot == std::string::npos ? 0 : dot + 1);
    }

    // False: there is nothing of that name.
    bool find(std::vector<Edit>& edits) {
        if (owner_.empty()) {
            return seed(edits) || datum(edits);
        }
        for (const lang::Use& use : file_.body.uses) {
            const std::string name = use.name.text.empty() ? lang::to_text(use.net) : use.name.text;
            if (name == owner_) {
                argument(use, edits);
                return true;
            }
        }
        for (const lang::Place& place : file_.body.places) {
            if (place.name.text == owner_) {
                return of_place(place, edits);
            }
        }
        return false;
    }

    std::string could_be() const {
        std::string list;
        const auto add = [&list](const std::string& what) {
            list += (list.empty() ? "" : ", ") + what;
        };
        for (const lang::Use& use : file_.body.uses) {
            const std::string instance =
                use.name.text.empty() ? lang::to_text(use.net) : use.name.text;
            const lang::Net* net = net_of(use);
            for (const lang::Parameter& p :
                 net != nullptr ? net->parameters : std::vector<lang::Parameter>{}) {
                add(instance + "." + p.name.text);
            }
        }
        for (const lang::Data& d : file_.body.data) {
            add(d.name.text);
        }
        for (const lang::Place& p : file_.body.places) {
            add(p.name.text + ".takes");
        }
        add("seed");
        return list;
    }

 private:
    bool seed(std::vector<Edit>& edits) {
        if (name_ != "seed" || !file_.header.seed) {
            return false;
        }
        edits.push_back(lang::replace(file_.header.seed.span, setting_.value));
        return true;
    }

    bool datum(std::vector<Edit>& edits) {
        for (const lang::Data& d : file_.body.data) {
            if (d.name.text == name_) {
                edits.push_back(d.initial ? lang::replace(d.initial.span, setting_.value)
                                          : behind(d.type.span, " = " + setting_.value));
                return true;
            }
        }
        return false;
    }

    bool of_place(const lang::Place& place, std::vector<Edit>& edits) {
        if (name_ == "takes") {
            edits.push_back(place.takes.kind == lang::DurationKind::kDefault
                                ? lang::add_clause(file_, place.span, "takes " + setting_.value)
                                : lang::replace(place.takes.span, "takes " + setting_.value));
            return true;
        }
        if (name_ == "tokens" && place.tokens.size() <= 1) {
            edits.push_back(place.tokens.empty()
                                ? lang::add_clause(file_, place.span, "tokens " + setting_.value)
                                : lang::replace(place.tokens[0].count.span, setting_.value));
            return true;
        }
        return false;
    }

    // Of a net of the same file; null: it is imported.
    const lang::Net* net_of(const lang::Use& use) const {
        for (const lang::Net& net : file_.body.nets) {
            if (net.name.text == lang::to_text(use.net)) {
                return &net;
            }
        }
        return nullptr;
    }

    void argument(const lang::Use& use, std::vector<Edit>& edits) {
        for (const lang::Argument& a : use.args) {
            if (a.name.text == name_) {
                edits.push_back(lang::replace(a.value.span, setting_.value));
                return;
            }
        }
        if (const lang::Net* net = net_of(use)) {
            for (std::size_t i = 0; i < std::min(net->parameters.size(), use.args.size()); ++i) {
                if (net->parameters[i].name.text == name_ && use.args[i].name.text.empty()) {
                    edits.push_back(lang::replace(use.args[i].value.span, setting_.value));
                    return;
                }
            }
        }
        const std::string named = name_ + ": " + setting_.value;
        if (!use.args.empty()) {
            edits.push_back(behind(use.args.back().value.span, ", " + named));
            return;
        }
        // `use shop` or `use shop()`
        const std::size_t open = file_.text.find_first_not_of(" \t", use.net.span.end);
        if (open < use.span.end && file_.text[open] == '(') {
            const auto at = static_cast<std::uint32_t>(open + 1);
            edits.push_back({{at, at, use.span.file}, named});
        } else {
            edits.push_back(behind(use.net.span, "(" + named + ")"));
        }
    }

    const lang::File& file_;
    const Setting& setting_;
    std::string owner_, name_;
};

}  // namespace

Checked<std::string> with_settings(std::string_view text, std::string_view filename,
                                   std::span<const Setting> settings) {
    std::string changed(text);
    Diagnostics wrong;
    // One after another, since two arguments that were not written meet at one place
    for (const Setting& s : settings) {
        lang::Parsed parsed = lang::parse(changed, filename);
        if (has_errors(parsed.diagnostics)) {
            return Unexpected(std::move(parsed.diagnostics));
        }
        std::vector<Edit> edits;
        Setter setter(parsed.file, s);
        if (setter.find(edits)) {
            PUP_TRY(changed, lang::apply(parsed.file, edits));
            continue;
        }
        Diagnostic d;
        d.code = "unknown-setting";
        d.where.file = std::string(filename);
        d.element = s.path;
        d.message = "the scene has nothing of this name that can be set";
        d.remedy = "can be set: " + setter.could_be();
        wrong.push_back(std::move(d));
    }
    if (!wrong.empty()) {
        return Unexpected(std::move(wrong));
    }
    return changed;
}

}  // namespace puppetri::scene
