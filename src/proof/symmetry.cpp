// SPDX-License-Identifier: MIT
// Instances by their names, exchanges verified on the sorted rows of the net.
#include "puppetri/proof/symmetry.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

namespace puppetri::proof {

namespace {

// In a ring of n no two of n (n - 1) / 2 pairs can be exchanged; larger ones are not looked
// through.
constexpr std::uint32_t kMostExchanges = 100'000;
// Texts of predicates that are compared, in nodes.
constexpr std::uint64_t kMostComparisons = 10'000'000;

// All there is about a transition.
using Signature = std::tuple<std::vector<std::uint64_t>, std::uint32_t, std::uint8_t>;

Signature signature(const PlainNet& net, std::uint32_t t,
                    const std::vector<std::uint32_t>& place_to) {
    std::vector<std::uint64_t> arcs;
    std::uint64_t kind = 0;
    for (const auto* rows : {&net.takes, &net.gives, &net.reads, &net.unless}) {
        std::vector<std::uint64_t> row;
        for (const net::Weighted& w : rows->row(t)) {
            row.push_back((std::uint64_t{place_to[w.place]} << 32) | w.weight);
        }
        std::sort(row.begin(), row.end());
        arcs.push_back((kind++ << 32) | row.size());
        arcs.insert(arcs.end(), row.begin(), row.end());
    }
    return {std::move(arcs), net.level[t], net.optional[t]};
}

// Is exchanging the places an automorphism, for some permutation of transitions? It is iff the
// renamed transitions are the old ones, counted with multiplicity. Only those that touch a moved
// place can differ.
bool is_automorphism(const PlainNet& net, const std::vector<std::uint32_t>& same,
                     const std::vector<std::uint32_t>& place_to,
                     const std::vector<std::uint32_t>& touched) {
    std::vector<Signature> before, after;
    for (const std::uint32_t t : touched) {
        before.push_back(signature(net, t, same));
        after.push_back(signature(net, t, place_to));
    }
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    return before == after;
}

struct Instance {
    std::vector<std::pair<std::string, std::uint32_t>> places, transitions;  // inner name, index
};

bool same_inner_names(const Instance& a, const Instance& b) {
    const auto same = [](const auto& x, const auto& y) {
        return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                          [](const auto& i, const auto& k) { return i.first == k.first; });
    };
    return same(a.places, b.places) && same(a.transitions, b.transitions);
}

// prefix -> what lies below it, for each dot in the names.
using Instances = std::map<std::string, std::map<std::string, Instance>>;  // parent, child

const std::string kNumbered = "#";  // the parent of what has numbers instead of dots

void collect(std::span<const std::string_view> names, bool places, Instances& out) {
    for (std::uint32_t i = 0; i < names.size(); ++i) {
        const std::string_view name = names[i];
        std::size_t begin = 0;
        for (std::size_t dot = name.find('.'); dot != std::string_view::npos;
             dot = name.find('.', dot + 1)) {
            const std::string parent(name.substr(0, begin));
            const std::string child(name.substr(begin, dot - begin));
            Instance& instance = out[parent][child];
            (places ? instance.places : instance.transitions)
                .emplace_back(std::string(name.substr(dot + 1)), i);
            begin = dot + 1;
        }
        const std::size_t digits = name.find_last_not_of("0123456789") + 1;
        if (begin == 0 && digits > 0 && digits < name.size()) {
            Instance& instance = out[kNumbered][std::string(name.substr(digits))];
            (places ? instance.places : instance.transitions)
                .emplace_back(std::string(name.substr(0, digits)), i);
        }
    }
}

class Finder {
 public:
    explicit Finder(const PlainNet& net)
        : net_(net), used_(net.place_count(), 0), of_(net.place_count()) {
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            same_.push_back(p);
        }
        to_ = same_;
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            for (const auto* rows : {&net.takes, &net.gives, &net.reads, &net.unless}) {
                for (const net::Weighted& w : rows->row(t)) {
                    of_[w.place].push_back(t);
                }
            }
        }
    }

    void look(std::map<std::string, Instance>& children) {
        std::vector<Instance*> rest;
        for (auto& [name, instance] : children) {
            std::sort(instance.places.begin(), instance.places.end());
            std::sort(instance.transitions.begin(), instance.transitions.end());
            const bool is_free = std::all_of(instance.places.begin(), instance.places.end(),
                                             [&](const auto& p) { return used_[p.second] == 0; });
            if (!instance.places.empty() && is_free) {
                rest.push_back(&instance);
            }
        }
        // Each group: the first one left and all with which it can be exchanged.
        while (rest.size() > 1) {
            std::vector<Instance*> group = {rest.front()}, others;
            for (std::size_t i = 1; i < rest.size(); ++i) {
                const bool fits = same_inner_names(*group.front(), *rest[i]) &&
                                  exchanges(*group.front(), *rest[i]);
                (fits ? group : others).push_back(rest[i]);
            }
            if (group.size() > 1) {
                add(group);
            }
            rest = std::move(others);
        }
    }

    Symmetry result;

 private:
    bool exchanges(const Instance& a, const Instance& b) {
        if (exchanges_left_ == 0) {
            return false;
        }
        --exchanges_left_;
        std::vector<std::uint32_t> touched;
        for (std::size_t k = 0; k < a.places.size(); ++k) {
            const std::uint32_t p = a.places[k].second, q = b.places[k].second;
            to_[p] = q;
            to_[q] = p;
            touched.insert(touched.end(), of_[p].begin(), of_[p].end());
            touched.insert(touched.end(), of_[q].begin(), of_[q].end());
        }
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
        const bool is = is_automorphism(net_, same_, to_, touched);
        for (std::size_t k = 0; k < a.places.size(); ++k) {
            to_[a.places[k].second] = a.places[k].second;
            to_[b.places[k].second] = b.places[k].second;
        }
        return is;
    }

    void add(const std::vector<Instance*>& group) {
        Symmetry::Group out;
        out.count = static_cast<std::uint32_t>(group.size());
        out.width = static_cast<std::uint32_t>(group.front()->places.size());
        out.transitions_width = static_cast<std::uint32_t>(group.front()->transitions.size());
        for (const Instance* instance : group) {
            for (const auto& [name, p] : instance->places) {
                out.places.push_back(p);
                used_[p] = 1;
            }
            for (const auto& [name, t] : instance->transitions) {
                out.transitions.push_back(t);
            }
        }
        result.groups.push_back(std::move(out));
    }

    const PlainNet& net_;
    std::vector<std::uint8_t> used_;
    std::vector<std::uint32_t> same_, to_;  // the identity, and what is tried
    std::uint32_t exchanges_left_ = kMostExchanges;
    std::vector<std::vector<std::uint32_t>> of_;  // transitions per place
};

