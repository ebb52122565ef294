// SPDX-License-Identifier: MIT
#include "puppetri/verdict/obligation.h"

#include <algorithm>
#include <utility>

#include "puppetri/net/tables.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;

void put(std::string& key, std::uint64_t x) {
    for (int i = 0; i < 8; ++i) {
        key.push_back(static_cast<char>(x & 255));
        x >>= 8;
    }
}

// Equal formulas have equal keys.
std::string key_of(const Formula& f) {
    std::string key;
    for (const Formula::Node& n : f.nodes) {
        put(key, static_cast<std::uint64_t>(n.op));
        put(key, (std::uint64_t{n.a} << 32) | n.b);
        put(key, n.index);
        put(key, static_cast<std::uint64_t>(n.count));
    }
    for (const Expr& e : f.expressions) {
        for (const Expr::Node& n : e.nodes()) {
            put(key, static_cast<std::uint64_t>(n.op));
            put(key, (std::uint64_t{n.a} << 32) | n.b);
            put(key, (std::uint64_t{n.c} << 32) | n.type.enumeration);
            put(key, static_cast<std::uint64_t>(n.literal));
            put(key, (std::uint64_t{n.slot.kind} << 32) | n.slot.index);
        }
        put(key, ~std::uint64_t{0});
    }
    return key;
}

// Which nodes speak of firings and occurrences, which of the host.
struct Marks {
    std::vector<std::uint8_t> fires, host;
};
Marks marks_of(const Formula& f) {
    Marks m;
    m.fires.resize(f.nodes.size());
    m.host.resize(f.nodes.size());
    for (std::size_t i = 0; i < f.nodes.size(); ++i) {
        const Formula::Node& n = f.nodes[i];
        m.fires[i] = n.op == FormulaOp::kFires || n.op == FormulaOp::kEvent ? 1 : 0;
        m.host[i] = n.op == FormulaOp::kHost ? 1 : 0;
        const bool unary = n.op == FormulaOp::kNot;
        const bool binary = n.op == FormulaOp::kAnd || n.op == FormulaOp::kOr ||
                            n.op == FormulaOp::kImplies || n.op == FormulaOp::kIff;
        if (unary || binary) {
            m.fires[i] |= m.fires[n.a];
            m.host[i] |= m.host[n.a];
        }
        if (binary) {
            m.fires[i] |= m.fires[n.b];
            m.host[i] |= m.host[n.b];
        }
    }
    return m;
}

// The part of a formula below one node, as a formula of its own.
Formula part_of(const Formula& f, std::uint32_t root) {
    Formula out;
    std::vector<std::uint32_t> to(f.nodes.size(), 0);
    std::vector<std::uint8_t> wanted(f.nodes.size(), 0);
    wanted[root] = 1;
    for (std::uint32_t i = root + 1; i-- > 0;) {
        const Formula::Node& n = f.nodes[i];
        if (wanted[i] == 0) {
            continue;
        }
        if (n.op >= FormulaOp::kNot) {
            wanted[n.a] = 1;
        }
        if (n.op >= FormulaOp::kAnd && n.op <= FormulaOp::kIff) {
            wanted[n.b] = 1;
        }
    }
    for (std::uint32_t i = 0; i <= root; ++i) {
        if (wanted[i] == 0) {
            continue;
        }
        Formula::Node n = f.nodes[i];
        if (n.op >= FormulaOp::kNot) {
            n.a = to[n.a];
        }
        if (n.op >= FormulaOp::kAnd && n.op <= FormulaOp::kIff) {
            n.b = to[n.b];
        }
        if (n.op == FormulaOp::kExpr) {
            out.expressions.push_back(f.expressions[n.index]);
            n.index = static_cast<std::uint32_t>(out.expressions.size() - 1);
        }
        to[i] = static_cast<std::uint32_t>(out.nodes.size());
        out.nodes.push_back(n);
    }
    return out;
}

class Builder {
 public:
    Builder(const Formula& f, const HostLowering* host, Atoms& atoms)
        : f_(f), marks_(marks_of(f)), host_(host), atoms_(atoms) {}

    Operand build() {
        if (f_.nodes.empty()) {
            out_.nodes.push_back({});
            return std::move(out_);
        }
        add(static_cast<std::uint32_t>(f_.nodes.size() - 1));
        return std::move(out_);
    }
    bool about_figures = false;

 private:
    using Node = Operand::Node;
    using Op = Operand::Node::Op;

    std::uint32_t push(const Node& n) {
        out_.nodes.push_back(n);
        return static_cast<std::uint32_t>(out_.nodes.size() - 1);
    }

    std::uint32_t add_state(std::uint32_t i) {
        const Formula part = part_of(f_, i);
        Node n{.op = Op::kAtom};
        if (part.nodes.back().op == FormulaOp::kConstant) {
            return push({.op = Op::kConstant, .value = part.nodes.back().count != 0});
        }
        if (marks_.host[i] == 0) {
            n.may = n.must = atoms_.add(part);
        } else {
            about_figures = true;
            const Lowered lowered =
                host_ != nullptr ? host_->lower(part)
                                 : Lowered{Formula::constant(true), Formula::constant(false)};
            n.may = atoms_.add(lowered.may);
            n.must = atoms_.add(lowered.must);
        }
        return push(n);
    }

