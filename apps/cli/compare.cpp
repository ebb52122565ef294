// SPDX-License-Identifier: MIT
// `puppetri compare A B`: where do two logs part?
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "foreign_log.h"
#include "horizon.h"
#include "interrupt.h"
#include "marking_text.h"
#include "performing.h"
#include "puppetri/base/text.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/scene/perform.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

// A log, and the scene that made it, if one did.
struct Side {
    std::string path;
    std::unique_ptr<const scene::Scene> scene;
    std::vector<io::LogLine> lines;
};

class Collected final : public run::LogSink {
 public:
    Collected(const net::Net& net, std::vector<io::LogLine>& lines) : net_(net), lines_(lines) {}
    void fired(SimTime at, net::TransitionIndex t) override {
        lines_.push_back({at, std::string(net_.transition(t).path), "", 0});
    }

 private:
    const net::Net& net_;
    std::vector<io::LogLine>& lines_;
};

Result<Side, int> load_side(const std::string& path, const Arguments& arguments,
                            double frames_per_s) {
    Side side{path, nullptr, {}};
    if (ending_of(path) != ".pup") {
        auto lines = load_log(path, arguments, frames_per_s);
        if (!lines) {
            return Unexpected<int>(lines.error());
        }
        side.lines = std::move(*lines);
        return side;
    }
    io::DiskFiles files;
    auto scene = scene::load(files, path);
    if (!scene) {
        say_diagnostics(scene.error());
        return Unexpected<int>(kBadInput);
    }
    side.scene = std::make_unique<const scene::Scene>(std::move(*scene));
    auto options = perform_options(arguments, *side.scene);
    if (!options) {
        return Unexpected<int>(options.error());
    }
    Collected sink(side.scene->net, side.lines);
    options->sink = &sink;
    options->go_on = [](void*, double) { return !interrupted(); };
    auto performed = scene::perform(*side.scene, *options);
    if (!performed) {
        say_diagnostics(performed.error());
        return Unexpected<int>(kBadInput);
    }
    if (performed->fault) {
        say_diagnostics({*performed->fault});
    }
    return side;
}

std::string name_of(const io::LogLine& line) {
    return line.object.empty() ? line.event : line.object + " " + line.event;
}

std::string at_text(SimTime at) { return number_to_text(at.seconds()) + " s"; }

// The tokens of each place after the first `count` firings of a log; empty where nobody knows the
// net, or the log is none of it.
std::map<std::string, std::uint32_t> marking_after(const scene::Scene* scene, const Side& side,
                                                   std::size_t count, const Arguments& arguments) {
    std::map<std::string, std::uint32_t> out;
    if (scene == nullptr) {
        return out;
    }
    const std::vector<io::LogLine> some(side.lines.begin(),
                                        side.lines.begin() + static_cast<std::ptrdiff_t>(count));
    // A scene's own log has its own names
    const auto log = in_names_of(scene->net, some, side.path, side.scene ? Arguments{} : arguments);
    if (!log) {
        return out;
    }
    const run::Replayed played = run::replay(scene->net, log->firings, {.beat = scene->beat});
    if (played.deviation) {
        say("note: " + side.path + " is no log of " + scene->path +
            ", so that no markings are told");
        return out;
    }
    for (std::uint32_t p = 0; p < played.tokens.size(); ++p) {
        out[std::string(scene->net.place({p}).path)] = played.tokens[p];
    }
    return out;
}

struct Difference {
    std::string place;
    std::uint32_t a = 0, b = 0;
};

std::vector<Difference> differences(const std::map<std::string, std::uint32_t>& a,
                                    const std::map<std::string, std::uint32_t>& b) {
    std::vector<Difference> out;
    for (const auto& [place, tokens] : a) {
        const auto other = b.find(place);
        if (other != b.end() && other->second != tokens) {
            out.push_back({place, tokens, other->second});
        }
    }
    return out;
}

