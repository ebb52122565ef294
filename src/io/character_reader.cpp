// SPDX-License-Identifier: MIT
// How the skeleton comes about. A skin says for each joint j which matrix takes the mesh into the
// joint's space (its inverse bind matrix I(j)); with M from the mesh's space to the model's, joint
// j stands at M I(j)^-1 when the mesh is bound, and every vertex p at M p whatever its weights.
// That pose becomes the rest pose: with it, and with rotations and translations alone, the skin
// follows exactly as the file means it. Joints without a bind matrix hang from their parents as the
// nodes say. M is the same for all skins that share joints; it is what brings the first joint to
// its node.
#include "puppetri/io/character_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "affine.h"
#include "character_mesh.h"
#include "puppetri/figure/complete_humanoid.h"

namespace puppetri::io {
namespace {

using figure::Character;
using figure::JointIndex;

constexpr double kLeast_m = 0.01, kMost_m = 100, kNoVolume = 1e-30;
constexpr std::size_t kMostJoints = 4096;

class Reader {
 public:
    Reader(const GltfDocument& document, const scene::CharacterRequest& request, Diagnostics& notes)
        : doc_(document), request_(request), notes_(notes) {}

    Checked<Character> read() {
        world_of_nodes();
        choose_nodes();
        if (defects_.empty()) {
            bind_skins();
        }
        if (!defects_.empty()) {
            return fail();
        }
        gather_mesh();
        if (mesh_.positions.empty()) {
            error("no-figure", "file", "there is no mesh in it", "export the figure with its mesh");
            return fail();
        }
        make_joints();
        std::vector<figure::FoundBone> bones;
        if (request_.humanoid) {
            bones = bones_of();
            turn_upright(bones);
        } else {
            check_names();
        }
        if (!defects_.empty() || !scale_to_size()) {
            return fail();
        }
        finish_skeleton();
        c_.mesh = make_character_mesh(doc_, mesh_);
        if (request_.humanoid && !fit(completed(bones))) {
            return fail();
        }
        if (!request_.humanoid) {
            add_dofs();
        }
        c_.source = request_.path;
        notes_.insert(notes_.end(), doc_.notes.begin(), doc_.notes.end());
        return std::move(c_);
    }

 private:
    void error(const char* code, std::string element, std::string message, std::string remedy) {
        defects_.push_back({Severity::kError,
                            code,
                            {request_.path, 0, 0, 1},
                            std::move(element),
                            std::move(message),
                            std::move(remedy)});
    }
    Unexpected<Diagnostics> fail() {
        for (Diagnostic& d : defects_) {
            if (d.where.file.empty()) {
                d.where.file = request_.path;
            }
        }
        return Unexpected(std::move(defects_));
    }

    // ---- nodes ----

    // All in time linear in the nodes, however deep they hang.
    void world_of_nodes() {
        world_.resize(doc_.nodes.size());
        depth_.assign(doc_.nodes.size(), 0);
        shown_.assign(doc_.nodes.size(), false);
        std::vector<std::uint32_t> open;
        for (std::uint32_t i = 0; i < doc_.nodes.size(); ++i) {
            if (doc_.nodes[i].parent == kNoGltf) {
                open.push_back(i);
            }
        }
        std::reverse(open.begin(), open.end());
        while (!open.empty()) {
            const std::uint32_t node = open.back();
            open.pop_back();
            top_down_.push_back(node);
            const auto& children = doc_.nodes[node].children;
            open.insert(open.end(), children.rbegin(), children.rend());
        }
        for (const std::uint32_t root : doc_.roots) {
            shown_[root] = true;
        }
        for (const std::uint32_t node : top_down_) {
            const std::uint32_t parent = doc_.nodes[node].parent;
            world_[node] = local(node);
            if (parent != kNoGltf) {
                world_[node] = world_[parent] * world_[node];
                depth_[node] = depth_[parent] + 1;
                shown_[node] = shown_[node] || shown_[parent];
            }
        }
    }
    Affine local(std::uint32_t node) const {
        return to_affine(doc_.nodes[node].parent_from_node, doc_.nodes[node].scale);
    }

