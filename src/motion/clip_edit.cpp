// SPDX-License-Identifier: MIT
// Edits of the times of clips: cutting, pasting, warping, repeating. Each works track by track with
// one template; where a cut falls into a spline the rates are written into the keys around it.
#include "puppetri/motion/clip_edit.h"

#include <algorithm>
#include <type_traits>

#include "clip_keys.h"
#include "clip_segment.h"
#include "puppetri/base/require.h"

namespace puppetri::motion {
namespace {

// Calls f(track) for the selected tracks of all three kinds; f is generic.
template <class AnyClip, class F>
void each_track(AnyClip& clip, const TrackSelection& selection, F f) {
    const auto over = [&](auto& tracks) {
        for (auto& track : tracks) {
            if (selection.has(track.target)) {
                f(track);
            }
        }
    };
    over(clip.rotations);
    over(clip.translations);
    over(clip.numbers);
}

// Writes the rates of segment i into its ends, so that it no longer depends on its neighbours.
template <class Key>
void freeze(ClipTrack<Key>& track, std::size_t i, bool seam) {
    Key& a = track.keys[i];
    if (!is_spline(a.interpolation) || a.interpolation == Interpolation::kHermite) {
        return;
    }
    const Segment<Key> s = make_segment(track, i, seam);
    a.out = s.out;
    track.keys[i + 1].in = s.in;
    a.interpolation = Interpolation::kHermite;
}

// The part of an easing curve on one side of parameter s, stretched to the unit square again.
// Source  de Casteljau's subdivision.
struct SplitEasing {
    Easing before, after;
    bool possible = false;
};
SplitEasing split(const Easing& e, double ratio) {
    // The parameter at which time is `ratio`, by halving: this is no inner loop.
    double lo = 0, hi = 1;
    for (int i = 0; i < 80; ++i) {
        const double s = (lo + hi) / 2, r = 1 - s;
        (3 * r * r * s * e.x1 + 3 * r * s * s * e.x2 + s * s * s < ratio ? lo : hi) = s;
    }
    const double s = (lo + hi) / 2;
    struct Point {
        double x, y;
    };
    const auto mid = [&](Point a, Point b) { return Point{lerp(a.x, b.x, s), lerp(a.y, b.y, s)}; };
    const Point p0{0, 0}, p1{e.x1, e.y1}, p2{e.x2, e.y2}, p3{1, 1};
    const Point q0 = mid(p0, p1), q1 = mid(p1, p2), q2 = mid(p2, p3);
    const Point r0 = mid(q0, q1), r1 = mid(q1, q2);
    const Point m = mid(r0, r1);
    const auto in_box = [](Point lo_corner, Point hi_corner, Point a, Point b) {
        const double w = hi_corner.x - lo_corner.x, h = hi_corner.y - lo_corner.y;
        return Easing{(a.x - lo_corner.x) / w, (a.y - lo_corner.y) / h, (b.x - lo_corner.x) / w,
                      (b.y - lo_corner.y) / h};
    };
    SplitEasing out;
    out.possible =
        m.x > 1e-9 && m.x < 1 - 1e-9 && std::fabs(m.y) > 1e-9 && std::fabs(1 - m.y) > 1e-9;
    if (out.possible) {
        out.before = in_box(p0, m, q0, r0);
        out.after = in_box(m, p3, r1, q2);
        out.possible = runs_forward(out.before) && runs_forward(out.after);
    }
    return out;
}

// A key at t, if t lies between two keys that are not there.
template <class Key>
void put_key(ClipTrack<Key>& track, double t, bool seam) {
    const std::size_t i = segment_of(track.keys, t);
    if (i + 1 >= track.keys.size() || t <= track.keys[i].t_s + kSame_s ||
        t >= track.keys[i + 1].t_s - kSame_s) {
        return;
    }
    // The splines before and after lean on keys that are no longer their neighbours.
    if (is_spline(track.keys[i].interpolation)) {
        for (std::size_t k = i > 0 ? i - 1 : 0; k <= i + 1 && k + 1 < track.keys.size(); ++k) {
            if (k != i) {
                freeze(track, k, seam);
            }
        }
        if (seam && i == 0) {
            freeze(track, track.keys.size() - 2, seam);
        }
        if (seam && i + 2 == track.keys.size()) {
            freeze(track, 0, seam);
        }
    } else {
        for (const std::size_t k : {i - 1, i + 1}) {
            if (k < track.keys.size() - 1) {
                freeze(track, k, seam);
            }
        }
    }
    freeze(track, i, seam);
    const Segment<Key> s = make_segment(track, i, seam);
    Key key;
    key.t_s = t;
    key.value = value_in(s, t);
    key.interpolation = s.kind;
    if (s.kind == Interpolation::kHermite) {
        key.in = key.out = rate_in(s, t);
    } else if (s.kind == Interpolation::kBezier) {
        const SplitEasing halves = split(s.easing, (t - s.begin_s) / s.length_s);
        if (halves.possible) {
            track.keys[i].easing = halves.before;
            key.easing = halves.after;
        } else {  // a value that has not moved yet, or is back: the curve by its rates
            Key &a = track.keys[i], &b = track.keys[i + 1];
            a.out = rate_in(s, s.begin_s);
            key.in = key.out = rate_in(s, t);
            b.in = rate_in(s, s.begin_s + s.length_s);
            a.interpolation = key.interpolation = Interpolation::kHermite;
        }
    }
    track.keys.insert(track.keys.begin() + static_cast<std::ptrdiff_t>(i) + 1, key);
}

template <class Key>
void shift(std::vector<Key>& keys, double by_s) {
    for (Key& key : keys) {
        key.t_s += by_s;
    }
}

// Keys of [begin, end], moved to start at 0; at least one.
template <class Key>
std::vector<Key> keys_between(const ClipTrack<Key>& track, double begin_s, double end_s,
                              bool seam) {
    ClipTrack<Key> t = track;
    put_key(t, begin_s, seam);
    put_key(t, end_s, seam);
    // What leans on keys outside is written down first.
    for (std::size_t k = 0; k + 1 < t.keys.size(); ++k) {
        const bool inside = t.keys[k].t_s >= begin_s - kSame_s && t.keys[k].t_s < end_s;
        const bool edge = k == 0 || t.keys[k - 1].t_s < begin_s - kSame_s ||
                          k + 2 >= t.keys.size() || t.keys[k + 2].t_s > end_s + kSame_s;
        if (inside && edge) {
            freeze(t, k, seam);
        }
    }
    std::vector<Key> keys;
    for (const Key& key : t.keys) {
        if (key.t_s >= begin_s - kSame_s && key.t_s <= end_s + kSame_s) {
            keys.push_back(key);
            // Exactly at the ends, whatever rounding says.
            keys.back().t_s = key.t_s <= begin_s + kSame_s ? 0
                              : key.t_s >= end_s - kSame_s ? end_s - begin_s
                                                           : key.t_s - begin_s;
        }
    }
    if (keys.empty()) {  // the stretch lies before the first or after the last key
        keys.push_back(begin_s < t.keys.front().t_s ? t.keys.front() : t.keys.back());
        keys.back().t_s = 0;
    }
    return keys;
}

bool seam_of(const Clip& clip, const auto& track) {
    return has_seam(track, clip.loops, clip.duration_s);
}

void sort_marks(Clip& clip) {
    std::stable_sort(clip.marks.begin(), clip.marks.end(),
                     [](const ClipMark& a, const ClipMark& b) { return a.t_s < b.t_s; });
}

template <class Key>
ClipTrack<Key>& track_of(std::vector<ClipTrack<Key>>& tracks, const std::string& target) {
    for (ClipTrack<Key>& track : tracks) {
        if (track.target == target) {
            return track;
        }
    }
    return tracks.emplace_back(ClipTrack<Key>{target, {}});
}

// The tracks of `piece` written over [t, t + its duration] of `clip`, whose keys from there on have
// been moved by room_s.
template <class Key>
void paste_tracks(std::vector<ClipTrack<Key>>& into, const Clip& clip, double t_s, double room_s,
                  const std::vector<ClipTrack<Key>>& from, double length_s) {
    for (const ClipTrack<Key>& piece : from) {
        ClipTrack<Key>& track = track_of(into, piece.target);
        std::vector<Key> keys, middle = piece.keys;
        shift(middle, t_s);
        if (!track.keys.empty()) {
            const bool seam = seam_of(clip, track);
            if (t_s > 0) {
                keys = keys_between(track, 0, t_s, seam);
            }
            std::vector<Key> after;
            const double resume_s = t_s + length_s - room_s;
            if (resume_s < clip.duration_s - kSame_s) {
                after = keys_between(track, resume_s, clip.duration_s, seam);
                shift(after, t_s + length_s);
            }
            append_keys(keys, std::move(middle));
            append_keys(keys, std::move(after));
        } else {
            keys = std::move(middle);
        }
        track.keys = std::move(keys);
    }
}

}  // namespace

bool TrackSelection::has(std::string_view target) const {
    return targets.empty() || std::find(targets.begin(), targets.end(), target) != targets.end();
}

Clip with_keys_at(const Clip& clip, double t_s, const TrackSelection& selection) {
    Clip out = clip;
    each_track(out, selection, [&](auto& track) { put_key(track, t_s, seam_of(clip, track)); });
    return out;
}

Clip copied(const Clip& clip, double begin_s, double end_s, const TrackSelection& selection) {
    PUP_REQUIRE(begin_s >= 0 && begin_s <= end_s && end_s <= clip.duration_s);
    Clip out;
    out.name = clip.name;
    out.duration_s = end_s - begin_s;
    out.root = clip.root;
    const auto copy = [&](const auto& from, auto& to) {
        for (const auto& track : from) {
            if (selection.has(track.target)) {
                to.push_back(
                    {track.target, keys_between(track, begin_s, end_s, seam_of(clip, track))});
            }
        }
    };
    copy(clip.rotations, out.rotations);
    copy(clip.translations, out.translations);
    copy(clip.numbers, out.numbers);
    for (ClipMark mark : clip.marks) {
        if (mark.end_s >= begin_s && mark.t_s <= end_s) {
            mark.t_s = clamp(mark.t_s - begin_s, 0, out.duration_s);
            mark.end_s = clamp(mark.end_s - begin_s, 0, out.duration_s);
            out.marks.push_back(std::move(mark));
        }
    }
    return out;
}

Clip without(const Clip& clip, double begin_s, double end_s, const TrackSelection& selection) {
    PUP_REQUIRE(begin_s >= 0 && begin_s <= end_s && end_s <= clip.duration_s);
    Clip out = clip;
    const bool all = selection.targets.empty();
    const double gap = end_s - begin_s;
    each_track(out, selection, [&](auto& track) {
        const bool seam = seam_of(clip, track);
        auto before = keys_between(track, 0, begin_s, seam);
        auto after = keys_between(track, end_s, clip.duration_s, seam);
        before.back().interpolation = Interpolation::kLinear;  // straight over what is gone
        shift(after, all ? begin_s : end_s);
        if (all && begin_s <= 0) {
            track.keys = std::move(after);
        } else if (all && end_s >= clip.duration_s) {
            track.keys = std::move(before);
        } else {
            append_keys(before, std::move(after));
            track.keys = std::move(before);
        }
    });
    if (all) {
        out.loops = false;
        out.duration_s = clip.duration_s - gap;
        std::vector<ClipMark> marks;
        const auto moved = [&](double t) {
            return t <= begin_s ? t : t >= end_s ? t - gap : begin_s;
        };
        for (ClipMark mark : clip.marks) {
            const bool inside = mark.t_s >= begin_s && mark.end_s <= end_s &&
                                !(mark.t_s == begin_s && mark.end_s == begin_s);
            if (inside && gap > 0) {
                continue;
            }
            mark.t_s = clamp(moved(mark.t_s), 0, out.duration_s);
            mark.end_s = clamp(moved(mark.end_s), 0, out.duration_s);
            marks.push_back(std::move(mark));
        }
        out.marks = std::move(marks);
        sort_marks(out);
        // Rounding must not leave a key behind the end.
        each_track(out, {}, [&](auto& track) {
            while (track.keys.size() > 1 && track.keys.back().t_s > out.duration_s + kSame_s) {
                track.keys.pop_back();
            }
            track.keys.back().t_s = std::min(track.keys.back().t_s, out.duration_s);
        });
    }
    return out;
}

CutClip cut(const Clip& clip, double begin_s, double end_s, const TrackSelection& selection) {
    return {copied(clip, begin_s, end_s, selection), without(clip, begin_s, end_s, selection)};
}

namespace {

Clip put_in(const Clip& clip, double t_s, const Clip& piece, bool insert) {
    PUP_REQUIRE(t_s >= 0 && t_s <= clip.duration_s);
    const double length = piece.duration_s, room = insert ? length : 0;
    Clip out = clip;
    out.loops = clip.loops && !insert;
    if (insert) {
        // Tracks that the piece lacks wait.
        each_track(out, {}, [&](auto& track) {
            const bool seam = seam_of(clip, track);
            put_key(track, t_s, seam);
            for (std::size_t k = 0; k + 1 < track.keys.size(); ++k) {
                freeze(track, k, seam);
            }
            auto keys = keys_between(track, 0, t_s, seam);
            auto after = keys_between(track, t_s, clip.duration_s, seam);
            if (length > 0 && t_s < clip.duration_s) {
                shift(after, t_s + length);
                append_keys(keys, std::move(after));
            }
            track.keys = std::move(keys);
        });
    }
    // The piece's own tracks are pasted from the clip as it was.
    const auto paste = [&](const auto& was, auto& into, const auto& from) {
        auto fresh = was;
        paste_tracks(fresh, clip, t_s, room, from, length);
        for (auto& track : fresh) {
            const bool pasted = std::any_of(
                from.begin(), from.end(), [&](const auto& p) { return p.target == track.target; });
            if (pasted) {
                track_of(into, track.target).keys = std::move(track.keys);
            }
        }
    };
    paste(clip.rotations, out.rotations, piece.rotations);
    paste(clip.translations, out.translations, piece.translations);
    paste(clip.numbers, out.numbers, piece.numbers);
    out.duration_s = std::max(clip.duration_s + room, t_s + length);
    if (insert) {
        for (ClipMark& mark : out.marks) {
            mark.t_s += mark.t_s >= t_s ? length : 0;
            mark.end_s += mark.end_s > t_s || mark.t_s >= t_s + length ? length : 0;
        }
    }
    for (ClipMark mark : piece.marks) {
        mark.t_s += t_s;
        mark.end_s += t_s;
        out.marks.push_back(std::move(mark));
    }
    sort_marks(out);
    return out;
}

}  // namespace

Clip pasted(const Clip& clip, double t_s, const Clip& piece) {
    return put_in(clip, t_s, piece, false);
}
Clip inserted(const Clip& clip, double t_s, const Clip& piece) {
    return put_in(clip, t_s, piece, true);
}

Clip reversed(const Clip& clip) {
    Clip out = clip;
    each_track(out, {}, [&](auto& track) {
        auto keys = track.keys;
        const std::size_t n = keys.size();
        for (std::size_t i = 0; i < n; ++i) {
            auto& key = keys[i];
            const auto& from = track.keys[n - 1 - i];
            key = from;
            key.t_s = clip.duration_s - from.t_s;
            // The way to the next key is what was the way from the one before.
            if (i + 1 < n) {
                const auto& before = track.keys[n - 2 - i];
                key.interpolation = before.interpolation;
                const Easing& e = before.easing;
                key.easing = {1 - e.x2, 1 - e.y2, 1 - e.x1, 1 - e.y1};
            } else {
                key.interpolation = Interpolation::kLinear;
                key.easing = {};
            }
            key.in = from.out * -1.0;
            key.out = from.in * -1.0;
            key.shape.bias = -from.shape.bias;
        }
        // A step stays at the value that it had; where a curve arrives at another one just before,
        // that one keeps a key of its own.
        std::vector<typename std::decay_t<decltype(track.keys)>::value_type> steps;
        for (std::size_t i = 0; i < n; ++i) {
            auto key = keys[i];
            if (i + 1 < n && key.interpolation == Interpolation::kStep) {
                if (i > 0 && keys[i - 1].interpolation != Interpolation::kStep &&
                    !(key.value == keys[i + 1].value) && key.t_s - 1e-6 > keys[i - 1].t_s) {
                    steps.push_back(key);
                    steps.back().t_s -= 1e-6;
                }
                key.value = keys[i + 1].value;
            }
            steps.push_back(key);
        }
        keys = std::move(steps);
        track.keys = std::move(keys);
    });
    for (ClipMark& mark : out.marks) {
        const double begin = clip.duration_s - mark.end_s;
        mark.end_s = clip.duration_s - mark.t_s;
        mark.t_s = begin;
    }
    sort_marks(out);
    return out;
}

Clip stretched(const Clip& clip, double factor) {
    PUP_REQUIRE(factor > 0);
    Clip out = clip;
    out.duration_s = clip.duration_s * factor;
    each_track(out, {}, [&](auto& track) {
        for (auto& key : track.keys) {
            key.t_s = std::min(key.t_s * factor, out.duration_s);
            key.in = key.in * (1 / factor);
            key.out = key.out * (1 / factor);
        }
    });
    for (ClipMark& mark : out.marks) {
        mark.t_s = std::min(mark.t_s * factor, out.duration_s);
        mark.end_s = std::min(mark.end_s * factor, out.duration_s);
    }
    return out;
}

Clip warped(const Clip& clip, std::span<const WarpPoint> points) {
    PUP_REQUIRE(points.size() >= 2 && points.front().from_s == 0 && points.front().to_s == 0 &&
                std::fabs(points.back().from_s - clip.duration_s) <= kSame_s);
    Clip out = clip;
    const auto span_of = [&](double t) {
        std::size_t i = 0;
        while (i + 2 < points.size() && points[i + 1].from_s <= t) {
            ++i;
        }
        return i;
    };
    const auto slower = [&](std::size_t i) {  // seconds after per second before
        return (points[i + 1].to_s - points[i].to_s) / (points[i + 1].from_s - points[i].from_s);
    };
    const auto moved = [&](double t) {
        const std::size_t i = span_of(t);
        return points[i].to_s + (t - points[i].from_s) * slower(i);
    };
    for (const WarpPoint& p : points) {
        PUP_REQUIRE(&p == &points.front() ||
                    ((&p)[-1].from_s < p.from_s && (&p)[-1].to_s < p.to_s));
        if (p.from_s > 0 && p.from_s < clip.duration_s) {
            out = with_keys_at(out, p.from_s);
        }
    }
    each_track(out, {}, [&](auto& track) {
        const bool seam = seam_of(out, track);
        for (std::size_t k = 0; k + 1 < track.keys.size(); ++k) {
            freeze(track, k, seam);
        }
        for (auto& key : track.keys) {
            const std::size_t i = span_of(key.t_s);
            const bool corner = i > 0 && key.t_s <= points[i].from_s + kSame_s;
            key.in = key.in * (1 / slower(corner ? i - 1 : i));
            key.out = key.out * (1 / slower(i));
            key.t_s = std::min(moved(key.t_s), points.back().to_s);
        }
    });
    out.duration_s = points.back().to_s;
    for (ClipMark& mark : out.marks) {
        mark.t_s = std::min(moved(mark.t_s), out.duration_s);
        mark.end_s = std::min(moved(mark.end_s), out.duration_s);
    }
    return out;
}

}  // namespace puppetri::motion
