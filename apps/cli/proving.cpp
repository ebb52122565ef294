// SPDX-License-Identifier: MIT
#include "proving.h"

#include <chrono>
#include <cstdio>

#include "interrupt.h"
#include "puppetri/base/text.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/load_net.h"
#include "puppetri/notation/foreign_file.h"
#include "scene_files.h"
#include "terminal.h"

namespace puppetri::cli {

std::vector<Option> with_proving_options(std::vector<Option> options) {
    options.push_back({"--time", Value::kText, "T",
                       "give up after so long, with what is known then (60s, 5min; default 60s)",
                       false});
    options.push_back(
        {"--memory", Value::kText, "M", "hold at most so much (500M, 2G; default 4G)", false});
    options.push_back({"--threads", Value::kInteger, "N",
                       "explore on so many cores where a method can; the verdicts are the same",
                       false});
    options.push_back({"--events-at-most", Value::kInteger, "N",
                       "let the outside make events occur at most so often (default: any number)",
                       false});
    options.push_back({"-o,--output", Value::kText, "FOLDER",
                       "where witnesses are written (default: out)", false});
    options.push_back(file_option());
    return options;
}

Result<Subject, int> load_subject(const std::string& path, const Arguments& arguments) {
    Subject subject;
    if (notation::is_scene_file(path)) {
        io::DiskFiles files;
        if (!use_files(arguments, files)) {
            return Unexpected<int>(kBadInput);
        }
        auto scene = scene::load(files, path);
        if (!scene) {
            say_diagnostics(scene.error());
            return Unexpected<int>(kBadInput);
        }
        subject.scene = std::make_unique<const scene::Scene>(std::move(*scene));
        say_diagnostics(subject.scene->notes);
        return subject;
    }
    auto file = io::load_net(path);
    if (!file) {
        say_diagnostics(file.error());
        return Unexpected<int>(kBadInput);
    }
    auto net = net::compile(file->draft);
    if (!net) {
        say_diagnostics(net.error());
        return Unexpected<int>(kBadInput);
    }
    subject.file = std::make_unique<const io::NetFile>(std::move(*file));
    subject.net = std::make_unique<const net::Net>(std::move(*net));
    return subject;
}

namespace {

// A number and the letters behind it.
std::optional<std::pair<double, std::string>> number_and_unit(const std::string& text) {
    std::size_t end = 0;
    while (end < text.size() && (text[end] == '.' || (text[end] >= '0' && text[end] <= '9'))) {
        ++end;
    }
    const auto number = parse_number(text.substr(0, end));
    if (!number) {
        return std::nullopt;
    }
    std::size_t unit = end;
    while (unit < text.size() && text[unit] == ' ') {
        ++unit;
    }
    return std::pair{*number, text.substr(unit)};
}

}  // namespace

std::optional<double> parse_seconds(const std::string& text) {
    const auto parts = number_and_unit(text);
    if (!parts) {
        return std::nullopt;
    }
    const auto& [x, unit] = *parts;
    return unit.empty() || unit == "s" ? std::optional(x)
           : unit == "ms"              ? std::optional(x / 1000)
           : unit == "min"             ? std::optional(x * 60)
           : unit == "h"               ? std::optional(x * 3600)
                                       : std::nullopt;
}

std::optional<std::uint64_t> parse_bytes(const std::string& text) {
    const auto parts = number_and_unit(text);
    if (!parts) {
        return std::nullopt;
    }
    const auto& [x, unit] = *parts;
    const char letter = unit.empty() ? 'M' : unit[0];
    if (unit.size() > 3 || (unit.size() > 1 && unit.substr(1) != "B" && unit.substr(1) != "iB")) {
        return std::nullopt;
    }
    const double factor = letter == 'k' || letter == 'K' ? 1024.0
                          : letter == 'M'                ? 1024.0 * 1024
                          : letter == 'G'                ? 1024.0 * 1024 * 1024
                                                         : 0;
    const double bytes = x * factor;
    return factor == 0 || bytes < 1 || bytes > 1e15
               ? std::nullopt
               : std::optional(static_cast<std::uint64_t>(bytes));
}

Result<verdict::ProveOptions, int> proving_options(const Arguments& arguments) {
    verdict::ProveOptions options;
    const auto wrong = [](const char* what) {
        say_error(what);
        return Unexpected<int>(kBadInput);
    };
    if (arguments.given("--time")) {
        const auto seconds = parse_seconds(arguments.text("--time"));
        if (!seconds) {
            return wrong("--time: write 30s, 5min or 1h");
        }
        options.budget.seconds = *seconds;
    }
    if (arguments.given("--memory")) {
        const auto bytes = parse_bytes(arguments.text("--memory"));
        if (!bytes) {
            return wrong("--memory: write 500M or 2G");
        }
        options.budget.bytes = *bytes;
    }
    if (arguments.given("--threads")) {
        const std::int64_t threads = arguments.integer("--threads");
        if (threads < 1 || threads > 1024) {
            return wrong("--threads: write a number from 1 to 1024");
        }
        options.budget.threads = static_cast<unsigned>(threads);
    }
    if (arguments.given("--events-at-most")) {
        const std::int64_t events = arguments.integer("--events-at-most");
        if (events < 0 || events > 1'000'000) {
            return wrong("--events-at-most: write a number from 0 to 1000000");
        }
        options.outside_events = static_cast<std::uint32_t>(events);
    }
    return options;
}

struct ProvingProgress::Data {
    std::atomic<bool> cancelled{false};
    double shown_s = -1;
    bool drawn = false;
};

double clock_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

namespace {

std::string short_number(double x) {
    return x >= 1e9   ? number_to_text_fixed(x / 1e9, 1) + " G"
           : x >= 1e6 ? number_to_text_fixed(x / 1e6, 1) + " M"
           : x >= 1e4 ? number_to_text_fixed(x / 1e3, 0) + " k"
                      : number_to_text_fixed(x, 0);
}

}  // namespace

ProvingProgress::ProvingProgress(verdict::ProveOptions& options) : data_(std::make_unique<Data>()) {
    options.budget.cancelled = &data_->cancelled;
    options.budget.context = data_.get();
    options.budget.progress = [](void* context, const proof::Progress& p) {
        Data& data = *static_cast<Data*>(context);
        const double now = clock_s();
        if (!on_terminal() || now - data.shown_s < 0.1) {
            return;
        }
        data.shown_s = now;
        data.drawn = true;
        const double rate = p.seconds > 0 ? static_cast<double>(p.states) / p.seconds : 0;
        std::fprintf(stderr, "\r\033[K%s: %s states, %s edges, %s/s, %sB, %s waiting", p.method,
                     short_number(static_cast<double>(p.states)).c_str(),
                     short_number(static_cast<double>(p.edges)).c_str(), short_number(rate).c_str(),
                     short_number(static_cast<double>(p.bytes)).c_str(),
                     short_number(static_cast<double>(p.waiting)).c_str());
        std::fflush(stderr);
    };
    set_when_interrupted(&data_->cancelled);
}

ProvingProgress::~ProvingProgress() {
    set_when_interrupted(nullptr);
    if (data_->drawn) {
        std::fputs("\r\033[K", stderr);
    }
}

std::vector<verdict::Verdict> prove_subject(const Subject& subject,
                                            const verdict::ProveOptions& options) {
    return subject.scene ? verdict::prove(*subject.scene, options)
                         : verdict::prove(subject.file->draft, *subject.net, options);
}

std::string witness_path(const std::string& folder, const std::string& rule) {
    std::string name = rule;
    for (char& c : name) {
        const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-' ||
                          static_cast<unsigned char>(c) >= 0x80;
        c = good ? c : '_';
    }
    if (name.empty() || name[0] == '.') {
        name = std::string(1, '_') + name;
    }
    return folder + "/" + name + ".witness.json";
}

std::string seconds_text(double seconds) {
    return seconds >= 10     ? number_to_text_fixed(seconds, 0) + " s"
           : seconds >= 0.1  ? number_to_text_fixed(seconds, 1) + " s"
           : seconds >= 0.01 ? number_to_text_fixed(seconds * 1000, 0) + " ms"
                             : number_to_text_fixed(seconds * 1000, 1) + " ms";
}

}  // namespace puppetri::cli
