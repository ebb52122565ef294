// SPDX-License-Identifier: MIT
// How the channels come about. BVH knows no rest rotations: with all channels zero every joint's
// axes are parallel to the world's. With R(j) the rotation of joint j in the model at rest, p its
// parent and L(j) its rotation relative to p, the axes that are parallel to the model's at rest
// turn relative to each other by R(p) L(j) R(j)^-1: zero at rest, whatever axes the skeleton uses.
// Offsets are in the model's axes for the same reason.
#include "puppetri/io/bvh_writer.h"

#include <algorithm>
#include <cmath>

#include "puppetri/io/atomic_file.h"
#include "puppetri/math/rotation.h"
#include "rest_pose.h"

namespace puppetri::io {
namespace {

constexpr double kDegrees = 180 / kPi;

// Appends the value with six decimals: 10 nanometres, 4e-9 of a turn. Needs |value| below 9e9.
void append_fixed(std::string& text, double value) {
    std::int64_t millionths = std::llround(value * 1e6);
    if (millionths < 0) {
        text += '-';
        millionths = -millionths;
    }
    char digits[24];
    char* at = digits + sizeof digits;
    for (int i = 0; i <= 6 || millionths != 0; ++i) {
        if (i == 6) {
            *--at = '.';
        }
        *--at = static_cast<char>('0' + millionths % 10);
        millionths /= 10;
    }
    text.append(at, static_cast<std::size_t>(digits + sizeof digits - at));
}

void append_vector(std::string& text, Vec3 v) {
    for (const double part : {v.x, v.y, v.z}) {
        text += ' ';
        append_fixed(text, part);
    }
}

Vec3 nearest_turns(Vec3 angles, Vec3 before) {
    const auto near = [](double angle, double goal) {
        return angle + 2 * kPi * std::nearbyint((goal - angle) / (2 * kPi));
    };
    return {near(angles.x, before.x), near(angles.y, before.y), near(angles.z, before.z)};
}

// One joint as it is written: which of the skeleton, below which other written joint, its children.
struct Part {
    std::size_t joint = 0;
    std::vector<std::size_t> children;  // parts
    bool six_channels = false;
};

class Writer {
 public:
    Writer(const Take& take, std::size_t actor, const BvhOptions& options)
        : take_(take),
          actor_(take.actors[actor]),
          options_(options),
          scale_(options.unit == LengthUnit::kMetre ? 1 : 100),
          rest_(model_from_rest(actor_.skeleton)) {
        const auto& joints = actor_.skeleton.joints;
        const figure::JointIndex hips = actor_.hips;
        // In the mode kHips the root does nothing: it is left out, and hips is the first.
        const auto of_root = std::count_if(
            joints.begin(), joints.end(),
            [](const figure::Joint& joint) { return joint.parent == figure::JointIndex{0}; });
        const bool hips_first = hips.valid() && of_root == 1 &&
                                joints[hips.value].parent == figure::JointIndex{0} &&
                                root_is_still();
        std::vector<std::size_t> part_of(joints.size(), 0);
        for (std::size_t j = hips_first ? 1 : 0; j < joints.size(); ++j) {
            part_of[j] = parts_.size();
            const bool first = parts_.empty() || !joints[j].parent.valid();
            parts_.push_back({j, {}, first || hips.value == j || shifts(j)});
            if (first) {
                trees_.push_back(part_of[j]);
            } else {
                const std::size_t parent = joints[j].parent.value;
                parts_[hips_first && parent == 0 ? 0 : part_of[parent]].children.push_back(
                    part_of[j]);
            }
        }
    }

    std::string text() {
        text_ = "HIERARCHY\n";
        for (const std::size_t tree : trees_) {
            write_part(tree, 0);
        }
        write_motion();
        return std::move(text_);
    }

 private:
    // Whether the joint is ever elsewhere than at rest, seen from its parent.
    bool shifts(std::size_t joint) const {
        const auto& joints = actor_.skeleton.joints;
        const Vec3 rest = joints[joint].parent_from_joint_rest.translation;
        for (std::size_t key = 0; key < take_.times.size(); ++key) {
            const Vec3 at = actor_.parent_from_joint[key * joints.size() + joint].translation;
            if (length(at - rest) > 1e-6) {
                return true;
            }
        }
        return false;
    }
    bool root_is_still() const {
        const std::size_t joints = actor_.skeleton.joints.size();
        for (std::size_t key = 0; key < take_.times.size(); ++key) {
            if (actor_.parent_from_joint[key * joints] != Transform{}) {
                return false;
            }
        }
        return true;
    }

    // From the parent's origin to the joint's, at rest, in the model's axes.
    Vec3 offset_model(std::size_t joint) const {
        const figure::JointIndex parent = actor_.skeleton.joints[joint].parent;
        return rest_[joint].translation -
               (parent.valid() ? rest_[parent.value].translation : Vec3{});
    }

    void indent(int depth) { text_.append(static_cast<std::size_t>(depth), '\t'); }

    void write_part(std::size_t part, int depth) {
        const Part& p = parts_[part];
        const figure::Joint& joint = actor_.skeleton.joints[p.joint];
        order_.push_back(part);
        indent(depth);
        text_ += depth == 0 ? "ROOT " : "JOINT ";
        text_ += bone_name(options_.names, joint.name) + "\n";
        indent(depth);
        text_ += "{\n";
        indent(depth + 1);
        text_ += "OFFSET";
        append_vector(text_, p.six_channels ? Vec3{} : offset_model(p.joint) * scale_);
        text_ += '\n';
        indent(depth + 1);
        text_ += p.six_channels
                     ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
                     : "CHANNELS 3 Zrotation Xrotation Yrotation\n";
        for (const std::size_t child : p.children) {
            write_part(child, depth + 1);
        }
        if (p.children.empty()) {
            indent(depth + 1);
            text_ += "End Site\n";
            indent(depth + 1);
            text_ += "{\n";
            indent(depth + 2);
            text_ += "OFFSET";
            append_vector(text_, rotate(rest_[p.joint].rotation, joint.end_site_joint) * scale_);
            text_ += '\n';
            indent(depth + 1);
            text_ += "}\n";
        }
        indent(depth);
        text_ += "}\n";
    }

