// SPDX-License-Identifier: MIT
#include "puppetri/run/course_book.h"

#include <algorithm>
#include <utility>

#include "bytes.h"
#include "puppetri/base/hash.h"
#include "puppetri/run/equations.h"

namespace puppetri::run {
namespace {

constexpr std::string_view kMagic = "puppetri courses 1\n";

bool same(std::span<const double> a, std::span<const double> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](double p, double q) { return value_of_real(p) == value_of_real(q); });
}

std::string bake_remedy(const EquationSystem& system) {
    return "on a machine with SUNDIALS: `puppetri run SCENE --bake` writes " + system.baked_in +
           " anew; or write `solver stiff`, which needs no file";
}

class Baked final : public StepSource {
 public:
    explicit Baked(const EquationSystem& system) : system_(system) {
        if (auto why = not_baked(system)) {
            why_ = std::move(*why);
        } else {
            part_ = system.baked->find(system.path);
        }
    }

    Outcome start(OdeSystem&, double t_s, double until_s, std::span<const double> x,
                  std::span<const double> data) override {
        segment_ = nullptr;
        now_s_ = t_s;
        at_ = 0;
        if (part_ == nullptr) {
            return Outcome::kUnknown;
        }
        for (const CourseSegment& s : part_->segments) {
            if (s.begin_s == t_s && s.until_s == until_s && same(s.x, x) && same(s.data, data)) {
                segment_ = &s;
                return Outcome::kStepped;
            }
        }
        why_ = {"not-baked",
                system_.baked_in +
                    " holds no course that begins here: this run is another than "
                    "the one that was baked, by its seed, its events or its choices",
                "bake this run: `puppetri run SCENE --bake` with its --seed and --events; or "
                "write `solver stiff`, which needs no file"};
        return Outcome::kUnknown;
    }

    Outcome step(OdeSystem&, OdeStep& out) override {
        if (segment_ == nullptr) {
            return Outcome::kUnknown;
        }
        if (at_ == segment_->steps.size()) {
            why_ = {"not-baked",
                    system_.baked_in + " ends here: the run that was baked was shorter",
                    "bake a longer one: `puppetri run SCENE --bake --for TIME`"};
            return Outcome::kUnknown;
        }
        out = segment_->steps[at_++];
        now_s_ = at_ < segment_->steps.size() ? segment_->steps[at_].begin_s : segment_->end_s;
        return Outcome::kStepped;
    }

    double now_s() const override { return now_s_; }
    Why why() const override { return why_; }

 private:
    const EquationSystem& system_;
    const CoursePart* part_ = nullptr;
    const CourseSegment* segment_ = nullptr;
    std::size_t at_ = 0;
    double now_s_ = 0;
    Why why_;
};

class Recording final : public StepSource {
 public:
    Recording(std::unique_ptr<StepSource> source, CoursePart& part)
        : source_(std::move(source)), part_(part) {}

    Outcome start(OdeSystem& system, double t_s, double until_s, std::span<const double> x,
                  std::span<const double> data) override {
        const Outcome outcome = source_->start(system, t_s, until_s, x, data);
        if (outcome == Outcome::kStepped) {
            part_.size = system.size();
            part_.segments.push_back(
                {t_s, until_s, {x.begin(), x.end()}, {data.begin(), data.end()}, {}, t_s});
        }
        return outcome;
    }
    Outcome step(OdeSystem& system, OdeStep& out) override {
        const Outcome outcome = source_->step(system, out);
        if (outcome == Outcome::kStepped) {
            part_.segments.back().steps.push_back(out);
            part_.segments.back().end_s = source_->now_s();
        }
        return outcome;
    }
    double now_s() const override { return source_->now_s(); }
    Why why() const override { return source_->why(); }

 private:
    std::unique_ptr<StepSource> source_;
    CoursePart& part_;
};

void write_segment(BytesWriter& w, const CourseSegment& s) {
    w.real(s.begin_s);
    w.real(s.until_s);
    w.reals(s.x);
    w.reals(s.data);
    w.number(s.steps.size());
    for (const OdeStep& step : s.steps) {
        w.real(step.begin_s);
        w.real(step.length_s);
        w.reals(step.rows);
    }
    w.real(s.end_s);
}

CourseSegment read_segment(BytesReader& r, std::uint32_t size) {
    CourseSegment s;
    s.begin_s = r.real();
    s.until_s = r.real();
    s.x = r.reals();
    s.data = r.reals();
    r.good = r.good && s.x.size() == size;
    double at_s = s.begin_s;
    for (std::size_t left = r.count(); left > 0 && r.good; --left) {
        OdeStep step;
        step.begin_s = r.real();
        step.length_s = r.real();
        step.method = OdeMethod::kGiven;
        step.size = size;
        step.rows = r.reals();
        const std::size_t rows = size == 0 ? 0 : step.rows.size() / size;
        r.good = r.good && rows >= 2 && rows <= 8 && rows * size == step.rows.size() &&
                 step.length_s > 0 &&
                 (s.steps.empty() ? step.begin_s == at_s : step.begin_s > at_s);
        at_s = step.begin_s;
        s.steps.push_back(std::move(step));
    }
    s.end_s = r.real();
    r.good = r.good && (s.steps.empty() ? s.end_s == at_s : s.end_s > at_s) && s.end_s <= s.until_s;
    return s;
}

}  // namespace

