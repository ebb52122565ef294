// SPDX-License-Identifier: MIT
// What stands on the accessors: materials, meshes, skins, nodes, animations, bones of humanoids.
#include <algorithm>
#include <array>
#include <cmath>

#include "gltf_reader.h"
#include "puppetri/math/rotation.h"

namespace puppetri::io {
namespace {

using Json = GltfReader::Json;

constexpr std::size_t kMostNodes = 1u << 16, kMostJoints = 1u << 12;

// The bones of VRM 1.0 that are called otherwise in VRM 0.x.
std::string vrm_1_bone(const std::string& bone) {
    for (const char* side : {"left", "right"}) {
        const std::string thumb = std::string(side) + "Thumb";
        if (bone == thumb + "Proximal") {
            return thumb + "Metacarpal";
        }
        if (bone == thumb + "Intermediate") {
            return thumb + "Proximal";
        }
    }
    return bone;
}

}  // namespace

void GltfReader::read_textures() {
    const Json& textures = list(root_, "textures", "file");
    const Json& samplers = list(root_, "samplers", "file");
    for (std::size_t i = 0; i < textures.size(); ++i) {
        const std::string element = gltf_element("texture", i);
        GltfTexture made;
        if (!textures[i].is_object()) {
            bad(element, "it is not an object");
        } else {
            made.image = index(textures[i], "source", element, doc_.images.size(), "image");
            const std::uint32_t sampler =
                index(textures[i], "sampler", element, samplers.size(), "sampler");
            if (sampler != kNoGltf && samplers[sampler].is_object()) {
                const Json& s = samplers[sampler];
                const auto word = [&](const char* name, std::uint32_t otherwise) {
                    return static_cast<std::uint32_t>(
                        whole(s, name, gltf_element("sampler", sampler), 65536)
                            .value_or(otherwise));
                };
                made.wrap_s = word("wrapS", 10497);
                made.wrap_t = word("wrapT", 10497);
                made.mag_filter = word("magFilter", 9729);
            }
        }
        doc_.textures.push_back(made);
    }
}

std::uint32_t GltfReader::texture_of(const Json& owner, const char* name,
                                     const std::string& element) {
    const Json* info = object(owner, name, element);
    if (info == nullptr) {
        return kNoGltf;
    }
    const std::uint32_t texture = index(*info, "index", element, doc_.textures.size(), "texture");
    if (whole(*info, "texCoord", element, kMostNodes).value_or(0) != 0) {
        note("texture-left-out", element,
             std::string(name) + " uses a second set of texture coordinates",
             "export it with one set of texture coordinates");
        return kNoGltf;
    }
    const Json* extensions = object(*info, "extensions", element);
    if (extensions != nullptr && extensions->contains("KHR_texture_transform")) {
        note("texture-transform", element,
             std::string(name) + " is moved by KHR_texture_transform, which is not done",
             "apply it to the texture coordinates before exporting");
    }
    return texture != kNoGltf && doc_.textures[texture].image == kNoGltf ? kNoGltf : texture;
}

void GltfReader::read_materials() {
    const Json& materials = list(root_, "materials", "file");
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const std::string element = gltf_element("material", i);
        GltfMaterialIn made;
        const Json& m = materials[i];
        if (!m.is_object()) {
            bad(element, "it is not an object");
            doc_.materials.push_back(made);
            continue;
        }
        made.name = text(m, "name", element);
        if (const Json* pbr = object(m, "pbrMetallicRoughness", element)) {
            numbers(*pbr, "baseColorFactor", element, made.base_colour.data(), 4);
            made.metallic = number(*pbr, "metallicFactor", element, 1);
            made.roughness = number(*pbr, "roughnessFactor", element, 1);
            made.base_colour_texture = texture_of(*pbr, "baseColorTexture", element);
            made.metallic_roughness_texture = texture_of(*pbr, "metallicRoughnessTexture", element);
        }
        numbers(m, "emissiveFactor", element, made.emissive.data(), 3);
        made.normal_texture = texture_of(m, "normalTexture", element);
        made.occlusion_texture = texture_of(m, "occlusionTexture", element);
        made.emissive_texture = texture_of(m, "emissiveTexture", element);
        if (const Json* info = object(m, "normalTexture", element)) {
            made.normal_scale = number(*info, "scale", element, 1);
        }
        if (const Json* info = object(m, "occlusionTexture", element)) {
            made.occlusion_strength = number(*info, "strength", element, 1);
        }
        if (m.contains("alphaMode")) {
            made.alpha_mode = text(m, "alphaMode", element);
        }
        made.alpha_cutoff = number(m, "alphaCutoff", element, 0.5);
        made.double_sided = truth(m, "doubleSided", element);
        doc_.materials.push_back(std::move(made));
    }
}

