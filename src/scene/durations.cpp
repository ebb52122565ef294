// SPDX-License-Identifier: MIT
// How long: constants, expressions, intervals and distributions, of places (`takes`) and of
// transitions (`after`, `for`).
#include "elaboration.h"
#include "puppetri/lang/signature.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {
namespace {

struct DistributionSignature {
    const char* name;
    DistributionKind kind;
    const char* parameters[4];  // null: no more
    int required;
};

constexpr DistributionSignature kDistributions[] = {
    {"uniform", DistributionKind::kUniform, {"low", "high"}, 2},
    {"normal", DistributionKind::kNormal, {"mean", "deviation", "low", "high"}, 2},
    {"exponential", DistributionKind::kExponential, {"mean"}, 1},
    {"triangular", DistributionKind::kTriangular, {"low", "mode", "high"}, 3},
    {"erlang", DistributionKind::kErlang, {"shape", "mean"}, 2},
    {"gamma", DistributionKind::kGamma, {"shape", "mean"}, 2},
    {"empirical", DistributionKind::kEmpirical, {}, 0},
    {"discrete", DistributionKind::kDiscrete, {}, 0},
};

const DistributionSignature* find_distribution(const lang::Expr& e) {
    if (e.kind != lang::ExprKind::kCall || e.path.steps.size() != 1) {
        return nullptr;
    }
    for (const DistributionSignature& d : kDistributions) {
        if (e.path.steps[0].text == d.name) {
            return &d;
        }
    }
    return nullptr;
}

bool constant_distribution(const lang::Expr& e) {
    return e.kind == lang::ExprKind::kCall && e.path.steps.size() == 1 &&
           e.path.steps[0].text == "constant" && e.args.size() == 1;
}

}  // namespace

net::DurationDraft Elaboration::duration_of(const lang::Expr& e, const Scope& scope) {
    constexpr ValueType kTime{ValueKind::kTime};
    net::DurationDraft out;
    out.where = at(e.span);
    if (constant_distribution(e)) {
        return duration_of(e.args[0].value, scope);
    }
    if (find_distribution(e) != nullptr) {
        return distribution_of(e, scope);
    }
    if (e.kind == lang::ExprKind::kRange) {
        const auto a = expr_of(e.args[0].value, scope, kTime);
        const auto b = expr_of(e.args[1].value, scope, kTime);
        if (a && b) {
            out.kind = net::DurationKind::kInterval;
            out.a = *a;
            out.b = *b;
        }
        return out;
    }
    if (e.kind == lang::ExprKind::kCall) {
        std::vector<std::string> known = {"constant"};
        for (const DistributionSignature& d : kDistributions) {
            known.emplace_back(d.name);
        }
        bool function = false;
        for (const char* name : {"abs", "min", "max"}) {
            function = function || (e.path.steps.size() == 1 && e.path.steps[0].text == name);
        }
        if (!function) {
            unknown(e.path.span, "distribution", lang::to_text(e.path), known);
            return out;
        }
    }
    if (auto a = expr_of(e, scope, kTime)) {
        out.kind = a->is_literal() ? net::DurationKind::kConstant : net::DurationKind::kExpression;
        out.a = std::move(*a);
    }
    return out;
}