const CoursePart* CourseBook::find(std::string_view path) const {
    const auto found = std::find_if(parts.begin(), parts.end(),
                                    [&](const CoursePart& p) { return p.path == path; });
    return found == parts.end() ? nullptr : &*found;
}

std::uint64_t hash_of(const EquationSystem& system) {
    Hash64 h;
    for (const EquationSystem::Variable& v : system.variables) {
        h.add_text(v.name).add_f64(v.initial).add_u64(v.rate.value).add_u64(v.next.value);
        h.add_i64(v.every_ticks).add_u64(v.before.value);
    }
    h.add_u64(system.locals.size());
    for (const ProgramIndex p : system.locals) {
        h.add_u64(p.value);
    }
    h.add_u64(system.events.size());
    for (const EquationSystem::Event& e : system.events) {
        h.add_u64(e.value.value).add_u64(e.plain ? 1 : 0);
    }
    h.add_u64(system.data.size()).add_u64(system.code.hash());
    const OdeOptions& o = system.options;
    h.add_f64(o.relative).add_f64(o.absolute).add_f64(o.most_s);
    return h.value();
}

std::optional<StepSource::Why> not_baked(const EquationSystem& system) {
    using Why = StepSource::Why;
    if (system.baked == nullptr) {
        return Why{"not-baked", "there is no file " + system.baked_in, bake_remedy(system)};
    }
    const CoursePart* part = system.baked->find(system.path);
    if (part == nullptr) {
        return Why{"not-baked", system.baked_in + " holds no courses of " + system.path,
                   bake_remedy(system)};
    }
    if (part->equations != hash_of(system)) {
        return Why{"stale-course",
                   system.baked_in + " was made of other equations, parameters or tolerances",
                   bake_remedy(system)};
    }
    return std::nullopt;
}

std::unique_ptr<StepSource> baked_source(const EquationSystem& system) {
    return std::make_unique<Baked>(system);
}

std::unique_ptr<StepSource> recording_source(std::unique_ptr<StepSource> source, CoursePart& part) {
    return std::make_unique<Recording>(std::move(source), part);
}

std::string write_courses(const CourseBook& book) {
    std::vector<std::uint8_t> bytes(kMagic.begin(), kMagic.end());
    BytesWriter w(bytes);
    w.text(book.solver);
    w.number(book.parts.size());
    for (const CoursePart& p : book.parts) {
        w.text(p.path);
        w.number(p.equations);
        w.number(p.size);
        w.number(p.segments.size());
        for (const CourseSegment& s : p.segments) {
            write_segment(w, s);
        }
    }
    const std::string text(bytes.begin(), bytes.end());
    w.number(hash_text(text));
    return {bytes.begin(), bytes.end()};
}

Checked<CourseBook> read_courses(std::string_view bytes, const std::string& file) {
    const auto bad = [&](const char* message) {
        return Unexpected(Diagnostics{{.code = "bad-course",
                                       .where = {.file = file},
                                       .element = "courses in " + file,
                                       .message = message,
                                       .remedy = "bake it anew, on a machine with SUNDIALS: "
                                                 "`puppetri run SCENE --bake`"}});
    };
    if (bytes.substr(0, kMagic.size()) != kMagic) {
        return bad("this is no file of baked courses, or one of another version");
    }
    if (bytes.size() < kMagic.size() + 8) {
        return bad("the file is cut off");
    }
    const std::string_view body = bytes.substr(0, bytes.size() - 8);
    const auto as_bytes = [](std::string_view t) {
        return std::span(reinterpret_cast<const std::uint8_t*>(t.data()), t.size());
    };
    if (BytesReader(as_bytes(bytes.substr(body.size()))).number() != hash_text(body)) {
        return bad("the file is cut off or damaged");
    }
    BytesReader r(as_bytes(body.substr(kMagic.size())));
    CourseBook book;
    book.solver = r.text();
    for (std::size_t left = r.count(); left > 0 && r.good; --left) {
        CoursePart part;
        part.path = r.text();
        part.equations = r.number();
        const std::uint64_t size = r.number();
        part.size = static_cast<std::uint32_t>(size);
        r.good = r.good && size < (1u << 20);
        for (std::size_t more = r.count(); more > 0 && r.good; --more) {
            part.segments.push_back(read_segment(r, part.size));
        }
        book.parts.push_back(std::move(part));
    }
    if (!r.good || !r.at_end()) {
        return bad("what the file says makes no sense");
    }
    return book;
}

}  // namespace puppetri::run
