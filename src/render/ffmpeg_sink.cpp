// SPDX-License-Identifier: MIT
// The program ffmpeg at the end of a pipe. Video goes in as planar YUV that is made here (BT.709,
// as players assume for films of this size), pictures for .gif and .apng as RGB. What ffmpeg says
// is kept and shown when it fails.
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "puppetri/render/film.h"

extern char** environ;

namespace puppetri::render {
namespace {

constexpr std::size_t kKeptWords = 4000;  // of what ffmpeg said

std::string path_of_ffmpeg() {
    const char* path = std::getenv("PATH");
    for (std::string_view rest = path == nullptr ? "" : path; !rest.empty();) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        const std::string candidate = std::string(rest.substr(0, end)) + "/ffmpeg";
        if (end > 0 && access(candidate.c_str(), X_OK) == 0) {
            return candidate;
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return "";
}

// 4:2:0 planes with studio range, coefficients of ITU-R BT.709.
void to_yuv(const Picture& in, int width, int height, std::vector<std::uint8_t>& out) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    const auto stride = static_cast<std::size_t>(in.width) * 3;
    out.resize(w * h * 3 / 2);
    std::uint8_t* luma = out.data();
    for (std::size_t y = 0; y < h; ++y) {
        const std::uint8_t* p = in.rgb.data() + y * stride;
        for (std::size_t x = 0; x < w; ++x, p += 3) {
            luma[y * w + x] = static_cast<std::uint8_t>(
                (11966 * p[0] + 40254 * p[1] + 4064 * p[2] + (16 << 16) + 32768) >> 16);
        }
    }
    std::uint8_t* blue = luma + w * h;
    std::uint8_t* red = blue + w * h / 4;
    for (std::size_t y = 0; y < h / 2; ++y) {
        const std::uint8_t* p = in.rgb.data() + 2 * y * stride;
        for (std::size_t x = 0; x < w / 2; ++x, p += 6) {
            const int r = p[0] + p[3] + p[stride] + p[stride + 3];
            const int g = p[1] + p[4] + p[stride + 1] + p[stride + 4];
            const int b = p[2] + p[5] + p[stride + 2] + p[stride + 5];
            blue[y * (w / 2) + x] = static_cast<std::uint8_t>(
                (-6596 * r - 22189 * g + 28785 * b + (128 << 18) + 131072) >> 18);
            red[y * (w / 2) + x] = static_cast<std::uint8_t>(
                (28785 * r - 26145 * g - 2640 * b + (128 << 18) + 131072) >> 18);
        }
    }
}

struct Codec {
    bool yuv = true;
    std::vector<std::string> options;
};

bool find_codec(std::string_view ending, Codec& out) {
    if (ending == ".mp4") {
        out = {true, {"-c:v",        "libx264",   "-preset",          "veryfast",     "-crf",
                      "20",          "-pix_fmt",  "yuv420p",          "-color_range", "tv",
                      "-colorspace", "bt709",     "-color_primaries", "bt709",        "-color_trc",
                      "bt709",       "-movflags", "+faststart",       "-f",           "mp4"}};
    } else if (ending == ".webm") {
        out = {true,
               {"-c:v", "libvpx-vp9", "-deadline", "realtime", "-cpu-used", "6", "-row-mt", "1",
                "-crf", "32", "-b:v", "0", "-pix_fmt", "yuv420p", "-colorspace", "bt709", "-f",
                "webm"}};
    } else if (ending == ".gif") {
        out = {false,
               {"-filter_complex",
                "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=bayer:bayer_"
                "scale=5:diff_mode=rectangle",
                "-loop", "0", "-f", "gif"}};
    } else if (ending == ".apng") {
        out = {false, {"-c:v", "apng", "-pred", "mixed", "-plays", "0", "-f", "apng"}};
    } else {
        return false;
    }
    return true;
}

}  // namespace

bool have_ffmpeg() { return !path_of_ffmpeg().empty(); }

struct FfmpegSink::Data {
    int width = 0, height = 0;
    bool yuv = true;
    pid_t process = -1;
    int to_program = -1, from_program = -1;
    std::string said;
    std::vector<std::uint8_t> planes;

    ~Data() { end(true); }

    // Reads what there is to read; until its end when `all`.
    void listen(bool all) {
        char buffer[1024];
        while (from_program >= 0) {
            const ssize_t got = read(from_program, buffer, sizeof buffer);
            if (got > 0) {
                said.append(buffer, static_cast<std::size_t>(got));
                if (said.size() > 2 * kKeptWords) {
                    said.erase(0, said.size() - kKeptWords);
                }
            } else if (got == 0) {
                return;
            } else if (errno == EAGAIN && all) {
                pollfd one{from_program, POLLIN, 0};
                poll(&one, 1, 1000);
            } else if (errno != EINTR) {
                return;
            }
        }
    }

