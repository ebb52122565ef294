// SPDX-License-Identifier: MIT
// Keyframe files, line by line: a line that begins with a word opens something, a line that begins
// with a number is a key of the track above it.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "clip_tidy.h"
#include "defects.h"
#include "puppetri/base/text.h"
#include "puppetri/io/keys_file.h"

namespace puppetri::io {
namespace {

using motion::Clip;
using motion::Interpolation;

constexpr std::size_t kMostKeys = 5'000'000;
constexpr std::size_t kMostJoints = 10'000;

struct Word {
    std::string text;
    std::uint32_t column = 1;
    bool quoted = false;
};

enum class TrackKind : std::uint8_t { kNone, kRotation, kTranslation, kNumber };

class Reader {
 public:
    Reader(std::string_view text, const std::string& path, double scale)
        : text_(text), path_(path), scale_(scale) {}

    Checked<ClipFile> read() {
        if (const auto bad = find_invalid_utf8(text_)) {
            line_ =
                1 + static_cast<std::uint32_t>(std::count(
                        text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(*bad), '\n'));
            fail(1, "", "this line is not UTF-8", "save the file as UTF-8");
            return Unexpected(defects_.take());
        }
        std::size_t at = text_.starts_with("\xEF\xBB\xBF") ? 3 : 0;
        while (at < text_.size()) {
            const std::size_t end = std::min(text_.find('\n', at), text_.size());
            ++line_;
            if (split(text_.substr(at, end - at)) && !words_.empty() && !read_line()) {
                break;
            }
            at = end + 1;
        }
        if (!begun_ && !defects_.any()) {
            line_ = 1;
            fail(1, "", "this is no keyframe file", "begin it with the line: keys 1");
        }
        finish();
        if (defects_.any()) {
            return Unexpected(defects_.take());
        }
        file_.notes = defects_.take();
        return std::move(file_);
    }

 private:
    SourceSpan here(std::uint32_t column) const { return {path_, line_, column, 1}; }
    bool fail(std::uint32_t column, std::string element, std::string message, std::string remedy) {
        defects_.error("bad-keys", here(column), std::move(element), std::move(message),
                       std::move(remedy));
        return false;
    }

    bool split(std::string_view line) {
        words_.clear();
        std::size_t i = 0;
        while (i < line.size()) {
            const char c = line[i];
            if (c == ' ' || c == '\t' || c == '\r') {
                ++i;
                continue;
            }
            if (c == '#') {
                break;
            }
            Word word;
            word.column = column_of(line, i);
            if (c == '"') {
                const std::size_t close = line.find('"', i + 1);
                if (close == std::string_view::npos) {
                    return fail(word.column, "", "the quote is not closed", "close it with \"");
                }
                word.text = line.substr(i + 1, close - i - 1);
                word.quoted = true;
                i = close + 1;
            } else {
                const std::size_t begin = i;
                while (i < line.size() && line[i] != ' ' && line[i] != '\t' && line[i] != '\r' &&
                       line[i] != '#' && line[i] != '"') {
                    ++i;
                }
                word.text = line.substr(begin, i - begin);
            }
            words_.push_back(std::move(word));
        }
        next_ = 0;
        return true;
    }