    std::uint32_t add(std::uint32_t i) {
        const Formula::Node& n = f_.nodes[i];
        if (marks_.fires[i] == 0) {
            return add_state(i);
        }
        switch (n.op) {
            case FormulaOp::kFires:
                out_.reads_firings = true;
                return push({.op = Op::kFires, .index = n.index});
            case FormulaOp::kEvent:
                out_.reads_firings = true;
                // Graphs leave out what nobody listens to, but for events in their atoms.
                atoms_.add(Formula::event(net::EventIndex{n.index}));
                return push({.op = Op::kEvent, .index = n.index});
            case FormulaOp::kNot: {
                const std::uint32_t a = add(n.a);
                return push({.op = Op::kNot, .a = a});
            }
            case FormulaOp::kImplies: {
                const std::uint32_t a = add(n.a);
                const std::uint32_t not_a = push({.op = Op::kNot, .a = a});
                const std::uint32_t b = add(n.b);
                return push({.op = Op::kOr, .a = not_a, .b = b});
            }
            default: {
                const std::uint32_t a = add(n.a);
                const std::uint32_t b = add(n.b);
                const Op op = n.op == FormulaOp::kAnd  ? Op::kAnd
                              : n.op == FormulaOp::kOr ? Op::kOr
                                                       : Op::kIff;
                return push({.op = op, .a = a, .b = b});
            }
        }
    }

    const Formula& f_;
    const Marks marks_;
    const HostLowering* host_;
    Atoms& atoms_;
    Operand out_;
};

// Some place of the list has more than k tokens.
Formula over_full(const net::Net& net, const net::Rule& rule) {
    Formula any = Formula::constant(false);
    bool first = true;
    const auto add = [&](std::uint32_t place) {
        Formula more = Formula::marked(net::PlaceIndex{place}, rule.count + 1);
        any = first ? std::move(more)
                    : Formula::binary(FormulaOp::kOr, std::move(any), std::move(more));
        first = false;
    };
    if (rule.operands.empty()) {
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            add(p);
        }
    }
    for (const Formula& operand : rule.operands) {
        for (const Formula::Node& n : operand.nodes) {
            if (n.op == FormulaOp::kMarked || n.op == FormulaOp::kReady) {
                add(n.index);
            }
        }
    }
    return any;
}

constexpr std::size_t kTogether = 6;

bool speaks_of_figures(const net::Rule& rule) {
    bool figures = false, steps = false;
    for (const Formula& f : rule.operands) {
        for (const Formula::Node& n : f.nodes) {
            figures = figures || n.op == FormulaOp::kHost;
            steps = steps || n.op == FormulaOp::kFires || n.op == FormulaOp::kEvent;
        }
    }
    return figures && !steps;
}

// At most one, or exactly one, of the operands as a formula.
Formula counted(const net::Rule& rule) {
    const auto both = [](FormulaOp op, Formula a, Formula b) {
        return Formula::binary(op, std::move(a), std::move(b));
    };
    Formula one = Formula::constant(rule.kind == net::RuleKind::kMutex);
    Formula none = Formula::constant(true);
    // From the last to the first: none of these, at most (exactly) one of these.
    for (std::size_t i = rule.operands.size(); i-- > 0;) {
        const Formula not_this = Formula::unary(FormulaOp::kNot, rule.operands[i]);
        one = both(FormulaOp::kOr, both(FormulaOp::kAnd, rule.operands[i], none),
                   both(FormulaOp::kAnd, not_this, std::move(one)));
        none = both(FormulaOp::kAnd, not_this, std::move(none));
    }
    return one;
}

// As many tokens everywhere, and the same data, as at the start.
Formula initial_marking(const net::Net& net) {
    std::vector<std::int64_t> tokens(net.place_count(), 0);
    for (const net::NetTables::Initial& i : net.tables().initial) {
        tokens[i.place] += i.count;
    }
    Formula all = Formula::constant(true);
    bool first = true;
    const auto add = [&](Formula f) {
        all = first ? std::move(f) : Formula::binary(FormulaOp::kAnd, std::move(all), std::move(f));
        first = false;
    };
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (tokens[p] > 0) {
            add(Formula::marked(net::PlaceIndex{p}, tokens[p]));
        }
        add(Formula::unary(FormulaOp::kNot, Formula::marked(net::PlaceIndex{p}, tokens[p] + 1)));
    }
    const std::vector<net::DatumDraft>& data = net.declarations().data;
    for (std::uint32_t d = 0; d < data.size(); ++d) {
        auto same = Expr::binary(ExprOp::kEqual,
                                 Expr::slot(net::slot(net::SlotKind::kDatum, d), data[d].type),
                                 Expr::literal(data[d].type, data[d].initial));
        if (same) {
            add(Formula::expression(std::move(*same)));
        }
    }
    return all;
}

}  // namespace