int compare(const Arguments& arguments) {
    std::unique_ptr<const scene::Scene> on;
    if (arguments.given("--on")) {
        io::DiskFiles files;
        auto scene = scene::load(files, arguments.text("--on"));
        if (!scene) {
            say_diagnostics(scene.error());
            return kBadInput;
        }
        on = std::make_unique<const scene::Scene>(std::move(*scene));
    }
    SimTime tolerance;
    if (arguments.given("--tolerance")) {
        const auto t = parse_horizon(arguments.text("--tolerance"), {});
        if (!t || !t->time) {
            say_error("--tolerance: write a time, as 10ms");
            return kBadInput;
        }
        tolerance = *t->time;
    }
    const double rate = on ? on->frame_rate.per_second() : 24;
    const auto first = load_side(arguments.text("a"), arguments, rate);
    if (!first) {
        return first.error();
    }
    const auto second = load_side(arguments.text("b"), arguments, rate);
    if (!second) {
        return second.error();
    }
    const Side& a = *first;
    const Side& b = *second;
    std::map<std::string, std::string> map;  // names of B in the names of A
    for (const std::string& text : arguments.texts("--map")) {
        if (const std::size_t equals = text.rfind('='); equals != std::string::npos) {
            map[text.substr(0, equals)] = text.substr(equals + 1);
        }
    }
    const auto renamed = [&](const io::LogLine& line) {
        const auto found = map.find(name_of(line));
        return found == map.end() ? name_of(line) : found->second;
    };
    const auto same = [&](const io::LogLine& x, const io::LogLine& y) {
        const std::int64_t off = x.at.ticks - y.at.ticks;
        return std::max(off, -off) <= tolerance.ticks && renamed(x) == renamed(y);
    };
    std::size_t n = 0;
    while (n < a.lines.size() && n < b.lines.size() && same(a.lines[n], b.lines[n])) {
        ++n;
    }
    const bool equal = n == a.lines.size() && n == b.lines.size();
    // Markings by the net of each, or by one net for both
    const scene::Scene* of_a = a.scene ? a.scene.get() : on.get();
    const scene::Scene* of_b = b.scene ? b.scene.get() : on.get();
    std::vector<Difference> places;
    std::string common;
    if (!equal && (of_a != nullptr || of_b != nullptr)) {
        const scene::Scene* known = of_a != nullptr ? of_a : of_b;
        const auto before = marking_after(known, of_a != nullptr ? a : b, n, arguments);
        std::vector<std::uint32_t> tokens;
        for (std::uint32_t p = 0; p < known->net.place_count() && !before.empty(); ++p) {
            tokens.push_back(before.at(std::string(known->net.place({p}).path)));
        }
        common = before.empty() ? "" : marking_text(known->net, tokens);
        if (!before.empty() && of_a != nullptr && of_b != nullptr) {
            places =
                differences(marking_after(of_a, a, std::min(n + 1, a.lines.size()), arguments),
                            marking_after(of_b, b, std::min(n + 1, b.lines.size()), arguments));
        }
    }
    if (arguments.given("--json")) {
        io::JsonWriter json;
        json.begin_object();
        json.member("equal", equal).member("common", static_cast<std::int64_t>(n));
        if (!equal) {
            for (const auto& [key, side] : {std::pair{"a", &a}, std::pair{"b", &b}}) {
                if (n < side->lines.size()) {
                    json.key(key).begin_object();
                    json.member("seconds", side->lines[n].at.seconds());
                    json.member("ticks", side->lines[n].at.ticks);
                    json.member("event", name_of(side->lines[n]));
                    json.end_object();
                }
            }
            json.key("places").begin_array();
            for (const Difference& d : places) {
                json.begin_object();
                json.member("place", d.place);
                json.member("a", static_cast<std::int64_t>(d.a));
                json.member("b", static_cast<std::int64_t>(d.b));
                json.end_object();
            }
            json.end_array();
        }
        json.end_object();
        std::puts(json.take().c_str());
        return equal ? kFine : kFailed;
    }
    if (equal) {
        say("the same: " + std::to_string(n) + " firings");
        return kFine;
    }
    say("the same for " + std::to_string(n) + " firings" +
        (n == 0 ? ""
                : ", up to " + at_text(a.lines[n - 1].at) + " (" + name_of(a.lines[n - 1]) + ")") +
        (common.empty() ? "" : "; then: " + common));
    constexpr std::size_t kShown = 5;
    for (const Side* side : {&a, &b}) {
        say(side->path + ":");
        if (n == side->lines.size()) {
            say("  ends here");
        }
        for (std::size_t i = n; i < std::min(n + kShown, side->lines.size()); ++i) {
            say(std::string(i == n ? "> " : "  ") + at_text(side->lines[i].at) + "  " +
                name_of(side->lines[i]));
        }
        if (side->lines.size() > n + kShown) {
            say("  and " + std::to_string(side->lines.size() - n - kShown) + " more");
        }
    }
    if (!places.empty()) {
        say("after that firing (tokens in " + a.path + ", in " + b.path + "):");
        for (const Difference& d : places) {
            say("  " + d.place + "  " + std::to_string(d.a) + "  " + std::to_string(d.b));
        }
    }
    return kFailed;
}

}  // namespace

Command compare_command() {
    std::vector<Option> options = {
        {"a", Value::kText, "A",
         "a log (CSV, or lines TIME OBJECT EVENT), or a scene, which is run", true},
        {"b", Value::kText, "B", "another", true},
        {"--on", Value::kText, "SCENE", "whose logs they are: markings are told, too"},
        {"--tolerance", Value::kText, "T", "times that differ by so much are the same (0)"},
        {"--json", Value::kFlag, "", "as one JSON object on stdout"}};
    return {
        "compare", "where two logs, or the runs of two scenes, part: time, firings, markings",
        "Looks for the first firing in which the two differ, by time or by name, and shows what "
        "each did next.\n"
        "Where the net is known (a scene, or --on), also the marking that both had come to, and "
        "the places\n"
        "that differ after that firing. Exit 1 if they differ.\n\n"
        "Examples:\n"
        "  puppetri compare before.csv after.csv --on shop.pup\n"
        "  puppetri compare shop.pup shop_as_events.pup --map 'come=arrive'\n"
        "  puppetri compare shop.pup till.csv --tolerance 1s",
        with_performing_options(with_log_options(std::move(options))), compare};
}

}  // namespace puppetri::cli
