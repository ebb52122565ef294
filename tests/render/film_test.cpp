// SPDX-License-Identifier: MIT
#include "puppetri/render/film.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#ifdef PUPPETRI_WITH_PNG
#include <png.h>
#endif

#include "stage_of_balls.h"

using namespace puppetri;
using namespace puppetri::render;
using namespace puppetri::test;

namespace {

bool can_draw() { return why_no_pictures().empty(); }

struct Kept final : FrameSink {
    std::vector<std::int64_t> numbers;
    std::vector<Picture> pictures;
    std::int64_t stop_at = -1;
    FilmStatus frame(std::int64_t number, const Picture& picture) override {
        numbers.push_back(number);
        pictures.push_back(picture);
        if (number == stop_at) {
            return Unexpected(FilmError{"enough", "", ""});
        }
        return Ok{};
    }
};

struct Rolling {
    StageOfBalls stage{10};
    std::unique_ptr<CameraPath> path;
    Rolling() {
        stage.add_ball(0.5, [](double t) { return Transform{about_z(-4 * t), {-1 + t, 0.25, 0}}; });
        scene::Camera camera;
        camera.at_world = {0, 1, 4};
        path = std::make_unique<CameraPath>(camera, stage, 1.5);
    }
    RenderScene scene() const { return {&stage, path.get(), {}, {}}; }
};

FilmFormat small(std::int64_t first, std::int64_t last, int threads) {
    FilmFormat f;
    f.width = 96;
    f.height = 64;
    f.first_frame = first;
    f.last_frame = last;
    f.threads = threads;
    return f;
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("frames come in order, the same for any number of threads [law]") {
    if (!can_draw()) {
        return;
    }
    const Rolling rolling;
    Kept one, four;
    CHECK(draw_film(rolling.scene(), small(3, 15, 1), one).has_value());
    CHECK(draw_film(rolling.scene(), small(3, 15, 4), four).has_value());
    REQUIRE(one.numbers.size() == 13);
    REQUIRE(four.numbers == one.numbers);
    for (std::size_t i = 0; i < one.numbers.size(); ++i) {
        CHECK(one.numbers[i] == static_cast<std::int64_t>(i) + 3);
        CHECK(one.pictures[i].rgb == four.pictures[i].rgb);
    }
    // Frame k shows the instant k / rate.
    PictureMaker maker(rolling.scene(), 96, 64);
    Picture at_seven;
    maker.draw(*scene::FrameRate{}.time_of_frame(7), at_seven);
    CHECK(one.pictures[4].rgb == at_seven.rgb);
}

TEST_CASE("a sink that fails ends the film with its own words [unit]") {
    if (!can_draw()) {
        return;
    }
    const Rolling rolling;
    Kept kept;
    kept.stop_at = 5;
    const FilmStatus status = draw_film(rolling.scene(), small(0, 500, 3), kept);
    REQUIRE(!status.has_value());
    CHECK(status.error().message == "enough");
    CHECK(kept.numbers.back() == 5);
}

#ifdef PUPPETRI_WITH_PNG
TEST_CASE("a PNG file gives the picture back [oracle]") {
    Picture p;
    p.width = 37;
    p.height = 11;
    for (int i = 0; i < 37 * 11 * 3; ++i) {
        p.rgb.push_back(static_cast<std::uint8_t>(i * i % 251));
    }
    const std::string file = encode_png(p);
    png_image image;
    std::memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&image, file.data(), file.size()) != 0);
    CHECK(image.width == 37);
    CHECK(image.height == 11);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, back.data(), 0, nullptr) != 0);
    CHECK(back == p.rgb);
}
#endif

TEST_CASE("ffmpeg makes films of each kind, with all frames [oracle]") {
    if (!can_draw() || !have_ffmpeg() || std::system("ffprobe -version > /dev/null 2>&1") != 0) {
        return;
    }
    const Rolling rolling;
    const auto folder = std::filesystem::temp_directory_path();
    for (const char* ending : {".mp4", ".webm", ".gif", ".apng"}) {
        const auto file = folder / ("puppetri_film_test" + std::string(ending));
        FilmFormat format = small(0, 8, 2);
        format.width = 97;  // odd: the last column is left out where the codec wants even sizes
        auto sink = FfmpegSink::start(format, file.string(), ending);
        REQUIRE(sink.has_value());
        CHECK(draw_film(rolling.scene(), format, **sink).has_value());
        CHECK((*sink)->finish().has_value());
        const auto list = folder / "puppetri_film_test.txt";
        const std::string probe =
            "ffprobe -v error -count_frames -select_streams v -show_entries "
            "stream=nb_read_frames,height -of csv=p=0 '" +
            file.string() + "' > '" + list.string() + "'";
        CHECK(std::system(probe.c_str()) == 0);
        CHECK(bytes_of(list) == "64,9\n");
        std::filesystem::remove(file);
        std::filesystem::remove(list);
    }
}

TEST_CASE("ffmpeg's failure is told in its words, and ends nobody else [hostile]") {
    if (!can_draw() || !have_ffmpeg()) {
        return;
    }
    const Rolling rolling;
    FilmFormat format = small(0, 60, 2);
    format.width = 640;
    format.height = 480;
    // A folder that is not there: ffmpeg stops at once, while we are still writing.
    auto sink = FfmpegSink::start(format, "/nowhere/at/all/film.mp4", ".mp4");
    REQUIRE(sink.has_value());
    FilmStatus status = draw_film(rolling.scene(), format, **sink);
    if (status.has_value()) {
        status = (*sink)->finish();
    }
    REQUIRE(!status.has_value());
    CHECK(status.error().details.find("No such file") != std::string::npos);
    // An ending that nobody knows.
    CHECK(!FfmpegSink::start(format, "film.avi", ".avi").has_value());
    // A sink that is dropped in the middle leaves no process behind.
    auto dropped = FfmpegSink::start(format, "/dev/null", ".mp4");
    CHECK(dropped.has_value());
}
