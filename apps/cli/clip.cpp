// SPDX-License-Identifier: MIT
// `puppetri clip IN [OUT] [EDIT...]`: what is in a file of motion, and editing it.
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "commands.h"
#include "convert_motion.h"
#include "puppetri/base/text.h"
#include "puppetri/figure/dof.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/io/character_reader.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/clip_edit.h"
#include "puppetri/motion/clip_layers.h"
#include "puppetri/motion/walk_cycle.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

// An edit in words: "cut 1 2.5".
struct Edit {
    std::string text, verb;
    std::vector<std::string> words;  // behind the verb
};

class Editor {
 public:
    explicit Editor(io::ClipFile& file) : file_(file) {}

    // Gives what is wrong, or nothing.
    std::string apply(const std::string& text) {
        edit_ = {text, "", {}};
        std::istringstream in(text);
        in >> edit_.verb;
        for (std::string word; in >> word;) {
            edit_.words.push_back(word);
        }
        problem_.clear();
        if (edit_.verb == "cycle") {
            cycle();
            return problem_;
        }
        for (motion::Clip& clip : file_.clips) {
            motion::Clip edited = edit(clip);
            if (!problem_.empty()) {
                return problem_ + " (" + clip.name + ", " + number_to_text(clip.duration_s) + " s)";
            }
            edited.name = clip.name;
            clip = std::move(edited);
        }
        return "";
    }

 private:
    double number(std::size_t i, double lo, double hi, const char* what) {
        const std::optional<double> value =
            i < edit_.words.size() ? parse_number(edit_.words[i]) : std::nullopt;
        if (!value || !(*value >= lo && *value <= hi)) {
            problem_ = "\"" + edit_.text + "\": " + what;
            return lo;
        }
        return *value;
    }
    void words(std::size_t least, std::size_t most) {
        if (edit_.words.size() < least || edit_.words.size() > most) {
            problem_ = "\"" + edit_.text + "\" has " + std::to_string(edit_.words.size()) +
                       " words behind " + edit_.verb + ": see puppetri clip --help";
        }
    }

    motion::Clip edit(const motion::Clip& clip) {
        const double end = clip.duration_s;
        const std::string& verb = edit_.verb;
        if (verb == "copy" || verb == "cut") {
            words(2, 2);
            const double from = number(0, 0, end, "from and to are seconds within the clip");
            const double to = number(1, from, end, "from and to are seconds within the clip");
            return !problem_.empty() ? clip
                   : verb == "copy"  ? motion::copied(clip, from, to)
                                     : motion::without(clip, from, to);
        }
        if (verb == "mirror") {
            words(0, 0);
            return motion::mirrored(clip, skeleton());
        }
        if (verb == "reverse") {
            words(0, 0);
            return motion::reversed(clip);
        }
        if (verb == "stretch") {
            words(1, 1);
            const double factor = number(0, 1e-3, 1e3, "a factor from 0.001 to 1000");
            return problem_.empty() ? motion::stretched(clip, factor) : clip;
        }
        if (verb == "warp") {
            return warp(clip);
        }
        if (verb == "repeat") {
            words(1, 1);
            const double rounds = number(0, 1, 1000, "rounds from 1 to 1000");
            return problem_.empty() ? motion::repeated(clip, static_cast<int>(rounds)) : clip;
        }
        if (verb == "close") {
            words(1, 1);
            const double blend = number(0, 1e-3, end, "seconds within the clip");
            return problem_.empty() ? motion::closed(clip, blend) : clip;
        }
        if (verb == "resample") {
            words(1, 1);
            const double rate = number(0, 0.1, 1000, "keys per second, up to 1000");
            return problem_.empty() ? motion::resampled(clip, rate) : clip;
        }
        if (verb == "reduce") {
            words(0, 2);
            const double degrees =
                edit_.words.empty() ? 0.1 : number(0, 0, 90, "degrees, then millimetres");
            const double mm =
                edit_.words.size() < 2 ? 0.5 : number(1, 0, 1000, "degrees, then millimetres");
            return problem_.empty() ? motion::reduced(clip, {radians(degrees), mm / 1000}) : clip;
        }
        if (verb == "loops") {
            words(0, 0);
            motion::Clip out = clip;
            out.loops = true;
            return out;
        }
        if (verb == "paste" || verb == "insert") {
            words(2, 3);
            const double at = number(0, 0, end, "it wants seconds within the clip, then a file");
            const std::optional<motion::Clip> piece =
                problem_.empty()
                    ? piece_of(edit_.words[1], edit_.words.size() > 2 ? edit_.words[2] : "")
                    : std::nullopt;
            return !piece            ? clip
                   : verb == "paste" ? motion::pasted(clip, at, *piece)
                                     : motion::inserted(clip, at, *piece);
        }
        if (verb == "layer") {
            return layered(clip);
        }
        if (verb == "key") {
            return with_key(clip);
        }
        static const std::vector<std::string> kVerbs = {
            "copy",    "cut",  "paste",  "insert", "layer", "key",      "mirror", "reverse",
            "stretch", "warp", "repeat", "close",  "cycle", "resample", "reduce", "loops"};
        const std::string_view near = nearest_name(verb, kVerbs);
        problem_ = "there is no edit " + verb +
                   (near.empty() ? std::string() : "; did you mean " + std::string(near) + "?");
        return clip;
    }

