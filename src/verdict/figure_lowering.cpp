// SPDX-License-Identifier: MIT
#include "puppetri/verdict/figure_lowering.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "holders.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/net/tables.h"

namespace puppetri::verdict {
namespace {

using motion::BoundCall;
using motion::Limb;
using motion::LimbSet;
using motion::SubjectKind;
using net::Formula;
using net::FormulaOp;

constexpr double kWalksAbove = 0.5;  // the duty factor above which a foot is always on the ground

bool runs(const BoundCall& call) {
    const motion::ArgumentValue* duty = call.find("duty");
    if (duty == nullptr) {
        return false;
    }
    const double* value = std::get_if<double>(duty);
    return value == nullptr || *value <= kWalksAbove;
}

bool is_one_of(const std::string& name, std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return name == n; });
}

bool is_constant(const Formula& f, bool& value) {
    if (f.nodes.size() != 1 || f.nodes[0].op != FormulaOp::kConstant) {
        return false;
    }
    value = f.nodes[0].count != 0;
    return true;
}

Formula negation(Formula f) {
    bool value = false;
    return is_constant(f, value) ? Formula::constant(!value)
                                 : Formula::unary(FormulaOp::kNot, std::move(f));
}

Formula combine(FormulaOp op, Formula a, Formula b) {
    bool value = false;
    const bool is_or = op == FormulaOp::kOr;
    if (is_constant(a, value)) {
        return value == is_or ? Formula::constant(is_or) : b;
    }
    if (is_constant(b, value)) {
        return value == is_or ? Formula::constant(is_or) : a;
    }
    return Formula::binary(op, std::move(a), std::move(b));
}

// The formula with each host atom replaced by what `values` says of it.
Formula with_values(const Formula& f, const std::map<std::uint32_t, bool>& values) {
    std::vector<Formula> built;
    built.reserve(f.nodes.size());
    for (const Formula::Node& n : f.nodes) {
        switch (n.op) {
            case FormulaOp::kHost:
                built.push_back(Formula::constant(values.at(n.index)));
                break;
            case FormulaOp::kNot:
                built.push_back(negation(built[n.a]));
                break;
            case FormulaOp::kAnd:
            case FormulaOp::kOr:
                built.push_back(combine(n.op, built[n.a], built[n.b]));
                break;
            case FormulaOp::kImplies:
                built.push_back(combine(FormulaOp::kOr, negation(built[n.a]), built[n.b]));
                break;
            case FormulaOp::kIff:
                built.push_back(
                    combine(FormulaOp::kOr, combine(FormulaOp::kAnd, built[n.a], built[n.b]),
                            combine(FormulaOp::kAnd, negation(built[n.a]), negation(built[n.b]))));
                break;
            default: {
                Formula leaf;
                leaf.nodes.push_back(n);
                if (n.op == FormulaOp::kExpr) {
                    leaf.nodes[0].index = 0;
                    leaf.expressions.push_back(f.expressions[n.index]);
                }
                built.push_back(std::move(leaf));
                break;
            }
        }
    }
    return built.empty() ? Formula::constant(false) : built.back();
}

}  // namespace

LimbSet driven_limbs(const BoundCall& call) {
    LimbSet limbs = motion::signature_of(call, call.subject.kind).limbs;
    if (call.subject.kind == SubjectKind::kLimb) {
        limbs = limbs.with(call.subject.limb);
    }
    // What is done with one hand leaves the other alone.
    if (limbs == motion::kBothArms && call.own == nullptr) {
        if (const motion::ArgumentValue* given = call.find("side")) {
            if (const auto* side = std::get_if<motion::Side>(given)) {
                limbs = motion::limb_set(motion::arm_of(*side));
            }
        }
    }
    return limbs;
}

