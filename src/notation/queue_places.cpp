// SPDX-License-Identifier: MIT
// Places, arcs and attributes of a queueing network's net.
#include "make.h"
#include "queue_builder.h"

namespace puppetri::notation {

using lang::Arc;
using lang::ArcKind;
using lang::Expr;
using lang::Span;

void QueueBuilder::declare_customers() {
    if (!typed() || model_.declared_elsewhere) {
        return;
    }
    lang::TokenType type;
    type.name = make_name(model_.customer, model_.customer_span);
    for (const CustomerAttribute& a : model_.attributes) {
        type.attributes.push_back({.name = a.name, .type = a.type, .span = a.name.span});
    }
    type.span = model_.customer_span;
    body_.token_types.push_back(std::move(type));
}

lang::Place& QueueBuilder::place(const std::string& name, Span span) {
    lang::Place made = make_place(make_name(name, span));
    made.span = span;
    made.is_public = true;
    body_.places.push_back(std::move(made));
    return body_.places.back();
}

lang::Place& QueueBuilder::customers_place(const std::string& name, Span span) {
    lang::Place& made = place(name, span);
    if (typed()) {
        made.of_type = make_path(model_.customer, span);
    }
    return made;
}

// Those who are there at the beginning.
void QueueBuilder::give_customers(lang::Place& place, const QueueNode& node,
                                  const std::vector<lang::Binding>& extra) {
    for (lang::InitialTokens group : node.customers) {
        for (const CustomerAttribute& a : model_.attributes) {
            bool given = false;
            for (const lang::Binding& b : group.attributes) {
                given = given || lang::to_text(b.name) == a.name.text;
            }
            if (!given && a.initial) {
                group.attributes.push_back(
                    make_assignment(make_path(a.name.text, group.span), a.initial));
            }
        }
        group.attributes.insert(group.attributes.end(), extra.begin(), extra.end());
        place.tokens.push_back(std::move(group));
    }
}

Arc QueueBuilder::take(ArcKind kind, const std::string& place, Span span, Expr count) const {
    Arc arc = make_arc(kind, make_path(place, span), std::move(count));
    arc.span = span;
    return arc;
}

// With the customer's attributes bound to their own names.
Arc QueueBuilder::customer(ArcKind kind, const std::string& place, Span span, Expr count) const {
    Arc arc = take(kind, place, span, std::move(count));
    arc.pattern = same(span);
    return arc;
}

Arc QueueBuilder::give_customer(const std::string& place, const Values& values, Span span,
                                Expr count) const {
    Arc arc = take(ArcKind::kGive, place, span, std::move(count));
    arc.pattern = values;
    return arc;
}

Values QueueBuilder::same(Span span) const {
    Values out;
    for (const CustomerAttribute& a : model_.attributes) {
        out.push_back(
            make_assignment(make_path(a.name.text, span), make_reference(a.name.text, span)));
    }
    return out;
}

// Of a new customer: what the routes do not say is what the type says.
Values QueueBuilder::initial(const QueueNode& source, const std::vector<const Route*>& routes) {
    Values out;
    for (const CustomerAttribute& a : model_.attributes) {
        bool always = true;
        for (const Route* r : routes) {
            bool said = false;
            for (const lang::Binding& b : r->sets) {
                said = said || lang::to_text(b.name) == a.name.text;
            }
            always = always && said;
        }
        if (!a.initial && !always) {
            teller_.error("no-value", source.span,
                          "customers of " + source.text() + " have no " + a.name.text,
                          "give it a value: " + source.text() + " -> ... { " + a.name.text +
                              " := ... }, or one for all: customer " + model_.customer + "(" +
                              a.name.text + ": ... = ...)");
        }
        if (a.initial) {
            out.push_back(make_assignment(make_path(a.name.text, source.span), a.initial));
        }
    }
    return out;
}

Values QueueBuilder::changed(const Values& values, const std::vector<lang::Binding>& sets) const {
    Values out = values;
    for (const lang::Binding& set : sets) {
        const std::string name = lang::to_text(set.name);
        if (model_.attribute(name) == nullptr) {
            continue;  // a datum
        }
        bool found = false;
        for (lang::Binding& b : out) {
            if (lang::to_text(b.name) == name) {
                b = set;
                found = true;
            }
        }
        if (!found) {
            out.push_back(set);
        }
    }
    return out;
}

lang::Transition& QueueBuilder::transition(std::string name, Span span, int priority) {
    const int same = ++names_[name];
    if (same > 1) {
        name += "_" + std::to_string(same);
    }
    lang::Transition made = make_transition(make_name(std::move(name), span), {}, {});
    made.is_public = true;
    made.span = span;
    made.priority = make_number(Rational{priority}, span);
    body_.transitions.push_back(std::move(made));
    return body_.transitions.back();
}

Expr renamed(Expr e, const std::vector<CustomerAttribute>& names, const std::string& suffix) {
    if (e.kind == lang::ExprKind::kPath && e.path.steps.size() == 1) {
        for (const CustomerAttribute& a : names) {
            if (e.path.steps[0].text == a.name.text) {
                e.path.steps[0].text += suffix;
                return e;
            }
        }
    }
    for (lang::Argument& a : e.args) {
        a.value = renamed(std::move(a.value), names, suffix);
    }
    return e;
}

}  // namespace puppetri::notation
