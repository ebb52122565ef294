// SPDX-License-Identifier: MIT
// Keyframe files out. Numbers are the shortest that read back with the same bits; what has its
// default is not said.
#include "puppetri/base/text.h"
#include "puppetri/io/keys_file.h"

namespace puppetri::io {
namespace {

class Writer {
 public:
    std::string write(const ClipFile& file) {
        text_ = "keys 1\n";
        if (file.frame_s > 0) {
            // Only what gives back the same frame time may be said.
            if (1 / (1 / file.frame_s) == file.frame_s) {
                text_ += "frames" + number(1 / file.frame_s) + "\n";
            }
        }
        if (!file.skeleton.joints.empty()) {
            text_ += "height" + number(file.skeleton.height_m) + "\n";
        }
        for (const figure::Joint& joint : file.skeleton.joints) {
            text_ += "joint " + name(joint.name) + " " +
                     (joint.parent.valid() ? name(file.skeleton.joints[joint.parent.value].name)
                                           : std::string("-")) +
                     value(joint.parent_from_joint_rest.translation);
            if (joint.parent_from_joint_rest.rotation != Quat{}) {
                text_ += " turned" + value(joint.parent_from_joint_rest.rotation);
            }
            if (joint.end_site_joint != Vec3{}) {
                text_ += " end" + value(joint.end_site_joint);
            }
            text_ += "\n";
        }
        for (const motion::Clip& clip : file.clips) {
            write(clip);
        }
        return std::move(text_);
    }

 private:
    static std::string number(double x) { return " " + number_to_text(x); }
    static std::string value(double x) { return number(x); }
    static std::string value(Vec3 v) { return number(v.x) + number(v.y) + number(v.z); }
    static std::string value(Quat q) {
        return number(q.x) + number(q.y) + number(q.z) + number(q.w);
    }
    // In quotes where the name would be taken for something else. Quotes and line ends have no way
    // to be said.
    static std::string name(std::string_view text) {
        std::string plain;
        for (const char c : text) {
            plain += c == '"' ? '\'' : c == '\n' || c == '\r' ? ' ' : c;
        }
        const bool quoted = plain.empty() || plain == "-" || plain == ".." ||
                            plain.find_first_of(" \t#") != std::string::npos;
        return quoted ? '"' + plain + '"' : plain;
    }

    void write(const motion::Clip& clip) {
        text_ += "\nclip " + name(clip.name) + " lasts" + number(clip.duration_s);
        text_ += clip.loops ? " loops" : "";
        text_ += clip.root.empty() ? "" : " root " + name(clip.root);
        text_ += "\n";
        for (const motion::ClipMark& mark : clip.marks) {
            text_ += "mark" + number(mark.t_s);
            text_ += mark.end_s > mark.t_s ? " .." + number(mark.end_s) : "";
            text_ += " " + name(mark.name);
            text_ += mark.target.empty() ? "" : " " + name(mark.target);
            text_ += "\n";
        }
        tracks(clip.translations, "translation ");
        tracks(clip.rotations, "rotation ");
        tracks(clip.numbers, "number ");
    }

    template <class Key>
    void tracks(const std::vector<motion::ClipTrack<Key>>& list, const char* kind) {
        for (const motion::ClipTrack<Key>& track : list) {
            const motion::Interpolation usual = track.keys.empty()
                                                    ? motion::Interpolation::kLinear
                                                    : track.keys.front().interpolation;
            text_ += kind + name(track.target);
            if (usual != motion::Interpolation::kLinear) {
                text_ += " " + std::string(motion::name_of(usual));
            }
            text_ += "\n";
            for (const Key& key : track.keys) {
                write(key, usual);
            }
        }
    }

    template <class Key>
    void write(const Key& key, motion::Interpolation usual) {
        text_ += " " + number(key.t_s) + value(key.value);
        if (key.interpolation != usual) {
            text_ += " " + std::string(motion::name_of(key.interpolation));
        }
        const auto unless_zero = [&](const char* word, double x) {
            text_ += x != 0 ? word + number(x) : "";
        };
        unless_zero(" tension", key.shape.tension);
        unless_zero(" continuity", key.shape.continuity);
        unless_zero(" bias", key.shape.bias);
        text_ += key.in == typename Key::Rate{} ? "" : " in" + value(key.in);
        text_ += key.out == typename Key::Rate{} ? "" : " out" + value(key.out);
        if (!(key.easing == Easing{})) {
            text_ += " easing" + number(key.easing.x1) + number(key.easing.y1) +
                     number(key.easing.x2) + number(key.easing.y2);
        }
        text_ += "\n";
    }
    std::string text_;
};

}  // namespace

std::string make_keys(const ClipFile& file) { return Writer().write(file); }

}  // namespace puppetri::io