    // Joints of the skins that are used, bones of the humanoid, and what lies between them.
    void choose_nodes() {
        std::vector<bool> joint(doc_.nodes.size(), false);
        bool any_skin = false;
        for (const std::uint32_t node : top_down_) {
            const GltfNode& n = doc_.nodes[node];
            if (shown_[node] && n.mesh != kNoGltf && n.skin != kNoGltf) {
                any_skin = true;
                skins_.insert(n.skin);
                for (const std::uint32_t j : doc_.skins[n.skin].joints) {
                    joint[j] = true;
                }
            }
        }
        for (const GltfBone& bone : doc_.humanoid) {
            joint[bone.node] = true;
        }
        for (std::uint32_t node = 0; node < doc_.nodes.size(); ++node) {
            if (!any_skin && shown_[node]) {
                joint[node] = true;
            }
        }
        // A node is taken in when it is a joint, or lies below one and above another.
        std::vector<bool> leads(joint), below(doc_.nodes.size(), false);
        for (auto node = top_down_.rbegin(); node != top_down_.rend(); ++node) {
            const std::uint32_t parent = doc_.nodes[*node].parent;
            if (parent != kNoGltf && leads[*node]) {
                leads[parent] = true;
            }
        }
        taken_.assign(doc_.nodes.size(), false);
        above_.assign(doc_.nodes.size(), kNoGltf);
        for (const std::uint32_t node : top_down_) {
            const std::uint32_t parent = doc_.nodes[node].parent;
            if (parent != kNoGltf) {
                below[node] = below[parent];
                above_[node] = taken_[parent] ? parent : above_[parent];
            }
            taken_[node] = joint[node] || (below[node] && leads[node]);
            below[node] = below[node] || joint[node];
            if (taken_[node]) {
                nodes_.push_back(node);
            }
        }
        if (nodes_.size() > kMostJoints) {
            error("too-large", "file", "it has " + std::to_string(nodes_.size()) + " joints",
                  "export the figure alone: at most " + std::to_string(kMostJoints) + " are read");
        }
    }

    // ---- binding ----

    std::vector<Affine> inverse_binds(std::uint32_t skin) {
        const GltfSkin& s = doc_.skins[skin];
        const std::vector<float> m = doc_.floats(s.inverse_bind_matrices);
        std::vector<Affine> list;
        for (std::size_t i = 0; i < s.joints.size(); ++i) {
            const float* a = &m[i * 16];
            list.push_back({{a[0], a[1], a[2]},
                            {a[4], a[5], a[6]},
                            {a[8], a[9], a[10]},
                            {a[12], a[13], a[14]}});
            const double d = list.back().determinant();
            if (!(std::fabs(d) > kNoVolume && std::fabs(d) < 1 / kNoVolume)) {
                error(
                    "bad-skin", "skin " + std::to_string(skin),
                    "the inverse bind matrix of " + doc_.node_text(s.joints[i]) + " has no inverse",
                    "the file is damaged or its writer is at fault: export it again");
                break;
            }
        }
        return list;
    }

    void bind_skins() {
        bound_.assign(doc_.nodes.size(), false);
        bind_.resize(doc_.nodes.size());
        std::vector<std::uint32_t> skins(skins_.begin(), skins_.end());
        std::stable_sort(skins.begin(), skins.end(), [&](std::uint32_t a, std::uint32_t b) {
            return doc_.skins[a].joints.size() > doc_.skins[b].joints.size();
        });
        for (const std::uint32_t skin : skins) {
            const GltfSkin& s = doc_.skins[skin];
            if (s.inverse_bind_matrices == kNoGltf) {
                continue;  // its vertices stand where the nodes put them
            }
            const std::vector<Affine> inverses = inverse_binds(skin);
            if (inverses.size() < s.joints.size() || !defects_.empty()) {
                return;
            }
            // The mesh stands where a joint that is known already, or the topmost one, has it.
            std::size_t first = s.joints.size(), top = 0;
            for (std::size_t i = 0; i < s.joints.size(); ++i) {
                first = first == s.joints.size() && bound_[s.joints[i]] ? i : first;
                top = depth_[s.joints[i]] < depth_[s.joints[top]] ? i : top;
            }
            const bool shared = first < s.joints.size();
            const std::size_t by = shared ? first : top;
            Affine model_from_mesh =
                (shared ? bind_[s.joints[by]] : world_[s.joints[by]]) * inverses[by];
            if (!shared) {
                model_from_mesh = squared(model_from_mesh);
            }
            mesh_of_skin_[skin] = model_from_mesh;
            for (std::size_t i = 0; i < s.joints.size(); ++i) {
                if (!bound_[s.joints[i]]) {
                    bound_[s.joints[i]] = true;
                    bind_[s.joints[i]] = model_from_mesh * inverse(inverses[i]);
                }
            }
        }
        for (const std::uint32_t node : nodes_) {
            if (!bound_[node]) {
                const std::uint32_t above = above_[node];
                bind_[node] = above == kNoGltf
                                  ? world_[node]
                                  : bind_[above] * inverse_or_same(world_[above]) * world_[node];
                bound_[node] = true;
            }
        }
    }
    static Affine inverse_or_same(const Affine& a) {
        return std::fabs(a.determinant()) > kNoVolume ? inverse(a) : Affine{};
    }
    // Nodes often stand in a frame of their clip, the first joint leaning by a little: a mesh that
    // leans with it by less than 15 degrees is turned back to the axes.
    static Affine squared(const Affine& a) {
        const Quat q = rotation_of(a);
        const Quat snapped = conjugate(
            figure::upright({}, rotate(q, {0, 1, 0}), rotate(q, {1, 0, 0}), rotate(q, {-1, 0, 0})));
        if (a.determinant() <= 0 || angle_between(q, snapped) > radians(15)) {
            return a;
        }
        return to_affine({snapped * conjugate(q), {}}) * a;
    }

