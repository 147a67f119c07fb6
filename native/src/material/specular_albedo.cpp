#include "material/specular_albedo.h"

#include <algorithm>

#include "material/ggx.h"
#include "sphere/quadrature.h"

namespace velour {

namespace {

/// Mean of F G2 / G1 over visible normals: the integrand is smooth whatever the roughness. `radius`: of the disk of
/// visible normals, in [0, 1].
float integrate_albedo(const Vec3& wv, const Vec2& alpha, const Fresnel& fresnel, const Quadrature& radius) {
  constexpr int kTurns = 24;  // half a circle's: the other side of the plane of incidence is its mirror image
  double sum = 0;
  for (size_t i = 0; i < radius.node.size(); ++i) {
    for (int k = 0; k < kTurns; ++k) {
      const float turn = 0.5f * (static_cast<float>(k) + 0.5f) / kTurns - 0.25f;
      const auto r = static_cast<float>(radius.node[i]);
      const Vec3 h = sample_ggx_visible_normal(wv, alpha, {r * r, turn});
      const float cosine = std::min(glm::dot(wv, h), 1.0f);
      const Vec3 wl = 2 * cosine * h - wv;
      if (cosine <= 0 || wl.z <= 0) continue;
      const float masking = wl.z * (wv.z + ggx_projected_length(wv, alpha)) /
                            (wl.z * ggx_projected_length(wv, alpha) + wv.z * ggx_projected_length(wl, alpha));
      sum += 2 * radius.node[i] * radius.weight[i] / kTurns * masking * fresnel(cosine);
    }
  }
  return static_cast<float>(std::clamp(sum, 0.0, 1.0));
}

}  // namespace

SpecularAlbedo::SpecularAlbedo(const Vec2& alpha, const Fresnel& fresnel) {
  const Quadrature radius = gauss_legendre(24, 0, 1);
  for (size_t i = 0; i < kEntries; ++i) {
    const float root = static_cast<float>(i) / (kEntries - 1);
    const float cosine = root * root;
    albedo_[i] = integrate_albedo({std::sqrt(1 - cosine * cosine), 0, cosine}, alpha, fresnel, radius);
  }
  mean_ = integrated();
}

SpecularAlbedo SpecularAlbedo::layered(const SpecularAlbedo& above, float weight, const SpecularAlbedo& below) {
  SpecularAlbedo both;
  for (size_t i = 0; i < kEntries; ++i) {
    both.albedo_[i] = 1 - (1 - weight * above.albedo_[i]) * (1 - below.albedo_[i]);
  }
  both.mean_ = both.integrated();
  return both;
}

SpecularAlbedo SpecularAlbedo::between(const SpecularAlbedo& a, const SpecularAlbedo& b, float share) {
  SpecularAlbedo mixed;
  for (size_t i = 0; i < kEntries; ++i) mixed.albedo_[i] = (1 - share) * a.albedo_[i] + share * b.albedo_[i];
  mixed.mean_ = (1 - share) * a.mean_ + share * b.mean_;
  return mixed;
}

float SpecularAlbedo::integrated() const {
  double mean = 0;
  for (int i = 0; i + 1 < kEntries; ++i) {  // mu = s^2: 4 int albedo s^3 ds, a quartic on each piece
    const Quadrature piece = gauss_legendre(3, i / (kEntries - 1.0), (i + 1) / (kEntries - 1.0));
    for (size_t k = 0; k < piece.node.size(); ++k) {
      const double s = piece.node[k];
      mean += 4 * s * s * s * piece.weight[k] * at(static_cast<float>(s * s));
    }
  }
  return static_cast<float>(mean);
}

float SpecularAlbedo::at(float cosine) const { return albedo_at(albedo_, cosine); }

}  // namespace velour
