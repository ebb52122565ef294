// SPDX-License-Identifier: MIT
// What commands that perform a scene share: the options --seed, --for, --events and --witness, and
// the way from a file to a finished performance with progress on the terminal.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "puppetri/scene/perform.h"
#include "puppetri/verdict/witness.h"

namespace puppetri::cli {

// The rows of those options, to be appended to a command's own.
std::vector<Option> with_performing_options(std::vector<Option> options);

// Everything that the command line says about a run, checked; says what is wrong and gives the exit
// code otherwise.
// `--events -` is the caller's business.
Result<scene::PerformOptions, int> perform_options(const Arguments& arguments,
                                                   const scene::Scene& scene);

// A witness of this very net. Says what is wrong and gives the exit code otherwise.
Result<verdict::Witness, int> load_witness(const std::string& path, const net::Net& net);

// A scene and its performance, which looks at the scene.
struct Staged {
    std::unique_ptr<const scene::Scene> scene;
    scene::Performed performed;
};

// Loads the argument "scene" and performs it. Says what is wrong or that it was stopped, and gives
// the exit code then.
Result<Staged, int> load_and_perform(const Arguments& arguments);

// What a program ends with whose run stopped so: equations without a solution are bad input, a net
// that stops has failed.
int status_of_fault(const Diagnostic& fault);

// The ending of a path in small letters with its dot, ".glb"; empty when there is none.
std::string ending_of(const std::string& path);

// "A-B" or "A": frames from 0, first not after last. None for anything else.
struct Frames {
    std::int64_t first = 0, last = 0;
};
std::optional<Frames> parse_frames(const std::string& text);

}  // namespace puppetri::cli
