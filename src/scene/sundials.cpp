// SPDX-License-Identifier: MIT
#include "puppetri/scene/sundials.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "puppetri/base/require.h"
#include "puppetri/run/equations.h"

#ifdef PUPPETRI_WITH_SUNDIALS
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#endif

namespace puppetri::scene {

#ifdef PUPPETRI_WITH_SUNDIALS
namespace {

// How far from its own number a rate reads variables; the whole size where a quantity is watched
// that may read any. Rates read through the names of parts, each of which may read those before it.
struct Band {
    std::uint32_t lower = 0, upper = 0;
};

Band band_of(const run::EquationSystem& system, std::uint32_t size) {
    if (size != system.variables.size()) {
        return {size, size};
    }
    struct Range {
        std::uint32_t first = ~std::uint32_t{0}, last = 0;  // none yet
    };
    std::vector<Range> locals;
    const auto reads = [&](ProgramIndex program) {
        Range range;
        for (const Slot& s : system.code.slots(program)) {
            Range more;
            if (s.kind == static_cast<std::uint32_t>(run::EquationSlot::kVariable)) {
                more = {s.index, s.index};
            } else if (s.kind == static_cast<std::uint32_t>(run::EquationSlot::kLocal)) {
                more = locals[s.index];
            }
            range.first = std::min(range.first, more.first);
            range.last = std::max(range.last, more.last);
        }
        return range;
    };
    for (const ProgramIndex p : system.locals) {
        const Range range = reads(p);
        locals.push_back(range);
    }
    Band band;
    for (std::uint32_t i = 0; i < size; ++i) {
        if (!system.variables[i].rate.valid()) {
            continue;
        }
        const Range range = reads(system.variables[i].rate);
        if (range.first <= range.last) {
            band.lower = std::max(band.lower, i > range.first ? i - range.first : 0);
            band.upper = std::max(band.upper, range.last > i ? range.last - i : 0);
        }
    }
    return band;
}

class Cvode final : public run::StepSource {
 public:
    explicit Cvode(const run::EquationSystem& equations) : equations_(equations) {
        PUP_REQUIRE(SUNContext_Create(nullptr, &context_) == 0);
    }
    ~Cvode() override {
        release();
        SUNContext_Free(&context_);
    }
    Cvode(const Cvode&) = delete;
    Cvode& operator=(const Cvode&) = delete;

    Outcome start(OdeSystem& system, double t_s, double until_s, std::span<const double> x,
                  std::span<const double>) override {
        release();
        n_ = system.size();
        now_s_ = t_s;
        system_ = &system;
        x_.assign(x.begin(), x.end());
        scratch_.assign(n_, 0);
        const auto all_finite = [](const std::vector<double>& list) {
            return std::all_of(list.begin(), list.end(), [](double v) { return v - v == 0; });
        };
        if (!all_finite(x_) || !system.rates(t_s, x_, scratch_) || !all_finite(scratch_)) {
            return Outcome::kBlewUp;
        }
        now_ = N_VNew_Serial(static_cast<sunindextype>(n_), context_);
        derivative_ = N_VNew_Serial(static_cast<sunindextype>(n_), context_);
        std::copy(x_.begin(), x_.end(), N_VGetArrayPointer(now_));
        memory_ = CVodeCreate(CV_BDF, context_);
        PUP_REQUIRE(now_ != nullptr && derivative_ != nullptr && memory_ != nullptr);
        const auto good = [](int flag) { PUP_REQUIRE(flag == CV_SUCCESS); };
        good(CVodeInit(memory_, rates, t_s, now_));
        good(CVodeSetUserData(memory_, this));
        good(CVodeSetErrHandlerFn(memory_, say_nothing, nullptr));
        good(CVodeWFtolerances(memory_, weights));
        const Band band = band_of(equations_, n_);
        if (band.lower + band.upper + 1 < n_ / 2) {
            matrix_ = SUNBandMatrix(n_, band.upper, band.lower, context_);
            linear_ = SUNLinSol_Band(now_, matrix_, context_);
        } else {
            matrix_ = SUNDenseMatrix(n_, n_, context_);
            linear_ = SUNLinSol_Dense(now_, matrix_, context_);
        }
        PUP_REQUIRE(matrix_ != nullptr && linear_ != nullptr);
        good(CVodeSetLinearSolver(memory_, linear_, matrix_));
        good(CVodeSetMaxStep(memory_, equations_.options.most_s));
        if (until_s < 1e100) {
            good(CVodeSetStopTime(memory_, until_s));
        }
        until_s_ = until_s;
        short_steps_ = 0;
        return Outcome::kStepped;
    }

    Outcome step(OdeSystem& system, OdeStep& out) override {
        // First steps may be that short; a long row of such steps comes to no end.
        constexpr double kShortest = 1e-13;
        constexpr int kMostShort = 200;
        system_ = &system;
        double end_s = 0;
        // Without a stop the second argument says only the direction.
        const double towards_s = until_s_ < 1e100 ? until_s_ : now_s_ + 1;
        const int flag = CVode(memory_, towards_s, now_, &end_s, CV_ONE_STEP);
        const bool is_short = end_s - now_s_ < kShortest * std::max(1.0, std::fabs(now_s_));
        short_steps_ = is_short ? short_steps_ + 1 : 0;
        if ((flag != CV_SUCCESS && flag != CV_TSTOP_RETURN) || !(end_s > now_s_) ||
            short_steps_ > kMostShort) {
            return Outcome::kBlewUp;
        }
        int order = 0;
        CVodeGetLastOrder(memory_, &order);
        out.begin_s = now_s_;
        out.length_s = end_s - now_s_;
        out.method = OdeMethod::kGiven;
        out.size = n_;
        const double* end = N_VGetArrayPointer(now_);
        out.rows.assign(std::size_t{n_} * (static_cast<std::uint32_t>(order) + 1), 0);
        std::copy(x_.begin(), x_.end(), out.rows.begin());
        std::copy(end, end + n_, out.rows.begin() + n_);
        if (!interpolant(out, order, end_s)) {
            return Outcome::kBlewUp;
        }
        x_.assign(end, end + n_);
        now_s_ = end_s;
        return Outcome::kStepped;
    }

