// SPDX-License-Identifier: MIT
// What accessors say: numbers out of bytes whose place has been checked by the reader.
#include "puppetri/io/gltf_document.h"

#include <algorithm>
#include <cstring>

#include "gltf_reader.h"

namespace puppetri::io {
namespace {

template <class T>
double value_at(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

double component_at(const char* bytes, std::uint32_t type) {
    switch (type) {
        case 5120:
            return value_at<std::int8_t>(bytes);
        case 5121:
            return value_at<std::uint8_t>(bytes);
        case 5122:
            return value_at<std::int16_t>(bytes);
        case 5123:
            return value_at<std::uint16_t>(bytes);
        case 5125:
            return value_at<std::uint32_t>(bytes);
        default:
            return value_at<float>(bytes);
    }
}

// glTF 2.0, section 3.11: normalised integers.
double fraction_of(double value, std::uint32_t type) {
    switch (type) {
        case 5120:
            return std::max(value / 127, -1.0);
        case 5121:
            return value / 255;
        case 5122:
            return std::max(value / 32767, -1.0);
        case 5123:
            return value / 65535;
        default:
            return value;
    }
}

}  // namespace

std::uint32_t gltf_component_size(std::uint32_t component_type) {
    switch (component_type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            return 0;
    }
}

Checked<GltfDocument> GltfDocument::parse(std::string bytes, const std::string& path,
                                          scene::FileSource* files) {
    return GltfReader(path, files).read(bytes);
}

std::string GltfDocument::node_text(std::uint32_t node) const {
    const std::string& name = nodes[node].name;
    return gltf_element("node", node) + (name.empty() ? "" : " (" + name + ")");
}

template <class T>
void GltfDocument::read(std::uint32_t accessor, std::vector<T>& out) const {
    const Accessor& a = accessors_[accessor];
    const std::uint32_t size = gltf_component_size(a.component_type);
    const std::size_t width = a.components;
    out.assign(a.count * width, T{});
    const auto put = [&](const char* from, std::size_t element) {
        if constexpr (std::is_same_v<T, float>) {
            if (a.component_type == 5126) {
                std::memcpy(&out[element * width], from, width * sizeof(float));
                return;
            }
        }
        for (std::size_t c = 0; c < width; ++c) {
            const double value = component_at(from + c * size, a.component_type);
            out[element * width + c] =
                static_cast<T>(a.normalized ? fraction_of(value, a.component_type) : value);
        }
    };
    if (a.view != kNoGltf) {
        const View& view = views_[a.view];
        const char* from = buffers_[view.buffer].data() + view.offset + a.offset;
        const std::size_t stride = view.stride != 0 ? view.stride : size * width;
        for (std::size_t i = 0; i < a.count; ++i) {
            put(from + i * stride, i);
        }
    }
    if (a.sparse_count != 0) {
        const View& at = views_[a.sparse_indices_view];
        const View& values = views_[a.sparse_values_view];
        const char* index = buffers_[at.buffer].data() + at.offset + a.sparse_indices_offset;
        const char* value = buffers_[values.buffer].data() + values.offset + a.sparse_values_offset;
        const std::uint32_t index_size = gltf_component_size(a.sparse_index_type);
        for (std::size_t i = 0; i < a.sparse_count; ++i) {
            put(value + i * size * width, static_cast<std::size_t>(component_at(
                                              index + i * index_size, a.sparse_index_type)));
        }
    }
}

std::vector<float> GltfDocument::floats(std::uint32_t accessor) const {
    std::vector<float> values;
    read(accessor, values);
    return values;
}

std::vector<std::uint32_t> GltfDocument::integers(std::uint32_t accessor) const {
    std::vector<std::uint32_t> values;
    read(accessor, values);
    return values;
}

}  // namespace puppetri::io