    const figure::Skeleton& skeleton() const {
        static const figure::Skeleton mannequin = figure::make_mannequin(1.75).skeleton;
        return file_.skeleton.joints.empty() ? mannequin : file_.skeleton;
    }

    // The clip of a file, the first where no name is given.
    std::optional<motion::Clip> piece_of(const std::string& path, const std::string& name) {
        Checked<io::ClipFile> file = io::load_clips(path, {});
        if (!file) {
            problem_ = "\"" + edit_.text + "\": " + file.error()[0].message + "; " +
                       file.error()[0].remedy;
            return std::nullopt;
        }
        for (motion::Clip& clip : file->clips) {
            if (name.empty() || clip.name == name) {
                return std::move(clip);
            }
        }
        problem_ = "\"" + edit_.text + "\": " + path + " has no clip " + name;
        return std::nullopt;
    }

    // layer FILE [clip NAME] [additive] [weight W] [begins T] [only JOINT]
    motion::Clip layered(const motion::Clip& clip) {
        motion::ClipLayer over;
        std::string name;
        if (edit_.words.empty()) {
            problem_ = "\"" + edit_.text + "\": layer wants a file";
        }
        for (std::size_t i = 1; i < edit_.words.size() && problem_.empty(); ++i) {
            const std::string& word = edit_.words[i];
            const bool more = i + 1 < edit_.words.size();
            if (word == "additive") {
                over.mode = motion::LayerMode::kAdditive;
            } else if (word == "weight") {
                over.weight = number(++i, 0, 1, "a weight is from 0 to 1");
            } else if (word == "begins") {
                over.begin_s = number(++i, 0, clip.duration_s, "it begins within the clip");
            } else if (word == "clip" && more) {
                name = edit_.words[++i];
            } else if (word == "only" && more && skeleton().find(edit_.words[i + 1]).valid()) {
                over.mask = motion::mask_below(skeleton(), edit_.words[++i]);
            } else {
                problem_ = "\"" + edit_.text +
                           "\": behind the file come clip NAME, additive, "
                           "weight W, begins T, only JOINT (one of the file)";
            }
        }
        if (!problem_.empty()) {
            return clip;
        }
        std::optional<motion::Clip> piece = piece_of(edit_.words[0], name);
        if (!piece) {
            return clip;
        }
        if (over.mode == motion::LayerMode::kAdditive) {
            piece = motion::to_additive(*piece, 0);
        }
        over.clip = &*piece;
        constexpr double kRate_hz = 60;
        static const figure::DofSet dofs = figure::humanoid_dofs(figure::make_mannequin(1.75));
        const motion::ClipLayer layers[] = {{.clip = &clip}, over};
        return motion::flattened(layers, skeleton(), clip.duration_s, kRate_hz,
                                 file_.skeleton.joints.empty() ? &dofs : nullptr);
    }

