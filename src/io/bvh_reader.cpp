// SPDX-License-Identifier: MIT
// Two passes over one text: the hierarchy word by word, then the motion line by line, so that a
// number that is missing is told with its frame and the channel that it should have been.
#include "puppetri/io/bvh_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "clip_tidy.h"
#include "defects.h"
#include "puppetri/base/text.h"
#include "puppetri/math/rotation.h"

namespace puppetri::io {
namespace {

constexpr std::size_t kMostJoints = 10'000;
constexpr std::size_t kDeepest = 500;
constexpr std::size_t kMostKeys = 10'000'000;  // 1.5 GB

enum class Channel : std::uint8_t { kXp, kYp, kZp, kXr, kYr, kZr };
constexpr std::array<std::string_view, 6> kChannelNames = {"xposition", "yposition", "zposition",
                                                           "xrotation", "yrotation", "zrotation"};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
std::string lower(std::string_view word) {
    std::string text(word);
    for (char& c : text) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return text;
}

struct ChannelOf {
    std::uint32_t joint = 0;
    Channel channel = Channel::kXp;
};

class Reader {
 public:
    Reader(std::string_view text, const std::string& path, double scale)
        : text_(text), path_(path), scale_(scale) {}

    Checked<ClipFile> read() {
        if (read_hierarchy()) {
            read_motion();
        }
        if (defects_.any()) {
            return Unexpected(defects_.take());
        }
        file_.notes = defects_.take();
        file_.format = ClipFormat::kBvh;
        return std::move(file_);
    }

 private:
    // The hierarchy, word by word.