std::uint32_t Atoms::add(const Formula& formula) {
    std::string key = key_of(formula);
    const auto found = std::find(keys_.begin(), keys_.end(), key);
    if (found != keys_.end()) {
        return static_cast<std::uint32_t>(found - keys_.begin());
    }
    keys_.push_back(std::move(key));
    formulas_.push_back(formula);
    return static_cast<std::uint32_t>(formulas_.size() - 1);
}

Truth Operand::at(const AtomRow& row, std::uint32_t label) const {
    constexpr std::size_t kFew = 32;
    Truth few[kFew];
    std::vector<Truth> many;
    Truth* t = few;
    if (nodes.size() > kFew) {
        many.resize(nodes.size());
        t = many.data();
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        switch (n.op) {
            case Node::Op::kConstant:
                t[i] = Truth::of(n.value);
                break;
            case Node::Op::kAtom:
                t[i] = {row[n.may].may, row[n.must].must};
                break;
            case Node::Op::kFires:
                t[i] = Truth::of(label == n.index);
                break;
            case Node::Op::kEvent:
                t[i] = Truth::of(label != kNoFiring && label == (0x80000000u | n.index));
                break;
            case Node::Op::kNot:
                t[i] = {!t[n.a].must, !t[n.a].may};
                break;
            case Node::Op::kAnd:
                t[i] = {t[n.a].may && t[n.b].may, t[n.a].must && t[n.b].must};
                break;
            case Node::Op::kOr:
                t[i] = {t[n.a].may || t[n.b].may, t[n.a].must || t[n.b].must};
                break;
            case Node::Op::kIff: {
                const Truth a = t[n.a], b = t[n.b];
                t[i] = {(a.may && b.may) || (!a.must && !b.must),
                        (a.must && b.must) || (!a.may && !b.may)};
                break;
            }
        }
    }
    return t[nodes.size() - 1];
}

bool Operand::never() const {
    return nodes.back().op == Node::Op::kConstant && !nodes.back().value;
}

Operand make_operand(const Formula& formula, const HostLowering* host, Atoms& atoms,
                     bool* about_figures) {
    Builder builder(formula, host, atoms);
    Operand operand = builder.build();
    if (about_figures != nullptr) {
        *about_figures = *about_figures || builder.about_figures;
    }
    return operand;
}

Obligation make_obligation(const net::Net& net, const net::Rule& rule, const HostLowering* host,
                           Atoms& atoms) {
    Obligation o;
    o.rule = rule.path;
    o.kind = rule.kind;
    o.within = rule.within;
    o.when_settled = rule.when_settled;
    o.subjects = rule.subjects;
    switch (rule.kind) {
        case net::RuleKind::kBounded:
            if (rule.count != kNoCount) {
                o.operands.push_back(make_operand(over_full(net, rule), host, atoms));
            }
            break;
        case net::RuleKind::kReversible:
            o.operands.push_back(make_operand(initial_marking(net), nullptr, atoms));
            break;
        case net::RuleKind::kFormula:
            o.temporal = proof::taken_apart(rule.operands.front());
            for (const Formula& atom : o.temporal->atoms) {
                o.operands.push_back(make_operand(atom, host, atoms, &o.about_figures));
            }
            break;
        case net::RuleKind::kMutex:
        case net::RuleKind::kExactlyOne:
            // What figures do is told of all operands together: who has the ball is one of them.
            if (rule.operands.size() <= kTogether && speaks_of_figures(rule)) {
                o.kind = net::RuleKind::kAlways;
                o.operands.push_back(make_operand(counted(rule), host, atoms, &o.about_figures));
                break;
            }
            [[fallthrough]];
        default:
            for (const Formula& operand : rule.operands) {
                o.operands.push_back(make_operand(operand, host, atoms, &o.about_figures));
            }
            break;
    }
    if (rule.kind == net::RuleKind::kLive || rule.kind == net::RuleKind::kQuasiLive) {
        for (const net::TransitionIndex t : rule.transitions) {
            o.transitions.push_back(t.value);
        }
        for (std::uint32_t t = 0; rule.transitions.empty() && t < net.transition_count(); ++t) {
            o.transitions.push_back(t);
        }
    }
    return o;
}

bool reads_whole_net(const net::Rule& rule) {
    switch (rule.kind) {
        case net::RuleKind::kEnds:
        case net::RuleKind::kDeadlockFree:
        case net::RuleKind::kReversible:
        case net::RuleKind::kFormula:
            return true;
        case net::RuleKind::kLive:
        case net::RuleKind::kQuasiLive:
            return rule.transitions.empty();
        case net::RuleKind::kBounded:
            return rule.operands.empty();
        default:
            return false;
    }
}

}  // namespace puppetri::verdict
