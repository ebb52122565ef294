// SPDX-License-Identifier: MIT
// Stick figures on a sheet, to look at what movements do: a PPM file, made only when PUP_DRAW names
// a folder.
#pragma once
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "puppetri/figure/mannequin.h"
#include "puppetri/math/rotation.h"

namespace puppetri::test {

class Drawing {
 public:
    Drawing(const figure::Figure& figure, double width_m, double height_m,
            double pixels_per_m = 200)
        : f_(figure),
          scale_(pixels_per_m),
          w_(int(width_m * scale_)),
          h_(int(height_m * scale_)),
          pixels_(static_cast<std::size_t>(w_) * h_ * 3, 255) {}

    // Seen from the left side (across the page: z) or from the front (x); `origin` goes to (at_x,
    // at_y) on the page.
    void add(const std::vector<Transform>& world, double at_x, double at_y, bool front,
             Vec3 origin) {
        auto page = [&](Vec3 p) -> std::array<double, 2> {
            const Vec3 q = p - origin;
            return {at_x + (front ? q.x : q.z), at_y - q.y};
        };
        for (std::size_t j = 2; j < world.size(); ++j) {
            const auto& joint = f_.skeleton.joints[j];
            const Colour colour = colour_of(joint.name);
            line(page(world[joint.parent.value].translation), page(world[j].translation), colour);
            if (length(joint.end_site_joint) > 0 && joint.name.find("Twist") == std::string::npos) {
                line(page(world[j].translation), page(world[j] * joint.end_site_joint), colour);
            }
        }
        for (int side = 0; side < 2; ++side) {
            const auto& leg = f_.legs[side];
            const Colour colour = colour_of(side ? "right" : "left");
            const Transform &foot = world[leg.ankle.value], &toes = world[leg.toes.value];
            line(page(foot.translation), page(foot * leg.heel_foot), colour);
            line(page(foot * leg.heel_foot), page(foot * leg.ball_foot), colour);
            line(page(toes * leg.ball_toes), page(toes * leg.toe_tip_toes), colour);
        }
    }
    void ball(Vec3 centre, double radius_m, double at_x, double at_y, bool front, Vec3 origin) {
        const Vec3 q = centre - origin;
        const double x = at_x + (front ? q.x : q.z), y = at_y - q.y;
        for (int i = 0; i < 24; ++i) {
            const double a = i * kPi / 12, b = a + kPi / 12;
            line({x + radius_m * std::cos(a), y + radius_m * std::sin(a)},
                 {x + radius_m * std::cos(b), y + radius_m * std::sin(b)}, {40, 150, 60});
        }
    }
    void floor(double y) { line({0, y}, {w_ / scale_, y}, {170, 170, 170}); }

    void save(const char* name) const {
        const char* folder = std::getenv("PUP_DRAW");
        FILE* file =
            folder ? std::fopen((std::string(folder) + "/" + name).c_str(), "wb") : nullptr;
        if (file != nullptr) {
            std::fprintf(file, "P6\n%d %d\n255\n", w_, h_);
            std::fwrite(pixels_.data(), 1, pixels_.size(), file);
            std::fclose(file);
        }
    }

 private:
    using Colour = std::array<unsigned char, 3>;
    static Colour colour_of(const std::string& name) {
        return name.rfind("right", 0) == 0  ? Colour{200, 50, 40}
               : name.rfind("left", 0) == 0 ? Colour{30, 110, 210}
                                            : Colour{30, 30, 30};
    }
    void line(std::array<double, 2> a, std::array<double, 2> b, Colour colour) {
        const double dx = (b[0] - a[0]) * scale_, dy = (b[1] - a[1]) * scale_;
        const int n = 1 + int(std::fmax(std::fabs(dx), std::fabs(dy)));
        for (int i = 0; i <= n; ++i) {
            const int x = int(a[0] * scale_ + dx * i / n), y = int(a[1] * scale_ + dy * i / n);
            for (int k = 0; k < 4; ++k) {
                const int px = x + k % 2, py = y + k / 2;
                if (px >= 0 && py >= 0 && px < w_ && py < h_) {
                    for (int c = 0; c < 3; ++c) {
                        pixels_[(static_cast<std::size_t>(py) * w_ + px) * 3 + c] = colour[c];
                    }
                }
            }
        }
    }
    const figure::Figure& f_;
    double scale_;
    int w_, h_;
    std::vector<unsigned char> pixels_;
};

}  // namespace puppetri::test
