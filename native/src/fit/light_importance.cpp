#include "fit/light_importance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace velour {
namespace {

constexpr double kMinImportance = 0.1, kMaxImportance = 10;
// Minimum divisor, so that the radiance of light at grazing incidence, which contributes little, is not overrated.
constexpr float kMinLightCosine = 0.05f;

}  // namespace

LightImportance::LightImportance(const SceneObservation& observation)
    : value_(static_cast<size_t>(kRings * kSpokes), 0.0) {
  for (const ObservedHit& hit : observation.hits) {
    for (uint32_t i = hit.first; i < hit.last; ++i) {
      const Vec3& wl = observation.wl[i];
      value_[bin(hit.wv, wl)] += static_cast<double>(luminance(observation.light[i]) / std::max(wl.z, kMinLightCosine));
    }
  }
  const double mean = std::accumulate(value_.begin(), value_.end(), 0.0) / static_cast<double>(value_.size());
  for (double& v : value_) v = mean > 0 ? std::clamp(v / mean, kMinImportance, kMaxImportance) : 1;
}

size_t LightImportance::bin(const Vec3& wv, const Vec3& wl) {
  const auto azimuth = [](const Vec3& w) { return std::atan2(static_cast<double>(w.y), static_cast<double>(w.x)); };
  const double phi = std::abs(std::remainder(azimuth(wl) - azimuth(wv), 2 * kPiD));
  const int ring = std::clamp(static_cast<int>(wl.z * kRings), 0, kRings - 1);
  const int spoke = std::clamp(static_cast<int>(phi / kPiD * kSpokes), 0, kSpokes - 1);
  return static_cast<size_t>(ring * kSpokes + spoke);
}

}  // namespace velour
