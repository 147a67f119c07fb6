// Small parametric models for tests.
#pragma once

#include <cmath>

#include "brdf/model/parametric_brdf.h"
#include "material/material.h"
#include "math/srbf/kernel.h"

namespace velour::test {

/// A lobe whose parameters change smoothly with the view's polar angle t, radians.
struct LobeRecipe {
  LobeSpace space;
  float bandwidth;
  Rgb coefficient;
  float tilt = 0;     // tilt / t: in light space -1 follows the mirror direction, 1 the view
  float stretch = 0;  // at the horizon; with t^2 below
  float rise = 0;     // of the coefficients' logarithm at the horizon, with t^2
};

/// `cells` of the splines; tilts point along the view's azimuth, anisotropic models have another stretch across it.
inline ParametricBrdf parametric_model(bool isotropic, const std::vector<LobeRecipe>& lobes, int cells = 10) {
  using P = ParametricBrdf;
  ParametricBrdf brdf;
  brdf.isotropic = isotropic;
  brdf.cells = cells;
  for (const LobeRecipe& lobe : lobes) brdf.space.push_back(lobe.space);
  const int side = cells + 2, nodes = brdf.spline().node_count();
  brdf.control.resize(brdf.index(nodes, 0, 0));
  for (int node = 0; node < nodes; ++node) {
    // A quadratic spline is linear where its coefficients are, with this place for each.
    const auto place = [&](int k) { return (static_cast<float>(k) - 0.5f) / static_cast<float>(cells); };
    const Vec2 r = isotropic ? Vec2(place(node + 1), 0) : Vec2(2 * place(node % side) - 1, 2 * place(node / side) - 1);
    const float r_sq = glm::dot(r, r);
    for (int j = 0; j < brdf.lobe_count(); ++j) {
      const LobeRecipe& lobe = lobes[static_cast<size_t>(j)];
      const auto set = [&](int k, float value) { brdf.control[brdf.index(node, k, j)] = value; };
      set(P::kLogBandwidth, std::log(lobe.bandwidth));
      set(P::kLogRed, std::log(lobe.coefficient.r) + lobe.rise * r_sq);
      set(P::kLogGreen, std::log(lobe.coefficient.g) + lobe.rise * r_sq);
      set(P::kLogBlue, std::log(lobe.coefficient.b) + 1.1f * lobe.rise * r_sq);
      set(P::kTiltX, lobe.tilt * r.x * kPi / 2);
      set(P::kStretchA, isotropic ? lobe.stretch * r_sq : lobe.stretch);
      if (isotropic) continue;
      set(P::kTiltY, lobe.tilt * r.y * kPi / 2);
      set(P::kStretchB, 0.5f * lobe.stretch * r.x);
    }
  }
  return brdf;
}

/// A highlight in half space of albedo about 1/2 at the normal, whatever its bandwidth, over one along the mirror
/// direction in light space, one that reflects back, and a nearly constant base.
inline std::vector<LobeRecipe> highlight_recipe(float bandwidth) {
  const auto integral = static_cast<float>(kernel_integral(Kernel::gaussian, static_cast<double>(bandwidth)));
  return {{LobeSpace::half, bandwidth, Rgb(0.6f, 0.5f, 0.3f) / (4 * integral), 0.02f, 0.5f, 1.2f},
          {LobeSpace::light, 4, {0.05f, 0.06f, 0.07f}, -0.7f, -0.2f},
          {LobeSpace::light, 20, {0.1f, 0.08f, 0.02f}, 0.9f},
          {LobeSpace::light, 1e-4f, {0.02f, 0.02f, 0.03f}}};
}

/// With two lobes more that fade away towards grazing views.
inline std::vector<LobeRecipe> fading_recipe(float bandwidth) {
  auto lobes = highlight_recipe(bandwidth);
  lobes.push_back({LobeSpace::light, 3, Rgb(0.05f), -0.5f, 0, -40});
  lobes.push_back({LobeSpace::half, 10, Rgb(0.1f), 0, 0.2f, -60});
  return lobes;
}

inline std::shared_ptr<const ParametricBrdf> parametric_highlight(float bandwidth, bool isotropic) {
  return std::make_shared<ParametricBrdf>(parametric_model(isotropic, highlight_recipe(bandwidth)));
}

}  // namespace velour::test
