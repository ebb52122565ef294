// SPDX-License-Identifier: MIT
#include "support/gltf_reader.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <stdexcept>

namespace puppetri::test {
namespace {

// Element i, component c of an accessor as a double; floats and unsigned integers.
double component(const tinygltf::Model& model, int accessor, std::size_t i, int c) {
    const tinygltf::Accessor& a = model.accessors.at(static_cast<std::size_t>(accessor));
    const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(a.bufferView));
    const int stride = a.ByteStride(view);
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType));
    const unsigned char* at =
        model.buffers.at(static_cast<std::size_t>(view.buffer)).data.data() + view.byteOffset +
        a.byteOffset + i * static_cast<std::size_t>(stride) + static_cast<std::size_t>(c * size);
    if (a.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) {
        float value = 0;
        std::copy(at, at + 4, reinterpret_cast<unsigned char*>(&value));
        return static_cast<double>(value);
    }
    std::uint32_t value = 0;
    std::copy(at, at + size, reinterpret_cast<unsigned char*>(&value));
    return value;
}

std::size_t count_of(const tinygltf::Model& model, int accessor) {
    return model.accessors.at(static_cast<std::size_t>(accessor)).count;
}

std::string text_of(const tinygltf::Value& object, const std::string& key) {
    return object.Has(key) && object.Get(key).IsString() ? object.Get(key).Get<std::string>()
                                                         : std::string();
}

GltfClip clip_of(const tinygltf::Model& model, const tinygltf::Animation& animation) {
    GltfClip clip;
    clip.name = animation.name;
    clip.extras = animation.extras_json_string;
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
        const tinygltf::AnimationSampler& sampler =
            animation.samplers.at(static_cast<std::size_t>(channel.sampler));
        if (sampler.interpolation != "LINEAR" && !sampler.interpolation.empty()) {
            throw std::runtime_error("interpolation " + sampler.interpolation);
        }
        GltfCurve curve;
        const int parts = channel.target_path == "rotation" ? 4 : 3;
        for (std::size_t i = 0; i < count_of(model, sampler.input); ++i) {
            curve.times.push_back(component(model, sampler.input, i, 0));
            Eigen::Vector4d value = Eigen::Vector4d::Zero();
            for (int c = 0; c < parts; ++c) {
                value[c] = component(model, sampler.output, i, c);
            }
            curve.values.push_back(value);
        }
        clip.curves[{channel.target_node, channel.target_path}] = std::move(curve);
    }
    if (animation.extras.Has("puppetri")) {
        const tinygltf::Value& events = animation.extras.Get("puppetri").Get("events");
        for (std::size_t i = 0; i < events.ArrayLen(); ++i) {
            const tinygltf::Value& e = events.Get(static_cast<int>(i));
            clip.events.push_back({e.Get("t").GetNumberAsDouble(), e.Get("frame").GetNumberAsInt(),
                                   text_of(e, "name"), text_of(e, "actor"), text_of(e, "limb"),
                                   text_of(e, "prop")});
        }
    }
    return clip;
}

GltfPrimitiveData primitive_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    GltfPrimitiveData data;
    const int positions = primitive.attributes.at("POSITION");
    for (std::size_t i = 0; i < count_of(model, positions); ++i) {
        data.positions.emplace_back(component(model, positions, i, 0),
                                    component(model, positions, i, 1),
                                    component(model, positions, i, 2));
    }
    if (primitive.attributes.count("JOINTS_0") != 0) {
        for (std::size_t i = 0; i < data.positions.size(); ++i) {
            std::array<int, 4> joints{};
            std::array<double, 4> weights{};
            for (int k = 0; k < 4; ++k) {
                const auto slot = static_cast<std::size_t>(k);
                joints[slot] =
                    static_cast<int>(component(model, primitive.attributes.at("JOINTS_0"), i, k));
                weights[slot] = component(model, primitive.attributes.at("WEIGHTS_0"), i, k);
            }
            data.joints.push_back(joints);
            data.weights.push_back(weights);
        }
    }
    data.index_count = primitive.indices < 0 ? 0 : count_of(model, primitive.indices);
    return data;
}

Eigen::Vector4d at_time(const GltfCurve& curve, double t, bool rotation) {
    const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), t);
    if (after == curve.times.begin()) {
        return curve.values.front();
    }
    if (after == curve.times.end()) {
        return curve.values.back();
    }
    const auto i = static_cast<std::size_t>(after - curve.times.begin());
    const double s = (t - curve.times[i - 1]) / (curve.times[i] - curve.times[i - 1]);
    if (!rotation) {
        return (1 - s) * curve.values[i - 1] + s * curve.values[i];
    }
    return Eigen::Quaterniond(curve.values[i - 1])
        .slerp(s, Eigen::Quaterniond(curve.values[i]))
        .coeffs();
}

}  // namespace

double GltfClip::end_s() const {
    double end = 0;
    for (const auto& [target, curve] : curves) {
        end = std::max(end, curve.times.back());
    }
    return end;
}