    bool more() const { return next_ < words_.size(); }
    std::uint32_t column() const {
        return more() ? words_[next_].column : words_.empty() ? 1 : words_.back().column;
    }
    bool take(std::string_view word) {
        if (more() && !words_[next_].quoted && words_[next_].text == word) {
            ++next_;
            return true;
        }
        return false;
    }
    bool name(std::string& to, const char* what) {
        if (!more() || words_[next_].text.empty()) {
            return fail(column(), "", std::string("here should stand ") + what,
                        "names with blanks stand in quotes");
        }
        to = words_[next_++].text;
        return true;
    }
    bool number(double& to, const std::string& element) {
        const std::optional<double> value =
            more() ? parse_number(words_[next_].text) : std::nullopt;
        if (!value || std::fabs(*value) > 1e12) {
            return fail(column(), element, "here should stand a number below 1e12",
                        "numbers are written like -0.25 or 1e-3");
        }
        to = *value;
        ++next_;
        return true;
    }
    bool vector(Vec3& to, const std::string& element) {
        return number(to.x, element) && number(to.y, element) && number(to.z, element);
    }
    bool quaternion(Quat& to, const std::string& element) {
        if (!number(to.x, element) || !number(to.y, element) || !number(to.z, element) ||
            !number(to.w, element)) {
            return false;
        }
        const double norm = to.x * to.x + to.y * to.y + to.z * to.z + to.w * to.w;
        if (std::fabs(norm - 1) > 2e-3) {
            return fail(column(), element, "this quaternion is not of length 1",
                        "give x y z w of a rotation, or use the unit degrees");
        }
        return true;
    }
    // Seconds, or frames with an f behind: 12f.
    bool time(double& to, const std::string& element) {
        if (!more()) {
            return fail(column(), element, "here should stand a time", "seconds, or frames: 12f");
        }
        std::string& text = words_[next_].text;
        if (text.ends_with('f') && text.size() > 1) {
            if (rate_ <= 0) {
                return fail(column(), element, "there is no rate for these frames",
                            "say it above: frames 24");
            }
            text.pop_back();
            if (!number(to, element)) {
                return false;
            }
            to /= rate_;
            return true;
        }
        return number(to, element);
    }
    bool end_of_line(const std::string& element) {
        return !more() || fail(column(), element, "this word is not expected here",
                               "see docs/formats/keys.md for what a line may say");
    }

    // False ends the reading: the file is none of this kind, or too large.
    bool read_line() {
        if (!begun_) {
            if (!take("keys")) {
                return fail(column(), "", "this is no keyframe file",
                            "begin it with the line: keys 1");
            }
            double version = 0;
            begun_ = true;
            if (!number(version, "") || version != 1) {
                return fail(column(), "", "this version of the format is not known",
                            "begin the file with the line: keys 1");
            }
            end_of_line("");
            return true;
        }
        const std::string& first = words_[0].text;
        if (words_[0].quoted) {
            fail(1, "", "a line begins with a word or a number", "see docs/formats/keys.md");
        } else if (first.front() == '-' || first.front() == '+' || first.front() == '.' ||
                   (first.front() >= '0' && first.front() <= '9')) {
            return read_key();
        } else if (take("frames")) {
            double rate = 0;
            if (number(rate, "frames") && end_of_line("frames")) {
                if (rate > 0 && rate <= 1e6) {
                    rate_ = rate;
                } else {
                    fail(words_[1].column, "frames", "this is no rate of frames",
                         "give frames per second");
                }
            }
        } else if (take("height")) {
            if (number(file_.skeleton.height_m, "height")) {
                file_.skeleton.height_m *= scale_;
                end_of_line("height");
            }
        } else if (take("joint")) {
            return read_joint();
        } else if (take("clip")) {
            read_clip();
        } else if (take("mark")) {
            read_mark();
        } else if (take("rotation")) {
            read_track(TrackKind::kRotation);
        } else if (take("translation")) {
            read_track(TrackKind::kTranslation);
        } else if (take("number")) {
            read_track(TrackKind::kNumber);
        } else {
            const std::array<std::string, 8> known = {
                "frames", "height", "joint", "clip", "mark", "rotation", "translation", "number"};
            const std::string_view near = nearest_name(first, known);
            fail(words_[0].column, "", "no line begins with " + first,
                 near.empty() ? "see docs/formats/keys.md"
                              : "did you mean " + std::string(near) + "?");
        }
        return true;
    }

    bool read_joint() {
        figure::Joint joint;
        std::string parent;
        if (file_.skeleton.joints.size() >= kMostJoints) {
            return fail(column(), "", "there are more than 10000 joints", "split the figure");
        }
        if (!name(joint.name, "the name of a joint")) {
            return true;
        }
        const std::string element = "joint " + joint.name;
        if (!more() || take("-")) {
            // a root
        } else if (name(parent, "the joint above it, or -")) {
            joint.parent = find_joint(parent);
            if (!joint.parent.valid()) {
                fail(words_[2].column, element, "there is no joint " + parent + " above it",
                     "joints stand below those that they hang from");
                return true;
            }
        }
        Vec3 at;
        if (!vector(at, element)) {
            return true;
        }
        joint.parent_from_joint_rest.translation = at * scale_;
        while (more()) {
            if (take("turned")) {
                if (!quaternion(joint.parent_from_joint_rest.rotation, element)) {
                    return true;
                }
            } else if (take("end")) {
                if (!vector(joint.end_site_joint, element)) {
                    return true;
                }
                joint.end_site_joint = joint.end_site_joint * scale_;
            } else {
                end_of_line(element);
                return true;
            }
        }
        if (!joint_of_.try_emplace(joint.name, file_.skeleton.joints.size()).second) {
            fail(words_[1].column, element, "there is such a joint already",
                 "give joints names of their own");
            return true;
        }
        file_.skeleton.joints.push_back(std::move(joint));
        return true;
    }
    figure::JointIndex find_joint(const std::string& name) const {
        const auto found = joint_of_.find(name);
        return found == joint_of_.end()
                   ? figure::JointIndex{}
                   : figure::JointIndex{static_cast<std::uint32_t>(found->second)};
    }

