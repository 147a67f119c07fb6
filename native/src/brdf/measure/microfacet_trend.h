// A smooth BRDF that irregular samples lie near: what their interpolation follows between them.
#pragma once

#include <span>
#include <vector>

#include "brdf/measure/measurement.h"

namespace velour {

/// A microfacet lobe without its colors: D G2 / (4 cos_l cos_v). G2 is the height-correlated Smith term of GGX for the
/// same alpha. With x = (tan theta_h / alpha)^2, D is Student's t-distribution of slopes [RBSM17], in proportion to
/// (1 + x / (tail - 1))^-tail / cos^4 theta_h: a tail of 2 makes it GGX, a large one Beckmann; or, for a power above 1,
/// exp(-x^power) / cos^4 theta_h: the flat top and steep flanks that a goniometer's aperture makes of sharp highlights.
struct MicrofacetShape {
  float alpha;
  float tail;          // above 1
  float power = 1.0f;  // at least 1
};

/// f = diffuse / pi + sum of shape x ((1 - s) normal + s grazing), s = (1 - cos theta_d)^5 (Schlick): a diffuse base
/// below at most two isotropic lobes. Reciprocal. Immutable.
class MicrofacetTrend {
 public:
  static constexpr size_t kMaxLobes = 2;

  /// Black.
  MicrofacetTrend() = default;
  /// With `lobes` lobes at most. Least squares on sqrt(f cos), where cos is the mean of both cosines, so that the order
  /// of a pair does not matter. Shapes are searched on a grid, colors are non-negative least squares. A lobe is added
  /// if the Bayesian information criterion [Sch78] wants it. Black if no sample has a positive luminance.
  explicit MicrofacetTrend(std::span<const IrregularSample> samples, size_t lobes = kMaxLobes);

  /// In 1/sr, for unit directions above the horizon; never negative.
  Rgb f(const Vec3& wl, const Vec3& wv) const;
  const std::vector<MicrofacetShape>& shapes() const { return shapes_; }
  const Rgb& diffuse() const { return diffuse_; }

 private:
  std::vector<MicrofacetShape> shapes_;
  Rgb diffuse_{0.0f};
  Rgb normal_[kMaxLobes], grazing_[kMaxLobes];
};

}  // namespace velour
