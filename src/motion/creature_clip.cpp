// SPDX-License-Identifier: MIT
// With M(c) the model space of the clip's joints, a joint j of the figure that has the clip's joint
// c takes M(a)^-1 M(c), where a is the nearest joint above c that the figure has too; in front of
// it the joints of the figure between the two, which stay at rest, are taken off. The topmost ones
// take M(c) itself, lengths scaled. Travel: X(t) = R T(0)^-1 T(t) R^-1, where T is the planar place
// of the clip's root and R that of the figure's at rest; what the joints do is relative to T(t).
#include "creature_clip.h"

#include <algorithm>
#include <cmath>

#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

using figure::Figure;
using figure::JointIndex;
using figure::Pose;
using figure::Skeleton;

// Reused by every such clip of a thread; results never depend on what it holds.
struct Scratch {
    Pose pose;
    std::vector<Transform> model;
};

std::vector<Transform> model_at_rest(const Skeleton& skeleton) {
    std::vector<Transform> model(skeleton.joints.size());
    figure::to_model_space(skeleton, figure::rest_pose(skeleton), model);
    return model;
}

class CreatureSource final : public PoseSource {
 public:
    CreatureSource(std::shared_ptr<const Clip> clip, const Skeleton& skeleton, const Figure& figure,
                   double speed, double advances_m_s)
        : clip_(std::move(clip)),
          skeleton_(skeleton.joints.empty() ? figure.skeleton : skeleton),
          binding_(bind_clip(*clip_, skeleton_)),
          rest_(figure::rest_pose(skeleton_)),
          speed_(speed),
          advances_m_s_(advances_m_s) {
        find_numbers(figure);
        find_joints(figure, skeleton.joints.empty());
        find_travel(figure);
    }

    void fill(PosedSpec& spec) const {
        spec.dofs = dofs_;
        for (const Driven& d : driven_) {
            spec.joints.push_back(d.name);
            if (d.shifts) {
                spec.places.push_back(d.name);
            }
        }
        spec.travels = travels_ || advances_m_s_ != 0;
    }

