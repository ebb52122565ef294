// SPDX-License-Identifier: MIT
// Which nodes are joints, what their scales do to lengths, and keys out of accessors.
#include "puppetri/io/gltf_clips.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "clip_tidy.h"
#include "defects.h"
#include "puppetri/math/rotation.h"

namespace puppetri::io {
namespace {

using motion::Interpolation;

constexpr double kSplineTolerance_rad = 1e-4;
constexpr std::size_t kMostJoints = 10'000;
constexpr std::uint32_t kDeepest = 500;

struct Four {
    double v[4];
};
Four at(const std::vector<float>& values, std::size_t element) {
    return {{values[4 * element], values[4 * element + 1], values[4 * element + 2],
             values[4 * element + 3]}};
}
Quat unit(const Four& f) { return normalized(Quat{f.v[0], f.v[1], f.v[2], f.v[3]}); }

// A cubic spline of glTF between two keys: the four numbers by the Hermite polynomial, then made
// unit (glTF 2.0, appendix C.5).
struct SplineOfFour {
    Four a, out, b, in;
    double length_s = 0;

    Four value(double u) const {
        const double v = 1 - u;
        const double wa = v * v * (1 + 2 * u), wo = u * v * v * length_s, wb = u * u * (3 - 2 * u),
                     wi = -u * u * v * length_s;
        Four r{};
        for (int i = 0; i < 4; ++i) {
            r.v[i] = a.v[i] * wa + out.v[i] * wo + b.v[i] * wb + in.v[i] * wi;
        }
        return r;
    }
    Four slope(double u) const {  // per second
        const double v = 1 - u;
        const double wa = -6 * u * v / length_s, wo = v * (1 - 3 * u), wb = -wa,
                     wi = u * (3 * u - 2);
        Four r{};
        for (int i = 0; i < 4; ++i) {
            r.v[i] = a.v[i] * wa + out.v[i] * wo + b.v[i] * wb + in.v[i] * wi;
        }
        return r;
    }
};

// The body's angular velocity of the rotation q / |q|: twice the vector part of conj(q) q' / |q|^2.
Vec3 angular(const Four& q, const Four& slope) {
    const Quat a{q.v[0], q.v[1], q.v[2], q.v[3]};
    const Quat d{slope.v[0], slope.v[1], slope.v[2], slope.v[3]};
    const double n = a.x * a.x + a.y * a.y + a.z * a.z + a.w * a.w;
    const Quat p = conjugate(a) * d;
    return n > 1e-12 ? Vec3{p.x, p.y, p.z} * (2 / n) : Vec3{};
}

class Maker {
 public:
    Maker(const GltfDocument& document, const std::string& path, const ClipReadOptions& options)
        : g_(document), path_(path), unit_(options.scale > 0 ? options.scale : 1) {}

    Checked<ClipFile> make() {
        if (g_.animations.empty()) {
            defects_.error("no-animation", {path_, 0, 0, 1}, "", "the file has no animation",
                           "export it with its animations");
            return Unexpected(defects_.take());
        }
        joint_of_.assign(g_.nodes.size(), kNoGltf);
        bone_of_.assign(g_.nodes.size(), "");
        if (g_.vrm_animation) {
            for (const GltfBone& bone : g_.humanoid) {
                bone_of_[bone.node] = bone.bone;
            }
        }
        place_nodes();
        make_skeleton();
        if (defects_.any()) {
            return Unexpected(defects_.take());
        }
        if (!g_.vrm_animation) {
            make_names_unique(file_.skeleton, defects_, path_);
        }
        for (std::size_t i = 0; i < g_.animations.size(); ++i) {
            make_clip(i);
        }
        file_.format = g_.vrm_animation ? ClipFormat::kVrma : ClipFormat::kGltf;
        file_.skeleton.height_m = rest_height_m(file_.skeleton);
        tell_odd_scale(file_, unit_, defects_, path_);
        if (defects_.any()) {
            return Unexpected(defects_.take());
        }
        file_.notes.insert(file_.notes.end(), g_.notes.begin(), g_.notes.end());
        for (Diagnostic& d : defects_.take()) {
            file_.notes.push_back(std::move(d));
        }
        return std::move(file_);
    }

