// SPDX-License-Identifier: MIT
// Talking to people: messages and progress on stderr, colours only on a terminal and never under
// NO_COLOR. Machine output goes to stdout by its command.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"

namespace puppetri::cli {

// Whether stderr takes ANSI colours: it is a terminal, NO_COLOR is unset or empty, TERM is not
// "dumb".
bool colours();
// Whether stderr is a terminal, so that a line can be redrawn.
bool on_terminal();

// One line on stderr, with a newline.
void say(std::string_view line);
// "puppetri: error: MESSAGE" on stderr.
void say_error(std::string_view message);

// All diagnostics on stderr, each with its source line, which is read from the named file.
void say_diagnostics(const Diagnostics& list);

// The bar of a long work, redrawn at most ten times a second on a terminal, silent elsewhere: share
// done, time left.
class Progress {
 public:
    explicit Progress(std::string what);
    ~Progress();  // wipes the line
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // done in [0, 1]; detail is appended ("frame 120 of 960").
    void show(double done, std::string_view detail = "");

 private:
    std::string what_;
    double begin_s_ = 0;
    double shown_s_ = -1;
    bool drawn_ = false;
};

// Text inside JSON quotes, without the quotes.
std::string json_escaped(std::string_view text);

// {"code": ..., "severity": ..., "file": ..., "line": ..., "column": ..., "length": ..., "element":
// ..., "message": ..., "remedy": ...}
std::string to_json(const Diagnostic& d);

}  // namespace puppetri::cli
