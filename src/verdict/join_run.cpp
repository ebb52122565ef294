// SPDX-License-Identifier: MIT
#include "join_run.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "puppetri/net/tables.h"
#include "puppetri/verdict/figure_lowering.h"

namespace puppetri::verdict {
namespace {

using motion::Limb;
using motion::LimbSet;

constexpr SimTime kPatience{600 * kTicksPerSecond};
constexpr SimTime kBeyond{kTicksPerSecond / 10};

const motion::BoundCall* call_of(const net::Net& net, const stage::Play& play, std::uint32_t p) {
    const net::ActionIndex action = net.action(net::PlaceIndex{p});
    if (!action.valid() || action.value >= play.actions.size()) {
        return nullptr;
    }
    const motion::BoundCall& call = play.actions[action.value].call;
    return call.subject.kind == motion::SubjectKind::kProp ? nullptr : &call;
}

// The places that a firing gives tokens to, and those whose movements it may cut.
void touched(const net::NetTables& tables, std::uint32_t t, std::vector<std::uint32_t>& given,
             std::vector<std::uint32_t>& cut) {
    given.clear();
    cut.clear();
    for (const net::Weighted& w : tables.gives(t)) {
        given.push_back(w.place);
    }
    const std::uint32_t special = tables.transition[t].special;
    if (special == net::kNoIndex) {
        return;
    }
    for (const net::OutputTable& out : tables.specials[special].outputs) {
        given.push_back(out.place);
    }
    for (const net::ArcTable& arc : tables.specials[special].arcs) {
        if (arc.kind == net::ArcKind::kTakeNow || arc.kind == net::ArcKind::kTakeAllNow) {
            cut.push_back(arc.place);
            // With the shadow of a module all that goes on in it is cut.
            for (const net::RefinementDraft& r : tables.refinements) {
                if (r.place.value == arc.place) {
                    for (const net::PlaceIndex inside : r.inside) {
                        cut.push_back(inside.value);
                    }
                }
            }
        }
    }
    std::sort(given.begin(), given.end());
    given.erase(std::unique(given.begin(), given.end()), given.end());
}

}  // namespace

MovementLanes movement_lanes(const net::Net& net, const stage::Play& play) {
    MovementLanes out;
    std::vector<std::vector<LimbSet>> of_actor(play.cast.actors.size());
    for (std::uint32_t a = 0; a < play.cast.actors.size(); ++a) {
        std::map<std::vector<std::uint32_t>, LimbSet> lanes;
        std::vector<std::uint32_t> own;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            const motion::BoundCall* call = call_of(net, play, p);
            if (call != nullptr && call->subject.actor.value == a) {
                own.push_back(p);
            }
        }
        for (int l = 0; l < motion::kMaxLimbs && !own.empty(); ++l) {
            const Limb limb = static_cast<Limb>(l);
            std::vector<std::uint32_t> places;
            for (const std::uint32_t p : own) {
                if (driven_limbs(*call_of(net, play, p)).has(limb)) {
                    places.push_back(p);
                }
            }
            if (!places.empty()) {
                LimbSet& limbs = lanes[places];
                limbs = limbs.with(limb);
            }
        }
        for (const auto& [places, limbs] : lanes) {
            out.lanes.push_back({a, limbs, places});
            out.items.push_back(static_cast<std::uint32_t>(places.size()) + 1);
        }
    }
    // Per place where it stands on which lanes.
    std::vector<std::vector<proof::Begin>> of_place(net.place_count());
    for (std::uint32_t l = 0; l < out.lanes.size(); ++l) {
        for (std::uint32_t i = 0; i < out.lanes[l].places.size(); ++i) {
            of_place[out.lanes[l].places[i]].push_back({l, i});
        }
    }
    const net::NetTables& tables = net.tables();
    std::vector<std::uint32_t> given, cut;
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        touched(tables, t, given, cut);
        std::vector<proof::Begin> row;
        for (const std::uint32_t p : given) {
            row.insert(row.end(), of_place[p].begin(), of_place[p].end());
        }
        const std::size_t moves = row.size();
        for (const std::uint32_t p : cut) {
            for (const proof::Begin& b : of_place[p]) {
                const std::uint32_t rest = out.items[b.lane] - 1;
                const bool known =
                    std::any_of(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(moves),
                                [&](const proof::Begin& r) { return r.lane == b.lane; }) ||
                    std::any_of(row.begin(), row.end(), [&](const proof::Begin& r) {
                        return r.lane == b.lane && r.item == rest;
                    });
                if (!known) {
                    row.push_back({b.lane, rest});
                }
            }
        }
        out.begins.items.insert(out.begins.items.end(), row.begin(), row.end());
        out.begins.starts.push_back(static_cast<std::uint32_t>(out.begins.items.size()));
    }
    for (const net::NetTables::Initial& i : tables.initial) {
        if (i.count > 0) {
            out.initially.insert(out.initially.end(), of_place[i.place].begin(),
                                 of_place[i.place].end());
        }
    }
    return out;
}