net::DurationDraft Elaboration::distribution_of(const lang::Expr& e, const Scope& scope) {
    constexpr ValueType kTime{ValueKind::kTime};
    const DistributionSignature& d = *find_distribution(e);
    net::DurationDraft out;
    out.kind = net::DurationKind::kDistribution;
    out.distribution = d.kind;
    out.where = at(e.span);
    if (d.kind == DistributionKind::kEmpirical || d.kind == DistributionKind::kDiscrete) {
        return sample_distribution(e, scope, std::move(out));
    }
    lang::Signature wanted{.name = d.name, .parameters = {}};
    for (int i = 0; i < 4 && d.parameters[i] != nullptr; ++i) {
        wanted.parameters.push_back(
            {.name = d.parameters[i], .required = i < d.required, .wanted = {}});
    }
    const lang::MatchedArguments matched = lang::match_arguments(wanted, e.args, e.span);
    for (const lang::CallDefect& defect : matched.defects) {
        error(defect.code, defect.where, defect.message, defect.remedy);
    }
    if (!matched.defects.empty()) {
        return {.where = out.where};
    }
    for (std::size_t i = 0; i < matched.values.size(); ++i) {
        if (matched.values[i] == nullptr) {
            if (i == 3 && matched.values[2] != nullptr) {
                error("missing-argument", e.span,
                      std::string(d.name) + " with a low end needs its high", "write high: ...");
                return {.where = out.where};
            }
            break;
        }
        const bool shape = std::string_view(d.parameters[i]) == "shape";
        const ValueType type = !shape                                ? kTime
                               : d.kind == DistributionKind::kErlang ? ValueType{ValueKind::kInt}
                                                                     : ValueType{ValueKind::kReal};
        const bool before = std::exchange(reading_distribution_, true);
        auto value = expr_of(*matched.values[i], scope, type);
        reading_distribution_ = before;
        if (!value) {
            return {.where = out.where};
        }
        out.parameters.push_back(std::move(*value));
    }
    return out;
}

// empirical(1 s, 1.5 s, 2 s) or empirical([1, 1.5, 2] s); discrete((1 s, 0.3), (2 s, 0.7)) or
// discrete([1, 2] s, [0.3, 0.7]).
net::DurationDraft Elaboration::sample_distribution(const lang::Expr& e, const Scope& scope,
                                                    net::DurationDraft out) {
    constexpr ValueType kTime{ValueKind::kTime};
    const net::DurationDraft nothing{.where = out.where};
    std::vector<Expr> times, weights;
    bool good = true;
    const auto take = [&](const lang::Expr& value, const lang::Expr& list, ValueType type,
                          std::vector<Expr>& into) {
        lang::Expr with_unit = value;
        if (!list.unit.empty() && value.kind == lang::ExprKind::kNumber && value.unit.empty()) {
            with_unit.unit = list.unit;
            with_unit.unit_span = list.unit_span;
        }
        auto x = expr_of(with_unit, scope, type);
        good = good && x.has_value();
        if (x) {
            into.push_back(std::move(*x));
        }
    };
    const bool discrete = out.distribution == DistributionKind::kDiscrete;
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        const lang::Expr& a = e.args[i].value;
        if (a.kind == lang::ExprKind::kList) {
            const bool is_weights = discrete && i == 1;
            for (const lang::Argument& item : a.args) {
                take(item.value, a, is_weights ? ValueType{ValueKind::kReal} : kTime,
                     is_weights ? weights : times);
            }
        } else if (discrete && a.kind == lang::ExprKind::kTuple && a.args.size() == 2) {
            take(a.args[0].value, a, kTime, times);
            take(a.args[1].value, a, {ValueKind::kReal}, weights);
        } else if (discrete && i % 2 == 1 && e.args[0].value.kind != lang::ExprKind::kTuple) {
            take(a, e, {ValueKind::kReal}, weights);
        } else {
            take(a, e, kTime, times);
        }
    }
    if (!good) {
        return nothing;
    }
    if (times.empty() || (discrete && weights.size() != times.size())) {
        error("missing-argument", e.span,
              discrete ? "discrete needs as many weights as values"
                       : "empirical needs at least one value",
              discrete ? "write pairs: discrete((1 s, 0.3), (2 s, 0.7))"
                       : "write empirical(1 s, 1.5 s, 2 s)");
        return nothing;
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
        out.parameters.push_back(std::move(times[i]));
        if (discrete) {
            out.parameters.push_back(std::move(weights[i]));
        }
    }
    return out;
}

}  // namespace puppetri::scene