    // key T DOF VALUE deg|m [INTERPOLATION]
    motion::Clip with_key(const motion::Clip& clip) {
        words(4, 5);
        motion::NumberKey key;
        key.t_s = number(0, 0, 86'400, "seconds come first");
        const double value = number(2, -1e6, 1e6, "behind the degree of freedom comes a number");
        const std::string unit = edit_.words.size() > 3 ? edit_.words[3] : "";
        if (problem_.empty() && unit != "deg" && unit != "m") {
            problem_ = "\"" + edit_.text + "\": the number is in deg or m";
        }
        key.value = unit == "deg" ? radians(value) : value;
        if (problem_.empty() && edit_.words.size() > 4) {
            bool known = false;
            for (int i = 0; i <= static_cast<int>(motion::Interpolation::kBezier); ++i) {
                const auto way = static_cast<motion::Interpolation>(i);
                if (motion::name_of(way) == edit_.words[4]) {
                    key.interpolation = way;
                    known = true;
                }
            }
            if (!known) {
                problem_ = "\"" + edit_.text + "\": there is no interpolation " + edit_.words[4];
            }
        }
        if (!problem_.empty()) {
            return clip;
        }
        motion::Clip out = clip;
        auto track = std::find_if(out.numbers.begin(), out.numbers.end(),
                                  [&](const auto& t) { return t.target == edit_.words[1]; });
        if (track == out.numbers.end()) {
            track = out.numbers.insert(track, {edit_.words[1], {}});
        }
        auto at = std::find_if(track->keys.begin(), track->keys.end(),
                               [&](const auto& k) { return k.t_s >= key.t_s; });
        if (at != track->keys.end() && at->t_s == key.t_s) {
            *at = key;
        } else {
            track->keys.insert(at, key);
        }
        out.duration_s = std::fmax(out.duration_s, key.t_s);
        return out;
    }

    motion::Clip warp(const motion::Clip& clip) {
        std::vector<motion::WarpPoint> points{{0, 0}};
        const char* const kRule =
            "pairs FROM:TO of seconds, both ascending; the last ends the clip";
        for (const std::string& word : edit_.words) {
            const std::size_t colon = word.find(':');
            const std::optional<double> from = parse_number(word.substr(0, colon));
            const std::optional<double> to =
                colon == std::string::npos ? std::nullopt : parse_number(word.substr(colon + 1));
            if (!from || !to || *from <= points.back().from_s || *to <= points.back().to_s ||
                *from > clip.duration_s) {
                problem_ = "\"" + edit_.text + "\": " + kRule;
                return clip;
            }
            points.push_back({*from, *to});
        }
        if (points.size() < 2) {
            problem_ = "\"" + edit_.text + "\": " + kRule;
            return clip;
        }
        if (points.back().from_s < clip.duration_s) {  // the rest at its own speed
            points.push_back(
                {clip.duration_s, points.back().to_s + clip.duration_s - points.back().from_s});
        }
        return motion::warped(clip, points);
    }

    void cycle() {
        words(0, 1);
        motion::CycleOptions options;
        if (!edit_.words.empty()) {
            options.alternating = edit_.words[0] != "hops";
            if (options.alternating) {
                problem_ = "\"" + edit_.text + "\": cycle, or cycle hops";
            }
        }
        if (!problem_.empty()) {
            return;
        }
        std::array<motion::FootJoints, 2> feet;
        for (const figure::FoundBone& bone : io::find_bones(file_.skeleton)) {
            const std::string& joint = file_.skeleton.joints[bone.joint.value].name;
            for (const std::size_t side : {0u, 1u}) {
                const std::string prefix = side == 0 ? "left" : "right";
                if (bone.bone == prefix + "Foot") {
                    feet[side].foot = joint;
                } else if (bone.bone == prefix + "Toes") {
                    feet[side].toes = joint;
                }
            }
        }
        for (motion::Clip& clip : file_.clips) {
            Checked<motion::WalkCycle> found =
                motion::cut_walk_cycle(clip, file_.skeleton, feet, options);
            if (!found) {
                problem_ = found.error()[0].message + "; " + found.error()[0].remedy;
                return;
            }
            say(clip.name + ": a stride of " + number_to_text_fixed(found->clip.duration_s, 2) +
                " s and " + number_to_text_fixed(found->travel_m, 2) + " m, from " +
                number_to_text_fixed(found->begin_s, 2) + " s on; its ends were " +
                number_to_text_fixed(1000 * found->mismatch_m, 0) + " mm apart, feet stand for " +
                number_to_text_fixed(100 * found->duty_factor, 0) + " %");
            found->clip.name = clip.name;
            clip = std::move(found->clip);
        }
    }

    io::ClipFile& file_;
    Edit edit_;
    std::string problem_;
};

std::size_t keys_of(const motion::Clip& clip) {
    std::size_t keys = 0;
    const auto add = [&](const auto& tracks) {
        for (const auto& track : tracks) {
            keys += track.keys.size();
        }
    };
    add(clip.rotations);
    add(clip.translations);
    add(clip.numbers);
    return keys;
}

void tell(const io::ClipFile& file, bool json) {
    io::JsonWriter out;
    if (json) {
        out.begin_object()
            .member("format", io::name_of(file.format))
            .member("joints", static_cast<std::int64_t>(file.skeleton.joints.size()))
            .member("height_m", file.skeleton.height_m)
            .key("clips")
            .begin_array();
    } else {
        std::printf("%s, %zu joints, %s m tall\n", io::name_of(file.format),
                    file.skeleton.joints.size(),
                    number_to_text_fixed(file.skeleton.height_m, 2).c_str());
    }
    for (const motion::Clip& clip : file.clips) {
        const std::size_t tracks =
            clip.rotations.size() + clip.translations.size() + clip.numbers.size();
        const Vec3 travel = motion::root_travel(clip, clip.duration_s).translation;
        if (json) {
            out.begin_object()
                .member("name", clip.name)
                .member("duration_s", clip.duration_s)
                .member("loops", clip.loops)
                .member("tracks", static_cast<std::int64_t>(tracks))
                .member("keys", static_cast<std::int64_t>(keys_of(clip)))
                .member("root", clip.root)
                .member("travel_m", length(travel))
                .key("marks")
                .begin_array();
            for (const motion::ClipMark& mark : clip.marks) {
                out.begin_object()
                    .member("t_s", mark.t_s)
                    .member("end_s", mark.end_s)
                    .member("name", mark.name)
                    .member("target", mark.target)
                    .end_object();
            }
            out.end_array().end_object();
        } else {
            std::printf("%-24s %9s s  %zu tracks, %zu keys%s", clip.name.c_str(),
                        number_to_text_fixed(clip.duration_s, 3).c_str(), tracks, keys_of(clip),
                        clip.loops ? ", loops" : "");
            if (!clip.root.empty()) {
                std::printf(", %s travels %s m", clip.root.c_str(),
                            number_to_text_fixed(length(travel), 2).c_str());
            }
            std::printf("\n");
        }
    }
    if (json) {
        std::printf("%s\n", out.end_array().end_object().text().c_str());
    }
}

int run(const Arguments& arguments) {
    const std::optional<io::ClipReadOptions> reading = motion_read_options(arguments);
    const std::optional<io::ClipWriteOptions> writing = motion_write_options(arguments);
    if (!reading || !writing) {
        return kBadInput;
    }
    const std::vector<std::string> edits = arguments.texts("edits");
    const std::string out = arguments.text("--output");
    if (out.empty() && !edits.empty()) {
        say_error("edits need a file to write: -o FILE");
        return kBadInput;
    }
    const bool empty = arguments.text("in") == "-";
    const std::vector<std::string> names = arguments.texts("--clip");
    io::ClipFile made;
    made.format = io::ClipFormat::kKeys;
    made.clips.emplace_back().name = names.empty() ? "clip" : names[0];
    Checked<io::ClipFile> file = empty ? Checked<io::ClipFile>(std::move(made))
                                       : io::load_clips(arguments.text("in"), *reading);
    if (!file) {
        say_diagnostics(file.error());
        return kBadInput;
    }
    say_diagnostics(file->notes);
    if (!keep_clips(*file, arguments.texts("--clip"))) {
        return kBadInput;
    }
    Editor editor(*file);
    for (const std::string& edit : edits) {
        if (const std::string problem = editor.apply(edit); !problem.empty()) {
            say_error(problem);
            return kBadInput;
        }
    }
    if (!out.empty() && (!carry_onto(*file, arguments, writing->rate_hz) ||
                         !rename_bones(*file, arguments, out, writing->names))) {
        return kBadInput;
    }
    if (out.empty()) {
        tell(*file, arguments.given("--json"));
        return kFine;
    }
    return write_motion(out, *file, *writing, arguments.given("--json"));
}

}  // namespace

