// SPDX-License-Identifier: MIT
// `clip stroll { from "take.bvh" ... }`: a stretch of recorded motion as a movement that `does` may
// call.
#include <algorithm>

#include "elaboration.h"
#include "puppetri/lang/units.h"
#include "puppetri/motion/clip_edit.h"
#include "puppetri/motion/clip_movement.h"
#include "puppetri/scene/assets.h"

namespace puppetri::scene {

class ClipBlock {
 public:
    ClipBlock(Elaboration& elaboration, const lang::Block& block)
        : e_(elaboration), block_(block) {}

    OwnDefinition define() {
        OwnDefinition out{.block = &block_};
        const std::size_t before = e_.diagnostics.size();
        for (const lang::Property& p : block_.properties) {
            read(p);
        }
        if (path_.empty() && !failed(before)) {
            e_.error("no-file", block_.name.span, "it does not say where it comes from",
                     "write `from \"take.bvh\"`");
        }
        if (failed(before)) {
            return out;
        }
        std::optional<LoadedClips> loaded = load();
        if (!loaded) {
            return out;
        }
        motion::Clip clip = chosen(*loaded);
        if (failed(before)) {
            return out;
        }
        edit(clip);
        if (failed(before)) {
            return out;
        }
        play_.hips_height_m = loaded->hips_height_m;
        for (const motion::ClipMark& mark : clip.marks) {
            out.events.push_back(mark.name);
        }
        auto maker = std::make_shared<const motion::ClipMaker>(
            block_.name.text, std::make_shared<const motion::Clip>(std::move(clip)), play_);
        static const figure::Figure figure = figure::make_mannequin(1.75);
        motion::OwnSignature signature{.name = block_.name.text, .doc = "a clip"};
        signature.limbs = motion::limbs_of(figure, maker->spec());
        if (signature.limbs.bits == 0) {
            e_.error("nothing-moves", where_, "this clip moves nothing that a humanoid has",
                     "its joints need names of humanoids; look at them with `puppetri clip`");
            return out;
        }
        signature.as_argument = motion::without(signature.limbs, motion::kBothArms).bits == 0;
        out.movement = std::make_shared<const motion::OwnMovement>(std::move(signature), maker);
        return out;
    }

 private:
    bool failed(std::size_t before) const {
        return std::any_of(e_.diagnostics.begin() + static_cast<std::ptrdiff_t>(before),
                           e_.diagnostics.end(),
                           [](const Diagnostic& d) { return d.severity == Severity::kError; });
    }

    void read(const lang::Property& p) {
        const std::string name = lang::to_text(p.name);
        const Scope scope{};
        const auto text = [&](const char* form) -> std::optional<std::string> {
            if (p.values.size() != 1 || p.values[0].kind != lang::ExprKind::kString) {
                e_.has_values(p, ~std::size_t{0}, form);
                return std::nullopt;
            }
            return p.values[0].text;
        };
        const auto factor = [&](const char* form) -> std::optional<double> {
            const auto x = e_.quantity_of(p, scope, lang::dimension::kNone, form);
            if (x && !(*x > 0 && *x < 1e6)) {
                e_.error("out-of-range", p.span, name + " is a number above 0",
                         std::string("write `") + form + "`");
                return std::nullopt;
            }
            return x;
        };
        if (name == "from") {
            if (const auto file = text("from \"take.bvh\"")) {
                path_ = *file;
                where_ = p.span;
            }
        } else if (name == "take") {
            take_ = text("take \"walk\"").value_or("");
            take_where_ = p.span;
        } else if (name == "cut") {
            if (e_.has_values(p, 1, "cut 1 s .. 2.5 s") &&
                p.values[0].kind == lang::ExprKind::kRange) {
                const auto begin = e_.constant_number(p.values[0].args[0].value, scope,
                                                      lang::dimension::kTime, "the beginning");
                const auto end = e_.constant_number(p.values[0].args[1].value, scope,
                                                    lang::dimension::kTime, "the end");
                if (begin && end) {
                    cut_ = {begin->value, end->value};
                    cut_where_ = p.span;
                }
            } else if (p.values.size() == 1) {
                e_.has_values(p, ~std::size_t{0}, "cut 1 s .. 2.5 s");
            }
        } else if (name == "speed") {
            play_.speed = factor("speed 1.2").value_or(1);
        } else if (name == "scale") {
            scale_ = factor("scale 0.0564").value_or(0);
        } else if (name == "mirror" && p.values.empty()) {
            mirror_ = true;
        } else if (name == "reverse" && p.values.empty()) {
            reverse_ = true;
        } else if (name == "loop" && p.values.empty()) {
            loop_ = true;
        } else if (name == "only") {
            only(p);
        } else {
            e_.unknown_property(
                p, {"from", "take", "cut", "speed", "scale", "mirror", "reverse", "loop", "only"});
        }
    }

