// SPDX-License-Identifier: MIT
// `puppetri render SCENE -o FILE`: a film of the performance, or pictures of it.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "commands.h"
#include "interrupt.h"
#include "performing.h"
#include "puppetri/base/frame_rate.h"
#include "puppetri/io/atomic_file.h"
#include "puppetri/io/json_writer.h"
#include "puppetri/render/film.h"
#include "terminal.h"

namespace puppetri::cli {
namespace {

constexpr int kSmallest = 16, kLargest = 8192;

struct Plan {
    std::string output, ending;
    render::FilmFormat format;
    bool rate_given = false;
    std::optional<Frames> frames;
    std::string camera;
    bool json = false;
};

// A natural number of at most nine digits.
std::optional<std::int64_t> natural(const std::string& digits) {
    if (digits.empty() || digits.size() > 9 ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
        return std::nullopt;
    }
    return std::atoll(digits.c_str());
}

// The place of "%d" or "%04d" in a name: its start and length, and the digits wanted; none when
// there is no such thing.
struct Numbering {
    std::size_t at = std::string::npos, length = 0;
    int digits = 0;
};
Numbering numbering_of(const std::string& path) {
    for (std::size_t at = path.find('%'); at != std::string::npos; at = path.find('%', at + 1)) {
        std::size_t end = at + 1;
        while (end < path.size() && path[end] >= '0' && path[end] <= '9') {
            ++end;
        }
        if (end < path.size() && path[end] == 'd' && end - at <= 4) {
            return {at, end + 1 - at, std::atoi(path.substr(at + 1, end - at - 1).c_str())};
        }
    }
    return {};
}

std::string numbered(const std::string& pattern, std::int64_t number) {
    const Numbering n = numbering_of(pattern);
    std::string digits = std::to_string(number);
    digits.insert(
        0, static_cast<std::size_t>(std::max(0, n.digits - static_cast<int>(digits.size()))), '0');
    return pattern.substr(0, n.at) + digits + pattern.substr(n.at + n.length);
}

// Gives what is wrong with the options, one sentence each.
std::vector<std::string> read_options(const Arguments& arguments, Plan& plan) {
    std::vector<std::string> problems;
    plan.output = arguments.text("--output");
    plan.ending = ending_of(plan.output);
    constexpr std::array<std::string_view, 5> kEndings{".mp4", ".webm", ".gif", ".apng", ".png"};
    if (std::find(kEndings.begin(), kEndings.end(), plan.ending) == kEndings.end()) {
        problems.push_back(
            "cannot tell the kind of film of " + plan.output +
            ": name a file .mp4, .webm, .gif, .apng or .png, or frames like frames/%04d.png");
    }
    const std::string size = arguments.text("--size", "1280x720");
    const std::size_t cross = std::min(size.find('x'), size.size());
    const auto width = natural(size.substr(0, cross)),
               height = natural(size.substr(std::min(cross + 1, size.size())));
    if (!width || !height || *width < kSmallest || *height < kSmallest || *width > kLargest ||
        *height > kLargest) {
        problems.push_back("--size is WIDTHxHEIGHT in pixels like 1280x720, each from 16 to 8192");
    } else {
        plan.format.width = static_cast<int>(*width);
        plan.format.height = static_cast<int>(*height);
    }
    if (arguments.given("--frames")) {
        plan.frames = parse_frames(arguments.text("--frames"));
        if (!plan.frames) {
            problems.push_back(
                "--frames is a frame or a range like 0-479, counted from 0, the first not after "
                "the last");
        }
    }
    if (arguments.given("--fps")) {
        const auto rate = parse_frame_rate(arguments.text("--fps"));
        if (rate) {
            plan.format.rate = {rate->numerator, rate->denominator};
            plan.rate_given = true;
        } else {
            problems.push_back("--fps is a number of frames per second: 24, 23.976, 30000/1001");
        }
    }
    const std::int64_t threads = arguments.integer("--threads", 0);
    if (threads < 0 || threads > 256) {
        problems.push_back(
            "--threads is a number from 1 to 256, or 0 for as many as the machine has");
    }
    plan.format.threads = static_cast<int>(threads);
    plan.camera = arguments.text("--camera");
    plan.json = arguments.given("--json");
    return problems;
}

// Counts frames on the terminal and stops the film on Ctrl-C.
class Watched final : public render::FrameSink {
 public:
    Watched(render::FrameSink& sink, const render::FilmFormat& format)
        : sink_(sink), format_(format), progress_("drawing") {}

