// SPDX-License-Identifier: MIT
// The binary half of a glTF file: bytes, the views into them, and the accessors that say what the
// bytes mean.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "puppetri/io/json_writer.h"

namespace puppetri::io {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

enum class Target : std::int32_t { kNone = 0, kVertices = 34962, kIndices = 34963 };
enum class Component : std::int32_t { kU8 = 5121, kU16 = 5123, kU32 = 5125, kFloat = 5126 };

class GltfBuffer {
 public:
    // Adds values as a view of their own (4-byte aligned) and an accessor over all of it; gives the
    // accessor's index. `type` is glTF's: "SCALAR", "VEC3", "VEC4", "MAT4". With bounds, min and
    // max are written (over `width` floats).
    template <class T>
    int add(std::span<const T> values, Target target, Component component, const char* type,
            int width, bool bounds = false) {
        Accessor accessor;
        accessor.view =
            add_view({reinterpret_cast<const char*>(values.data()), values.size_bytes()}, target);
        accessor.component = component;
        accessor.type = type;
        accessor.count = static_cast<std::int64_t>(values.size()) / width;
        if constexpr (std::is_same_v<T, float>) {
            if (bounds) {
                set_bounds(accessor, values, width);
            }
        }
        accessors_.push_back(std::move(accessor));
        return static_cast<int>(accessors_.size()) - 1;
    }

    // Bytes without an accessor (an image); gives the view's index.
    int add_bytes(std::string_view bytes) { return add_view(bytes, Target::kNone); }

    void write_accessors(JsonWriter& json) const;
    void write_views(JsonWriter& json) const;
    const std::string& bytes() const { return bytes_; }

 private:
    struct View {
        std::size_t offset = 0, length = 0;
        Target target = Target::kNone;
    };
    struct Accessor {
        int view = 0;
        std::int64_t count = 0;
        Component component = Component::kFloat;
        const char* type = "SCALAR";
        std::vector<float> min, max;
    };

    int add_view(std::string_view bytes, Target target);
    static void set_bounds(Accessor& accessor, std::span<const float> values, int width);

    std::string bytes_;
    std::vector<View> views_;
    std::vector<Accessor> accessors_;
};

}  // namespace puppetri::io
