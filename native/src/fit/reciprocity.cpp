#include "fit/reciprocity.h"

#include <cmath>

#include "fit/evaluate.h"
#include "fit/view_grid.h"
#include "sphere/directions.h"

namespace velour {
namespace {

constexpr int kReciprocityViews = 16, kReciprocityRings = 32, kReciprocitySpokes = 16;

std::vector<Vec3> views(bool isotropic) {
  std::vector<Vec3> out = hemisphere_fibonacci(kReciprocityViews);
  if (!isotropic) return out;
  for (Vec3& v : out) v = Vec3(std::sqrt(1 - v.z * v.z), 0, v.z);
  return out;
}

/// `f(pair)` is the luminance, or nothing if the pair is not covered. Returns nothing if no pair is covered both ways.
template <class Luminance>
std::optional<double> error_of(bool isotropic, const Progress& progress, const Luminance& f) {
  double difference = 0, energy = 0;
  bool covered = false;
  for (const Vec3& wv : views(isotropic)) {
    progress.check();
    const LightGrid lights = light_grid(wv, kReciprocityRings, kReciprocitySpokes);
    for (size_t i = 0; i < lights.wl.size(); ++i) {
      const Vec3& wl = lights.wl[i];
      const std::optional<double> there = f({wl, wv}), back = f({wv, wl});
      if (!there || !back) continue;
      covered = true;
      const double cosines = static_cast<double>(wl.z) * wv.z;
      const double a = *there * cosines, b = *back * cosines;
      difference += lights.weight[i] * (a - b) * (a - b);
      energy += lights.weight[i] * 0.5 * (a * a + b * b);
    }
  }
  if (!covered) return std::nullopt;
  return energy > 0 ? std::sqrt(difference / energy) : 0.0;
}

}  // namespace

double reciprocity_error(const Material& material, const Progress& progress) {
  const auto f = [&](const DirectionPair& pair) -> std::optional<double> {
    Rgb value;
    evaluate(material, pair.wv, {&pair.wl, 1}, {&value, 1});
    return luminance(value);
  };
  return error_of(material.isotropic(), progress, f).value_or(0);
}

std::optional<double> reciprocity_error(const Measurement& measurement, const Progress& progress) {
  if (!measurement.samples().empty()) return std::nullopt;
  const auto f = [&](const DirectionPair& pair) -> std::optional<double> {
    Rgb value;
    uint8_t valid = 0;
    measurement.eval(pair.wv, {&pair.wl, 1}, {&value, 1}, {&valid, 1});
    return valid ? std::optional<double>(luminance(value)) : std::nullopt;
  };
  return error_of(measurement.isotropic(), progress, f);
}

}  // namespace velour
