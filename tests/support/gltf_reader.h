// SPDX-License-Identifier: MIT
// A glTF reader for tests: tinygltf reads the file, Eigen poses it. No line of Puppetri takes part.
#pragma once
#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

namespace puppetri::test {

struct GltfEvent {
    double t = 0;
    int frame = 0;
    std::string name, actor, limb, prop;
};

struct GltfCurve {
    std::vector<double> times;
    std::vector<Eigen::Vector4d> values;  // quaternions x y z w; translations x y z 0
};

struct GltfClip {
    std::string name;
    std::map<std::pair<int, std::string>, GltfCurve> curves;  // by node and path
    std::vector<GltfEvent> events;
    std::string extras;  // as JSON
    double end_s() const;
};

struct GltfNode {
    std::string name;
    int parent = -1;
    std::vector<int> children;
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Eigen::Vector3d scale = Eigen::Vector3d::Ones();
    int mesh = -1, skin = -1, camera = -1;
};

struct GltfSkin {
    std::vector<int> joints;
    std::vector<Eigen::Matrix4d> inverse_bind;
};

struct GltfPrimitiveData {
    std::vector<Eigen::Vector3d> positions;
    std::vector<std::array<int, 4>> joints;
    std::vector<std::array<double, 4>> weights;
    std::size_t index_count = 0;
};

struct GltfFile {
    std::vector<GltfNode> nodes;
    std::vector<int> order;  // of nodes, parents first
    std::vector<GltfSkin> skins;
    std::vector<GltfClip> clips;
    std::vector<std::vector<GltfPrimitiveData>> meshes;
    std::vector<std::string> materials;
    std::size_t cameras = 0;

    int find(const std::string& name) const;  // -1: there is none
    // World placement of every node at t: linear, spherical for rotations; the node's own placement
    // without a curve.
    std::vector<Eigen::Isometry3d> pose(std::size_t clip, double t) const;
};

// The bytes of a .glb; or the JSON of a .gltf whose buffer lies in `folder`. Throws
// std::runtime_error with what tinygltf says; its warnings count as errors, and, unless `scales` is
// set, scales and matrices of nodes: our files have none.
GltfFile read_gltf(const std::string& bytes, const std::string& folder = "", bool scales = false);

}  // namespace puppetri::test
