// SPDX-License-Identifier: MIT
// `puppetri explore NET`: all reachable markings, counted one by one.
#if defined(__GLIBC__) || defined(__linux__)
#include <malloc.h>
#endif

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "budget_arguments.h"
#include "commands.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/io/load_net.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/coverability.h"
#include "puppetri/proof/explorer.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

using proof::Ended;
using proof::Exploration;

// To name the place that grows when an exploration has not come to an end.
constexpr double kBoundedness_s = 2;
constexpr std::uint64_t kBoundednessBytes = 256 << 20;
constexpr std::size_t kLeftOutShown = 3;

std::optional<std::uint32_t> growing_place(const proof::PlainNet& net, const Exploration& e) {
    if (e.complete || e.ended == Ended::kCancelled) {
        return std::nullopt;
    }
    proof::Budget budget;
    budget.seconds = kBoundedness_s;
    budget.bytes = kBoundednessBytes;
    const proof::BoundednessAnswer answer = proof::boundedness(net, budget);
    if (answer.kind != proof::BoundednessAnswer::kUnbounded) {
        return std::nullopt;
    }
    return answer.place;
}

void say_left_out(const proof::PlainNet& net) {
    if (net.exact()) {
        return;
    }
    say("note: explored without time, data and events; more markings than the net reaches may be "
        "counted:");
    for (std::size_t i = 0; i < std::min(net.left_out.size(), kLeftOutShown); ++i) {
        say("  " + net.left_out[i]);
    }
    if (net.left_out.size() > kLeftOutShown) {
        say("  and " + std::to_string(net.left_out.size() - kLeftOutShown) + " more");
    }
}

std::string json_of(const Exploration& e, const std::string& ended, bool exact,
                    const std::string& growing) {
    const auto integer = [](std::uint64_t x) { return static_cast<std::int64_t>(x); };
    io::JsonWriter json;
    json.begin_object();
    json.member("states", integer(e.states));
    json.member("edges", integer(e.edges));
    json.member("max_tokens_in_place", integer(e.max_tokens_in_place));
    json.member("max_tokens_per_marking", integer(e.max_tokens_per_marking));
    json.member("bytes_per_state", static_cast<double>(e.bytes) /
                                       static_cast<double>(std::max<std::uint64_t>(e.states, 1)));
    json.member("bits_per_state", integer(e.bits_per_state));
    json.member("seconds", e.seconds);
    json.member("dead", e.dead.found);
    json.member("complete", e.complete);
    json.member("ended", ended);
    json.member("exact", exact);
    if (!growing.empty()) {
        json.member("unbounded_place", growing);
    }
    json.end_object();
    return json.take();
}

Checked<net::Net> compiled_net(const std::string& path) {
    const auto file = io::load_net(path);
    if (!file) {
        return Unexpected(file.error());
    }
    return net::compile(file->draft);
}

void give_back_memory() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

int run(const Arguments& arguments) {
    const auto watched = WatchedBudget::from(arguments);
    if (!watched) {
        return kBadInput;
    }
    const auto net = compiled_net(arguments.text("net"));
    if (!net) {
        say_diagnostics(net.error());
        return kBadInput;
    }
    give_back_memory();  // of the file, which may be larger than what its net is explored in
    const proof::Plain plain = proof::plain(*net);
    if (plain.unsound) {
        say_error("this net has no untimed picture of counts, so nothing is explored: " +
                  plain.net.left_out.front());
        return kUnknown;
    }
    const Exploration e = proof::explore(plain.net, {.find_dead = true}, watched->budget());
    watched->wipe();
    say_left_out(plain.net);
    const auto place = growing_place(plain.net, e);
    const std::string growing =
        place ? std::string(net->place(net::PlaceIndex{*place}).path) : std::string();
    const std::string ended = place ? name_of(Ended::kUnbounded) : name_of(e.ended);
    if (!growing.empty()) {
        say("UNKNOWN: the net is unbounded: place " + growing + " can grow for ever");
    } else if (!e.complete) {
        say("UNKNOWN: not everything was explored: " + ended);
    }
    if (arguments.given("--json")) {
        std::puts(json_of(e, ended, plain.net.exact(), growing).c_str());
    } else {
        const double per_state = static_cast<double>(e.bytes) / static_cast<double>(e.states);
        const double rate = static_cast<double>(e.edges) / std::max(e.seconds, 1e-6);
        const char* so_far = e.complete ? "" : " so far";
        std::printf("states                  %llu%s\n", static_cast<unsigned long long>(e.states),
                    so_far);
        std::printf("edges                   %llu%s\n", static_cast<unsigned long long>(e.edges),
                    so_far);
        std::printf("most tokens in a place  %u\n", e.max_tokens_in_place);
        std::printf("most tokens in all      %llu\n",
                    static_cast<unsigned long long>(e.max_tokens_per_marking));
        std::printf("a dead marking          %s\n", e.dead.found ? "yes"
                                                    : e.complete ? "no"
                                                                 : "none so far");
        std::printf("memory                  %s, %.1f bytes per state (%u bits packed)\n",
                    short_bytes(static_cast<double>(e.bytes)).c_str(), per_state, e.bits_per_state);
        std::printf("time                    %.3f s, %s edges/s\n", e.seconds,
                    short_number(rate).c_str());
    }
    return e.complete ? kFine : kUnknown;
}

}  // namespace

Command explore_command() {
    std::vector<Option> options = {
        {"net", Value::kText, "NET", "a net: PNML, PIPE, TINA or a scene", true},
        {"--json", Value::kFlag, "", "the counts as one JSON object on stdout", false}};
    for (Option& option : budget_options()) {
        options.push_back(std::move(option));
    }
    return {
        "explore", "count all reachable markings of a net, and their edges",
        "Every marking is visited once and stored without loss, packed by what invariants say "
        "about "
        "the net.\n"
        "Of a net with time, data or events the untimed picture is explored, and a note says so.\n"
        "When the budget is used up, or Ctrl-C asks to stop, what is known is told; a place that "
        "grows for\n"
        "ever is named. Exits 0 when everything was explored, 3 otherwise.\n\n"
        "Examples:\n"
        "  puppetri explore model.pnml\n"
        "  puppetri explore model.pnml --threads 2 --memory 2G --json",
        std::move(options), run};
}

}  // namespace puppetri::cli