    void read_clip() {
        kind_ = TrackKind::kNone;
        Clip clip;
        if (!name(clip.name, "the name of a clip")) {
            return;
        }
        const std::string element = "clip " + clip.name;
        clip_lines_.push_back(line_);
        bool lasts = false;
        while (more()) {
            if (take("lasts")) {
                lasts = true;
                if (!time(clip.duration_s, element)) {
                    break;
                }
            } else if (take("loops")) {
                clip.loops = true;
            } else if (take("root")) {
                if (!name(clip.root, "the joint that travels")) {
                    break;
                }
            } else {
                end_of_line(element);
                break;
            }
        }
        own_length_.push_back(!lasts);
        if (std::any_of(file_.clips.begin(), file_.clips.end(),
                        [&](const Clip& c) { return c.name == clip.name; })) {
            fail(words_[1].column, element, "there is such a clip already",
                 "give clips names of their own");
        }
        file_.clips.push_back(std::move(clip));
    }

    bool has_clip(const char* what) {
        return !file_.clips.empty() ||
               fail(words_[0].column, "", std::string("a ") + what + " belongs to a clip",
                    "begin one above: clip NAME lasts 2");
    }

    void read_mark() {
        motion::ClipMark mark;
        if (!has_clip("mark") || !time(mark.t_s, "mark")) {
            return;
        }
        mark.end_s = mark.t_s;
        if (take("..") && !time(mark.end_s, "mark")) {
            return;
        }
        if (!name(mark.name, "the name of the mark") ||
            (more() && !name(mark.target, "what the mark is about")) ||
            !end_of_line("mark " + mark.name)) {
            return;
        }
        file_.clips.back().marks.push_back(std::move(mark));
    }

    void read_track(TrackKind kind) {
        kind_ = TrackKind::kNone;
        std::string target;
        if (!has_clip("track") || !name(target, "a joint, or a degree of freedom")) {
            return;
        }
        element_ = (kind == TrackKind::kRotation      ? "rotation of "
                    : kind == TrackKind::kTranslation ? "translation of "
                                                      : "track ") +
                   target;
        degrees_ = kind != TrackKind::kTranslation && take("degrees");
        default_ = Interpolation::kLinear;
        if (more() && !interpolation(default_)) {
            end_of_line(element_);
            return;
        }
        if (!end_of_line(element_)) {
            return;
        }
        kind_ = kind;
        Clip& clip = file_.clips.back();
        if (kind == TrackKind::kRotation) {
            clip.rotations.push_back({std::move(target), {}});
        } else if (kind == TrackKind::kTranslation) {
            clip.translations.push_back({std::move(target), {}});
        } else {
            clip.numbers.push_back({std::move(target), {}});
        }
    }

    bool interpolation(Interpolation& how) {
        for (int i = 0; i < 7; ++i) {
            const auto candidate = static_cast<Interpolation>(i);
            if (take(motion::name_of(candidate))) {
                how = candidate;
                return true;
            }
        }
        return false;
    }

    double unit() const {
        return degrees_ ? kPi / 180 : kind_ == TrackKind::kTranslation ? scale_ : 1;
    }
    bool read_value(Quat& to) {
        if (!degrees_) {
            return quaternion(to, element_);
        }
        Vec3 angles;
        if (!vector(angles, element_)) {
            return false;
        }
        angles = angles * unit();
        to = about_z(angles.z) * about_y(angles.y) * about_x(angles.x);
        return true;
    }
    bool read_value(Vec3& to) { return read_rate(to); }
    bool read_value(double& to) { return read_rate(to); }
    bool read_rate(Vec3& to) {
        if (!vector(to, element_)) {
            return false;
        }
        to = to * unit();
        return true;
    }
    bool read_rate(double& to) {
        if (!number(to, element_)) {
            return false;
        }
        to *= unit();
        return true;
    }

