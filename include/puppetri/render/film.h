// SPDX-License-Identifier: MIT
// Films: many pictures, drawn by several threads, handed over in order to a sink: the program
// `ffmpeg` at the end of a pipe, or whatever the caller makes of them.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "puppetri/base/result.h"
#include "puppetri/render/picture.h"
#include "puppetri/scene/scene.h"

namespace puppetri::render {

struct FilmError {
    std::string message;  // one sentence without a full stop
    std::string remedy;
    std::string details;  // what ffmpeg said, some lines, or empty
};
using FilmStatus = Result<Ok, FilmError>;

struct FilmFormat {
    int width = 1280, height = 720;
    scene::FrameRate rate;
    std::int64_t first_frame = 0, last_frame = 0;  // inclusive
    int threads = 0;                               // 0: as many as the machine has
};

// Takes pictures one by one.
class FrameSink {
 public:
    virtual ~FrameSink() = default;
    // Called in order of frames, from the thread that called draw_film. An error ends the film.
    virtual FilmStatus frame(std::int64_t number, const Picture& picture) = 0;
};

// Draws the frames and hands each over as soon as those before it are. Gives the first error of the
// sink. Needs   first_frame <= last_frame, and instants of frames that fit SimTime. Gives   the
// same bytes for any number of threads. Cost    one PictureMaker per thread; at most two pictures
// per thread wait.
FilmStatus draw_film(const RenderScene& scene, const FilmFormat& format, FrameSink& sink);

// A PNG file in memory: 8-bit RGB.
std::string encode_png(const Picture& picture);

// The program `ffmpeg` (found on the PATH) that encodes what is piped into it.
class FfmpegSink final : public FrameSink {
 public:
    // Starts it. The name's ending chooses the codec: .mp4 H.264, .webm VP9, .gif, .apng.
    // Needs   even width and height for .mp4 and .webm (one row or column is left out otherwise).
    // Fails   another ending; no program named ffmpeg; no more processes.
    static Result<std::unique_ptr<FfmpegSink>, FilmError> start(const FilmFormat& format,
                                                                const std::string& file,
                                                                std::string_view ending);
    ~FfmpegSink() override;  // an unfinished one is ended and waited for

    FilmStatus frame(std::int64_t number, const Picture& picture) override;
    // Closes the pipe and waits. Fails with what ffmpeg said, when it failed.
    FilmStatus finish();

 private:
    struct Data;
    explicit FfmpegSink(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

// True when a program of that name can be started.
bool have_ffmpeg();

}  // namespace puppetri::render
