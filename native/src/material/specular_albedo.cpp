#include "material/specular_albedo.h"

#include <algorithm>
#include <cmath>

#include "material/visible_facets.h"

namespace velour {

namespace {

float integrate_albedo(const Vec3& wv, const Vec2& alpha, const Fresnel& fresnel) {
  double sum = 0;
  for_visible_facets(wv, alpha, [&](double weight, float cosine, float masking) {
    if (masking > 0) sum += weight * masking * fresnel(cosine);
  });
  return static_cast<float>(std::clamp(sum, 0.0, 1.0));
}

}  // namespace

SpecularAlbedo::SpecularAlbedo(const Vec2& alpha, const Fresnel& fresnel) {
  for (size_t i = 0; i < kEntries; ++i) {
    const float root = static_cast<float>(i) / (kEntries - 1);
    const float cosine = root * root;
    albedo_[i] = integrate_albedo({std::sqrt(1 - cosine * cosine), 0, cosine}, alpha, fresnel);
  }
}

float SpecularAlbedo::at(float cosine) const {
  constexpr size_t kLast = kEntries - 1;
  const float place = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * kLast;
  const size_t low = std::min(static_cast<size_t>(place), kLast - 1);
  const float share = place - static_cast<float>(low);
  return (1 - share) * albedo_[low] + share * albedo_[low + 1];
}

}  // namespace velour
