// SPDX-License-Identifier: MIT
// `puppetri replay SCENE LOG`: could the net have done what a log says?
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "commands.h"
#include "foreign_log.h"
#include "horizon.h"
#include "marking_text.h"
#include "proving.h"
#include "puppetri/base/text.h"
#include "puppetri/io/json_writer.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

using run::Deviation;

const char* word_of(Deviation::Kind kind) {
    switch (kind) {
        case Deviation::Kind::kCannotFire:
            return "cannot-fire";
        case Deviation::Kind::kOvertaken:
            return "overtaken";
        case Deviation::Kind::kMissed:
            return "missed";
        case Deviation::Kind::kOutOfOrder:
            return "out-of-order";
        case Deviation::Kind::kFault:
            return "fault";
    }
    return "";
}

std::string message_of(Deviation::Kind kind, const std::string& transition) {
    switch (kind) {
        case Deviation::Kind::kCannotFire:
            return "the net cannot fire " + transition + " here";
        case Deviation::Kind::kOvertaken:
            return "the net fires something else before " + transition;
        case Deviation::Kind::kMissed:
            return "before " + transition + " the net would have fired what the log does not have";
        case Deviation::Kind::kOutOfOrder:
            return transition + " comes after something later";
        case Deviation::Kind::kFault:
            return "firing " + transition + " stops the net";
    }
    return "";
}

std::string at_text(SimTime at) { return number_to_text(at.seconds()) + " s"; }

int replay(const Arguments& arguments) {
    const auto subject = load_subject(arguments.text("scene"), arguments);
    if (!subject) {
        return subject.error();
    }
    const net::Net& net = subject->scene ? subject->scene->net : *subject->net;
    const double rate = subject->scene ? subject->scene->frame_rate.per_second() : 24;
    const std::string path = arguments.text("log");
    const auto lines = load_log(path, arguments, rate);
    if (!lines) {
        return lines.error();
    }
    const auto log = in_names_of(net, *lines, path, arguments);
    if (!log) {
        return log.error();
    }
    run::ReplayOptions options;
    options.unlogged_fire = arguments.given("--unlogged");
    if (subject->scene) {
        options.beat = subject->scene->beat;
    }
    if (arguments.given("--tolerance")) {
        const auto t =
            parse_horizon(arguments.text("--tolerance"),
                          subject->scene ? subject->scene->frame_rate : scene::FrameRate{});
        if (!t || !t->time) {
            say_error("--tolerance: write a time, as 10ms");
            return kBadInput;
        }
        options.tolerance = *t->time;
    }
    const run::Replayed result = run::replay(net, log->firings, options);
    const std::string marking = marking_text(net, result.tokens);
    if (arguments.given("--json")) {
        io::JsonWriter json;
        json.begin_object();
        json.member("lines", static_cast<std::int64_t>(log->firings.size()));
        json.member("followed", static_cast<std::int64_t>(result.firings));
        json.member("unseen", static_cast<std::int64_t>(result.unseen));
        json.member("marking", marking);
        if (result.deviation) {
            const Deviation& d = *result.deviation;
            json.key("deviation").begin_object();
            json.member("kind", word_of(d.kind));
            json.member("certain", d.certain);
            json.member("line", static_cast<std::int64_t>(log->lines[d.index]));
            json.member("seconds", d.at.seconds());
            json.member("transition",
                        std::string(net.transition(log->firings[d.index].transition).path));
            json.key("reasons").begin_array();
            for (const std::string& reason : d.reasons) {
                json.string(reason);
            }
            json.end_array().key("could_fire").begin_array();
            for (const net::TransitionIndex t : d.could_fire) {
                json.string(net.transition(t).path);
            }
            json.end_array().end_object();
        }
        json.end_object();
        std::puts(json.take().c_str());
        return !result.deviation ? kFine : result.deviation->certain ? kFailed : kUnknown;
    }
    const std::string unseen =
        result.unseen == 0 ? ""
                           : ", and " + std::to_string(result.unseen) + " that the log leaves out";
    if (!result.deviation) {
        say("the net can do all of it: " + std::to_string(result.firings) + " firings" + unseen +
            "; then: " + marking);
        return kFine;
    }
    const Deviation& d = *result.deviation;
    const std::string transition(net.transition(log->firings[d.index].transition).path);
    say(path + ":" + std::to_string(log->lines[d.index]) + ": at " +
        at_text(log->firings[d.index].at) + ": " + message_of(d.kind, transition));
    for (const std::string& reason : d.reasons) {
        say("  " + reason);
    }
    std::string could;
    for (const net::TransitionIndex t : d.could_fire) {
        could += (could.empty() ? "" : ", ") + std::string(net.transition(t).path);
    }
    say("  what could fire at " + at_text(d.at) + ": " + (could.empty() ? "nothing yet" : could));
    say("  after " + std::to_string(result.firings) + " firings" + unseen + ": " + marking);
    if (!d.certain) {
        say("UNKNOWN whether the net could have done it otherwise: something that the log leaves "
            "open was guessed before");
        return kUnknown;
    }
    return kFailed;
}

}  // namespace

Command replay_command() {
    std::vector<Option> options = {
        {"scene", Value::kText, "SCENE", "a scene (.pup) or a net (.pnml, .xml, .net)", true},
        {"log", Value::kText, "LOG", "CSV (time, event[, object]), or lines TIME OBJECT EVENT",
         true},
        {"--tolerance", Value::kText, "T", "the log's times may be wrong by so much (0)"},
        {"--unlogged", Value::kFlag, "",
         "transitions that the log never mentions fire unseen as soon as they can"},
        {"--json", Value::kFlag, "", "as one JSON object on stdout"}};
    return {"replay",
            "hold a log from elsewhere against a net: where does it part from what the net can do?",
            "Follows the log line by line. Durations, delays and events that the log does not tell "
            "are chosen so\n"
            "that it fits, where the net's own bounds allow it. The first line that the net cannot "
            "follow is\n"
            "explained: which place lacks tokens, which guard fails, how much too early it is, or "
            "what should\n"
            "have fired before. Exit 1 then; 3 where a guess before (which of several tokens with "
            "attributes, what fired\n"
            "unseen) may have been wrong.\n\n"
            "CSV may have a head line (tick, frame, seconds or time; event or transition; object); "
            "otherwise the\n"
            "columns are seconds, event, object. Times of lines TIME OBJECT EVENT are frames.\n\n"
            "Examples:\n"
            "  puppetri run shop.pup --log log.csv && puppetri replay shop.pup log.csv\n"
            "  puppetri replay shop.pup till.csv --map 'paid=leave' --unlogged --tolerance 1s\n"
            "  puppetri replay table.pup table.tuples --name 'phil[{object}].{event}' --rate 10",
            with_log_options(std::move(options)), replay};
}

}  // namespace puppetri::cli
