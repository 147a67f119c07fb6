// Directional albedo of a specular lobe as a table over the cosine, and its cosine-weighted mean.
#pragma once

#include <array>
#include <functional>

#include "sphere/vec.h"

namespace velour {

/// Reflectance at the microfacet as a function of the cosine with its normal.
using Fresnel = std::function<float(float cosine)>;

/// Linear in sqrt(cosine) between entries, where grazing albedos change fast. Immutable.
class SpecularAlbedo {
 public:
  SpecularAlbedo() = default;
  /// Albedo of the GGX lobe of roughness `alpha` by quadrature, for views along x.
  SpecularAlbedo(const Vec2& alpha, const Fresnel& fresnel);
  /// Of `below` under a layer `above` that is there with `weight` in [0, 1]: all but what both let through.
  static SpecularAlbedo layered(const SpecularAlbedo& above, float weight, const SpecularAlbedo& below);

  /// (1 - share) a + share b, its mean with it.
  static SpecularAlbedo between(const SpecularAlbedo& a, const SpecularAlbedo& b, float share);

  float at(float cosine) const;
  /// For albedo_at().
  static constexpr int kEntries = 64;
  using Table = std::array<float, kEntries>;
  const Table& table() const { return albedo_; }
  /// 2 int albedo(mu) mu dmu of this interpolant.
  float mean() const { return mean_; }

 private:
  float integrated() const;

  Table albedo_{};
  float mean_ = 0;
};

}  // namespace velour
