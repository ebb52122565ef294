// SPDX-License-Identifier: MIT
// What a command of the program is: data, so that its file says everything about it and knows
// nothing of the parser of the command line (which is CLI11, in arguments.cpp alone). To add a
// command: write its file, declare its function in commands.h, name it in the table of
// commands.cpp.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace puppetri::cli {

// What the program answers to the shell.
enum ExitCode : int {
    kFine = 0,
    kFailed = 1,    // refuted, or the run stopped with an error, or a file could not be written
    kBadInput = 2,  // bad usage, or a file with errors
    kUnknown = 3,   // no verdict within the limits
};

enum class Value : std::uint8_t { kFlag, kText, kInteger, kTexts };

struct Option {
    std::string name;  // "--seed", "-o,--output"; without dashes: an argument by position ("scene")
    Value value = Value::kFlag;
    std::string shown;  // what stands for the value in the help: "N", "FILE"
    std::string help;
    bool required = false;
};

// The options that were given, by the last of their names ("--output" for "-o,--output").
class Arguments {
 public:
    bool given(const std::string& name) const { return values_.count(name) != 0; }
    // The (last) value given, or `otherwise`.
    std::string text(const std::string& name, const std::string& otherwise = "") const;
    std::int64_t integer(const std::string& name, std::int64_t otherwise = 0) const;
    std::vector<std::string> texts(const std::string& name) const;

    void set(const std::string& name, std::vector<std::string> values) {
        values_[name] = std::move(values);
    }

 private:
    std::map<std::string, std::vector<std::string>> values_;
};

struct Command {
    std::string name;
    std::string summary;   // one line
    std::string teaching;  // below the options: how to use it, with examples
    std::vector<Option> options;
    int (*run)(const Arguments&) = nullptr;  // gives an ExitCode
};

// Parses the command line, runs the command, gives the exit code. --help and --version are answered
// here.
int run_command_line(int argc, char** argv, const std::vector<Command>& commands);

}  // namespace puppetri::cli