// A predicate's node as text in which places are renamed; children of and, or in order of text.
std::string canonical_text(const Predicate& predicate, std::uint32_t node,
                           const std::vector<std::uint32_t>& place_to) {
    const Predicate::Node& n = predicate.nodes[node];
    std::string out(1, static_cast<char>('a' + static_cast<int>(n.op)));
    switch (n.op) {
        case Predicate::Op::kFalse:
        case Predicate::Op::kTrue:
            break;
        case Predicate::Op::kAtMost:
        case Predicate::Op::kAtLeast: {
            std::vector<std::pair<std::uint32_t, std::int64_t>> terms;
            for (const LinearSum::Term& term : predicate.sums[n.index].terms) {
                terms.emplace_back(place_to[term.place], term.factor);
            }
            std::sort(terms.begin(), terms.end());
            for (const auto& [p, f] : terms) {
                out += ' ' + std::to_string(f) + '*' + std::to_string(p);
            }
            out += ' ' + std::to_string(n.limit);
            break;
        }
        case Predicate::Op::kEnabled:
        case Predicate::Op::kNoneEnabled:
            for (std::uint32_t k = 0; k < n.count; ++k) {
                out += ' ' + std::to_string(predicate.list[n.first + k]);
            }
            break;
        case Predicate::Op::kAnd:
        case Predicate::Op::kOr: {
            std::vector<std::string> parts;
            for (std::uint32_t k = 0; k < n.count; ++k) {
                parts.push_back(canonical_text(predicate, predicate.list[n.first + k], place_to));
            }
            std::sort(parts.begin(), parts.end());
            for (const std::string& part : parts) {
                out += '(' + part + ')';
            }
            break;
        }
    }
    return out;
}

}  // namespace

Symmetry interchangeable_instances(const PlainNet& net,
                                   std::span<const std::string_view> place_names,
                                   std::span<const std::string_view> transition_names) {
    Instances instances;
    collect(place_names, true, instances);
    collect(transition_names, false, instances);
    Finder finder(net);
    // Outer instances first ("pairs.7" before "pairs.7.ana"): the order of the parents' names does
    // it.
    for (auto& [parent, children] : instances) {
        finder.look(children);
    }
    return std::move(finder.result);
}

