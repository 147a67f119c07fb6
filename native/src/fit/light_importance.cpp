#include "fit/light_importance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace velour {
namespace {

constexpr double kLeast = 0.1, kMost = 10;
// Light at grazing incidence brings little; its radiance is not to be overrated for that.
constexpr float kLeastCosine = 0.05f;

}  // namespace

LightImportance::LightImportance(const SceneObservation& observation, bool isotropic)
    : isotropic_(isotropic), value_(static_cast<size_t>(kRings * kSpokes), 0.0) {
  for (const ObservedHit& hit : observation.hits) {
    for (uint32_t i = hit.first; i < hit.last; ++i) {
      const Vec3& wl = observation.wl[i];
      value_[bin(hit.wv, wl)] += static_cast<double>(luminance(observation.light[i]) / std::max(wl.z, kLeastCosine));
    }
  }
  const double mean = std::accumulate(value_.begin(), value_.end(), 0.0) / static_cast<double>(value_.size());
  for (double& v : value_) v = mean > 0 ? std::clamp(v / mean, kLeast, kMost) : 1;
}

size_t LightImportance::bin(const Vec3& wv, const Vec3& wl) const {
  double phi = std::atan2(static_cast<double>(wl.y), static_cast<double>(wl.x));
  double turn = 2 * kPiD;
  if (isotropic_) {
    phi = std::remainder(phi - std::atan2(static_cast<double>(wv.y), static_cast<double>(wv.x)), 2 * kPiD);
    phi = std::abs(phi), turn = kPiD;
  } else if (phi < 0) {
    phi += turn;
  }
  const int ring = std::clamp(static_cast<int>(wl.z * kRings), 0, kRings - 1);
  const int spoke = std::clamp(static_cast<int>(phi / turn * kSpokes), 0, kSpokes - 1);
  return static_cast<size_t>(ring * kSpokes + spoke);
}

}  // namespace velour
