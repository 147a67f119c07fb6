// Error of a material against the formula behind a measurement, independent of the library's own directions.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/analytic_measurement.h"
#include "support/materials.h"

namespace velour::test {

/// Random light directions with solid angles: a third even, a third about the mirror direction and a third about the
/// view, these with radii uniform on a logarithmic scale. Another way than the library's own light trees.
class RandomLights {
 public:
  explicit RandomLights(const Vec3& wv) : axes_{{-wv.x, -wv.y, wv.z}, wv} {
    for (uint64_t i = 0; i < kCount; ++i) {
      RandomStream random(77, 0, i);
      const Vec3 w = i % 3 == 2 ? sample_uniform_hemisphere(random.next2()) : near(axes_[i % 3], random);
      if (w.z <= 0) continue;
      wl.push_back(w);
      weight.push_back(3 / (kCount * (0.5 / kPiD + density(axes_[0], w) + density(axes_[1], w))));
    }
  }
  std::vector<Vec3> wl;
  std::vector<double> weight;

 private:
  static constexpr uint64_t kCount = 60000;
  static constexpr double kInner = 1e-4, kOuter = 1;  // radians

  static Vec3 near(const Vec3& axis, RandomStream& random) {
    const double angle = kInner * std::pow(kOuter / kInner, static_cast<double>(random.next()));
    const double phi = 2 * kPiD * static_cast<double>(random.next());
    const Vec3d local(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle));
    return glm::normalize(Frame::about(axis).to_world(Vec3(local)));
  }
  static double density(const Vec3& axis, const Vec3& w) {
    const double angle = 2 * std::asin(std::min(1.0, 0.5 * glm::length(Vec3d(w) - Vec3d(axis))));
    if (angle < kInner || angle > kOuter) return 0;
    return 1 / (2 * kPiD * std::sin(angle) * angle * std::log(kOuter / kInner));
  }

  Vec3 axes_[2];
};

/// Relative L2 of the luminance of f cos where `known` (empty: everywhere), by random directions.
inline double true_error(const Material& material, const AnalyticMeasurement::Formula& truth,
                         const AnalyticMeasurement::Coverage& known, const Vec3& wv) {
  const RandomLights lights(wv);
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  double error = 0, energy = 0;
  for (size_t i = 0; i < lights.wl.size(); ++i) {
    const Vec3& wl = lights.wl[i];
    if (known && !known({wl, wv})) continue;
    const double expected = luminance(truth({wl, wv})) * static_cast<double>(wl.z);
    const double found = luminance(eval_one(*point, wl).f) * static_cast<double>(wl.z);
    error += lights.weight[i] * (expected - found) * (expected - found);
    energy += lights.weight[i] * expected * expected;
  }
  if (!(energy > 0)) return error > 0 ? 1 : 0;
  return std::sqrt(error / energy);
}

}  // namespace velour::test
