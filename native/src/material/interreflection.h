// Light between the facets of a rough surface.
#pragma once

#include "material/ggx.h"
#include "material/ggx_albedo.h"

namespace velour {

/// What facets that send light to each other make of a lobe seen at a cosine: factors of it, 1 unless it is
/// GgxLobe::whole. The shape stays that of one bounce, so it is not reciprocal; Blender's, since 4.0.
class Interreflection {
 public:
  Interreflection(GgxLobe lobe, float roughness, float cosine) {
    if (lobe != GgxLobe::whole) return;
    albedo_ = ggx_albedo::of_white(roughness, cosine);
    mean_ = ggx_albedo::mean_of_white(roughness);
  }

  /// By the facets' reflectance in the mean over a hemisphere, 2 int F mu dmu: the albedo is that of one bounce or more
  /// [KC17, appendix].
  Rgb gain(const Rgb& mean_fresnel) const {
    const Rgb more = mean_fresnel * mean_ / (1.0f - mean_fresnel * (1 - mean_));
    return 1.0f + more * ((1 - albedo_) / albedo_);
  }
  /// The same over the gain of facets that reflect all light, which makes the albedo 1.
  Rgb gain_of_whole(const Rgb& mean_fresnel) const { return gain(mean_fresnel) * albedo_; }

 private:
  float albedo_ = 1, mean_ = 1;
};

}  // namespace velour