Command clip_command() {
    Command command{
        "clip",
        "show and edit the clips of a file of motion",
        "Without -o it tells what is in the file. Edits are done one after the other, on all clips "
        "or those of --clip; where IN is - they begin with an empty clip:\n"
        "  \"copy FROM TO\"      keeps this stretch (seconds)\n"
        "  \"cut FROM TO\"       takes it out; what follows moves up\n"
        "  \"paste AT FILE\"     writes the first clip of FILE (or \"paste AT FILE NAME\") over it "
        "from AT on\n"
        "  \"insert AT FILE\"    the same, what was behind AT moves back\n"
        "  \"layer FILE ..\"     lays a clip of FILE over it; may be followed by clip NAME, "
        "additive,\n"
        "                      weight W, begins T, only JOINT (with all below)\n"
        "  \"key T DOF N deg\"   sets a key of a degree of freedom, in deg or m; a word for the\n"
        "                      interpolation may follow: step, linear, catmull-rom, ..\n"
        "  mirror              left becomes right\n"
        "  reverse             backwards\n"
        "  \"stretch FACTOR\"    2 is half as fast\n"
        "  \"warp A:B C:D ..\"   what was at A is at B, at C at D, ..\n"
        "  \"repeat N\"          N times; a travelling root goes on\n"
        "  \"close BLEND\"       makes the end meet the beginning over the last seconds, as a "
        "loop\n"
        "  cycle               cuts one stride out of a capture of walking: contacts found, loop "
        "closed;\n"
        "                      \"cycle hops\" where both feet land together\n"
        "  \"resample RATE\"     keys per second, straight lines between them\n"
        "  \"reduce DEG MM\"     fewer keys within these tolerances (0.1 0.5)\n"
        "  loops               says that the clip repeats\n\n"
        "Examples:\n"
        "  puppetri clip take.bvh --scale 0.056444\n"
        "  puppetri clip take.bvh cycle -o walk.keys\n"
        "  puppetri clip fox.glb --clip Run \"repeat 4\" -o run.glb\n"
        "  puppetri clip wave.keys \"copy 0.5 1.5\" mirror -o other.keys\n"
        "  puppetri clip walk.keys \"layer nod.keys additive only neck\" -o nodding.keys\n"
        "  puppetri clip - \"key 0 head.flex 0 deg\" \"key 0.5 head.flex 20 deg\" -o nod.keys",
        {{"in", Value::kText, "IN",
          "a file of motion: .keys, .bvh, .glb, .gltf, .vrm, .vrma; - for none", true},
         {"edits", Value::kTexts, "EDIT", "what to do, in this order", false},
         {"-o,--output", Value::kText, "FILE", "the file to write: .keys, .bvh, .glb or .gltf",
          false}},
        run};
    for (Option& option : motion_options()) {
        command.options.push_back(std::move(option));
    }
    return command;
}

}  // namespace puppetri::cli
