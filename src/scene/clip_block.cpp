// SPDX-License-Identifier: MIT
// `clip stroll { from "take.bvh" ... }`: a stretch of recorded motion as a movement that `does` may
// call, alone or with layers of others over it. All is done twice where it can be: to the form of
// the clip for humanoids, and to that of its file, for creatures.
#include <algorithm>
#include <deque>

#include "elaboration.h"
#include "formula_block.h"
#include "puppetri/lang/units.h"
#include "puppetri/motion/clip_edit.h"
#include "puppetri/motion/clip_layers.h"
#include "puppetri/motion/clip_movement.h"
#include "puppetri/motion/controls_from_pose.h"
#include "puppetri/scene/assets.h"

namespace puppetri::scene {
namespace {

const figure::Figure& humanoid() {
    static const figure::Figure figure = figure::make_mannequin(1.75);
    return figure;
}

// Both forms of a clip; none where its file has none of the kind, or what is said about it cannot
// be meant of that kind.
struct Forms {
    std::optional<motion::Clip> humanoid, raw;
    double hips_height_m = 0;
    figure::Skeleton skeleton;  // of raw
    Diagnostics no_humanoid;    // why
};

// What stands about one clip, the block's own or that of a layer.
struct Piece {
    std::string path, take;
    lang::Span where, take_where, cut_where, warp_where, only_where;
    std::optional<std::pair<double, double>> cut;
    std::vector<motion::WarpPoint> warp;
    std::vector<lang::Expr> only;
    double scale = 0, speed = 1;
    bool mirror = false, reverse = false, loop = false;
    double advances_m_s = 0;  // of the block itself
    // Of layers.
    std::vector<std::pair<lang::Name, double>> mask;
    double weight = 1, begins_s = 0, fade_in_s = 0, fade_out_s = 0;
    bool additive = false;
};

constexpr double kLayerRate_hz = 60;

}  // namespace

class ClipBlock {
 public:
    ClipBlock(Elaboration& elaboration, const lang::Block& block)
        : e_(elaboration), block_(block) {}

    OwnDefinition define() {
        OwnDefinition out{.block = &block_};
        const std::size_t before = e_.diagnostics.size();
        Piece base;
        base.where = block_.name.span;
        for (const lang::Property& p : block_.properties) {
            read(p, base, false);
        }
        if (base.path.empty() && !failed(before)) {
            e_.error("no-file", block_.name.span, "it does not say where it comes from",
                     "write `from \"take.bvh\"`");
        }
        if (failed(before)) {
            return out;
        }
        std::optional<Forms> forms = load(base);
        for (Piece& layer : layers_) {
            if (layer.path.empty()) {
                layer.path = base.path;
                layer.scale = layer.scale > 0 ? layer.scale : base.scale;
            }
        }
        if (!forms || failed(before)) {
            return out;
        }
        edit(base, *forms);
        if (!failed(before) && !layers_.empty()) {
            put_layers(*forms);
        }
        if (!failed(before)) {
            finish(base, *forms);
        }
        if (failed(before)) {
            return out;
        }
        return made(base, std::move(*forms), std::move(out));
    }

 private:
    bool failed(std::size_t before) const {
        return std::any_of(e_.diagnostics.begin() + static_cast<std::ptrdiff_t>(before),
                           e_.diagnostics.end(),
                           [](const Diagnostic& d) { return d.severity == Severity::kError; });
    }

