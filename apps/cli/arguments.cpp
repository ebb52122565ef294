// SPDX-License-Identifier: MIT
// The command line, parsed by CLI11: the only file that knows it.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <list>
#include <optional>

#include "command.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

// The name under which a command asks for an option: the last of "-o,--output".
std::string key_of(const Option& option) {
    const std::size_t comma = option.name.rfind(',');
    return comma == std::string::npos ? option.name : option.name.substr(comma + 1);
}

// None where it is no number, or does not fit: what is too large must not become another one.
std::optional<std::int64_t> whole_number(const std::string& text) {
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [at, problem] = std::from_chars(text.data(), end, value);
    return problem == std::errc{} && at == end && !text.empty() ? std::optional(value)
                                                                : std::nullopt;
}

struct Bound {
    const Option* option = nullptr;
    CLI::Option* cli = nullptr;
    std::vector<std::string> values;
    bool flag = false;
};

struct BoundCommand {
    const Command* command = nullptr;
    CLI::App* app = nullptr;
    std::list<Bound> options;  // a list: CLI11 keeps references
};

void bind(CLI::App& app, BoundCommand& out) {
    for (const Option& option : out.command->options) {
        Bound& b = out.options.emplace_back();
        b.option = &option;
        if (option.value == Value::kFlag) {
            b.cli = app.add_flag(option.name, b.flag, option.help);
            continue;
        }
        b.cli = app.add_option(option.name, b.values, option.help)->option_text(option.shown);
        b.cli->required(option.required);
        b.cli->expected(1);
        b.cli->allow_extra_args(false);
        b.cli->multi_option_policy(option.value == Value::kTexts
                                       ? CLI::MultiOptionPolicy::TakeAll
                                       : CLI::MultiOptionPolicy::TakeLast);
        if (option.value == Value::kTexts) {
            b.cli->expected(1, -1);
            b.cli->allow_extra_args(option.name.front() != '-');  // several by position
        }
        if (option.value == Value::kInteger) {
            b.cli->check([](const std::string& text) {
                return whole_number(text) ? std::string()
                                          : text + " is no whole number from -2^63 to 2^63 - 1";
            });
        }
    }
}

Arguments arguments_of(const BoundCommand& bound) {
    Arguments out;
    for (const Bound& b : bound.options) {
        if (b.cli->count() > 0) {
            out.set(key_of(*b.option), b.values);
        }
    }
    return out;
}

}  // namespace

std::string Arguments::text(const std::string& name, const std::string& otherwise) const {
    const auto at = values_.find(name);
    return at == values_.end() || at->second.empty() ? otherwise : at->second.back();
}

std::int64_t Arguments::integer(const std::string& name, std::int64_t otherwise) const {
    const auto at = values_.find(name);
    if (at == values_.end() || at->second.empty()) {
        return otherwise;
    }
    return whole_number(at->second.back()).value_or(otherwise);
}

std::vector<std::string> Arguments::texts(const std::string& name) const {
    const auto at = values_.find(name);
    return at == values_.end() ? std::vector<std::string>{} : at->second;
}

int run_command_line(int argc, char** argv, const std::vector<Command>& commands) {
    CLI::App app{
        "Puppetri writes the interplay of figures as a net and performs it.\n"
        "Start with `puppetri new NAME`, look with `puppetri run NAME.pup`."};
    app.name("puppetri");
    app.set_version_flag("--version", std::string("puppetri ") + PUPPETRI_VERSION);
    app.require_subcommand(1);
    app.footer(
        "`puppetri COMMAND --help` explains a command, with examples.\n"
        "Exit codes: 0 fine, 1 failed or refuted, 2 bad input or usage, 3 unknown.");
    std::list<BoundCommand> bound;
    for (const Command& command : commands) {
        BoundCommand& b = bound.emplace_back();
        b.command = &command;
        b.app = app.add_subcommand(command.name, command.summary);
        b.app->footer(command.teaching);
        bind(*b.app, b);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        return code == 0 ? kFine : kBadInput;
    }
    for (const BoundCommand& b : bound) {
        if (b.app->parsed()) {
            return b.command->run(arguments_of(b));
        }
    }
    return kBadInput;
}

}  // namespace puppetri::cli