    double now_s() const override { return now_s_; }
    Why why() const override { return {}; }

 private:
    // CVODE's polynomial of this step is sum y_k (s - 1)^k with y_k the k-th derivative at the end
    // times length^k / k!, or sum a_m s^m with a_m = sum over k >= m of y_k (k over m) (-1)^(k-m).
    // What is left of it when the chord is taken away and s (1 - s) is divided out has the
    // coefficients r_(2+j) = - sum over m >= j + 2 of a_m: only derivatives from the second on.
    bool interpolant(OdeStep& out, int order, double end_s) {
        double scale = out.length_s;
        double choose[6] = {1, 1, 0, 0, 0, 0};  // row k of Pascal's triangle
        for (int k = 2; k <= order; ++k) {
            for (int m = k; m > 0; --m) {
                choose[m] += choose[m - 1];
            }
            scale *= out.length_s / k;
            if (CVodeGetDky(memory_, end_s, k, derivative_) != CV_SUCCESS) {
                return false;
            }
            const double* d = N_VGetArrayPointer(derivative_);
            double factor = 0;
            for (int m = k; m >= 2; --m) {
                factor -= (k - m) % 2 == 0 ? choose[m] : -choose[m];
                double* row = out.rows.data() + std::size_t{n_} * static_cast<std::size_t>(m);
                for (std::uint32_t i = 0; i < n_; ++i) {
                    row[i] += factor * scale * d[i];
                }
            }
        }
        return std::all_of(out.rows.begin(), out.rows.end(), [](double v) { return v - v == 0; });
    }

    static int rates(realtype t, N_Vector x, N_Vector out, void* self) {
        Cvode& c = *static_cast<Cvode*>(self);
        const double* from = N_VGetArrayPointer(x);
        double* to = N_VGetArrayPointer(out);
        for (std::uint32_t i = 0; i < c.n_; ++i) {
            if (!(from[i] - from[i] == 0)) {
                return 1;  // to be tried with a shorter step
            }
        }
        return c.system_->rates(t, {from, c.n_}, {to, c.n_}) ? 0 : 1;
    }

    static int weights(N_Vector x, N_Vector out, void* self) {
        const Cvode& c = *static_cast<Cvode*>(self);
        const OdeOptions& o = c.equations_.options;
        const double* from = N_VGetArrayPointer(x);
        double* to = N_VGetArrayPointer(out);
        for (std::uint32_t i = 0; i < c.n_; ++i) {
            const double size = std::fabs(from[i]);
            to[i] = i < c.equations_.variables.size() ? 1 / (o.absolute + o.relative * size)
                                                      : 1 / (o.watched * (1e-6 + size));
        }
        return 0;
    }

    static void say_nothing(int, const char*, const char*, char*, void*) {}

    void release() {
        if (memory_ != nullptr) {
            CVodeFree(&memory_);
            SUNLinSolFree(linear_);
            SUNMatDestroy(matrix_);
            N_VDestroy(now_);
            N_VDestroy(derivative_);
        }
    }

    const run::EquationSystem& equations_;
    OdeSystem* system_ = nullptr;
    std::uint32_t n_ = 0;
    double now_s_ = 0, until_s_ = 0;
    int short_steps_ = 0;
    std::vector<double> x_, scratch_;
    SUNContext context_ = nullptr;
    void* memory_ = nullptr;
    N_Vector now_ = nullptr, derivative_ = nullptr;
    SUNMatrix matrix_ = nullptr;
    SUNLinearSolver linear_ = nullptr;
};

class Sources final : public run::StepSources {
 public:
    std::unique_ptr<run::StepSource> source(const run::EquationSystem& system) override {
        return std::make_unique<Cvode>(system);
    }
};

}  // namespace

std::string sundials_version() {
    char text[64] = {};
    return SUNDIALSGetVersion(text, sizeof text) == 0 ? std::string("SUNDIALS ") + text
                                                      : "SUNDIALS";
}

#else
namespace {

class Missing final : public run::StepSource {
 public:
    Outcome start(OdeSystem&, double t_s, double, std::span<const double>,
                  std::span<const double>) override {
        now_s_ = t_s;
        return Outcome::kUnknown;
    }
    Outcome step(OdeSystem&, OdeStep&) override { return Outcome::kUnknown; }
    double now_s() const override { return now_s_; }
    Why why() const override {
        return {"no-sundials", "this build has no SUNDIALS", kSundialsRemedy};
    }

 private:
    double now_s_ = 0;
};

class Sources final : public run::StepSources {
 public:
    std::unique_ptr<run::StepSource> source(const run::EquationSystem&) override {
        return std::make_unique<Missing>();
    }
};

}  // namespace

std::string sundials_version() { return {}; }
#endif

std::unique_ptr<run::StepSources> sundials_sources() { return std::make_unique<Sources>(); }

}  // namespace puppetri::scene