    OwnDefinition made(const Piece& base, Forms forms, OwnDefinition out) {
        motion::PlayableClip playable;
        playable.hips_height_m = forms.hips_height_m;
        playable.skeleton = std::move(forms.skeleton);
        playable.advances_m_s = base.advances_m_s;
        for (const auto& [from, to] : {std::pair{&forms.humanoid, &playable.humanoid},
                                       std::pair{&forms.raw, &playable.raw}}) {
            if (*from) {
                *to = std::make_shared<const motion::Clip>(std::move(**from));
            }
        }
        const motion::Clip& any = playable.humanoid != nullptr ? *playable.humanoid : *playable.raw;
        for (const motion::ClipMark& mark : any.marks) {
            out.events.push_back(mark.name);
        }
        const bool only_raw = playable.humanoid == nullptr;
        auto maker = std::make_shared<const motion::ClipMaker>(block_.name.text,
                                                               std::move(playable), base.speed);
        motion::OwnSignature signature{.name = block_.name.text, .doc = "a clip"};
        signature.limbs =
            only_raw ? motion::LimbSet{} : motion::limbs_of(humanoid(), maker->spec());
        signature.as_argument = signature.limbs.bits != 0 &&
                                motion::without(signature.limbs, motion::kBothArms).bits == 0;
        out.clip = maker;
        out.no_humanoid = std::move(forms.no_humanoid);
        out.movement = std::make_shared<const motion::OwnMovement>(std::move(signature), maker);
        return out;
    }

    // ---- reading ----