    void write_motion() {
        text_ += "MOTION\nFrames: " + std::to_string(take_.frame_keys.size()) + "\nFrame Time: ";
        // Nine decimals: after an hour the error is a twentieth of a millisecond.
        const double frame_time_s = 1 / take_.rate.per_second();
        std::string time = std::to_string(static_cast<std::int64_t>(frame_time_s));
        const std::string decimals =
            std::to_string(std::llround(frame_time_s * 1e9) % 1'000'000'000);
        text_ += time + "." + std::string(9 - decimals.size(), '0') + decimals + "\n";

        const std::size_t joints = actor_.skeleton.joints.size();
        std::vector<Vec3> before(joints);
        text_.reserve(text_.size() + take_.frame_keys.size() * joints * 32);
        for (const std::uint32_t key : take_.frame_keys) {
            const Transform* pose = &actor_.parent_from_joint[key * joints];
            const std::size_t line = text_.size();
            for (const std::size_t part : order_) {
                const Part& p = parts_[part];
                const figure::JointIndex parent = actor_.skeleton.joints[p.joint].parent;
                const Quat model_from_parent =
                    parent.valid() ? rest_[parent.value].rotation : Quat{};
                if (p.six_channels) {
                    append_vector(text_,
                                  rotate(model_from_parent, pose[p.joint].translation) * scale_);
                }
                const Quat turn =
                    model_from_parent * pose[p.joint].rotation * conjugate(rest_[p.joint].rotation);
                before[p.joint] = euler_zxy_rad(turn, before[p.joint]);
                const Vec3 degrees = before[p.joint] * kDegrees;
                append_vector(text_, {degrees.z, degrees.x, degrees.y});
            }
            text_.erase(line, 1);  // the blank before the first number
            text_ += '\n';
        }
    }

    const Take& take_;
    const TakeActor& actor_;
    const BvhOptions& options_;
    double scale_ = 100;
    std::vector<Transform> rest_;  // model_from_joint at rest
    std::vector<Part> parts_;
    std::vector<std::size_t> trees_;  // parts without a parent
    std::vector<std::size_t> order_;  // parts, depth first: the order of the channels
    std::string text_;
};

}  // namespace

// With c and s of the angles z, x, y, the matrix Rz Rx Ry has in its rows
//   (cz cy - sz sx sy,  -sz cx,  cz sy + sz sx cy)
//   (sz cy + cz sx sy,   cz cx,  sz sy - cz sx cy)
//   (-cx sy,             sx,     cx cy).
Vec3 euler_zxy_rad(Quat q, Vec3 before) {
    const double m01 = 2 * (q.x * q.y - q.z * q.w), m11 = 1 - 2 * (q.x * q.x + q.z * q.z);
    const double m20 = 2 * (q.x * q.z - q.y * q.w), m22 = 1 - 2 * (q.x * q.x + q.y * q.y);
    const double m21 = 2 * (q.y * q.z + q.x * q.w);
    const double cosine = std::sqrt(m01 * m01 + m11 * m11);
    const double x = std::atan2(m21, cosine);
    if (cosine < 1e-9) {
        // sx = +-1: the first row is (cos(z +- y), 0, +-sin(z +- y)); only the sum or difference is
        // known.
        const double m00 = 1 - 2 * (q.y * q.y + q.z * q.z), m10 = 2 * (q.x * q.y + q.z * q.w);
        const double both = std::atan2(m10, m00);
        const double y = before.y;
        return nearest_turns({x, y, both - (m21 > 0 ? y : -y)}, before);
    }
    const Vec3 plain = nearest_turns({x, std::atan2(-m20, m22), std::atan2(-m01, m11)}, before);
    const Vec3 other = nearest_turns({kPi - plain.x, plain.y + kPi, plain.z + kPi}, before);
    const auto distance = [&](Vec3 v) {
        return std::fabs(v.x - before.x) + std::fabs(v.y - before.y) + std::fabs(v.z - before.z);
    };
    return distance(plain) <= distance(other) ? plain : other;
}

std::string make_bvh(const Take& take, std::size_t actor, const BvhOptions& options) {
    PUP_REQUIRE(actor < take.actors.size());
    return Writer(take, actor, options).text();
}

std::string bvh_path(const std::string& path, const std::string& actor) {
    const std::string stem = path.ends_with(".bvh") ? path.substr(0, path.size() - 4) : path;
    return stem + "_" + node_name(actor) + ".bvh";
}

Checked<std::vector<std::string>> write_bvh(const std::string& path, const Take& take,
                                            const BvhOptions& options) {
    std::vector<AtomicFile> files;
    std::vector<std::string> paths;
    for (std::size_t a = 0; a < take.actors.size(); ++a) {
        paths.push_back(bvh_path(path, take.actors[a].name));
        PUP_TRY(AtomicFile file, AtomicFile::open(paths.back()));
        PUP_TRY(Ok written, file.write(make_bvh(take, a, options)));
        static_cast<void>(written);
        files.push_back(std::move(file));
    }
    for (AtomicFile& file : files) {
        PUP_TRY(Ok committed, file.commit());
        static_cast<void>(committed);
    }
    return paths;
}

}  // namespace puppetri::io
