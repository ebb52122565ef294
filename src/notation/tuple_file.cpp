// SPDX-License-Identifier: MIT
// A tuple file as a net: each object goes through its tuples in turn, and does the movement of an
// event in time for its keyframe to be reached when the tuple says. Objects and events are
// parameters, so that a file from elsewhere drives any figures with any technique:
//   import dinner from "dinner.tuples"
//   use dinner(man1: ana, man2: rui, RESTING: rest(), EATING1: lift(), EATING2: taste()) as d
// The tuple `24 man1 EATING1` becomes the place `man1_24`, which lasts from the object's tuple
// before until frame 24. Frame 0 is at the parameter `begin`, usually 0 s.
#include <algorithm>
#include <map>

#include "foreign_formats.h"
#include "make.h"
#include "puppetri/base/text.h"
#include "puppetri/notation/keyframe_tuples.h"

namespace puppetri::notation {
namespace {

class TupleNet {
 public:
    TupleNet(lang::Parsed& out, std::uint32_t file) : out_(out), file_(file) {}

    void read() {
        const std::string& path = out_.file.filename;
        Checked<std::vector<KeyframeTuple>> tuples = read_tuples(out_.file.text, path);
        if (!tuples) {
            out_.diagnostics = std::move(tuples.error());
            return;
        }
        lang::Net& net = out_.file.body.nets.emplace_back();
        net.span = {0, static_cast<std::uint32_t>(out_.file.text.size()), file_};
        net.name = make_name(std::string(stem_of(path)), {0, 0, file_});
        for (const KeyframeTuple& t : *tuples) {
            add_parameter(net, t.object, "actor", t.line);
            objects_[t.object].push_back(t);
        }
        for (const KeyframeTuple& t : *tuples) {
            add_parameter(net, t.event, "movement", t.line);
        }
        if (!tuples->empty()) {  // when frame 0 is
            add_parameter(net, "begin", "time", tuples->front().line);
            net.parameters.back().default_value =
                make_number(Rational{0}, net.parameters.back().span, "s");
        }
        lang::End end;
        end.span = net.span;
        lang::Expr all;
        for (auto& [object, list] : objects_) {
            std::stable_sort(list.begin(), list.end(),
                             [](const auto& a, const auto& b) { return a.frame < b.frame; });
            all = make_both(std::move(all), make_reference(go_through(list, net.body)));
        }
        if (all) {
            end.formulas.push_back(std::move(all));
            net.body.ends.push_back(std::move(end));
        }
    }

 private:
    lang::Span line(std::uint32_t number) const {
        const std::vector<std::uint32_t>& starts = out_.file.line_starts;
        const auto size = static_cast<std::uint32_t>(out_.file.text.size());
        std::uint32_t end = number < starts.size() ? starts[number] : size;
        const std::uint32_t begin = starts[number - 1];
        while (end > begin &&
               (out_.file.text[end - 1] == '\n' || out_.file.text[end - 1] == '\r')) {
            --end;
        }
        return {begin, end, file_};
    }

    void add_parameter(lang::Net& net, const std::string& name, const char* type,
                       std::uint32_t at) {
        const auto [known, added] = types_.emplace(name, type);
        if (!added) {
            if (known->second != type) {
                out_.diagnostics.push_back({.code = "name-twice",
                                            .where = out_.file.where(line(at)),
                                            .element = name,
                                            .message = name + " is an object and an event",
                                            .remedy = "give one of them another name"});
                known->second = type;
            }
            return;
        }
        lang::Parameter parameter;
        parameter.name = make_name(name, line(at));
        parameter.type = make_reference(type, line(at));
        parameter.span = line(at);
        net.parameters.push_back(std::move(parameter));
    }

    static lang::Path place_of(const KeyframeTuple& t, lang::Span span) {
        return make_path(t.object + "_" + std::to_string(t.frame), span);
    }

    // Gives the last place.
    lang::Path go_through(const std::vector<KeyframeTuple>& list, lang::Body& body) {
        // Nobody can have reached a pose when the play begins: half of the time to the next tuple
        // is left for it.
        std::int64_t before = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const KeyframeTuple& t = list[i];
            const lang::Span span = line(t.line);
            std::int64_t until = t.frame;
            if (until == 0) {
                until = list.size() > 1 ? std::max<std::int64_t>(1, list[1].frame / 2) : 24;
                out_.diagnostics.push_back(
                    {.severity = Severity::kNote,
                     .code = "late-keyframe",
                     .where = out_.file.where(span),
                     .element = "object " + t.object,
                     .message = "it cannot have reached " + t.event +
                                " when the play begins, and reaches it at frame " +
                                std::to_string(until),
                     .remedy = "let the first tuple be some frames later"});
            }
            lang::Place place = make_place(place_of(t, span).steps[0]);
            place.caption = {t.event, span};
            place.is_public = true;
            place.does = make_call(
                make_path({make_name(t.object, span), make_name(t.event, span)}, span), {}, span);
            place.takes = make_duration(make_number(Rational{until - before}, span, "frames"));
            lang::Path from;
            if (i == 0) {
                lang::Place waits = make_place(make_name(t.object + "_waits", span));
                waits.is_public = true;
                waits.takes = make_duration(make_reference("begin", span));
                give_token(waits);
                from = make_path(waits.name.text, span);
                body.places.push_back(std::move(waits));
            } else {
                from = place_of(list[i - 1], span);
            }
            lang::Transition next =
                make_transition(make_name(t.object + "_to_" + std::to_string(t.frame), span),
                                {std::move(from)}, {place_of(t, span)});
            next.is_public = true;
            body.transitions.push_back(std::move(next));
            body.places.push_back(std::move(place));
            before = until;
        }
        return place_of(list.back(), line(list.back().line));
    }

    lang::Parsed& out_;
    std::uint32_t file_;
    std::map<std::string, std::string> types_;  // of the parameters
    std::map<std::string, std::vector<KeyframeTuple>> objects_;
};

}  // namespace

void read_tuple_file(lang::Parsed& out, std::uint32_t file) { TupleNet(out, file).read(); }

}  // namespace puppetri::notation
