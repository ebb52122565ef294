// SPDX-License-Identifier: MIT
// A small BVH reader for tests, written from the format's description and without a line of
// Puppetri: positions of all joints in every frame, by matrices.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace puppetri::test {

struct BvhJoint {
    std::string name;
    int parent = -1;
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    std::vector<std::string> channels;  // "Xposition", "Zrotation", ...
    int first_channel = 0;
    bool end_site = false;  // has an offset only
};

struct Bvh {
    std::vector<BvhJoint> joints;  // parents before children
    double frame_time_s = 0;
    std::vector<std::vector<double>> frames;  // channels of each

    int find(const std::string& name) const;  // -1: there is none
    // World placement of every joint; position channels are added to the offset where they exist.
    std::vector<Eigen::Isometry3d> pose(const std::vector<double>& channels) const;
    std::vector<Eigen::Isometry3d> pose(std::size_t frame) const { return pose(frames.at(frame)); }
};

// Throws std::runtime_error on anything that the format does not allow.
Bvh read_bvh(const std::string& text);

}  // namespace puppetri::test