    template <class Key>
    bool read_key_of(std::vector<Key>& keys) {
        Key key;
        key.interpolation = default_;
        if (!time(key.t_s, element_) || !read_value(key.value)) {
            return false;
        }
        interpolation(key.interpolation);
        while (more()) {
            const bool good = take("tension")      ? number(key.shape.tension, element_)
                              : take("continuity") ? number(key.shape.continuity, element_)
                              : take("bias")       ? number(key.shape.bias, element_)
                              : take("in")         ? read_rate(key.in)
                              : take("out")        ? read_rate(key.out)
                              : take("easing")     ? number(key.easing.x1, element_) &&
                                                     number(key.easing.y1, element_) &&
                                                     number(key.easing.x2, element_) &&
                                                     number(key.easing.y2, element_)
                                               : end_of_line(element_);
            if (!good) {
                return false;
            }
        }
        keys.push_back(key);
        return true;
    }

    bool read_key() {
        if (++keys_ > kMostKeys) {
            return fail(1, element_, "there are more than five million keys", "split the file");
        }
        if (kind_ == TrackKind::kNone) {
            if (!defects_.any()) {
                fail(words_[0].column, "", "a key belongs to a track",
                     "begin one above: rotation JOINT, translation JOINT or number JOINT.DOF");
            }
            return true;
        }
        Clip& clip = file_.clips.back();
        if (kind_ == TrackKind::kRotation) {
            read_key_of(clip.rotations.back().keys);
        } else if (kind_ == TrackKind::kTranslation) {
            read_key_of(clip.translations.back().keys);
        } else {
            read_key_of(clip.numbers.back().keys);
        }
        return true;
    }

    void finish() {
        for (std::size_t c = 0; c < file_.clips.size(); ++c) {
            Clip& clip = file_.clips[c];
            if (own_length_[c]) {  // as long as its last key
                const auto last = [&](const auto& tracks) {
                    for (const auto& track : tracks) {
                        if (!track.keys.empty()) {
                            clip.duration_s = std::max(clip.duration_s, track.keys.back().t_s);
                        }
                    }
                };
                last(clip.rotations);
                last(clip.translations);
                last(clip.numbers);
                for (const motion::ClipMark& mark : clip.marks) {
                    clip.duration_s = std::max(clip.duration_s, mark.end_s);
                }
            }
            std::stable_sort(clip.marks.begin(), clip.marks.end(),
                             [](const auto& a, const auto& b) { return a.t_s < b.t_s; });
            if (defects_.any()) {
                continue;
            }
            if (const Status status = motion::check(clip, path_); !status) {
                for (const Diagnostic& d : status.error()) {
                    SourceSpan where = d.where;
                    where.line = clip_lines_[c];
                    where.column = 1;
                    defects_.error(d.code.c_str(), where, "clip " + clip.name + ", " + d.element,
                                   d.message, d.remedy);
                }
            }
        }
        if (file_.skeleton.height_m <= 0 && !file_.skeleton.joints.empty()) {
            file_.skeleton.height_m = rest_height_m(file_.skeleton);
        }
        file_.frame_s = rate_ > 0 ? 1 / rate_ : 0;
    }

    std::string_view text_;
    const std::string& path_;
    double scale_ = 1;
    std::uint32_t line_ = 0;
    std::vector<Word> words_;
    std::size_t next_ = 0;
    bool begun_ = false;
    double rate_ = 0;
    TrackKind kind_ = TrackKind::kNone;
    bool degrees_ = false;
    Interpolation default_ = Interpolation::kLinear;
    std::string element_;
    std::size_t keys_ = 0;
    std::map<std::string, std::size_t> joint_of_;
    std::vector<std::uint32_t> clip_lines_;
    std::vector<bool> own_length_;
    Defects defects_;
    ClipFile file_;
};

}  // namespace

Checked<ClipFile> read_keys(std::string_view text, const std::string& path,
                            const ClipReadOptions& options) {
    if (text.size() > options.largest_bytes) {
        return Unexpected(too_large(path, options.largest_bytes));
    }
    return Reader(text, path, options.scale > 0 ? options.scale : 1).read();
}

}  // namespace puppetri::io