    render::FilmStatus frame(std::int64_t number, const render::Picture& picture) override {
        if (interrupted()) {
            return Unexpected(render::FilmError{"stopped by Ctrl-C", "", ""});
        }
        render::FilmStatus status = sink_.frame(number, picture);
        const std::int64_t all = format_.last_frame - format_.first_frame + 1,
                           done = number - format_.first_frame + 1;
        progress_.show(static_cast<double>(done) / static_cast<double>(all),
                       "frame " + std::to_string(done) + " of " + std::to_string(all));
        return status;
    }

 private:
    render::FrameSink& sink_;
    const render::FilmFormat& format_;
    Progress progress_;
};

render::FilmError film_error(const Diagnostics& list) {
    return list.empty() ? render::FilmError{"the file cannot be written", "", ""}
                        : render::FilmError{list.front().message, list.front().remedy, ""};
}

// One PNG file per frame, or one alone.
class PngFiles final : public render::FrameSink {
 public:
    explicit PngFiles(std::string pattern) : pattern_(std::move(pattern)) {}

    render::FilmStatus frame(std::int64_t number, const render::Picture& picture) override {
        const std::string path =
            numbering_of(pattern_).at == std::string::npos ? pattern_ : numbered(pattern_, number);
        const Status status = io::write_file(path, render::encode_png(picture));
        if (!status) {
            return Unexpected(film_error(status.error()));
        }
        return Ok{};
    }

