// SPDX-License-Identifier: MIT
// Animations of a glTF file: curves of rotations and translations over keys, as few as tell the
// motion.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "gltf_buffer.h"
#include "puppetri/io/take.h"

namespace puppetri::io {

struct GltfChannel {
    int node = 0;
    const char* path = "rotation";
    int times = 0, values = 0;  // accessors
};

// Collects the channels of one take. Rotations are written in one hemisphere: neighbours never
// differ in sign.
class GltfAnimation {
 public:
    // reduce_m: see GltfOptions.
    GltfAnimation(GltfBuffer& buffer, const Take& take, double reduce_m);

    // One value per key of the take. No channel when all equal what the node says; one key when all
    // are equal.
    void add_rotations(int node, std::span<const Quat> values, Quat of_node, double allowance_rad);
    void add_translations(int node, std::span<const Vec3> values, Vec3 of_node, double allowance_m);

    const std::vector<GltfChannel>& channels() const { return channels_; }
    void write(JsonWriter& json, const std::string& name, std::string_view title) const;

 private:
    // The accessor of the times of these keys; the commonest two lists are shared.
    int times_of(std::span<const std::uint32_t> keys);
    std::vector<std::uint32_t> keys_for(bool still, double allowance, auto misfit) const;

    GltfBuffer& buffer_;
    const Take& take_;
    double reduce_m_ = 0;
    std::vector<std::uint32_t> all_, pinned_;  // keys; those at events and holder changes
    int all_times_ = -1, first_time_ = -1;     // accessors
    std::vector<GltfChannel> channels_;
};

}  // namespace puppetri::io
