// SPDX-License-Identifier: MIT
#include "gltf_buffer.h"

#include <algorithm>

namespace puppetri::io {

int GltfBuffer::add_view(std::string_view bytes, Target target) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    views_.push_back({bytes_.size(), bytes.size(), target});
    bytes_ += bytes;
    return static_cast<int>(views_.size()) - 1;
}

void GltfBuffer::set_bounds(Accessor& accessor, std::span<const float> values, int width) {
    for (int c = 0; c < width; ++c) {
        const std::size_t component = static_cast<std::size_t>(c);
        float low = values[component], high = low;
        for (std::size_t i = component; i < values.size(); i += static_cast<std::size_t>(width)) {
            low = std::min(low, values[i]);
            high = std::max(high, values[i]);
        }
        accessor.min.push_back(low);
        accessor.max.push_back(high);
    }
}

void GltfBuffer::write_accessors(JsonWriter& json) const {
    for (const Accessor& accessor : accessors_) {
        json.begin_object().member("bufferView", accessor.view);
        json.member("componentType", static_cast<int>(accessor.component))
            .member("count", accessor.count);
        json.member("type", accessor.type);
        for (const auto& [name, values] :
             {std::pair{"min", &accessor.min}, std::pair{"max", &accessor.max}}) {
            if (!values->empty()) {
                json.key(name).begin_array();
                for (const float value : *values) {
                    json.number(value);
                }
                json.end_array();
            }
        }
        json.end_object();
    }
}

void GltfBuffer::write_views(JsonWriter& json) const {
    for (const View& view : views_) {
        json.begin_object().member("buffer", 0);
        json.member("byteOffset", static_cast<std::int64_t>(view.offset));
        json.member("byteLength", static_cast<std::int64_t>(view.length));
        if (view.target != Target::kNone) {
            json.member("target", static_cast<int>(view.target));
        }
        json.end_object();
    }
}

}  // namespace puppetri::io
