// SPDX-License-Identifier: MIT
// Films: many pictures, drawn by several threads, kept in order, and piped into the program `ffmpeg`, or written as
// numbered PNG files. Whole or absent: everything goes to a temporary name that takes its final one at the very end.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "puppetri/base/result.h"
#include "puppetri/render/picture.h"

namespace puppetri::render {

struct FilmFormat {
    int width = 1280, height = 720;
    double frames_per_second = 24;
    std::int64_t first_frame = 0, last_frame = 0;  // inclusive; frame k shows t = k / frames_per_second
    int threads = 0;                               // 0: as many as the machine has
};

// Sees and may stop a film that is being made.
class FilmWatcher {
 public:
    virtual ~FilmWatcher() = default;
    // Called in order after each frame, from the thread that asked for the film. False stops it.
    virtual bool frame_done(std::int64_t done, std::int64_t all) = 0;
};

struct FilmError {
    std::string message;  // one sentence
    std::string remedy;
    std::string details;  // what ffmpeg said, several lines, or empty
    bool stopped = false; // by the watcher
};

struct FilmOutcome {
    std::string written;  // the file, or the pattern of the files
    std::string note;     // a remark for the user ("no ffmpeg: ..."), or empty
};

// Makes a film of the frames. `file` says the kind by its ending: .mp4, .webm, .gif, .apng are made by ffmpeg; .png is
// one picture (of the first frame), or one per frame where the name has a %d or %04d. Without ffmpeg the film becomes
// PNG frames NAME_%04d.png beside it, and the note says so.
// Fails   an unknown ending, a file that cannot be written, a full disk, ffmpeg's own failure; then no file is left.
Result<FilmOutcome, FilmError> make_film(const RenderScene& scene, const FilmFormat& format, const std::string& file,
                                         FilmWatcher& watcher);

}  // namespace puppetri::render
