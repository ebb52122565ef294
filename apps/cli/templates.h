// SPDX-License-Identifier: MIT
// The scenes of `puppetri new`: examples of the project, put into the program when it is built.
#pragma once
#include <span>
#include <string_view>

namespace puppetri::cli {

struct TemplateFile {
    std::string_view of;    // the template: "ball"
    std::string_view name;  // "ball.pup", "walk.pup"
    std::string_view text;
};

// The main file of a template bears its name; files of one template stand together, the main one
// first.
std::span<const TemplateFile> template_files();

}  // namespace puppetri::cli