Swings swings_of(const BoundCall& call, bool calm) {
    const std::string& m = call.movement;
    const Swings anything{true, true, true};
    if (call.subject.kind == SubjectKind::kProp) {
        return {};
    }
    if (!calm) {
        return anything;
    }
    if (m == "step" || m == "half_step") {
        const motion::ArgumentValue* side = call.find("side");
        const motion::Side* which = side != nullptr ? std::get_if<motion::Side>(side) : nullptr;
        return which == nullptr                ? Swings{true, true, false}
               : *which == motion::Side::kLeft ? Swings{true, false, false}
                                               : Swings{false, true, false};
    }
    if (m == "transfer") {
        return {call.subject.limb == Limb::kLeftLeg, call.subject.limb == Limb::kRightLeg, false};
    }
    // One foot after the other.
    if (is_one_of(m, {"go", "walk", "turn", "face", "ready", "throw", "catch"})) {
        return {true, true, false};
    }
    if (call.own != nullptr) {
        const LimbSet limbs = driven_limbs(call);
        const bool pelvis = limbs.has(Limb::kPelvis);
        const bool left = pelvis || limbs.has(Limb::kLeftLeg);
        const bool right = pelvis || limbs.has(Limb::kRightLeg);
        return {left, right, left && right};
    }
    if (is_one_of(m, {"support",  "idle", "stand",     "carry", "hold",          "reach",
                      "point",    "aim",  "look",      "swing", "swing_forward", "swing_backward",
                      "bow",      "eat",  "hand_over", "hug",   "pick_up",       "sit",
                      "stand_up", "wave", "take",      "lay"})) {
        return {};
    }
    return anything;
}

motion::PropIndex claimed_prop(const BoundCall& call) {
    if (call.subject.kind == SubjectKind::kProp) {
        return call.movement == "fly" ? call.subject.prop : motion::PropIndex{};
    }
    if (is_one_of(call.movement, {"carry", "hold", "throw", "catch"})) {
        if (const motion::ArgumentValue* ball = call.find("ball")) {
            if (const auto* prop = std::get_if<motion::PropIndex>(ball)) {
                return *prop;
            }
        }
    }
    for (const BoundCall& nested : call.nested) {
        BoundCall inner = nested;
        inner.subject = call.subject;
        const motion::PropIndex prop = claimed_prop(inner);
        if (prop.valid()) {
            return prop;
        }
    }
    return {};
}

FigureLowering::FigureLowering(const net::Net& net, const stage::Play& play)
    : net_(net),
      play_(play),
      calm_(play.cast.actors.size(), 1),
      holders_(std::make_unique<Holders>(net, play)) {
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        const net::ActionIndex action = net.action(net::PlaceIndex{p});
        if (action.valid() && action.value < play.actions.size()) {
            places_.push_back({p, &play.actions[action.value].call});
        }
    }
    const auto restless = [&](const BoundCall& call) {
        if (call.subject.kind != SubjectKind::kProp && call.subject.actor.value < calm_.size()) {
            calm_[call.subject.actor.value] = 0;
        }
    };
    for (const ActionPlace& a : places_) {
        if (runs(*a.call)) {
            restless(*a.call);
        }
    }
    // Who takes tokens that are not ready cuts movements.
    const net::NetTables& tables = net.tables();
    std::vector<std::uint8_t> cut(net.place_count(), 0);
    for (const net::Special& s : tables.specials) {
        for (const net::ArcTable& arc : s.arcs) {
            if (arc.kind == net::ArcKind::kTakeNow || arc.kind == net::ArcKind::kTakeAllNow) {
                cut[arc.place] = 1;
            }
        }
    }
    for (const ActionPlace& a : places_) {
        if (cut[a.place] != 0) {
            restless(*a.call);
        }
    }
}

// Left and right are asked to be in the air; of the other leg nothing is asked.
Formula FigureLowering::may_swing(std::uint32_t actor, bool left, bool right) const {
    if (actor >= calm_.size() || calm_[actor] == 0) {
        return Formula::constant(true);
    }
    std::vector<Formula> ways, lefts, rights;
    std::vector<std::pair<std::uint32_t, Swings>> places;
    for (const ActionPlace& a : places_) {
        if (a.call->subject.kind != SubjectKind::kProp && a.call->subject.actor.value == actor) {
            places.push_back({a.place, swings_of(*a.call, true)});
        }
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto& [p, s] = places[i];
        const net::PlaceIndex place{p};
        if (left != right) {
            if (left ? s.left : s.right) {
                ways.push_back(Formula::marked(place));
            }
            continue;
        }
        if (s.both) {
            ways.push_back(Formula::marked(place));
        } else if (s.left && s.right) {
            ways.push_back(Formula::marked(place, 2));
        }
        for (std::size_t k = 0; k < places.size(); ++k) {
            if (k != i && s.left && places[k].second.right) {
                ways.push_back(Formula::binary(FormulaOp::kAnd, Formula::marked(place),
                                               Formula::marked(net::PlaceIndex{places[k].first})));
            }
        }
    }
    return any_of(std::move(ways));
}

