#include "model/model_material.h"

#include "job/error.h"
#include "material/factored_material.h"
#include "material/parametric_material.h"
#include "material/scattered_material.h"
#include "material/srbf_btf_material.h"
#include "material/tensor_btf_material.h"

namespace velour {
namespace {

/// `make` of the model's body, as a pointer that shares the ownership of the model instead of copying its lobes.
template <typename Make>
std::shared_ptr<const Material> made_of_body(const std::shared_ptr<const Model>& model, const Make& make) {
  return std::visit(
      [&](const auto& body) { return make(std::shared_ptr<const std::remove_cvref_t<decltype(body)>>(model, &body)); },
      model->body);
}

using Scattered = std::shared_ptr<const ScatteredBrdf>;
using Parametric = std::shared_ptr<const ParametricBrdf>;
using Factored = std::shared_ptr<const FactoredBtf>;
using Srbf = std::shared_ptr<const SrbfBtf>;
using Tensors = std::shared_ptr<const TensorBtf>;

template <typename... Makes>
struct Either : Makes... {
  using Makes::operator()...;
};

}  // namespace

std::shared_ptr<const Material> make_material(const std::shared_ptr<const Model>& model, int neighbors) {
  return made_of_body(model, Either{[&](const Scattered& body) { return make_scattered_material(body, neighbors); },
                                    [&](const Parametric& body) { return make_parametric_material(body); },
                                    [&](const Factored& body) { return make_factored_material(body); },
                                    [&](const Srbf& body) { return make_srbf_btf_material(body); },
                                    [&](const Tensors& body) { return make_tensor_btf_material(body); }});
}

std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const Model>& proposal, int neighbors) {
  if (is_btf(*proposal)) {
    throw Error(Status::invalid_argument, "A model of a BTF cannot draw samples for the measurement of a BRDF.");
  }
  if (const auto* body = std::get_if<ScatteredBrdf>(&proposal->body)) {
    return make_measured_material(std::move(measurement), Scattered(proposal, body), neighbors);
  }
  const auto* body = &std::get<ParametricBrdf>(proposal->body);
  return make_measured_material(std::move(measurement), Parametric(proposal, body));
}

}  // namespace velour