    // only left_arm and right_arm
    void only(const lang::Property& p) {
        if (!e_.has_values(p, 1, "only left_arm and right_arm")) {
            return;
        }
        play_.only = {};
        const auto add = [&](const lang::Expr& e) {
            const std::string limb = lang::to_text(e);
            if (limb == "arms") {
                play_.only = motion::both(play_.only, motion::kBothArms);
            } else if (limb == "legs") {
                play_.only = motion::both(play_.only, motion::kLowerBody);
            } else if (const auto found = motion::limb_named(limb)) {
                play_.only = play_.only.with(*found);
            } else {
                std::vector<std::string> known{"arms", "legs"};
                for (int i = 0; i < motion::kLimbCount; ++i) {
                    known.emplace_back(motion::name_of(static_cast<motion::Limb>(i)));
                }
                e_.unknown(e.span, "limb", limb, known);
            }
        };
        const lang::Expr& value = p.values[0];
        if (value.kind == lang::ExprKind::kBinary && value.op == lang::Op::kAnd) {
            for (const lang::Argument& a : value.args) {
                add(a.value);
            }
        } else {
            add(value);
        }
    }

    std::optional<LoadedClips> load() {
        FileSource* source = e_.library_.source;
        Assets* assets = source != nullptr ? source->assets() : nullptr;
        if (assets == nullptr) {
            e_.error("cannot-read", where_, "files of motion cannot be read here",
                     "use keyframes or a formula");
            return std::nullopt;
        }
        const std::string path =
            source->resolve(e_.library_.files[block_.span.file].filename, path_);
        auto loaded = assets->clips({path, scale_});
        if (!loaded) {
            for (Diagnostic& d : loaded.error()) {
                e_.error(d.code, where_, d.where.file + ": " + d.element + ": " + d.message,
                         d.remedy);
            }
            return std::nullopt;
        }
        for (const Diagnostic& d : loaded->notes) {
            e_.warn(d.code, where_, d.message, d.remedy);
        }
        return std::move(*loaded);
    }

    motion::Clip chosen(LoadedClips& loaded) {
        std::vector<std::string> known;
        for (motion::Clip& clip : loaded.clips) {
            if (take_.empty() ? loaded.clips.size() == 1 : clip.name == take_) {
                return std::move(clip);
            }
            known.push_back(clip.name);
        }
        if (take_.empty()) {
            e_.error("which-take", where_,
                     "this file has " + std::to_string(known.size()) + " clips",
                     known.empty() ? "use another file" : "write `take \"" + known[0] + "\"`");
        } else {
            e_.unknown(take_where_, "clip in " + path_, take_, known);
        }
        return {};
    }

    void edit(motion::Clip& clip) {
        if (cut_) {
            const auto [begin, end] = *cut_;
            if (!(begin >= 0 && begin < end && end <= clip.duration_s + 1e-9)) {
                e_.error("out-of-range", cut_where_,
                         "the clip goes from 0 s to " + told(clip.duration_s),
                         "cut a stretch inside, the end after the beginning");
                return;
            }
            clip = motion::copied(clip, begin, std::fmin(end, clip.duration_s));
        }
        if (mirror_) {
            static const figure::Figure figure = figure::make_mannequin(1.75);
            clip = motion::mirrored(clip, figure.skeleton);
        }
        if (reverse_) {
            clip = motion::reversed(clip);
        }
        if (loop_) {
            clip = motion::closed(clip, std::fmin(0.3, clip.duration_s / 4));
        }
        if (!(clip.duration_s > 0.001)) {
            e_.error("out-of-range", where_, "this clip takes no time", "use another stretch");
        }
    }

    static std::string told(double s) {
        return std::to_string(static_cast<long long>(s * 1000)) + " ms";
    }

    Elaboration& e_;
    const lang::Block& block_;
    std::string path_, take_;
    lang::Span where_, take_where_, cut_where_;
    std::optional<std::pair<double, double>> cut_;
    motion::ClipPlay play_;
    double scale_ = 0;
    bool mirror_ = false, reverse_ = false, loop_ = false;
};

OwnDefinition Elaboration::define_clip(const lang::Block& block) {
    return ClipBlock(*this, block).define();
}

}  // namespace puppetri::scene
