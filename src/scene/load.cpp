// SPDX-License-Identifier: MIT
// Loading: read and parse all files, elaborate, compile, and give either a whole scene or every
// reason why not.
#include <algorithm>

#include "elaboration.h"
#include "puppetri/net/queueing.h"
#include "puppetri/scene/scene.h"

namespace puppetri::scene {

void Elaboration::read_header() {
    const lang::Header& header = library_.files[0].header;
    About about(*this, "scene", header.scene_span);
    scene.title = header.title.text;
    scene.path = library_.files[0].filename;
    scene.frame_rate = frame_rate_of(0).value_or(FrameRate{});
    if (header.seed) {
        const auto seed = constant_integer(header.seed, {}, "the seed");
        if (seed && *seed < 0) {
            error("out-of-range", header.seed.span, "a seed is 0 or more", "write `seed 7`");
        }
        scene.seed = static_cast<std::uint64_t>(seed.value_or(1));
    }
    if (header.pace) {
        if (const auto beat = constant_time(header.pace, {}, "the pace")) {
            if (beat->ticks <= 0) {
                error("out-of-range", header.pace.span, "a beat takes some time",
                      "write `pace 1 s`");
            } else {
                scene.beat = *beat;
            }
        }
    }
    switch (header.horizon_kind) {
        case lang::HorizonKind::kNone:
            break;
        case lang::HorizonKind::kTime:
            scene.horizon.time = constant_time(header.horizon, {}, "the end of the run");
            break;
        case lang::HorizonKind::kFrame:
            if (const auto frame = constant_integer(header.horizon, {}, "the last frame")) {
                scene.horizon.time = scene.frame_rate.time_of_frame(*frame);
            }
            break;
        case lang::HorizonKind::kFirings:
            if (const auto firings =
                    constant_integer(header.horizon, {}, "the number of firings")) {
                scene.horizon.firings =
                    static_cast<std::uint64_t>(std::max<std::int64_t>(*firings, 0));
            }
            break;
    }
    if (scene.horizon.time && scene.horizon.time->ticks < 0) {
        error("negative-time", header.horizon.span, "time begins at 0", "write a later end");
    }
}

void Elaboration::complete() {
    instantiate();
    complete_cast();
    complete_data();
    complete_attributes();
    complete_places();
    declare_channels();
    complete_transitions();
    complete_channels();
    complete_refinements();
    complete_states();
    complete_rules();
    complete_ends();
    complete_events();
    complete_equations();
    complete_measures();
    complete_blocks();
    check_cast();
    // Every argument is looked at, also where nothing asked for it.
    for (std::uint32_t i = 0; i < instances_.size(); ++i) {
        for (std::size_t k = 0; k < instances_[i].values.size(); ++k) {
            parameter_value(i, k);
        }
    }
    // Which events of its movement a place tells is known when all have been named.
    for (const PlaceElement& place : places_) {
        if (place.action.valid()) {
            scene.play.actions[place.action.value].raises = place.raises;
        }
    }
    // Last, since the lists of the draft are parallel to those of the statements up to here.
    if (!has_errors(diagnostics)) {
        net::meet(draft(), diagnostics);
    }
}

void Elaboration::elaborate_scene() {
    Instance& root = instances_.emplace_back();
    root.body = &library_.files[0].body;
    read_header();
    draft().name = scene.title;
    to_expand_.push_back(0);
    complete();
}

void Elaboration::elaborate_alone(const Declaration& net) {
    Instance& root = instances_.emplace_back();
    root.net = net.net;
    root.body = &net.net->body;
    root.equations = library_.equations_of(net.net);
    root.file = net.file;
    root.stand_in = true;
    root.where = net.net->name.span;
    match_arguments(root, {});
    to_expand_.push_back(0);
    complete();
}

namespace {

// By file in the order of loading, then line, column.
void sort_by_position(Diagnostics& list, const Library& library) {
    std::map<std::string, std::size_t> order;
    for (std::size_t i = 0; i < library.files.size(); ++i) {
        order.emplace(library.files[i].filename, i);
    }
    const auto rank = [&](const Diagnostic& d) {
        const auto at = order.find(d.where.file);
        return at == order.end() ? library.files.size() : at->second;
    };
    std::stable_sort(list.begin(), list.end(), [&](const Diagnostic& a, const Diagnostic& b) {
        const std::size_t x = rank(a), y = rank(b);
        return x != y                         ? x < y
               : a.where.line != b.where.line ? a.where.line < b.where.line
                                              : a.where.column < b.where.column;
    });
}

struct Loaded {
    std::optional<Scene> scene;
    Diagnostics diagnostics;
};

void append(Diagnostics& to, Diagnostics from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

bool told_already(const Diagnostics& list, const Diagnostic& d) {
    return std::any_of(list.begin(), list.end(), [&](const Diagnostic& known) {
        return known.code == d.code && known.where == d.where;
    });
}

// `also_unused`: nets that nobody instantiates are tried alone.
Loaded load_all(FileSource& files, const std::string& path,
                std::span<const motion::OwnMovementPtr> movements, bool also_unused) {
    Loaded out;
    Library library = load_library(files, path);
    library.movements.assign(movements.begin(), movements.end());
    out.diagnostics = std::move(library.diagnostics);
    if (!library.readable) {
        sort_by_position(out.diagnostics, library);
        return out;
    }
    const lang::File& root = library.files[0];
    std::vector<const lang::Net*> nets;  // that the file declares
    for (const lang::Net& net : root.body.nets) {
        if (!net.is_machine) {  // lowered below
            nets.push_back(&net);
        }
    }
    for (const lang::Net& net : library.lowered) {
        if (net.span.file == 0) {
            nets.push_back(&net);
        }
    }
    const bool is_library = root.header.scene_span.begin == root.header.scene_span.end &&
                            root.body.places.empty() && root.body.uses.empty() && !nets.empty();
    Elaboration scene(library);
    if (is_library && !also_unused) {
        out.diagnostics.push_back({.code = "no-scene",
                                   .where = {.file = path},
                                   .element = "file " + path,
                                   .message = "this file is a library of nets and has no scene",
                                   .remedy = "import its nets into a scene: `import " +
                                             nets[0]->name.text + " from \"...\"`"});
        return out;
    }
    if (!is_library) {
        scene.elaborate_scene();
        append(out.diagnostics, std::move(scene.diagnostics));
        Checked<net::Net> net = net::compile(scene.scene.draft);
        if (!net) {
            for (Diagnostic& d : net.error()) {
                // On a statement that is broken anyway, what the kernel says is a consequence.
                if (scene.broken_lines.count({d.where.file, d.where.line}) == 0 &&
                    !told_already(out.diagnostics, d)) {
                    out.diagnostics.push_back(std::move(d));
                }
            }
        } else {
            append(out.diagnostics, net->notes());
            append(out.diagnostics, net::growing_queues(scene.scene.draft));
            scene.scene.net = std::move(*net);
        }
    }
    if (also_unused) {
        for (const lang::Net* net : nets) {
            if (scene.used(*net)) {
                continue;
            }
            Elaboration alone(library);
            alone.elaborate_alone({.file = 0, .net = net});
            for (Diagnostic& d : alone.diagnostics) {
                if (!told_already(out.diagnostics, d)) {
                    out.diagnostics.push_back(std::move(d));
                }
            }
        }
    }
    sort_by_position(out.diagnostics, library);
    if (!is_library && !has_errors(out.diagnostics)) {
        out.scene = std::move(scene.scene);
        out.scene->notes = out.diagnostics;
    }
    return out;
}

}  // namespace

Checked<Scene> load(FileSource& files, const std::string& path,
                    std::span<const motion::OwnMovementPtr> movements) {
    Loaded loaded = load_all(files, path, movements, false);
    if (!loaded.scene) {
        return Unexpected(std::move(loaded.diagnostics));
    }
    return std::move(*loaded.scene);
}

Diagnostics check(FileSource& files, const std::string& path,
                  std::span<const motion::OwnMovementPtr> movements) {
    return load_all(files, path, movements, true).diagnostics;
}

}  // namespace puppetri::scene