Lowered FigureLowering::lower(const Formula& formula) const {
    constexpr std::size_t kMost = 8;
    const std::vector<net::HostAtom>& atoms = net_.declarations().host_atoms;
    std::vector<std::uint32_t> used;
    for (const Formula::Node& n : formula.nodes) {
        if (n.op == FormulaOp::kHost &&
            std::find(used.begin(), used.end(), n.index) == used.end()) {
            used.push_back(n.index);
        }
    }
    const Lowered nothing{Formula::constant(true), Formula::constant(false)};
    if (used.size() > kMost) {
        return nothing;
    }
    Lowered out{Formula::constant(false), Formula::constant(false)};
    Formula may_not = Formula::constant(false);
    for (std::uint32_t values = 0; values < (1u << used.size()); ++values) {
        std::map<std::uint32_t, bool> value_of;
        std::map<std::uint32_t, std::pair<bool, bool>> lifted;  // per actor: left, right
        struct Held {
            std::set<std::string> named, by;
        };
        std::map<std::uint32_t, Held> held;  // per prop
        Formula feasible = Formula::constant(true);
        for (std::size_t i = 0; i < used.size(); ++i) {
            const bool value = ((values >> i) & 1) != 0;
            value_of[used[i]] = value;
            if (used[i] >= atoms.size()) {
                continue;
            }
            const net::HostAtom& atom = atoms[used[i]];
            if (atom.kind == net::HostAtom::Kind::kHolder) {
                for (std::uint32_t p = 0; p < play_.cast.props.size(); ++p) {
                    if (play_.cast.props[p].name == atom.subject) {
                        Held& h = held[p];
                        h.named.insert(atom.value);
                        if (value) {
                            h.by.insert(atom.value);
                        }
                    }
                }
                continue;
            }
            if (!value) {
                continue;  // that a leg is not in some phase can always be
            }
            const std::size_t dot = atom.subject.rfind('.');
            const std::string who = atom.subject.substr(0, dot),
                              limb = atom.subject.substr(dot + 1);
            for (std::uint32_t a = 0; a < play_.cast.actors.size(); ++a) {
                if (play_.cast.actors[a].name == who && atom.value == "swing") {
                    if (limb == "left_leg") {
                        lifted[a].first = true;
                    } else if (limb == "right_leg") {
                        lifted[a].second = true;
                    }
                }
            }
        }
        for (const auto& [prop, h] : held) {  // by one at a time
            feasible = h.by.size() > 1
                           ? Formula::constant(false)
                           : combine(FormulaOp::kAnd, std::move(feasible),
                                     h.by.empty() ? holders_->may_hold(prop, h.named, true)
                                                  : holders_->may_hold(prop, h.by));
        }
        for (const auto& [actor, legs] : lifted) {
            feasible = combine(FormulaOp::kAnd, std::move(feasible),
                               may_swing(actor, legs.first, legs.second));
        }
        const Formula here = with_values(formula, value_of);
        out.may =
            combine(FormulaOp::kOr, std::move(out.may), combine(FormulaOp::kAnd, feasible, here));
        may_not = combine(FormulaOp::kOr, std::move(may_not),
                          combine(FormulaOp::kAnd, feasible, negation(here)));
    }
    out.must = negation(std::move(may_not));
    return out;
}

FigureLowering::~FigureLowering() = default;

std::vector<std::string> FigureLowering::assumptions(const net::Rule& rule) const {
    std::set<std::string> props;
    for (const Formula& f : rule.operands) {
        for (const Formula::Node& n : f.nodes) {
            const auto& atoms = net_.declarations().host_atoms;
            if (n.op == FormulaOp::kHost && n.index < atoms.size() &&
                atoms[n.index].kind == net::HostAtom::Kind::kHolder) {
                props.insert(atoms[n.index].subject);
            }
        }
    }
    std::vector<std::string> out;
    for (std::uint32_t p = 0; p < play_.cast.props.size(); ++p) {
        if (props.contains(play_.cast.props[p].name)) {
            const std::vector<std::string> some = holders_->assumptions(p);
            out.insert(out.end(), some.begin(), some.end());
        }
    }
    return out;
}