    // ---- mesh ----

    void gather_mesh() {
        for (const std::uint32_t node : top_down_) {
            const GltfNode& n = doc_.nodes[node];
            if (!shown_[node] || n.mesh == kNoGltf) {
                continue;
            }
            CharacterPart part;
            part.mesh = n.mesh;
            if (n.skin != kNoGltf && mesh_of_skin_.contains(n.skin)) {
                part.model_from_mesh = mesh_of_skin_[n.skin];
                part.skinned = true;
            } else if (n.skin != kNoGltf) {  // no bind matrices: skinned here, by the nodes
                part.skinned = true;
                for (const std::uint32_t joint : doc_.skins[n.skin].joints) {
                    part.model_from_joint_mesh.push_back(bind_[joint]);
                }
            } else {
                const std::uint32_t holder = taken_[node] ? node : above_[node];
                part.holder = holder;
                part.model_from_mesh =
                    holder == kNoGltf
                        ? world_[node]
                        : bind_[holder] * inverse_or_same(world_[holder]) * world_[node];
            }
            if (n.skin != kNoGltf) {
                part.joints = doc_.skins[n.skin].joints;
            }
            add_positions(doc_, part, mesh_);
            parts_.push_back(std::move(part));
        }
    }

    // ---- the skeleton ----

    void make_joints() {
        std::set<std::string> names{"root"};
        std::map<std::string, std::size_t> used;  // how often a name came
        c_.skeleton.joints.push_back({"root", {}, {}, {}});
        joint_of_node_.assign(doc_.nodes.size(), 0);
        for (const std::uint32_t node : nodes_) {
            std::string base = doc_.nodes[node].name;
            base = base.empty() ? "joint_" + std::to_string(node) : base;
            std::string name = base;
            for (std::size_t& i = used[base]; !names.insert(name).second;) {
                name = base + "_" + std::to_string(++i + 1);
            }
            const std::uint32_t above = above_[node];
            const std::uint32_t parent = above == kNoGltf ? 0 : joint_of_node_[above];
            joint_of_node_[node] = static_cast<std::uint32_t>(c_.skeleton.joints.size());
            c_.skeleton.joints.push_back({std::move(name), {parent}, {}, {}});
            model_.push_back({rotation_of(bind_[node]), bind_[node].translation});
        }
    }
    std::uint32_t joint_named(const std::string& name) const {
        for (const std::uint32_t node : nodes_) {
            if (doc_.nodes[node].name == name) {
                return joint_of_node_[node];
            }
        }
        return c_.skeleton.find(name).value;
    }
    Vec3 place(JointIndex joint) const { return model_[joint.value - 1].translation; }

    void unknown_joint(const scene::NamedBone& named) {
        std::string some;
        for (std::size_t i = 1; i < c_.skeleton.joints.size() && i <= 40; ++i) {
            some += (i > 1 ? ", " : "") + c_.skeleton.joints[i].name;
        }
        Diagnostic d{Severity::kError,
                     "unknown-joint",
                     named.where,
                     named.bone,
                     request_.path + " has no joint \"" + named.joint + "\"",
                     "its joints: " + some};
        defects_.push_back(std::move(d));
    }
    void check_names() {
        for (const scene::NamedBone& named : request_.bones) {
            if (joint_named(named.joint) == kNoGltf) {
                unknown_joint(named);
            }
        }
    }

