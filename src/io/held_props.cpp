// SPDX-License-Identifier: MIT
#include "held_props.h"

#include <algorithm>
#include <string_view>

#include "puppetri/math/rotation.h"

namespace puppetri::io {
namespace {

// From a hand up to the root, in this order.
using Chain = std::vector<std::uint32_t>;

Chain chain_of(const figure::Skeleton& skeleton, const char* hand) {
    Chain chain;
    for (figure::JointIndex joint = skeleton.find(hand); joint.valid();
         joint = skeleton.joints[joint.value].parent) {
        chain.push_back(joint.value);
    }
    return chain;
}

// "ana.hands", "ana.left_hand": whose, and which chains.
struct Holder {
    std::size_t actor = 0;
    std::vector<Chain> hands;
};

Holder holder_of(const Take& take, std::string_view holder) {
    Holder result;
    const std::size_t dot = holder.find('.');
    if (dot == std::string_view::npos) {
        return result;
    }
    const std::string_view part = holder.substr(dot + 1);
    for (result.actor = 0; result.actor < take.actors.size(); ++result.actor) {
        if (take.actors[result.actor].name != holder.substr(0, dot)) {
            continue;
        }
        for (const auto& [word, joint] :
             {std::pair{"left", "leftHand"}, std::pair{"right", "rightHand"}}) {
            if (part == "hands" || part.find(word) != std::string_view::npos) {
                Chain chain = chain_of(take.actors[result.actor].skeleton, joint);
                if (!chain.empty()) {
                    result.hands.push_back(std::move(chain));
                }
            }
        }
        return result;
    }
    return result;
}

Transform world_from_hand(const Take& take, const Holder& holder, const Chain& chain,
                          std::size_t key) {
    const auto pose = take.pose(holder.actor, key);
    Transform result;
    for (const std::uint32_t joint : chain) {
        result = pose[joint] * result;
    }
    return result;
}

Transform world_from_hand_between(const Take& take, const Holder& holder, const Chain& chain,
                                  std::size_t key) {
    const auto before = take.pose(holder.actor, key), after = take.pose(holder.actor, key + 1);
    Transform result;
    for (const std::uint32_t joint : chain) {
        const Transform middle{slerp(before[joint].rotation, after[joint].rotation, 0.5),
                               lerp(before[joint].translation, after[joint].translation, 0.5)};
        result = middle * result;
    }
    return result;
}

}  // namespace

std::vector<SimTime> loose_middles(const Take& take, double tolerance_m) {
    std::vector<SimTime> middles;
    for (const TakeProp& prop : take.props) {
        for (std::size_t change = 0; change < prop.holders.size(); ++change) {
            const Holder holder = holder_of(take, prop.holders[change].holder);
            const SimTime end =
                change + 1 < prop.holders.size() ? prop.holders[change + 1].at : take.times.back();
            auto key = static_cast<std::size_t>(
                std::lower_bound(take.times.begin(), take.times.end(), prop.holders[change].at) -
                take.times.begin());
            for (;
                 key + 1 < take.times.size() && take.times[key + 1] <= end && !holder.hands.empty();
                 ++key) {
                const Vec3 before = prop.world_from_prop[key].translation;
                const Vec3 after = prop.world_from_prop[key + 1].translation;
                for (const Chain& chain : holder.hands) {
                    const Vec3 grip =
                        lerp(inverse(world_from_hand(take, holder, chain, key)) * before,
                             inverse(world_from_hand(take, holder, chain, key + 1)) * after, 0.5);
                    const Vec3 carried = world_from_hand_between(take, holder, chain, key) * grip;
                    if (length(carried - lerp(before, after, 0.5)) > tolerance_m) {
                        middles.push_back(
                            {(take.times[key].ticks + take.times[key + 1].ticks) / 2});
                        break;
                    }
                }
            }
        }
    }
    std::sort(middles.begin(), middles.end());
    middles.erase(std::unique(middles.begin(), middles.end()), middles.end());
    return middles;
}

}  // namespace puppetri::io
