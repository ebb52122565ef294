// SPDX-License-Identifier: MIT
// `puppetri export SCENE -o FILE`: a take for other programs, as glTF or BVH, with its markers
// beside it.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "commands.h"
#include "performing.h"
#include "puppetri/base/text.h"
#include "puppetri/figure/prop_mesh.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/bvh_writer.h"
#include "puppetri/io/events_json.h"
#include "puppetri/io/gltf_writer.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/io/keyframe_tuples.h"
#include "puppetri/math/rotation.h"
#include "puppetri/render/camera.h"
#include "puppetri/scene/perform.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

constexpr const char* kNoFbx =
    "FBX is not made: its only complete writer is closed. Write a .glb, open it in Blender (File > "
    "Import > glTF 2.0) and "
    "export FBX from there";

// What the command line asks for, checked.
struct Plan {
    std::vector<std::string> outputs;
    io::TakeOptions take;
    bool root_given = false;  // otherwise each format has its own default
    bool rate_given = false;  // otherwise the scene's
    bool clips = false;
    bool camera = false, sets = true;
    io::GltfOptions gltf;
    io::BvhOptions bvh;
};

// Gives what is wrong with the options, one sentence each; empty: the plan is good.
std::vector<std::string> read_options(const Arguments& arguments, Plan& plan) {
    std::vector<std::string> problems;
    const auto choose = [&](const char* option,
                            std::initializer_list<std::string_view> values) -> std::size_t {
        const std::string text = arguments.text(option, std::string(*values.begin()));
        const auto found = std::find(values.begin(), values.end(), text);
        if (found == values.end()) {
            std::string all;
            for (const std::string_view value : values) {
                all += (all.empty() ? "" : ", ") + std::string(value);
            }
            problems.push_back(std::string(option) + " is one of: " + all + "; not \"" + text +
                               "\"");
            return 0;
        }
        return static_cast<std::size_t>(found - values.begin());
    };
    plan.outputs = arguments.texts("--output");
    for (const std::string& path : plan.outputs) {
        const std::string kind = ending_of(path);
        if (kind == ".fbx") {
            problems.push_back(kNoFbx);
        } else if (kind != ".glb" && kind != ".gltf" && kind != ".bvh" && kind != ".tuples") {
            problems.push_back("cannot tell the format of " + path +
                               ": name a file .glb, .gltf, .bvh or .tuples");
        }
    }
    if (arguments.given("--fps")) {
        const auto rate = parse_frame_rate(arguments.text("--fps"));
        if (rate) {
            plan.take.rate = *rate;
            plan.rate_given = true;
        } else {
            problems.push_back("--fps is a number of frames per second: 24, 23.976, 30000/1001");
        }
    }
    if (arguments.given("--frames")) {
        const auto frames = parse_frames(arguments.text("--frames"));
        if (frames) {
            plan.take.frames = io::FrameRange{frames->first, frames->last};
        } else {
            problems.push_back(
                "--frames is a range like 0-479, the first frame not after the last");
        }
    }
    plan.take.handles_frames = arguments.integer("--handles", 0);
    plan.take.loop = arguments.given("--loop");
    plan.root_given = arguments.given("--root");
    plan.take.root = static_cast<io::RootMode>(choose("--root", {"motion", "in-place", "hips"}));
    if (arguments.given("--rest")) {
        plan.take.rest = static_cast<io::RestPose>(choose("--rest", {"t", "a"}));
    }
    plan.take.bone_names = arguments.given("--names");
    plan.clips = choose("--clips", {"whole", "per-movement"}) == 1;
    plan.gltf.names =
        static_cast<io::BoneNames>(choose("--names", {"vrm", "mixamo", "unreal", "rigify"}));
    plan.bvh.names = plan.gltf.names;
    plan.bvh.unit = static_cast<io::LengthUnit>(choose("--unit", {"cm", "m"}));
    plan.camera = arguments.given("--camera");
    plan.sets = !arguments.given("--no-sets");
    if (arguments.given("--reduce")) {
        const auto tolerance_mm = parse_number(arguments.text("--tolerance", "0.5"));
        if (tolerance_mm && *tolerance_mm > 0 && *tolerance_mm <= 1000) {
            plan.gltf.reduce_m = *tolerance_mm / 1000;
        } else {
            problems.push_back(
                "--tolerance is a distance in millimetres, above 0 and at most 1000");
        }
    }
    if (plan.clips && plan.take.loop) {
        problems.push_back(
            "--loop and --clips per-movement exclude each other: a clip is one movement");
    }
    const bool bvh = std::any_of(plan.outputs.begin(), plan.outputs.end(),
                                 [](const std::string& path) { return ending_of(path) == ".bvh"; });
    if (plan.clips && bvh) {
        problems.push_back("--clips per-movement is for glTF: a BVH file holds one motion");
    }
    return problems;
}

