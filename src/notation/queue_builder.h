// SPDX-License-Identifier: MIT
// The net of a queueing network, node by node. A customer is a token that goes from place to place;
// whoever sends customers on does it by an *exit*, and a node takes them by its *ways in*.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "queue_model.h"

namespace puppetri::notation {

// At one instant: what is begun goes on, services begin, customers decide, services end, those come
// who were on their way, and only then somebody gives up.
enum QueuePriority : int {
    kDraws = 9,
    kStarts = 8,
    kDecides = 7,
    kJockeys = 6,
    kEnds = 5,
    kArrives = 4,
    kGivesUp = 3
};

// Attributes and what they become.
using Values = std::vector<lang::Binding>;

// What takes customers out of where they are.
struct Exit {
    std::string name;
    lang::Span span;
    std::vector<lang::Arc> takes, gives;
    Values values;         // of the customer's attributes, in words of the arcs that take
    bool outside = false;  // the customer was not in the network before
    int priority = kEnds;
    lang::Expr count;  // kNone: one customer
};

// One way into a node. Of several just one is open, or they are drawn by their odds, which sum to
// 1.
struct Way {
    std::string suffix;
    std::vector<lang::Arc> takes, tests, gives;
    lang::Expr guard, odds;
    bool leaves = false;  // the customer is outside of the network afterwards
};

class QueueBuilder {
 public:
    QueueBuilder(const QueueModel& model, Teller& teller, lang::Body& body)
        : model_(model), teller_(teller), body_(body) {}

    void build();

 private:
    // queue_places.cpp: places, arcs and the attributes on them
    void declare_customers();
    bool typed() const { return !model_.customer.empty(); }
    std::string type_of_resumed(const QueueNode& station) const;
    lang::Place& place(const std::string& name, lang::Span span);
    lang::Place& customers_place(const std::string& name, lang::Span span);
    void give_customers(lang::Place& place, const QueueNode& node,
                        const std::vector<lang::Binding>& extra = {});
    lang::Arc take(lang::ArcKind kind, const std::string& place, lang::Span span,
                   lang::Expr count = {}) const;
    lang::Arc customer(lang::ArcKind kind, const std::string& place, lang::Span span,
                       lang::Expr count = {}) const;
    lang::Arc give_customer(const std::string& place, const Values& values, lang::Span span,
                            lang::Expr count = {}) const;
    Values same(lang::Span span) const;
    Values initial(const QueueNode& source, const std::vector<const Route*>& routes);
    Values changed(const Values& values, const std::vector<lang::Binding>& sets) const;
    lang::Transition& transition(std::string name, lang::Span span, int priority);

    // queue_routes.cpp: from exits through ways in
    bool blocks(const QueueNode& node) const { return node.room && node.full == WhenFull::kBlocks; }
    std::string way_in(const QueueNode& station) const;
    lang::Expr number_at(const QueueNode& node, lang::Span span) const;
    std::vector<Way> ways_into(std::size_t node, const Values& values, const lang::Expr& count,
                               lang::Span span, bool reserved);
    void turned_away(std::size_t node, RouteOn on, const Values& values, const lang::Expr& count,
                     lang::Span span, Way& way);
    void emit(const Exit& exit, const std::vector<const Route*>& routes);
    void send(const Exit& exit, const Route& route, std::size_t to, const lang::Expr& guard,
              const lang::Expr& odds);
    void fire(const Exit& exit, const std::string& name, const Way& way, const lang::Expr& guard,
              const lang::Expr& odds, const std::vector<lang::Binding>& data);
    void build_gates();

    // queue_source.cpp
    void build_source(std::size_t node);
    void build_periods(const QueueNode& source);
    void arrivals(std::size_t node, const std::string& clock);
    // queue_station.cpp
    void build_station(std::size_t node);
    void build_plain(std::size_t node);
    void build_line(const QueueNode& station, lang::Place& queue);
    bool one_way(const std::vector<const Route*>& routes) const;
    void build_jockeys(std::size_t node);
    void build_breaks(const QueueNode& station);
    Exit service_end(const QueueNode& station) const;
    // queue_resumed.cpp: services that go on where they were
    void build_resumed(std::size_t node);
    void build_preemption(const QueueNode& station);
    void build_failures(const QueueNode& station);
    bool numbered(const QueueNode& station) const;
    void give_servers(lang::Place& place, const QueueNode& station);
    lang::Arc server(lang::ArcKind kind, const std::string& place, const QueueNode& station) const;

    struct Gate {
        std::size_t node;
        RouteOn on;
        bool operator<(const Gate& g) const { return node != g.node ? node < g.node : on < g.on; }
    };

    const QueueModel& model_;
    Teller& teller_;
    lang::Body& body_;
    std::map<std::string, int> names_;  // of transitions
    std::set<Gate> gates_, built_gates_;
};

// `a` with every name of `names` replaced by `name + suffix`.
lang::Expr renamed(lang::Expr a, const std::vector<CustomerAttribute>& names,
                   const std::string& suffix);

}  // namespace puppetri::notation
