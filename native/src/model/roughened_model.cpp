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
    refuse("The roughness offset is " + text_of(roughness) + "; it must be 0 to 1.");
  }
  if (roughness == 0) return model;
  if (is_btf(model)) {
    refuse("BTF models do not support a roughness offset. Set the roughness offset to 0, or use a BRDF model.");
  }
  Model rougher = model;
  const auto r = static_cast<double>(roughness);
  if (const auto* scattered = std::get_if<ScatteredBrdf>(&model.body)) rougher.body = roughened(*scattered, r);
  if (const auto* parametric = std::get_if<ParametricBrdf>(&model.body)) rougher.body = roughened(*parametric, r);
  rougher.fit.warnings.push_back("made rougher by " + text_of(roughness) +
                                 "; errors are those of the model before that");
  return rougher;
}

}  // namespace velour
