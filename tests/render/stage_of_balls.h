// SPDX-License-Identifier: MIT
// A performance by formula for tests of pictures: walking mannequins and balls whose places are
// known in closed form.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "puppetri/figure/mannequin.h"
#include "puppetri/figure/mannequin_mesh.h"
#include "puppetri/figure/palette.h"
#include "puppetri/figure/prop_mesh.h"
#include "puppetri/math/rotation.h"
#include "puppetri/stage/performance.h"

namespace puppetri::test {

class StageOfBalls final : public stage::Performance {
 public:
    explicit StageOfBalls(double duration_s) : duration_s_(duration_s) {
        figures_.reserve(4);
        meshes_.reserve(16);
    }

    // At most four actors; their roots follow `place`.
    void add_actor(double height_m, std::function<Transform(double t_s)> place) {
        figures_.push_back(figure::make_mannequin(height_m));
        meshes_.push_back(
            figure::make_mannequin_mesh(figures_.back().skeleton, *figure::find_palette("teal")));
        roots_.push_back(std::move(place));
        actors_.push_back({"actor", &figures_.back().skeleton, &meshes_.back()});
    }
    // At most twelve balls, or boxes.
    void add_ball(double diameter_m, std::function<Transform(double t_s)> place) {
        meshes_.push_back(figure::make_ball_mesh(diameter_m, *figure::find_palette("violet")));
        places_.push_back(std::move(place));
        props_.push_back({"ball",
                          stage::PropShape::kSphere,
                          {diameter_m, diameter_m, diameter_m},
                          &meshes_.back()});
    }

    static SimTime instant(double t_s) {
        return {static_cast<std::int64_t>(t_s * static_cast<double>(kTicksPerSecond))};
    }

    SimTime duration() const override { return instant(duration_s_); }
    std::span<const stage::ActorView> actors() const override { return actors_; }
    std::span<const stage::PropView> props() const override { return props_; }
    std::span<const stage::ScoreEntry> score() const override { return {}; }
    std::span<const stage::StageEvent> events() const override { return {}; }
    void pose(stage::ActorIndex actor, SimTime at, figure::Pose& out) const override {
        out = figure::rest_pose(figures_[actor.value].skeleton);
        out.parent_from_joint[0] = roots_[actor.value](at.seconds());
    }
    Transform world_from_prop(stage::PropIndex prop, SimTime at) const override {
        return places_[prop.value](at.seconds());
    }
    std::string holder(stage::PropIndex, SimTime) const override { return "air"; }
    motion::Phase phase(stage::ActorIndex, motion::Limb, SimTime) const override {
        return motion::Phase::kFree;
    }

 private:
    double duration_s_;
    std::vector<figure::Figure> figures_;
    std::vector<figure::Mesh> meshes_;
    std::vector<std::function<Transform(double)>> roots_, places_;
    std::vector<stage::ActorView> actors_;
    std::vector<stage::PropView> props_;
};

}  // namespace puppetri::test