    void sample(double t_s, PoseFrame& frame) const override {
        const double t = t_s * speed_;
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            frame.dofs[i] =
                motion::sample(clip_->numbers[numbers_[i]], t, clip_->loops, clip_->duration_s);
        }
        static thread_local Scratch s;
        model_at(t, s);
        Transform strip;
        frame.start_from_pelvis = {};
        if (travels_) {
            const Transform place = place_of(s.model);
            frame.start_from_pelvis = at_rest_ * from_first_ * place * inverse(at_rest_);
            strip = at_rest_ * inverse(place);
        }
        frame.start_from_pelvis.translation.z += advances_m_s_ * t_s;
        std::size_t shift = 0;
        for (std::size_t i = 0; i < driven_.size(); ++i) {
            const Driven& d = driven_[i];
            Transform local;
            if (d.above.valid()) {
                local = inverse(s.model[d.above.value]) * s.model[d.joint.value];
                local.translation = local.translation * scale_;
            } else {
                local = strip * placed(s.model[d.joint.value]);
            }
            local = d.parent_from_above * local;
            frame.joints[i] = normalized(local.rotation);
            if (d.shifts) {
                // Below the top what counts is by how much the clip's joint has shifted.
                frame.places[shift++] = d.above.valid()
                                            ? d.rest.translation + (local.translation - d.clip_rest)
                                            : local.translation;
            }
        }
    }

 private:
    struct Driven {
        std::string name;
        JointIndex joint, above;      // of the clip's skeleton
        Transform parent_from_above;  // of the figure, at rest: the joints between
        Transform rest;               // parent_from_joint of the figure
        Vec3 clip_rest;               // where the clip's skeleton has it at rest, scaled
        bool shifts = false;
    };

    void model_at(double t_s, Scratch& s) const {
        s.pose = rest_;
        s.model.resize(skeleton_.joints.size());
        sample_clip(*clip_, binding_, t_s, s.pose);
        figure::to_model_space(skeleton_, s.pose, s.model);
    }
    // From the clip's model space to the figure's.
    Transform placed(Transform model) const {
        model.translation = model.translation * scale_;
        model.translation.y += lift_m_;
        return model;
    }

    void find_numbers(const Figure& figure) {
        for (std::size_t i = 0; i < clip_->numbers.size(); ++i) {
            if (figure.dofs.find(clip_->numbers[i].target).valid()) {
                numbers_.push_back(i);
                dofs_.push_back(clip_->numbers[i].target);
            }
        }
    }

    void find_joints(const Figure& figure, bool own_skeleton) {
        const auto& joints = figure.skeleton.joints;
        std::vector<JointIndex> partner(joints.size());  // of the clip's skeleton
        std::vector<char> taken(skeleton_.joints.size(), 0);
        for (std::size_t j = 0; j < joints.size(); ++j) {
            // The root of a figure from a file is ours, on the floor; a joint of the file that was
            // called so has a number.
            const std::string& name = joints[j].name;
            if (own_skeleton || j != figure.root.value) {
                partner[j] = skeleton_.find(name);
                if (!partner[j].valid() && name == "root_2") {
                    partner[j] = skeleton_.find("root");
                }
            }
            if (partner[j].valid()) {
                taken[partner[j].value] = 1;
            }
        }
        std::vector<char> moves(skeleton_.joints.size(), own_skeleton ? 0 : 1);
        for (const auto* bound : {&binding_.rotations, &binding_.translations}) {
            for (const JointIndex j : *bound) {
                if (j.valid()) {
                    moves[j.value] = 1;
                }
            }
        }
        const std::vector<Transform> model = model_at_rest(figure.skeleton),
                                     clip_model = model_at_rest(skeleton_);
        double own = 0, others = 0;
        for (std::size_t j = 0; j < joints.size(); ++j) {
            if (!partner[j].valid() || moves[partner[j].value] == 0 || j == figure.root.value) {
                continue;
            }
            Driven d;
            d.name = joints[j].name;
            d.joint = partner[j];
            d.rest = joints[j].parent_from_joint_rest;
            d.above = skeleton_.joints[d.joint.value].parent;
            while (d.above.valid() && taken[d.above.value] == 0) {
                d.above = skeleton_.joints[d.above.value].parent;
            }
            const JointIndex parent = joints[j].parent;
            if (d.above.valid()) {
                const auto mine = static_cast<std::size_t>(
                    std::find(partner.begin(), partner.end(), d.above) - partner.begin());
                const Transform model_from_parent =
                    parent.valid() ? model[parent.value] : Transform{};
                d.parent_from_above = inverse(model_from_parent) * model[mine];
                own += length(model[j].translation - model[mine].translation);
                others += length(clip_model[d.joint.value].translation -
                                 clip_model[d.above.value].translation);
            } else if (parent.valid()) {
                d.parent_from_above = inverse(model[parent.value]);
            }
            driven_.push_back(std::move(d));
        }
        scale_ = own > 0 && others > 0 ? own / others : 1;
        finish_joints(clip_model);
    }

    void finish_joints(const std::vector<Transform>& clip_model) {
        const auto moved = [&](JointIndex joint, JointIndex above) {
            for (JointIndex j = joint; j.valid() && j != above;
                 j = skeleton_.joints[j.value].parent) {
                if (std::find(binding_.translations.begin(), binding_.translations.end(), j) !=
                    binding_.translations.end()) {
                    return true;
                }
            }
            return false;
        };
        for (Driven& d : driven_) {
            d.shifts = !d.above.valid() || moved(d.joint, d.above);
            if (d.above.valid()) {
                const Transform local =
                    inverse(clip_model[d.above.value]) * clip_model[d.joint.value];
                d.clip_rest = d.parent_from_above * (local.translation * scale_);
                constexpr double kSame = 0.02;
                const double mine = length(d.rest.translation);
                same_bones_ = same_bones_ &&
                              (d.shifts || std::fabs(length(d.clip_rest) - mine) < kSame * mine);
            } else if (!lifted_) {
                // The floor is where the figure's top joint says.
                const Transform rest = inverse(d.parent_from_above) * d.rest;
                lift_m_ = rest.translation.y - clip_model[d.joint.value].translation.y * scale_;
                lifted_ = true;
            }
        }
    }

    // Which joint travels: the clip's root, or the figure's topmost.
    void find_travel(const Figure& figure) {
        root_ = skeleton_.find(clip_->root);
        for (const Driven& d : driven_) {
            if (!root_.valid() && !d.above.valid()) {
                root_ = d.joint;
            }
        }
        if (!root_.valid() || driven_.empty()) {
            return;
        }
        const std::vector<Transform> at_rest = model_at_rest(skeleton_);
        root_rest_ = at_rest[root_.value].rotation;
        at_rest_ = {{}, placed(at_rest[root_.value]).translation};
        at_rest_.translation.y = 0;
        Scratch s;
        model_at(0, s);
        from_first_ = inverse(place_of(s.model));
        model_at(clip_->duration_s, s);
        const Transform whole = from_first_ * place_of(s.model);
        const double size_m = figure.height_m > 0 ? figure.height_m : 1;
        travels_ = length(whole.translation) > 0.05 * size_m ||
                   std::fabs(heading_of(whole.rotation)) > radians(5);
    }
    Transform place_of(const std::vector<Transform>& model) const {
        const Transform root = placed(model[root_.value]);
        return {about_y(heading_of(root.rotation * conjugate(root_rest_))),
                {root.translation.x, 0, root.translation.z}};
    }

    std::shared_ptr<const Clip> clip_;
    Skeleton skeleton_;
    ClipBinding binding_;
    Pose rest_;
    double speed_ = 1, advances_m_s_ = 0, scale_ = 1, lift_m_ = 0;
    bool lifted_ = false, travels_ = false, same_bones_ = true;
    std::vector<std::size_t> numbers_;
    std::vector<std::string> dofs_;
    std::vector<Driven> driven_;
    JointIndex root_;
    Quat root_rest_;
    Transform at_rest_, from_first_;
};

}  // namespace

CreatureClip make_creature_clip(const std::string& name, std::shared_ptr<const Clip> clip,
                                const Skeleton& skeleton, const Figure& figure, double speed,
                                double advances_m_s) {
    CreatureClip out;
    out.spec.name = name;
    out.spec.duration_s = clip->duration_s / speed;
    out.spec.loops = clip->loops;
    for (const ClipMark& mark : clip->marks) {
        if (mark.end_s <= mark.t_s) {
            out.spec.events.push_back({mark.t_s / speed, mark.name, Limb::kBody});
        }
    }
    auto source = std::make_shared<const CreatureSource>(std::move(clip), skeleton, figure, speed,
                                                         advances_m_s);
    source->fill(out.spec);
    out.source = std::move(source);
    return out;
}

}  // namespace puppetri::motion
