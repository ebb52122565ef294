// SPDX-License-Identifier: MIT
#include "puppetri/verdict/explain.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "puppetri/base/text.h"
#include "puppetri/net/chooser.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/run/player.h"
#include "puppetri/stage/stage.h"
#include "script_player.h"

namespace puppetri::verdict {
namespace {

std::string quoted_caption(const net::ElementView& e) {
    return e.caption.empty() ? std::string(e.path)
                             : std::string(e.path) + " \"" + std::string(e.caption) + '"';
}

std::string time_text(SimTime at) { return number_to_text_fixed(at.seconds(), 3) + " s"; }

// What begins with this firing: the captions of the places that it gives to.
std::string begins(const net::Net& net, const proof::PlainNet& plain, std::uint32_t t) {
    std::string out;
    for (const net::Weighted& w : plain.gives.row(t)) {
        const net::ElementView place = net.place(net::PlaceIndex{w.place});
        out += (out.empty() ? "" : "; ") +
               std::string(place.caption.empty() ? place.path : place.caption);
    }
    return out;
}

bool is_enabled(const proof::PlainNet& plain, const proof::Marking& marking, std::uint32_t t) {
    return plain.enabled(marking, t);
}

bool is_about_freezing(const scene::Scene& scene, const std::string& rule) {
    return rule.starts_with("builtin.nobody_freezes") ||
           std::any_of(scene.rules().begin(), scene.rules().end(), [&](const net::Rule& r) {
               return r.path == rule && r.kind == net::RuleKind::kNobodyFreezes;
           });
}

}  // namespace

std::vector<std::string> story(const net::Net& net, const Witness& witness) {
    const proof::Plain plain = proof::plain(net);
    std::vector<std::string> out;
    std::size_t width = 0, time = 0;
    for (const Witness::Step& s : witness.steps) {
        width = std::max<std::size_t>(width, count_code_points(s.transition));
        time = std::max(time, time_text(s.at).size());
    }
    const auto mark = [&](std::size_t firings) {
        if (witness.lasso_from == firings) {
            out.push_back("from here it goes round for ever:");
        }
        if (witness.violates_after == firings) {
            out.push_back("here: " + witness.says);
        }
    };
    mark(0);
    for (std::size_t i = 0; i < witness.steps.size(); ++i) {
        const Witness::Step& s = witness.steps[i];
        const net::TransitionIndex t = net.find_transition(s.transition);
        const std::string at = time_text(s.at);
        std::string line = std::string(time - at.size(), ' ') + at + "  " + s.transition;
        if (t.valid()) {
            const std::string what = begins(net, plain.net, t.value);
            if (!what.empty()) {
                line += std::string(width - count_code_points(s.transition) + 2, ' ') + what;
            }
        }
        out.push_back(std::move(line));
        mark(i + 1);
    }
    return out;
}

Explanation explain(const scene::Scene& scene, const Verdict& verdict) {
    Explanation out;
    out.what = name_of(verdict) + (verdict.reason.empty() ? "" : ": " + verdict.reason);
    if (!verdict.witness) {
        return out;
    }
    const Witness& witness = *verdict.witness;
    const net::Net& net = scene.net;
    out.story = story(net, witness);
    const proof::Plain plain = proof::plain(net);
    ScriptPlayer player(scene, witness);
    // Per place: the last firing that took from it.
    std::vector<std::pair<std::uint32_t, SimTime>> taker(net.place_count(),
                                                         {net::TransitionIndex{}.value, {}});
    std::vector<std::uint8_t> had(net.place_count(), 0);
    const auto look = [&] {
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            had[p] |= player.player().tokens(net::PlaceIndex{p}) > 0 ? 1 : 0;
        }
    };
    look();
    const auto fired = [&] {
        const net::TransitionIndex t = player.player().last();
        for (const net::Weighted& w : plain.net.takes.row(t.value)) {
            taker[w.place] = {t.value, player.player().now()};
        }
        look();
    };
    while (player.step()) {
        fired();
    }
    // Who freezes may still be on its way to where it will wait.
    for (std::uint32_t more = 0; is_about_freezing(scene, verdict.rule) &&
                                 more < 2 * net.transition_count() && player.step_on();
         ++more) {
        fired();
    }
    proof::Marking marking(net.place_count());
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        marking[p] = player.player().tokens(net::PlaceIndex{p});
    }
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (marking[p] == 0) {
            continue;
        }
        std::vector<std::uint32_t> consumers;
        bool goes_on = false;
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            for (const net::Weighted& w : plain.net.takes.row(t)) {
                if (w.place == p) {
                    consumers.push_back(t);
                    goes_on = goes_on || is_enabled(plain.net, marking, t);
                }
            }
        }
        if (goes_on) {
            continue;
        }
        for (const std::uint32_t t : consumers) {
            for (const net::Weighted& w : plain.net.takes.row(t)) {
                if (marking[w.place] >= w.weight) {
                    continue;
                }
                Wait wait;
                wait.place = quoted_caption(net.place(net::PlaceIndex{p}));
                wait.transition = net.transition(net::TransitionIndex{t}).path;
                wait.missing = quoted_caption(net.place(net::PlaceIndex{w.place}));
                const auto& [last, at] = taker[w.place];
                if (last != net::TransitionIndex{}.value) {
                    wait.taken_by = std::string(net.transition(net::TransitionIndex{last}).path) +
                                    " at " + time_text(at);
                }
                for (std::uint32_t g = 0; g < net.transition_count(); ++g) {
                    for (const net::Weighted& given : plain.net.gives.row(g)) {
                        if (given.place == w.place) {
                            wait.givers.emplace_back(net.transition(net::TransitionIndex{g}).path);
                        }
                    }
                }
                wait.words = wait.place + " waits for " + wait.transition +
                             ", which needs a token in " + wait.missing + "; ";
                wait.words += !wait.taken_by.empty() ? wait.taken_by + " took the last one"
                              : had[w.place] != 0    ? "it had one at the start"
                                                     : "it never had one";
                if (wait.givers.empty()) {
                    wait.words += ", and nothing gives one";
                } else {
                    wait.words += ", and only ";
                    for (std::size_t i = 0; i < wait.givers.size(); ++i) {
                        wait.words += (i == 0 ? "" : " or ") + wait.givers[i];
                    }
                    wait.words += " can give another";
                }
                out.waits.push_back(std::move(wait));
            }
        }
    }
    if (!plain.unsound) {
        for (const std::uint32_t p : empty_siphon(plain.net, marking)) {
            out.siphon.push_back(quoted_caption(net.place(net::PlaceIndex{p})));
        }
    }
    return out;
}

}  // namespace puppetri::verdict