GltfPrimitiveIn GltfReader::read_primitive(const Json& primitive, const std::string& element) {
    GltfPrimitiveIn made;
    const std::size_t accessors = doc_.accessors_.size();
    made.mode = static_cast<std::uint32_t>(whole(primitive, "mode", element, 7).value_or(4));
    made.indices = index(primitive, "indices", element, accessors, "accessor");
    made.material = index(primitive, "material", element, doc_.materials.size(), "material");
    const Json* attributes = object(primitive, "attributes", element);
    if (attributes == nullptr) {
        bad(element, "it has no attributes");
        return made;
    }
    const auto attribute = [&](const char* name) {
        return index(*attributes, name, element, accessors, "accessor");
    };
    made.positions = attribute("POSITION");
    made.normals = attribute("NORMAL");
    made.uvs = attribute("TEXCOORD_0");
    made.joints = attribute("JOINTS_0");
    made.weights = attribute("WEIGHTS_0");
    if (attributes->contains("JOINTS_1")) {
        note("weights-left-out", element, "a vertex hangs on more than four joints",
             "export it with at most four weights per vertex; the first four are used");
    }
    return made;
}

void GltfReader::check_primitive(const GltfPrimitiveIn& p, const std::string& element) {
    const auto attribute = [&](std::uint32_t accessor, const char* as,
                               std::initializer_list<std::uint32_t> components,
                               std::initializer_list<std::uint32_t> types, bool normalized) {
        if (accessor == kNoGltf) {
            return;
        }
        if (use(accessor, element, as, components, types, normalized) && p.positions != kNoGltf &&
            doc_.count(accessor) != doc_.count(p.positions)) {
            bad(element, std::string("there are not as many ") + as + " as positions");
        }
    };
    if (p.positions == kNoGltf) {
        bad(element, "it has no positions");
        return;
    }
    attribute(p.positions, "positions", {3}, {5126, 5120, 5121, 5122, 5123}, false);
    attribute(p.normals, "normals", {3}, {5126, 5120, 5122}, true);
    attribute(p.uvs, "texture coordinates", {2}, {5126, 5120, 5121, 5122, 5123}, false);
    attribute(p.joints, "joints", {4}, {5121, 5123}, false);
    attribute(p.weights, "weights", {4}, {5126, 5121, 5123}, true);
    if ((p.joints == kNoGltf) != (p.weights == kNoGltf)) {
        bad(element, "it has joints without weights or weights without joints");
    }
    if (p.indices != kNoGltf && use(p.indices, element, "indices", {1}, {5121, 5123, 5125})) {
        const std::uint32_t count = doc_.count(p.positions);
        for (const std::uint32_t i : doc_.integers(p.indices)) {
            if (i >= count) {
                bad(element, "an index is " + std::to_string(i) + ", but there are " +
                                 std::to_string(count) + " vertices");
                break;
            }
        }
    }
}

void GltfReader::read_meshes() {
    const Json& meshes = list(root_, "meshes", "file");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const std::string element = gltf_element("mesh", i);
        GltfMeshIn made;
        std::uint32_t most = 0;
        if (!meshes[i].is_object()) {
            bad(element, "it is not an object");
        } else {
            made.name = text(meshes[i], "name", element);
            const Json& primitives = list(meshes[i], "primitives", element);
            for (std::size_t k = 0; k < primitives.size(); ++k) {
                const std::string part = element + " primitive " + std::to_string(k);
                if (!primitives[k].is_object()) {
                    bad(part, "it is not an object");
                    continue;
                }
                const GltfPrimitiveIn p = read_primitive(primitives[k], part);
                check_primitive(p, part);
                if (!defects_.any() && p.joints != kNoGltf) {
                    const std::vector<std::uint32_t> joints = doc_.integers(p.joints);
                    const std::vector<float> weights = doc_.floats(p.weights);
                    for (std::size_t v = 0; v < joints.size(); ++v) {
                        most = weights[v] > 0 ? std::max(most, joints[v]) : most;
                    }
                }
                made.primitives.push_back(p);
            }
        }
        most_joint_.push_back(most);
        doc_.meshes.push_back(std::move(made));
    }
}

