// Directional albedo of a specular lobe as a table over the cosine.
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
  /// Albedo of the GGX lobe of roughness `alpha` by quadrature, for views in the xz plane.
  SpecularAlbedo(const Vec2& alpha, const Fresnel& fresnel);
  float at(float cosine) const;

 private:
  static constexpr int kEntries = 64;
  std::array<float, kEntries> albedo_{};
};

}  // namespace velour
