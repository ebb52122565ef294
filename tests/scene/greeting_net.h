// SPDX-License-Identifier: MIT
// The net under which tests swap techniques: all that changes is how ana greets.
#pragma once
#include <string>

namespace puppetri::test {

// Two figures that greet each other and walk on. `greet` is all that changes.
inline constexpr const char* kGreetingNet = R"(language 1
scene "A greeting"
frames 24 per second, until 16 s
seed 3

cast {
  ana: mannequin { at (-1, 0, 0) m, facing 90 deg }
  rui: mannequin { at (1, 0, 0) m, facing -90 deg }
}

place waits   does ana.idle(lasting: 1 s)     takes 1 .. 2 s  tokens 1
place greets  does ana.GREET                  takes 2400 ms
place answers does rui.bow()                  takes 2 s
place idles   does rui.idle()                 takes 1 s       tokens 1
place goes    does ana.walk(steps: 2)         takes 2 s
place rests   does ana.idle(lasting: 1 s)

meet:   waits -> greets
answer: greets + idles -> goes + answers
on:     goes -> rests
done:   answers -> idles
again:  rests -> waits

rule greets_once greets leads to answers
)";

// With this call for GREET, and definitions (movements, clips) below.
inline std::string greeting_with(const std::string& greet, const std::string& definitions = "") {
    std::string text = kGreetingNet;
    text.replace(text.find("GREET"), 5, greet);
    return text + definitions;
}

}  // namespace puppetri::test
