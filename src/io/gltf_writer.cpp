// SPDX-License-Identifier: MIT
#include "puppetri/io/gltf_writer.h"

#include <algorithm>
#include <cstring>

#include "gltf_animation.h"
#include "gltf_buffer.h"
#include "gltf_mesh.h"
#include "key_reduction.h"
#include "puppetri/io/atomic_file.h"
#include "rest_pose.h"

namespace puppetri::io {
namespace {

struct Node {
    std::string name;
    Transform parent_from_node;
    std::vector<int> children;
    int mesh = -1, skin = -1, camera = -1;
};

struct Skin {
    std::string name;
    std::vector<int> joints;
    int inverse_bind_matrices = -1;
};

// What a name of the takes became.
struct Placed {
    std::string name;
    int first_node = 0;  // of an actor: the root joint, the others follow in the skeleton's order
};

class Assembly {
 public:
    Assembly(const GltfContent& content, const GltfOptions& options)
        : content_(content), options_(options) {
        PUP_REQUIRE(!content.takes.empty());
        for (const Take& take : content.takes) {
            for (const TakeActor& actor : take.actors) {
                place_actor(actor);
            }
            for (const TakeProp& prop : take.props) {
                place_prop(prop);
            }
        }
        for (const StaticMesh& set : content.sets) {
            const int mesh =
                set.mesh ? add_mesh(meshes_, buffer_, node_name(set.name), *set.mesh) : -1;
            add_root({unique(set.name), set.world_from_mesh, {}, mesh, -1, -1});
        }
        for (std::size_t i = 0; i < content.cameras.size(); ++i) {
            const CameraTrack& camera = content.cameras[i];
            PUP_REQUIRE(camera.world_from_camera.size() == content.takes.front().times.size());
            camera_nodes_.push_back(add_root({unique(camera.name),
                                              camera.world_from_camera.front(),
                                              {},
                                              -1,
                                              -1,
                                              static_cast<int>(i)}));
        }
        for (const Take& take : content.takes) {
            animate(take);
        }
    }

    std::string json(std::string_view buffer_uri) const;
    const std::string& binary() const { return buffer_.bytes(); }

 private:
    int add_node(Node node) {
        nodes_.push_back(std::move(node));
        return static_cast<int>(nodes_.size()) - 1;
    }
    int add_root(Node node) {
        roots_.push_back(add_node(std::move(node)));
        return roots_.back();
    }
    std::string unique(std::string_view wanted) {
        const std::string base = node_name(wanted);
        std::string name = base;
        const auto taken = [&](const std::string& n) {
            return std::any_of(nodes_.begin(), nodes_.end(),
                               [&](const Node& node) { return node.name == n; });
        };
        for (int i = 2; taken(name); ++i) {
            name = base + "_" + std::to_string(i);
        }
        return name;
    }
    static const Placed* find(const std::vector<Placed>& list, const std::string& name) {
        const auto found =
            std::find_if(list.begin(), list.end(), [&](const Placed& p) { return p.name == name; });
        return found == list.end() ? nullptr : &*found;
    }

    void place_actor(const TakeActor& actor);
    void place_prop(const TakeProp& prop);
    void animate(const Take& take);
    void write_nodes(JsonWriter& json) const;
    void write_skins(JsonWriter& json) const;
    void write_cameras(JsonWriter& json) const;

