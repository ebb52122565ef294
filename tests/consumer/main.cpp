// SPDX-License-Identifier: MIT
// A traffic light in somebody else's program: draft, compile, play. Prints what fires when.
#include <cstdio>

#include "puppetri/net/net.h"
#include "puppetri/run/player.h"

using namespace puppetri;

namespace {

class Printer final : public run::LogSink {
 public:
    explicit Printer(const net::Net& net) : net_(net) {}
    void fired(SimTime at, net::TransitionIndex transition) override {
        const std::string path(net_.transition(transition).path);
        std::printf("%.1f s %s\n", at.seconds(), path.c_str());
    }

 private:
    const net::Net& net_;
};

}  // namespace

int main() {
    net::NetDraft draft;
    for (const char* colour : {"red", "green"}) {
        net::PlaceDraft place;
        place.path = colour;
        place.duration = net::DurationDraft::constant({30 * kTicksPerSecond});
        draft.places.push_back(place);
    }
    draft.places[0].tokens = {{}};
    for (std::uint32_t from = 0; from < 2; ++from) {
        net::TransitionDraft transition;
        transition.path = from == 0 ? "go" : "stop";
        net::ArcDraft take;
        take.place = {from};
        net::OutputDraft put;
        put.place = {1 - from};
        transition.inputs = {take};
        transition.outputs = {put};
        draft.transitions.push_back(transition);
    }
    const auto net = net::compile(draft);
    if (!net) {
        for (const Diagnostic& d : net.error()) {
            std::fputs(format_diagnostic(d, "", false).c_str(), stderr);
        }
        return 1;
    }
    Printer printer(*net);
    run::Player player(*net, {.sink = &printer});
    player.run({.until = {100 * kTicksPerSecond}});
    std::printf("%llu firings\n", static_cast<unsigned long long>(player.firings()));
    return player.firings() == 3 ? 0 : 1;
}
