#include "fit/picture_weights.h"

#include <algorithm>

namespace velour {
namespace {

// Luminance relative to the mean below which a sample is invisible beside the light from other directions.
constexpr double kWeightFloor = 0.1;

double luminance_of(const SliceSample& s) { return std::max(static_cast<double>(luminance(s.value)), 0.0); }

}  // namespace

std::vector<float> picture_weights(std::span<const SliceSample> samples) {
  double sum = 0, solid_angle = 0, square = 0;
  for (const SliceSample& s : samples) {
    sum += static_cast<double>(s.weight) * luminance_of(s);
    solid_angle += static_cast<double>(s.weight);
  }
  if (!(sum > 0)) return {};
  const double floor = kWeightFloor * sum / solid_angle;
  std::vector<double> factors;
  for (const SliceSample& s : samples) {
    const double y = luminance_of(s);
    factors.push_back(1 / ((y + floor) * (y + floor)));
    square += static_cast<double>(s.weight) * y * y * factors.back();
  }
  std::vector<float> out;
  for (const double f : factors) out.push_back(static_cast<float>(f / square));
  return out;
}

}  // namespace velour