 private:
    // Where the nodes are at rest, parents first; scales multiply down the tree.
    void place_nodes() {
        model_.resize(g_.nodes.size());
        scale_.assign(g_.nodes.size(), 1);  // of what hangs from the node
        std::vector<std::uint32_t> open;
        for (std::uint32_t n = 0; n < g_.nodes.size(); ++n) {
            if (g_.nodes[n].parent == kNoGltf) {
                open.push_back(n);
            }
        }
        while (!open.empty()) {
            const std::uint32_t n = open.back();
            open.pop_back();
            order_.push_back(n);
            const GltfNode& node = g_.nodes[n];
            const double above = node.parent == kNoGltf ? unit_ : scale_[node.parent];
            Transform local = node.parent_from_node;
            local.translation = local.translation * above;
            model_[n] = node.parent == kNoGltf ? local : model_[node.parent] * local;
            scale_[n] = above * mean_scale(node, n);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                open.push_back(*child);
            }
        }
    }

    double mean_scale(const GltfNode& node, std::uint32_t n) {
        const Vec3 s = node.scale;
        const double mean = (std::fabs(s.x) + std::fabs(s.y) + std::fabs(s.z)) / 3;
        if (std::fabs(s.x - mean) + std::fabs(s.y - mean) + std::fabs(s.z - mean) > 1e-3 * mean &&
            !node.children.empty()) {
            warn("uneven-scale", g_.node_text(n),
                 "its scale is not the same in all directions, or mirrors; below it the mean is "
                 "used",
                 "apply the scale before the export");
        }
        return mean > 1e-9 ? mean : 1;
    }

    bool is_wanted(const std::vector<char>& useful, std::uint32_t n) const {
        if (g_.vrm_animation) {
            return !bone_of_[n].empty();
        }
        return useful[n] != 0;
    }

    void make_skeleton() {
        std::vector<char> useful(g_.nodes.size(), 0);
        for (const GltfSkin& skin : g_.skins) {
            for (const std::uint32_t joint : skin.joints) {
                useful[joint] = 1;
            }
        }
        for (const GltfAnimationIn& animation : g_.animations) {
            for (const GltfChannelIn& channel : animation.channels) {
                useful[channel.node] = 1;
            }
        }
        // Upwards: between useful nodes all, above the topmost those that turn or shift.
        std::vector<char> below(g_.nodes.size(), 0), above(g_.nodes.size(), 0);
        for (auto n = order_.rbegin(); n != order_.rend(); ++n) {
            if ((useful[*n] || below[*n]) && g_.nodes[*n].parent != kNoGltf) {
                below[g_.nodes[*n].parent] = 1;
            }
        }
        for (const std::uint32_t n : order_) {
            const GltfNode& node = g_.nodes[n];
            above[n] = node.parent != kNoGltf && (above[node.parent] || useful[node.parent]);
            if (below[n] && (above[n] || node.parent_from_node != Transform{})) {
                useful[n] = 1;
            }
        }
        std::vector<std::uint32_t> depth(g_.nodes.size(), 0);
        for (const std::uint32_t n : order_) {
            if (!is_wanted(useful, n)) {
                continue;
            }
            const GltfNode& node = g_.nodes[n];
            figure::Joint joint;
            std::uint32_t parent = node.parent;
            while (parent != kNoGltf && joint_of_[parent] == kNoGltf) {
                parent = g_.nodes[parent].parent;
            }
            if (parent != kNoGltf) {
                joint.parent = {joint_of_[parent]};
            }
            if (g_.vrm_animation) {
                // Rotations at rest are the identity: what is left are the places.
                joint.name = bone_of_[n];
                joint.parent_from_joint_rest.translation =
                    model_[n].translation -
                    (parent != kNoGltf ? model_[parent].translation : Vec3{});
            } else {
                joint.name = node.name.empty() ? "node_" + std::to_string(n) : node.name;
                joint.parent_from_joint_rest =
                    parent != kNoGltf ? inverse(model_[parent]) * model_[n] : model_[n];
                joint.parent_from_joint_rest.rotation =
                    normalized(joint.parent_from_joint_rest.rotation);
            }
            depth[n] = 1 + (parent != kNoGltf ? depth[parent] : 0);
            if (file_.skeleton.joints.size() == kMostJoints || depth[n] > kDeepest) {
                defects_.error("too-large", {path_, 0, 0, 1}, g_.node_text(n),
                               "there are more than " + std::to_string(kMostJoints) +
                                   " joints, or more than " + std::to_string(kDeepest) +
                                   " in a chain",
                               "split the figure");
                return;
            }
            if (!(length(model_[n].translation) < 1e9)) {
                defects_.error("bad-node", {path_, 0, 0, 1}, g_.node_text(n),
                               "it lies a million kilometres away, or nowhere",
                               "export the file anew, or name its unit with --scale");
                return;
            }
            joint_of_[n] = static_cast<std::uint32_t>(file_.skeleton.joints.size());
            file_.skeleton.joints.push_back(std::move(joint));
        }
    }