void GltfReader::read_skins() {
    const Json& skins = list(root_, "skins", "file");
    const std::size_t node_count = list(root_, "nodes", "file").size();
    for (std::size_t i = 0; i < skins.size(); ++i) {
        const std::string element = gltf_element("skin", i);
        GltfSkin made;
        if (!skins[i].is_object()) {
            bad(element, "it is not an object");
            doc_.skins.push_back(made);
            continue;
        }
        made.name = text(skins[i], "name", element);
        const Json& joints = list(skins[i], "joints", element);
        std::vector<bool> seen(node_count, false);
        for (const Json& joint : joints) {
            if (!joint.is_number_unsigned() || joint.get<std::uint64_t>() >= node_count) {
                bad(element, "a joint is not one of the " + std::to_string(node_count) + " nodes");
                break;
            }
            const auto node = static_cast<std::uint32_t>(joint.get<std::uint64_t>());
            if (seen[node]) {
                bad(element, "node " + std::to_string(node) + " is a joint twice");
                break;
            }
            seen[node] = true;
            made.joints.push_back(node);
        }
        if (joints.empty()) {
            bad(element, "it has no joints");
        } else if (joints.size() > kMostJoints) {
            error("too-large", element, "it has " + std::to_string(joints.size()) + " joints",
                  "export at most " + std::to_string(kMostJoints));
        }
        made.inverse_bind_matrices =
            index(skins[i], "inverseBindMatrices", element, doc_.accessors_.size(), "accessor");
        if (made.inverse_bind_matrices != kNoGltf &&
            use(made.inverse_bind_matrices, element, "inverse bind matrices", {16}, {5126}) &&
            doc_.count(made.inverse_bind_matrices) < made.joints.size()) {
            bad(element, "it has fewer inverse bind matrices than joints");
        }
        doc_.skins.push_back(std::move(made));
    }
}

// Gram-Schmidt: x keeps its direction, y its plane with it; what is left over is shear.
void GltfReader::read_transform(const Json& node, const std::string& element, GltfNode& made) {
    std::array<double, 16> m{};
    if (numbers(node, "matrix", element, m.data(), 16)) {
        const Vec3 x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
        made.parent_from_node.translation = {m[12], m[13], m[14]};
        const Vec3 ex = normalized(x);
        const Vec3 ey = normalized(y - ex * dot(ex, y), {0, 1, 0});
        const Vec3 ez = cross(ex, ey);
        made.scale = {dot(x, ex), dot(y, ey), dot(z, ez)};
        made.parent_from_node.rotation = normalized(from_basis(ex, ey, ez));
    }
    std::array<double, 4> q{0, 0, 0, 1};
    std::array<double, 3> t{};
    if (numbers(node, "rotation", element, q.data(), 4)) {
        const double size = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (!(size > 1e-6)) {
            bad(element, "its rotation is zero");
        } else {
            made.parent_from_node.rotation = normalized(Quat{q[0], q[1], q[2], q[3]});
        }
    }
    if (numbers(node, "translation", element, t.data(), 3)) {
        made.parent_from_node.translation = {t[0], t[1], t[2]};
    }
    t = {1, 1, 1};
    if (numbers(node, "scale", element, t.data(), 3)) {
        made.scale = {t[0], t[1], t[2]};
    }
    const Vec3 p = made.parent_from_node.translation;
    if (!(std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) < 1e9) ||
        !(std::fabs(made.scale.x) + std::fabs(made.scale.y) + std::fabs(made.scale.z) < 1e9)) {
        bad(element, "its place or scale is beyond all measure");
    }
}

void GltfReader::read_nodes() {
    const Json& nodes = list(root_, "nodes", "file");
    if (nodes.size() > kMostNodes) {
        error("too-large", "file", "it has " + std::to_string(nodes.size()) + " nodes",
              "export the figure alone");
        return;
    }
    doc_.nodes.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::string element = gltf_element("node", i);
        GltfNode& made = doc_.nodes[i];
        if (!nodes[i].is_object()) {
            bad(element, "it is not an object");
            continue;
        }
        made.name = text(nodes[i], "name", element);
        made.mesh = index(nodes[i], "mesh", element, doc_.meshes.size(), "mesh");
        made.skin = index(nodes[i], "skin", element, doc_.skins.size(), "skin");
        read_transform(nodes[i], element, made);
        for (const Json& child : list(nodes[i], "children", element)) {
            if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= nodes.size()) {
                bad(element,
                    "a child is not one of the " + std::to_string(nodes.size()) + " nodes");
                break;
            }
            const auto c = static_cast<std::uint32_t>(child.get<std::uint64_t>());
            if (doc_.nodes[c].parent != kNoGltf) {
                bad(gltf_element("node", c), "it is the child of two nodes");
                break;
            }
            doc_.nodes[c].parent = static_cast<std::uint32_t>(i);
            made.children.push_back(c);
        }
    }
}

