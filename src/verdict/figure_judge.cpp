// SPDX-License-Identifier: MIT
#include "figure_judge.h"

#include <algorithm>
#include <string>
#include <vector>

#include "puppetri/motion/library.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;

class Judge {
 public:
    Judge(const scene::Scene& scene, const stage::Performance& performance, const MarkingLog& log)
        : scene_(scene), performance_(performance), log_(log) {}

    // Nothing: the formula speaks of more than figures and tokens.
    std::optional<bool> holds(const Formula& f, SimTime at) const {
        std::vector<bool> t;
        for (const Formula::Node& n : f.nodes) {
            switch (n.op) {
                case FormulaOp::kConstant:
                    t.push_back(n.count != 0);
                    break;
                case FormulaOp::kMarked: {
                    const auto later = std::upper_bound(log_.at.begin(), log_.at.end(), at);
                    if (later == log_.at.begin()) {
                        return std::nullopt;
                    }
                    const auto i = static_cast<std::size_t>(later - log_.at.begin()) - 1;
                    t.push_back(log_.tokens[i][n.index] >= n.count);
                    break;
                }
                case FormulaOp::kHost: {
                    const auto value = atom(n.index, at);
                    if (!value) {
                        return std::nullopt;
                    }
                    t.push_back(*value);
                    break;
                }
                case FormulaOp::kNot:
                    t.push_back(!t[n.a]);
                    break;
                case FormulaOp::kAnd:
                    t.push_back(t[n.a] && t[n.b]);
                    break;
                case FormulaOp::kOr:
                    t.push_back(t[n.a] || t[n.b]);
                    break;
                case FormulaOp::kImplies:
                    t.push_back(!t[n.a] || t[n.b]);
                    break;
                case FormulaOp::kIff:
                    t.push_back(t[n.a] == t[n.b]);
                    break;
                default:
                    return std::nullopt;
            }
        }
        return t.empty() ? std::nullopt : std::optional(static_cast<bool>(t.back()));
    }

 private:
    std::optional<bool> atom(std::uint32_t index, SimTime at) const {
        const std::vector<net::HostAtom>& atoms = scene_.net.declarations().host_atoms;
        if (index >= atoms.size()) {
            return std::nullopt;
        }
        const net::HostAtom& a = atoms[index];
        if (a.kind == net::HostAtom::Kind::kHolder) {
            for (std::uint32_t p = 0; p < scene_.play.cast.props.size(); ++p) {
                if (scene_.play.cast.props[p].name == a.subject) {
                    return performance_.holder(stage::PropIndex{p}, at) == a.value;
                }
            }
            return std::nullopt;
        }
        const std::size_t dot = a.subject.rfind('.');
        if (dot == std::string::npos) {
            return std::nullopt;
        }
        const auto limb = motion::limb_named(a.subject.substr(dot + 1));
        for (std::uint32_t i = 0; limb && i < scene_.play.cast.actors.size(); ++i) {
            if (scene_.play.cast.actors[i].name == a.subject.substr(0, dot)) {
                const motion::Phase phase = performance_.phase(stage::ActorIndex{i}, *limb, at);
                return phase == (a.value == "swing"     ? motion::Phase::kSwing
                                 : a.value == "support" ? motion::Phase::kSupport
                                                        : motion::Phase::kFree);
            }
        }
        return std::nullopt;
    }

    const scene::Scene& scene_;
    const stage::Performance& performance_;
    const MarkingLog& log_;
};

}  // namespace

std::optional<SimTime> judge_figures(const scene::Scene& scene, const Obligation& obligation,
                                     stage::Stage& stage, const MarkingLog& log, SimTime end) {
    const auto rule = std::find_if(scene.rules().begin(), scene.rules().end(),
                                   [&](const net::Rule& r) { return r.path == obligation.rule; });
    // A limb with two masters is the stage's own warning.
    const auto overlap = [&] {
        return std::any_of(stage.diagnostics().begin(), stage.diagnostics().end(),
                           [](const Diagnostic& d) { return d.code == "limb-driven-twice"; });
    };
    if (rule == scene.rules().end()) {
        return overlap() ? std::optional(end) : std::nullopt;
    }
    const auto performance = stage.finish(end);
    const Judge judge(scene, *performance, log);
    constexpr std::int64_t kSample = kTicksPerSecond / 480;
    for (std::int64_t t = 0; t <= end.ticks; t += kSample) {
        std::size_t hold = 0;
        for (const Formula& f : rule->operands) {
            const auto value = judge.holds(f, SimTime{t});
            if (!value) {
                return std::nullopt;
            }
            hold += *value ? 1 : 0;
        }
        bool broken = false;
        switch (rule->kind) {
            case net::RuleKind::kNever:
            case net::RuleKind::kPossible:
                broken = hold > 0;
                break;
            case net::RuleKind::kAlways:
                broken = hold == 0;
                break;
            case net::RuleKind::kMutex:
                broken = hold > 1;
                break;
            case net::RuleKind::kExactlyOne:
                broken = hold != 1;
                break;
            default:
                return std::nullopt;
        }
        if (broken) {
            return SimTime{t};
        }
    }
    return std::nullopt;
}

}  // namespace puppetri::verdict
