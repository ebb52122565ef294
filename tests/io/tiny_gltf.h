// SPDX-License-Identifier: MIT
// Small figures as glTF files, written by hand: a humanoid of boxes' corners in a T-pose or with
// lowered arms, with the names of any program, as text, GLB or VRM.
#pragma once
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace puppetri::io::testing {

struct TinyBone {
    const char* name;  // of VRM 1.0
    int parent;        // in this list
    double x, y, z;    // in the model, metres
};

// 1.6 m tall; arms level.
inline const std::vector<TinyBone>& tiny_bones() {
    static const std::vector<TinyBone> bones{
        {"hips", -1, 0, 0.9, 0},
        {"spine", 0, 0, 1.0, 0},
        {"chest", 1, 0, 1.15, 0},
        {"neck", 2, 0, 1.35, 0},
        {"head", 3, 0, 1.42, 0},
        {"leftUpperArm", 2, 0.15, 1.3, 0},
        {"leftLowerArm", 5, 0.42, 1.3, 0},
        {"leftHand", 6, 0.65, 1.3, 0},
        {"rightUpperArm", 2, -0.15, 1.3, 0},
        {"rightLowerArm", 8, -0.42, 1.3, 0},
        {"rightHand", 9, -0.65, 1.3, 0},
        {"leftUpperLeg", 0, 0.09, 0.86, 0},
        {"leftLowerLeg", 11, 0.09, 0.47, 0},
        {"leftFoot", 12, 0.09, 0.08, 0},
        {"leftToes", 13, 0.09, 0.02, 0.12},
        {"rightUpperLeg", 0, -0.09, 0.86, 0},
        {"rightLowerLeg", 15, -0.09, 0.47, 0},
        {"rightFoot", 16, -0.09, 0.08, 0},
        {"rightToes", 17, -0.09, 0.02, 0.12},
    };
    return bones;
}

struct TinyFile {
    // What a bone is called in the file; empty: the bone is left out (its children hang higher).
    std::function<std::string(const std::string& bone)> name = [](const std::string& b) {
        return b;
    };
    std::function<void(const std::string& bone, double& x, double& y, double& z)> move = nullptr;
    enum class Vrm { kNone, kZero, kOne } vrm = Vrm::kNone;
    bool picture = false;
    double scale = 1;  // units per metre
};

struct TinyParts {
    std::string json, binary;
};

inline std::string tiny_number(double v) {
    std::string text = std::to_string(v);
    while (text.find('.') != std::string::npos && (text.back() == '0' || text.back() == '.')) {
        const bool dot = text.back() == '.';
        text.pop_back();
        if (dot) {
            break;
        }
    }
    return text == "-0" ? "0" : text;
}

// The skin: for each bone a triangle around it, and for the foot one that reaches the floor.
inline TinyParts tiny_parts(const TinyFile& file, std::string_view uri = "") {
    struct Kept {
        std::string bone, name;
        int parent;
        double at[3];
    };
    std::vector<Kept> kept;
    std::map<int, int> of;
    const auto& bones = tiny_bones();
    for (int i = 0; i < static_cast<int>(bones.size()); ++i) {
        const TinyBone& b = bones[static_cast<std::size_t>(i)];
        int up = b.parent;
        while (up >= 0 && !of.count(up)) {
            up = bones[static_cast<std::size_t>(up)].parent;
        }
        const std::string name = file.name(b.name);
        if (name.empty()) {
            continue;
        }
        of[i] = static_cast<int>(kept.size());
        Kept k{b.name, name, up < 0 ? -1 : of[up], {b.x, b.y, b.z}};
        if (file.move) {
            file.move(k.bone, k.at[0], k.at[1], k.at[2]);
        }
        for (double& v : k.at) {
            v *= file.scale;
        }
        kept.push_back(k);
    }
    const std::size_t n = kept.size();
    std::string binary;
    const auto put = [&](const void* data, std::size_t size) {
        binary.append(static_cast<const char*>(data), size);
    };
    const auto put_float = [&](double v) {
        const float f = static_cast<float>(v);
        put(&f, 4);
    };
    struct View {
        std::size_t offset, length;
    };
    std::vector<View> views;
    const auto view = [&](auto fill) {
        const std::size_t at = binary.size();
        fill();
        views.push_back({at, binary.size() - at});
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
    };
    view([&] {
        for (const Kept& k : kept) {
            const double s = file.scale;
            const bool foot = k.bone.find("Foot") != std::string::npos;
            const double low = foot ? -k.at[1] : -0.03 * s;
            const double corners[3][3] = {{-0.03 * s, low, -0.06 * s},
                                          {0.03 * s, low, (foot ? 0.18 : 0.03) * s},
                                          {0, 0.18 * s, 0}};
            for (const auto& c : corners) {
                for (int d = 0; d < 3; ++d) {
                    put_float(k.at[d] + c[d] * (d == 1 && !foot && c[1] > 0 ? 0.5 : 1));
                }
            }
        }
    });
    view([&] {
        for (std::size_t v = 0; v < 3 * n; ++v) {
            const std::uint8_t joints[4] = {static_cast<std::uint8_t>(v / 3), 0, 0, 0};
            put(joints, 4);
        }
    });
    view([&] {
        for (std::size_t v = 0; v < 3 * n; ++v) {
            for (const double w : {1.0, 0.0, 0.0, 0.0}) {
                put_float(w);
            }
        }
    });
    view([&] {
        for (std::size_t v = 0; v < 3 * n; ++v) {
            const std::uint16_t index = static_cast<std::uint16_t>(v);
            put(&index, 2);
        }
    });
    view([&] {
        for (const Kept& k : kept) {
            for (int c = 0; c < 4; ++c) {
                for (int r = 0; r < 4; ++r) {
                    put_float(c == 3 && r < 3 ? -k.at[r] : c == r ? 1 : 0);
                }
            }
        }
    });
    if (file.picture) {
        view([&] {
            for (std::size_t v = 0; v < 3 * n; ++v) {
                put_float(v % 3 == 1);
                put_float(v % 3 == 2);
            }
        });
        view([&] { put("\x89PNG\r\n\x1a\nnot a picture", 21); });
    }
    const auto text = [](std::size_t v) { return std::to_string(v); };
    std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,)" + text(n) +
                       R"(]}],"nodes":[)";
    for (std::size_t i = 0; i < n; ++i) {
        const Kept& k = kept[i];
        const double* up = k.parent < 0 ? nullptr : kept[static_cast<std::size_t>(k.parent)].at;
        json += R"({"name":")" + k.name + R"(","translation":[)";
        for (int d = 0; d < 3; ++d) {
            json += (d > 0 ? "," : "") + tiny_number(k.at[d] - (up ? up[d] : 0));
        }
        json += "]";
        std::string children;
        for (std::size_t c = 0; c < n; ++c) {
            if (kept[c].parent == static_cast<int>(i)) {
                children += (children.empty() ? "" : ",") + text(c);
            }
        }
        json += children.empty() ? "}," : R"(,"children":[)" + children + "]},";
    }
    json += R"({"mesh":0,"skin":0}],"skins":[{"joints":[)";
    for (std::size_t i = 0; i < n; ++i) {
        json += (i > 0 ? "," : "") + text(i);
    }
    json += R"(],"inverseBindMatrices":4}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,)"
            R"("JOINTS_0":1,"WEIGHTS_0":2)" +
            std::string(file.picture ? R"(,"TEXCOORD_0":5)" : "") + R"(},"indices":3)" +
            (file.picture ? R"(,"material":0)" : "") + "}]}]";
    if (file.picture) {
        json +=
            R"(,"materials":[{"name":"cloth","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"
            R"(,"textures":[{"source":0}],"images":[{"bufferView":6,"mimeType":"image/png"}])";
    }
    if (file.vrm == TinyFile::Vrm::kOne) {
        json += R"(,"extensions":{"VRMC_vrm":{"specVersion":"1.0","humanoid":{"humanBones":{)";
        for (std::size_t i = 0; i < n; ++i) {
            json += (i > 0 ? ",\"" : "\"") + kept[i].bone + R"(":{"node":)" + text(i) + "}";
        }
        json += "}}}}";
    } else if (file.vrm == TinyFile::Vrm::kZero) {
        json += R"(,"extensions":{"VRM":{"humanoid":{"humanBones":[)";
        for (std::size_t i = 0; i < n; ++i) {
            json += (i > 0 ? "," : "") + std::string(R"({"bone":")") + kept[i].bone +
                    R"(","node":)" + text(i) + "}";
        }
        json += "]}}}";
    }
    json += R"(,"accessors":[)";
    const auto accessor = [&](std::size_t v, int component, std::size_t count, const char* type) {
        json += (v > 0 ? "," : "") + std::string(R"({"bufferView":)") + text(v) +
                R"(,"componentType":)" + std::to_string(component) + R"(,"count":)" + text(count) +
                R"(,"type":")" + type + "\"}";
    };
    accessor(0, 5126, 3 * n, "VEC3");
    accessor(1, 5121, 3 * n, "VEC4");
    accessor(2, 5126, 3 * n, "VEC4");
    accessor(3, 5123, 3 * n, "SCALAR");
    accessor(4, 5126, n, "MAT4");
    if (file.picture) {
        accessor(5, 5126, 3 * n, "VEC2");
    }
    json += R"(],"bufferViews":[)";
    for (std::size_t v = 0; v < views.size(); ++v) {
        json += (v > 0 ? "," : "") + std::string(R"({"buffer":0,"byteOffset":)") +
                text(views[v].offset) + R"(,"byteLength":)" + text(views[v].length) + "}";
    }
    json += R"(],"buffers":[{"byteLength":)" + text(binary.size()) +
            (uri.empty() ? "" : R"(,"uri":")" + std::string(uri) + "\"") + "}]}";
    return {json, binary};
}

inline std::string glb_of(std::string json, std::string binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string bytes = "glTF";
    const auto word = [&](std::size_t v) {
        for (int i = 0; i < 4; ++i) {
            bytes += static_cast<char>(v >> (8 * i) & 0xFF);
        }
    };
    word(2);
    word(12 + 8 + json.size() + 8 + binary.size());
    word(json.size());
    bytes += "JSON" + json;
    word(binary.size());
    bytes += std::string("BIN\0", 4) + binary;
    return bytes;
}

inline std::string tiny_glb(const TinyFile& file = {}) {
    TinyParts parts = tiny_parts(file);
    return glb_of(std::move(parts.json), std::move(parts.binary));
}

}  // namespace puppetri::io::testing
