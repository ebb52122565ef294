// SPDX-License-Identifier: MIT
// A scene in memory: a cast, one compiled net with every module instantiated, the actions that its
// places ask of the stage, rules and cameras. Made from files that have been checked as a whole:
// parsed, names resolved, units and types compared with the signatures of movements. Immutable;
// runs and performances are made from it.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/frame_rate.h"
#include "puppetri/base/time.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/net/net.h"
#include "puppetri/run/equations.h"
#include "puppetri/scene/file_source.h"
#include "puppetri/stage/sensors.h"
#include "puppetri/stage/stage.h"

namespace puppetri::scene {

using puppetri::FrameRate;  // base/frame_rate.h

// `camera main { at (0, 1.6, 8) m, keeps ana and rui in view, moves with them }`
struct Camera {
    std::string name;
    Vec3 at_world{0, 1.6, 8};
    std::optional<Vec3> looking_at_world;
    std::vector<stage::ActorIndex> keeps;
    bool moves_with_them = false;
    std::optional<double> fov_rad;  // vertical
};

// Where a run ends: `until frame 960`, `until 40 s`, `until 500 firings`.
struct Horizon {
    std::optional<SimTime> time;
    std::optional<std::uint64_t> firings;
    bool given() const { return time.has_value() || firings.has_value(); }
};

struct Scene {
    std::string title;
    std::string path;  // of its file
    FrameRate frame_rate;
    Horizon horizon;
    std::uint64_t seed = 1;
    SimTime beat{kTicksPerSecond};               // of a net without time
    stage::Play play;                            // the cast, and one action per place with `does`
    net::NetDraft draft;                         // as elaborated, rules and named states included
    net::Net net;                                // compiled from it
    std::vector<run::EquationSystem> equations;  // beside the net; props and joints follow them
    std::vector<stage::Sensor> sensors;
    std::vector<Camera> cameras;
    Diagnostics notes;  // warnings and notes: no errors

    const std::vector<net::Rule>& rules() const { return net.declarations().rules; }
    const std::vector<net::TimeQuestion>& questions() const { return net.declarations().questions; }
};

// Reads a scene and all that it imports.
// Fails   with every defect of every file, in order of file and position; nothing half-loaded is
// given.
//
// `movements` of the program that embeds this (motion/host_movement.h) may be called by their names
// like those of the library; what a file itself defines comes first.
Checked<Scene> load(FileSource& files, const std::string& path,
                    std::span<const motion::OwnMovementPtr> movements = {});

// Looks for defects only. A file without a scene line is a library of nets: each is tried with
// stand-ins for its parameters; so is each net of a scene that nobody uses. Gives   errors,
// warnings and notes in order of file and position.
Diagnostics check(FileSource& files, const std::string& path,
                  std::span<const motion::OwnMovementPtr> movements = {});

}  // namespace puppetri::scene
