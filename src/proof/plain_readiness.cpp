// SPDX-License-Identifier: MIT
#include "plain_readiness.h"

#include <utility>

#include "puppetri/net/tables.h"
#include "puppetri/proof/explorer.h"
#include "puppetri/proof/predicate.h"
#include "timed_builder.h"

namespace puppetri::proof {

using namespace net;

namespace {

// Of every tie the transition that comes next.
class WantedChooser final : public Chooser {
 public:
    std::int64_t choose(const Choice& choice) override {
        std::int64_t answer = 0;
        for (std::size_t i = 0; i < choice.transitions.size(); ++i) {
            answer = choice.transitions[i] == wanted ? static_cast<std::int64_t>(i) : answer;
        }
        answers.push_back(answer);
        return answer;
    }
    std::uint32_t wanted = 0;
    std::vector<std::int64_t> answers;
};

}  // namespace

std::optional<TimedGraph> plain_readiness(const GraphRequest& request) {
    const Net& net = request.net;
    if (!net.paced() || !net.declarations().data.empty()) {
        return std::nullopt;
    }
    const Plain plain = proof::plain(net);
    if (plain.unsound || !plain.net.exact()) {
        return std::nullopt;
    }
    std::vector<Predicate> atoms;
    for (const Formula& f : request.atoms) {
        std::optional<Predicate> p = predicate_of(net, f);
        if (!p) {
            return std::nullopt;
        }
        atoms.push_back(std::move(*p));
    }
    const std::optional<Predicate> final = final_markings(net);
    if (!final) {
        return std::nullopt;
    }
    TimedGraph out;
    World world;
    world.net = &net;
    world.beat = request.beat;
    out.states = std::make_unique<TimedGraph::States>(std::move(world), ClockForm::kReadiness);
    out.states->plain = build_graph(plain.net, atoms, &*final, request.budget);
    out.graph = std::move(out.states->plain->graph);
    // A beat passes wherever a firing has led to, and where nothing fires.
    Graph& g = out.graph;
    for (std::uint32_t s = 0; s < g.size(); ++s) {
        if (s != g.initial || g.dead(s)) {
            g.flags[s] |= Graph::kSettled;
        }
    }
    return out;
}

std::optional<Script> script_of(const Net& net, std::span<const std::uint32_t> firings,
                                std::int64_t beat, std::string* trouble) {
    WantedChooser chooser;
    EngineOptions options;
    options.beat = beat;
    Engine engine(net, chooser, options);
    engine.start();
    Script script;
    for (const std::uint32_t t : firings) {
        chooser.wanted = t;
        if (engine.step(SimTime::never().ticks) != Engine::Outcome::kFired ||
            engine.state().last != t) {
            if (trouble != nullptr) {
                *trouble = std::string(net.transition({t}).path) + " does not fire there";
            }
            return std::nullopt;
        }
        script.until = SimTime{engine.state().now};
        script.firings.push_back({script.until, {t}});
    }
    script.answers = std::move(chooser.answers);
    World world;
    world.net = &net;
    world.beat = beat;
    if (!plays(world, script, trouble)) {
        return std::nullopt;
    }
    return script;
}

}  // namespace puppetri::proof
