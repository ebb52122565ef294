// SPDX-License-Identifier: MIT
// Statements of files: header, imports, rules, and the heads of blocks with their properties.
#include "build.h"

namespace puppetri::lang {

Rule Builder::rule(std::uint32_t node) {
    Rule out;
    out.name = name(child(node, NodeKind::kName));
    out.caption = caption(node);
    out.when_settled = child(node, NodeKind::kSettled) != 0;
    out.span = span(node);
    const std::uint32_t form = child(node, NodeKind::kForm);
    for (const std::uint32_t c : children(form)) {
        if (kind(c) == NodeKind::kExpr) {
            out.operands.push_back(expr(c));
        } else if (kind(c) == NodeKind::kArgument) {  // bounded(P, Q, by: k)
            const std::uint32_t label = child(c, NodeKind::kLabel);
            if (label == 0) {
                out.operands.push_back(child_expr(c));
            } else if (text(first(label)) == "by" && !out.bound) {
                out.bound = child_expr(c);
            } else {
                report_.error(span(label), "unknown-argument", "rule " + out.name.text,
                              "'bounded' has one named argument, by", "write bounded(P, by: 3)");
            }
        }
    }
    const auto binary = [&] {
        if (has_token(form, Kind::kOnly)) {
            return RuleKind::kOnlyIf;
        }
        return has_token(form, Kind::kLeads) ? RuleKind::kLeadsTo : RuleKind::kTakesAtMost;
    };
    const bool has_children = nodes_[form].next > form + 1;
    if (has_children && nodes_[form + 1].begin == nodes_[form].begin) {
        out.kind = binary();
    } else {
        switch (first(form).kind) {
            case Kind::kNever:
                out.kind = RuleKind::kNever;
                break;
            case Kind::kAlways:
                out.kind = RuleKind::kAlways;
                break;
            case Kind::kPossible:
                out.kind = RuleKind::kPossible;
                break;
            case Kind::kMutex:
                out.kind = RuleKind::kMutex;
                break;
            case Kind::kExactlyOne:
                out.kind = RuleKind::kExactlyOne;
                break;
            case Kind::kAlternate:
                out.kind = RuleKind::kAlternate;
                break;
            case Kind::kBounded:
                out.kind = RuleKind::kBounded;
                break;
            case Kind::kDeadlockFree:
                out.kind = RuleKind::kDeadlockFree;
                break;
            case Kind::kReversible:
                out.kind = RuleKind::kReversible;
                break;
            case Kind::kEnds:
                out.kind = RuleKind::kEnds;
                break;
            case Kind::kLive:
                out.kind = RuleKind::kLive;
                break;
            case Kind::kQuasiLive:
                out.kind = RuleKind::kQuasiLive;
                break;
            case Kind::kNobodyFreezes:
                out.kind = RuleKind::kNobodyFreezes;
                break;
            case Kind::kCtl:
                out.kind = RuleKind::kCtl;
                break;
            case Kind::kLtl:
                out.kind = RuleKind::kLtl;
                break;
            default:
                out.kind = RuleKind::kAfterNoUntil;
        }
    }
    const bool timed = out.kind == RuleKind::kTakesAtMost ||
                       (out.kind == RuleKind::kLeadsTo && out.operands.size() == 3);
    if (timed) {
        out.bound = std::move(out.operands.back());
        out.operands.pop_back();
    }
    const bool needs_two = out.kind == RuleKind::kMutex || out.kind == RuleKind::kExactlyOne ||
                           out.kind == RuleKind::kAlternate;
    if (needs_two && out.operands.size() < 2) {
        report_.error(span(form), "missing-argument", "rule " + out.name.text,
                      "this rule is about two things or more",
                      "name them all, with commas between");
    }
    return out;
}

Question Builder::question(std::uint32_t node) {
    Question out;
    out.name = name(child(node, NodeKind::kName));
    out.caption = caption(node);
    out.span = span(node);
    const std::uint32_t form = child(node, NodeKind::kForm);
    out.about = child_expr(form);
    out.kind = first(form).kind == Kind::kShortest  ? QuestionKind::kShortestTime
               : first(form).kind == Kind::kLongest ? QuestionKind::kLongestTime
                                                    : QuestionKind::kCycleTime;
    return out;
}

std::vector<Moment> Builder::moments(std::uint32_t node) {
    std::vector<Moment> out;
    for (const std::uint32_t c : children(node)) {
        Moment& moment = out.emplace_back();
        moment.transition = child_path(c);
        moment.span = span(c);
        if (const std::uint32_t key = child(c, NodeKind::kExpr); key != 0) {
            moment.key = expr(key);
        }
    }
    return out;
}

Measure Builder::measure(std::uint32_t node) {
    Measure out;
    out.name = name(child(node, NodeKind::kName));
    out.caption = caption(node);
    out.span = span(node);
    const std::uint32_t form = child(node, NodeKind::kForm);
    out.statistic = name(child(form, NodeKind::kName));
    if (const std::uint32_t percent = child(form, NodeKind::kNumber); percent != 0) {
        number(percent, out.percent);
        out.percent.kind = ExprKind::kNumber;
        out.percent.span = span(percent);
    }
    std::vector<std::vector<Moment>> lists;
    for (const std::uint32_t c : children(form)) {
        if (kind(c) == NodeKind::kPath) {
            out.place = path(c);
            out.seen = Seen::kStay;
        } else if (kind(c) == NodeKind::kMoments) {
            lists.push_back(moments(c));
        }
    }
    if (lists.size() == 2) {
        out.seen = Seen::kPassage;
        out.to = std::move(lists[1]);
    }
    if (!lists.empty()) {
        out.from = std::move(lists[0]);
    }
    if (const std::uint32_t value = child(form, NodeKind::kExpr); value != 0) {
        (out.seen == Seen::kExpr ? out.value : out.above) = expr(value);
    }
    return out;
}

For Builder::loop(std::uint32_t node) {
    For out;
    out.variable = name(child(node, NodeKind::kName));
    out.domain = child_expr(node);
    out.span = span(node);
    return out;
}

Net Builder::net(std::uint32_t node) {
    Net out;
    out.name = name(child(node, NodeKind::kName));
    out.caption = caption(node);
    out.is_machine = first(node).kind == Kind::kMachine;
    out.parameters = parameters(node);
    out.span = span(node);
    return out;
}

Block Builder::block(std::uint32_t node) {
    Block out;
    for (const std::uint32_t c : children(node)) {
        if (kind(c) == NodeKind::kName) {
            (out.kind.text.empty() ? out.kind : out.name) = name(c);
        }
    }
    out.parameters = parameters(node);
    out.span = span(node);
    return out;
}

Property Builder::property(std::uint32_t node) {
    Property out;
    out.name = child_path(node);
    for (const std::uint32_t c : children(node)) {
        if (kind(c) == NodeKind::kExpr) {
            out.values.push_back(expr(c));
        } else if (kind(c) == NodeKind::kSymbol) {
            Expr symbol;
            symbol.kind = ExprKind::kSymbol;
            symbol.text = std::string(text(first(c)));
            symbol.span = span(c);
            out.values.push_back(std::move(symbol));
        }
    }
    out.span = span(node);
    return out;
}

CastMember Builder::member(std::uint32_t node) {
    CastMember out;
    bool named = false;
    for (const std::uint32_t c : children(node)) {
        (named ? out.kind : out.name) = name(c);
        named = true;
    }
    out.span = span(node);
    return out;
}

Expr Builder::formula(std::uint32_t node) { return child_expr(node); }

Import Builder::import(std::uint32_t node) {
    Import out;
    for (const std::uint32_t c : children(node)) {
        if (kind(c) == NodeKind::kName) {
            out.names.push_back(name(c));
        } else {
            out.path = quoted(first(c));
            out.path_span = span(c);
        }
    }
    out.span = span(node);
    return out;
}

void Builder::header_clause(std::uint32_t node, Header& out) {
    const auto keep = [&](Expr& to, Expr value) {
        if (to) {
            report_.error(span(node), "repeated-header", element,
                          "'" + std::string(text(first(node))) + "' is given twice in one file",
                          "keep one of them");
            return;
        }
        to = std::move(value);
    };
    switch (first(node).kind) {
        case Kind::kLanguage: {
            keep(out.language, operand(child(node, NodeKind::kNumber)).expr);
            if (out.language.number != Rational{1}) {
                report_.error(out.language.span, "unsupported-language", element,
                              "this program reads version 1 of the language",
                              "write language 1, or use a newer program");
            }
            break;
        }
        case Kind::kScene:
            if (!out.title.text.empty()) {
                report_.error(span(node), "repeated-header", element, "a file holds one scene",
                              "put the second one into a file of its own");
                return;
            }
            out.title = caption(node);
            out.scene_span = span(node);
            break;
        case Kind::kFrames:
            keep(out.frames_per_second, child_expr(node));
            break;
        case Kind::kUntil:
            keep(out.horizon, child_expr(node));
            out.horizon_kind = token(node, 1).kind == Kind::kFrame &&
                                       nodes_[node + 1].begin > nodes_[node].begin + 1
                                   ? HorizonKind::kFrame
                               : has_token(node, Kind::kFirings) ? HorizonKind::kFirings
                                                                 : HorizonKind::kTime;
            break;
        case Kind::kSeed:
            keep(out.seed, child_expr(node));
            break;
        case Kind::kPace:
            keep(out.pace, child_expr(node));
            break;
        default:
            keep(out.time_unit, child_expr(node));
    }
}

void Builder::header(std::uint32_t node, Header& out) {
    for (const std::uint32_t c : children(node)) {
        header_clause(c, out);
    }
}

}  // namespace puppetri::lang