// The floor and the roads of the scene. The meshes live as long as this.
struct Sets {
    std::vector<figure::Mesh> meshes;
    std::vector<io::StaticMesh> placed;

    explicit Sets(const std::vector<stage::Set>& sets) {
        meshes.reserve(sets.size());
        for (const stage::Set& set : sets) {
            meshes.push_back(set.kind == stage::SetKind::kRoad
                                 ? figure::make_road_mesh(set.length_m, set.width_m)
                                 : figure::make_floor_mesh(set.length_m, set.width_m));
            placed.push_back(
                {set.name, &meshes.back(), {about_y(set.direction_rad), set.position_world}});
        }
    }
};

std::vector<io::CameraTrack> camera_tracks(const scene::Scene& scene,
                                           const stage::Performance& performance,
                                           const io::Take& take) {
    constexpr double kAspect = 16.0 / 9;
    std::vector<scene::Camera> cameras = scene.cameras;
    if (cameras.empty()) {
        cameras.push_back(render::default_camera(performance));
    }
    const SimTime start = take.rate.time_of(take.first_frame);
    std::vector<io::CameraTrack> tracks;
    for (const scene::Camera& camera : cameras) {
        const render::CameraPath path(camera, performance, kAspect);
        io::CameraTrack track{camera.name, path.view(start).fov_rad, kAspect, {}};
        for (const SimTime at : take.times) {
            track.world_from_camera.push_back(path.view(start + at).world_from_camera);
        }
        tracks.push_back(std::move(track));
    }
    return tracks;
}

struct Written {
    std::string path;
    std::string what;  // "2 figures, 1 clip of 40.00 s"
};

std::string described(const std::vector<io::Take>& takes) {
    char text[96];
    const io::Take& take = takes.front();
    if (takes.size() > 1 || !take.name.empty()) {
        std::snprintf(text, sizeof text, "%zu clips", takes.size());
    } else {
        std::snprintf(text, sizeof text, "%zu %s, %lld frames at %s per second, %.2f s",
                      take.actors.size(), take.actors.size() == 1 ? "figure" : "figures",
                      static_cast<long long>(take.frame_count), to_string(take.rate).c_str(),
                      take.times.back().seconds());
    }
    return text;
}

// The takes that a format wants. In BVH the hips lead, as its readers expect, unless --root says
// otherwise.
Checked<std::vector<io::Take>> takes_for(const Plan& plan, const stage::Performance& performance,
                                         bool bvh) {
    io::TakeOptions options = plan.take;
    if (bvh && !plan.root_given) {
        options.root = io::RootMode::kHips;
    }
    if (plan.clips) {
        return io::sample_clips(performance, options);
    }
    std::vector<io::Take> takes;
    PUP_TRY(io::Take take, io::sample_take(performance, options));
    takes.push_back(std::move(take));
    return takes;
}

Status write_one(const Plan& plan, const scene::Scene& scene, const stage::Performance& performance,
                 const std::string& path, std::vector<Written>& written) {
    const std::string kind = ending_of(path);
    const std::string stem = path.substr(0, path.size() - kind.size());
    PUP_TRY(Ok made, io::make_parent_folders(path));
    static_cast<void>(made);
    if (kind == ".tuples") {
        const auto tuples = io::tuples_of(performance, plan.take.rate);
        PUP_TRY(Ok done, io::write_file(path, notation::make_tuples(tuples)));
        static_cast<void>(done);
        written.push_back({path, std::to_string(tuples.size()) + " keyframes reached"});
        return Ok{};
    }
    PUP_TRY(const std::vector<io::Take> takes, takes_for(plan, performance, kind == ".bvh"));
    if (kind == ".bvh") {
        PUP_TRY(const std::vector<std::string> paths, io::write_bvh(path, takes.front(), plan.bvh));
        for (const std::string& file : paths) {
            written.push_back({file, described(takes)});
        }
    } else {
        const Sets sets(plan.sets && !plan.clips ? scene.play.cast.sets
                                                 : std::vector<stage::Set>());
        const auto cameras = plan.camera && !plan.clips
                                 ? camera_tracks(scene, performance, takes.front())
                                 : std::vector<io::CameraTrack>();
        PUP_TRY(Ok done, io::write_gltf(path, {takes, sets.placed, cameras}, plan.gltf));
        static_cast<void>(done);
        written.push_back({path, described(takes)});
    }
    const std::string events = stem + ".events.json";
    const bool known = std::any_of(written.begin(), written.end(),
                                   [&](const Written& w) { return w.path == events; });
    if (!known) {
        PUP_TRY(Ok done, io::write_file(events, io::make_events_json(takes, scene.title)));
        static_cast<void>(done);
        std::size_t count = 0;
        for (const io::Take& take : takes) {
            count += take.events.size();
        }
        written.push_back({events, std::to_string(count) + " markers"});
    }
    return Ok{};
}