 private:
    std::string pattern_;
};

int fail(const render::FilmError& error) {
    if (!error.details.empty()) {
        std::fputs(error.details.c_str(), stderr);
    }
    say_error(error.message + (error.remedy.empty() ? "" : " (" + error.remedy + ")"));
    return kFailed;
}

// Says what was made: for people on stderr, for programs as JSON on stdout.
void tell(const Plan& plan, const std::string& file) {
    say("wrote " + file);
    if (plan.json) {
        io::JsonWriter json;
        json.begin_object().member("file", file);
        json.member("width", static_cast<std::int64_t>(plan.format.width));
        json.member("height", static_cast<std::int64_t>(plan.format.height));
        json.member("frames_per_second", plan.format.rate.per_second());
        json.member("first_frame", plan.format.first_frame)
            .member("last_frame", plan.format.last_frame);
        json.end_object();
        std::printf("%s\n", json.text().c_str());
    }
}

int make(const Plan& plan, const render::RenderScene& scene) {
    const render::FilmFormat& format = plan.format;
    const bool pictures = plan.ending == ".png";
    if (Status folders = io::make_parent_folders(plan.output); !folders) {
        return fail(film_error(folders.error()));
    }
    if (pictures || !render::have_ffmpeg()) {
        std::string pattern = plan.output;
        if (!pictures) {
            pattern = plan.output.substr(0, plan.output.size() - plan.ending.size()) + "_%04d.png";
            say("there is no program ffmpeg to make " + plan.output + ": writing the frames " +
                pattern + " instead (on Debian: apt-get install ffmpeg)");
        }
        PngFiles files(pattern);
        Watched watched(files, format);
        if (const render::FilmStatus status = draw_film(scene, format, watched); !status) {
            return fail(status.error());
        }
        tell(plan, pattern);
        return kFine;
    }
    Checked<io::PendingFile> pending = io::PendingFile::open(plan.output);
    if (!pending) {
        return fail(film_error(pending.error()));
    }
    auto ffmpeg = render::FfmpegSink::start(format, pending->temporary(), plan.ending);
    if (!ffmpeg) {
        return fail(ffmpeg.error());
    }
    {
        Watched watched(**ffmpeg, format);
        if (const render::FilmStatus status = draw_film(scene, format, watched); !status) {
            return fail(status.error());
        }
    }
    if (const render::FilmStatus status = (*ffmpeg)->finish(); !status) {
        return fail(status.error());
    }
    if (const Status status = pending->commit(); !status) {
        return fail(film_error(status.error()));
    }
    tell(plan, plan.output);
    return kFine;
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
    if (const std::string missing = render::why_no_pictures(); !missing.empty()) {
        say_error(missing);
        return kFailed;
    }
    const auto staged = load_and_perform(arguments);
    if (!staged) {
        return staged.error();
    }
    const scene::Scene& scene = *staged->scene;
    const stage::Performance& performance = *staged->performed.performance;
    const auto camera = std::find_if(
        scene.cameras.begin(), scene.cameras.end(),
        [&](const scene::Camera& one) { return plan.camera.empty() || one.name == plan.camera; });
    const bool found = camera != scene.cameras.end();
    if (!plan.camera.empty() && !found) {
        say_error("the scene has no camera " + plan.camera);
        return kBadInput;
    }
    if (!plan.rate_given) {
        plan.format.rate = scene.frame_rate;
    }
    // The last instant of a film is shown by the frame before it.
    const double all = performance.duration().seconds() * plan.format.rate.per_second();
    const std::int64_t last = std::max<std::int64_t>(0, static_cast<std::int64_t>(all + 0.5) - 1);
    const Frames frames = plan.frames.value_or(Frames{0, last});
    plan.format.first_frame = frames.first;
    plan.format.last_frame = std::max(frames.first, std::min(frames.last, last));
    if (plan.format.first_frame > last) {
        say_error("the performance ends with frame " + std::to_string(last) + ", before frame " +
                  std::to_string(plan.format.first_frame));
        return kBadInput;
    }
    if (plan.ending == ".png" && numbering_of(plan.output).at == std::string::npos) {
        plan.format.last_frame = plan.format.first_frame;
    }
    const double aspect = static_cast<double>(plan.format.width) / plan.format.height;
    const render::CameraPath path(found ? *camera : render::default_camera(performance),
                                  performance, aspect);
    render::RenderScene picture{&performance, &path, scene.play.cast.sets, {}};
    picture.look.dither = plan.ending != ".gif" && plan.ending != ".apng";
    return make(plan, picture);
}

}  // namespace

Command render_command() {
    return {"render", "draw a film of a scene, or pictures",
            "Performs the scene and draws it: figures and props under a sun, on the scene's road "
            "or floor, seen by its\n"
            "camera. The name of the file says what to make: .mp4, .webm, .gif, .apng (with the "
            "program ffmpeg), .png for\n"
            "one picture, or numbered pictures where the name has a %04d.\n\n"
            "Examples:\n"
            "  puppetri render ball.pup -o ball.mp4\n"
            "  puppetri render ball.pup -o ball.mp4 --size 960x540 --frames 0-479     the first 20 "
            "s at 24 frames/s\n"
            "  puppetri render ball.pup -o start.png --frames 48                      one picture\n"
            "  puppetri render ball.pup -o frames/%04d.png                            every frame "
            "as a picture",
            with_performing_options(
                {{"scene", Value::kText, "SCENE", "the scene to perform", true},
                 {"-o,--output", Value::kText, "FILE", "the film or picture to make", true},
                 {"--size", Value::kText, "WxH", "pixels (default 1280x720)", false},
                 {"--frames", Value::kText, "A-B",
                  "only these frames, from 0, both included (default: all)", false},
                 {"--fps", Value::kText, "RATE", "frames per second (default: the scene's)", false},
                 {"--camera", Value::kText, "NAME",
                  "which of the scene's cameras (default: the first)", false},
                 {"--threads", Value::kInteger, "N",
                  "pictures drawn at once (default: as many as the machine has cores)", false},
                 {"--json", Value::kFlag, "", "what was made as JSON on stdout"}}),
            run};
}

}  // namespace puppetri::cli
