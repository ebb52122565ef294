// SPDX-License-Identifier: MIT
// Lists of indices that become one: fused places, transitions that meet.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace puppetri::net {

// The classes that lists of indices join: every element's representative is its least member.
template <class Lists>
std::vector<std::uint32_t> classes(const Lists& lists, std::size_t count) {
    std::vector<std::uint32_t> root(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        root[i] = i;
    }
    const auto find = [&](std::uint32_t i) {
        while (root[i] != i) {
            root[i] = root[root[i]];
            i = root[i];
        }
        return i;
    };
    for (const auto& list : lists) {
        for (const auto& other : list) {
            const std::uint32_t a = find(list.front().value);
            const std::uint32_t b = find(other.value);
            root[std::max(a, b)] = std::min(a, b);
        }
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        root[i] = find(i);
    }
    return root;
}

// Drops everything that is not its class's representative; gives old -> new.
template <class T>
std::vector<std::uint32_t> compact(std::vector<T>& items, const std::vector<std::uint32_t>& root) {
    std::vector<std::uint32_t> map(root.size());
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < root.size(); ++i) {
        if (root[i] == i) {
            map[i] = next;
            if (next != i) {
                items[next] = std::move(items[i]);
            }
            ++next;
        } else {
            map[i] = map[root[i]];
        }
    }
    items.resize(next);
    return map;
}

}  // namespace puppetri::net
