// SPDX-License-Identifier: MIT
#include "clip_tidy.h"

#include <algorithm>
#include <map>
#include <set>

#include "puppetri/base/text.h"
#include "rest_pose.h"

namespace puppetri::io {
namespace {

// The captures of Carnegie Mellon are in inches / 0.45.
constexpr double kCmuScale = 0.0254 / 0.45;

template <class Key>
void drop_still(std::vector<motion::ClipTrack<Key>>& tracks) {
    for (motion::ClipTrack<Key>& track : tracks) {
        const Key& first = track.keys.front();
        const bool still = std::all_of(track.keys.begin(), track.keys.end(), [&](const Key& key) {
            return key.value == first.value && key.in == typename Key::Rate{} &&
                   key.out == typename Key::Rate{};
        });
        if (still && track.keys.size() > 1) {
            track.keys.resize(1);
            track.keys.shrink_to_fit();
        }
    }
}

}  // namespace

Diagnostics too_large(const std::string& path, std::uint64_t bytes) {
    return {{Severity::kError,
             "too-large",
             {path, 0, 0, 1},
             "",
             "the file is larger than " + std::to_string(bytes) + " bytes",
             "split it"}};
}

std::string clip_name_of(std::string_view path) {
    const std::size_t slash = path.find_last_of("/\\");
    std::string_view name = slash == std::string_view::npos ? path : path.substr(slash + 1);
    if (const std::size_t dot = name.rfind('.'); dot != std::string_view::npos && dot > 0) {
        name = name.substr(0, dot);
    }
    return name.empty() ? "clip" : std::string(name);
}

void make_names_unique(figure::Skeleton& skeleton, Defects& defects, const std::string& path) {
    std::set<std::string> taken;
    for (const figure::Joint& joint : skeleton.joints) {
        taken.insert(joint.name);
    }
    if (taken.size() == skeleton.joints.size()) {
        return;
    }
    std::set<std::string> seen;
    std::map<std::string, int> next;  // of a name: the number to try
    for (figure::Joint& joint : skeleton.joints) {
        if (seen.insert(joint.name).second) {
            continue;
        }
        const std::string old = joint.name;
        int& number = next.try_emplace(old, 2).first->second;
        do {
            joint.name = old + "_" + std::to_string(number++);
        } while (!taken.insert(joint.name).second);
        defects.note(Severity::kWarning, "duplicate-joint", {path, 0, 0, 1}, "joint " + old,
                     "there are two joints of this name; the second is called " + joint.name,
                     "give joints names of their own");
    }
}

void drop_still_keys(motion::Clip& clip) {
    drop_still(clip.rotations);
    drop_still(clip.translations);
    drop_still(clip.numbers);
}

double rest_height_m(const figure::Skeleton& skeleton) {
    const std::vector<Transform> model = model_from_rest(skeleton);
    double lo = 1e300, hi = -1e300;
    for (std::size_t j = 0; j < model.size(); ++j) {
        for (const double y :
             {model[j].translation.y, (model[j] * skeleton.joints[j].end_site_joint).y}) {
            lo = std::min(lo, y);
            hi = std::max(hi, y);
        }
    }
    return hi > lo ? hi - lo : 0;
}

void tell_odd_scale(const ClipFile& file, double scale, Defects& defects, const std::string& path) {
    const double height = file.skeleton.height_m;
    if (file.skeleton.joints.size() <= 10 || height <= 0 || (height >= 0.4 && height <= 4)) {
        return;
    }
    const double units = height / scale;  // of the file
    const bool cmu = units * kCmuScale > 1.3 && units * kCmuScale < 2.2;
    const bool centimetres = units * 0.01 > 0.4 && units * 0.01 < 4;
    const auto say = [](double metres, int digits) {
        const std::string number = number_to_text_fixed(metres, digits);
        return "`scale " + number + "` in the scene, --scale " + number + " on the command line";
    };
    std::string remedy;
    if (cmu) {
        remedy = "captures of CMU are in inches / 0.45: " + say(kCmuScale, 6);
    } else if (centimetres) {
        remedy = "in centimetres it would be " + number_to_text_fixed(units * 0.01, 1) +
                 " m: " + say(0.01, 2);
    } else {
        remedy = "it would be 1.75 m tall with " + say(1.75 / units, 8);
    }
    defects.note(Severity::kWarning, "odd-scale", {path, 0, 0, 1}, "the skeleton",
                 "the figure is " + number_to_text_fixed(height, height < 1 ? 2 : 1) + " m tall",
                 std::move(remedy));
}

}  // namespace puppetri::io