    std::vector<figure::FoundBone> bones_of() {
        std::vector<figure::FoundBone> list;
        std::set<std::string> bones;
        std::set<std::uint32_t> joints{0};
        const auto add = [&](const std::string& bone, std::uint32_t joint) {
            if (!bones.contains(bone) && !joints.contains(joint)) {
                bones.insert(bone);
                joints.insert(joint);
                list.push_back({bone, {joint}});
            }
        };
        for (const scene::NamedBone& named : request_.bones) {
            const std::string_view known = figure::humanoid_joint(named.bone);
            const std::uint32_t joint = joint_named(named.joint);
            if (joint == kNoGltf || joint == 0) {
                unknown_joint(named);
            } else {
                add(known.empty() ? named.bone : std::string(known), joint);
            }
        }
        for (const GltfBone& bone : doc_.humanoid) {
            add(bone.bone, joint_of_node_[bone.node]);
        }
        if (doc_.humanoid.empty()) {
            for (const figure::FoundBone& found : find_bones(c_.skeleton)) {
                add(found.bone, found.joint.value);
            }
        }
        return list;
    }

    void turn_upright(const std::vector<figure::FoundBone>& bones) {
        const auto at = [&](const char* bone) -> const figure::FoundBone* {
            const auto found = std::find_if(bones.begin(), bones.end(),
                                            [&](const auto& b) { return b.bone == bone; });
            return found == bones.end() ? nullptr : &*found;
        };
        const auto *hips = at("hips"), *left = at("leftUpperLeg"), *right = at("rightUpperLeg");
        const auto* top = at("head") != nullptr ? at("head") : at("neck");
        if (hips != nullptr && top != nullptr && left != nullptr && right != nullptr) {
            const Vec3 middle = (place(left->joint) + place(right->joint)) * 0.5;
            turn_ =
                figure::upright(middle, place(top->joint), place(left->joint), place(right->joint));
            hips_ = hips->joint;
        }
    }

    // Metres, the origin on the floor: below the hips of a humanoid, where the file has it
    // otherwise.
    bool scale_to_size() {
        Vec3 low{1, 1, 1}, high{-1, -1, -1};
        for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
            const Vec3 p = rotate(turn_, mesh_.positions[i]);
            low = i == 0
                      ? p
                      : Vec3{std::fmin(low.x, p.x), std::fmin(low.y, p.y), std::fmin(low.z, p.z)};
            high = i == 0 ? p
                          : Vec3{std::fmax(high.x, p.x), std::fmax(high.y, p.y),
                                 std::fmax(high.z, p.z)};
        }
        const double height = high.y - low.y;
        const double wanted = request_.height_m.value_or(height);
        if (!(height > 0) || !std::isfinite(height)) {
            error("no-figure", "file", "the figure has no height",
                  "export it standing, +Y up, with its mesh");
            return false;
        }
        if (!(wanted >= kLeast_m && wanted <= kMost_m)) {
            error("height-out-of-range", "file",
                  "the figure would be " + std::to_string(wanted) + " m tall",
                  "give a height: `height 1.7 m`");
            return false;
        }
        if (!request_.height_m && wanted > 10) {
            notes_.push_back({Severity::kWarning,
                              "very-tall",
                              {request_.path, 0, 0, 1},
                              "file",
                              "the figure is " + std::to_string(static_cast<int>(wanted)) +
                                  " m tall: its file is not in metres",
                              "give a height: `height 1.7 m`"});
        }
        scale_ = wanted / height;
        Vec3 origin = hips_.valid() ? rotate(turn_, place(hips_)) : Vec3{};
        origin.y = low.y;
        place_ = {turn_, -origin * scale_};
        c_.metres_per_unit = scale_;
        c_.skeleton.height_m = wanted;
        return true;
    }

    void finish_skeleton() {
        for (Transform& t : model_) {
            t = {normalized(turn_ * t.rotation),
                 place_.translation + rotate(turn_, t.translation) * scale_};
        }
        for (std::size_t j = 1; j < c_.skeleton.joints.size(); ++j) {
            figure::Joint& joint = c_.skeleton.joints[j];
            const Transform parent =
                joint.parent.value == 0 ? Transform{} : model_[joint.parent.value - 1];
            joint.parent_from_joint_rest = inverse(parent) * model_[j - 1];
            joint.parent_from_joint_rest.rotation =
                normalized(joint.parent_from_joint_rest.rotation);
        }
        end_sites();
        c_.limits.assign(c_.skeleton.joints.size(), {});
        for (Vec3& p : mesh_.positions) {
            p = place_.translation + rotate(turn_, p) * scale_;
        }
        for (Vec3& n : mesh_.normals) {
            n = rotate(turn_, n);
        }
        for (CharacterVertex& v : mesh_.vertices) {
            for (std::uint32_t& node : v.joints) {
                node = node == kNoGltf ? 0 : joint_of_node_[node];
            }
        }
    }

