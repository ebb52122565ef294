// SPDX-License-Identifier: MIT
// Pictures of a performance: its figures and props under a sun and a sky, on a floor or a road, ray
// traced with Embree. A PictureMaker belongs to one thread; several may look at one performance.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/time.h"
#include "puppetri/render/camera.h"
#include "puppetri/stage/cast.h"
#include "puppetri/stage/performance.h"

namespace puppetri::render {

// Eight-bit sRGB, rows from the top, three bytes per pixel.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

struct Look {
    // Any length above 0, y > 0. None: over the left shoulder of the camera as it stands at time 0.
    std::optional<Vec3> to_sun_world;
    int edge_samples =
        5;  // more primary rays per pixel where the first ones disagree; 0 turns it off
    bool dither = true;  // half a step of noise against bands in the sky; off for .gif and .apng
};

// All that a picture needs beside the time. What it points to must outlive the PictureMaker.
struct RenderScene {
    const stage::Performance* performance = nullptr;
    const CameraPath* camera = nullptr;
    std::span<const stage::Set> sets;  // the first one is drawn; none: an endless floor
    Look look;
};

// Empty when this build can draw. Otherwise what is missing and how to get it, for the user.
std::string why_no_pictures();

class PictureMaker {
 public:
    // Needs why_no_pictures() empty, performance and camera, 16 <= width, height <= 8192.
    PictureMaker(const RenderScene& scene, int width, int height);
    ~PictureMaker();
    PictureMaker(PictureMaker&&) noexcept;
    PictureMaker& operator=(PictureMaker&&) noexcept;

    // The picture of one instant. The same instant gives the same bytes, whatever was asked before.
    // Gives   `out` resized once and then reused.
    // Cost    about 0.1 s for 1280x720 with two mannequins on one core.
    void draw(SimTime at, Picture& out);

 private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace puppetri::render
