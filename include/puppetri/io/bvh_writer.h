// SPDX-License-Identifier: MIT
// Writes one actor of a take as BVH, the motion-capture format that every animation tool reads
// (docs/formats/bvh.md). +Y up, rotations in degrees in the order Z X Y, unwrapped so that no curve
// jumps by a turn; all channels zero is the rest pose; only frames are written, no keys between
// them.
#pragma once
#include <cstdint>
#include <string>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/bone_names.h"
#include "puppetri/io/take.h"

namespace puppetri::io {

enum class LengthUnit : std::uint8_t { kCentimetre, kMetre };

struct BvhOptions {
    BoneNames names = BoneNames::kVrm;
    LengthUnit unit = LengthUnit::kCentimetre;
};

// The text of the file. The root joint has six channels. With RootMode::kHips that is `hips`, and
// the joint `root` is left out; otherwise it is `root`, and `hips` has six channels as well. The
// offset of a joint with position channels is zero, so that readers agree which add the offset to
// the channel and which replace it. Needs   actor is an index of take.actors.
std::string make_bvh(const Take& take, std::size_t actor, const BvhOptions& options);

// "NAME_ana.bvh" for NAME.bvh.
std::string bvh_path(const std::string& path, const std::string& actor);

// Writes one file per actor, all whole or all absent. Gives their paths. Fails "cannot-write",
// "disk-full".
Checked<std::vector<std::string>> write_bvh(const std::string& path, const Take& take,
                                            const BvhOptions& options);

// The rotation as turns about Z, then the new X, then the new Y: q = Rz * Rx * Ry, radians in x, y,
// z of the result. Among the equal triples (whole turns; (z + pi, pi - x, y + pi)) the one nearest
// to `before`. Looking straight along the axis (x a quarter turn) leaves one angle free: y stays
// that of before.
Vec3 euler_zxy_rad(Quat q, Vec3 before);

}  // namespace puppetri::io