void make_canonical(const Symmetry& symmetry, std::span<std::uint32_t> marking) {
    std::vector<std::uint32_t> rows, order;
    for (const Symmetry::Group& g : symmetry.groups) {
        const auto place = [&](std::uint32_t i, std::uint32_t k) {
            return g.places[std::size_t{i} * g.width + k];
        };
        const auto less = [&](std::uint32_t a, std::uint32_t b) {
            for (std::uint32_t k = 0; k < g.width; ++k) {
                const std::uint32_t x = marking[place(a, k)], y = marking[place(b, k)];
                if (x != y) {
                    return x < y;
                }
            }
            return false;
        };
        // One firing moves few rows: most are in order.
        std::uint32_t i = 1;
        while (i < g.count && !less(i, i - 1)) {
            ++i;
        }
        if (i == g.count) {
            continue;
        }
        order.resize(g.count);
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), less);
        rows.clear();
        for (const std::uint32_t from : order) {
            for (std::uint32_t k = 0; k < g.width; ++k) {
                rows.push_back(marking[place(from, k)]);
            }
        }
        for (std::size_t n = 0; n < rows.size(); ++n) {
            marking[g.places[n]] = rows[n];
        }
    }
}

namespace {

// Of each group those that are the same as the first, and so on with the rest.
template <class Same>
Symmetry split(const Symmetry& symmetry, Same&& same) {
    Symmetry out;
    for (const Symmetry::Group& g : symmetry.groups) {
        std::vector<std::uint32_t> rest(g.count);
        std::iota(rest.begin(), rest.end(), 0u);
        while (rest.size() > 1) {
            std::vector<std::uint32_t> group = {rest.front()}, others;
            for (std::size_t i = 1; i < rest.size(); ++i) {
                (same(g, rest.front(), rest[i]) ? group : others).push_back(rest[i]);
            }
            if (group.size() > 1) {
                Symmetry::Group part;
                part.count = static_cast<std::uint32_t>(group.size());
                part.width = g.width;
                part.transitions_width = g.transitions_width;
                for (const std::uint32_t i : group) {
                    const auto add = [i](const std::vector<std::uint32_t>& from, std::size_t width,
                                         std::vector<std::uint32_t>& to) {
                        const auto at = from.begin() + static_cast<std::ptrdiff_t>(i * width);
                        to.insert(to.end(), at, at + static_cast<std::ptrdiff_t>(width));
                    };
                    add(g.places, g.width, part.places);
                    add(g.transitions, g.transitions_width, part.transitions);
                }
                out.groups.push_back(std::move(part));
            }
            rest = std::move(others);
        }
    }
    return out;
}

}  // namespace

Symmetry respecting(const Symmetry& symmetry, const Predicate& predicate) {
    std::uint32_t places = 0;
    std::uint64_t pairs = 0;
    const auto reach = [&](std::uint32_t p) { places = std::max(places, p + 1); };
    for (const Symmetry::Group& g : symmetry.groups) {
        std::for_each(g.places.begin(), g.places.end(), reach);
        pairs += std::uint64_t{g.count} * g.count;
    }
    for (const LinearSum& sum : predicate.sums) {
        for (const LinearSum::Term& term : sum.terms) {
            reach(term.place);
        }
    }
    std::vector<std::uint32_t> to(places);
    std::iota(to.begin(), to.end(), 0u);
    const bool asks =
        std::any_of(predicate.nodes.begin(), predicate.nodes.end(), [](const Predicate::Node& n) {
            return n.op == Predicate::Op::kEnabled || n.op == Predicate::Op::kNoneEnabled;
        });
    if (asks || pairs * predicate.nodes.size() > kMostComparisons) {
        return {};
    }
    const auto root = static_cast<std::uint32_t>(predicate.nodes.size() - 1);
    const std::string before = canonical_text(predicate, root, to);
    return split(symmetry, [&](const Symmetry::Group& g, std::uint32_t a, std::uint32_t b) {
        const auto swap = [&] {
            for (std::uint32_t k = 0; k < g.width; ++k) {
                std::swap(to[g.places[std::size_t{a} * g.width + k]],
                          to[g.places[std::size_t{b} * g.width + k]]);
            }
        };
        swap();
        const bool same = canonical_text(predicate, root, to) == before;
        swap();
        return same;
    });
}

Symmetry keeping(const Symmetry& symmetry, std::span<const std::uint32_t> marking) {
    return split(symmetry, [&](const Symmetry::Group& g, std::uint32_t a, std::uint32_t b) {
        for (std::uint32_t k = 0; k < g.width; ++k) {
            if (marking[g.places[std::size_t{a} * g.width + k]] !=
                marking[g.places[std::size_t{b} * g.width + k]]) {
                return false;
            }
        }
        return true;
    });
}

}  // namespace puppetri::proof
