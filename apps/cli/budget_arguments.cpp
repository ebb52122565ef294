// SPDX-License-Identifier: MIT
#include "budget_arguments.h"

#include <cstdio>

#include "interrupt.h"
#include "puppetri/base/text.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

struct Unit {
    const char* name;
    double factor;
};
constexpr double kMebi = 1024.0 * 1024.0;
constexpr Unit kTimes[] = {{"", 1}, {"s", 1}, {"ms", 0.001}, {"min", 60}, {"h", 3600}};
constexpr Unit kSizes[] = {{"", kMebi}, {"M", kMebi}, {"G", 1024 * kMebi}};

// A number and the unit right behind it.
template <std::size_t kCount>
std::optional<double> parse_quantity(const std::string& text, const Unit (&units)[kCount]) {
    const std::size_t end = text.find_first_not_of("0123456789.");
    const std::optional<double> number = parse_number(text.substr(0, end));
    const std::string name = end == std::string::npos ? "" : text.substr(end);
    for (const Unit& unit : units) {
        if (number && name == unit.name) {
            return *number * unit.factor;
        }
    }
    return std::nullopt;
}

std::string rounded(double x, const char* unit) {
    char text[40];
    std::snprintf(text, sizeof text, x < 10 ? "%.1f%s" : "%.0f%s", x, unit);
    return text;
}

}  // namespace

std::vector<Option> budget_options() {
    return {{"--time", Value::kText, "T", "give up after so long (60s, 5min; default 60s)", false},
            {"--memory", Value::kText, "M", "hold at most so much (500M, 2G; default 4G)", false},
            {"--threads", Value::kInteger, "N", "work on so many cores; the answers are the same",
             false}};
}

std::unique_ptr<WatchedBudget> WatchedBudget::from(const Arguments& arguments) {
    std::unique_ptr<WatchedBudget> made(new WatchedBudget);
    proof::Budget& budget = made->budget_;
    if (arguments.given("--time")) {
        const auto seconds = parse_quantity(arguments.text("--time"), kTimes);
        if (!seconds) {
            say_error("--time: write 30s, 5min or 1h");
            return nullptr;
        }
        budget.seconds = *seconds;
    }
    if (arguments.given("--memory")) {
        const auto bytes = parse_quantity(arguments.text("--memory"), kSizes);
        if (!bytes || *bytes > 1e15) {
            say_error("--memory: write 500M or 2G");
            return nullptr;
        }
        budget.bytes = static_cast<std::uint64_t>(*bytes);
    }
    const std::int64_t threads = arguments.integer("--threads", 1);
    if (threads < 1 || threads > 1024) {
        say_error("--threads: write a number from 1 to 1024");
        return nullptr;
    }
    budget.threads = static_cast<unsigned>(threads);
    budget.cancelled = &made->cancelled_;
    budget.context = made.get();
    budget.progress = show;
    return made;
}

WatchedBudget::~WatchedBudget() { wipe(); }

void WatchedBudget::wipe() {
    if (drawn_) {
        std::fputs("\r\033[K", stderr);
        drawn_ = false;
    }
}

void WatchedBudget::show(void* context, const proof::Progress& p) {
    auto* self = static_cast<WatchedBudget*>(context);
    if (interrupted()) {
        self->cancelled_ = true;
    }
    if (!on_terminal()) {
        return;
    }
    const double rate = p.seconds > 0 ? static_cast<double>(p.edges) / p.seconds : 0;
    const std::string line =
        std::string(p.method) + ": " + short_number(static_cast<double>(p.states)) + " states, " +
        short_number(rate) + " edges/s, " + short_bytes(static_cast<double>(p.bytes)) + ", " +
        rounded(p.seconds, " s");
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    self->drawn_ = true;
}

std::string short_number(double x) {
    return x < 1000  ? std::to_string(static_cast<int>(x))
           : x < 1e6 ? rounded(x / 1e3, " k")
           : x < 1e9 ? rounded(x / 1e6, " M")
                     : rounded(x / 1e9, " G");
}

std::string short_bytes(double bytes) {
    return bytes < 1024 * kMebi ? rounded(bytes / kMebi, " MiB")
                                : rounded(bytes / (1024 * kMebi), " GiB");
}

}  // namespace puppetri::cli