    std::optional<std::string> text_of(const lang::Property& p, const char* form) {
        if (p.values.size() != 1 || p.values[0].kind != lang::ExprKind::kString) {
            e_.has_values(p, ~std::size_t{0}, form);
            return std::nullopt;
        }
        return p.values[0].text;
    }
    std::optional<double> number_of(const lang::Property& p, lang::Dimension dimension, double lo,
                                    double hi, const char* form, const char* range) {
        const auto x = e_.quantity_of(p, Scope{}, dimension, form);
        if (x && !(*x >= lo && *x <= hi)) {
            e_.error("out-of-range", p.span, lang::to_text(p.name) + " is " + range,
                     std::string("write `") + form + "`");
            return std::nullopt;
        }
        return x;
    }
    std::optional<double> factor_of(const lang::Property& p, const char* form) {
        return number_of(p, lang::dimension::kNone, 1e-6, 1e6, form, "a number above 0");
    }
    std::optional<double> time_of(const lang::Property& p, const char* form) {
        return number_of(p, lang::dimension::kTime, 0, 86'400, form, "a time, not negative");
    }

    void read(const lang::Property& p, Piece& piece, bool layer) {
        const std::string name = lang::to_text(p.name);
        if (p.has_children && name != "layer" && name != "mask") {
            e_.error("wrong-property", p.span, "nothing can stand in braces here",
                     "write one property per line");
        } else if (name == "from") {
            if (const auto file = text_of(p, "from \"take.bvh\"")) {
                piece.path = *file;
                piece.where = p.span;
            }
        } else if (name == "take") {
            piece.take = text_of(p, "take \"walk\"").value_or("");
            piece.take_where = p.span;
        } else if (name == "cut") {
            read_cut(p, piece);
        } else if (name == "warp") {
            read_warp(p, piece);
        } else if (name == "speed") {
            piece.speed = factor_of(p, "speed 1.2").value_or(1);
        } else if (name == "scale") {
            piece.scale = factor_of(p, "scale 0.0564").value_or(0);
        } else if (name == "mirror" && p.values.empty()) {
            piece.mirror = true;
        } else if (name == "reverse" && p.values.empty()) {
            piece.reverse = true;
        } else if (name == "loop" && p.values.empty()) {
            piece.loop = true;
        } else if (name == "only") {
            read_only(p, piece);
        } else if (name == "layer" && !layer) {
            read_layer(p);
        } else if (name == "advances" && !layer) {
            piece.advances_m_s = number_of(p, lang::dimension::kSpeed, -1000, 1000,
                                           "advances 1.2 m/s", "at most 1000 m/s")
                                     .value_or(0);
        } else if (!layer || !read_of_layer(p, name, piece)) {
            std::vector<std::string> known{"from",  "take",   "cut",     "warp", "speed",
                                           "scale", "mirror", "reverse", "loop", "only"};
            for (const char* more :
                 {"weight", "additive", "begins", "fade_in", "fade_out", "mask"}) {
                if (layer) {
                    known.emplace_back(more);
                }
            }
            if (!layer) {
                known.insert(known.end(), {"advances", "layer"});
            }
            e_.unknown_property(p, known);
        }
    }

    bool read_of_layer(const lang::Property& p, const std::string& name, Piece& piece) {
        if (name == "weight") {
            piece.weight =
                number_of(p, lang::dimension::kNone, 0, 1, "weight 0.5", "a number from 0 to 1")
                    .value_or(1);
        } else if (name == "additive" && p.values.empty()) {
            piece.additive = true;
        } else if (name == "begins") {
            piece.begins_s = time_of(p, "begins 0.4 s").value_or(0);
        } else if (name == "fade_in") {
            piece.fade_in_s = time_of(p, "fade_in 0.2 s").value_or(0);
        } else if (name == "fade_out") {
            piece.fade_out_s = time_of(p, "fade_out 0.2 s").value_or(0);
        } else if (name == "mask") {
            read_mask(p, piece);
        } else {
            return false;
        }
        return true;
    }

    void read_layer(const lang::Property& p) {
        if (!p.has_children || !p.values.empty()) {
            e_.error("wrong-property", p.span, "layer is not written like this",
                     "write `layer { from \"nod.keys\", additive }`");
            return;
        }
        Piece layer;
        layer.where = p.span;
        for (const lang::Property& child : p.children) {
            read(child, layer, true);
        }
        layers_.push_back(std::move(layer));
    }

    void read_cut(const lang::Property& p, Piece& piece) {
        if (p.values.size() != 1 || p.values[0].kind != lang::ExprKind::kRange) {
            e_.has_values(p, ~std::size_t{0}, "cut 1 s .. 2.5 s");
            return;
        }
        const auto begin = e_.constant_number(p.values[0].args[0].value, {}, lang::dimension::kTime,
                                              "the beginning");
        const auto end =
            e_.constant_number(p.values[0].args[1].value, {}, lang::dimension::kTime, "the end");
        if (begin && end) {
            piece.cut = {begin->value, end->value};
            piece.cut_where = p.span;
        }
    }

    // warp 0.4 s -> 0.6 s: what was at 0.4 s is at 0.6 s.
    void read_warp(const lang::Property& p, Piece& piece) {
        if (p.values.size() != 3 || !is_symbol(p.values[1], "->")) {
            e_.has_values(p, ~std::size_t{0}, "warp 0.4 s -> 0.6 s");
            return;
        }
        const auto from =
            e_.constant_number(p.values[0], {}, lang::dimension::kTime, "the time in the clip");
        const auto to = e_.constant_number(p.values[2], {}, lang::dimension::kTime, "the new time");
        if (!from || !to) {
            return;
        }
        const motion::WarpPoint last = piece.warp.empty() ? motion::WarpPoint{} : piece.warp.back();
        if (!(from->value > last.from_s && to->value > last.to_s)) {
            e_.error("out-of-range", p.span,
                     "times of a warp ascend, on both sides of the arrow, from 0 s on",
                     "order the warps; leave 0 s -> 0 s out");
            return;
        }
        piece.warp.push_back({from->value, to->value});
        piece.warp_where = p.span;
    }

    // only left_arm and right_arm
    void read_only(const lang::Property& p, Piece& piece) {
        if (!e_.has_values(p, 1, "only left_arm and right_arm")) {
            return;
        }
        piece.only_where = p.span;
        const lang::Expr& value = p.values[0];
        if (value.kind == lang::ExprKind::kBinary && value.op == lang::Op::kAnd) {
            for (const lang::Argument& a : value.args) {
                piece.only.push_back(a.value);
            }
        } else {
            piece.only.push_back(value);
        }
    }

    // mask { head 0.5, left_arm 0.2 }
    void read_mask(const lang::Property& p, Piece& piece) {
        if (!p.has_children || !p.values.empty() || p.children.empty()) {
            e_.error("wrong-property", p.span, "mask is not written like this",
                     "write `mask { head 0.5, left_arm 1 }`");
            return;
        }
        piece.only_where = p.span;
        for (const lang::Property& child : p.children) {
            const auto weight =
                number_of(child, lang::dimension::kNone, 0, 1, "head 0.5", "weighted from 0 to 1");
            if (weight && child.name.steps.size() == 1) {
                piece.mask.emplace_back(child.name.steps[0], *weight);
            } else if (weight) {
                e_.error("wrong-property", child.span, "a mask names limbs and joints",
                         "write `head 0.5`");
            }
        }
    }

    // ---- files ----

    std::optional<Forms> load(const Piece& piece) {
        FileSource* source = e_.library_.source;
        Assets* assets = source != nullptr ? source->assets() : nullptr;
        if (assets == nullptr) {
            e_.error("cannot-read", piece.where, "files of motion cannot be read here",
                     "use keyframes or a formula");
            return std::nullopt;
        }
        const std::string path =
            source->resolve(e_.library_.files[block_.span.file].filename, piece.path);
        auto loaded = assets->clips({path, piece.scale});
        if (!loaded) {
            for (Diagnostic& d : loaded.error()) {
                e_.error(d.code, piece.where, d.where.file + ": " + d.element + ": " + d.message,
                         d.remedy);
            }
            return std::nullopt;
        }
        for (const Diagnostic& d : loaded->notes) {
            e_.warn(d.code, piece.where, d.message, d.remedy);
        }
        Forms forms;
        forms.hips_height_m = loaded->hips_height_m;
        forms.skeleton = std::move(loaded->skeleton);
        forms.no_humanoid = std::move(loaded->no_humanoid);
        choose(piece, *loaded, forms);
        return forms;
    }

    void choose(const Piece& piece, LoadedClips& loaded, Forms& forms) {
        const auto take = [&](std::vector<motion::Clip>& clips, std::optional<motion::Clip>& out) {
            for (motion::Clip& clip : clips) {
                if (piece.take.empty() ? clips.size() == 1 : clip.name == piece.take) {
                    out = std::move(clip);
                    return;
                }
            }
        };
        std::vector<std::string> known;
        for (const motion::Clip& clip : loaded.raw.empty() ? loaded.humanoid : loaded.raw) {
            known.push_back(clip.name);
        }
        take(loaded.humanoid, forms.humanoid);
        take(loaded.raw, forms.raw);
        if (forms.humanoid || forms.raw) {
            return;
        }
        if (piece.take.empty()) {
            e_.error("which-take", piece.where,
                     "this file has " + std::to_string(known.size()) + " clips",
                     known.empty() ? "use another file" : "write `take \"" + known[0] + "\"`");
        } else {
            e_.unknown(piece.take_where, "clip in " + piece.path, piece.take, known);
        }
    }

    // ---- editing ----

    template <class F>
    static void each(Forms& forms, F&& change) {
        if (forms.humanoid) {
            change(*forms.humanoid, humanoid().skeleton);
        }
        if (forms.raw) {
            change(*forms.raw,
                   forms.skeleton.joints.empty() ? humanoid().skeleton : forms.skeleton);
        }
    }

    void edit(const Piece& piece, Forms& forms) {
        const double whole_s = (forms.humanoid ? *forms.humanoid : *forms.raw).duration_s;
        if (piece.cut) {
            const auto [begin, end] = *piece.cut;
            if (!(begin >= 0 && begin < end && end <= whole_s + 1e-9)) {
                e_.error("out-of-range", piece.cut_where,
                         "the clip goes from 0 s to " + told(whole_s),
                         "cut a stretch inside, the end after the beginning");
                return;
            }
        }
        each(forms, [&](motion::Clip& clip, const figure::Skeleton& skeleton) {
            if (piece.cut) {
                clip = motion::copied(clip, piece.cut->first,
                                      std::fmin(piece.cut->second, clip.duration_s));
            }
            if (piece.mirror) {
                clip = motion::mirrored(clip, skeleton);
            }
            if (piece.reverse) {
                clip = motion::reversed(clip);
            }
        });
        if (!piece.warp.empty() && !warp(piece, forms)) {
            return;
        }
        keep_only(piece, forms);
    }

    bool warp(const Piece& piece, Forms& forms) {
        const double end_s = (forms.humanoid ? *forms.humanoid : *forms.raw).duration_s;
        if (piece.warp.back().from_s > end_s + 1e-9) {
            e_.error("out-of-range", piece.warp_where, "the clip ends at " + told(end_s),
                     "warp times inside it; they count from where it is cut");
            return false;
        }
        each(forms, [&](motion::Clip& clip, const figure::Skeleton&) {
            std::vector<motion::WarpPoint> points{{0, 0}};
            points.insert(points.end(), piece.warp.begin(), piece.warp.end());
            points.back().from_s = std::fmin(points.back().from_s, clip.duration_s);
            if (points.back().from_s < clip.duration_s) {  // the rest at its own pace
                points.push_back(
                    {clip.duration_s, points.back().to_s + clip.duration_s - points.back().from_s});
            }
            clip = motion::warped(clip, points);
        });
        return true;
    }

    // What `only` and `mask` name, as weights of tracks; others get 0. Of humanoids limbs and
    // joints of the language, of files their own joints. With `below` a joint stands for all that
    // hangs from it. None where a name means nothing there.
    static std::optional<motion::LayerMask> mask_of_humanoid(
        const std::vector<std::pair<std::string, double>>& names, bool below) {
        motion::LayerMask mask{.others = 0};
        const figure::Figure& figure = humanoid();
        const figure::DofSet& dofs = mannequin_dofs();
        for (const auto& [name, weight] : names) {
            std::vector<figure::JointIndex> joints;
            const auto add_limb = [&](motion::Limb limb) {
                for (const figure::JointIndex j : motion::joints_of(figure, limb)) {
                    joints.push_back(j);
                }
            };
            if (const auto limb = motion::limb_named(name)) {
                add_limb(*limb);
            } else if (name == "arms") {
                add_limb(motion::Limb::kLeftArm);
                add_limb(motion::Limb::kRightArm);
            } else if (name == "legs") {
                add_limb(motion::Limb::kPelvis);
                add_limb(motion::Limb::kLeftLeg);
                add_limb(motion::Limb::kRightLeg);
            } else {
                const std::string_view known = figure::humanoid_joint(name);
                const figure::JointIndex top =
                    figure.skeleton.find(known.empty() ? std::string_view(name) : known);
                if (!top.valid()) {
                    return std::nullopt;
                }
                for (const auto& part :
                     motion::mask_below(figure.skeleton, figure.skeleton.joints[top.value].name)
                         .parts) {
                    const figure::JointIndex j = figure.skeleton.find(part.target);
                    if (below || j == top) {
                        joints.push_back(j);
                    }
                }
            }
            for (const figure::JointIndex j : joints) {
                mask.parts.push_back({figure.skeleton.joints[j.value].name, weight});
                const figure::DofSet::Range range = dofs.of_joint(j);
                for (std::uint32_t d = 0; d < range.count; ++d) {
                    mask.parts.push_back({dofs.dofs[range.first + d].name, weight});
                }
            }
        }
        return mask;
    }
    static std::optional<motion::LayerMask> mask_of_file(
        const std::vector<std::pair<std::string, double>>& names, bool below,
        const motion::Clip& clip, const figure::Skeleton& skeleton) {
        motion::LayerMask mask{.others = 0};
        for (const auto& [name, weight] : names) {
            bool found = skeleton.find(name).valid();
            if (found && below) {
                for (motion::LayerMask::Part part : motion::mask_below(skeleton, name).parts) {
                    part.weight = weight;
                    mask.parts.push_back(std::move(part));
                }
            }
            mask.parts.push_back({name, weight});
            for (const motion::NumberTrack& track : clip.numbers) {
                if (track.target.substr(0, track.target.rfind('.')) == name) {
                    mask.parts.push_back({track.target, weight});
                    found = true;
                }
            }
            found = found || clip.find_rotation(name) != nullptr ||
                    clip.find_translation(name) != nullptr;
            if (!found) {
                return std::nullopt;
            }
        }
        return mask;
    }

    struct Masks {
        std::optional<motion::LayerMask> humanoid, raw;
    };
    // The masks of both forms; a form of which the names mean nothing is given up.
    Masks masks(const Piece& piece, Forms& forms) {
        std::vector<std::pair<std::string, double>> names;
        for (const lang::Expr& e : piece.only) {
            names.emplace_back(lang::to_text(e), 1);
            if (e.kind == lang::ExprKind::kPath && e.path.steps.size() == 1) {
                names.back().first = e.path.steps[0].text;
            }
        }
        for (const auto& [name, weight] : piece.mask) {
            names.emplace_back(name.text, weight);
        }
        if (names.empty()) {
            return {motion::LayerMask{}, motion::LayerMask{}};
        }
        Masks out;
        const bool below = piece.mask.empty();
        if (forms.humanoid) {
            out.humanoid = mask_of_humanoid(names, below);
        }
        if (forms.raw) {
            out.raw = mask_of_file(names, below, *forms.raw, forms.skeleton);
        }
        if (!out.humanoid && !out.raw) {
            unknown_part(piece, forms, names);
        }
        if (!out.humanoid) {
            forms.humanoid.reset();
        }
        if (!out.raw) {
            forms.raw.reset();
        }
        return out;
    }
    void unknown_part(const Piece& piece, const Forms& forms,
                      const std::vector<std::pair<std::string, double>>& names) {
        std::vector<std::string> known{"arms", "legs"};
        for (int i = 0; i < motion::kLimbCount; ++i) {
            known.emplace_back(motion::name_of(static_cast<motion::Limb>(i)));
        }
        if (!forms.humanoid) {
            known.clear();
        }
        for (const figure::Joint& joint : forms.skeleton.joints) {
            known.push_back(joint.name);
        }
        std::string unknown = names.front().first;
        for (const auto& [name, weight] : names) {
            const bool alone = !forms.humanoid || !mask_of_humanoid({{name, weight}}, true);
            unknown = alone ? name : unknown;
        }
        e_.unknown(piece.only_where, "limb or joint", unknown, known);
    }

    void keep_only(const Piece& piece, Forms& forms) {
        if (piece.only.empty()) {
            return;
        }
        const Masks masks = this->masks(piece, forms);
        const auto keep = [](motion::Clip& clip, const motion::LayerMask& mask) {
            const auto drop = [&](auto& tracks) {
                std::erase_if(tracks, [&](const auto& t) { return mask.weight_of(t.target) == 0; });
            };
            drop(clip.rotations);
            drop(clip.translations);
            drop(clip.numbers);
        };
        if (forms.humanoid) {
            keep(*forms.humanoid, *masks.humanoid);
        }
        if (forms.raw) {
            keep(*forms.raw, *masks.raw);
        }
    }

    // ---- layers ----

    void put_layers(Forms& base) {
        std::deque<Forms> kept;  // clips stay where they are while the layers speak of them
        std::vector<motion::ClipLayer> of_humanoid, of_file;
        if (base.humanoid) {
            of_humanoid.push_back({.clip = &*base.humanoid});
        }
        if (base.raw) {
            of_file.push_back({.clip = &*base.raw});
        }
        for (const Piece& piece : layers_) {
            const std::size_t before = e_.diagnostics.size();
            std::optional<Forms> loaded = load(piece);
            if (!loaded || failed(before)) {
                return;
            }
            Forms& forms = kept.emplace_back(std::move(*loaded));
            edit(piece, forms);
            if (failed(before)) {
                return;
            }
            Masks masks = this->masks(piece, forms);
            if (failed(before)) {
                return;
            }
            each(forms, [&](motion::Clip& clip, const figure::Skeleton&) {
                if (piece.additive) {
                    clip = motion::to_additive(clip, 0);
                }
                if (piece.loop) {
                    clip = closed(clip);
                }
            });
            motion::ClipLayer layer{.weight = piece.weight,
                                    .mode = piece.additive ? motion::LayerMode::kAdditive
                                                           : motion::LayerMode::kOverride,
                                    .begin_s = piece.begins_s,
                                    .speed = piece.speed,
                                    .fade_in_s = piece.fade_in_s,
                                    .fade_out_s = piece.fade_out_s};
            add(base.humanoid, forms.humanoid, masks.humanoid, layer, of_humanoid);
            add(base.raw, forms.raw, masks.raw, layer, of_file);
            if (!base.humanoid && !base.raw) {
                e_.error("wrong-type", piece.where,
                         "this layer is for other figures than what lies below it",
                         "let both be clips of humanoids, or both of the same creature");
                return;
            }
        }
        if (base.humanoid) {
            *base.humanoid = flat(of_humanoid, humanoid().skeleton, &mannequin_dofs());
        }
        if (base.raw) {
            *base.raw = flat(
                of_file, base.skeleton.joints.empty() ? named_by(of_file) : base.skeleton, nullptr);
        }
    }

    // A form in which the layer is missing is given up.
    static void add(std::optional<motion::Clip>& base, std::optional<motion::Clip>& clip,
                    std::optional<motion::LayerMask>& mask, motion::ClipLayer layer,
                    std::vector<motion::ClipLayer>& stack) {
        if (!base || !clip || !mask) {
            base.reset();
            return;
        }
        layer.clip = &*clip;
        layer.mask = std::move(*mask);
        stack.push_back(std::move(layer));
    }

    // All joints that tracks name, in a row: a stand-in for a skeleton that the file does not have.
    static figure::Skeleton named_by(const std::vector<motion::ClipLayer>& layers) {
        figure::Skeleton skeleton;
        const auto put = [&](const auto& tracks) {
            for (const auto& track : tracks) {
                if (!skeleton.find(track.target).valid()) {
                    skeleton.joints.push_back({track.target, {}, {}, {}});
                }
            }
        };
        for (const motion::ClipLayer& layer : layers) {
            put(layer.clip->rotations);
            put(layer.clip->translations);
        }
        return skeleton;
    }

    static motion::Clip flat(const std::vector<motion::ClipLayer>& layers,
                             const figure::Skeleton& skeleton, const figure::DofSet* dofs) {
        const motion::Clip& base = *layers.front().clip;
        motion::Clip out =
            motion::flattened(layers, skeleton, base.duration_s, kLayerRate_hz, dofs);
        out.name = base.name;
        out.loops = base.loops;
        return out;
    }

    void finish(const Piece& piece, Forms& forms) {
        each(forms, [&](motion::Clip& clip, const figure::Skeleton&) {
            if (piece.loop) {
                clip = closed(clip);
            }
        });
        const motion::Clip& any = forms.humanoid ? *forms.humanoid : *forms.raw;
        if (!(any.duration_s > 0.001)) {
            e_.error("out-of-range", piece.where, "this clip takes no time", "use another stretch");
        } else if (any.rotations.empty() && any.translations.empty() && any.numbers.empty()) {
            e_.error("nothing-moves", piece.where, "this clip moves nothing",
                     "its tracks are shown by `puppetri clip`");
        }
    }

    static motion::Clip closed(const motion::Clip& clip) {
        return motion::closed(clip, std::fmin(0.3, clip.duration_s / 4));
    }

    static std::string told(double s) {
        return std::to_string(static_cast<long long>(s * 1000)) + " ms";
    }

    Elaboration& e_;
    const lang::Block& block_;
    std::vector<Piece> layers_;
};

OwnDefinition Elaboration::define_clip(const lang::Block& block) {
    return ClipBlock(*this, block).define();
}

}  // namespace puppetri::scene
