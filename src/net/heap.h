// SPDX-License-Identifier: MIT
// Heaps in vectors with D children per node: flatter than binary ones, so that a pop touches fewer
// cache lines.
#pragma once
#include <cstddef>
#include <vector>

namespace puppetri::net {

// `before` is a strict order; equal items come out in an order that depends only on the pushes and
// pops.
template <std::size_t D, class T, class Before>
void heap_push(std::vector<T>& heap, const T& item, Before before) {
    std::size_t i = heap.size();
    heap.push_back(item);
    while (i > 0) {
        const std::size_t parent = (i - 1) / D;
        if (!before(item, heap[parent])) {
            break;
        }
        heap[i] = heap[parent];
        i = parent;
    }
    heap[i] = item;
}

// Needs a heap that is not empty.
template <std::size_t D, class T, class Before>
void heap_pop(std::vector<T>& heap, Before before) {
    const T item = heap.back();
    heap.pop_back();
    const std::size_t size = heap.size();
    if (size == 0) {
        return;
    }
    std::size_t i = 0;
    for (;;) {
        const std::size_t first = i * D + 1;
        if (first >= size) {
            break;
        }
        const std::size_t last = first + D < size ? first + D : size;
        std::size_t best = first;
        for (std::size_t c = first + 1; c < last; ++c) {
            if (before(heap[c], heap[best])) {
                best = c;
            }
        }
        if (!before(heap[best], item)) {
            break;
        }
        heap[i] = heap[best];
        i = best;
    }
    heap[i] = item;
}

}  // namespace puppetri::net
