// SPDX-License-Identifier: MIT
#include "test_arcs.h"

#include <algorithm>
#include <utility>

namespace puppetri::io {
namespace {

bool is_test(net::ArcKind kind) {
    return kind == net::ArcKind::kRead || kind == net::ArcKind::kUnless;
}

// The arcs of a transition that go into an earlier one, in ascending order.
std::vector<std::uint32_t> join(net::TransitionDraft& t) {
    std::vector<std::uint32_t> tests, gone;
    for (std::uint32_t i = 0; i < t.inputs.size(); ++i) {
        if (is_test(t.inputs[i].kind)) {
            tests.push_back(i);
        }
    }
    if (tests.size() < 2) {
        return gone;
    }
    const auto key = [&](std::uint32_t i) {
        return std::pair(t.inputs[i].kind, t.inputs[i].place.value);
    };
    std::sort(tests.begin(), tests.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(key(a), a) < std::pair(key(b), b);
    });
    std::uint32_t first = 0;
    for (std::uint32_t i = 1; i < tests.size(); ++i) {
        if (key(tests[i]) != key(tests[first])) {
            first = i;
            continue;
        }
        net::ArcDraft& kept = t.inputs[tests[first]];
        const std::int64_t other = t.inputs[tests[i]].weight;
        kept.weight = kept.kind == net::ArcKind::kRead ? std::max(kept.weight, other)
                                                       : std::min(kept.weight, other);
        gone.push_back(tests[i]);
    }
    std::sort(gone.begin(), gone.end());
    return gone;
}

}  // namespace

void join_parallel_tests(NetFile& file, Defects& defects) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> removed;  // transition, arc
    for (std::uint32_t i = 0; i < file.draft.transitions.size(); ++i) {
        net::TransitionDraft& t = file.draft.transitions[i];
        const std::vector<std::uint32_t> gone = join(t);
        if (gone.empty()) {
            continue;
        }
        defects.note(Severity::kNote, "parallel-tests", t.where, "transition " + t.path,
                     "parallel read or inhibitor arcs: the strictest counts", "keep one of them");
        std::size_t kept = 0;
        for (std::uint32_t a = 0, next = 0; a < t.inputs.size(); ++a) {
            if (next < gone.size() && gone[next] == a) {
                removed.emplace_back(i, a);
                ++next;
            } else {
                if (kept != a) {
                    t.inputs[kept] = std::move(t.inputs[a]);
                }
                ++kept;
            }
        }
        t.inputs.resize(kept);
    }
    if (removed.empty()) {
        return;
    }
    std::vector<ArcLook> looks;
    for (ArcLook& look : file.look.arcs) {
        if (!look.is_output) {
            const std::pair key(look.transition.value, look.number);
            const auto at = std::lower_bound(removed.begin(), removed.end(), key);
            if (at != removed.end() && *at == key) {
                continue;
            }
            const auto begin = std::lower_bound(removed.begin(), removed.end(),
                                                std::pair(look.transition.value, std::uint32_t{0}));
            look.number -= static_cast<std::uint32_t>(at - begin);
        }
        looks.push_back(std::move(look));
    }
    file.look.arcs = std::move(looks);
}

}  // namespace puppetri::io
