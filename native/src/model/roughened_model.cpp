#include "model/roughened_model.h"

#include <cstdio>

#include "job/error.h"

namespace velour {
namespace {

std::string text_of(float roughness) {
  char text[16];
  std::snprintf(text, sizeof text, "%.3g", static_cast<double>(roughness));
  return text;
}

}  // namespace

Model roughened(const Model& model, float roughness) {
  if (!(roughness >= 0 && roughness <= 1)) {
    refuse("A roughness offset of " + text_of(roughness) + " cannot be had; choose 0 to 1.");
  }
  if (roughness == 0) return model;
  if (is_btf(model)) {
    refuse(
        "A model of a BTF cannot be made rougher: its values are no sums of lobes that each have their own light. "
        "Set the roughness offset to 0, or render a model of a BRDF.");
  }
  Model rougher = model;
  const auto r = static_cast<double>(roughness);
  if (const auto* scattered = std::get_if<ScatteredBrdf>(&model.body)) rougher.body = roughened(*scattered, r);
  if (const auto* parametric = std::get_if<ParametricBrdf>(&model.body)) rougher.body = roughened(*parametric, r);
  rougher.fit.warnings.push_back("made rougher by " + text_of(roughness) + "; errors are those before");
  return rougher;
}

}  // namespace velour