    std::string unique_name(std::string wanted) {
        if (wanted.empty()) {
            wanted = clip_name_of(path_);
        }
        std::string name = wanted;
        for (int i = 2; !names_.insert(name).second; ++i) {
            name = wanted + "_" + std::to_string(i);
        }
        return name;
    }

    void warn(const char* code, std::string element, std::string message, std::string remedy) {
        defects_.note(Severity::kWarning, code, {path_, 0, 0, 1}, std::move(element),
                      std::move(message), std::move(remedy));
    }

    void make_clip(std::size_t index) {
        const GltfAnimationIn& animation = g_.animations[index];
        motion::Clip clip;
        clip.name = unique_name(animation.name);
        for (const GltfChannelIn& channel : animation.channels) {
            const std::uint32_t joint = joint_of_[channel.node];
            if (joint == kNoGltf) {
                continue;  // of a VRM animation: what is no bone
            }
            const std::vector<float> times = g_.floats(channel.times);
            const std::vector<float> values = g_.floats(channel.values);
            if (times.empty()) {
                continue;
            }
            clip.duration_s = std::max(clip.duration_s, static_cast<double>(times.back()));
            const std::string element =
                "animation " + clip.name + ", " + g_.node_text(channel.node);
            switch (channel.path) {
                case GltfPath::kRotation:
                    clip.rotations.push_back({file_.skeleton.joints[joint].name, {}});
                    rotations(channel, times, values, element, clip.rotations.back().keys);
                    break;
                case GltfPath::kTranslation:
                    clip.translations.push_back({file_.skeleton.joints[joint].name, {}});
                    translations(channel, times, values, clip.translations.back().keys);
                    break;
                case GltfPath::kScale:
                    scales(channel, values, element);
                    break;
                case GltfPath::kWeights:
                    break;
            }
        }
        if (defects_.any()) {
            return;
        }
        for (const figure::Joint& joint : file_.skeleton.joints) {
            if (const motion::VectorTrack* track = clip.find_translation(joint.name);
                track != nullptr && track->keys.size() > 1) {
                clip.root = joint.name;
                break;
            }
        }
        drop_still_keys(clip);
        if (const Status status = motion::check(clip, path_); !status) {
            for (const Diagnostic& d : status.error()) {
                defects_.error(d.code.c_str(), d.where, "animation " + clip.name + ", " + d.element,
                               d.message, d.remedy);
            }
            return;
        }
        file_.clips.push_back(std::move(clip));
    }

    static Interpolation plain(GltfInterpolation i) {
        return i == GltfInterpolation::kStep ? Interpolation::kStep : Interpolation::kLinear;
    }

