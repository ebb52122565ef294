// SPDX-License-Identifier: MIT
#include "support/bvh_reader.h"

#include <sstream>
#include <stdexcept>

namespace puppetri::test {
namespace {

std::string word(std::istream& in) {
    std::string text;
    if (!(in >> text)) {
        throw std::runtime_error("BVH: unexpected end");
    }
    return text;
}

void expect(std::istream& in, const std::string& wanted) {
    const std::string found = word(in);
    if (found != wanted) {
        throw std::runtime_error("BVH: expected " + wanted + ", found " + found);
    }
}

double number(std::istream& in) {
    double value = 0;
    if (!(in >> value)) {
        throw std::runtime_error("BVH: expected a number");
    }
    return value;
}

void read_joint(std::istream& in, Bvh& bvh, int parent, int& channels, bool end_site) {
    BvhJoint joint;
    joint.parent = parent;
    joint.end_site = end_site;
    joint.name = word(in);  // "Site" of an end site
    expect(in, "{");
    expect(in, "OFFSET");
    for (int i = 0; i < 3; ++i) {
        joint.offset[i] = number(in);
    }
    const int index = static_cast<int>(bvh.joints.size());
    joint.first_channel = channels;
    if (!end_site) {
        expect(in, "CHANNELS");
        const int count = static_cast<int>(number(in));
        for (int i = 0; i < count; ++i) {
            joint.channels.push_back(word(in));
        }
        channels += count;
    }
    bvh.joints.push_back(joint);
    for (std::string next = word(in); next != "}"; next = word(in)) {
        if (end_site || (next != "JOINT" && next != "End")) {
            throw std::runtime_error("BVH: unexpected " + next);
        }
        read_joint(in, bvh, index, channels, next == "End");
    }
}

}  // namespace

int Bvh::find(const std::string& name) const {
    for (std::size_t i = 0; i < joints.size(); ++i) {
        if (joints[i].name == name && !joints[i].end_site) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

std::vector<Eigen::Isometry3d> Bvh::pose(const std::vector<double>& values) const {
    constexpr double kRadians = 3.14159265358979323846 / 180;
    std::vector<Eigen::Isometry3d> world(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const BvhJoint& joint = joints[j];
        Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
        Eigen::Vector3d position = joint.offset;
        for (std::size_t c = 0; c < joint.channels.size(); ++c) {
            const std::string& channel = joint.channels[c];
            const double value = values.at(static_cast<std::size_t>(joint.first_channel) + c);
            const int axis = channel.at(0) - 'X';
            if (channel.substr(1) == "position") {
                position[axis] += value;
            } else {
                local.rotate(Eigen::AngleAxisd(value * kRadians, Eigen::Vector3d::Unit(axis)));
            }
        }
        local.pretranslate(position);
        world[j] = joint.parent < 0 ? local : world[static_cast<std::size_t>(joint.parent)] * local;
    }
    return world;
}

Bvh read_bvh(const std::string& text) {
    std::istringstream in(text);
    Bvh bvh;
    int channels = 0;
    expect(in, "HIERARCHY");
    expect(in, "ROOT");
    read_joint(in, bvh, -1, channels, false);
    expect(in, "MOTION");
    expect(in, "Frames:");
    const auto frames = static_cast<std::size_t>(number(in));
    expect(in, "Frame");
    expect(in, "Time:");
    bvh.frame_time_s = number(in);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::istringstream numbers(line);
        std::vector<double> frame;
        for (double value = 0; numbers >> value;) {
            frame.push_back(value);
        }
        if (static_cast<int>(frame.size()) != channels) {
            throw std::runtime_error("BVH: a frame with " + std::to_string(frame.size()) +
                                     " channels");
        }
        bvh.frames.push_back(std::move(frame));
    }
    if (bvh.frames.size() != frames) {
        throw std::runtime_error("BVH: not the promised number of frames");
    }
    return bvh;
}

}  // namespace puppetri::test