    // A leaf ends as far beyond it as it is from its parent, in the same direction.
    void end_sites() {
        std::vector<bool> leaf(c_.skeleton.joints.size(), true);
        for (const figure::Joint& joint : c_.skeleton.joints) {
            if (joint.parent.valid()) {
                leaf[joint.parent.value] = false;
            }
        }
        for (std::size_t j = 1; j < c_.skeleton.joints.size(); ++j) {
            figure::Joint& joint = c_.skeleton.joints[j];
            if (leaf[j]) {
                joint.end_site_joint = rotate(conjugate(joint.parent_from_joint_rest.rotation),
                                              joint.parent_from_joint_rest.translation) *
                                       0.5;
            }
        }
    }

    // Limbs of rigs that leave feet and hands to controllers are put right.
    std::vector<figure::FoundBone> completed(const std::vector<figure::FoundBone>& bones) {
        figure::CompletedSkeleton done = figure::complete_humanoid(c_.skeleton, c_.mesh, bones);
        for (Diagnostic& note : done.notes) {
            note.where.file = request_.path;
            notes_.push_back(std::move(note));
        }
        done.rebind(c_.mesh);
        c_.skeleton = std::move(done.skeleton);
        c_.limits.assign(c_.skeleton.joints.size(), {});
        return std::move(done.bones);
    }

    // Knees that bend a little at rest are straight in the T-pose: the height is that of the
    // figure as it stands there.
    bool fit(const std::vector<figure::FoundBone>& bones) {
        auto fitted = figure::fit_humanoid(c_.skeleton, c_.mesh, bones);
        if (fitted && request_.height_m) {
            rescale(*request_.height_m / fitted->figure.height_m);
            fitted = figure::fit_humanoid(c_.skeleton, c_.mesh, bones);
        }
        if (!fitted) {
            defects_ = std::move(fitted.error());
            return false;
        }
        c_.humanoid = std::move(*fitted);
        c_.dofs = figure::humanoid_dofs(c_.humanoid->figure);
        c_.skeleton.height_m = c_.humanoid->figure.height_m;
        return true;
    }
    void rescale(double by) {
        for (figure::Joint& joint : c_.skeleton.joints) {
            joint.parent_from_joint_rest.translation =
                joint.parent_from_joint_rest.translation * by;
            joint.end_site_joint = joint.end_site_joint * by;
        }
        for (auto& p : c_.mesh.positions) {
            for (float& part : p) {
                part = static_cast<float>(part * by);
            }
        }
        c_.metres_per_unit *= by;
    }

    // Creatures turn about the three axes of each joint; what `bones` names has that name.
    void add_dofs() {
        for (std::uint32_t j = 1; j < c_.skeleton.joints.size(); ++j) {
            std::string name = c_.skeleton.joints[j].name;
            for (const scene::NamedBone& named : request_.bones) {
                name = joint_named(named.joint) == j ? named.bone : name;
            }
            const std::pair<const char*, Vec3> axes[] = {
                {".x", {1, 0, 0}}, {".y", {0, 1, 0}}, {".z", {0, 0, 1}}};
            for (const auto& [what, axis] : axes) {
                c_.dofs.dofs.push_back(
                    {.name = name + what, .joint = {j}, .axis_joint = axis, .lo = -kPi, .hi = kPi});
            }
        }
    }

    const GltfDocument& doc_;
    const scene::CharacterRequest& request_;
    Diagnostics& notes_;
    Diagnostics defects_;
    std::vector<Affine> world_, bind_;          // by node: where it is in the file; when bound
    std::vector<std::uint32_t> top_down_;       // all nodes, parents first
    std::vector<std::uint32_t> depth_, above_;  // how deep; the nearest taken one above
    std::vector<bool> shown_, taken_, bound_;
    std::set<std::uint32_t> skins_;
    std::map<std::uint32_t, Affine> mesh_of_skin_;
    std::vector<CharacterPart> parts_;
    CharacterMesh mesh_;
    std::vector<std::uint32_t> nodes_;  // of the joints but the root
    std::vector<std::uint32_t> joint_of_node_;
    std::vector<Transform> model_;  // model_from_joint of the joints but the root
    Quat turn_;
    JointIndex hips_;
    double scale_ = 1;
    Transform place_;
    Character c_;
};

}  // namespace

Checked<Character> read_character(const GltfDocument& document,
                                  const scene::CharacterRequest& request, Diagnostics& notes) {
    return Reader(document, request, notes).read();
}

}  // namespace puppetri::io
