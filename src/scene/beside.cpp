// SPDX-License-Identifier: MIT
#include "puppetri/scene/beside.h"

#include <utility>

#include "puppetri/base/require.h"
#include "puppetri/scene/sundials.h"

namespace puppetri::scene {
namespace {

// Outputs of all systems, one after another.
class Outputs final : public stage::Quantities {
 public:
    explicit Outputs(std::shared_ptr<const run::Equations> equations)
        : equations_(std::move(equations)) {
        for (std::uint32_t s = 0; s < equations_->systems().size(); ++s) {
            for (std::uint32_t k = 0; k < equations_->systems()[s].outputs.size(); ++k) {
                outputs_.emplace_back(s, k);
            }
        }
    }
    double at(std::uint32_t quantity, SimTime at) const override {
        PUP_REQUIRE(quantity < outputs_.size());
        return equations_->output(outputs_[quantity].first, outputs_[quantity].second, at);
    }

 private:
    std::shared_ptr<const run::Equations> equations_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> outputs_;
};

}  // namespace

Beside::Beside(const Scene& scene, run::CourseBook* bake) : scene_(scene) {
    if (scene.equations.empty()) {
        return;
    }
    const auto sources = sundials_sources();
    equations_ = std::make_shared<run::Equations>(
        scene.equations, run::EquationsOptions{.sources = sources.get(), .bake = bake});
    if (!scene.play.driven_props.empty() || !scene.play.driven_dofs.empty()) {
        quantities_ = std::make_shared<Outputs>(equations_);
    }
}
Beside::~Beside() = default;

std::shared_ptr<const stage::Quantities> Beside::quantities() const { return quantities_; }

std::vector<run::Coupled*> Beside::coupled(stage::Stage& stage) {
    std::vector<run::Coupled*> list;
    if (equations_ != nullptr) {
        list.push_back(equations_.get());
    }
    if (!scene_.sensors.empty()) {
        sensors_ = std::make_unique<stage::Sensors>(scene_.sensors, stage);
        list.push_back(sensors_.get());
    }
    return list;
}

bool Beside::carry_to(SimTime at, Diagnostic& fault) {
    return equations_ == nullptr || equations_->carry_to(at, fault);
}

}  // namespace puppetri::scene
