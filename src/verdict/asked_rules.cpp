// SPDX-License-Identifier: MIT
#include "asked_rules.h"

#include <utility>

#include "puppetri/verdict/obligation.h"

namespace puppetri::verdict {
namespace {

bool wanted(const std::string& path, const std::string& only) {
    return only.empty() || path == only || path.starts_with(only + ".");
}

}  // namespace

std::vector<Asked> chosen(std::vector<Asked> all, const ProveOptions& options) {
    std::erase_if(all, [&](const Asked& a) {
        return !wanted(a.rule.path, options.only) || (a.built_in && !options.built_in);
    });
    return all;
}

std::vector<Asked> all_rules(const scene::Scene& scene) {
    std::vector<Asked> out;
    bool freezes = false;
    for (const net::Rule& rule : scene.rules()) {
        Asked a;
        a.rule = rule;
        if (rule.kind == net::RuleKind::kNobodyFreezes) {
            const std::size_t actors = scene.play.cast.actors.size();
            freezes = freezes || rule.operands.size() == actors;
            for (std::size_t i = 0; rule.subjects.empty() && rule.operands.size() == actors &&
                                    a.rule.subjects.size() < actors;
                 ++i) {
                a.rule.subjects.push_back(scene.play.cast.actors[i].name);
            }
        }
        out.push_back(std::move(a));
    }
    for (Asked& a : built_in_rules(scene.net, scene.draft, &scene.play)) {
        if (!freezes || a.rule.kind != net::RuleKind::kNobodyFreezes) {
            out.push_back(std::move(a));
        }
    }
    return out;
}

std::vector<Asked> all_rules(const net::NetDraft& draft, const net::Net& net) {
    std::vector<Asked> out;
    for (const net::Rule& rule : net.declarations().rules) {
        Asked a;
        a.rule = rule;
        out.push_back(std::move(a));
    }
    if (out.empty()) {
        const auto ask = [&](const char* path, const char* caption, net::RuleKind kind) {
            Asked a;
            a.rule.path = path;
            a.rule.caption = caption;
            a.rule.kind = kind;
            a.rule.count = kind == net::RuleKind::kBounded ? kNoCount : 1;
            out.push_back(std::move(a));
        };
        ask("deadlock_free", "the net stops in ends only", net::RuleKind::kDeadlockFree);
        ask("bounded", "no place grows without end", net::RuleKind::kBounded);
        ask("quasi_live", "every transition can fire", net::RuleKind::kQuasiLive);
        ask("live", "every transition can always fire again", net::RuleKind::kLive);
        ask("reversible", "the start can always be reached again", net::RuleKind::kReversible);
    }
    for (Asked& a : built_in_rules(net, draft, nullptr)) {
        out.push_back(std::move(a));
    }
    return out;
}

std::vector<net::Rule> rules_of(const scene::Scene& scene) {
    std::vector<net::Rule> out;
    for (Asked& a : all_rules(scene)) {
        out.push_back(std::move(a.rule));
    }
    return out;
}

std::vector<net::Rule> rules_of(const net::Net& net) { return net.declarations().rules; }

}  // namespace puppetri::verdict
