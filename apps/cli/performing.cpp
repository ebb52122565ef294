// SPDX-License-Identifier: MIT
#include "performing.h"

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "horizon.h"
#include "interrupt.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/witness_file.h"
#include "puppetri/scene/events.h"
#include "scene_files.h"
#include "terminal.h"

namespace puppetri::cli {

std::vector<Option> with_performing_options(std::vector<Option> options) {
    options.push_back({"--seed", Value::kInteger, "N", "instead of the scene's seed"});
    options.push_back({"--for", Value::kText, "HOW LONG",
                       "a time (40s), frames (960f) or firings (1000x), instead of the scene's"});
    options.push_back(
        {"--events", Value::kText, "FILE", "outside events from a list or a recorded session"});
    options.push_back({"--witness", Value::kText, "FILE",
                       "perform the run of a witness that `puppetri prove` has written"});
    options.push_back(file_option());
    return options;
}

Result<verdict::Witness, int> load_witness(const std::string& path, const net::Net& net) {
    const auto text = io::DiskFiles().read(path);
    if (!text) {
        say_error(path + ": " + text.error().message);
        return Unexpected<int>(kBadInput);
    }
    auto witness = io::read_witness(*text, path);
    if (!witness) {
        say_diagnostics(witness.error());
        return Unexpected<int>(kBadInput);
    }
    if (witness->net_hash != net.hash()) {
        say_error(path + " belongs to another net: the scene has changed since; prove it again");
        return Unexpected<int>(kBadInput);
    }
    for (const verdict::Witness::Event& e : witness->events) {
        if (!net.find_event(e.path).valid()) {
            say_error(path + ": there is no event " + e.path);
            return Unexpected<int>(kBadInput);
        }
    }
    return std::move(*witness);
}

Result<scene::PerformOptions, int> perform_options(const Arguments& arguments,
                                                   const scene::Scene& scene) {
    scene::PerformOptions options;
    if (arguments.given("--seed")) {
        const std::int64_t seed = arguments.integer("--seed");
        if (seed < 0) {
            say_error("a seed is 0 or more");
            return Unexpected<int>(kBadInput);
        }
        options.seed = static_cast<std::uint64_t>(seed);
    }
    if (arguments.given("--for")) {
        const auto horizon = parse_horizon(arguments.text("--for"), scene.frame_rate);
        if (!horizon) {
            say_error("--for: " + horizon.error());
            return Unexpected<int>(kBadInput);
        }
        options.horizon = *horizon;
    }
    if (arguments.given("--witness")) {
        auto witness = load_witness(arguments.text("--witness"), scene.net);
        if (!witness) {
            return Unexpected<int>(witness.error());
        }
        if (arguments.given("--seed") || arguments.given("--events")) {
            say_error("a witness brings its own seed and events: leave out --seed and --events");
            return Unexpected<int>(kBadInput);
        }
        options.seed = witness->seed;
        options.script = std::move(witness->choices);
        for (const verdict::Witness::Event& e : witness->events) {
            options.events.push_back({e.at, scene.net.find_event(e.path)});
        }
        if (!options.horizon.given()) {
            // Some time to look at what it comes to.
            constexpr SimTime kAfter{2 * kTicksPerSecond};
            options.horizon.time = witness->until + kAfter;
        }
    }
    const std::string events = arguments.text("--events");
    if (!events.empty() && events != "-") {
        const auto text = io::DiskFiles().read(events);
        if (!text) {
            say_error(events + ": " + text.error().message);
            return Unexpected<int>(kBadInput);
        }
        scene::EventList list =
            scene::parse_event_list(*text, events, scene::event_names(scene.net));
        say_diagnostics(list.diagnostics);
        if (has_errors(list.diagnostics)) {
            return Unexpected<int>(kBadInput);
        }
        options.events = std::move(list.events);
        if (list.seed && !options.seed) {
            options.seed = list.seed;
        }
    }
    return options;
}

Result<Staged, int> load_and_perform(const Arguments& arguments) {
    io::DiskFiles files;
    if (!use_files(arguments, files)) {
        return Unexpected<int>(kBadInput);
    }
    auto scene = scene::load(files, arguments.text("scene"));
    if (!scene) {
        say_diagnostics(scene.error());
        return Unexpected<int>(kBadInput);
    }
    Staged staged{std::make_unique<const scene::Scene>(std::move(*scene)), {}};
    say_diagnostics(staged.scene->notes);
    if (arguments.text("--events") == "-") {
        say_error(
            "--events - follows a person in real time: record the session with `puppetri run "
            "--record`, then name its "
            "file here");
        return Unexpected<int>(kBadInput);
    }
    auto options = perform_options(arguments, *staged.scene);
    if (!options) {
        return Unexpected<int>(options.error());
    }
    Progress progress("performing");
    options->context = &progress;
    options->go_on = [](void* context, double share_done) {
        static_cast<Progress*>(context)->show(share_done);
        return !interrupted();
    };
    auto performed = scene::perform(*staged.scene, *options);
    if (!performed) {
        say_diagnostics(performed.error());
        return Unexpected<int>(kBadInput);
    }
    if (performed->interrupted || interrupted()) {
        say("stopped: nothing was written");
        return Unexpected<int>(kFailed);
    }
    say_diagnostics(performed->notes);
    if (performed->fault) {
        say_diagnostics({*performed->fault});
        return Unexpected<int>(status_of_fault(*performed->fault));
    }
    staged.performed = std::move(*performed);
    return staged;
}

int status_of_fault(const Diagnostic& fault) {
    for (const char* code : {"equations-blow-up", "crossings-accumulate", "not-baked",
                             "stale-course", "no-sundials"}) {
        if (fault.code == code) {
            return kBadInput;
        }
    }
    return kFailed;
}

std::string ending_of(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    std::string text = dot == std::string::npos || path.find('/', dot) != std::string::npos
                           ? ""
                           : path.substr(dot);
    for (char& c : text) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
    }
    return text;
}

std::optional<Frames> parse_frames(const std::string& text) {
    const std::size_t dash = text.find('-');
    const std::string first = text.substr(0, dash),
                      last = dash == std::string::npos ? first : text.substr(dash + 1);
    const auto number = [](const std::string& digits) -> std::optional<std::int64_t> {
        if (digits.empty() || digits.size() > 9 ||
            digits.find_first_not_of("0123456789") != std::string::npos) {
            return std::nullopt;
        }
        return std::atoll(digits.c_str());
    };
    const auto a = number(first), b = number(last);
    if (!a || !b || *b < *a) {
        return std::nullopt;
    }
    return Frames{*a, *b};
}

}  // namespace puppetri::cli