    void skip() {
        while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '\n')) {
            if (text_[at_] == '\n') {
                ++line_;
                line_begin_ = at_ + 1;
            }
            ++at_;
        }
    }
    std::string_view word() {
        skip();
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') {
            ++at_;
        }
        word_at_ = begin;
        return text_.substr(begin, at_ - begin);
    }
    std::string_view rest_of_line() {
        while (at_ < text_.size() && is_blank(text_[at_])) {
            ++at_;
        }
        word_at_ = at_;
        std::size_t end = std::min(text_.find('\n', at_), text_.size());
        at_ = end;
        while (end > word_at_ && is_blank(text_[end - 1])) {
            --end;
        }
        return text_.substr(word_at_, end - word_at_);
    }
    SourceSpan here() const {
        return {path_, line_, static_cast<std::uint32_t>(word_at_ - line_begin_ + 1), 1};
    }
    std::string joint_text(std::size_t joint) const {
        return "joint " + file_.skeleton.joints[joint].name;
    }
    bool fail(const char* code, std::string element, std::string message, std::string remedy) {
        defects_.error(code, here(), std::move(element), std::move(message), std::move(remedy));
        return false;
    }
    bool expect(std::string_view wanted, const std::string& element) {
        const std::string_view got = word();
        if (lower(got) == wanted) {
            return true;
        }
        return fail("bad-bvh", element,
                    got.empty() ? "the file ends where " + std::string(wanted) + " should stand"
                                : "here should stand " + std::string(wanted),
                    "mend the hierarchy, or export the file anew");
    }
    bool number(double& value, const std::string& element) {
        const std::string_view text = word();
        const std::optional<double> read = parse_number(text);
        if (!read || std::fabs(*read) > 1e9) {
            return fail("bad-number", element, "here should stand a number",
                        "give a finite number below 1e9");
        }
        value = *read;
        return true;
    }
    bool offset(Vec3& value, const std::string& element) {
        if (!number(value.x, element) || !number(value.y, element) || !number(value.z, element)) {
            return false;
        }
        value = value * scale_;
        return true;
    }

    bool read_hierarchy() {
        if (text_.starts_with("\xEF\xBB\xBF")) {
            at_ = 3;
        }
        if (!expect("hierarchy", "")) {
            return false;
        }
        for (;;) {
            const std::string_view next = word();
            const std::string kind = lower(next);
            if (kind == "motion") {
                break;
            }
            if (kind != "root") {
                return fail("bad-bvh", "", "here should stand ROOT or MOTION",
                            "a BVH file is a HIERARCHY and then a MOTION");
            }
            if (!read_joint()) {
                return false;
            }
        }
        if (file_.skeleton.joints.empty()) {
            return fail("bad-bvh", "", "the hierarchy has no joint", "start it with ROOT");
        }
        make_names_unique(file_.skeleton, defects_, path_);
        return true;
    }

    // A ROOT and all below it, without recursion: files may nest as deep as they like.
    bool read_joint() {
        std::vector<std::uint32_t> open;
        if (!open_joint(open)) {
            return false;
        }
        while (!open.empty()) {
            const std::uint32_t joint = open.back();
            const std::string kind = lower(word());
            if (kind == "}") {
                open.pop_back();
            } else if (kind == "joint") {
                if (!open_joint(open)) {
                    return false;
                }
            } else if (kind == "end") {
                rest_of_line();  // "Site"
                Vec3& tip = file_.skeleton.joints[joint].end_site_joint;
                if (!expect("{", joint_text(joint)) || !expect("offset", joint_text(joint)) ||
                    !offset(tip, joint_text(joint)) || !expect("}", joint_text(joint))) {
                    return false;
                }
            } else if (kind == "offset") {
                Vec3& at = file_.skeleton.joints[joint].parent_from_joint_rest.translation;
                if (!offset(at, joint_text(joint))) {
                    return false;
                }
            } else if (kind == "channels") {
                if (!read_channels(joint)) {
                    return false;
                }
            } else {
                return fail("bad-bvh", joint_text(joint),
                            kind.empty() ? "the file ends inside the hierarchy"
                                         : "here should stand OFFSET, CHANNELS, JOINT, End Site "
                                           "or a closing brace",
                            "mend the hierarchy, or export the file anew");
            }
        }
        return true;
    }

    bool open_joint(std::vector<std::uint32_t>& open) {
        std::string name(rest_of_line());
        if (name.ends_with('{')) {  // the brace on the line of the name
            name.pop_back();
            while (!name.empty() && is_blank(name.back())) {
                name.pop_back();
            }
        } else if (!expect("{", "joint " + name)) {
            return false;
        }
        auto& joints = file_.skeleton.joints;
        if (name.empty() || find_invalid_utf8(name)) {
            return fail("bad-bvh", "joint " + std::to_string(joints.size() + 1),
                        "a joint needs a name in UTF-8", "give it one");
        }
        if (joints.size() == kMostJoints || open.size() == kDeepest) {
            return fail("too-large", "joint " + name,
                        "there are more than " + std::to_string(kMostJoints) +
                            " joints, or more than " + std::to_string(kDeepest) + " in a chain",
                        "split the figure");
        }
        figure::Joint joint;
        joint.name = std::move(name);
        joint.parent = open.empty() ? figure::JointIndex{} : figure::JointIndex{open.back()};
        open.push_back(static_cast<std::uint32_t>(joints.size()));
        joints.push_back(std::move(joint));
        has_channels_.push_back(0);
        return true;
    }

    bool read_channels(std::uint32_t joint) {
        double count = 0;
        if (!number(count, joint_text(joint))) {
            return false;
        }
        if (!(count >= 0 && count <= 6 && count == std::floor(count)) || has_channels_[joint]) {
            return fail("bad-bvh", joint_text(joint), "a joint has 0 to 6 channels, told once",
                        "mend the line CHANNELS");
        }
        const std::string_view names = rest_of_line();
        std::size_t at = 0;
        unsigned seen = 0;
        for (int i = 0; i < static_cast<int>(count); ++i) {
            while (at < names.size() && is_blank(names[at])) {
                ++at;
            }
            const std::size_t begin = at;
            while (at < names.size() && !is_blank(names[at])) {
                ++at;
            }
            const std::string name = lower(names.substr(begin, at - begin));
            const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), name);
            if (found == kChannelNames.end()) {
                return fail(name.empty() ? "missing-channel" : "bad-bvh", joint_text(joint),
                            name.empty() ? "it says " + std::to_string(static_cast<int>(count)) +
                                               " channels and names " + std::to_string(i)
                                         : "there is no channel " + name,
                            "channels are Xposition .. Zposition and Xrotation .. Zrotation");
            }
            const auto channel = static_cast<unsigned>(found - kChannelNames.begin());
            if (seen >> channel & 1) {
                return fail("bad-bvh", joint_text(joint), "the channel " + name + " stands twice",
                            "name each channel once");
            }
            seen |= 1u << channel;
            channels_.push_back({joint, static_cast<Channel>(channel)});
        }
        if (names.find_first_not_of(" \t\r\v\f", at) != std::string_view::npos) {
            return fail("extra-channel", joint_text(joint), "it names more channels than it says",
                        "mend the count of CHANNELS");
        }
        has_channels_[joint] = 1;
        return true;
    }

    // The motion, line by line.

    bool next_line(std::string_view& line) {
        while (at_ < text_.size()) {
            const std::size_t end = std::min(text_.find('\n', at_), text_.size());
            line = text_.substr(at_, end - at_);
            line_begin_ = word_at_ = at_;
            ++line_;
            at_ = end + 1;
            if (line.find_first_not_of(" \t\r\v\f") != std::string_view::npos) {
                return true;
            }
        }
        at_ = text_.size();
        return false;
    }

    void read_motion() {
        // From here on line_ is the line that next_line gave: step back onto the line of MOTION.
        if (!expect("frames:", "")) {
            return;
        }
        double frames = 0, frame_s = 0;
        if (!number(frames, "Frames")) {
            return;
        }
        if (!(frames >= 1 && frames <= 1e8 && frames == std::floor(frames))) {
            fail("bad-bvh", "Frames", "the number of frames is no whole number from 1",
                 "give the number of lines that follow");
            return;
        }
        if (!expect("frame", "Frame Time") || !expect("time:", "Frame Time") ||
            !number(frame_s, "Frame Time")) {
            return;
        }
        if (!(frame_s > 1e-6 && frame_s <= 3600)) {
            fail("bad-frame-time", "Frame Time",
                 "the time from frame to frame is not positive, or is out of all reason",
                 "give seconds: 0.0333333 for 30 frames per second");
            return;
        }
        if (const std::string_view rest = rest_of_line(); !rest.empty()) {
            fail("bad-bvh", "Frame Time", "something follows the frame time on its line",
                 "put the first frame on a line of its own");
            return;
        }
        at_ = std::min(at_ + 1, text_.size());

        const auto announced = static_cast<std::size_t>(frames);
        std::vector<double> row(channels_.size());
        // What is left of the text bounds the frames, whatever was announced.
        const std::size_t possible =
            (text_.size() - at_) / std::max<std::size_t>(2 * channels_.size(), 1) + 1;
        const std::size_t expected = std::min(announced, possible);
        if (expected > kMostKeys / file_.skeleton.joints.size()) {
            too_long();
            return;
        }
        begin_tracks(expected);
        std::size_t frame = 0;
        std::string_view line;
        while (next_line(line)) {
            if (frame >= kMostKeys / file_.skeleton.joints.size()) {
                too_long();
                return;
            }
            if (read_row(line, frame, row)) {
                add_frame(static_cast<double>(frame) * frame_s, row);
            }
            ++frame;
        }
        if (channels_.empty()) {
            frame = announced;
        }
        if (frame < announced) {
            fail("truncated", "Frames",
                 "there are " + std::to_string(frame) + " of " + std::to_string(announced) +
                     " frames",
                 "get the whole file, or correct the number of frames");
        } else if (frame > announced) {
            defects_.note(Severity::kWarning, "frame-count", here(), "Frames",
                          "there are " + std::to_string(frame) + " frames instead of " +
                              std::to_string(announced) + "; all are used",
                          "correct the number of frames");
        }
        if (defects_.any()) {
            return;
        }
        end_tracks(frame, frame_s);
    }

    void too_long() {
        fail("too-large", "Frames", "there are more than ten million keys",
             "split the take, or leave out every second frame");
    }

    bool read_row(std::string_view line, std::size_t frame, std::vector<double>& row) {
        std::size_t at = 0;
        const auto element = [&](std::size_t channel) {
            const ChannelOf c = channels_[std::min(channel, channels_.size() - 1)];
            return "frame " + std::to_string(frame + 1) + ", " + joint_text(c.joint) + ", " +
                   std::string(kChannelNames[static_cast<std::size_t>(c.channel)]);
        };
        const auto skip_blanks = [&] {
            while (at < line.size() && is_blank(line[at])) {
                ++at;
            }
        };
        for (std::size_t c = 0; c < row.size(); ++c) {
            skip_blanks();
            const std::size_t begin = at;
            while (at < line.size() && !is_blank(line[at])) {
                ++at;
            }
            word_at_ = line_begin_ + begin;
            if (begin == at) {
                return fail("missing-channel", element(c),
                            "the frame has " + std::to_string(c) + " of " +
                                std::to_string(row.size()) + " numbers",
                            "give one number per channel");
            }
            const std::optional<double> value = parse_number(line.substr(begin, at - begin));
            if (!value || std::fabs(*value) > 1e9) {
                return fail("bad-number", element(c), "this is not a finite number below 1e9",
                            "mend the number, or cut the frame out");
            }
            row[c] = *value;
        }
        skip_blanks();
        if (at < line.size()) {
            word_at_ = line_begin_ + at;
            return fail("extra-channel", "frame " + std::to_string(frame + 1),
                        "the frame has more than " + std::to_string(row.size()) + " numbers",
                        "give one number per channel, and each frame a line");
        }
        return true;
    }

    // Tracks of the joints that have such channels.
    struct Tracks {
        std::uint32_t joint = 0;
        std::size_t first = 0, count = 0;  // of channels_
        bool moves = false, turns = false;
        motion::VectorTrack translation;
        motion::RotationTrack rotation;
    };

    void begin_tracks(std::size_t frames) {
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            if (tracks_.empty() || tracks_.back().joint != channels_[c].joint) {
                tracks_.push_back({channels_[c].joint, c, 0, false, false, {}, {}});
            }
            Tracks& t = tracks_.back();
            ++t.count;
            (channels_[c].channel < Channel::kXr ? t.moves : t.turns) = true;
        }
        for (Tracks& t : tracks_) {
            t.translation.target = t.rotation.target = file_.skeleton.joints[t.joint].name;
            t.translation.keys.reserve(t.moves ? frames : 0);
            t.rotation.keys.reserve(t.turns ? frames : 0);
        }
    }

    void add_frame(double t_s, const std::vector<double>& row) {
        for (Tracks& t : tracks_) {
            Vec3 at = file_.skeleton.joints[t.joint].parent_from_joint_rest.translation;
            Quat turn;
            for (std::size_t c = t.first; c < t.first + t.count; ++c) {
                const double value = row[c];
                switch (channels_[c].channel) {
                    case Channel::kXp:
                        at.x += value * scale_;
                        break;
                    case Channel::kYp:
                        at.y += value * scale_;
                        break;
                    case Channel::kZp:
                        at.z += value * scale_;
                        break;
                    case Channel::kXr:
                        turn = turn * about_x(radians(value));
                        break;
                    case Channel::kYr:
                        turn = turn * about_y(radians(value));
                        break;
                    case Channel::kZr:
                        turn = turn * about_z(radians(value));
                        break;
                }
            }
            if (t.moves) {
                motion::VectorKey& key = t.translation.keys.emplace_back();
                key.t_s = t_s;
                key.value = at;
            }
            if (t.turns) {
                motion::RotationKey& key = t.rotation.keys.emplace_back();
                key.t_s = t_s;
                key.value = turn;
            }
        }
    }

    void end_tracks(std::size_t frames, double frame_s) {
        motion::Clip clip;
        clip.name = clip_name_of(path_);
        clip.duration_s = static_cast<double>(frames - 1) * frame_s;
        for (Tracks& t : tracks_) {
            if (t.moves) {
                if (clip.root.empty()) {
                    clip.root = t.translation.target;
                }
                clip.translations.push_back(std::move(t.translation));
            }
            if (t.turns) {
                clip.rotations.push_back(std::move(t.rotation));
            }
        }
        file_.frame_s = frame_s;
        drop_still_keys(clip);
        file_.clips.push_back(std::move(clip));
        file_.skeleton.height_m = rest_height_m(file_.skeleton);
        tell_odd_scale(file_, scale_, defects_, path_);
    }

    std::string_view text_;
    const std::string& path_;
    double scale_ = 0.01;
    std::size_t at_ = 0, line_begin_ = 0, word_at_ = 0;
    std::uint32_t line_ = 1;
    Defects defects_;
    ClipFile file_;
    std::vector<ChannelOf> channels_;
    std::vector<char> has_channels_;  // by joint
    std::vector<Tracks> tracks_;
};

}  // namespace

Checked<ClipFile> read_bvh(std::string_view text, const std::string& path,
                           const ClipReadOptions& options) {
    if (text.size() > options.largest_bytes) {
        return Unexpected(too_large(path, options.largest_bytes));
    }
    return Reader(text, path, options.scale > 0 ? options.scale : 0.01).read();
}

}  // namespace puppetri::io