int GltfFile::find(const std::string& name) const {
    const auto found =
        std::find_if(nodes.begin(), nodes.end(), [&](const GltfNode& n) { return n.name == name; });
    return found == nodes.end() ? -1 : static_cast<int>(found - nodes.begin());
}

std::vector<Eigen::Isometry3d> GltfFile::pose(std::size_t clip, double t) const {
    std::vector<Eigen::Isometry3d> world(nodes.size());
    // Places by way of the scales; turns without them.
    std::vector<Eigen::Affine3d> scaled(nodes.size());
    for (const int n : order) {
        const GltfNode& node = nodes[static_cast<std::size_t>(n)];
        Eigen::Vector3d translation = node.translation;
        Eigen::Quaterniond rotation = node.rotation;
        if (clip < clips.size()) {
            const auto& curves = clips[clip].curves;
            if (const auto found = curves.find({n, "translation"}); found != curves.end()) {
                translation = at_time(found->second, t, false).head<3>();
            }
            if (const auto found = curves.find({n, "rotation"}); found != curves.end()) {
                rotation = Eigen::Quaterniond(at_time(found->second, t, true));
            }
        }
        Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
        local.translate(translation).rotate(rotation.normalized());
        const auto at = static_cast<std::size_t>(n), above = static_cast<std::size_t>(node.parent);
        scaled[at] = Eigen::Affine3d(local) * Eigen::Scaling(node.scale);
        world[at] = local;
        if (node.parent >= 0) {
            scaled[at] = scaled[above] * scaled[at];
            world[at] = world[above] * local;
        }
        world[at].translation() = scaled[at].translation();
    }
    return world;
}

GltfFile read_gltf(const std::string& bytes, const std::string& folder, bool scales) {
    tinygltf::TinyGLTF loader;
    loader.SetStoreOriginalJSONForExtrasAndExtensions(true);
    tinygltf::Model model;
    std::string error, warning;
    const auto size = static_cast<unsigned>(bytes.size());
    const bool good =
        bytes.starts_with("glTF")
            ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          size, folder)
            : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
    if (!good || !error.empty() || !warning.empty()) {
        throw std::runtime_error("tinygltf: " + error + warning);
    }
    GltfFile file;
    for (const tinygltf::Node& n : model.nodes) {
        GltfNode node;
        node.name = n.name;
        node.children = n.children;
        node.mesh = n.mesh;
        node.skin = n.skin;
        node.camera = n.camera;
        if ((!n.scale.empty() || !n.matrix.empty()) && !scales) {
            throw std::runtime_error("node " + n.name + " has a scale or a matrix");
        }
        if (!n.scale.empty()) {
            node.scale = {n.scale[0], n.scale[1], n.scale[2]};
        }
        if (!n.matrix.empty()) {
            const Eigen::Affine3d affine(Eigen::Map<const Eigen::Matrix4d>(n.matrix.data()));
            Eigen::Matrix3d turn, stretch;
            affine.computeRotationScaling(&turn, &stretch);
            node.translation = affine.translation();
            node.rotation = turn;
            node.scale = stretch.diagonal();
        }
        if (!n.translation.empty()) {
            node.translation = {n.translation[0], n.translation[1], n.translation[2]};
        }
        if (!n.rotation.empty()) {
            node.rotation =
                Eigen::Quaterniond(n.rotation[3], n.rotation[0], n.rotation[1], n.rotation[2]);
        }
        file.nodes.push_back(std::move(node));
    }
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
        for (const int child : file.nodes[i].children) {
            file.nodes[static_cast<std::size_t>(child)].parent = static_cast<int>(i);
        }
    }
    file.order = model.scenes.at(static_cast<std::size_t>(std::max(model.defaultScene, 0))).nodes;
    for (std::size_t i = 0; i < file.order.size(); ++i) {
        const auto& children = file.nodes[static_cast<std::size_t>(file.order[i])].children;
        file.order.insert(file.order.end(), children.begin(), children.end());
    }
    for (const tinygltf::Skin& s : model.skins) {
        GltfSkin skin;
        skin.joints = s.joints;
        for (std::size_t i = 0; i < s.joints.size(); ++i) {
            Eigen::Matrix4d matrix;
            for (int c = 0; c < 16; ++c) {
                matrix(c % 4, c / 4) = component(model, s.inverseBindMatrices, i, c);
            }
            skin.inverse_bind.push_back(matrix);
        }
        file.skins.push_back(std::move(skin));
    }
    for (const tinygltf::Mesh& mesh : model.meshes) {
        std::vector<GltfPrimitiveData> primitives;
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            primitives.push_back(primitive_of(model, primitive));
        }
        file.meshes.push_back(std::move(primitives));
    }
    for (const tinygltf::Animation& animation : model.animations) {
        file.clips.push_back(clip_of(model, animation));
    }
    for (const tinygltf::Material& material : model.materials) {
        file.materials.push_back(material.name);
    }
    file.cameras = model.cameras.size();
    return file;
}

}  // namespace puppetri::test