std::vector<net::Rule> figure_rules(const net::Net& net, const stage::Play& play) {
    std::vector<net::Rule> rules;
    // Sums of places per actor and limb, none of which may have two tokens; limbs with the same
    // sums make one rule.
    using Sums = std::vector<std::vector<std::uint32_t>>;
    for (std::uint32_t a = 0; a < play.cast.actors.size(); ++a) {
        std::map<Sums, std::string> of_sums;
        for (int l = 0; l < motion::kLimbCount; ++l) {
            const Limb limb = static_cast<Limb>(l);
            std::vector<std::uint32_t> all, without_holding, holding;
            for (std::uint32_t p = 0; p < net.place_count(); ++p) {
                const net::ActionIndex action = net.action(net::PlaceIndex{p});
                if (!action.valid() || action.value >= play.actions.size()) {
                    continue;
                }
                const BoundCall& call = play.actions[action.value].call;
                if (call.subject.kind == SubjectKind::kProp || call.subject.actor.value != a ||
                    !driven_limbs(call).has(limb)) {
                    continue;
                }
                all.push_back(p);
                // Whoever walks, stands or turns leaves arms alone that hold something.
                const bool holds = is_one_of(call.movement, {"carry", "hold"});
                const bool gives_way =
                    !motion::signature_of(call, call.subject.kind).arms_parameter.empty();
                if (!holds) {
                    without_holding.push_back(p);
                }
                if (!gives_way) {
                    holding.push_back(p);
                }
            }
            const bool arm = limb == Limb::kLeftArm || limb == Limb::kRightArm;
            Sums sums;
            if (arm && holding.size() + without_holding.size() != all.size() * 2) {
                sums = {without_holding, holding};
            } else {
                sums = {all};
            }
            std::erase_if(sums, [](const auto& places) { return places.empty(); });
            if (!sums.empty()) {
                std::string& limbs = of_sums[sums];
                limbs += (limbs.empty() ? "" : ", ") + std::string(motion::name_of(limb));
            }
        }
        for (const auto& [sums, limbs] : of_sums) {
            net::Rule rule;
            const bool whole = of_sums.size() == 1;
            rule.path = "builtin.one_movement." + play.cast.actors[a].name +
                        (whole ? "" : "." + limbs.substr(0, limbs.find(',')));
            rule.caption = "one movement at a time drives " + play.cast.actors[a].name + "'s " +
                           (whole ? "limbs" : limbs);
            rule.kind = net::RuleKind::kNever;
            std::vector<Formula> twice;
            for (const std::vector<std::uint32_t>& places : sums) {
                Expr sum = Expr::integer(0);
                for (std::size_t i = 0; i < places.size(); ++i) {
                    Expr count =
                        Expr::slot(net::slot(net::SlotKind::kCount, places[i]), {ValueKind::kInt});
                    sum =
                        i == 0
                            ? std::move(count)
                            : Expr::binary(ExprOp::kAdd, std::move(sum), std::move(count)).value();
                }
                twice.push_back(Formula::expression(
                    Expr::binary(ExprOp::kGreaterEqual, std::move(sum), Expr::integer(2)).value()));
            }
            rule.operands.push_back(any_of(std::move(twice)));
            rules.push_back(std::move(rule));
        }
    }
    for (std::uint32_t b = 0; b < play.cast.props.size(); ++b) {
        std::map<std::uint32_t, std::vector<Formula>> of_holder;  // actor; the air
        constexpr std::uint32_t kAir = ~std::uint32_t{0};
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            const net::ActionIndex action = net.action(net::PlaceIndex{p});
            if (!action.valid() || action.value >= play.actions.size()) {
                continue;
            }
            const BoundCall& call = play.actions[action.value].call;
            if (claimed_prop(call).value == b) {
                of_holder[call.subject.kind == SubjectKind::kProp ? kAir : call.subject.actor.value]
                    .push_back(Formula::marked(net::PlaceIndex{p}));
            }
        }
        if (of_holder.size() < 2) {
            continue;
        }
        net::Rule rule;
        rule.path = "builtin.one_holder." + play.cast.props[b].name;
        rule.caption = "nobody holds " + play.cast.props[b].name + " while another does";
        rule.kind = net::RuleKind::kMutex;
        for (auto& [who, places] : of_holder) {
            rule.operands.push_back(any_of(std::move(places)));
        }
        rules.push_back(std::move(rule));
    }
    return rules;
}

}  // namespace puppetri::verdict
