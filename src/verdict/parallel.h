// SPDX-License-Identifier: MIT
// The same work on several threads, where there are any.
#pragma once
#if !defined(__EMSCRIPTEN__) || defined(__EMSCRIPTEN_PTHREADS__)
#include <thread>
#include <vector>
#endif

namespace puppetri::verdict {

// Calls work(number) once on each of so many threads (0: this one), and waits for all. Each call
// has to find its share of the work by itself; one call must be able to do all of it.
template <class Work>
void in_parallel(unsigned threads, Work&& work) {
#if !defined(__EMSCRIPTEN__) || defined(__EMSCRIPTEN_PTHREADS__)
    std::vector<std::thread> others;
    for (unsigned i = 1; i < threads; ++i) {
        others.emplace_back([&work, i] { work(i); });
    }
    work(0u);
    for (std::thread& t : others) {
        t.join();
    }
#else
    static_cast<void>(threads);
    work(0u);
#endif
}

}  // namespace puppetri::verdict