void GltfReader::check_forest() {
    std::vector<std::uint32_t> open;
    std::size_t reached = 0;
    for (std::uint32_t i = 0; i < doc_.nodes.size(); ++i) {
        if (doc_.nodes[i].parent == kNoGltf) {
            open.push_back(i);
        }
    }
    while (!open.empty()) {
        const std::uint32_t node = open.back();
        open.pop_back();
        ++reached;
        open.insert(open.end(), doc_.nodes[node].children.begin(), doc_.nodes[node].children.end());
    }
    if (reached < doc_.nodes.size()) {
        bad("nodes", "some are their own ancestors");
    }
}

void GltfReader::read_roots() {
    const Json& scenes = list(root_, "scenes", "file");
    const std::uint32_t shown = index(root_, "scene", "file", scenes.size(), "scene");
    const std::size_t scene = shown == kNoGltf ? 0 : shown;
    if (scene < scenes.size() && scenes[scene].is_object()) {
        const std::string element = gltf_element("scene", scene);
        for (const Json& node : list(scenes[scene], "nodes", element)) {
            if (!node.is_number_unsigned() || node.get<std::uint64_t>() >= doc_.nodes.size()) {
                bad(element, "it names a node that is not there");
                break;
            }
            doc_.roots.push_back(static_cast<std::uint32_t>(node.get<std::uint64_t>()));
        }
    } else {
        for (std::uint32_t i = 0; i < doc_.nodes.size(); ++i) {
            if (doc_.nodes[i].parent == kNoGltf) {
                doc_.roots.push_back(i);
            }
        }
    }
}

void GltfReader::check_skinned_nodes() {
    for (std::uint32_t i = 0; i < doc_.nodes.size(); ++i) {
        const GltfNode& node = doc_.nodes[i];
        if (node.skin != kNoGltf && node.mesh != kNoGltf &&
            most_joint_[node.mesh] >= doc_.skins[node.skin].joints.size()) {
            bad(doc_.node_text(i),
                "a vertex of its mesh hangs on joint " + std::to_string(most_joint_[node.mesh]) +
                    ", but the skin has " + std::to_string(doc_.skins[node.skin].joints.size()));
        }
    }
}

void GltfReader::read_animations() {
    const Json& animations = list(root_, "animations", "file");
    for (std::size_t i = 0; i < animations.size(); ++i) {
        const std::string element = gltf_element("animation", i);
        GltfAnimationIn made;
        if (!animations[i].is_object()) {
            bad(element, "it is not an object");
            continue;
        }
        made.name = text(animations[i], "name", element);
        const Json& samplers = list(animations[i], "samplers", element);
        const Json& channels = list(animations[i], "channels", element);
        for (std::size_t k = 0; k < channels.size(); ++k) {
            read_channel(channels[k], samplers, element + " channel " + std::to_string(k), made);
        }
        doc_.animations.push_back(std::move(made));
    }
}

