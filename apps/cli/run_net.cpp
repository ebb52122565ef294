// SPDX-License-Identifier: MIT
#include "run_net.h"

#include <cstdio>
#include <string>
#include <vector>

#include "horizon.h"
#include "logs.h"
#include "marking_text.h"
#include "performing.h"
#include "proving.h"
#include "puppetri/run/player.h"
#include "puppetri/verdict/explain.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

constexpr std::uint64_t kFirings = 100;  // unless told

}  // namespace

int run_net(const Arguments& arguments) {
    for (const char* option : {"--events", "--record", "--score", "--json", "--log", "--measure"}) {
        if (arguments.given(option)) {
            say_error(std::string(option) +
                      " is for scenes; a net takes --witness, --seed, --for "
                      "1000x, --hash");
            return kBadInput;
        }
    }
    const auto subject = load_subject(arguments.text("scene"), arguments);
    if (!subject) {
        return subject.error();
    }
    const net::Net& net = *subject->net;
    verdict::Witness witness;
    const bool given = arguments.given("--witness");
    std::uint64_t firings = kFirings;
    if (given) {
        auto read = load_witness(arguments.text("--witness"), net);
        if (!read) {
            return read.error();
        }
        witness = std::move(*read);
        firings = witness.steps.size();
    } else if (arguments.given("--seed")) {
        witness.seed = static_cast<std::uint64_t>(arguments.integer("--seed"));
    }
    if (arguments.given("--for")) {
        const auto horizon = parse_horizon(arguments.text("--for"), {});
        if (!horizon || !horizon->firings) {
            say_error("--for: a net runs for a number of firings, such as 1000x");
            return kBadInput;
        }
        firings = *horizon->firings;
    }
    net::ScriptedChooser script(witness.choices);
    net::RandomChooser random;
    run::Options options;
    options.seed = witness.seed;
    options.chooser = given ? static_cast<net::Chooser*>(&script) : &random;
    run::Player player(net, options);
    std::vector<run::OutsideEvent> events;
    for (const verdict::Witness::Event& e : witness.events) {
        events.push_back({e.at, net.find_event(e.path)});
    }
    player.schedule(events);
    run::Stop stop = run::Stop::kNone;
    verdict::Witness played = witness;
    played.steps.clear();
    while (played.steps.size() < firings && (stop = player.step()) == run::Stop::kNone) {
        played.steps.push_back({player.now(), std::string(net.transition(player.last()).path)});
        const std::size_t i = played.steps.size() - 1;
        if (i < witness.steps.size() && played.steps[i] != witness.steps[i]) {
            say_error("the net fires " + played.steps[i].transition + " where the witness has " +
                      witness.steps[i].transition);
            return kFailed;
        }
    }
    if (arguments.given("--hash")) {
        std::puts(hash_text_of(player.log_hash()).c_str());
        return stop == run::Stop::kFault ? kFailed : kFine;
    }
    for (const std::string& line : verdict::story(net, played)) {
        say(line);
    }
    if (stop == run::Stop::kFault) {
        say_diagnostics({player.fault()});
        return kFailed;
    }
    std::vector<std::uint32_t> tokens;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        tokens.push_back(player.tokens({p}));
    }
    say("after " + std::to_string(played.steps.size()) + " firings: " + marking_text(net, tokens));
    if (player.next_time() == SimTime::never()) {
        say(player.in_final_marking() ? "at rest in a final marking" : "nothing can fire any more");
    }
    return kFine;
}

}  // namespace puppetri::cli
