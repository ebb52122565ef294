// SPDX-License-Identifier: MIT
// Frame by frame: the source's raw pose to its normalised humanoid, to handles, scaled, solved for
// the target, and to the target's raw skeleton.
#include "puppetri/motion/retarget.h"

#include <algorithm>

#include "puppetri/base/require.h"
#include "puppetri/motion/context.h"
#include "puppetri/motion/controls_from_pose.h"
#include "puppetri/motion/solve_controls.h"

namespace puppetri::motion {
namespace {

using figure::Figure;

double smooth(double u) { return u <= 0 ? 0 : u >= 1 ? 1 : u * u * (3 - 2 * u); }

double arm_m(const figure::Arm& arm) { return arm.upper_m + arm.fore_m; }
Vec3 shoulder_chest(const figure::Arm& arm) { return arm.clavicle_chest + arm.shoulder_clavicle; }

class Carrier {
 public:
    Carrier(const Clip& clip, const Performer& source, const Figure& target,
            const RetargetOptions& options)
        : clip_(clip),
          source_(source),
          from_(source.humanoid.figure),
          to_(target),
          options_(options),
          binding_(bind_clip(clip, source.skeleton)),
          raw_rest_(figure::rest_pose(source.skeleton)),
          model_(from_.skeleton.joints.size()) {
        // Legs and ankle: what a step is in proportion to.
        size_ = (to_.leg_m + to_.ankle_height_m) / (from_.leg_m + from_.ankle_height_m);
        travel_ = options.travel_scale > 0 ? options.travel_scale : size_;
        if (options.find_floor) {
            find_floor();
        }
    }

    // Writes the target's normalised pose at that time.
    void carry(double t_s, figure::Pose& out) {
        pose_at(t_s);
        Controls c;
        controls_from_pose(from_, pose_, kAllLimbs, c);
        scale(c, t_s);
        const SolveOutcome outcome = solve_controls(to_, c, out);
        for (const int side : {figure::kLeft, figure::kRight}) {
            worst_foot_m_ = std::fmax(worst_foot_m_, outcome.leg_residual_m[side]);
            if (c.arms[side].world_weight >= 1) {
                worst_hand_m_ = std::fmax(worst_hand_m_, outcome.arm_residual_m[side]);
            }
            // Fingers have no handles: their bends are the source's.
            for (int i = 0; i < figure::kFingerJointCount; ++i) {
                out.parent_from_joint[to_.arms[side].fingers[i].value].rotation =
                    pose_.parent_from_joint[from_.arms[side].fingers[i].value].rotation;
            }
        }
    }

    double worst_foot_m() const { return worst_foot_m_; }
    double worst_hand_m() const { return worst_hand_m_; }

 private:
    // The source's humanoid: pose_ and model_.
    void pose_at(double t_s) {
        raw_ = raw_rest_;
        sample_clip(clip_, binding_, t_s, raw_);
        source_.humanoid.rig.to_figure(from_, source_.skeleton, raw_, pose_);
        pose_.parent_from_joint[from_.root.value].translation.y -= floor_m_;
        figure::to_model_space(from_.skeleton, pose_, model_);
    }

    void find_floor() {
        constexpr int kLooks = 400;
        std::vector<double> lowest;
        for (int i = 0; i <= kLooks; ++i) {
            pose_at(clip_.duration_s * i / kLooks);
            double low = 1e300;
            for (const figure::Leg& leg : from_.legs) {
                const Transform &foot = model_[leg.ankle.value], &toes = model_[leg.toes.value];
                low = std::min({low, (foot * leg.heel_foot).y, (toes * leg.ball_toes).y,
                                (toes * leg.toe_tip_toes).y});
            }
            lowest.push_back(low);
        }
        const auto tenth = lowest.begin() + kLooks / 10;
        std::nth_element(lowest.begin(), tenth, lowest.end());
        floor_m_ = std::fabs(*tenth) > 0.01 ? *tenth : 0;
    }

    // Of a point of the world: the floor is scaled with the travel, heights with the figure.
    Vec3 scaled(Vec3 p) const { return {p.x * travel_, p.y * size_, p.z * travel_}; }

    void scale(Controls& c, double t_s) const {
        // Hips and feet are seen from the middle of the body: it travels by one scale, what is
        // around it has the figure's own.
        const Vec3 hips = c.pelvis.position_world;
        const Vec3 middle{hips.x, 0, hips.z};
        const auto place = [&](Vec3 p) {
            if (travel_ == size_) {
                return scaled(p);
            }
            return scaled(middle) + (p - middle) * size_;
        };
        c.pelvis.position_world = place(hips);
        for (const int side : {figure::kLeft, figure::kRight}) {
            // The sole's height is what counts: the ankle is over it by the figure's own measure.
            Vec3& ankle = c.legs[side].ankle_world;
            const double over_m = ankle.y - from_.ankle_height_m;
            ankle = place(ankle);
            ankle.y = over_m * size_ + to_.ankle_height_m;

            ArmControl& arm = c.arms[side];
            const figure::Arm &was = from_.arms[side], &is = to_.arms[side];
            const double reach = arm_m(is) / arm_m(was);
            Vec3& hand = arm.chest_from_hand.translation;
            hand = shoulder_chest(is) + (hand - shoulder_chest(was)) * reach;
            if (const double weight = contact_weight(side, t_s); weight > 0) {
                // The palm is what touches.
                const Transform& hand_world = model_[was.hand.value];
                const Vec3 palm = hand_world * was.hand_from_palm.translation;
                const Vec3 there{palm.x * travel_, palm.y, palm.z * travel_};
                arm.world_from_hand = {
                    hand_world.rotation,
                    there - rotate(hand_world.rotation, is.hand_from_palm.translation)};
                arm.world_weight = weight;
            }
        }
    }