void GltfReader::read_channel(const Json& channel, const Json& samplers, const std::string& element,
                              GltfAnimationIn& made) {
    const Json* target = channel.is_object() ? object(channel, "target", element) : nullptr;
    const std::uint32_t sampler =
        channel.is_object() ? index(channel, "sampler", element, samplers.size(), "sampler")
                            : kNoGltf;
    if (target == nullptr || sampler == kNoGltf || !samplers[sampler].is_object()) {
        bad(element, "it has no target or no sampler");
        return;
    }
    const std::string path = text(*target, "path", element);
    GltfChannelIn c;
    c.node = index(*target, "node", element, doc_.nodes.size(), "node");
    if (c.node == kNoGltf || path == "weights" || path == "pointer") {
        return;  // nothing that moves a joint
    }
    c.path = path == "translation" ? GltfPath::kTranslation
             : path == "scale"     ? GltfPath::kScale
                                   : GltfPath::kRotation;
    if (c.path == GltfPath::kRotation && path != "rotation") {
        bad(element, "its path is not one of glTF");
        return;
    }
    const Json& s = samplers[sampler];
    const std::string way =
        s.contains("interpolation") ? text(s, "interpolation", element) : "LINEAR";
    c.interpolation = way == "STEP"          ? GltfInterpolation::kStep
                      : way == "CUBICSPLINE" ? GltfInterpolation::kCubicSpline
                                             : GltfInterpolation::kLinear;
    if (c.interpolation == GltfInterpolation::kLinear && way != "LINEAR") {
        bad(element, "its interpolation is not one of glTF");
    }
    c.times = index(s, "input", element, doc_.accessors_.size(), "accessor");
    c.values = index(s, "output", element, doc_.accessors_.size(), "accessor");
    if (c.times == kNoGltf || c.values == kNoGltf) {
        bad(element, "its sampler has no input or no output");
        return;
    }
    const bool turns = c.path == GltfPath::kRotation;
    if (!use(c.times, element, "times", {1}, {5126}) ||
        !use(c.values, element, turns ? "rotations" : "translations", {turns ? 4u : 3u},
             {5126, 5120, 5121, 5122, 5123}, true)) {
        return;
    }
    const std::uint64_t each = c.interpolation == GltfInterpolation::kCubicSpline ? 3 : 1;
    if (doc_.count(c.values) != doc_.count(c.times) * each) {
        bad(element, "it has " + std::to_string(doc_.count(c.times)) + " times but " +
                         std::to_string(doc_.count(c.values)) + " values");
        return;
    }
    float before = -1;
    for (const float time : doc_.floats(c.times)) {
        if (!(time > before) || time < 0) {
            bad(element, "its times do not increase from 0 on");
            return;
        }
        before = time;
    }
    made.channels.push_back(c);
}

void GltfReader::add_bone(const std::string& bone, std::uint32_t node, const std::string& element) {
    for (const GltfBone& other : doc_.humanoid) {
        if (other.bone == bone || other.node == node) {
            bad(element, other.bone == bone ? bone + " is named twice"
                                            : "node " + std::to_string(node) + " is " + bone +
                                                  " and " + other.bone);
            return;
        }
    }
    doc_.humanoid.push_back({bone, node});
}

void GltfReader::read_bones(const Json& bones, bool version_0) {
    const std::string element = "humanoid";
    if (version_0 ? !bones.is_array() : !bones.is_object()) {
        bad(element, "humanBones is not written as its version of VRM wants");
        return;
    }
    if (bones.size() > 256) {
        error("too-large", element, "it has more bones than a humanoid", "export it again");
        return;
    }
    for (const auto& item : bones.items()) {
        const Json& bone = item.value();
        if (!bone.is_object()) {
            bad(element, "a bone is not an object");
            continue;
        }
        const std::string name = version_0 ? vrm_1_bone(text(bone, "bone", element)) : item.key();
        const std::uint32_t node = index(bone, "node", element, doc_.nodes.size(), "node");
        if (node == kNoGltf) {
            bad(element, name + " names no node");
            continue;
        }
        add_bone(name, node, element);
    }
}

void GltfReader::read_humanoid() {
    const Json* extensions = object(root_, "extensions", "file");
    if (extensions == nullptr) {
        return;
    }
    for (const char* name : {"VRMC_vrm", "VRMC_vrm_animation", "VRM"}) {
        const Json* vrm = object(*extensions, name, "file");
        const Json* humanoid = vrm != nullptr ? object(*vrm, "humanoid", "extension") : nullptr;
        if (vrm != nullptr && std::string_view(name) == "VRMC_vrm_animation") {
            doc_.vrm_animation = true;
        }
        if (humanoid != nullptr && humanoid->contains("humanBones") && doc_.humanoid.empty()) {
            doc_.vrm_0 = std::string_view(name) == "VRM";
            read_bones(humanoid->at("humanBones"), doc_.vrm_0);
        }
    }
}

void GltfReader::warn_of_lines() {
    for (const GltfMeshIn& mesh : doc_.meshes) {
        for (const GltfPrimitiveIn& p : mesh.primitives) {
            if (p.mode != 4 && p.mode != 5 && p.mode != 6) {
                note("not-shown", "mesh " + mesh.name,
                     "it has points or lines, which are not shown", "make them triangles");
                return;
            }
        }
    }
}

}  // namespace puppetri::io