JoinRun::JoinRun(const net::Net& net, const Theatre& theatre, const MovementLanes& lanes,
                 net::Chooser& chooser, std::uint64_t seed,
                 const std::vector<Witness::Event>& events)
    : net_(net),
      lanes_(lanes),
      beside_(*theatre.scene),
      stage_(theatre.scene->play, beside_.quantities()),
      // What is coupled speaks of the elements of the whole net.
      player_(net, {.seed = seed,
                    .host = &stage_,
                    .chooser = &chooser,
                    .beat = theatre.beat,
                    .coupled = &net == &theatre.scene->net ? beside_.coupled(stage_)
                                                           : std::vector<run::Coupled*>{}}) {
    for (const std::uint32_t items : lanes_.items) {
        last_.push_back({items});
    }
    for (const proof::Begin& b : lanes_.initially) {
        std::erase(last_[b.lane], lanes_.items[b.lane]);
        last_[b.lane].push_back(b.item);
    }
    std::vector<run::OutsideEvent> outside;
    for (const Witness::Event& e : events) {
        outside.push_back({e.at, net.find_event(e.path)});
    }
    player_.schedule(outside);
}

bool JoinRun::step() { return step(player_.now() + kPatience); }

bool JoinRun::step(SimTime until) {
    if (over_) {
        return false;
    }
    const run::Stop stop = player_.step({.until = until});
    if (stop != run::Stop::kNone) {
        at_rest_ = stop == run::Stop::kDead || stop == run::Stop::kFinal;
        over_ = stop != run::Stop::kLimit;
        return false;
    }
    const std::uint32_t t = player_.last().value;
    fired_.push_back({player_.now(), player_.last()});
    const std::span<const proof::Begin> begins = lanes_.begins.row(t);
    for (const proof::Begin& b : begins) {
        for (const std::uint32_t before : last_[b.lane]) {
            seen_.push_back({{b.lane, before, t, b.item}, player_.now(), player_.firings()});
        }
        for (const proof::Begin& other : begins) {
            if (other.lane == b.lane && other.item != b.item) {
                seen_.push_back(
                    {{b.lane, other.item, t, b.item}, player_.now(), player_.firings()});
            }
        }
    }
    for (const proof::Begin& b : begins) {
        last_[b.lane].clear();
    }
    for (const proof::Begin& b : begins) {
        last_[b.lane].push_back(b.item);
    }
    return true;
}

void JoinRun::look_beyond(SimTime at) {
    const SimTime until = at + kBeyond;
    while (player_.now() < until && step(until)) {
    }
    stage_.pass_to(std::max(until, player_.now()));
}

motion::JoinMeasures JoinRun::measure(const Seen& seen, const motion::JoinLimits& limits) {
    struct Asked {
        const stage::Stage& stage;
        motion::ActorIndex actor;
        const figure::Figure& figure;
        figure::Pose pose;
        static void sample(void* context, double t_s, std::span<Transform> world) {
            Asked& a = *static_cast<Asked*>(context);
            a.stage.pose(a.actor,
                         SimTime{static_cast<std::int64_t>(std::nearbyint(t_s * kTicksPerSecond))},
                         a.pose);
            figure::to_model_space(a.figure.skeleton, a.pose, world);
        }
    };
    const motion::ActorIndex actor{lanes_.lanes[seen.succession.lane].actor};
    Asked asked{stage_, actor, stage_.figure(actor), {}};
    return motion::measure_join({.figure = asked.figure,
                                 .sample = Asked::sample,
                                 .context = &asked,
                                 .at_s = seen.at.seconds(),
                                 .begin_s = 0,
                                 .end_s = (seen.at + kBeyond).seconds()},
                                &limits);
}

std::string JoinRun::joint_of(const proof::Succession& succession,
                              const motion::JoinFault& fault) const {
    const motion::ActorIndex actor{lanes_.lanes[succession.lane].actor};
    return fault.quantity == nullptr ? std::string()
                                     : stage_.figure(actor).skeleton.joints[fault.joint.value].name;
}

std::vector<Witness::Step> JoinRun::steps() const {
    std::vector<Witness::Step> out;
    for (const Fired& f : fired_) {
        out.push_back({f.at, std::string(net_.transition(f.transition).path)});
    }
    return out;
}

}  // namespace puppetri::verdict
