// SPDX-License-Identifier: MIT
#include "support/example_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "puppetri/io/disk_files.h"

namespace puppetri::test {
namespace {

constexpr double kRate_hz = 480;

SimTime at(double t_s) {
    return {static_cast<std::int64_t>(std::nearbyint(t_s * kTicksPerSecond))};
}

[[noreturn]] void give_up(const std::string& name, const Diagnostics& why) {
    for (const Diagnostic& d : why) {
        std::fprintf(stderr, "%s: %s: %s\n", name.c_str(), d.element.c_str(), d.message.c_str());
    }
    std::abort();
}

}  // namespace

figure::Figure Example::figure(std::uint32_t actor) const {
    return figure::make_mannequin(scene->play.cast.actors[actor].height_m);
}

const Example& example(const std::string& name) {
    static std::vector<std::unique_ptr<Example>> known;
    for (const auto& one : known) {
        if (one->name == name) {
            return *one;
        }
    }
    io::DiskFiles files;
    auto loaded = scene::load(files, PUP_SOURCE_DIR "/examples/" + name);
    if (!loaded) {
        give_up(name, loaded.error());
    }
    auto made = std::make_unique<Example>();
    made->name = name;
    made->scene = std::make_unique<scene::Scene>(std::move(*loaded));
    auto performed = scene::perform(*made->scene);
    if (!performed) {
        give_up(name, performed.error());
    }
    made->performed = std::move(*performed);
    known.push_back(std::move(made));
    return *known.back();
}

std::vector<Planted> planted_of(const Example& e, std::uint32_t actor, double end_s) {
    std::vector<Planted> planted;
    const int count = static_cast<int>(std::floor(end_s * kRate_hz + 1e-6));
    for (int side = 0; side < 2; ++side) {
        const motion::Limb leg = side == 0 ? motion::Limb::kLeftLeg : motion::Limb::kRightLeg;
        bool was = false;
        for (int i = 0; i <= count; ++i) {
            const bool on =
                e.performance().phase({actor}, leg, at(i / kRate_hz)) == motion::Phase::kSupport;
            if (on && !was) {
                planted.push_back({side, i / kRate_hz, i / kRate_hz});
            }
            if (on) {
                planted.back().end_s = i / kRate_hz;
            }
            was = on;
        }
    }
    return planted;
}

std::vector<double> joins_of(const Example& e, std::uint32_t actor, double end_s) {
    std::vector<double> joins;
    for (const stage::ScoreEntry& entry : e.performance().score()) {
        const double t = entry.start.seconds();
        if (entry.actor == e.actor(actor) && t > 0 && t < end_s) {
            joins.push_back(t);
        }
    }
    std::sort(joins.begin(), joins.end());
    joins.erase(std::unique(joins.begin(), joins.end()), joins.end());
    return joins;
}

Measures measured_on_stage(const Example& e, std::uint32_t actor, double begin_s, double end_s) {
    const figure::Figure figure = e.figure(actor);
    figure::Pose pose;
    return measure({.figure = figure,
                    .sample =
                        [&](double t, std::span<Transform> world) {
                            e.performance().pose({actor}, at(t), pose);
                            figure::to_model_space(figure.skeleton, pose, world);
                        },
                    .begin_s = begin_s,
                    .end_s = end_s,
                    .rate_hz = kRate_hz,
                    .planted = planted_of(e, actor, end_s),
                    .joins_s = joins_of(e, actor, end_s)});
}

std::vector<Stretch> stretches_of(const Example& e, std::uint32_t actor, double end_s) {
    std::vector<Stretch> list;
    for (const stage::ScoreEntry& entry : e.performance().score()) {
        const double t = entry.start.seconds();
        if (entry.actor == e.actor(actor) && entry.limbs.has(motion::Limb::kPelvis) && t < end_s) {
            if (!list.empty()) {
                list.back().end_s = t;
            }
            list.push_back({entry.movement, entry.place, t, end_s});
        }
    }
    return list;
}

}  // namespace puppetri::test
