// SPDX-License-Identifier: MIT
#include "convert_motion.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "puppetri/base/frame_rate.h"
#include "puppetri/base/text.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/io/character_reader.h"
#include "puppetri/io/clip_performer.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/gltf_document.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/io/keyframe_tuples.h"
#include "puppetri/motion/retarget.h"
#include "terminal.h"

namespace puppetri::cli {

std::vector<Option> motion_options() {
    return {{"--scale", Value::kText, "S",
             "motion: a length of the file times S is metres (BVH: 0.01 unless said)", false},
            {"--clip", Value::kTexts, "NAME", "motion: only this clip; may be given again", false},
            {"--fps", Value::kText, "RATE", "motion: frames per second of what is sampled", false},
            {"--onto", Value::kText, "FIGURE",
             "motion: carried to another humanoid: a .glb, .gltf or .vrm file, or the height of a "
             "mannequin in metres",
             false},
            {"--unit", Value::kText, "UNIT", "BVH out: cm or m", false},
            {"--names", Value::kText, "SET", "bones out: vrm, mixamo, unreal or rigify", false},
            {"--json", Value::kFlag, "", "motion: say what was written as JSON", false}};
}

std::optional<io::ClipReadOptions> motion_read_options(const Arguments& arguments) {
    io::ClipReadOptions options;
    if (arguments.given("--scale")) {
        const std::optional<double> scale = parse_number(arguments.text("--scale"));
        if (!scale || !(*scale > 1e-9 && *scale < 1e9)) {
            say_error("--scale is a positive number: the metres of one unit of the file");
            return std::nullopt;
        }
        options.scale = *scale;
    }
    return options;
}

std::optional<io::ClipWriteOptions> motion_write_options(const Arguments& arguments) {
    io::ClipWriteOptions options;
    if (arguments.given("--fps")) {
        const std::optional<FrameRate> rate = parse_frame_rate(arguments.text("--fps"));
        if (!rate) {
            say_error("--fps is a number of frames per second: 24, 23.976, 30000/1001");
            return std::nullopt;
        }
        options.rate_hz = rate->per_second();
    }
    const std::string unit = arguments.text("--unit", "cm");
    if (unit != "cm" && unit != "m") {
        say_error("--unit is one of: cm, m; not \"" + unit + "\"");
        return std::nullopt;
    }
    options.metres = unit == "m";
    const std::string names = arguments.text("--names", "vrm");
    const std::optional<io::BoneNames> set = io::parse_bone_names(names);
    if (!set) {
        say_error("--names is one of: vrm, mixamo, unreal, rigify; not \"" + names + "\"");
        return std::nullopt;
    }
    options.names = *set;
    return options;
}

bool keep_clips(io::ClipFile& file, const std::vector<std::string>& names) {
    if (names.empty()) {
        return true;
    }
    std::vector<std::string> known;
    for (const motion::Clip& clip : file.clips) {
        known.push_back(clip.name);
    }
    std::vector<motion::Clip> kept;
    for (const std::string& name : names) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end()) {
            std::string all;
            for (const std::string& k : known) {
                all += (all.empty() ? "" : ", ") + k;
            }
            const std::string_view near = nearest_name(name, known);
            say_error("there is no clip " + name +
                      (near.empty() ? "" : "; did you mean " + std::string(near) + "?"));
            say("clips: " + all);
            return false;
        }
        kept.push_back(file.clips[static_cast<std::size_t>(found - known.begin())]);
    }
    file.clips = std::move(kept);
    return true;
}

bool carry_onto(io::ClipFile& file, const Arguments& arguments, double rate_hz) {
    const std::string onto = arguments.text("--onto");
    if (onto.empty()) {
        return true;
    }
    const Checked<figure::Character> source = io::performer_of(file, arguments.text("in"));
    if (!source) {
        say_diagnostics(source.error());
        return false;
    }
    const motion::Performer from{source->skeleton, *source->humanoid};
    motion::RetargetOptions options;
    if (rate_hz > 0) {
        options.rate_hz = rate_hz;
    } else if (file.frame_s > 0) {
        options.rate_hz = 1 / file.frame_s;
    }
    std::optional<figure::Figure> mannequin;
    std::optional<figure::Character> character;
    if (const std::optional<double> height = parse_number(onto)) {
        if (!(*height >= 0.5 && *height <= 3)) {
            say_error("--onto: a mannequin is 0.5 to 3 m tall");
            return false;
        }
        mannequin = figure::make_mannequin(*height);
    } else {
        io::DiskFiles disk;
        Result<std::string, scene::FileProblem> bytes = disk.read(onto);
        if (!bytes) {
            say_error(onto + ": " + bytes.error().message);
            return false;
        }
        Checked<io::GltfDocument> document =
            io::GltfDocument::parse(std::move(*bytes), onto, &disk);
        Diagnostics notes;
        Checked<figure::Character> read =
            document ? io::read_character(*document, {.path = onto}, notes)
                     : Checked<figure::Character>(Unexpected(std::move(document).error()));
        if (!read) {
            say_diagnostics(read.error());
            return false;
        }
        if (!read->humanoid) {
            say_error(onto + " has no humanoid in it");
            return false;
        }
        character = std::move(*read);
    }
    for (motion::Clip& clip : file.clips) {
        motion::Retargeted made =
            mannequin ? motion::retarget(clip, from, *mannequin, options)
                      : motion::retarget(
                            clip, from,
                            motion::Performer{character->skeleton, *character->humanoid}, options);
        if (made.worst_foot_m > 0.02) {
            say(clip.name + ": at worst a foot is " +
                number_to_text_fixed(100 * made.worst_foot_m, 0) +
                " cm from where it should be: the legs are too short for it");
        }
        clip = std::move(made.clip);
    }
    file.skeleton = mannequin ? mannequin->skeleton : character->skeleton;
    file.frame_s = 1 / options.rate_hz;
    return true;
}