    // Closes the pipe, waits for the program; gives its exit status, -1 when it died of a signal.
    int end(bool kill_it) {
        if (to_program >= 0) {
            close(to_program);
            to_program = -1;
        }
        int status = 0;
        if (process > 0) {
            if (kill_it) {
                kill(process, SIGKILL);
            }
            listen(true);
            while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
            }
            process = -1;
        }
        if (from_program >= 0) {
            close(from_program);
            from_program = -1;
        }
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    FilmError failure(std::string message) {
        return {std::move(message),
                "see what ffmpeg says; is there room on the disk, and may the file be written?",
                said};
    }
};

FfmpegSink::FfmpegSink(std::unique_ptr<Data> data) : data_(std::move(data)) {}
FfmpegSink::~FfmpegSink() = default;

Result<std::unique_ptr<FfmpegSink>, FilmError> FfmpegSink::start(const FilmFormat& format,
                                                                 const std::string& file,
                                                                 std::string_view ending) {
    Codec codec;
    if (!find_codec(ending, codec)) {
        return Unexpected(FilmError{"there is no film of the kind '" + std::string(ending) + "'",
                                    "choose a name that ends in .mp4, .webm, .gif, .apng or .png",
                                    ""});
    }
    const std::string program = path_of_ffmpeg();
    if (program.empty()) {
        return Unexpected(FilmError{"there is no program ffmpeg",
                                    "install it (on Debian: apt-get install ffmpeg), or "
                                    "ask for pictures (-o frames/%04d.png)",
                                    ""});
    }
    auto data = std::make_unique<Data>();
    data->yuv = codec.yuv;
    data->width = codec.yuv ? format.width & ~1 : format.width;
    data->height = codec.yuv ? format.height & ~1 : format.height;
    const std::string size = std::to_string(data->width) + "x" + std::to_string(data->height);
    const std::string rate =
        std::to_string(format.rate.numerator) + "/" + std::to_string(format.rate.denominator);
    std::vector<std::string> words{program,
                                   "-hide_banner",
                                   "-loglevel",
                                   "error",
                                   "-nostdin",
                                   "-y",
                                   "-f",
                                   "rawvideo",
                                   "-pixel_format",
                                   codec.yuv ? "yuv420p" : "rgb24",
                                   "-video_size",
                                   size,
                                   "-framerate",
                                   rate,
                                   "-i",
                                   "pipe:0"};
    words.insert(words.end(), codec.options.begin(), codec.options.end());
    words.push_back("file:" + file);
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);

    int in[2], err[2];
    if (pipe2(in, O_CLOEXEC) != 0) {
        return Unexpected(FilmError{std::string("no pipe to ffmpeg: ") + std::strerror(errno),
                                    "close other programs", ""});
    }
    if (pipe2(err, O_CLOEXEC) != 0) {
        close(in[0]);
        close(in[1]);
        return Unexpected(FilmError{std::string("no pipe to ffmpeg: ") + std::strerror(errno),
                                    "close other programs", ""});
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, err[1], 2);
    // A group of its own: Ctrl-C is for us, and we end it.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t defaults;
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    sigaddset(&defaults, SIGINT);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    const int failed = posix_spawn(&data->process, program.c_str(), &actions, &attributes,
                                   arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(in[0]);
    close(err[1]);
    data->to_program = in[1];
    data->from_program = err[0];
    if (failed != 0) {
        data->process = -1;
        return Unexpected(FilmError{std::string("ffmpeg does not start: ") + std::strerror(failed),
                                    "try " + program, ""});
    }
    fcntl(data->from_program, F_SETFL, O_NONBLOCK);
    fcntl(data->to_program, F_SETFL, O_NONBLOCK);
    fcntl(data->to_program, F_SETPIPE_SZ, 1 << 20);  // fewer turns; a smaller pipe works as well
    return std::unique_ptr<FfmpegSink>(new FfmpegSink(std::move(data)));
}

FilmStatus FfmpegSink::frame(std::int64_t, const Picture& picture) {
    Data& d = *data_;
    const std::uint8_t* bytes = picture.rgb.data();
    std::size_t left = picture.rgb.size();
    if (d.yuv) {
        to_yuv(picture, d.width, d.height, d.planes);
        bytes = d.planes.data();
        left = d.planes.size();
    }
    // A closed pipe must be an error of write, not the end of the program, whoever calls us.
    sigset_t pipe_signal, before;
    sigemptyset(&pipe_signal);
    sigaddset(&pipe_signal, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
    int problem = 0;
    while (left > 0 && problem == 0) {
        const ssize_t put = write(d.to_program, bytes, left);
        if (put > 0) {
            bytes += put;
            left -= static_cast<std::size_t>(put);
        } else if (errno == EAGAIN) {
            // Waits for room, and listens meanwhile: a program that nobody listens to may stand
            // still.
            std::array<pollfd, 2> both{{{d.to_program, POLLOUT, 0}, {d.from_program, POLLIN, 0}}};
            poll(both.data(), both.size(), 1000);
            if (both[1].revents != 0) {
                d.listen(false);
            }
        } else if (errno != EINTR) {
            problem = errno;
        }
    }
    if (problem == EPIPE) {
        const timespec now{0, 0};
        sigtimedwait(&pipe_signal, nullptr, &now);  // takes the pending signal away
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    d.listen(false);
    if (problem != 0) {
        d.end(false);
        return Unexpected(d.failure("ffmpeg stopped in the middle of the film"));
    }
    return Ok{};
}

FilmStatus FfmpegSink::finish() {
    // When only the last bytes found no room, ffmpeg 5.1 complains and yet answers 0.
    const int status = data_->end(false);
    const std::string& said = data_->said;
    if (status != 0 || said.find("rror") != std::string::npos ||
        said.find("No space") != std::string::npos) {
        return Unexpected(data_->failure("ffmpeg could not finish the film"));
    }
    return Ok{};
}

}  // namespace puppetri::render
