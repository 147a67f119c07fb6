// Interreflection between the facets of a rough surface.
#pragma once

#include "material/ggx.h"
#include "material/ggx_albedo.h"

namespace velour {

/// Factors by which interreflection between facets scales a lobe at a view cosine; 1 unless it is GgxLobe::whole. The
/// shape remains that of one bounce, so f is not reciprocal. Follows Blender since 4.0.
class Interreflection {
 public:
  Interreflection(GgxLobe lobe, float roughness, float cosine) {
    if (lobe != GgxLobe::whole) return;
    albedo_ = ggx_albedo::of_white(roughness, cosine);
    mean_ = ggx_albedo::mean_of_white(roughness);
  }

  /// Makes the albedo that of one or more bounces [KC17, appendix]. `mean_fresnel`: mean reflectance of the facets over
  /// a hemisphere, 2 int F mu dmu.
  Rgb gain(const Rgb& mean_fresnel) const {
    const Rgb more = mean_fresnel * mean_ / (1.0f - mean_fresnel * (1 - mean_));
    return 1.0f + more * ((1 - albedo_) / albedo_);
  }
  /// gain() relative to that of perfectly reflecting facets, which makes the albedo 1.
  Rgb gain_of_whole(const Rgb& mean_fresnel) const { return gain(mean_fresnel) * albedo_; }

 private:
  float albedo_ = 1, mean_ = 1;
};

}  // namespace velour
