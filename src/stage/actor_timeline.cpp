// SPDX-License-Identifier: MIT
#include "actor_timeline.h"

#include <algorithm>

#include "puppetri/base/require.h"

namespace puppetri::stage {

using motion::Limb;
using motion::LimbSet;

void ActorTimeline::take(LimbSet limbs, const Charge& charge) {
    has_overlays_ = has_overlays_ || charge.movement->overlays.bits != 0;
    for (int i = 0; i < motion::kLimbCount; ++i) {
        if (!limbs.has(static_cast<Limb>(i))) {
            continue;
        }
        std::vector<Charge>& list = charges_[static_cast<std::size_t>(i)];
        PUP_REQUIRE(list.empty() || list.back().from <= charge.from);
        if (!list.empty() && list.back().from == charge.from) {
            list.back() = charge;
        } else {
            list.push_back(charge);
        }
    }
}

const Charge& ActorTimeline::in_charge(Limb limb, SimTime at, bool before) const {
    const std::vector<Charge>& list = charges(limb);
    const auto after =
        before ? std::lower_bound(list.begin(), list.end(), at,
                                  [](const Charge& c, SimTime t) { return c.from < t; })
               : std::upper_bound(list.begin(), list.end(), at,
                                  [](SimTime t, const Charge& c) { return t < c.from; });
    PUP_REQUIRE(after != list.begin());
    return *(after - 1);
}

void ActorTimeline::sample(SimTime at, motion::Controls& out, bool before) const {
    std::array<const Charge*, motion::kLimbCount> in_charge_of;
    for (int i = 0; i < motion::kLimbCount; ++i) {
        in_charge_of[static_cast<std::size_t>(i)] = &in_charge(static_cast<Limb>(i), at, before);
    }
    std::uint32_t done = 0;
    for (int i = 0; i < motion::kLimbCount; ++i) {
        if ((done >> i) & 1) {
            continue;
        }
        const Charge& charge = *in_charge_of[static_cast<std::size_t>(i)];
        LimbSet mine;
        for (int j = i; j < motion::kLimbCount; ++j) {
            const Charge& other = *in_charge_of[static_cast<std::size_t>(j)];
            if (other.movement == charge.movement && other.start == charge.start) {
                mine = mine.with(static_cast<Limb>(j));
            }
        }
        done |= mine.bits;
        motion::Controls own = out;
        charge.movement->sample((at - charge.start).seconds(), own);
        motion::copy_limbs(mine, own, out);
    }
}

void ActorTimeline::overlay(const figure::Figure& figure, SimTime at, figure::Pose& pose,
                            bool before) const {
    if (!has_overlays_) {
        return;
    }
    std::uint32_t done = 0;
    for (int i = 0; i < motion::kLimbCount; ++i) {
        const Limb limb = static_cast<Limb>(i);
        const Charge& charge = in_charge(limb, at, before);
        if (!charge.poses(limb) || ((done >> i) & 1)) {
            continue;
        }
        LimbSet mine = motion::limb_set(limb);
        for (int j = i + 1; j < motion::kLimbCount; ++j) {
            const Limb next = static_cast<Limb>(j);
            const Charge& other = in_charge(next, at, before);
            if (other.movement == charge.movement && other.start == charge.start &&
                other.poses(next)) {
                mine = mine.with(next);
            }
        }
        done |= mine.bits;
        charge.movement->overlay((at - charge.start).seconds(), mine, pose);
    }
    for (int i = 0; i < motion::kLimbCount; ++i) {
        const Charge& charge = in_charge(static_cast<Limb>(i), at, before);
        if (charge.join != nullptr) {
            const double since_s = (at - charge.from).seconds();
            for (const auto& [joint, offset] : charge.join->joints) {
                Transform& turned = pose.parent_from_joint[joint.value];
                offset.apply(since_s, turned);
                turned.rotation =
                    figure::clamp_to_limit(figure.limits[joint.value], turned.rotation);
            }
        }
    }
}

motion::Phase ActorTimeline::phase(Limb limb, SimTime at) const {
    const Charge& charge = in_charge(limb, at);
    const SimTime age = at - charge.start;
    for (const motion::PhaseSpan& span : charge.movement->phases) {
        if (span.limb == limb && span.begin <= age && age < span.end) {
            return span.phase;
        }
    }
    return motion::Phase::kFree;
}

}  // namespace puppetri::stage
