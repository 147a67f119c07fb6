#include "model/model.h"

#include "base/error.h"
#include "brdf/eval/parametric_material.h"
#include "brdf/eval/per_view_material.h"
#include "btf/eval/factored_material.h"
#include "btf/eval/sided_btf_material.h"
#include "btf/measure/pair_layout.h"
#include "material/derived_materials.h"

namespace velour {
namespace {

/// Calls `make` with a pointer to the model's body that shares ownership of the model, so no lobes are copied.
template <typename Make>
std::shared_ptr<const Material> made_of_body(const std::shared_ptr<const Model>& model, const Make& make) {
  return std::visit(
      [&](const auto& body) { return make(std::shared_ptr<const std::remove_cvref_t<decltype(body)>>(model, &body)); },
      model->body);
}

using Scattered = std::shared_ptr<const PerViewBrdf>;
using Parametric = std::shared_ptr<const ParametricBrdf>;
using Factored = std::shared_ptr<const FactoredBtf>;
using Srbf = std::shared_ptr<const SrbfBtf>;
using Tensors = std::shared_ptr<const TensorBtf>;

template <typename... Makes>
struct Either : Makes... {
  using Makes::operator()...;
};
template <typename... Makes>
Either(Makes...) -> Either<Makes...>;

/// Material for light from one side.
std::shared_ptr<const Material> lit_from(BtfLight light, const std::shared_ptr<const Model>& model, int neighbors) {
  return made_of_body(model, Either{[&](const Scattered& body) { return make_per_view_material(body, neighbors); },
                                    [&](const Parametric& body) { return make_parametric_material(body); },
                                    [&](const Factored& body) { return make_factored_material(body, light); },
                                    [&](const Srbf& body) { return make_srbf_btf_material(body, light); },
                                    [&](const Tensors& body) { return make_tensor_btf_material(body, light); }});
}

/// Whether the model includes transmitted light.
template <typename Btf>
bool knows_through(const Btf& btf) {
  return serving_side(btf, false, true) || serving_side(btf, true, false);
}
bool knows_through(const FactoredBtf& btf) { return PairInterpolation(btf.layout).knows_through(); }
bool knows_through(const PerViewBrdf&) { return false; }
bool knows_through(const ParametricBrdf&) { return false; }

}  // namespace

std::shared_ptr<const Material> make_reflecting_material(const std::shared_ptr<const Model>& model, int neighbors) {
  return lit_from(BtfLight::viewers_side, model, neighbors);
}

std::shared_ptr<const Material> make_material(const std::shared_ptr<const Model>& model, int neighbors) {
  auto reflecting = make_reflecting_material(model, neighbors);
  if (!std::visit([](const auto& body) { return knows_through(body); }, model->body)) return reflecting;
  return std::make_shared<const ThroughMaterial>(std::move(reflecting),
                                                 lit_from(BtfLight::other_side, model, neighbors));
}

std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const Model>& proposal, int neighbors) {
  if (is_btf(*proposal)) {
    throw Error(Status::invalid_argument, "A BTF model cannot be used to sample a BRDF measurement; use a BRDF model.");
  }
  if (const auto* body = std::get_if<PerViewBrdf>(&proposal->body)) {
    return make_measured_material(std::move(measurement), Scattered(proposal, body), neighbors);
  }
  const auto* body = &std::get<ParametricBrdf>(proposal->body);
  return make_measured_material(std::move(measurement), Parametric(proposal, body));
}

}  // namespace velour