    double contact_weight(int side, double t_s) const {
        const figure::JointIndex hand = from_.arms[side].hand;
        const std::string& bone = from_.skeleton.joints[hand.value].name;
        std::string_view raw;
        for (const figure::RigBone& b : source_.humanoid.rig.bones) {
            if (b.bone == hand) {
                raw = source_.skeleton.joints[b.joint.value].name;
            }
        }
        double weight = 0;
        for (const ClipMark& mark : clip_.marks) {
            if (mark.name == "contact" && (mark.target == bone || mark.target == raw)) {
                const double blend = std::fmax(options_.hand_blend_s, 1e-6);
                weight = std::fmax(weight, std::fmin(smooth(1 + (t_s - mark.t_s) / blend),
                                                     smooth(1 + (mark.end_s - t_s) / blend)));
            }
        }
        return weight;
    }

    const Clip& clip_;
    const Performer& source_;
    const Figure& from_;
    const Figure& to_;
    RetargetOptions options_;
    ClipBinding binding_;
    figure::Pose raw_rest_, raw_, pose_;
    std::vector<Transform> model_;
    double size_ = 1, travel_ = 1, floor_m_ = 0;
    double worst_foot_m_ = 0, worst_hand_m_ = 0;
};

// Tracks of a skeleton, filled pose by pose; what never moves keeps one key, what is at rest none.
class Recorder {
 public:
    Recorder(const Clip& like, const figure::Skeleton& skeleton) : skeleton_(skeleton) {
        out_.name = like.name;
        out_.duration_s = like.duration_s;
        out_.loops = like.loops;
        out_.marks = like.marks;
        for (const figure::Joint& joint : skeleton.joints) {
            out_.rotations.push_back({joint.name, {}});
            out_.translations.push_back({joint.name, {}});
        }
    }
    void add(double t_s, const figure::Pose& pose) {
        for (std::size_t j = 0; j < pose.parent_from_joint.size(); ++j) {
            RotationKey& turn = out_.rotations[j].keys.emplace_back();
            turn.t_s = t_s;
            turn.value = pose.parent_from_joint[j].rotation;
            VectorKey& place = out_.translations[j].keys.emplace_back();
            place.t_s = t_s;
            place.value = pose.parent_from_joint[j].translation;
        }
    }
    Clip clip(std::string root) {
        out_.root = std::move(root);
        const auto thin = [&](auto& tracks, auto at_rest, auto same) {
            std::size_t j = 0;
            std::erase_if(tracks, [&](auto& track) {
                const auto rest = at_rest(skeleton_.joints[j++]);
                const auto& first = track.keys.front().value;
                const bool still =
                    std::all_of(track.keys.begin(), track.keys.end(),
                                [&](const auto& key) { return same(key.value, first); });
                if (still) {
                    track.keys.resize(1);
                }
                return still && same(first, rest);
            });
        };
        thin(
            out_.rotations,
            [](const figure::Joint& j) { return j.parent_from_joint_rest.rotation; },
            [](Quat a, Quat b) { return angle_between(a, b) < 1e-7; });
        thin(
            out_.translations,
            [](const figure::Joint& j) { return j.parent_from_joint_rest.translation; },
            [](Vec3 a, Vec3 b) { return length(a - b) < 1e-7; });
        return std::move(out_);
    }

 private:
    const figure::Skeleton& skeleton_;
    Clip out_;
};

std::vector<double> instants(const Clip& clip, double rate_hz) {
    PUP_REQUIRE(rate_hz > 0);
    std::vector<double> times;
    for (std::size_t k = 0; static_cast<double>(k) / rate_hz < clip.duration_s - 1e-9; ++k) {
        times.push_back(static_cast<double>(k) / rate_hz);
    }
    times.push_back(clip.duration_s);
    return times;
}

}  // namespace

Retargeted retarget(const Clip& clip, const Performer& source, const Performer& target,
                    const RetargetOptions& options) {
    const Figure& figure = target.humanoid.figure;
    Carrier carrier(clip, source, figure, options);
    Recorder recorder(clip, target.skeleton);
    figure::Pose pose, raw;
    for (const double t : instants(clip, options.rate_hz)) {
        carrier.carry(t, pose);
        target.humanoid.rig.to_raw(figure, target.skeleton, pose, raw);
        recorder.add(t, raw);
    }
    return {recorder.clip(target.skeleton.joints[target.humanoid.rig.raw_root.value].name),
            carrier.worst_foot_m(), carrier.worst_hand_m()};
}

Retargeted retarget(const Clip& clip, const Performer& source, const figure::Figure& target,
                    const RetargetOptions& options) {
    Carrier carrier(clip, source, target, options);
    Recorder recorder(clip, target.skeleton);
    figure::Pose pose;
    for (const double t : instants(clip, options.rate_hz)) {
        carrier.carry(t, pose);
        recorder.add(t, pose);
    }
    return {recorder.clip(target.skeleton.joints[target.root.value].name), carrier.worst_foot_m(),
            carrier.worst_hand_m()};
}

}  // namespace puppetri::motion