void tell(const std::vector<Written>& written, const scene::Scene& scene,
          const scene::Performed& performed, bool as_json) {
    if (!as_json) {
        for (const Written& file : written) {
            std::printf("%s: %s\n", file.path.c_str(), file.what.c_str());
        }
        return;
    }
    io::JsonWriter json;
    json.begin_object()
        .member("scene", scene.title)
        .member("seed", static_cast<std::int64_t>(performed.seed));
    json.member("seconds", performed.end.seconds());
    json.member("firings", static_cast<std::int64_t>(performed.firings)).key("files").begin_array();
    for (const Written& file : written) {
        json.begin_object().member("path", file.path).member("what", file.what).end_object();
    }
    json.end_array().end_object();
    std::printf("%s\n", json.text().c_str());
}

int run(const Arguments& arguments) {
    Plan plan;
    const std::vector<std::string> problems = read_options(arguments, plan);
    for (const std::string& problem : problems) {
        say_error(problem);
    }
    if (!problems.empty()) {
        return kBadInput;
    }
    const auto staged = load_and_perform(arguments);
    if (!staged) {
        return staged.error();
    }
    const scene::Scene& scene = *staged->scene;
    if (!plan.rate_given) {
        plan.take.rate = {scene.frame_rate.numerator, scene.frame_rate.denominator};
    }
    plan.gltf.title = scene.title;
    std::vector<Written> written;
    for (const std::string& path : plan.outputs) {
        const Status status = write_one(plan, scene, *staged->performed.performance, path, written);
        if (!status) {
            say_diagnostics(status.error());
            const std::string& code = status.error().front().code;
            const bool disk = code == "cannot-write" || code == "disk-full";
            return disk ? kFailed : kBadInput;
        }
    }
    tell(written, scene, staged->performed, arguments.given("--json"));
    return kFine;
}

}  // namespace

Command export_command() {
    return {
        "export", "write a take for other programs: glTF, BVH, markers, tuples",
        "The ending of FILE says the format: .glb, .gltf (with a .bin beside it), .bvh (one file "
        "per figure:\n"
        "NAME_ana.bvh), .tuples (which movement ended when, FRAME OBJECT EVENT). The markers (foot "
        "strikes,\n"
        "releases, catches) also go to NAME.events.json.\n"
        "FBX is not made: its only complete writer is closed. Write a .glb, open it in Blender\n"
        "(File > Import > glTF 2.0) and export FBX from there.\n\n"
        "Examples:\n"
        "  puppetri export ball.pup -o out/ball.glb                       one animation for all "
        "figures\n"
        "  puppetri export ball.pup -o ana.glb --clips per-movement       one clip per movement, "
        "for engines\n"
        "  puppetri export walk.pup -o walk.glb --loop --root in-place    one period\n"
        "  puppetri export ball.pup -o ball.bvh --fps 120 --unit m        motion capture",
        with_performing_options(
            {{"scene", Value::kText, "SCENE", "the scene to perform", true},
             {"-o,--output", Value::kTexts, "FILE", "where to; may be given more than once", true},
             {"--fps", Value::kText, "RATE",
              "keys per second, 23.976 to 120 (default: the scene's)"},
             {"--frames", Value::kText, "A-B",
              "only these frames, both inside; frame A becomes frame 0"},
             {"--handles", Value::kInteger, "N",
              "N more frames before and after --frames, where there are any"},
             {"--loop", Value::kFlag, "",
              "one period: the last key equals the first but for the root's travel"},
             {"--clips", Value::kText, "HOW", "whole (default) or per-movement"},
             {"--root", Value::kText, "MODE",
              "motion (default), in-place, or hips (default for BVH)"},
             {"--rest", Value::kText, "POSE",
              "rest pose of humanoids: t or a (default: t, of characters that of their file)"},
             {"--names", Value::kText, "SET",
              "bones named as in vrm, mixamo, unreal or rigify (default: vrm, of characters as in "
              "their file)"},
             {"--unit", Value::kText, "UNIT", "lengths in BVH: cm (default) or m"},
             {"--reduce", Value::kFlag, "", "glTF: leave out keys that interpolation gives back"},
             {"--tolerance", Value::kText, "MM",
              "of --reduce: joints move at most this far (default: 0.5)"},
             {"--camera", Value::kFlag, "", "glTF: with the scene's cameras"},
             {"--no-sets", Value::kFlag, "", "glTF: without floors and roads"},
             {"--json", Value::kFlag, "", "the summary as JSON on stdout"}}),
        run};
}

}  // namespace puppetri::cli
