// SPDX-License-Identifier: MIT
// Outside events: lists, live lines, and sessions that replay.
#include "puppetri/scene/events.h"

#include "files.h"
#include "puppetri/scene/perform.h"

namespace puppetri::scene {
namespace {

const std::vector<std::string> kNames = {"go", "a.whistle"};

constexpr const char* kScene =
    "event go\nevent stop at 4 s\nplace idle tokens 1\nplace busy takes 0.5 .. 1.5 s\n"
    "start: idle -> busy on go\nfinish: busy -> idle\nhalt: idle -> idle on stop";

}  // namespace

TEST_CASE("a list of events is read exactly [unit]") {
    const EventList list = parse_event_list(
        "# a comment\nseed 7\n2.5 s go\n\n100 ms a.whistle   # another\n1764000000 ticks go\n1.5 "
        "min go\n",
        "f", kNames);
    CHECK(list.diagnostics.empty());
    CHECK(list.seed == std::optional<std::uint64_t>(7));
    REQUIRE(list.events.size() == 4);
    CHECK(list.events[0] == run::OutsideEvent{{5 * kTicksPerSecond / 2}, {0}});
    CHECK(list.events[1] == run::OutsideEvent{{kTicksPerSecond / 10}, {1}});
    CHECK(list.events[2] == run::OutsideEvent{{1764000000}, {0}});
    CHECK(list.events[3] == run::OutsideEvent{{90 * kTicksPerSecond}, {0}});
}

TEST_CASE("each bad line of a list is told where it is wrong [unit]") {
    const EventList list = parse_event_list(
        "2.5 s og\n3 m go\nx s go\n2 s\nnow go\n0.5 ticks go\n2 s go too\n", "f", kNames);
    std::vector<std::pair<std::uint32_t, std::string>> got;
    for (const Diagnostic& d : list.diagnostics) {
        got.emplace_back(d.where.line, d.code);
        CHECK_FALSE(d.remedy.empty());
    }
    CHECK(got == std::vector<std::pair<std::uint32_t, std::string>>{{1, "unknown-name"},
                                                                    {2, "wrong-unit"},
                                                                    {3, "bad-event-line"},
                                                                    {4, "bad-event-line"},
                                                                    {5, "bad-event-line"},
                                                                    {6, "bad-event-line"},
                                                                    {7, "bad-event-line"}});
    CHECK(list.events.empty());
}

TEST_CASE("live lines say now or a time [unit]") {
    const auto now = parse_live_event("now go", kNames);
    REQUIRE(now.has_value());
    REQUIRE(now->has_value());
    CHECK_FALSE((*now)->at.has_value());
    CHECK_FALSE(parse_live_event("  # nothing", kNames)->has_value());
    CHECK_FALSE(parse_live_event("now gone", kNames).has_value());
}

TEST_CASE("the inner clock of a notation is no event that anybody may call [unit]") {
    const Scene scene = from_text(
        "messages row {\n message m\n node a takes 1 s\n"
        " node b takes 1 s\n link a b takes 0.2 s\n a sends m to b every 5 s\n}\nuse row\n"
        "event tick every 1 s\nplace p tokens 1\nt: p -> p on tick\n");
    const std::vector<std::string> names = event_names(scene.net);
    const net::EventIndex clock = scene.net.find_event("row.a_sends_time");
    const net::EventIndex tick = scene.net.find_event("tick");
    REQUIRE(clock.valid());
    REQUIRE(tick.valid());
    CHECK_FALSE(scene.net.declarations().events[clock.value].outside);
    CHECK(scene.net.declarations().events[tick.value].outside);
    CHECK(has_errors(parse_event_list("2 s row.a_sends_time", "f", names).diagnostics));
    CHECK(parse_event_list("2 s tick", "f", names).diagnostics.empty());
}

TEST_CASE("a recorded session replays to the same hash [law]") {
    const Scene scene = from_text(kScene);
    const std::vector<std::string> names = event_names(scene.net);
    const net::EventIndex go = scene.net.find_event("go");
    // Live: events pushed at whatever instant the run has reached.
    Session live(scene, {.seed = 11, .record = true});
    for (const double t : {0.3, 1.1, 2.77, 4.0, 9.5}) {
        live.advance_to(SimTime{static_cast<std::int64_t>(t * kTicksPerSecond)});
        live.push(go);
    }
    live.schedule({SimTime{12 * kTicksPerSecond}, go});
    live.run();
    const auto first = live.finish();
    REQUIRE(first.has_value());
    CHECK(first->firings >= 8);

    const std::string file = write_event_list(first->recording, first->seed, names);
    const EventList list = parse_event_list(file, "session", names);
    REQUIRE(list.diagnostics.empty());
    const auto second = perform(scene, {.seed = list.seed, .events = list.events, .record = true});
    REQUIRE(second.has_value());
    CHECK(second->log_hash == first->log_hash);
    CHECK(second->firings == first->firings);
    CHECK(write_event_list(second->recording, second->seed, names) == file);
}

TEST_CASE("a file of events is part of the scene [unit]") {
    MemoryFiles files;
    files.add("scene.pup",
              "scene \"x\"\nuntil 10 s\nevents from \"go.txt\"\nnet n {\n event go\n place P\n t: "
              "-> P on go\n}\nuse n as a\n");
    files.add("go.txt", "1 s a.go\n2 s a.go\n");
    const Scene scene = must(load(files, "scene.pup"));
    const auto performed = perform(scene);
    REQUIRE(performed.has_value());
    CHECK(performed->firings == 2);
    files.add("go.txt", "1 s a.gone\n");
    const Diagnostics list = check(files, "scene.pup");
    REQUIRE(list.size() == 1);
    CHECK(list[0].where.file == "go.txt");
}

TEST_CASE("a run without an end is refused, and slices of a run change nothing [law]") {
    MemoryFiles files;
    files.add("scene.pup", "scene \"x\"\nplace P takes 1 s tokens 1\nt: P -> P\n");
    const Scene scene = must(load(files, "scene.pup"));
    const auto endless = perform(scene);
    REQUIRE_FALSE(endless.has_value());
    CHECK(endless.error().at(0).code == "no-horizon");
    const auto counted = perform(scene, {.horizon = {.firings = 7}});
    REQUIRE(counted.has_value());
    CHECK(counted->firings == 7);
    CHECK(counted->end.ticks == 7 * kTicksPerSecond);
}

}  // namespace puppetri::scene
