// SPDX-License-Identifier: MIT
#include "line.h"

#include <algorithm>

#include "make.h"

namespace puppetri::notation {

using lang::Expr;
using lang::ExprKind;

void Teller::tell(Severity severity, std::string code, lang::Span where, std::string message,
                  std::string remedy) {
    out_.diagnostics.push_back({severity, std::move(code), file_.where(where), element_,
                                std::move(message), std::move(remedy)});
}

std::string_view word_of(const Expr& e) {
    return e.kind == ExprKind::kPath && e.path.steps.size() == 1 && e.path.steps[0].index.empty()
               ? std::string_view(e.path.steps[0].text)
               : std::string_view();
}

bool paths_of(const Expr& e, lang::Op joined_by, std::vector<lang::Path>& out) {
    if (e.kind == ExprKind::kPath) {
        out.push_back(e.path);
        return true;
    }
    return e.kind == ExprKind::kBinary && e.op == joined_by &&
           std::all_of(e.args.begin(), e.args.end(),
                       [&](const lang::Argument& a) { return paths_of(a.value, joined_by, out); });
}

Labelled read_labelled(const lang::Property& property) {
    Labelled out;
    out.property = &property;
    out.word = property.name.steps[0].text;
    const std::vector<Expr>& values = property.values;
    std::size_t i = 0;
    lang::Caption caption;
    if (i < values.size() && values[i].kind == ExprKind::kString) {
        caption = {values[i].text, values[i].span};
        ++i;
    }
    if (i < values.size() && values[i].kind == ExprKind::kSymbol && values[i].text == ":") {
        out.label = std::move(out.word);
        out.caption = std::move(caption);
        out.word.clear();
        if (++i < values.size() && !word_of(values[i]).empty()) {
            out.word = word_of(values[i++]);
        }
        out.first = i;
    }
    return out;
}

bool has_arrow(const lang::Property& property) {
    return !property.values.empty() && property.values[0].kind == ExprKind::kSymbol &&
           property.values[0].text == "->";
}

bool Line::word(std::string_view text) {
    const Expr* e = next();
    if (e == nullptr || e->kind != ExprKind::kPath || e->path.steps.size() != 1 ||
        e->path.steps[0].text != text || !e->path.steps[0].index.empty()) {
        return false;
    }
    ++at_;
    return true;
}

bool Line::symbol(std::string_view text) {
    const Expr* e = next();
    if (e == nullptr || e->kind != ExprKind::kSymbol || e->text != text) {
        return false;
    }
    ++at_;
    return true;
}

lang::Caption Line::caption() {
    const Expr* e = next();
    if (e == nullptr || e->kind != ExprKind::kString) {
        return {};
    }
    ++at_;
    return {e->text, e->span};
}

void Line::missing(std::string_view wanted) {
    const Expr* e = next();
    teller_.error(
        "syntax", e != nullptr ? e->span : property_.span,
        std::string(wanted) + " is wanted " + (e != nullptr ? "here" : "at the end of this line"),
        "write " + std::string(wanted));
}

const Expr* Line::value(std::string_view wanted) {
    const Expr* e = next();
    if (e == nullptr || e->kind == ExprKind::kSymbol) {
        missing(wanted);
        return nullptr;
    }
    ++at_;
    return e;
}

bool Line::clause(std::string_view text, std::string_view wanted, Expr& to) {
    if (!word(text)) {
        return false;
    }
    if (const Expr* e = value(wanted)) {
        to = *e;
    }
    return true;
}

bool Line::takes(lang::Duration& to) {
    Expr time;
    const bool there = clause("takes", "a time", time);
    if (time) {
        to = make_duration(time);
    }
    return there;
}

const lang::Path* Line::path(std::string_view wanted) {
    const Expr* e = next();
    if (e == nullptr || e->kind != ExprKind::kPath) {
        missing(wanted);
        return nullptr;
    }
    ++at_;
    return &e->path;
}

void Line::finish(std::string_view forms) {
    if (const Expr* e = next(); e != nullptr) {
        teller_.error("syntax", e->span, "this is no part of such a line",
                      "write " + std::string(forms));
        at_ = property_.values.size();
    }
}

bool read_data(Line& line, lang::Data& made) {
    const lang::Path* name = line.path("the name of a datum");
    if (name == nullptr) {
        return false;
    }
    line.symbol(":");
    const Expr* type = line.value("the type of the datum");
    if (type == nullptr) {
        return false;
    }
    made.name = name->steps[0];
    made.is_public = true;
    made.span = line.span();
    made.type = *type;
    if (type->kind == ExprKind::kBinary && type->op == lang::Op::kEqual) {
        made.type = type->args[0].value;  // TYPE = VALUE has been read as a comparison
        made.initial = type->args[1].value;
    } else if (line.symbol("=")) {
        if (const Expr* e = line.value("its value at the beginning")) {
            made.initial = *e;
        }
    }
    line.finish("data NAME: TYPE = VALUE");
    return true;
}

bool has_plain_lines(const lang::Block& block, Teller& teller) {
    bool plain = true;
    for (const lang::Property& p : block.properties) {
        if (p.name.steps.size() != 1 || !p.name.steps[0].index.empty()) {
            teller.error("syntax", p.name.span, "a line begins with one name, without an index",
                         "write names such as left_leg, or 'left leg' in quotes");
            plain = false;
        }
        if (p.has_children) {
            teller.error("syntax", p.span, "this line has lines of its own", "remove the braces");
            plain = false;
        }
    }
    return plain;
}

}  // namespace puppetri::notation