    // parent_from_joint of a node that is turned to q against its own parent, in our skeleton.
    Quat joint_rotation(std::uint32_t node, Quat q) const {
        const std::uint32_t parent = g_.nodes[node].parent;
        if (g_.vrm_animation) {
            // parent turn and rest turn taken off: rotations of the normalised humanoid.
            const Quat world = parent == kNoGltf ? Quat{} : model_[parent].rotation;
            return world * q * conjugate(model_[node].rotation);
        }
        return between(node).rotation * q;
    }
    // From the node's parent to the joint that ours hangs from: the identity unless nodes between
    // were left out, which stand still.
    Transform between(std::uint32_t node) const {
        const std::uint32_t parent = g_.nodes[node].parent;
        if (parent == kNoGltf || joint_of_[parent] != kNoGltf) {
            return {};
        }
        std::uint32_t above = parent;
        while (above != kNoGltf && joint_of_[above] == kNoGltf) {
            above = g_.nodes[above].parent;
        }
        return above == kNoGltf ? model_[parent] : inverse(model_[above]) * model_[parent];
    }
    Vec3 joint_translation(std::uint32_t node, Vec3 t) const {
        const std::uint32_t parent = g_.nodes[node].parent;
        t = t * (parent == kNoGltf ? unit_ : scale_[parent]);
        if (g_.vrm_animation) {
            const Vec3 model = parent == kNoGltf ? t : model_[parent] * t;
            const figure::JointIndex above = file_.skeleton.joints[joint_of_[node]].parent;
            if (!above.valid()) {
                return model;
            }
            std::uint32_t bone = parent;
            while (joint_of_[bone] != above.value) {
                bone = g_.nodes[bone].parent;
            }
            return model - model_[bone].translation;
        }
        return between(node) * t;
    }

    void rotations(const GltfChannelIn& channel, const std::vector<float>& times,
                   const std::vector<float>& values, const std::string& element,
                   std::vector<motion::RotationKey>& keys) {
        const bool spline = channel.interpolation == GltfInterpolation::kCubicSpline;
        const std::size_t step = spline ? 3 : 1, middle = spline ? 1 : 0;
        for (std::size_t k = 0; k < times.size(); ++k) {
            const Four four = at(values, step * k + middle);
            const double norm = four.v[0] * four.v[0] + four.v[1] * four.v[1] +
                                four.v[2] * four.v[2] + four.v[3] * four.v[3];
            if (!(norm > 0.25 && norm < 4)) {
                defects_.error("bad-rotation", {path_, 0, 0, 1},
                               element + ", key " + std::to_string(k + 1),
                               "this is no unit quaternion", "export the file anew");
                return;
            }
            motion::RotationKey key;
            key.t_s = static_cast<double>(times[k]);
            key.value = unit(four);
            key.interpolation = spline ? Interpolation::kHermite : plain(channel.interpolation);
            if (spline) {
                key.in = angular(four, at(values, 3 * k));
                key.out = angular(four, at(values, 3 * k + 2));
            }
            keys.push_back(key);
        }
        if (spline) {
            refine(times, values, keys);
        }
        for (motion::RotationKey& key : keys) {
            key.value = joint_rotation(channel.node, key.value);
            if (g_.vrm_animation) {  // the axes of the body have been turned
                key.in = rotate(model_[channel.node].rotation, key.in);
                key.out = rotate(model_[channel.node].rotation, key.out);
            }
        }
    }

