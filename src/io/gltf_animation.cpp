// SPDX-License-Identifier: MIT
#include "gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "key_reduction.h"
#include "markers.h"
#include "puppetri/io/events_json.h"
#include "puppetri/math/rotation.h"

namespace puppetri::io {
namespace {

// What counts as not moving: a tenth of what a float can tell apart a metre away.
constexpr double kStill_m = 1e-8;
constexpr double kStill_rad = 2e-8;

double apart(Vec3 a, Vec3 b) { return length(a - b); }

// The chord between two rotations as quaternions, about half their angle when small, without the
// trigonometry.
double chord(Quat a, Quat b) {
    const double sign = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0 ? -1 : 1;
    const double x = a.x - sign * b.x, y = a.y - sign * b.y, z = a.z - sign * b.z,
                 w = a.w - sign * b.w;
    return std::sqrt(x * x + y * y + z * z + w * w);
}

}  // namespace

GltfAnimation::GltfAnimation(GltfBuffer& buffer, const Take& take, double reduce_m)
    : buffer_(buffer), take_(take), reduce_m_(reduce_m), all_(take.times.size()) {
    PUP_REQUIRE(!take.times.empty());
    std::iota(all_.begin(), all_.end(), 0u);
    const auto pin = [&](SimTime at) {
        const auto found = std::lower_bound(take.times.begin(), take.times.end(), at);
        if (found != take.times.end()) {
            pinned_.push_back(static_cast<std::uint32_t>(found - take.times.begin()));
        }
    };
    for (const TakeEvent& event : take.events) {
        pin(event.at);
    }
    for (const TakeProp& prop : take.props) {
        for (const HolderChange& change : prop.holders) {
            pin(change.at);
        }
    }
}

int GltfAnimation::times_of(std::span<const std::uint32_t> keys) {
    int* shared = keys.size() == all_.size() ? &all_times_
                  : keys.size() == 1         ? &first_time_
                                             : nullptr;
    if (shared != nullptr && *shared >= 0) {
        return *shared;
    }
    std::vector<float> seconds;
    seconds.reserve(keys.size());
    for (const std::uint32_t key : keys) {
        seconds.push_back(static_cast<float>(take_.times[key].seconds()));
    }
    const int accessor = buffer_.add(std::span<const float>(seconds), Target::kNone,
                                     Component::kFloat, "SCALAR", 1, true);
    if (shared != nullptr) {
        *shared = accessor;
    }
    return accessor;
}

std::vector<std::uint32_t> GltfAnimation::keys_for(bool still, double allowance,
                                                   auto misfit) const {
    if (still) {
        return {0};
    }
    if (reduce_m_ <= 0) {
        return all_;
    }
    return reduce_keys(static_cast<std::uint32_t>(all_.size()), pinned_, allowance, misfit);
}

void GltfAnimation::add_rotations(int node, std::span<const Quat> values, Quat of_node,
                                  double allowance_rad) {
    const bool still = std::all_of(values.begin(), values.end(), [&](Quat q) {
        return chord(q, values.front()) * 2 < kStill_rad;
    });
    if (still && chord(of_node, values.front()) * 2 < kStill_rad) {
        return;
    }
    const auto share = [&](std::uint32_t from, std::uint32_t to, std::uint32_t key) {
        return (take_.times[key] - take_.times[from]).seconds() /
               (take_.times[to] - take_.times[from]).seconds();
    };
    const std::vector<std::uint32_t> keys = keys_for(
        still, allowance_rad, [&](std::uint32_t from, std::uint32_t to, std::uint32_t key) {
            return angle_between(slerp(values[from], values[to], share(from, to, key)),
                                 values[key]);
        });
    std::vector<float> floats;
    floats.reserve(keys.size() * 4);
    Quat before = of_node;
    for (const std::uint32_t key : keys) {
        Quat q = values[key];
        const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
        const bool opposite = before.x * q.x + before.y * q.y + before.z * q.z + before.w * q.w < 0;
        const double scale = (opposite ? -1 : 1) / norm;
        q = {q.x * scale, q.y * scale, q.z * scale, q.w * scale};
        for (const double part : {q.x, q.y, q.z, q.w}) {
            floats.push_back(static_cast<float>(part));
        }
        before = q;
    }
    const int times = times_of(keys);
    const int accessor =
        buffer_.add(std::span<const float>(floats), Target::kNone, Component::kFloat, "VEC4", 4);
    channels_.push_back({node, "rotation", times, accessor});
}

void GltfAnimation::add_translations(int node, std::span<const Vec3> values, Vec3 of_node,
                                     double allowance_m) {
    const bool still = std::all_of(values.begin(), values.end(),
                                   [&](Vec3 v) { return apart(v, values.front()) < kStill_m; });
    if (still && apart(of_node, values.front()) < kStill_m) {
        return;
    }
    const std::vector<std::uint32_t> keys =
        keys_for(still, allowance_m, [&](std::uint32_t from, std::uint32_t to, std::uint32_t key) {
            const double s = (take_.times[key] - take_.times[from]).seconds() /
                             (take_.times[to] - take_.times[from]).seconds();
            return apart(lerp(values[from], values[to], s), values[key]);
        });
    std::vector<float> floats;
    floats.reserve(keys.size() * 3);
    for (const std::uint32_t key : keys) {
        for (const double part : {values[key].x, values[key].y, values[key].z}) {
            floats.push_back(static_cast<float>(part));
        }
    }
    const int times = times_of(keys);
    const int accessor =
        buffer_.add(std::span<const float>(floats), Target::kNone, Component::kFloat, "VEC3", 3);
    channels_.push_back({node, "translation", times, accessor});
}

void GltfAnimation::write(JsonWriter& json, const std::string& name, std::string_view title) const {
    json.begin_object().member("name", name).key("samplers").begin_array();
    for (const GltfChannel& channel : channels_) {
        json.begin_object()
            .member("input", channel.times)
            .member("output", channel.values)
            .end_object();
    }
    json.end_array().key("channels").begin_array();
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        json.begin_object().member("sampler", static_cast<int>(i)).key("target").begin_object();
        json.member("node", channels_[i].node)
            .member("path", channels_[i].path)
            .end_object()
            .end_object();
    }
    json.end_array().key("extras").begin_object().key("puppetri").begin_object();
    json.member("version", kEventsVersion).member("scene", title);
    json.member("frames_per_second", to_string(take_.rate));
    json.member("first_frame", take_.first_frame).member("frames", take_.frame_count);
    if (take_.handle_before + take_.handle_after > 0) {
        json.key("handles")
            .begin_array()
            .integer(take_.handle_before)
            .integer(take_.handle_after)
            .end_array();
    }
    if (take_.loop) {
        json.member("loop", true);
    }
    json.key("root_delta").begin_object();
    for (const TakeActor& actor : take_.actors) {
        const Transform& delta = actor.root_delta;
        json.key(actor.name).begin_object().key("translation").begin_array();
        json.number(delta.translation.x)
            .number(delta.translation.y)
            .number(delta.translation.z)
            .end_array();
        json.key("rotation").begin_array().number(delta.rotation.x).number(delta.rotation.y);
        json.number(delta.rotation.z).number(delta.rotation.w).end_array().end_object();
    }
    json.end_object().key("events").begin_array();
    write_events(json, take_, false);
    json.end_array().key("holders").begin_array();
    write_holders(json, take_, false);
    json.end_array().end_object().end_object().end_object();
}

}  // namespace puppetri::io
