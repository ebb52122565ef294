// SPDX-License-Identifier: MIT
// A queueing network as its block says it: nodes, routes, customers. Expressions are not looked at
// yet: they may speak of parameters.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ending.h"
#include "line.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::notation {

// `customer Client(kind: Kind = normal)`
struct CustomerAttribute {
    lang::Name name;
    lang::Expr type;
    lang::Expr initial;  // kNone: said where customers come from
};

// `breaks every 2 h first 1 h for 15 min`
struct Break {
    lang::Expr every, first, lasting;
    lang::Span span;
};

// `at 9 h every exponential(3 min)`, `at 18 h closed`
struct Period {
    lang::Expr from;
    lang::Expr every;  // kNone: closed
    lang::Span span;
};

enum class NodeKind : std::uint8_t { kSource, kStation, kDelay, kPool, kSink };
enum class Order : std::uint8_t { kFifo, kLifo, kRandom, kLeast, kMost };
enum class WhenFull : std::uint8_t { kBlocks, kLost };

struct QueueNode {
    NodeKind kind = NodeKind::kStation;
    lang::Name name;
    lang::Caption caption;
    lang::Span span;
    std::vector<lang::InitialTokens> customers;  // there at the beginning
    lang::Expr does;                             // while in service, or on the way

    // Sources
    lang::Expr every, first, closes, batch, repeats;
    lang::Path from;  // a pool
    std::vector<Period> periods;

    // Stations and, of `takes`, delays
    lang::Expr serves;
    lang::Expr servers;  // kNone: 1
    Order order = Order::kFifo;
    lang::Expr key;  // of kLeast, kMost
    bool preempts = false;
    lang::Expr room;
    WhenFull full = WhenFull::kBlocks;
    lang::Expr patience;
    lang::Expr balks;       // a probability
    lang::Expr balks_when;  // a condition
    lang::Expr gathers;
    std::vector<Break> breaks;
    lang::Expr fails, repairs;

    bool resumes() const { return preempts || fails; }  // services that go on where they were
    const std::string& text() const { return name.text; }
};

// Why a customer goes this way.
enum class RouteOn : std::uint8_t { kLeaving, kFull, kBalking, kImpatient, kJockeying };

struct Route {
    std::size_t from = 0;
    std::vector<std::size_t> to;  // several: the shortest of them
    RouteOn on = RouteOn::kLeaving;
    lang::Expr when, probability;
    lang::Expr takes, does;  // on the way
    std::vector<lang::Binding> sets;
    lang::Caption caption;
    lang::Span span;
};

struct QueueModel {
    std::string customer;  // the type's name; empty: customers that nothing tells apart
    lang::Span customer_span;
    bool declared_elsewhere = false;  // the file declares tokens of this type
    std::vector<CustomerAttribute> attributes;
    std::vector<lang::Data> data;
    std::optional<lang::Name> inside;  // the place that counts customers in the network
    std::vector<QueueNode> nodes;
    std::vector<Route> routes;
    Ending ending;  // counts those who leave by sinks

    std::vector<const Route*> routes_of(std::size_t node, RouteOn on) const {
        std::vector<const Route*> out;
        for (const Route& r : routes) {
            if (r.from == node && r.on == on) {
                out.push_back(&r);
            }
        }
        return out;
    }
    const CustomerAttribute* attribute(const std::string& name) const {
        for (const CustomerAttribute& a : attributes) {
            if (a.name.text == name) {
                return &a;
            }
        }
        return nullptr;
    }
};

// Reads the block; tells every line that cannot be read.
QueueModel read_queue(const lang::Block& block, const lang::File& file, Teller& teller);

// Probabilities that do not sum to one, nodes that nobody comes to or leaves, clauses that do not
// go together.
void check_queue(const QueueModel& model, const lang::Block& block, const lang::File& file,
                 Teller& teller);

}  // namespace puppetri::notation
