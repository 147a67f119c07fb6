#include "fit/close_lights.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "fit/close_rings.h"
#include "fit/evaluate.h"
#include "sphere/directions.h"

namespace velour {
namespace {

constexpr int kEvenLights = 4096, kCloseRings = 72, kCloseSpokes = 40;
constexpr double kInnerRadius = 1e-4;  // radians; the width of a Gaussian of bandwidth 1e8

CloseRings rings_about(const Vec3& axis) { return {axis, kInnerRadius, 0.5 * kPiD, kCloseRings, kCloseSpokes}; }

constexpr int kOwnLights = 2048;

/// Appends directions that the material's own sampler generates from a rank-1 lattice.
void append_own(const Material& material, const PreparedBrdf& point, std::vector<Vec3>& out) {
  for (int i = 0; i < kOwnLights; ++i) {
    const double u = (i + 0.5) / kOwnLights, v = 0.6180339887498949 * i;
    out.push_back(material.sample_one(point, Vec2(u, v - std::floor(v))));
  }
}

}  // namespace

WeightedLights close_lights(const Material& material, const Vec3& wv) {
  const auto point = std::make_unique<PreparedBrdf>();
  material.prepare(wv, *point);
  const CloseRings mirror = rings_about({-wv.x, -wv.y, wv.z}), retro = rings_about(wv);
  std::vector<Vec3> all = hemisphere_fibonacci(kEvenLights);
  mirror.append(all);
  retro.append(all);
  const size_t not_own = all.size();
  append_own(material, *point, all);
  std::vector<float> own(all.size());
  evaluate(material, wv, all, {}, own);
  WeightedLights lights;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool drawn_with_density = i < not_own || own[i] > 0.0f;
    if (all[i].z <= 0 || !drawn_with_density) continue;
    lights.wl.push_back(all[i]);
    lights.weight.push_back(1 / (kEvenLights / (2 * kPiD) + mirror.density(all[i]) + retro.density(all[i]) +
                                 kOwnLights * static_cast<double>(own[i])));
  }
  return lights;
}

}  // namespace velour
