// SPDX-License-Identifier: MIT
// Settings: parameters of a scene changed from outside, as if its author had written other values.
// They are edits of the text, so that whatever a value may be and whatever is wrong with it is told
// as for any scene.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"

namespace puppetri::scene {

// `path` is written as the scene's author would name it:
//   a.out          the argument `out` of the instance `a` (of a `use` of the scene file)
//   level          the initial value of the datum `level`
//   chair.takes    how long tokens stay in the place `chair`
//   chair.tokens   how many tokens it has at the start
//   seed           the scene's
// `value` is an expression of the language: "3", "12 s", "exponential(5 s)".
struct Setting {
    std::string path;
    std::string value;
};

// Gives   the changed text of the file.
// Fails   "unknown-setting", naming what could be meant; with the text's own defects; with those of
//         a value that does not parse.
Checked<std::string> with_settings(std::string_view text, std::string_view filename,
                                   std::span<const Setting> settings);

}  // namespace puppetri::scene