    const GltfContent& content_;
    const GltfOptions& options_;
    GltfBuffer buffer_;
    GltfMeshes meshes_;
    std::vector<Node> nodes_;
    std::vector<int> roots_;  // of the scene
    std::vector<Skin> skins_;
    std::vector<Placed> actors_, props_;
    std::vector<int> camera_nodes_;
    std::vector<GltfAnimation> animations_;  // those with channels
    std::vector<const Take*> animated_;      // theirs
};

void Assembly::place_actor(const TakeActor& actor) {
    if (find(actors_, actor.name) != nullptr) {
        return;
    }
    // A figure without a name is alone in its file: its joints keep theirs, at rest where the
    // skeleton says.
    const bool alone = actor.name.empty();
    const std::string prefix = alone ? "figure" : node_name(actor.name);
    const int group = add_root({unique(prefix), {}, {}, -1, -1, -1});
    Skin skin;
    skin.name = prefix;
    Placed placed{actor.name, static_cast<int>(nodes_.size())};
    for (std::size_t j = 0; j < actor.skeleton.joints.size(); ++j) {
        const figure::Joint& joint = actor.skeleton.joints[j];
        // The root stands where the take begins, so that figures are apart without an animation
        // too.
        const Transform& rest =
            j == 0 && !alone ? actor.parent_from_joint.front() : joint.parent_from_joint_rest;
        const int parent =
            joint.parent.valid() ? placed.first_node + static_cast<int>(joint.parent.value) : group;
        // Colons, blanks and brackets go, but Rigify's dots stay: Blender mirrors by them.
        std::string name = bone_name(options_.names, joint.name);
        if (options_.names != BoneNames::kRigify) {
            name = node_name(name);
        }
        const int node = add_node({alone ? name : prefix + "_" + name, rest, {}, -1, -1, -1});
        nodes_[static_cast<std::size_t>(parent)].children.push_back(node);
        skin.joints.push_back(node);
    }
    const int mesh = add_mesh(meshes_, buffer_, prefix + "_mesh", actor.mesh);
    if (mesh >= 0) {
        skin.inverse_bind_matrices = add_inverse_bind_matrices(buffer_, actor.skeleton);
        skins_.push_back(std::move(skin));
        add_root({unique(prefix + "_mesh"), {}, {}, mesh, static_cast<int>(skins_.size()) - 1, -1});
    }
    actors_.push_back(std::move(placed));
}

void Assembly::place_prop(const TakeProp& prop) {
    if (find(props_, prop.name) != nullptr) {
        return;
    }
    const int mesh = prop.mesh ? add_mesh(meshes_, buffer_, node_name(prop.name), *prop.mesh) : -1;
    props_.push_back(
        {prop.name, add_root({unique(prop.name), prop.world_from_prop.front(), {}, mesh, -1, -1})});
}

void Assembly::animate(const Take& take) {
    GltfAnimation animation(buffer_, take, options_.reduce_m);
    std::vector<Quat> rotations(take.times.size());
    std::vector<Vec3> translations(take.times.size());
    const auto add = [&](int node, double allowance_rad, double allowance_m) {
        const Transform& of_node = nodes_[static_cast<std::size_t>(node)].parent_from_node;
        animation.add_rotations(node, rotations, of_node.rotation, allowance_rad);
        animation.add_translations(node, translations, of_node.translation, allowance_m);
    };
    for (const TakeActor& actor : take.actors) {
        const int first = find(actors_, actor.name)->first_node;
        const std::size_t joints = actor.skeleton.joints.size();
        const Allowance allowance = allowance_for(actor.skeleton, options_.reduce_m);
        for (std::size_t j = 0; j < joints; ++j) {
            for (std::size_t key = 0; key < take.times.size(); ++key) {
                rotations[key] = actor.parent_from_joint[key * joints + j].rotation;
                translations[key] = actor.parent_from_joint[key * joints + j].translation;
            }
            add(first + static_cast<int>(j), allowance.rotation_rad[j], allowance.translation_m);
        }
    }
    for (const TakeProp& prop : take.props) {
        for (std::size_t key = 0; key < take.times.size(); ++key) {
            rotations[key] = prop.world_from_prop[key].rotation;
            translations[key] = prop.world_from_prop[key].translation;
        }
        add(find(props_, prop.name)->first_node, options_.reduce_m, options_.reduce_m);
    }
    if (&take == &content_.takes.front()) {
        for (std::size_t c = 0; c < content_.cameras.size(); ++c) {
            for (std::size_t key = 0; key < take.times.size(); ++key) {
                rotations[key] = content_.cameras[c].world_from_camera[key].rotation;
                translations[key] = content_.cameras[c].world_from_camera[key].translation;
            }
            add(camera_nodes_[c], options_.reduce_m / 10, options_.reduce_m);
        }
    }
    if (!animation.channels().empty()) {
        animations_.push_back(std::move(animation));
        animated_.push_back(&take);
    }
}

void write_vector(JsonWriter& json, const char* name, std::initializer_list<double> parts) {
    json.key(name).begin_array();
    for (const double part : parts) {
        json.number(static_cast<float>(part));
    }
    json.end_array();
}

void Assembly::write_nodes(JsonWriter& json) const {
    for (const Node& node : nodes_) {
        json.begin_object().member("name", node.name);
        const auto& [rotation, translation] = node.parent_from_node;
        if (translation != Vec3{}) {
            write_vector(json, "translation", {translation.x, translation.y, translation.z});
        }
        if (rotation != Quat{}) {
            write_vector(json, "rotation", {rotation.x, rotation.y, rotation.z, rotation.w});
        }
        for (const auto& [name, index] :
             {std::pair{"mesh", node.mesh}, std::pair{"skin", node.skin},
              std::pair{"camera", node.camera}}) {
            if (index >= 0) {
                json.member(name, index);
            }
        }
        if (!node.children.empty()) {
            json.key("children").begin_array();
            for (const int child : node.children) {
                json.integer(child);
            }
            json.end_array();
        }
        json.end_object();
    }
}

void Assembly::write_skins(JsonWriter& json) const {
    for (const Skin& skin : skins_) {
        json.begin_object().member("name", skin.name);
        json.member("inverseBindMatrices", skin.inverse_bind_matrices)
            .member("skeleton", skin.joints.front());
        json.key("joints").begin_array();
        for (const int joint : skin.joints) {
            json.integer(joint);
        }
        json.end_array().end_object();
    }
}

void Assembly::write_cameras(JsonWriter& json) const {
    for (const CameraTrack& camera : content_.cameras) {
        json.begin_object().member("name", node_name(camera.name)).member("type", "perspective");
        json.key("perspective").begin_object().member("yfov", camera.fov_y_rad);
        json.member("aspectRatio", camera.aspect).member("znear", 0.05).end_object().end_object();
    }
}

std::string Assembly::json(std::string_view buffer_uri) const {
    JsonWriter json;
    json.begin_object().key("asset").begin_object().member("version", "2.0");
    json.member("generator", "Puppetri").end_object();
    json.member("scene", 0).key("scenes").begin_array().begin_object();
    if (!options_.title.empty()) {
        json.member("name", options_.title);
    }
    json.key("nodes").begin_array();
    for (const int root : roots_) {
        json.integer(root);
    }
    json.end_array().end_object().end_array();
    // An empty array is an error in glTF: what there is none of is left out.
    const auto list = [&](const char* name, bool any, auto write) {
        if (any) {
            json.key(name).begin_array();
            write();
            json.end_array();
        }
    };
    list("nodes", !nodes_.empty(), [&] { write_nodes(json); });
    list("cameras", !content_.cameras.empty(), [&] { write_cameras(json); });
    list("meshes", !meshes_.meshes.empty(), [&] { write_meshes(json, meshes_); });
    list("materials", !meshes_.materials.empty(), [&] { write_materials(json, meshes_); });
    list("textures", !meshes_.textures.empty(), [&] { write_textures(json, meshes_); });
    list("samplers", !meshes_.samplers.empty(), [&] { write_samplers(json, meshes_); });
    list("images", !meshes_.images.empty(), [&] { write_images(json, meshes_); });
    list("skins", !skins_.empty(), [&] { write_skins(json); });
    list("animations", !animations_.empty(), [&] {
        for (std::size_t i = 0; i < animations_.size(); ++i) {
            const std::string& name = animated_[i]->name;
            animations_[i].write(json, name.empty() ? "performance" : name, options_.title);
        }
    });
    if (!binary().empty()) {
        json.key("accessors").begin_array();
        buffer_.write_accessors(json);
        json.end_array().key("bufferViews").begin_array();
        buffer_.write_views(json);
        json.end_array().key("buffers").begin_array().begin_object();
        json.member("byteLength", static_cast<std::int64_t>(binary().size()));
        if (!buffer_uri.empty()) {
            json.member("uri", buffer_uri);
        }
        json.end_object().end_array();
    }
    json.end_object();
    return json.take();
}

void append_u32(std::string& bytes, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    char raw[4];
    std::memcpy(raw, &word, 4);
    bytes.append(raw, 4);
}

// A file name as a URI reference (RFC 3986): everything but the unreserved characters becomes %XX.
std::string percent_encoded(std::string_view name) {
    constexpr char kHex[] = "0123456789ABCDEF";
    std::string uri;
    for (const char c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_' || c == '~';
        if (plain) {
            uri += c;
        } else {
            const auto byte = static_cast<unsigned char>(c);
            uri += {'%', kHex[byte >> 4], kHex[byte & 15]};
        }
    }
    return uri;
}

}  // namespace

GltfText make_gltf(const GltfContent& content, const GltfOptions& options,
                   std::string_view buffer_uri) {
    const Assembly assembly(content, options);
    return {assembly.json(buffer_uri), assembly.binary()};
}

std::string make_glb(const GltfContent& content, const GltfOptions& options) {
    auto [json, binary] = make_gltf(content, options, "");
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const std::size_t total = 12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size());
    std::string bytes;
    bytes.reserve(total);
    bytes += "glTF";
    append_u32(bytes, 2);
    append_u32(bytes, total);
    append_u32(bytes, json.size());
    bytes += "JSON";
    bytes += json;
    if (!binary.empty()) {
        append_u32(bytes, binary.size());
        bytes.append("BIN\0", 4);
        bytes += binary;
    }
    return bytes;
}

Status write_gltf(const std::string& path, const GltfContent& content, const GltfOptions& options) {
    if (!path.ends_with(".gltf")) {
        return write_file(path, make_glb(content, options));
    }
    const std::string binary_path = path.substr(0, path.size() - 4) + "bin";
    const GltfText text = make_gltf(
        content, options, percent_encoded(binary_path.substr(binary_path.rfind('/') + 1)));
    PUP_TRY(AtomicFile binary, AtomicFile::open(binary_path));
    PUP_TRY(AtomicFile json, AtomicFile::open(path));
    PUP_TRY(Ok binary_written, binary.write(text.binary));
    PUP_TRY(Ok json_written, json.write(text.json));
    PUP_TRY(Ok binary_done, binary.commit());
    static_cast<void>(binary_written), static_cast<void>(json_written),
        static_cast<void>(binary_done);
    return json.commit();
}

}  // namespace puppetri::io