    // Puts keys between those of the file, on its own curve, until the curve of rotations through
    // them is near enough.
    static void refine(const std::vector<float>& times, const std::vector<float>& values,
                       std::vector<motion::RotationKey>& keys) {
        std::vector<motion::RotationKey> fine;
        for (std::size_t k = 0; k + 1 < times.size(); ++k) {
            const double begin = static_cast<double>(times[k]);
            const SplineOfFour s{at(values, 3 * k + 1), at(values, 3 * k + 2),
                                 at(values, 3 * k + 4), at(values, 3 * k + 3),
                                 static_cast<double>(times[k + 1]) - begin};
            for (int parts = 1;; parts *= 2) {
                std::vector<motion::RotationKey> cut;
                for (int p = 0; p <= parts; ++p) {
                    const double u = static_cast<double>(p) / parts;
                    motion::RotationKey key;
                    key.t_s = begin + u * s.length_s;
                    key.value = unit(s.value(u));
                    key.interpolation = Interpolation::kHermite;
                    key.in = key.out = angular(s.value(u), s.slope(u));
                    cut.push_back(key);
                }
                double worst = 0;
                for (int p = 0; p < parts; ++p) {
                    const auto &a = cut[static_cast<std::size_t>(p)],
                               &b = cut[static_cast<std::size_t>(p) + 1];
                    for (const double r : {0.25, 0.5, 0.75}) {
                        const Quat ours =
                            hermite(a.value, a.out, b.value, b.in, s.length_s / parts, r);
                        worst =
                            std::max(worst, angle_between(ours, unit(s.value((p + r) / parts))));
                    }
                }
                if (worst <= kSplineTolerance_rad || parts >= 64) {
                    cut.front().in = keys[k].in;
                    cut.pop_back();
                    fine.insert(fine.end(), cut.begin(), cut.end());
                    break;
                }
            }
        }
        fine.push_back(keys.back());
        keys = std::move(fine);
    }

    void translations(const GltfChannelIn& channel, const std::vector<float>& times,
                      const std::vector<float>& values, std::vector<motion::VectorKey>& keys) {
        const bool spline = channel.interpolation == GltfInterpolation::kCubicSpline;
        const std::size_t step = spline ? 3 : 1, middle = spline ? 1 : 0;
        const auto vector = [&](std::size_t element) {
            return Vec3{static_cast<double>(values[3 * element]),
                        static_cast<double>(values[3 * element + 1]),
                        static_cast<double>(values[3 * element + 2])};
        };
        const Vec3 origin = joint_translation(channel.node, {});
        for (std::size_t k = 0; k < times.size(); ++k) {
            motion::VectorKey key;
            key.t_s = static_cast<double>(times[k]);
            key.value = joint_translation(channel.node, vector(step * k + middle));
            key.interpolation = spline ? Interpolation::kHermite : plain(channel.interpolation);
            if (spline) {
                key.in = joint_translation(channel.node, vector(3 * k)) - origin;
                key.out = joint_translation(channel.node, vector(3 * k + 2)) - origin;
            }
            keys.push_back(key);
        }
    }

    void scales(const GltfChannelIn& channel, const std::vector<float>& values,
                const std::string& element) {
        const Vec3 rest = g_.nodes[channel.node].scale;
        const bool spline = channel.interpolation == GltfInterpolation::kCubicSpline;
        for (std::size_t e = spline ? 1 : 0; 3 * e + 2 < values.size(); e += spline ? 3 : 1) {
            const Vec3 s{static_cast<double>(values[3 * e]), static_cast<double>(values[3 * e + 1]),
                         static_cast<double>(values[3 * e + 2])};
            if (length(s - rest) > 1e-3 * (1 + length(rest))) {
                warn("scale-dropped", element, "its scale changes, which joints here do not",
                     "figures keep their size; animate meshes instead");
                return;
            }
        }
    }

    const GltfDocument& g_;
    const std::string& path_;
    double unit_ = 1;
    Defects defects_;
    ClipFile file_;
    std::vector<std::uint32_t> order_;     // nodes, parents first
    std::vector<Transform> model_;         // at rest, in metres
    std::vector<double> scale_;            // of lengths below a node
    std::vector<std::uint32_t> joint_of_;  // by node
    std::vector<std::string> bone_of_;     // by node
    std::set<std::string> names_;
};

}  // namespace

Checked<ClipFile> clips_of(const GltfDocument& document, const std::string& path,
                           const ClipReadOptions& options) {
    return Maker(document, path, options).make();
}

}  // namespace puppetri::io