bool rename_bones(io::ClipFile& file, const Arguments& arguments, const std::string& out,
                  io::BoneNames set) {
    if (!arguments.given("--names") || file.skeleton.joints.empty()) {
        return true;  // without joints the mannequin's are written, with these names
    }
    std::map<std::string, std::string> names;
    std::set<std::string> wanted{"hips", "head", "leftUpperLeg", "rightUpperLeg"};
    for (const figure::FoundBone& bone : io::find_bones(file.skeleton)) {
        wanted.erase(bone.bone);
        // Writers of other formats turn VRM's names into those of the set.
        const bool keys = io::clip_format_of(out) == io::ClipFormat::kKeys;
        names[file.skeleton.joints[bone.joint.value].name] =
            keys ? io::bone_name(set, bone.bone) : bone.bone;
    }
    if (!wanted.empty()) {
        say_error("--names: " + arguments.text("in") +
                  " is no humanoid: no joint of it is known as " + *wanted.begin() +
                  "; leave --names out");
        return false;
    }
    const auto rename = [&](std::string& name) {
        if (const auto found = names.find(name); found != names.end()) {
            name = found->second;
        }
    };
    for (figure::Joint& joint : file.skeleton.joints) {
        const bool clash = names.count(joint.name) == 0 &&
                           std::any_of(names.begin(), names.end(),
                                       [&](const auto& n) { return n.second == joint.name; });
        if (clash) {
            say_error("--names: " + arguments.text("in") + " has a joint " + joint.name +
                      " that is another bone; leave --names out");
            return false;
        }
        rename(joint.name);
    }
    for (motion::Clip& clip : file.clips) {
        rename(clip.root);
        for (auto& track : clip.rotations) {
            rename(track.target);
        }
        for (auto& track : clip.translations) {
            rename(track.target);
        }
        for (motion::ClipMark& mark : clip.marks) {
            rename(mark.target);
        }
    }
    return true;
}

int write_motion(const std::string& path, const io::ClipFile& file,
                 const io::ClipWriteOptions& options, bool json) {
    Diagnostics notes;
    const Checked<std::vector<std::string>> written = io::write_clips(path, file, options, notes);
    if (!written) {
        say_diagnostics(written.error());
        const std::string& code = written.error()[0].code;
        return code == "cannot-write" || code == "disk-full" ? kFailed : kBadInput;
    }
    say_diagnostics(notes);
    if (json) {
        io::JsonWriter out;
        out.begin_object().key("files").begin_array();
        for (const std::string& name : *written) {
            out.string(name);
        }
        out.end_array().key("clips").begin_array();
        for (const motion::Clip& clip : file.clips) {
            out.begin_object()
                .member("name", clip.name)
                .member("duration_s", clip.duration_s)
                .end_object();
        }
        out.end_array().end_object();
        std::printf("%s\n", out.text().c_str());
        return kFine;
    }
    for (const std::string& name : *written) {
        say(name + ": " + std::to_string(file.clips.size()) +
            (file.clips.size() == 1 ? " clip, " : " clips, ") +
            std::to_string(file.skeleton.joints.size()) + " joints");
    }
    return kFine;
}

namespace {

// The absolute keyframes that a tuple file makes of the poses of another file.
Checked<io::ClipFile> load_tuples(const Arguments& arguments, double rate_hz) {
    const std::string path = arguments.text("in"), poses_path = arguments.text("--poses");
    const auto failure = [](const std::string& file, std::string message, std::string remedy) {
        return Unexpected(Diagnostics{{Severity::kError,
                                       "cannot-read",
                                       {file, 0, 0, 1},
                                       "",
                                       std::move(message),
                                       std::move(remedy)}});
    };
    if (poses_path.empty()) {
        return failure(path, "tuples name keyframes that stand in another file",
                       "name it: --poses FILE.keys");
    }
    io::DiskFiles disk;
    Result<std::string, scene::FileProblem> text = disk.read(path);
    if (!text) {
        return failure(path, text.error().message, "name a file that is there");
    }
    PUP_TRY(const std::vector<notation::KeyframeTuple> tuples, notation::read_tuples(*text, path));
    PUP_TRY(const io::ClipFile poses, io::load_clips(poses_path));
    // A frame is one of the poses' file (frames 24), or of --fps.
    const double rate = rate_hz > 0 ? rate_hz : poses.frame_s > 0 ? 1 / poses.frame_s : 24;
    return io::absolute_keyframes(tuples, poses, rate, motion::Interpolation::kLinear, path);
}

}  // namespace

int convert_motion(const Arguments& arguments) {
    const std::optional<io::ClipReadOptions> reading = motion_read_options(arguments);
    const std::optional<io::ClipWriteOptions> writing = motion_write_options(arguments);
    if (!reading || !writing) {
        return kBadInput;
    }
    const std::string in = arguments.text("in");
    Checked<io::ClipFile> file = in.ends_with(".tuples") ? load_tuples(arguments, writing->rate_hz)
                                                         : io::load_clips(in, *reading);
    if (!file) {
        say_diagnostics(file.error());
        return kBadInput;
    }
    say_diagnostics(file->notes);
    if (!keep_clips(*file, arguments.texts("--clip"))) {
        return kBadInput;
    }
    if (!carry_onto(*file, arguments, writing->rate_hz) ||
        !rename_bones(*file, arguments, arguments.text("out"), writing->names)) {
        return kBadInput;
    }
    return write_motion(arguments.text("out"), *file, *writing, arguments.given("--json"));
}

}  // namespace puppetri::cli
