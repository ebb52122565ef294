// SPDX-License-Identifier: MIT
#include "puppetri/proof/timed_exact.h"

#include "puppetri/net/tables.h"
#include "timed_builder.h"

namespace puppetri::proof {

using namespace net;

namespace {

class ExactBuilder final : public TimedBuilder {
 public:
    explicit ExactBuilder(const GraphRequest& request)
        : TimedBuilder(request, ClockForm::kExact, "timed exact") {
        const NetTables& n = request.net.tables();
        const World& world = graph_.states->world;
        for (std::uint32_t p = 0; p < n.places.size(); ++p) {
            if (n.place[p].duration != kNoIndex &&
                n.durations[n.place[p].duration].kind == DurationKind::kAuto &&
                movement_range(world, p).high > kWaiting) {
                graph_.why_not.push_back("place " + std::string(n.places.path(p)) +
                                         " lasts as long as its movement, and nobody says how long "
                                         "that may be");
            }
        }
    }

    TimedGraph make() {
        const World& world = graph_.states->world;
        const NetTables& n = request_.net.tables();
        for (const std::string& what : open_durations(request_.net, world)) {
            graph_.not_over.push_back(what + ": not all of it was tried");
        }
        bool others = !n.declarations.schedule.empty();
        for (const Special& s : n.specials) {
            others = others || !s.raises.empty();
        }
        for (const auto* events : {&world.outer_events, &world.movement_events}) {
            for (const std::uint32_t e : *events) {
                const std::string who = "event " + std::string(n.events.path(e));
                graph_.not_over.push_back(who +
                                          " was only tried at instants in which something "
                                          "happens by itself");
                if (events == &world.movement_events) {
                    graph_.not_exact.push_back(who +
                                               " is raised by a movement: it was tried at "
                                               "any instant");
                } else if (others) {
                    graph_.not_exact.push_back(who +
                                               " was tried after other events of its "
                                               "instant");
                }
            }
        }
        for (const std::uint32_t d : world.free_sensors) {
            const std::string who = "sensor " + std::string(n.data.path(d));
            graph_.not_over.push_back(who +
                                      " was only tried to change at instants in which "
                                      "something happens by itself");
        }
        graph_.assumptions = assumed(world);
        graph_.graph.over = graph_.not_over.empty();
        graph_.graph.exact = graph_.not_exact.empty();
        return build();
    }
};

}  // namespace

TimedGraph timed_exact_graph(const GraphRequest& request) {
    ExactBuilder builder(request);
    return builder.make();
}

}  // namespace puppetri::proof
