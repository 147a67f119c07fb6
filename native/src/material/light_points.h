// Quadrature over light directions adapted to a mixture of warped lobes.
#pragma once

#include <span>
#include <vector>

#include "srbf/warped_mixture.h"

namespace velour {

/// Stratified samples of every lobe and of the cosine, in the lobes' frame, with each lobe's kernel at each sample.
/// Accurate to a few per cent.
class LightPoints {
 public:
  /// Uses only the value of `mixture`, not its density.
  explicit LightPoints(const WarpedMixture& mixture);

  size_t size() const { return light_.size(); }
  /// The integral of the luminance of f cos over the hemisphere.
  double mass() const { return mass_; }
  const Vec3& light(size_t i) const { return light_[i]; }
  double value(size_t i) const { return value_[i]; }          // luminance of f
  double per_value(size_t i) const { return per_value_[i]; }  // 1 / value; 0 where that is 0
  double weight(size_t i) const { return weight_[i]; }        // part of the mass
  double kernel(size_t i, int lobe) const { return static_cast<double>(kernel_[lobe][i]); }

 private:
  void add(const WarpedMixture& even, const DirectionBatch& wl);

  std::vector<Vec3> light_;
  std::vector<double> value_, per_value_, weight_;
  double mass_ = 0;
  std::vector<float> kernel_[WarpedMixture::kCapacity];  // peak 1
};

}  // namespace velour
